# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces and body accelerations on signals whose answers are known."""

import numpy as np
import pytest

import railsym as rs
from railsym.criteria import CriterionError
from railsym.results import RunInfo

criteria = rs.criteria
RATE, SPEED, Q0 = 500.0, 50.0, 60e3
TIME = np.arange(10_000) / RATE
WHEELS = ("wheelset1.left", "wheelset1.right")


def a_run(**changed):
    """Q of 60 kN with 5 kN at 3 Hz, opposite on the two sides; Y of +12 and -6 kN."""
    wave = 5e3 * np.sin(2 * np.pi * 3.0 * TIME)
    values = {"wheelset1.left.Q": Q0 + wave, "wheelset1.right.Q": Q0 - wave, "wheelset1.left.Y": np.full(TIME.size, 12e3),
              "wheelset1.right.Y": np.full(TIME.size, -6e3)} | {name.replace("__", "."): value for name, value in changed.items()}
    units = {name: "N" for name in values}
    return rs.Run.from_arrays(TIME, values, units, speed=SPEED)


def test_steady_forces_give_their_quotients_and_sums():
    found = criteria.derailment(a_run(wheelset1__left__Q=np.full(TIME.size, Q0)), wheel_load=Q0)
    assert found["Y/Q wheelset1.left"].value == pytest.approx(0.2, rel=1e-9)
    assert found["sum Y wheelset1"].value == pytest.approx(6e3, rel=1e-9)
    assert found["sum Y wheelset1"].limit.value == pytest.approx(10e3 + 40e3)
    assert found["Y quasi-static wheelset1.right"].value == pytest.approx(-6e3, rel=1e-9)
    assert found["unloading wheelset1.left"].value == pytest.approx(0.0, abs=1e-9)
    assert found["Y/Q wheelset1.left"].verdict == "within the limit 0.8 (V2)" and "no verdict" in found["sum Y wheelset1"].verdict


def test_percentiles_of_a_moving_wheel_load():
    """The arcsine distribution of a sine has its 99.85 percentile at sin(pi (0.9985 - 1/2)) = 0.99999 of the amplitude."""
    found = criteria.derailment(a_run(), wheel_load=Q0, vehicle_speed=200 / 3.6)
    gain = abs(criteria.Butterworth(0.0, 20.0).response([3.0], RATE)[0])
    # the ends of the record swing in: 0.1 %
    assert found["Q wheelset1.left"].value == pytest.approx(Q0 + 5e3 * gain, rel=1e-3)
    assert found["unloading wheelset1.right"].value == pytest.approx(5e3 * gain / Q0, rel=5e-3)
    assert found["Q quasi-static wheelset1.left"].value == pytest.approx(Q0, rel=1e-3)
    assert found["Q wheelset1.left"].limit.value == 150e3 and "no verdict" in found["Q wheelset1.left"].verdict


def test_two_metre_mean_takes_the_edge_off_a_short_blow():
    """Y of 60 kN over 0.5 m at 50 m/s would be Y/Q = 1; its 2 m mean is about a quarter of it."""
    distance = SPEED * TIME
    blow = np.where((distance >= 400.0) & (distance < 400.5), 60e3, 0.0)
    steady = {"wheelset1__left__Q": np.full(TIME.size, Q0), "wheelset1__left__Y": blow}
    found = criteria.derailment(a_run(**steady), wheel_load=Q0)
    top = found.signals["Y/Q wheelset1.left"]
    # 20 Hz is 2.5 m at 50 m/s, so the low-pass spreads the blow beyond the window; its integral over distance stays
    assert 0.2 < top.max() < 0.27
    assert top.sum() * 0.5 == pytest.approx(0.5, rel=0.02)
    slow = criteria.derailment(a_run(**steady), wheel_load=Q0, speed=2.0)  # at 2 m/s the same 10 ms are 0.02 m
    assert slow.signals["Y/Q wheelset1.left"].max() == pytest.approx(0.01, rel=0.02)


def test_percentile_lets_a_single_window_pass_and_sections_do_not():
    distance = SPEED * TIME
    blow = np.where((distance >= 400.0) & (distance < 402.0), 60e3, 0.0)
    run = a_run(wheelset1__left__Q=np.full(TIME.size, Q0), wheelset1__left__Y=blow)
    whole = criteria.derailment(run, wheel_load=Q0)["Y/Q wheelset1.left"].value
    parts = criteria.derailment(run, wheel_load=Q0, sections=100.0)
    assert parts["Y/Q wheelset1.left"].value > 1.02 * whole
    assert parts.statistics["Y/Q wheelset1.left"].values.shape == (9, 2)


def test_a_lifted_wheel_has_no_quotient_and_is_named():
    load = np.where((TIME > 8.0) & (TIME < 8.5), -1.0, Q0)
    found = criteria.derailment(a_run(wheelset1__left__Q=load), wheel_load=Q0)
    assert found["Y/Q wheelset1.left"].value == np.inf and found["Y/Q wheelset1.left"].over
    assert any(note.startswith("wheelset1.left lifts at s = 40") for note in found.notes)
    assert np.isfinite(found["Y/Q wheelset1.right"].value) and not np.isnan(found.signals["Y/Q wheelset1.left"]).any()
    assert found["unloading wheelset1.left"].value > 0.99


def test_quasi_static_limits_only_in_curves():
    run = a_run()
    assert criteria.derailment(run, wheel_load=Q0)["Y quasi-static wheelset1.left"].limit is None
    assert criteria.derailment(run, wheel_load=Q0, radius=600.0)["Y quasi-static wheelset1.left"].limit.value == 60e3
    assert criteria.derailment(run, wheel_load=Q0, radius=-250.0)["Y quasi-static wheelset1.left"].limit.value == pytest.approx(72e3)
    with pytest.raises(CriterionError, match="radius = 0 m"):
        criteria.derailment(run, radius=0.0)


def test_static_loads_by_wheel_from_the_run_or_assumed():
    assert any("medians of Q" in note for note in criteria.derailment(a_run()).notes)
    run = a_run().with_info(extra={"wheel_loads": {WHEELS[0]: 50e3, WHEELS[1]: 70e3}})
    found = criteria.derailment(run)
    assert found.wheel_load == {WHEELS[0]: 50e3, WHEELS[1]: 70e3} and found.notes == ()
    assert found["sum Y wheelset1"].limit.value == pytest.approx(10e3 + 40e3)
    with pytest.raises(CriterionError, match="no entry for wheelset1.right; it has wheelset1.left"):
        criteria.derailment(a_run(), wheel_load={WHEELS[0]: 50e3})
    with pytest.raises(CriterionError, match="must be above 0"):
        criteria.derailment(a_run(), wheel_load=0.0)


def test_mirrored_forces_give_mirrored_values():
    run = a_run(wheelset1__left__Y=12e3 + 4e3 * np.sin(2 * np.pi * 2 * TIME))
    mirrored = {f"wheelset1__{a}__{force}": (-1 if force == "Y" else 1) * run[f"wheelset1.{b}.{force}"]
                for a, b in (("left", "right"), ("right", "left")) for force in "QY"}
    one, other = criteria.derailment(run, wheel_load=Q0), criteria.derailment(a_run(**mirrored), wheel_load=Q0)
    for quantity in ("Y/Q", "Q", "unloading", "Y quasi-static"):
        assert abs(one[f"{quantity} wheelset1.left"].value) == pytest.approx(abs(other[f"{quantity} wheelset1.right"].value), rel=1e-12)
    assert one["sum Y wheelset1"].value == pytest.approx(-other["sum Y wheelset1"].value, rel=1e-12)


def test_worst_message_and_plot():
    found = criteria.derailment(a_run(), wheel_load=Q0)
    assert found.worst("Y/Q").name == "Y/Q wheelset1.left" and found.message.startswith("Y/Q wheelset1.left: 0.2")
    with pytest.raises(CriterionError, match="there are Y/Q, sum Y, Q, unloading, Y quasi-static, Q quasi-static"):
        found.worst("Z")
    with pytest.raises(CriterionError, match="there is no 'Y/Q'; there are Y/Q wheelset1.left"):
        found["Y/Q"]
    assert found.plot("sum Y").get_ylabel() == "sum Y, kN, 2 m mean" and found.plot().get_ylabel() == "Y/Q, 2 m mean"


def test_forces_that_cannot_be_judged():
    with pytest.raises(KeyError, match="wheelset1.right.Y"):
        criteria.derailment(a_run().select("*.Q", "*.left.Y"))
    with pytest.raises(CriterionError, match="names such as wheelset1.left.Q are needed"):
        criteria.derailment(a_run(), wheels="*.Y")
    with pytest.raises(CriterionError, match="at least 100 Hz; the signal has 50 Hz"):
        criteria.derailment(rs.Run(TIME[::10], {n: a_run()[n][::10] for n in a_run().channels}, a_run().channels, RunInfo(speed=SPEED)))
    with pytest.raises(CriterionError, match="needs at least that distance; the record covers 0.9999 m"):
        criteria.derailment(a_run(), speed=0.05)
    one = criteria.derailment(a_run().select("*.left.*"), wheel_load=Q0)
    assert any("no sum of Y" in note for note in one.notes)


def test_body_accelerations_of_a_sine_on_a_curve():
    value = 0.7 + 0.8 * np.sin(2 * np.pi * 2.0 * TIME)
    found = criteria.body_acceleration(TIME, {"car.ay": value, "car.az": value})
    assert found["r.m.s. car.ay"].value == pytest.approx(0.8 / np.sqrt(2), rel=0.01)
    assert found["peak car.ay"].value == pytest.approx(0.8, rel=0.02)
    assert found["quasi-static car.ay"].value == pytest.approx(0.7, rel=0.02)
    assert found["quasi-static car.az"].limit is None and found["r.m.s. car.az"].limit.name == "body_rms_vertical"
    assert all(item.limit is None or "no verdict" in item.verdict for item in found.assessed)
    assert criteria.acceleration_rms(TIME, value) == pytest.approx(found["r.m.s. car.ay"].value, rel=1e-12)
    with pytest.raises(CriterionError, match="needs at least 7.5 s; the signal is 3.998 s long"):
        criteria.body_acceleration(TIME[:2000], value[:2000])
