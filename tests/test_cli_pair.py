# SPDX-License-Identifier: BSD-3-Clause
"""``railsym stability`` and ``railsym modes`` with a pair of profiles, and a vehicle written after a list option."""

import json
import re
from types import SimpleNamespace

import numpy as np
import pytest

import railsym as rs
from railsym import plots
from railsym.cli import main
from railsym.cli_pair import pair_contacts
from railsym.stability_map import join_amplitudes

PAIR = ["--wheel", "S1002", "--rail", "UIC60"]
BOGIE = ["stability", "bogie", "--criterion", "real_part"]


def run(capsys, *arguments):
    status = main(list(arguments))
    return status, *capsys.readouterr()


@pytest.fixture(scope="module")
def pair():
    return rs.ContactPair("S1002", "UIC60", inclination=1 / 40)


def test_speeds_are_those_of_the_contact_of_the_pair(capsys, pair):
    status, out, err = run(capsys, *BOGIE, *PAIR, "--inclination", "1:40", "--gauge", "1435mm", "--amplitude", "2,3,4mm")
    assert (status, err) == (0, "") and "S1002 on UIC60, inclination 1:40, gauge 1435.00 mm" in out
    contacts = [pair.linear_contact(a) for a in (2e-3, 3e-3, 4e-3)]
    assert all(f"{1e3 * c.amplitude:g} mm: {c.conicity:.3f}" in out for c in contacts)
    vehicle = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
    row = next(line for line in out.splitlines() if line.startswith("with_anti_yaw_dampers"))
    # columns are at least two blanks apart; a speed and its frequency stand one apart
    for cell, contact in zip(re.split(" {2,}", row)[1:], contacts, strict=True):
        found = rs.critical_speed(vehicle, contact=contact)
        assert cell.strip() == f"{3.6 * found.speed:.0f} ({found.frequency_hz:.1f})"
    cone = rs.critical_speed(vehicle, contacts[0].conicity, contact=rs.LinearContact(amplitude=2e-3))
    # 7.45 Hz and 7.41 Hz
    assert abs(float(cone.frequency_hz) / float(rs.critical_speed(vehicle, contact=contacts[0]).frequency_hz) - 1.0) > 1e-3, "radii and angles must matter"


def test_json_tells_pair_and_amplitudes(capsys, pair):
    status, out, _ = run(capsys, *BOGIE, *PAIR, "--amplitude", "2:4:2mm", "--friction", "0.4", "--json")
    data = json.loads(out)
    expected = [pair.linear_contact(a, friction=0.4) for a in (2e-3, 4e-3)]
    assert status == 0 and data["pair"]["wheel"] == "S1002" and data["pair"]["amplitude"] == [2e-3, 4e-3]
    assert data["pair"]["contact_angle_parameter"] == [c.contact_angle_parameter for c in expected]
    contact = data["contact"]["with_anti_yaw_dampers"]
    assert contact["friction"] == 0.4 and not {"conicity", "amplitude", "roll_parameter", "rail_transverse_radius"} & set(contact)
    cases = [c for c in data["cases"] if c["configuration"] == "with_anti_yaw_dampers"]
    assert [(c["amplitude"], c["conicity"]) for c in cases] == [(c.amplitude, c.conicity) for c in expected]
    speed = rs.critical_speed(rs.load_vehicle("bogie").configured("with_anti_yaw_dampers"), contact=expected[1]).speed
    assert cases[1]["speed"] == pytest.approx(float(speed), rel=1e-9)       # the same computation twice


def test_wheel_radius_is_that_of_the_vehicle(capsys):
    data = json.loads(run(capsys, "stability", "cooperrider", *PAIR, "--criterion", "real_part", "--json")[1])
    found = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, wheel_radius=0.425).linear_contact(3e-3)
    assert data["pair"]["wheel_radius"] == 0.425 and data["pair"]["conicity"] == [found.conicity]


def test_notes_and_sensitivity_name_the_amplitude(capsys):
    status, out, _ = run(capsys, *BOGIE, *PAIR, "--amplitude", "2,3,4mm", "--speed-range", "20:40km/h", "--sensitivity")
    assert status == 0 and "amplitude 2 mm, 3 mm, 4 mm: none from 20 to 40 km/h" in out
    assert "what moves the critical speed, amplitude 3 mm" in out


def test_vehicle_without_configurations(capsys):
    status, out, _ = run(capsys, "stability", "wheelset", *PAIR, "--criterion", "real_part")
    assert status == 0 and "3 mm: 0.180" in out


def test_modes_take_the_pair(capsys, pair):
    arguments = ["modes", "bogie", *PAIR, "--amplitude", "3mm", "--speed", "60m/s"]
    data = json.loads(run(capsys, *arguments, "--json")[1])
    vehicle = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
    modes = rs.linearise(vehicle, 60.0, pair.linear_contact(3e-3)).modes()
    assert data["modes"] and data["pair"]["rail"] == "UIC60"
    for entry in data["modes"]:
        assert entry["frequency_hz"] == pytest.approx(modes[entry["number"]].frequency_hz, rel=1e-9)
    status, out, _ = run(capsys, *arguments)
    assert status == 0 and out.startswith("S1002 on UIC60, inclination 1:40") and "conicity 0.1804" in out


def test_axes_of_the_drawings_are_amplitudes(pair, capsys, tmp_path):
    vehicle, contacts = rs.load_vehicle("bogie"), [pair.linear_contact(a) for a in (2e-3, 4e-3)]
    maps = [rs.stability_map(vehicle, conicity=[c.conicity], criteria=["real_part"], contact=c) for c in contacts]
    found = join_amplitudes(maps, [2e-3, 4e-3], "this on that")
    assert found.speed.shape == (2, 1, 2) and found.conicity.tolist() == [c.conicity for c in contacts]
    axes = plots.plot_stability_report(found)
    assert axes[0, 0].figure.get_suptitle() == "this on that"
    for row in (0, 1, 3):
        assert axes[row, 0].get_xlabel() == "amplitude, mm; below: conicity"
        assert [t.get_text() for t in axes[row, 0].get_xticklabels()] == [f"{1e3 * c.amplitude:g}\n{c.conicity:.3f}" for c in contacts]
    line = axes[0, 0].get_lines()[0]
    assert np.array_equal(line.get_xdata()[np.isfinite(line.get_xdata())], [2.0, 4.0])
    plain = plots.plot_stability_map(maps[0])
    assert plain[0].get_xlabel() == "equivalent conicity"
    target = tmp_path / "pair.png"
    assert run(capsys, *BOGIE, *PAIR, "--plot", str(target))[0] == 0 and target.stat().st_size > 20_000


@pytest.mark.parametrize("arguments, expected", [
    ([*BOGIE, *PAIR, "--conicity", "0.2"], "leave out --conicity"), ([*BOGIE, "--wheel", "S1003", "--rail", "UIC60"], "nearest: S1002"),
    ([*BOGIE, "--wheel", "S1002", "--rail", "UIC6"], "nearest: UIC60"), ([*BOGIE, "--wheel", "UIC60", "--rail", "S1002"], "is a rail, and a wheel"),
    ([*BOGIE, "--wheel", "S1002"], "a rail is needed too"), ([*BOGIE, "--rail", "UIC60"], "a wheel is needed too"),
    ([*BOGIE, "--gauge", "1435mm"], "--gauge goes with profiles"), ([*BOGIE, "--inclination", "1:40"], "--inclination goes with profiles"),
    ([*BOGIE, "--amplitude", "2,3mm"], "several amplitudes need profiles"), ([*BOGIE, *PAIR, "--amplitude", "3,2mm"], "larger than the one before"),
    ([*BOGIE, *PAIR, "--amplitude", "0mm"], "must be positive"), ([*BOGIE, *PAIR, "--amplitude", "2,3"], "has no unit"),
    ([*BOGIE, *PAIR, "--amplitude", "100mm"], "off the rail"),
    ([*BOGIE, *PAIR, "--flange-back-distance", "1340mm"], "--flange-back-distance 1360mm"), ([*BOGIE, *PAIR, "--inclination", "1:0"], "such as 1:40"),
    (["modes", "bogie", *PAIR, "--speed", "50m/s", "--amplitude", "2,3mm"], "one amplitude"),
    (["modes", "bogie", *PAIR, "--speed", "50m/s", "--conicity", "0.2"], "leave out --conicity")])
def test_errors_are_one_line_with_status_2(capsys, arguments, expected):
    status, out, err = run(capsys, *arguments)
    assert status == 2 and out == "" and expected in err and len(err.strip().splitlines()) == 1, err


def test_wheelsets_of_different_radii_are_refused():
    options = SimpleNamespace(wheel="S1002", rail="UIC60", conicity=None)
    with pytest.raises(ValueError, match="425, 460 mm"):
        pair_contacts(options, [rs.load_vehicle("bogie"), rs.load_vehicle("cooperrider")])


@pytest.mark.parametrize("arguments", [
    ["--configuration", "with_anti_yaw_dampers", "bogie"], ["--criterion", "real_part", "bogie", "--configuration", "with_anti_yaw_dampers"],
    ["--configuration", "with_anti_yaw_dampers", "--speed-range", "20:700", "km/h", "bogie"], ["--conicity", "0.2", "bogie"],
    ["--conicity", "0.2", "--sensitivity", "bogie", "--configuration", "with_anti_yaw_dampers"]])
def test_the_vehicle_may_stand_after_a_list(capsys, arguments):
    more = [] if "--criterion" in arguments else ["--criterion", "real_part"]
    status, out, err = run(capsys, "stability", *more, *arguments)
    assert (status, err) == (0, "") and out.startswith("bogie") and "with_anti_yaw_dampers" in out
    assert run(capsys, "modes", "--speed", "200", "km/h", "bogie")[0] == 0


def test_a_file_may_stand_after_a_list_and_a_misspelt_vehicle_is_told(capsys, tmp_path):
    from railsym.vehicle import SHIPPED

    source = tmp_path / "mine.toml"
    source.write_text((SHIPPED / "bogie.toml").read_text())
    status, out, _ = run(capsys, "stability", "--conicity", "0.2", "--configuration", "with_anti_yaw_dampers", str(source))
    assert status == 0 and "without_anti_yaw_dampers" not in out
    status, out, err = run(capsys, "stability", "--configuration", "AS_K", "pendolin")
    assert (status, out) == (2, "") and "VEHICLE is missing" in err and "'pendolin'" in err and "railsym stability VEHICLE --configuration" in err


def test_elastic_contact_under_a_load(capsys, pair):
    status, out, err = run(capsys, *BOGIE, *PAIR, "--inclination", "1:40", "--load", "60kN")
    assert (status, err) == (0, "") and f"3 mm: {pair.linear_contact(3e-3, 60e3).conicity:.3f}" in out
    status, _, err = run(capsys, *BOGIE, "--load", "60kN")
    assert status == 2 and "--load goes with profiles" in err
