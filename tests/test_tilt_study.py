# SPDX-License-Identifier: BSD-3-Clause
"""The tilting study: closed forms, what active tilt and its improvements do, faults end reported, the command and its pictures."""

import json

import numpy as np
import pytest

import railsym as rs
from railsym.cli import main
from railsym.studies import tilt_figures as figures
from railsym.studies.tilt import tilt_study
from railsym.studies.tilt_report import as_data, steady_rows
from railsym.tilt import TiltError

SPEED = 105.0 / 3.6
SHORT = """
[track]
name = "short_s"
[[sections]]
type = "straight"
length = [30, "m"]
[[sections]]
type = "transition"
length = [50, "m"]
[[sections]]
type = "curve"
radius = [500, "m"]
length = [90, "m"]
cant = [100, "mm"]
direction = "right"
[[sections]]
type = "transition"
length = [50, "m"]
[[sections]]
type = "straight"
length = [120, "m"]
"""


@pytest.fixture(scope="module")
def track(tmp_path_factory):
    path = tmp_path_factory.mktemp("tilt") / "short.toml"
    path.write_text(SHORT)
    return path


@pytest.fixture(scope="module")
def study(track):
    vehicle = rs.load_vehicle("pendolino_tilting").configured("AS_K")
    return tilt_study(vehicle, rs.track.load_track(str(track)), law="polach", compiled=True)


def test_steady_curve_is_that_of_the_closed_forms(study):
    """a_nc by the forces on the rails, the bogie frame (whose springs roll outwards, 3 to 5 %), and the floor by the roll of the body: 2 %."""
    for row in steady_rows(study):
        assert row["closed form"] == pytest.approx(SPEED ** 2 / 500.0 - 9.81 * 0.1 / 1.5, rel=1e-6)
        assert row["sum Y over mass"] == pytest.approx(row["closed form"], rel=0.02)
        assert row["floor"] == pytest.approx(row["floor, V^2/R cos - g sin"], rel=0.02)
        assert 1.0 < row["bogie frame"] / row["closed form"] < 1.06


def test_active_tilt_spares_the_share_and_lags(study):
    passive, active = study["passive"], study["active"]
    for name in ("front", "middle", "rear", "seat"):
        assert active.ride[name]["peak"] < 0.75 * passive.ride[name]["peak"]
    level = 0.6 * np.arctan(steady_rows(study)[0]["closed form"] / 9.81)
    assert np.abs(active.tilt).max() == pytest.approx(level, rel=0.08)
    p = study.parameters
    lag = p.filter_delay(p.lateral_cutoff) + p.latency + p.follow_delay - p.ahead / SPEED
    assert active.delay == pytest.approx(lag, abs=0.06)
    assert np.isnan(passive.delay) and passive.state is None and not active.reports


def test_improvements_come_closer_to_a_perfect_tilt(study):
    active = study["active"]
    for name in ("detection", "leading", "database, exact"):
        better = study[name]
        assert abs(better.delay) < 0.6 * active.delay
        assert better.ride["front"]["over_rms"] < active.ride["front"]["over_rms"]
    assert study["database"].delay - study["database, exact"].delay == pytest.approx(5.0 / SPEED, abs=0.02)


def test_forces_on_rails_hardly_change(study):
    """The body's centre of mass moves with the linkage by some centimetres: a few per cent."""
    passive, active = study["passive"].rails, study["active"].rails
    assert active["Y/Q"] == pytest.approx(passive["Y/Q"], rel=0.1)
    for name, value in active["sum_Y"].items():
        assert value == pytest.approx(passive["sum_Y"][name], rel=0.12, abs=1e3)


def test_lag_of_a_shifted_signal_is_its_shift():
    time = np.linspace(0.0, 20.0, 4001)
    ideal = np.clip(np.minimum(time - 5.0, 14.0 - time), 0.0, 2.0)
    for shift in (-0.31, 0.0, 0.247):
        assert figures.lag(time, 0.93 * np.interp(time - shift, time, ideal), ideal) == pytest.approx(shift, abs=0.003)
    assert np.isnan(figures.lag(time, 0.0 * time, ideal))


def test_parts_of_a_track(study):
    parts = figures.TrackParts.of(study.scene.track)
    assert np.allclose(parts.transitions, [(30.0, 80.0), (170.0, 220.0)], atol=1.0) and np.allclose(parts.curves, [(80.0, 170.0)], atol=1.0)


def test_report_and_data_say_the_same(study):
    text, data = str(study), json.loads(json.dumps(as_data(study)))
    assert "gain margin" in text and "short_s, 105 km/h" in text
    assert [case["name"] for case in data["cases"]] == ["passive", "active", "detection", "leading", "database", "database, exact"]
    assert data["cases"][1]["ride"]["front"]["peak"] == study["active"].ride["front"]["peak"]
    with pytest.raises(TiltError, match="no case 'agile'"):
        study["agile"]


@pytest.mark.slow
def test_fault_cases_end_in_reported_states(track):
    study = tilt_study(rs.load_vehicle("pendolino_tilting").configured("AS_K"), rs.track.load_track(str(track)), law="polach", improvements=False, faults=True)
    ends = {case.name: case.end for case in study.faults}
    assert ends == {"bias": "degraded", "accelerometer": "degraded", "frozen": "degraded", "gyroscope": "degraded", "gyroscope bias": "degraded",
                    "accelerometers": "safe", "odometer": "safe", "tilt sensor": "degraded", "saturation": "failed", "stuck": "failed", "free": "failed",
                    "damped": "failed", "half stuck": "failed"}
    assert all(case.reports and case.run.status == "completed" for case in study.faults)
    assert max(np.abs(case.tilt).max() for case in study.faults) < np.radians(8.2)
    assert "half stuck" in str(study)


def test_command_draws_and_writes(track, tmp_path, capsys):
    picture, data, moving = tmp_path / "tilt.png", tmp_path / "tilt.json", tmp_path / "tilt.gif"
    assert main(["tilt", "pendolino_tilting", "--configuration", "AS_K", "--track", str(track), "--no-improvements", "--law", "polach", "--irregularity", "erri_b176_low",
                 "--plot", str(picture), "--json", str(data), "--animate", str(moving), "--animate-frames", "4"]) == 0
    said = capsys.readouterr().out
    assert "105 km/h" in said and "passive" in said and "4 pictures" in said
    assert picture.stat().st_size > 5e4 and moving.stat().st_size > 1e4
    found = json.loads(data.read_text())
    assert found["cases"][1]["state"] == "normal" and found["cases"][0]["demand"] is None


@pytest.mark.parametrize("options, text", [
    (["pendolino"], "has no actuators to tilt it; pendolino_tilting has"), (["pendolino_tilting", "--share=-1"], "share = -1.0"),
    (["pendolino_tilting", "--speed=-20km/h"], "a speed above 0 is needed"), (["pendolino_tilting", "--track", "lost"], "track 'lost' is unknown"),
    (["pendolino_tilting", "--rate", "300Hz"], "latency 0.02 s: a whole number of samples|whole number of steps"), (["pendolino_tilting", "--shares", "1"], "nearest: --share"),
    (["pendolino_tilting", "--animate", "x.avi"], ".gif or .mp4")])
def test_command_refuses(options, text, capsys):
    import re

    assert main(["tilt", *options]) == 2
    assert re.search(text, capsys.readouterr().err)
