# SPDX-License-Identifier: BSD-3-Clause
"""``railsym curving``; ``railsym simulate`` with a speed over distance, a run kept in its file, and measured geometry."""

import json

import numpy as np
import pytest

import railsym as rs
from railsym.cli import main
from railsym.cli_curving import quantities
from railsym.cli_values import CommandError

FAST = ["curving", "bogie", "--radius", "600,1500m", "--cant", "100mm", "--law", "polach"]


def test_table_json_and_picture_are_those_of_python(tmp_path, capsys):
    assert main([*FAST, "--cant-deficiency", "0:100:2mm", "--json", str(tmp_path / "c.json"), "--plot", str(tmp_path / "c.png")]) == 0
    shown, data = capsys.readouterr().out, json.loads((tmp_path / "c.json").read_text())
    vehicle = rs.load_vehicle("bogie")
    vehicle = vehicle.configured(next(iter(vehicle.configurations)))
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435)
    found = rs.curving(vehicle, radius=[600.0, 1500.0], cant=0.1, cant_deficiency=[0.0, 0.1], contact=pair, law="polach")
    np.testing.assert_allclose(data["quasi_static"]["Y"], found.Y, atol=1e-6)
    assert data["units"]["t_gamma"] == "N" and data["law"] == "polach" and data["failures"] == []
    assert "S1002 on UIC60, inclination 1:40" in shown and "no verdict" in shown and len(shown.splitlines()) > 10
    assert (tmp_path / "c.png").stat().st_size > 10_000


def test_speeds_and_a_curve_to_the_left(capsys):
    assert main([*FAST, "--speed", "60,80km/h", "--direction", "left", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    np.testing.assert_allclose(data["speed"], [[60 / 3.6] * 2, [80 / 3.6] * 2])
    assert data["quasi_static"]["angle_of_attack"][0][0][0] > data["quasi_static"]["angle_of_attack"][0][1][0] > 0.0


@pytest.mark.parametrize("arguments, message", [
    (["--radius", "wide"], "radius 'wide'"), (["--radius", "250:1500m"], "first:last:count"), (["--radius", "500", "--cant", "150"], "has no unit"),
    (["--radius", "500", "--cant", "150m"], "are the units right"), (["--radius", "500", "--speed", "80km/h", "--cant-deficiency", "9mm"], "one of the two"),
    (["--radius", "500", "--seed", "2"], "goes with --dynamic"), (["--radius", "500", "--load", "60kN"], "linear contact"),
    (["--radius", "-500m"], 'direction="left"'), (["--radius", "500", "--plot", "c.xyz"], "must end in"), ([], "--radius"),
])
def test_errors_are_one_line_with_advice(arguments, message, capsys):
    assert main(["curving", "bogie", *arguments]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and message in error


def test_quantities():
    np.testing.assert_allclose(quantities("250:1500:6", "m", "radius", "m"), np.linspace(250, 1500, 6))
    np.testing.assert_allclose(quantities("0.5km,300m", "m", "radius", "m"), [500.0, 300.0])
    np.testing.assert_allclose(quantities("50,100 mm", "m", "cant"), [0.05, 0.1])
    np.testing.assert_allclose(quantities("-50mm", "m", "cant deficiency"), [-0.05])
    np.testing.assert_allclose(quantities("36:72:2km/h", "m/s", "speed"), [10.0, 20.0])
    with pytest.raises(CommandError, match="has no unit"):
        quantities("50:100:3", "m", "cant")


def test_simulate_with_speed_against_place_on_measured_geometry_into_a_file(tmp_path, capsys):
    s = np.arange(0.0, 401.0, 5.0)
    curvature = np.clip((s - 100.0) / 60.0, 0.0, 1.0) * 2.0
    (tmp_path / "line.csv").write_text("s [m], curvature [1/km], cant [mm]\n" + "\n".join(f"{a}, {b}, {50 * b}" for a, b in zip(s, curvature, strict=True)))
    (tmp_path / "speed.csv").write_text("s [m], speed [km/h]\n0, 90\n100, 90\n250, 72\n")
    command = ["simulate", "bogie", "--track", str(tmp_path / "line.csv"), "--speed", str(tmp_path / "speed.csv"), "--law", "polach", "--save", str(tmp_path / "run.nc")]
    assert main(command) == 0
    shown = capsys.readouterr().out
    assert "speed of speed.csv, track line" in shown and "completed" in shown
    run = rs.Run.from_netcdf(tmp_path / "run.nc", lazy=True)
    assert run["V"][0] == 25.0 and run["V"][-1] == 20.0 and 395.0 < run["s"][-1] + 1.35 <= 400.0
    assert main([*command, "--duration", "60s"]) == 2
    assert "at the speeds of the file" in capsys.readouterr().err
