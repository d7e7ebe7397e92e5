# SPDX-License-Identifier: BSD-3-Clause
"""Measured profiles from files: the formats, and an error with line and reason for what is none."""

import numpy as np
import pytest

import railsym as rs
from railsym.profiles import ProfileError


def points(name, spacing=0.4):
    """Points (mm, z down) every 0.4 mm along a profile that comes along."""
    profile = rs.load_profile(name)
    at = np.arange(2.0, 1e3 * profile.arc_length[-1] - 2.0, spacing)
    return np.column_stack([np.interp(at, 1e3 * profile.arc_length, 1e3 * v) for v in (profile.y, profile.z)])


def csv_file(folder, rows, header="# measured\ny_mm,z_mm", name="wheel.csv"):
    path = folder / name
    path.write_text(header + "\n" + "\n".join(f"{a:.7f},{b:.7f}" for a, b in rows) + "\n", encoding="utf-8")
    return path


def simpack(rows, kind, factor=1000.0, **more):
    keys = {"units.len.f": factor, **{key.replace("_", "."): value for key, value in more.items()}}
    body = "\n".join(f"    {a:.9f} {b:.9f}" for a, b in rows)
    return ("! a profile\nheader.begin\n  version = 1\n  type = %d ! 0 rail, 1 wheel\nheader.end\nspline.begin\n  approx.smooth = 0.0\n" % (kind == "wheel")
            + "".join(f"  {key} = {value}\n" for key, value in keys.items()) + f"  point.begin\n  ! y z\n{body}\n  point.end\nspline.end\n")


def same(found, rows, tolerance=1e-8):
    order = 1 if rows[0][0] < rows[-1][0] else -1
    np.testing.assert_allclose(found.points, 1e-3 * rows[::order], atol=tolerance)


def test_csv_with_units_in_its_header(tmp_path):
    rows = points("S1002")
    same(rs.load_profile(csv_file(tmp_path, rows), "wheel"), rows)
    same(rs.load_profile(csv_file(tmp_path, rows * 1e-3, "# kind: wheel\ny_m,z_m")), rows, tolerance=1e-7)      # 7 digits of a metre
    same(rs.load_profile(csv_file(tmp_path, rows[:, ::-1], "# kind: wheel\nz_mm,y_mm")), rows)
    same(rs.load_profile(csv_file(tmp_path, rows[::-1], ""), "wheel"), rows)                 # from the field side, no header
    same(rs.load_profile(csv_file(tmp_path, rows * 1e-3, ""), "wheel", unit="m"), rows, tolerance=1e-7)


def test_left_side_upward_and_from_the_flange_back(tmp_path):
    rows = points("S1002")
    path = csv_file(tmp_path, rows * [-1.0, -1.0] + [-70.0, 0.0], "")
    same(rs.load_profile(path, "wheel", mirror=True, upward=True, shift=-0.070), rows)


@pytest.mark.parametrize("name, kind, suffix", [("S1002", "wheel", ".prw"), ("UIC60", "rail", ".prr")])
def test_simpack_in_any_unit_and_mirrored(tmp_path, name, kind, suffix):
    rows, path = points(name), tmp_path / f"profile{suffix}"
    path.write_text(simpack(rows, kind), encoding="utf-8")
    same(rs.load_profile(path), rows)
    path.write_text(simpack(1e-3 * rows, kind, factor=1.0), encoding="utf-8")
    same(rs.load_profile(path), rows)
    path.write_text(simpack(rows * [-1.0, -1.0] - [0.5, 0.25], kind, mirror_y=1, mirror_z=1, shift_y=0.5, shift_z=0.25), encoding="utf-8")
    same(rs.load_profile(path), rows)
    path.write_text(simpack(rows, kind, bound_y_min=-34.0, bound_y_max=34.0), encoding="utf-8")
    if kind == "rail":
        assert np.abs(rs.load_profile(path).points[:, 0]).max() <= 0.034
    c, s = np.cos(0.02), np.sin(0.02)
    path.write_text(simpack(rows @ np.array([[c, -s], [s, c]]), kind, rotate=np.degrees(0.02), units_ang_f=180.0 / np.pi), encoding="utf-8")
    same(rs.load_profile(path), rows, tolerance=2e-8)


def test_miniprof_with_and_without_columndef(tmp_path):
    rows, path = points("UIC60"), tmp_path / "rail.ban"
    body = "\n".join(f"  {a:.6f}\t{b:.6f}\t0.0" for a, b in rows[::-1])
    path.write_text(f"Filename=rail.ban\nXYPoints={len(rows)}\nXOffset=0.0\nColumnDef=X,Y,A\n\n{body}\n\" 1.0\t2.0\t3.0\n", encoding="utf-8")
    same(rs.load_profile(path), rows, tolerance=1e-8)
    path.write_text(path.read_text(encoding="utf-8").replace("\t0.0\n", "\t0.0 a point added by hand % dent\n", 1), encoding="utf-8")
    same(rs.load_profile(path), rows, tolerance=1e-8)
    path.write_text(path.read_text(encoding="utf-8").replace("\t0.0\n", "\n", 1), encoding="utf-8")
    with pytest.raises(ProfileError, match="rail.ban, line 7: 2 columns, where ColumnDef has X,Y,A"):
        rs.load_profile(path)
    rows, path = points("S1002"), tmp_path / "wheel.whl"
    path.write_text("#MINIWHEELPROF\nMINIPROF 2020\nStock.......:\n\" 32.58 37.11\n(Sd/Sh/qR)\n\n"
                    + "\n".join(f"{a + 70.0:.6f} {b:.6f}" for a, b in rows) + "\n", encoding="latin-1")
    same(rs.load_profile(path, shift=-0.070), rows, tolerance=1e-8)


def broken(change):
    rows = points("S1002")
    return change(rows)


def without(rows, low, high):
    return np.delete(rows, slice(low, high), axis=0)


def swapped(rows):
    rows = rows.copy()
    rows[[100, 103]] = rows[[103, 100]]
    return rows


def repeated(rows):
    return np.insert(rows, 51, rows[50], axis=0)


# (change, what the message says); a point is on the line of its number + 2: a comment and a header are before it
BAD = {"unsorted": (swapped, r"line 10[2-6] to line 10[3-7]: the points turn back.*sorted"),
       "gap": (lambda r: without(r, 100, 120), r"line 102 to line 103: a gap of 8\.\d* mm"),
       "metres": (lambda r: 1e-3 * r, "metres are given where millimetres are declared"),
       "inches": (lambda r: r / 25.4, "inches"),
       "flipped": (lambda r: r * [-1.0, 1.0], r"left and right are exchanged.*mirror=True"),
       "upside down": (lambda r: r * [1.0, -1.0], r"upside down.*upward=True"),
       "too short": (lambda r: r[-90:], "too short"),
       "no flange": (lambda r: r[-180:], "no flange"),
       "too few": (lambda r: r[:: len(r) // 10], "too few"),
       "no tread": (lambda r: r[: len(r) // 2], "too short"),
       "repeated": (repeated, "line 54: repeats the point of line 53")}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_gets_an_error_with_line_and_reason(tmp_path, name):
    change, expected = BAD[name]
    with pytest.raises(ProfileError, match=expected) as caught:
        rs.load_profile(csv_file(tmp_path, broken(change)), "wheel")
    assert "wheel.csv" in str(caught.value)


@pytest.mark.parametrize("text", ["nan", "inf", "12,4", "--"])
def test_what_is_no_number_is_named_with_its_line(tmp_path, text):
    path = csv_file(tmp_path, points("S1002"))
    lines = path.read_text(encoding="utf-8").splitlines()
    lines[40] = f"{text},1.0" if text != "12,4" else "12.4"
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(ProfileError, match="wheel.csv, line 41: .*(not a finite number|two numbers|one number)"):
        rs.load_profile(path, "wheel")


def test_an_upside_down_rail_is_refused(tmp_path):
    path = csv_file(tmp_path, points("UIC60") * [1.0, -1.0], name="rail.csv")
    with pytest.raises(ProfileError, match="rail is upside down"):
        rs.load_profile(path, "rail")
    assert rs.load_profile(path, "rail", upward=True).kind == "rail"


def test_files_that_do_not_say_enough(tmp_path):
    path = csv_file(tmp_path, points("S1002"))
    with pytest.raises(ProfileError, match="a wheel or a rail"):
        rs.load_profile(path)
    with pytest.raises(ProfileError, match="must name the columns y and z"):
        rs.load_profile(csv_file(tmp_path, points("S1002"), "a,b"), "wheel")
    with pytest.raises(ProfileError, match="different units"):
        rs.load_profile(csv_file(tmp_path, points("S1002"), "y_mm,z_m"), "wheel")
    with pytest.raises(ProfileError, match="'.xyz' are not known"):
        rs.load_profile(csv_file(tmp_path, points("S1002"), name="wheel.xyz"), "wheel")
    empty = tmp_path / "empty.prw"
    empty.write_text("header.begin\nheader.end\n", encoding="utf-8")
    with pytest.raises(ProfileError, match="no block point.begin"):
        rs.load_profile(empty)
