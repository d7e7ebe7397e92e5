# SPDX-License-Identifier: BSD-3-Clause
"""The switch study: what it makes of a run, how it finds the threshold, and the paper's case."""

from dataclasses import replace

import numpy as np
import pytest

import railsym as rs
from railsym.errors import SimulationError
from railsym.studies import SWITCH, switch_study, switch_threshold, variants
from railsym.studies import switch_threshold as threshold_function
from railsym.studies.quasi_linear import hunting_mode, mean_wheel_load, quasi_linear
from railsym.studies.switch import default_pair, linear_reference
from railsym.studies.switch_run import cross, judged, switch_track

FRAME = "bogie1.above_wheelset1_left.ay"


@pytest.fixture(scope="module")
def vehicle():
    return rs.load_vehicle("pendolino").configured("noAS_K")


@pytest.fixture(scope="module")
def pair(vehicle):
    return default_pair(vehicle)


def made_run(acceleration, shift, status="completed"):
    """A run of 8 s with these functions of time."""
    time = np.arange(0.0, 8.0, 0.005)
    values = {"s": 60.0 * time, "V": 60.0 + 0.0 * time, FRAME: acceleration(time), "wheelset1.y": shift(time)}
    units = {"s": "m", "V": "m/s", FRAME: "m/s^2", "wheelset1.y": "m"}
    ending = rs.results.Ending(status)
    return rs.Run.from_arrays(time, values, units, ending=ending)


def wave(size, rate=0.0, frequency=5.5):
    return lambda t: size * np.exp(rate * t) * np.sin(2.0 * np.pi * frequency * t)


@pytest.mark.parametrize("rate, fate", [(0.0, "goes on"), (-0.4, "decays"), (0.2, "grows"), (-1.5, "dies out")])
def test_what_becomes_of_the_motion_is_read_from_the_run(rate, fate):
    found = judged(made_run(wave(9.0, rate), wave(3e-3, rate)), 60.0, 0.9, 1.0)
    assert found.fate == fate
    assert found.frequency_hz == pytest.approx(5.5, abs=0.05)        # resolution 0.3 Hz, located between lines
    assert found.growth == pytest.approx(rate, abs=0.02)             # peaks are read at samples: 9 of them a half-wave
    # largest in the 1.5 s behind 1.3 s; half of the distance of extremes that are half a period apart, up to a period from the end
    start = 1.3 if rate <= 0.0 else 2.8
    assert found.motion == pytest.approx(3e-3 * np.exp(rate * start), rel=0.01 + abs(rate) / 5.5)


def test_the_verdict_is_that_of_the_criterion():
    over, under = (judged(made_run(wave(size), wave(1e-3)), 60.0, 0.9, 1.0) for size in (8.3, 7.7))
    assert (over.unstable, under.unstable) == (True, False)
    assert over.worst.sustained == pytest.approx(8.3, rel=0.02)


def test_a_run_that_stopped_has_no_verdict_unless_it_derailed_or_was_unstable_before():
    quiet = made_run(wave(1.0), wave(1e-3), "not_converged")
    assert judged(quiet, 60.0, 0.9, 1.0).unstable is None
    assert judged(made_run(wave(9.0), wave(1e-3), "not_converged"), 60.0, 0.9, 1.0).unstable is True
    assert judged(made_run(wave(1.0), wave(1e-3), "derailed"), 60.0, 0.9, 1.0).unstable is True
    short = rs.Run(quiet.time[:60], {n: quiet[n][:60] for n in quiet.channels}, quiet.channels, quiet.info)     # 0.3 s
    found = judged(short, 60.0, 0.9, 1.0)
    assert found.unstable is None and found.worst is None and found.fate == "not converged"


class Answers:
    """Stands for a crossing: unstable where the function says so."""

    def __init__(self, verdict):
        self.verdict, self.asked = verdict, []

    def __call__(self, vehicle, contact, switch, speed, *, reference, after, **_):
        self.asked.append(speed / reference)
        unstable = self.verdict(speed / reference)
        made = made_run(wave(9.0 if unstable else 1.0), wave(1e-3), "completed" if unstable is not None else "not_converged")
        return judged(made, speed, speed / reference, 1.0)


def answered(monkeypatch, verdict, **options):
    import railsym.studies.switch_threshold  # noqa: F401
    import sys

    answers = Answers(verdict)
    monkeypatch.setattr(sys.modules["railsym.studies.switch_threshold"], "cross", answers)
    return switch_threshold(None, None, SWITCH, reference=70.0, after=4.0, **options), answers


def test_threshold_is_bracketed(monkeypatch):
    found, answers = answered(monkeypatch, lambda ratio: ratio > 0.873, tolerance=0.005)
    low, high = found.bracket
    assert low <= 0.873 < high and high - low <= 0.005 and found.monotone
    assert len(answers.asked) == len(set(answers.asked))             # no speed is run twice
    assert "km/h" in found.message and f"{3.6 * 70.0 * low:.1f}" in found.message


def test_verdicts_that_turn_back_are_told(monkeypatch):
    found, _ = answered(monkeypatch, lambda ratio: 0.82 < ratio < 0.97, ratios=[0.8, 0.9, 1.0])
    assert not found.monotone and "stable again at 1.00 V0" in found.message
    assert found.bracket[0] <= 0.82 < found.bracket[1]


@pytest.mark.parametrize("always", [True, False])
def test_a_verdict_that_never_turns(monkeypatch, always):
    found, _ = answered(monkeypatch, lambda ratio: always, ratios=[0.8, 0.9])
    assert np.isnan(found.ratio) and found.message == f"{'unstable' if always else 'stable'} at all speeds from 0.80 to 0.90 V0"


def test_no_verdict_is_an_error_and_not_stable(monkeypatch):
    with pytest.raises(SimulationError, match="no verdict at 0.900 V0"):
        answered(monkeypatch, lambda ratio: None if ratio > 0.85 else False, ratios=[0.8, 0.9])


@pytest.mark.parametrize("options, words", [({"ratios": [0.9]}, "at least two"), ({"ratios": [0.9, 0.8]}, "ascending"), ({"tolerance": 0.0}, "tolerance")])
def test_bad_scans_are_refused(options, words):
    with pytest.raises(SimulationError, match=words):
        threshold_function(None, None, SWITCH, reference=70.0, after=4.0, **options)


def test_reference_is_the_critical_speed_of_the_pair(vehicle, pair):
    contact, found = linear_reference(vehicle, pair)
    assert contact.conicity == pytest.approx(0.180, abs=0.002)       # REFERENCE: S1002/UIC 60, 1:40, 3 mm
    assert float(found.speed) == pytest.approx(float(rs.critical_speed(vehicle, contact=pair.linear_contact(3e-3)).speed), rel=1e-12)
    low = rs.load_vehicle("pendolino").configured("AS_K")
    assert float(linear_reference(low, pair)[1].speed) > 1.3 * float(found.speed)


def test_quasi_linear_theory_at_one_amplitude_is_the_critical_speed(vehicle, pair):
    load = mean_wheel_load(vehicle)
    found, elastic = quasi_linear(vehicle, pair, (None, load), amplitudes=[1e-3, 3e-3])
    expected = rs.critical_speed(vehicle, contact=pair.linear_contact(3e-3))
    assert found["speed"][1] == pytest.approx(float(expected.speed), rel=1e-12)
    mode = hunting_mode(vehicle, pair, found["speed"][1], 3e-3)
    assert mode.frequency_hz == pytest.approx(float(expected.frequency_hz), rel=1e-6) and abs(mode.damping_ratio) < 1e-6
    assert load == pytest.approx(9.81 * 51768 / 8, rel=2e-3)         # mass of the vehicle (docs/pendolino.md)
    # REFERENCE: conicity at 1 mm falls from 0.37 (rigid) to 0.22 (60 kN)
    assert found["conicity"][0] == pytest.approx(0.37, abs=0.01)
    assert elastic["conicity"][0] == pytest.approx(0.22, abs=0.012)
    expected = rs.critical_speed(vehicle, contact=pair.linear_contact(1e-3, load))
    assert elastic["speed"][0] == pytest.approx(float(expected.speed), rel=1e-12) and elastic["speed"][0] > found["speed"][0]
    assert hunting_mode(vehicle, pair, 60.0, 1e-6) is None


def test_crossings_below_and_above_the_threshold(vehicle, pair):
    contact, found = linear_reference(vehicle, pair)
    V0, table = float(found.speed), pair.table(deepest=6e-4)
    calm, wild = (cross(vehicle, table, SWITCH, ratio * V0, reference=V0, after=3.4) for ratio in (0.80, 1.05))
    assert (calm.unstable, wild.unstable) == (False, True)
    assert calm.fate in ("decays", "dies out") and wild.fate == "goes on"
    assert wild.motion > 5e-3 and wild.worst.cycles > 15
    mode = hunting_mode(vehicle, pair, calm.speed, calm.mean_motion, mean_wheel_load(vehicle))
    # the quasi-linear amplitude stands for a motion that decays from 2 to 0.1 mm; on 6 s 1.4 %
    assert calm.frequency_hz == pytest.approx(mode.frequency_hz, rel=0.04)


def test_bad_studies_are_refused(vehicle):
    for ratios in ([], [0.9, -0.1], [np.nan]):
        with pytest.raises(SimulationError, match="ratios"):
            switch_study(vehicle, ratios=ratios)
    with pytest.raises(SimulationError, match="behind the switch"):
        switch_study(vehicle, ratios=[0.9], after=1.0, threshold=False)


def test_track_and_variants():
    track = switch_track(SWITCH, 100.0)
    assert track.rails(25.0).left_y == pytest.approx(5e-3, rel=1e-6) and track.rails(60.0).right_y == 0.0
    found = variants()
    assert len(set(found)) == len(found) and SWITCH not in found


@pytest.mark.slow
def test_the_paper_s_case(vehicle, tmp_path):
    """Stable at 0.85 V0 and unstable above a threshold, at the frequency of the linear mode; docs/switch_study.md."""
    study = switch_study(vehicle, ratios=(0.85, 0.9, 1.0))
    assert [run.unstable for run in study.runs] == [False, False, True, True]
    # hunting on the treads: measured 0.2 and 0.5 % off the mode, 0.2 mm off the amplitude that neither grows nor decays
    for run, mode in zip(study.runs[:2], study.modes):
        assert run.frequency_hz == pytest.approx(mode.frequency_hz, rel=0.02)
    treads = slice(0, 9)                                             # 0.5 to 4.5 mm, where speed rises with amplitude
    amplitude = np.interp(0.9 * study.reference, study.elastic["speed"][treads], study.elastic["amplitude"][treads])
    assert study.runs[1].fate == "goes on" and study.runs[1].late_motion == pytest.approx(amplitude, abs=4e-4)
    assert 0.93 < study.threshold.ratio < 1.0 and study.threshold.monotone
    limit_cycle = study.runs[-1]
    assert limit_cycle.ratio == 1.0 and limit_cycle.fate == "goes on"
    assert limit_cycle.frequency_hz == pytest.approx(study.frequency_hz, rel=0.06)
    text = str(study)
    assert "stable" in text and "V0 = 264.3 km/h" in text and "the paper" in text
    import matplotlib

    matplotlib.use("Agg")
    from railsym.plots.style import save

    for name, draw in (("a.png", study.plot), ("b.png", study.plot_quasi_linear)):
        save(draw(), tmp_path / name)
        assert (tmp_path / name).stat().st_size > 20_000


@pytest.mark.slow
def test_a_mirrored_switch_gives_the_same_verdict(vehicle, pair):
    V0, table = float(linear_reference(vehicle, pair)[1].speed), pair.table(deepest=6e-4)
    one, other = (cross(vehicle, table, switch, 0.95 * V0, reference=V0, after=3.4) for switch in (SWITCH, replace(SWITCH, amplitude=-SWITCH.amplitude)))
    assert other.worst.sustained == pytest.approx(one.worst.sustained, rel=1e-6)
    assert other.frequency_hz == pytest.approx(one.frequency_hz, rel=1e-6)
