# SPDX-License-Identifier: BSD-3-Clause
"""The tilting controller on recorded signals: detection, estimates, demand, faults; Python and C to the bit; SciPy on its linear part."""

import numpy as np
import pytest
from scipy.signal import dlsim, dlti, group_delay, lfilter

import railsym as rs
from railsym.tilt import CompiledController, Controller, SensorFault, SensorSet, TiltError, TiltParameters, TrackDatabase, reports
from railsym.tilt.constants import constants
from railsym.tilt.faults import Fault, State
from railsym.tilt.filtering import LowPass
from railsym.tilt.loop import fitted_plant, margins, servo_matrices
from railsym.tilt.place import PlaceBuffer
from railsym.tilt.sensors import NoiseSource
from railsym.tilt.servo import Servo
from tests.oracles.tilt_signals import OUT, followed, on_track

SPEED = 105.0 / 3.6
TRACK = rs.Track.s_curve(500.0, 200.0, transition=80.0, cant=0.1, before=100.0, after=180.0)
TIMES, CLEAN = on_track(TRACK, SPEED, noise=1e-7)                # a sensor without any noise would repeat its values, which is a fault
NOISY = on_track(TRACK, SPEED, noise=0.05)[1]
LEVEL = SPEED ** 2 / 500.0 - 9.81 * 0.1 / 1.5                 # m/s^2, cant deficiency in the curves
IN_CURVE = slice(round(200.0 / SPEED * 100), round(340.0 / SPEED * 100))
LAWS = {"accelerometer": TiltParameters(), "complementary": TiltParameters(estimator="complementary", kd=0.05),
        "leading": TiltParameters(source="leading", ahead=35.0, lead=0.5), "database": TiltParameters(source="database", lead=0.1, latency=0.0)}


def database(parameters, **options):
    return TrackDatabase.of(TRACK, **options) if parameters.source == "database" else None


def spoilt(signals, rng):
    """Gaps, repeated values, a bias."""
    rows = signals.copy()
    rows[rng.random(rows.shape) < 0.02] = np.nan
    rows[800:830, 2] = rows[800, 2]
    rows[1500:, 3] += 0.6
    return rows


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("spoil", [False, True])
def test_python_and_c_agree_to_the_bit(law, spoil):
    parameters = LAWS[law]
    rows = spoilt(NOISY, np.random.default_rng(3)) if spoil else NOISY
    found = [kind(parameters, database(parameters)).replay(TIMES, rows) for kind in (Controller, CompiledController)]
    assert np.isfinite(found[0][:, OUT["command"]]).all() and np.abs(found[0][:, OUT["demand"]]).max() > 0.02
    assert found[0].tobytes() == found[1].tobytes()
    assert bool(reports(TIMES, rows, found[0])[:2]) >= spoil


def test_filter_is_scipys_and_its_delay_is_known():
    parameters = TiltParameters(lateral_cutoff=0.7)
    b0, b1, b2, a1, a2 = parameters.biquad(0.7)
    x = np.random.default_rng(1).standard_normal(300)
    ours = LowPass((b0, b1, b2, a1, a2))
    np.testing.assert_allclose([ours.step(v) for v in x], lfilter([b0, b1, b2], [1.0, a1, a2], x), atol=1e-15)
    _, delay = group_delay(([b0, b1, b2], [1.0, a1, a2]), w=[1e-4])
    assert parameters.filter_delay(0.7) == pytest.approx(delay[0] / 100.0, rel=1e-4)
    assert parameters.filter_delay(0.7) == pytest.approx(np.sqrt(2.0) / (2.0 * np.pi * 0.7), rel=1e-3)   # continuous, to the sampling


def test_start_of_the_curve_is_found_in_time_and_place():
    """True starts: 100 m, and the middle of the reversing transition at 460 m, where the curvature is zero."""
    found = Controller(TiltParameters()).replay(TIMES, CLEAN)
    places, times = found[:, OUT["start_place"]], found[:, OUT["start_time"]]
    first, second = np.unique(places[np.isfinite(places)])
    assert abs(first - 100.0) < 0.5 and abs(second - 460.0) < 0.5      # the ramp's rounded corner; uncorrected it would be 3 m late
    assert np.nanmin(times) == pytest.approx((100.0 - 9.5) / SPEED, abs=0.02)
    late = Controller(TiltParameters(sensor_delay=0.1)).replay(TIMES, CLEAN)[:, OUT["start_place"]]
    assert np.nanmin(late) == pytest.approx(first - 0.1 * SPEED, abs=1e-6)


def test_curve_state_has_hysteresis():
    found = followed(TiltParameters(), TIMES, NOISY)[:, OUT["in_curve"]]
    changes = np.flatnonzero(np.diff(found))
    assert len(changes) == 2 and found[0] == found[-1] == 0.0          # in once, out once: also through the reversing transition
    assert TIMES[changes[0]] == pytest.approx((100.0 - 9.5) / SPEED, abs=0.3)


@pytest.mark.parametrize("estimator", ["accelerometer", "complementary"])
def test_demand_is_the_share_of_the_cant_deficiency(estimator):
    parameters = TiltParameters(estimator=estimator)
    found = followed(parameters, TIMES, CLEAN)
    assert found[IN_CURVE, OUT["cant_deficiency"]][-1] == pytest.approx(LEVEL, rel=0.01)
    assert found[IN_CURVE, OUT["demand"]][-1] == pytest.approx(0.6 * np.arctan(LEVEL / 9.81), rel=0.01)


def test_complementary_estimate_lags_less_and_a_database_not_at_all():
    def lag(parameters, **options):
        wanted = np.arctan(CLEAN[:, 2] / 9.81) * 0.6
        found = followed(parameters, TIMES, CLEAN, database(parameters, **options))[:, OUT["demand"]]
        return min(range(-60, 120), key=lambda k: np.sum((np.roll(wanted, k) - found)[150:-150] ** 2)) / 100.0

    slow, fast = lag(LAWS["accelerometer"]), lag(LAWS["complementary"])
    assert slow == pytest.approx(TiltParameters().filter_delay(0.5), abs=0.02)
    assert fast < 0.25 * slow
    ahead = 9.5 / SPEED                                                 # the database is read at the vehicle's middle, 9.5 m behind the sensors
    smooth = TiltParameters().filter_delay(0.5)
    assert lag(TiltParameters(source="database", lead=smooth)) == pytest.approx(ahead, abs=0.02)
    assert lag(TiltParameters(source="database", lead=0.2), offset=6.0) == pytest.approx(ahead + smooth - 0.2 + 6.0 / SPEED, abs=0.02)


def test_leading_sensors_call_the_demand_where_they_found_it():
    parameters = LAWS["leading"].with_(lead=0.0)
    times, signals = on_track(TRACK, SPEED, ahead=35.0, noise=1e-7)
    found, own = followed(parameters, times, signals), followed(parameters.with_(source="own"), times, signals)
    late = round(35.0 / SPEED * 100.0)
    np.testing.assert_allclose(found[late + 100:, OUT["demand"]], own[100:-late, OUT["demand"]], atol=2e-4)   # a sample is 0.3 m of 80 m


def test_mirrored_signals_give_mirrored_commands_to_the_bit():
    mirror = np.array([-1, -1, -1, -1, -1, 1, 1.0])
    for parameters in (LAWS["accelerometer"], LAWS["complementary"], LAWS["leading"]):
        one, other = (Controller(parameters).replay(TIMES, rows) for rows in (NOISY, NOISY * mirror))
        for name in ("command", "demand", "cant_deficiency", "error", "trim"):
            assert np.array_equal(one[:, OUT[name]], -other[:, OUT[name]]), name


# --- faults: each ends in a state that is said beforehand ---------------------------------------------------------------

def with_fault(signal, change, start=800):
    rows = CLEAN.copy()
    rows[start:, signal] = change(rows[start:, signal])
    return rows


CASES = {
    "bias of an accelerometer in the curve": (2, lambda x: x + 0.5, Fault.ACCELEROMETER_A, State.DEGRADED),
    "the other one": (3, lambda x: x - 0.5, Fault.ACCELEROMETER_B, State.DEGRADED),
    "accelerometer missing": (2, lambda x: np.nan * x, Fault.ACCELEROMETER_A, State.DEGRADED),
    "accelerometer frozen": (3, lambda x: 0.0 * x + x[0], Fault.ACCELEROMETER_B, State.DEGRADED),
    "roll gyroscope missing": (0, lambda x: np.nan * x, Fault.GYROSCOPE, State.DEGRADED),
    "yaw gyroscope biased": (1, lambda x: x + 0.03, Fault.GYROSCOPE, State.DEGRADED),
    "odometer missing": (6, lambda x: np.nan * x, Fault.ODOMETER, State.SAFE),
    "tilt sensor missing": (4, lambda x: np.nan * x, Fault.TILT_SENSOR, State.DEGRADED),
}


@pytest.mark.parametrize("case", CASES)
def test_fault_is_found_and_named(case):
    signal, change, fault, state = CASES[case]
    rows, control = with_fault(signal, change), Controller(TiltParameters())
    tilt, found = 0.0, []
    for time, row in zip(TIMES, rows):
        row[4] = tilt if signal != 4 or time < 8.0 else np.nan
        control.step(time, row)
        found.append(control.outputs)
        tilt = control.servo.expected + 1e-7
    said = reports(TIMES, rows, np.array(found))
    assert [(r.fault, r.state) for r in said] == [(fault, state)]
    assert 8.0 <= said[0].time < 9.2 and str(state.name).lower() in str(said[0])
    demand = np.array(found)[:, OUT["demand"]]
    if state == State.SAFE:
        assert demand[-1] == 0.0 and np.abs(np.diff(demand[900:])).max() <= np.radians(2.0) / 100.0 + 1e-12
    elif fault in (Fault.ACCELEROMETER_A, Fault.ACCELEROMETER_B, Fault.GYROSCOPE):
        level = demand[round(560.0 / SPEED * 100)]
        assert level == pytest.approx(-0.6 * np.arctan(LEVEL / 9.81), rel=0.03)      # the second curve, with the sensors left


def test_short_gaps_are_bridged_and_long_ones_are_not():
    rows = CLEAN.copy()
    rows[700:705, 2] = np.nan
    far = TiltParameters(follow_tolerance=1.0)
    assert not reports(TIMES, rows, Controller(far).replay(TIMES, rows))
    rows[700:706, 2] = np.nan
    assert [r.fault for r in reports(TIMES, rows, Controller(far).replay(TIMES, rows))] == [Fault.ACCELEROMETER_A]


def test_losing_everything_brings_the_body_upright():
    rows = with_fault(2, lambda x: np.nan * x)
    rows[1000:, 3] = np.nan
    found = followed(TiltParameters(), TIMES, rows)
    said = reports(TIMES, rows, found)
    assert [(r.fault, r.state) for r in said] == [(Fault.ACCELEROMETER_A, State.DEGRADED), (Fault.ACCELEROMETER_B, State.SAFE)]
    assert found[1400, OUT["command"]] == 0.0


def test_stuck_actuator_is_reported_and_the_demand_comes_down():
    stuck = followed(TiltParameters(), TIMES, CLEAN, plant=lambda command: 0.0)
    said = reports(TIMES, CLEAN, stuck)
    assert [(r.fault, r.state) for r in said] == [(Fault.ACTUATOR, State.FAILED)] and stuck[-1, OUT["demand"]] == 0.0


def test_database_that_is_elsewhere_gives_way_to_the_sensors():
    parameters = TiltParameters(source="database", lead=0.1)
    near, far = (followed(parameters, TIMES, NOISY, database(parameters, offset=offset)) for offset in (5.0, 90.0))
    assert not reports(TIMES, NOISY, near)
    assert [(r.fault, r.state) for r in reports(TIMES, NOISY, far)] == [(Fault.DATABASE, State.DEGRADED)]
    own = followed(TiltParameters(lead=0.1), TIMES, NOISY)
    np.testing.assert_allclose(far[-800:, OUT["demand"]], own[-800:, OUT["demand"]], atol=1e-12)


# --- the linear part against SciPy --------------------------------------------------------------------------------------

@pytest.mark.parametrize("latency", [0.0, 0.01, 0.03])
def test_servo_is_the_discrete_system_that_scipy_simulates(latency):
    """Random demand and tilt within the limits: equal to rounding."""
    parameters = TiltParameters(kp=0.7, ki=1.3, kd=0.06, latency=latency, limit=1.5, trim_limit=1e3)
    servo, rng, found = Servo(constants(parameters)), np.random.default_rng(2), []
    inputs = 0.01 * rng.standard_normal((400, 2))
    for demand, tilt in inputs:
        servo.compare(tilt)
        found.append(servo.command(demand, True))
    _, expected, _ = dlsim(dlti(*servo_matrices(parameters), dt=parameters.period), inputs)
    np.testing.assert_allclose(found, expected[:, 0], atol=1e-16, rtol=1e-12)


def test_margins_of_an_integrator_with_delay():
    """L = w0 exp(-T s)/s: gain margin pi/(2 w0 T) at 1/(4 T), phase margin pi/2 - w0 T."""
    f = np.geomspace(0.01, 50.0, 20000)
    s = 2j * np.pi * f
    found = margins(f, 5.0 / s * np.exp(-0.1 * s))
    assert found.gain == pytest.approx(np.pi / (2 * 5.0 * 0.1), rel=1e-3) and found.gain_frequency == pytest.approx(2.5, rel=1e-3)
    assert found.phase == pytest.approx(np.pi / 2 - 0.5, rel=1e-3) and found.phase_frequency == pytest.approx(5.0 / (2 * np.pi), rel=1e-3)
    assert fitted_plant(f[:10000], 0.9 / (1 + 1.6 * s / 12.0 + (s / 12.0) ** 2)[:10000]) == pytest.approx((12.0 / (2 * np.pi), 0.8, 0.9), rel=1e-6)


def test_integral_does_not_wind_up():
    """An actuator that holds still for 10 s and then follows at once: the trim leaves its limit within the time of tracking, not of 10 s."""
    k = constants(TiltParameters(ki=4.0, trim_limit=0.01))
    servo = Servo(k)
    for _ in range(1000):
        servo.compare(0.0)
        servo.command(0.05, True)
    assert servo.trim == pytest.approx(0.01, rel=1e-12)
    # where ki e + tracking (trim - wanted) = 0
    assert servo.integral < 0.01 + k.ki / k.tracking * 0.05 + 1e-9
    for _ in range(300):
        servo.compare(servo.expected + 0.005)
        servo.command(0.05, True)
    assert servo.trim < 0.0          # an integral without tracking would have gathered ki e t = 2 rad


# --- what is refused -----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("change, text", [
    ({"share": -0.1}, "share = -0.1"), ({"rate": np.nan}, "rate = nan"), ({"latency": 0.005}, "whole number of samples"),
    ({"estimator": "guess"}, "accelerometer, complementary"), ({"curve_on": 1e-4}, "hysteresis"), ({"gyro_cutoff": 60.0}, "below 0.45 of the rate"),
    ({"source": "database"}, "without a track database"), ({"source": "leading", "ahead": 300.0}, "remembers 200 m"), ({"wobble": 1.0}, "no parameter")])
def test_parameters_that_make_no_sense(change, text):
    with pytest.raises(TiltError, match=text):
        Controller(TiltParameters().with_(**change))


def test_recordings_that_do_not_fit():
    control = Controller()
    with pytest.raises(TiltError, match="0.01 s apart"):
        control.replay(TIMES * 2.0, CLEAN)
    with pytest.raises(TiltError, match=r"shape .*; \(\d+, 7\) is needed"):
        control.replay(TIMES, CLEAN[:, :5])
    with pytest.raises(TiltError, match="lack roll_rate"):
        control.replay(TIMES, {"yaw_rate": CLEAN[:, 1]})
    with pytest.raises(TiltError, match="must increase"):
        TrackDatabase([0.0, 0.0], [0.0, 0.0], [0.0, 0.0])
    with pytest.raises(TiltError, match="signals are roll_rate"):
        SensorFault("speedo", "bias", 1.0)


def test_noise_is_that_of_its_seed_and_density():
    whole, pieces = NoiseSource(SensorSet(loss=0.1)).rows(1000), NoiseSource(SensorSet(loss=0.1))
    assert np.array_equal(np.concatenate([pieces.rows(300), pieces.rows(700)]), whole, equal_nan=True)
    assert 0.08 < np.isnan(whole).mean() < 0.12
    assert SensorSet().scatter(100.0)[2] == pytest.approx(2e-3 * np.sqrt(50.0))


def test_place_buffer_reads_between_its_values_and_keeps_its_room():
    buffer, found = PlaceBuffer(), []
    for s in np.arange(0.0, 1000.0, 0.25):
        buffer.push(s, 2.0 * s)
        found.append(buffer.look(s - 100.0))
    np.testing.assert_allclose(found[-3000:], 2.0 * (np.arange(0.0, 1000.0, 0.25)[-3000:] - 100.0), rtol=1e-12)
    assert buffer.look(2000.0) == 2.0 * 999.75 and PlaceBuffer().look(3.0) == 0.0
