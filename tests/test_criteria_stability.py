# SPDX-License-Identifier: BSD-3-Clause
"""The paper's instability criterion, sliding r.m.s., hunting frequency."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railsym as rs
from railsym.criteria import CriterionError
from railsym.criteria.instability import half_waves
from railsym.results import Channel

criteria = rs.criteria
RATE, FREQUENCY = 500.0, 5.6    # 5.66 Hz is the middle of 4 to 8 Hz, where the filter's gain is 1
TIME = np.arange(6000) / RATE


def burst(cycles, amplitude=9.0, start=4.0, low=6.0, frequency=FREQUENCY):
    """A sine of ``low`` m/s^2, a number of whole cycles of which have ``amplitude``."""
    phase = 2 * np.pi * frequency * (TIME - start)
    inside = (phase >= 0) & (phase < 2 * np.pi * cycles)
    return np.where(inside, amplitude, low) * np.sin(phase)


@pytest.mark.parametrize("halves, unstable", [(0, False), (10, False), (11, False), (12, True), (13, True), (40, True)])
def test_six_consecutive_cycles_and_not_one_half_wave_less(halves, unstable):
    """Without the filter's smearing: a wide band leaves the signal as it is."""
    found = criteria.instability(TIME, burst(0.5 * halves, low=4.0), band=(0.26, 99.0), speed=50.0)
    box = found.axleboxes[0]
    assert (box.unstable, found.unstable, box.cycles) == (unstable, unstable, 0.5 * halves)
    if unstable:
        assert box.time == pytest.approx(4.0 + 0.25 / FREQUENCY, abs=1.5 / RATE)
        assert box.detected == pytest.approx(box.time + 5.5 / FREQUENCY, abs=1.5 / RATE)
        assert box.distance == pytest.approx(50.0 * box.time, rel=1e-9)
    else:
        assert box.time is None and box.distance is None and found.message.startswith("stable")


@settings(max_examples=30, deadline=None)
@given(amplitude=st.floats(6.0, 10.5), frequency=st.floats(4.4, 7.3))
def test_limit_just_above_and_just_below_through_the_filter(amplitude, frequency):
    """A steady sine is judged by its amplitude times the gain of the filter."""
    gain = abs(criteria.Butterworth(4.0, 8.0).response([frequency], RATE)[0])
    level = amplitude * gain
    if abs(level - 8.0) < 0.05:    # peaks between two samples are lower by up to 1 - cos(pi f/rate) = 0.1 %, ends swing in
        return
    box = criteria.instability(TIME, amplitude * np.sin(2 * np.pi * frequency * TIME)).axleboxes[0]
    assert box.unstable == (level > 8.0)
    assert box.sustained == pytest.approx(level, rel=4e-3)


def test_a_gap_starts_the_count_again():
    """Twice five cycles with one weak half-wave between them are not six in a row."""
    wave = burst(0.0)
    phase = FREQUENCY * (TIME - 4.0)
    strong = ((phase >= 0) & (phase < 5)) | ((phase >= 5.5) & (phase < 10.5))
    found = criteria.instability(TIME, np.where(strong, 9.0, 6.0) * np.sin(2 * np.pi * phase), band=(0.26, 99.0))
    assert not found.unstable and found.axleboxes[0].cycles == 5.0 and wave.max() < 8.0


def test_offset_and_slow_motions_do_not_count():
    """20 m/s^2 of curve and 10 m/s^2 of sway at 1 Hz: none of it is between 4 and 8 Hz."""
    box = criteria.instability(TIME, 20.0 + 10.0 * np.sin(2 * np.pi * TIME)).axleboxes[0]
    assert not box.unstable and box.sustained < 0.2


def test_half_waves_between_crossings():
    peaks, places = half_waves(np.array([1.0, -1.0, -3.0, 2.0, 1.0, 0.0, 0.0, 4.0, -1.0]))
    np.testing.assert_array_equal(peaks, [3.0, 2.0, 4.0])
    np.testing.assert_array_equal(places, [2, 3, 7])
    assert half_waves(np.ones(10))[0].size == 0 and half_waves(np.zeros(10))[0].size == 0


def a_run(**signals):
    names = {"bogie1.above_wheelset1_left.ay": burst(0.0), "bogie2.above_wheelset4_right.ay": burst(20.0)} | signals
    values = names | {"s": 60.0 * TIME, "wheelset1.y": 5e-3 * np.sin(2 * np.pi * FREQUENCY * TIME)}
    units = {name: "m/s^2" for name in names} | {"s": "m", "wheelset1.y": "m"}
    return rs.Run.from_arrays(TIME, values, units, vehicle="pendolino")


def test_a_run_is_judged_by_axlebox():
    found = criteria.instability(a_run())
    assert [box.unstable for box in found.axleboxes] == [False, True]
    text = str(found)
    assert text.startswith("unstable: 6 consecutive cycles over 8 m/s^2, 4 to 8 Hz at 1 of 2 places, "
                           "first bogie2.above_wheelset4_right.ay from t = 4.0")
    assert "limit 8 m/s^2: V1, UIC 518" in text and "stable" in text
    assert found.assessed[1].verdict.startswith("over the limit 8 m/s^2 (V1)")
    panels = found.plot()
    assert [panel.get_title(loc="left") for panel in panels][0] == "bogie1.above_wheelset1_left: stable"


def test_limit_and_cycles_can_be_given():
    run = a_run()
    assert criteria.instability(run, limit=5.0).axleboxes[0].unstable
    assert not criteria.instability(run, limit=9.5).unstable
    assert not criteria.instability(run, cycles=25).unstable
    assert criteria.instability(run, limit=5.0).limit.trust == "given"


@pytest.mark.parametrize("time, values, message", [
    (TIME[:300], np.zeros(300), "needs at least 0.75 s; the signal is 0.598 s long"),
    (np.arange(100) / 30.0, np.zeros(100), "needs a sampling rate of at least 40 Hz; the signal has 30 Hz"),
    (TIME, np.where(TIME == TIME[77], np.nan, 0.0), r"frame.ay is not finite at t = 0.154 s \(nan\); cut it off with run.between"),
    (np.append(TIME[:-1], 99.0), np.zeros(6000), "time is not uniform: a step of 87.004 s at t = 11.996 s"),
    (TIME, np.zeros(7), r"frame.ay has shape \(7,\), time \(6000,\)"),
    (TIME, None, "give a run, or time"),
])
def test_what_cannot_be_judged_says_how_long_or_how_fast(time, values, message):
    with pytest.raises(ValueError, match=message):
        criteria.instability(time, values)


def test_a_run_without_the_channels_or_in_another_unit():
    with pytest.raises(KeyError, match=r"no channel fits '\*\.above_\*\.ay'; there are 1: a"):
        criteria.instability(rs.Run(TIME, {"a": TIME}, [Channel("a", "m")]))
    with pytest.raises(CriterionError, match=r"channel x\.above_y\.ay is in g; m/s\^2 is needed"):
        criteria.instability(rs.Run(TIME, {"x.above_y.ay": TIME}, [Channel("x.above_y.ay", "g")]))
    with pytest.raises(CriterionError, match="distance does not increase at t = 0.002 s"):
        criteria.instability(TIME, burst(0.0), distance=np.concatenate(([0, 1, 1], np.arange(2.0, 5999.0))))


def test_rms_of_a_steady_sine_over_100_m():
    amplitude = 30e3
    found = criteria.instability_rms(TIME, {"wheelset1.sum_Y": amplitude * np.sin(2 * np.pi * FREQUENCY * TIME)}, speed=60.0, wheel_load=66e3)
    assert found.frequency_hz == pytest.approx(FREQUENCY, abs=1e-3)
    item = found.assessed[0]
    # windows of 100 m hold 9.3 periods; f0 is not the geometric middle of the band, where the gain is 1
    gain = abs(criteria.Butterworth(FREQUENCY - 2, FREQUENCY + 2).response([FREQUENCY], RATE)[0])
    assert item.value == pytest.approx(amplitude * gain / np.sqrt(2), rel=0.02)
    assert item.limit.value == pytest.approx(0.5 * (10e3 + 132e3 / 3)) and "no verdict" in item.verdict
    assert np.diff(found.distance["wheelset1.sum_Y"]) == pytest.approx(10.0)


def test_rms_by_the_simplified_method():
    found = criteria.instability_rms(a_run(), method="acceleration", bogie_mass=6000.0, frequency=5.0)
    assert found.assessed[0].limit.value == pytest.approx((12 - 6 / 5) / 2) and len(found.assessed) == 2
    assert criteria.instability_rms(a_run(), method="acceleration").assessed[0].limit is None
    for arguments, message in (({"frequency": 1.5}, "needs f0 above 2 Hz"), ({"bogie_mass": 70e3}, "no meaning above 60 t"),
                               ({"method": "x"}, "there are 'sum_Y'")):
        with pytest.raises(CriterionError, match=message):
            criteria.instability_rms(a_run(), **({"method": "acceleration"} | arguments))
    with pytest.raises(CriterionError, match="distance is needed"):
        criteria.instability_rms(TIME, burst(9.0), method="acceleration")
    with pytest.raises(CriterionError, match="a window of 100 m needs"):
        criteria.instability_rms(TIME, burst(9.0), method="acceleration", speed=1.0)


def test_hunting_frequency_is_named_with_its_channel():
    found = criteria.hunting_frequency(a_run(), start=4.0, end=7.0)
    assert found.channel == "bogie2.above_wheelset4_right.ay" and found.unit == "m/s^2"
    assert found.frequency_hz == pytest.approx(FREQUENCY, abs=0.01) and len(found.agreeing) == 2
    assert criteria.hunting_frequency(a_run(), channels="wheelset*.y").unit == "m"
    assert criteria.hunting_frequency(TIME, np.sin(2 * np.pi * 2.2 * TIME)).frequency_hz == pytest.approx(2.2, abs=1e-3)
    with pytest.raises(CriterionError, match="nothing moves between 0.5 and 12 Hz"):
        criteria.hunting_frequency(TIME, np.ones(6000))


def test_markers_of_the_shipped_vehicles():
    markers = criteria.frame_markers(rs.load_vehicle("pendolino"))
    assert list(markers) == [f"bogie{1 if k < 3 else 2}.above_wheelset{k}_{side}" for k in (1, 2, 3, 4) for side in ("left", "right")]
    body, place = markers["bogie2.above_wheelset4_right"]
    assert body == "bogie2" and place.tolist() == [-10.85, 1.0, -0.55]
    assert criteria.frame_markers(rs.load_vehicle("cooperrider"))["bogie1.above_wheelset2_left"][1][1] == -0.75
    with pytest.raises(CriterionError, match="joined to no body"):
        criteria.frame_markers(rs.load_vehicle("wheelset"))


def test_a_vehicle_at_its_linear_critical_speed():
    """The matrix exponential of the linear train hunts at the frequency that the eigenvalues give, and the criterion sees its amplitude."""
    from scipy.linalg import expm

    vehicle, contact = rs.load_vehicle("pendolino").configured("noAS_K"), rs.LinearContact(conicity=0.2)
    critical = rs.critical_speed(vehicle, 0.2)
    lin = rs.linearise(vehicle, float(critical.speed), contact)
    place = {name: k for k, name in enumerate(lin.states)}
    step, state = expm(4e-3 * lin.A), np.zeros(len(place))
    state[place["wheelset1.y"]] = 2e-3
    states = np.empty((5000, state.size))
    for row in states:
        row[:] = state
        state = step @ state
    values = {}
    for name, (body, position) in criteria.frame_markers(vehicle).items():
        lateral, yaw = (lin.A[place[f"{body}.{c}.rate"]] for c in ("y", "yaw"))
        values[f"{name}.ay"] = states @ (lateral + (position - vehicle.body(body).position)[0] * yaw)
    run = rs.Run.from_arrays(np.arange(5000) * 4e-3, values, dict.fromkeys(values, "m/s^2"), speed=float(critical.speed)).between(10.0, 20.0)
    found = criteria.hunting_frequency(run)
    # at the critical speed the other motions have died out after 10 s, and a steady sine is left
    assert found.frequency_hz == pytest.approx(float(critical.frequency_hz), abs=5e-3) and len(found.agreeing) == 8
    for level, unstable in ((8.2, True), (7.8, False)):
        scaled = rs.Run(run.time, {n: run[n] * level / found.amplitude for n in run.channels}, run.channels, run.info)
        assert criteria.instability(scaled).unstable == unstable
