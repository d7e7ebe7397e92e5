# SPDX-License-Identifier: BSD-3-Clause
"""Contact tables in files: ours come back to the bit; those of other programs give what they say; bad ones say why."""

from functools import cache

import numpy as np
import pytest

import railsym as rs
from railsym.contact_pair import ContactPair
from railsym.contact_table_files import COLUMNS, load
from railsym.errors import ContactError

LOAD = 60e3


@cache
def table():
    return ContactPair("S1002", "UIC60", inclination=1 / 40).table()


def assert_same(one, other, places):
    for side in ("left", "right"):
        a, b = (getattr(t, side).lookup(*places) for t in (one, other))
        for name in ("load", "x", "lateral", "radius", "angle", "a", "b", "count"):
            assert np.array_equal(getattr(a, name), getattr(b, name)), name


PLACES = (np.linspace(-6e-3, 6e-3, 25), 1e-3 * np.sin(np.arange(25.0)), 2.5e-4 * np.ones(25), 4e-3 * np.cos(np.arange(25.0)))


def test_a_table_comes_back_to_the_bit(tmp_path):
    table().save(tmp_path / "pair.npz")
    back = rs.load_contact_table(tmp_path / "pair.npz")
    shallow = (PLACES[0], PLACES[1], np.minimum(table().right.under_load(PLACES[0], LOAD, PLACES[1])[0],
                                               table().left.under_load(PLACES[0], LOAD, PLACES[1])[0]), PLACES[3])
    assert_same(table(), back, shallow)
    assert (back.description, back.wheel_radius, back.tape_circle_spacing, back.nbytes) == ("S1002 on UIC60, gauge 1435.0 mm", 0.46, 1.5, table().nbytes)


def test_an_asymmetric_pair_comes_back(tmp_path):
    both = ContactPair("S1002", "UIC60", inclination=1 / 40, wheel_radius_left=0.4605).table()
    both.save(tmp_path / "pair.npz")
    back = rs.load_contact_table(tmp_path / "pair.npz")
    assert back.contact([1e-3], LOAD).rolling_radius_difference == both.contact([1e-3], LOAD).rolling_radius_difference


def test_damaged_and_missing_files(tmp_path):
    path = tmp_path / "pair.npz"
    table().save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[:len(whole) // 2])
    with pytest.raises(ContactError, match="pair.npz"):
        rs.load_contact_table(path)
    with pytest.raises(ContactError, match="there is no contact table"):
        rs.load_contact_table(tmp_path / "none.npz")
    np.savez(path, format=99)
    with pytest.raises(ContactError, match="format 99; this railsym reads 2"):
        rs.load_contact_table(path)
    np.savez(path, something=1)
    with pytest.raises(ContactError, match="is not a contact table of railsym"):
        rs.load_contact_table(path)


def test_a_table_that_cannot_be_written_leaves_what_is_there(tmp_path):
    with pytest.raises(ContactError, match="cannot be written"):
        table().save(tmp_path / "nowhere" / "pair.npz")
    assert not list(tmp_path.iterdir())


@cache
def columns(loads=(LOAD,)):
    """What another program would write of this pair: the right wheel, both wheels touching, tread only."""
    y = np.linspace(-4.2e-3, 4.2e-3, 421)
    rows = []
    for load_ in loads:
        found = table().contact(y, load_, with_roll=True)
        touching = table().right.under_load(y, 1e-2, found.roll)[0]
        p = found.right
        depth = (table().right.under_load(y, load_, found.roll)[0] - touching) * np.cos(p.angle[:, 0])
        rows.append(np.column_stack([y, p.load[:, 0], p.angle[:, 0] + found.roll, p.a[:, 0], p.b[:, 0], p.lateral[:, 0], p.radius[:, 0], 0 * y + 4.8, 0 * y + 4.4, 0 * y + 2.1,
                                     depth]))
    return np.concatenate(rows), found


def write(path, rows, header=None, separator=","):
    lines = ([separator.join(header)] if header else []) + [separator.join(f"{v:.10e}" for v in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_an_external_table_gives_what_it_says(tmp_path):
    # between its rows: 3 um of radius; of roll, which it integrates from the angles of the loaded patch, 6 urad
    rows, found = columns()
    external = rs.load_contact_table(write(tmp_path / "other.csv", rows))
    y = np.array([-3e-3, -1e-3, 0.0, 5e-4, 2e-3, 3.5e-3])
    ours, theirs = table().contact(y, LOAD, with_roll=True), external.contact(y, LOAD, with_roll=True)
    assert theirs.right.mean("radius") == pytest.approx(ours.right.mean("radius"), abs=3e-6)
    assert theirs.left.mean("radius") == pytest.approx(ours.left.mean("radius"), abs=3e-6)
    assert theirs.right.mean("angle") == pytest.approx(ours.right.mean("angle"), abs=1e-4)      # the roll of 0.2 mrad taken wrongly: 2e-4
    assert theirs.roll == pytest.approx(ours.roll, abs=6e-6)
    assert theirs.right.a[:, 0] == pytest.approx(ours.right.a[:, 0], rel=0.01)
    assert external.nbytes < 4e6


def test_an_external_table_pushes_along_its_own_normal(tmp_path):
    # a wheelset that slides with a fixed roll rises by the tangent of its contact's angle to the track: within 0.05 mrad; the
    # angle and the moving contact's share in the roll (up to 0.3 mrad) are what can go wrong
    rows, _ = columns()
    external = rs.load_contact_table(write(tmp_path / "other.csv", rows))
    y, step = np.linspace(-3.8e-3, 3.8e-3, 11), 1e-4
    found = external.contact(y, LOAD, with_roll=True)
    before, after = (external.right.under_load(y + side * step, 1e-2, found.roll)[0] for side in (-1.0, 1.0))
    assert np.arctan((before - after) / (2.0 * step)) == pytest.approx(found.right.mean("angle"), abs=1e-4)


def test_loads_between_those_of_an_external_table(tmp_path):
    rows, _ = columns((30e3, 60e3, 90e3))
    header = [*COLUMNS[3:], *COLUMNS[:3]]
    external = rs.load_contact_table(write(tmp_path / "other.csv", np.roll(rows, -3, axis=1), header, ";"))
    ours, theirs = (t.contact([2e-3], 75e3, with_roll=True).right for t in (table(), external))
    assert theirs.a[0, 0] == pytest.approx(ours.a[0, 0], rel=0.01)
    assert theirs.mean("radius") == pytest.approx(ours.mean("radius"), abs=1e-5)


@pytest.mark.parametrize(("change", "said"), [
    (lambda r: r[:5], "5 rows; a contact table needs at least 8 shifts"),
    (lambda r: r[r[:, 0] > 1e-4], "on both sides of the centre"),
    (lambda r: np.column_stack([1e3 * r[:, :1], r[:, 1:]]), "lateral_shift_m is -4.2 at lateral shift -4200 mm; it must be from -0.05 to 0.05: check its unit"),
    (lambda r: np.column_stack([r[:, :2], 57.3 * r[:, 2:3], r[:, 3:]]), "contact_angle_rad is .* check its unit"),
    (lambda r: np.column_stack([r[:, :1], -r[:, 1:2], r[:, 2:]]), "normal_load_N is -"),
    (lambda r: np.delete(r, 10, axis=0) if len(r) == 421 else r, None),
    (lambda r: np.where(np.arange(r.size).reshape(r.shape) == 500, np.nan, r), "line 46: a number is not finite")])
def test_external_tables_that_make_no_sense(tmp_path, change, said):
    path = write(tmp_path / "other.csv", change(columns()[0]))
    if said is None:
        load(path)
        return
    with pytest.raises(ContactError, match=said):
        load(path)


def test_external_files_that_are_none(tmp_path):
    rows, _ = columns()
    cases = [("", "the file is empty"), ("a,b\n1,2\n", "no column 'lateral_shift_m'"), ("1,2,3\n" * 9, "line 1 has 3 numbers and no header"),
             ("\n".join([",".join(COLUMNS)] + ["1," * 10 + "x"] * 9), "line 2: not all of it are numbers"),
             ("\n".join([",".join(COLUMNS)] + ["1,2"] * 9), "line 2: 2 numbers, and there are 11 columns")]
    for text, said in cases:
        (tmp_path / "other.csv").write_text(text, encoding="utf-8")
        with pytest.raises(ContactError, match=said):
            load(tmp_path / "other.csv")
    (tmp_path / "other.csv").write_bytes(b"\xff\xfe\x00\x01" * 20)
    with pytest.raises(ContactError, match="other.csv"):
        load(tmp_path / "other.csv")
    two = np.concatenate([rows, rows[:100] * [1.0, 1.1, *[1.0] * 9]])
    with pytest.raises(ContactError, match="each needs the same loads"):
        load(write(tmp_path / "other.csv", two))
