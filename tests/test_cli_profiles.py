# SPDX-License-Identifier: BSD-3-Clause
"""``railsym profiles``: table, JSON, picture, errors."""

import json

import pytest

import railsym as rs
from railsym.cli import main

PAIR = ["profiles", "S1002", "UIC60", "--amplitude", "3mm"]


def run(capsys, *arguments):
    status = main(list(arguments))
    return status, *capsys.readouterr()


def test_lists_what_comes_along(capsys):
    status, out, err = run(capsys, "profiles")
    assert (status, err) == (0, "")
    assert all(name in out for name in rs.profiles()) and "wheel S1002" in out


def test_shows_the_conicity_of_the_api(capsys):
    status, out, _ = run(capsys, *PAIR, "--inclination", "1:40")
    expected = rs.ContactPair("S1002", "UIC60", inclination=1 / 40).equivalent_conicity(3e-3).conicity[0]
    assert status == 0 and f"{expected:.3f}" in out.splitlines()[-1] and "inclination 1:40, gauge 1435.00 mm" in out


def test_json_and_picture(capsys, tmp_path):
    picture = tmp_path / "pair.png"
    status, out, _ = run(capsys, "profiles", "S1002", "UIC60", "--inclination", "0.05", "--amplitude", "1:3:2mm", "--json", "--plot", str(picture))
    data = json.loads(out)
    assert status == 0 and picture.stat().st_size > 20000
    assert data["amplitude"] == [0.001, 0.003] and data["conicity"][1] == pytest.approx(0.009, abs=5e-4)
    assert data["gauge"] == pytest.approx(1.435)


def test_a_rail_as_it_lies_needs_neither_gauge_nor_inclination(capsys):
    status, out, _ = run(capsys, "profiles", "EN15302_wheel_A", "EN15302_rail_A", "--amplitude", "3mm")
    assert status == 0 and "0.188" in out and "as it lies, gauge 1435.16 mm" in out


@pytest.mark.parametrize("arguments, expected", [
    (["S1003", "UIC60"], "nearest: S1002"), (["UIC60", "S1002"], "is a rail, and a wheel is needed"), (["S1002"], "a rail is needed too"),
    (["S1002", "UIC60", "--inclination", "1:0"], "a slope such as 1:40"), (["S1002", "UIC60", "--gauge", "1435"], "has no unit"),
    (["S1002", "UIC60", "--gauge", "1435m"], "gauge is 1435"), (["S1002", "UIC60", "--amplitude", "3:1:4mm"], "smaller than the last"),
    (["S1002", "UIC60", "--amplitude", "150mm"], "off the rail"), (["S1002", "UIC60", "--incline", "1:40"], "nearest: --inclination")])
def test_errors_are_one_line_with_status_2(capsys, arguments, expected):
    status, out, err = run(capsys, "profiles", *arguments)
    assert status == 2 and out == "" and expected in err and len(err.strip().splitlines()) == 1


def test_elastic_conicity_and_the_table(capsys, tmp_path):
    path = tmp_path / "pair.npz"
    status, out, err = run(capsys, *PAIR, "--inclination", "1:40", "--load", "60kN", "--table", str(path))
    expected = rs.ContactPair("S1002", "UIC60", inclination=1 / 40).equivalent_conicity(3e-3, load=60e3).conicity[0]
    assert (status, err) == (0, "") and "elastic, 60 kN" in out and f"{expected:.3f}" in out
    assert rs.load_contact_table(path).right.lookup([0.0], drop=3e-4).load[0, 0] > 1e4
    status, out, err = run(capsys, *PAIR, "--load", "60mm")
    assert status == 2 and "load" in err
