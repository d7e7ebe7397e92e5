# SPDX-License-Identifier: BSD-3-Clause
"""railsym simulate: table, files, pictures, errors."""

import json

import numpy as np
import pytest

import railsym as rs
from railsym.cli import main

SHORT = ["simulate", "pendolino", "--configuration", "AS_K", "--speed", "200km/h", "--duration", "1s"]


def run(capsys, *arguments):
    """Exit status, standard output and standard error."""
    status = main(arguments)
    return status, *capsys.readouterr()


def test_the_table_is_that_of_the_run(capsys, tmp_path):
    target = tmp_path / "run.nc"
    status, out, err = run(capsys, *SHORT, "--irregularity", "erri_b176_low", "--save", str(target), "--plot", str(tmp_path / "run.png"))
    assert (status, err) == (0, "")
    saved = rs.Run.from_netcdf(target)
    vehicle = rs.load_vehicle("pendolino").configured("AS_K")
    table = rs.ContactPair("S1002", "UIC60", inclination=1 / 40).table(deepest=6e-4)
    # the command makes the track as long as the run needs, and 5 m
    length = max(body.position[0] for body in vehicle.bodies) + 200 / 3.6 + 5.0
    track = rs.Track.straight(length).with_irregularity("erri_b176_low", seed=1)
    expected = rs.simulate(vehicle, speed=200 / 3.6, duration=1.0, track=track, contact=table)
    assert list(saved.channels) == list(expected.channels)
    for name in saved.channels:
        np.testing.assert_array_equal(saved[name], expected[name])
    rows = {line[:47].strip(): line.split() for line in out.splitlines()}
    largest = max((np.abs(saved[name]).max(), name) for name in saved.channels.match("*.above_*.ay"))
    line = next(words for what, words in rows.items() if what.startswith("largest bogie frame"))
    assert f"{largest[0]:.2f}" in line and largest[1] in line
    worst = rs.criteria.derailment(saved).worst("Y/Q")
    line = next(words for what, words in rows.items() if what.startswith("largest Y/Q"))
    assert f"{worst.value:.3f}" in line and worst.name.split()[-1] in line
    assert "running stability: stable" in out and "the run: completed at t = 1 s" in out and "erri_b176_low (seed 1)" in out
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")


def test_json_holds_si_numbers_and_nothing_else(capsys):
    status, out, _ = run(capsys, *SHORT[:-1], "0.8s", "--conicity", "0.2", "--json")
    data = json.loads(out)
    assert status == 0 and data["status"] == "completed" and data["speed"] == pytest.approx(200 / 3.6)
    assert data["creep_law"] == "linear" and data["running_stability"]["unstable"] is False
    assert {entry["unit"] for entry in data["quantities"]} == {"m/s^2", "m"}


def test_a_run_that_stopped_is_not_called_stable():
    from railsym.cli_run_table import as_data, run_table

    time = np.arange(0.0, 3.0, 0.005)
    name = "bogie1.above_wheelset1_left.ay"
    for size, verdict in ((1.0, None), (9.0, True)):
        values = {name: size * np.sin(2.0 * np.pi * 5.0 * time), "s": 50.0 * time}
        made = rs.Run.from_arrays(time, values, {name: "m/s^2", "s": "m"}, ending=rs.results.Ending("not_converged"))
        assert as_data(made)["running_stability"]["unstable"] is verdict
        assert ("no verdict, because the run stopped" in run_table(made)) is (verdict is None)


def test_a_run_too_short_for_a_verdict_says_so(capsys):
    status, out, _ = run(capsys, *SHORT[:-1], "0.2s", "--conicity", "0.2")
    assert status == 0 and "running stability: no verdict" in out and "0.75 s" in out


def test_track_by_name_and_to_its_end(capsys, tmp_path):
    file = tmp_path / "short.toml"
    rs.Track.straight(50.0, name="short").to_toml(file)
    target = tmp_path / "run.csv"
    status, out, _ = run(capsys, *SHORT[:-2], "--track", str(file), "--conicity", "0.2", "--save", str(target), "--channels", "car.z")
    assert status == 0 and "track short" in out
    saved = rs.Run.from_csv(target)
    vehicle = rs.load_vehicle("pendolino")
    ahead = max(body.position[0] for body in vehicle.bodies)
    # the foremost body comes within two steps of the end; the last sample is up to 5 ms older
    assert 50.0 - 200 / 3.6 * 7e-3 < saved["s"][-1] + ahead <= 50.0
    assert "car.z" in saved.channels


def test_animation(capsys, tmp_path):
    target = tmp_path / "run.gif"
    status, out, _ = run(capsys, *SHORT[:-1], "0.3s", "--conicity", "0.2", "--animate", str(target),
                         "--animate-range", "0.1:0.2s", "--animate-frames", "4", "--animate-factor", "30")
    assert status == 0 and "motions times 30" in out and target.read_bytes().startswith(b"GIF")


def test_channels_can_be_listed(capsys):
    status, out, _ = run(capsys, *SHORT, "--channels", "list")
    assert status == 0 and "wheelset1.left.Q  [N]" in out and "bogie1.above_wheelset1_left.ay  [m/s^2]" in out


@pytest.mark.parametrize("arguments, words", [
    (["--speed", "200"], "has no unit: write 200km/h"),
    (["--speed", "0km/h"], "above 0"),
    (["--speed", "-20km/h"], "above 0"),
    (["--speed", "50:60:2km/h"], "one speed"),
    (["--speed", "200km/h", "--channels", "wheelset1.left.QQ"], "near: wheelset1.left.Q"),
    (["--speed", "200km/h", "--track", "s_curve_500", "--duration", "30s"], "1000 m long, and 30 s at 200 km/h take 1666.67 m"),
    (["--speed", "200km/h", "--track", "s_curve_50"], "s_curve_500"),
    (["--speed", "200km/h", "--duration", "0s"], "above 0 s"),
    (["--speed", "200km/h", "--duration", "10"], "has no unit"),
    (["--speed", "200km/h", "--law", "fastsimm"], "fastsim"),
    (["--speed", "200km/h", "--irregularity", "erri_b176"], "erri_b176_low"),
    (["--speed", "200km/h", "--seed", "2"], "--irregularity"),
    (["--speed", "200km/h", "--conicity", "0.2", "--law", "polach"], "--conicity"),
    (["--speed", "200km/h", "--conicity", "0.2", "--irregularity", "erri_b176_low"], "does not see"),
    (["--speed", "200km/h", "--conicity", "0.2", "--wheel", "S1002", "--rail", "UIC60"], "leave out --conicity"),
    (["--speed", "200km/h", "--save", "run.txt"], ".nc, .csv, .mat"),
    (["--speed", "200km/h", "--save", "nowhere/run.nc"], "no directory"),
    (["--speed", "200km/h", "--animate", "run.avi"], ".gif or .mp4"),
    (["--speed", "200km/h", "--animate-range", "1:2s"], "--animate FILE"),
])
def test_errors_say_what_to_do(capsys, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    status, out, err = run(capsys, "simulate", "pendolino", *arguments)
    assert status == 2 and out == "" and err.startswith("railsym: ") and words in err and err.count("\n") == 1
    assert not list(tmp_path.iterdir())
