# SPDX-License-Identifier: BSD-3-Clause
"""Profile files as users have them: random valid ones come back, damaged ones are refused with file, line and reason, by nothing but ProfileError."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import railsym as rs
from railsym.profiles import ProfileError
from tests.test_profile_files import csv_file, points, simpack

files = settings(max_examples=25, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
UNITS = {"mm": 1.0, "cm": 0.1, "m": 1e-3}
POINTS = {name: points(name) for name in ("S1002", "UIC60")}
KINDS = {"S1002": "wheel", "UIC60": "rail"}
SUFFIXES = {"simpack": {"wheel": ".prw", "rail": ".prr"}, "miniprof": {"wheel": ".whl", "rail": ".ban"}}


def same(found, rows, tolerance=2e-8):
    order = 1 if rows[0][0] < rows[-1][0] else -1
    np.testing.assert_allclose(found.points, 1e-3 * rows[::order], rtol=0, atol=tolerance)


@files
@given(name=st.sampled_from(["S1002", "UIC60"]), unit=st.sampled_from(list(UNITS)), separator=st.sampled_from([",", ";", "\t", " ", ", ", "decimal;", "decimal "]),
       columns=st.permutations(["y", "z", "n"]), backwards=st.booleans(), header=st.sampled_from(["", "comment", "twice"]),
       encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "latin-1"]), newline=st.sampled_from(["\n", "\r\n"]))
def test_csv_in_any_valid_form(tmp_path, name, unit, separator, columns, backwards, header, encoding, newline):
    rows = POINTS[name][::-1] if backwards else POINTS[name]
    data = {"y": rows[:, 0] * UNITS[unit], "z": rows[:, 1] * UNITS[unit], "n": np.arange(len(rows)) + 0.5}
    between = separator[-1] if separator.startswith("decimal") else separator
    head = (";" if between == " " else between).join(f"{c}_{unit}" if c != "n" else "n" for c in columns)
    lines = [f"# kind: {KINDS[name]}", *(["# gemessen in M\xfcnchen", ""] if header == "comment" else []), *[head] * (2 if header == "twice" else 1)]
    body = [between.join(f"{data[c][k]:.9f}" for c in columns) for k in range(len(rows))]
    if separator.startswith("decimal"):
        body = [line.replace(".", ",") for line in body]
    path = tmp_path / "profile.csv"
    path.write_bytes((newline.join([*lines, *body]) + newline).encode(encoding))
    same(rs.load_profile(path), rows)


@files
@given(name=st.sampled_from(["S1002", "UIC60"]), factor=st.sampled_from([1.0, 1000.0]), mirror=st.tuples(st.booleans(), st.booleans()),
       shift=st.tuples(st.floats(-80, 80), st.floats(-30, 30)), turn=st.floats(-0.05, 0.05), backwards=st.booleans(), weights=st.booleans(), fortran=st.booleans())
def test_simpack_with_all_its_treatments(tmp_path, name, factor, mirror, shift, turn, backwards, weights, fortran):
    rows = POINTS[name]
    signs = [-1.0 if m else 1.0 for m in mirror]
    c, s = np.cos(turn), np.sin(turn)
    scale = factor / 1000.0
    # what the file must hold: the treatments undone, last first
    kept = rows * scale * signs
    kept = kept @ np.array([[c, -s], [s, c]]) - np.array(shift) * scale
    if backwards:
        kept = kept[::-1]
    if weights:
        kept = np.column_stack([kept, np.ones(len(kept))])
    number = (lambda x: f"{x:+.12e}".replace("e", "D")) if fortran else (lambda x: f"{x:.12f}")
    body = "\n".join("      " + " ".join(map(number, row)) for row in kept)
    kind = KINDS[name]
    path = tmp_path / f"profile{SUFFIXES['simpack'][kind]}"
    path.write_text("! profile\n  header.begin\n    version = 1 ! version\n" + f"    type = {int(kind == 'wheel')} ! 0=rail profile, 1=wheel profile\n  header.end\n  spline.begin\n"
                    "    approx.smooth = +0.000000000000000e+00\n    file = '-'\n    file.mtime = 0\n    comment = 'measured'\n    type = 0 ! Original data file type\n"
                    f"    point.dist.min = 0.0\n    shift.y = {shift[0] * scale!r}\n    shift.z = {shift[1] * scale!r}\n    rotate = {turn!r}\n    bound.y.min = 1.0\n"
                    f"    bound.y.max = 0.0\n    mirror.y = {int(mirror[0])}\n    mirror.z = {int(mirror[1])}\n    inversion = 0\n    units.len = 'm'\n    units.len.f = {factor}\n"
                    f"    units.ang.f = 1.0\n    point.begin\n    ! y z\n{body}\n    point.end\n  spline.end\n", encoding="utf-8")
    same(rs.load_profile(path), rows)


def test_simpack_drops_points_that_are_too_near_as_the_file_asks(tmp_path):
    rows = POINTS["S1002"]
    path = tmp_path / "wheel.prw"
    path.write_text(simpack(np.repeat(rows, 2, axis=0), "wheel"), encoding="utf-8")
    with pytest.raises(ProfileError, match="repeats the point"):
        rs.load_profile(path)
    path.write_text(simpack(np.repeat(rows, 2, axis=0), "wheel", point_dist_min=1e-3), encoding="utf-8")
    same(rs.load_profile(path), rows)


@files
@given(name=st.sampled_from(["S1002", "UIC60"]), columns=st.sampled_from(["X,Y", "X,Y,*", "X,Y,A,C", "A,X,Y", "N,Y,X", None]), count=st.booleans(),
       backwards=st.booleans(), remarks=st.lists(st.integers(0, 200), max_size=5, unique=True))
def test_miniprof_with_its_columns_in_any_order(tmp_path, name, columns, count, backwards, remarks):
    rows, kind = POINTS[name][::-1] if backwards else POINTS[name], KINDS[name]
    names = (columns or "X,Y").replace(",*", ",Q,R").split(",")
    body = ["\t".join(f"{ {'X': y, 'Y': z}.get(c, 0.25):.7f}" for c in names) for y, z in rows]
    for at in sorted(remarks, reverse=True):
        body.insert(at, '" 1.0 2.0 taken out')
    head = ["Filename=x", "Date=01-02-2024", *([f"XYPoints={len(rows)}"] if count else []), *([f"ColumnDef={columns}"] if columns else []), "Comment=worn = no", ""]
    path = tmp_path / f"p{SUFFIXES['miniprof'][kind]}"
    path.write_text("\n".join([*head, *body]) + "\n", encoding="latin-1")
    same(rs.load_profile(path), rows, tolerance=2e-7)


DAMAGE = {"unsorted": (lambda r: np.concatenate([r[:50], r[80:110], r[50:80], r[110:]]), "turn back|gap"),
          "repeated": (lambda r: np.insert(r, 60, r[60], axis=0), "repeats the point"),
          "gap": (lambda r: np.delete(r, slice(100, 118), axis=0), "a gap of"),
          "metres": (lambda r: r * 1e-3, "metres are given where millimetres"),
          "inches": (lambda r: r / 25.4, "inches are given"),
          "flipped": (lambda r: r * [-1.0, 1.0], "left and right are exchanged"),
          "upside down": (lambda r: r * [1.0, -1.0], "upside down"),
          "short": (lambda r: r[-90:], "too short"), "few": (lambda r: r[::40], "too few")}


@pytest.mark.parametrize("form", ["csv", "simpack", "miniprof"])
@pytest.mark.parametrize("name", DAMAGE)
def test_damaged_wheels_are_refused_in_every_format(tmp_path, form, name):
    change, reason = DAMAGE[name]
    rows = change(POINTS["S1002"])
    text = {"csv": "y_mm,z_mm\n" + "\n".join(f"{a:.8f},{b:.8f}" for a, b in rows), "simpack": simpack(rows, "wheel"),
            "miniprof": "ColumnDef=X,Y\n\n" + "\n".join(f"{a:.8f} {b:.8f}" for a, b in rows)}[form]
    path = tmp_path / f"worn{SUFFIXES.get(form, {}).get('wheel', '.csv')}"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ProfileError, match=f"worn.*({reason})"):
        rs.load_profile(path, "wheel")


BROKEN = {"empty.csv": (b"", "no line with two numbers"), "empty.prw": (b"", "no block point.begin"), "empty.whl": (b"", "no points; .*empty line"),
          "binary.csv": (bytes(range(256)) * 8, "line 1: this is no text"), "binary.ban": (b"PK\x03\x04" + bytes(200), "line 1: this is no text"),
          "utf16.csv": ("1,2\n3,4\n".encode("utf-16-le"), "line 1: this is no text"), "words.csv": (b"hello world\n", "line 1: the header .* must name the columns y and z"),
          "half.csv": (b"y_mm,z_mm\n1.0,2.0\n3.0\n", "line 3: .* is one number"), "text.csv": (b"y_mm,z_mm\n1.0,2.0\n3.0,abc\n", "line 3: .* are not two numbers"),
          "column.csv": (b"n,z_mm\n1,2\n", "line 1: .*must name the columns y and z"), "third.csv": (b"n,y_mm,z_mm\n1,2,3\n1,2\n", "line 3: 2 columns"),
          "unit.csv": (b"y_kg,z_kg\n1,2\n", "kg"), "cut.prw": (b"header.begin\nheader.end\nspline.begin\npoint.begin\n1 2\n3 4\n", "no block point.begin"),
          "key.prw": (b"shift.y = abc\npoint.begin\n1 2\npoint.end\n", "line 1: shift.y = 'abc' is not a number"),
          "factor.prw": (b"units.len.f = 0\npoint.begin\n1 2\npoint.end\n", "line 1: units.len.f is 0"),
          "smooth.prw": (b"approx.smooth = 3\npoint.begin\n1 2\npoint.end\n", "line 1: approx.smooth"),
          "columns.whl": (b"ColumnDef=A,X\n\n1 2\n", "line 1: ColumnDef"), "star.whl": (b"ColumnDef=X,*,Y\n\n1 2\n", "line 3: 2 columns"),
          "cut.whl": (b"XYPoints=300\nColumnDef=X,Y\n\n1 2\n3 4\n", "line 1: XYPoints=300, and 2 points follow"),
          "joined.whl": (b"ColumnDef=X,Y\n1 2\n3 4\n", "after a header and an empty line"), "toml.toml": (b"name = ", "toml"), "list.toml": (
              b'name="x"\nkind="wheel"\nunit="mm"\norigin="me"\nzones=3\n', "zones must be a list"), "none.toml": (
              b'name="x"\nkind="wheel"\nunit="mm"\norigin="me"\nzones=[]\n', "zones must be a list"), "what.xyz": (b"1 2", "'.xyz' are not known")}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_are_refused_in_one_line(tmp_path, name):
    content, reason = BROKEN[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ProfileError, match=f"(?s){name.split('.')[0]}.*{reason}") as caught:
        rs.load_profile(path, "wheel" if not name.endswith(".ban") else "rail")
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 300


@settings(max_examples=200, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(suffix=st.sampled_from([".csv", ".prw", ".prr", ".whl", ".ban", ".toml", ".txt"]),
       content=st.one_of(st.binary(max_size=300), st.text(max_size=300).map(lambda t: t.encode("utf-8", "surrogatepass")),
                         st.text(alphabet="0123456789.,;-+eDyzXY=#!%\"\n\t ", max_size=400).map(str.encode)),
       frame=st.sampled_from([b"%s", b"y_mm,z_mm\n%s", b"point.begin\n%s\npoint.end\n", b"ColumnDef=X,Y\n\n%s", b"units.len.f = %s\npoint.begin\n1 2\npoint.end\n"]))
def test_nothing_but_a_profile_error_comes_out_of_any_bytes(tmp_path, suffix, content, frame):
    path = tmp_path / f"noise{suffix}"
    path.write_bytes(frame.replace(b"%s", content))
    with pytest.raises(ProfileError, match="noise"):
        rs.load_profile(path, "rail" if suffix in (".prr", ".ban") else "wheel")


def test_a_wheel_is_not_read_as_a_rail(tmp_path):
    path = tmp_path / "wheel.prw"
    path.write_text(simpack(POINTS["S1002"], "wheel"), encoding="utf-8")
    with pytest.raises(ProfileError, match="wheel.prw is a wheel, and a rail is needed"):
        rs.load_profile(path, "rail")
    with pytest.raises(ProfileError, match="is a rail, and a wheel is needed"):
        rs.load_profile(csv_file(tmp_path, POINTS["UIC60"], "# kind: Rail\ny_mm,z_mm"), "wheel")


@files
@given(noise=st.floats(2e-6, 3e-5), seed=st.integers(0, 10), name=st.sampled_from(["S1002", "UIC60"]))
def test_smoothing_keeps_its_tolerance(noise, seed, name):
    """The root-mean-square distance of the points is the one asked for, or less where the curve is smooth enough already; the largest
    is a few times that, and the curve is nearer to the true profile than the points are."""
    rows = 1e-3 * POINTS[name]
    moved = rows + noise / np.sqrt(2.0) * np.random.default_rng(seed).normal(size=rows.shape)
    found = rs.Profile.from_points("measured", KINDS[name], *moved.T, smoothing=noise)
    curve = np.column_stack([found.y, found.z])
    nearest = np.array([np.hypot(*(curve - point).T).min() for point in moved[5:-5]])
    # nodes are 0.05 mm apart: a point on the curve is up to 0.025 mm along it from one, so across it is what counts
    across = np.sqrt(np.maximum(nearest**2 - 2.5e-5**2, 0.0))
    assert np.sqrt(np.mean(across**2)) <= 1.01 * noise
    assert found.deviation <= 6.0 * noise
    through = rs.Profile.from_points("measured", KINDS[name], *moved.T)
    assert through.deviation < 1e-9
    assert np.abs(found.curvature).max() < np.abs(through.curvature).max()


def cli(*arguments):
    return subprocess.run([sys.executable, "-m", "railsym", *map(str, arguments)], capture_output=True, text=True)


@pytest.mark.parametrize("name", ["binary.csv", "cut.whl", "half.csv"])
def test_the_command_line_says_it_in_one_line(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(BROKEN[name][0])
    done = cli("profiles", path, "UIC60")
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1 and name in done.stderr and "line" in done.stderr
