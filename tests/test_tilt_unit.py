# SPDX-License-Identifier: BSD-3-Clause
"""The tilt unit on a vehicle in motion: sensors, controller in the loop and on its record, users' controllers, faults."""

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

import railsym as rs
from railsym.errors import ControllerError
from railsym.simulation import Simulation
from railsym.tilt import (OUTPUTS, SIGNALS, CompiledController, CompiledLaw, Controller, LeadingSignals, Sensor, SensorFault, SensorSet, State, TiltDrive,
                          TiltError, TiltLoop, TiltParameters, TiltUnit)
from railsym.studies.tilt_faults import Failing

VEHICLE = rs.load_vehicle("pendolino_tilting").configured("AS_K")
SPEED = 105.0 / 3.6
TRACK = rs.Track.curve(500.0, 90.0, transition=60.0, cant=0.1, before=40.0, after=60.0, name="short curve")
CHANNELS = ["s", "V", "car.roll", "car.y", "bolster?.roll", "bogie1.ay", "car.ay", "tilt_actuator.*"]


def run(unit=None, duration=9.0, track=TRACK, also=(), **options):
    control = [] if unit is None else [unit.controller]
    return rs.simulate(VEHICLE, speed=SPEED, duration=duration, track=track, channels=CHANNELS, controllers=[*also, *control], **options)


def same(one, other):
    return all(np.array_equal(one[name], other[name]) for name in one.channels)


@pytest.fixture(scope="module")
def noisy():
    """Runs in Python and in C with noise, lost samples and a sensor that goes off."""
    sensors = SensorSet(loss=0.02, faults=(SensorFault("lateral_a", "bias", 5.0, value=0.6),))
    units = [TiltUnit(kind(TiltParameters(kd=0.02)), sensors) for kind in (Controller, CompiledController)]
    return units, [run(unit) for unit in units]


def test_controller_in_c_gives_the_run_of_the_python_one_to_the_bit(noisy):
    units, runs = noisy
    assert units[0].rows().tobytes() == units[1].rows().tobytes() and len(units[0].rows()) == 900
    assert same(*runs) and np.abs(runs[0]["car.roll"]).max() > 0.03
    assert [r.fault.name for r in units[0].reports] == ["ACCELEROMETER_A"] and units[1].state == State.DEGRADED


def test_controller_on_its_record_answers_as_in_the_loop(noisy, tmp_path):
    for unit in noisy[0]:
        record = unit.record
        record.to_csv(tmp_path / "record.csv")
        for source in (record, rs.results.Run.from_csv(tmp_path / "record.csv")):
            outputs = unit.law.replay(source.time, source)
            assert outputs.tobytes() == np.column_stack([record[name] for name in OUTPUTS]).tobytes()


def test_a_run_in_pieces_is_the_same_run(noisy):
    unit = TiltUnit(CompiledController(TiltParameters(kd=0.02)), noisy[0][0].sensors)
    pieces = Simulation(VEHICLE, speed=SPEED, track=TRACK, channels=CHANNELS)
    for length in (1.234, 3.0, 9.0 - 4.234):
        pieces.run(length, controllers=[unit.controller])
    assert same(pieces.result(), noisy[1][0])


def test_sensors_read_what_the_body_feels():
    """Wide sensors without noise against `Controls.imu`, which is computed in NumPy from another formula for the frame."""
    wide = {name: Sensor(bandwidth=400.0) for name in list(SIGNALS)[:5]}
    seen = []

    class Look:
        rate = 100.0

        def step(self, time, signals):
            return 0.05 if time > 0.5 else 0.0

    def look(controls):
        points = [controls.imu("bogie1", [9.5, y, -0.55]) for y in (-0.5, 0.5)]
        seen.append([points[0][1][0], points[0][1][2], points[0][0][1], points[1][0][1]])

    unit = TiltUnit(Look(), SensorSet(**wide))
    run(unit, 6.0, also=[(look, 100.0)])
    found = unit.rows()[:, 1:5]
    size = np.abs(found).max(axis=0)
    # the filter of 400 Hz delays by 0.6 ms
    assert (np.abs(found - np.array(seen))[60:] < 0.05 * size).all() and (size > [0.02, 0.05, 1.0, 1.0]).all()
    assert np.median(np.abs(found - np.array(seen)), axis=0) == pytest.approx(np.zeros(4), abs=2e-3)


def test_formula_of_the_sensors_is_that_of_the_channels():
    """Large random motions, where every term counts, against `railsym.simulation.markers`."""
    from railsym._core import _doubles, ffi, lib
    from railsym.simulation.markers import _turning, accelerometer, rotations

    rng = np.random.default_rng(4)
    for _ in range(20):
        q, u, a, offset, w, dw, pull = rng.standard_normal((7, 6))
        arm, V, dV = rng.standard_normal((2, 3)), 20.0, 1.3
        frame = ffi.new("rs_tilt_frame *", {"V": V, "dV": dV, "w": list(w[:3]), "dw": list(dw[:3]), "gravity": list(pull[:3])})
        out, lever = np.empty(4), arm.ravel().copy()
        lib.rs_tilt_motion(*map(_doubles, (q, u, a, offset[:3].copy(), lever)), frame, _doubles(out))
        motion = {"V": np.array([V]), "dV": np.array([dV]), "w": w[None, :3], "dw": dw[None, :3], "gravity": pull[None, :3]}
        columns = [part[:, None] for part in (q, u, a)]
        expected = [accelerometer(*columns, point, offset[:3], motion, 9.81)[0][1] for point in arm]
        turning = rotations(q[3:, None])[0].T @ (_turning(q[3:, None], u[3:, None], a[3:, None])[0][0] + w[:3])
        np.testing.assert_allclose(out, [turning[0], turning[2], *expected], rtol=1e-12, atol=1e-11)


def test_mirrored_curve_gives_mirrored_motion():
    units = [TiltUnit(CompiledController(TiltParameters(stale=np.inf)), SensorSet.ideal()) for _ in range(2)]
    right, left = (run(unit, track=track) for unit, track in zip(units, (TRACK, TRACK.mirrored())))
    for name in ("car.roll", "car.y", "bolster1.roll", "car.ay", "bogie1.ay"):
        np.testing.assert_allclose(right[name], -left[name], rtol=0.0, atol=1e-9)   # rounding; accelerations above 1 m/s^2
    for name in ("front", "rear"):
        np.testing.assert_allclose(right[f"tilt_actuator.{name}_left.length"], left[f"tilt_actuator.{name}_right.length"], atol=1e-12)
    assert right["car.roll"].max() > 0.03
    np.testing.assert_allclose(units[0].record["demand"], -units[1].record["demand"], atol=1e-12)


def test_lengths_of_the_actuators_turn_the_body_as_far_as_asked():
    """Links and actuators give way a little: 2.2 % (docs/tilting.md); the sensor reads the true angle."""
    class Lean:
        rate = 100.0

        def step(self, time, signals):
            return -0.1

    unit = TiltUnit(Lean(), SensorSet.ideal())
    found = run(unit, 4.0, track=None)
    against = found["car.roll"][-1] - 0.5 * (found["bolster1.roll"][-1] + found["bolster2.roll"][-1])
    assert against == pytest.approx(-0.1, rel=0.03)
    assert unit.record["tilt"][-1] == pytest.approx(against, rel=1e-3)
    drive = TiltDrive.of(VEHICLE)
    lengths = np.array([found[f"{name}.length"][-1] for name in drive.actuators])
    assert drive.tilt(lengths) == pytest.approx(against, rel=5e-3)


def test_linear_loop_is_the_loop_of_the_simulation():
    """A step of the demand by 0.1 degree (a larger one meets the actuators' rate limit) on straight track, against SciPy's dlsim."""
    p = TiltParameters(latency=0.02)
    loop = TiltLoop.of(VEHICLE, SPEED, p)
    times, expected, _ = loop.step(3.0, np.radians(0.1))

    class Step:
        parameters, rate = p, p.rate

        def __init__(self):
            from railsym.tilt.constants import constants
            from railsym.tilt.servo import Servo

            self.servo = Servo(constants(p))

        def step(self, time, signals):
            self.servo.compare(signals.tilt)
            return self.servo.command(np.radians(0.1), True)

    unit = TiltUnit(Step(), SensorSet(tilt=Sensor(bandwidth=400.0)))
    run(unit, 3.0, track=None)
    tilt = unit.record["tilt"]
    np.testing.assert_allclose(tilt, expected[:len(tilt)], atol=0.02 * np.radians(0.1))


def test_margins_tell_where_the_loop_loses_its_hold():
    loop = TiltLoop.of(VEHICLE, SPEED)
    gain = loop.margins().gain
    for factor, stable in ((0.97, True), (1.03, False)):
        p = TiltParameters(kp=0.5 * gain * factor, ki=2.0 * gain * factor)
        radius = np.abs(np.linalg.eigvals(replace(loop, parameters=p).closed().A)).max()
        assert (radius < 1.0 + 1e-9) == stable
    f = np.array([0.2, 1.0, 5.0])
    system = loop.closed()
    direct = [system.C[0] @ np.linalg.solve(z * np.eye(len(system.A)) - system.A, system.B[:, 0]) for z in np.exp(2j * np.pi * f * 0.01)]
    np.testing.assert_allclose(loop.response(f), direct, rtol=1e-9)
    assert "gain margin" in str(loop) and loop.bandwidth() > 1.0


# --- users' controllers ----------------------------------------------------------------------------------------------------

class Answers:
    rate = 50.0

    def __init__(self, answer):
        self.answer = answer

    def step(self, time, signals):
        return 0.01 if time < 0.1 else self.answer


@pytest.mark.parametrize("answer, text", [
    (None, "gave None at t = 0.1 s"), (np.nan, "gave nan"), ([0.1, 0.2], r"an array of shape \(2,\)"), (3.0, r"gave 3 rad \(171\.9 degrees\)"),
    ("left", "gave 'left'"), (1j, "gave 1j"), ({}, r"gave \{\}")])
def test_nonsense_of_a_controller_is_named_and_the_run_is_kept(answer, text):
    with pytest.raises(ControllerError, match=text) as caught:
        run(TiltUnit(Answers(answer)), 1.0)
    assert "one finite number within" in str(caught.value)
    assert caught.value.run.status == "interrupted" and caught.value.run.time[-1] == pytest.approx(0.1)


def test_a_controller_of_one_method_tilts():
    unit = TiltUnit(Answers(0.05))
    assert run(unit, 2.0)["car.roll"][-1] > 0.02 and len(unit.record) == 100
    with pytest.raises(TiltError, match="a method step"):
        TiltUnit(object())
    with pytest.raises(TiltError, match="samples at 50 Hz"):
        TiltUnit(Answers(0.0), rate=100.0)
    with pytest.raises(TiltError, match="whole number of steps"):
        run(TiltUnit(Controller(TiltParameters(rate=300.0, latency=0.0))), 1.0)
    with pytest.raises(TiltError, match="has no actuators"):
        TiltDrive.of(rs.load_vehicle("pendolino"))


LAW = """
#include <math.h>
struct memory { double lean, until; };
int lean(void *context, double time, const double *signal, double *command, double *output)
{
	struct memory *m = context;
	*command = time < m->until ? m->lean : NAN;
	output[1] = 2.0 * signal[4];
	return 0;
}
int stop(void *context, double time, const double *signal, double *command, double *output) { *command = 0.0; return time > 0.105 ? 7 : 0; }
"""


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_a_users_law_in_c(tmp_path):
    (tmp_path / "law.c").write_text(LAW)
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", str(tmp_path / "law.c"), "-o", str(tmp_path / "law.so"), "-lm"], check=True)
    made = CompiledLaw(tmp_path / "law.so", "lean", rate=50.0, context=np.array([0.03, 10.0]).tobytes())
    unit = TiltUnit(made, SensorSet.ideal())
    found = run(unit, 2.0)
    assert found["car.roll"][-1] > 0.02 and np.array_equal(unit.record["demand"], 2.0 * unit.record["tilt"])
    wrong = CompiledLaw(tmp_path / "law.so", "lean", rate=50.0, context=np.array([0.03, 0.2]).tobytes())
    with pytest.raises(ControllerError, match="lean: it gave nan rad at t = 0.2 s") as caught:
        run(TiltUnit(wrong), 2.0)
    assert caught.value.run.time[-1] == pytest.approx(0.2)
    with pytest.raises(ControllerError, match="stopped the run at t = 0.12 s with status 7"):
        run(TiltUnit(CompiledLaw(tmp_path / "law.so", "stop", rate=50.0)), 2.0)
    with pytest.raises(TiltError, match="no function 'leen'"):
        CompiledLaw(tmp_path / "law.so", "leen")


# --- faults and other sources --------------------------------------------------------------------------------------------------

def test_actuators_that_stick_at_full_tilt_end_in_a_reported_state():
    unit = TiltUnit(Controller(TiltParameters(share=1.4)))
    stuck = Failing(TiltDrive.of(VEHICLE).actuators, "stuck", 5.0)
    found = run(unit, 9.5, also=[(stuck, 100.0)])
    assert [(r.fault.name, r.state.name) for r in unit.reports] == [("ACTUATOR", "FAILED")] and unit.state == State.FAILED
    assert found.status == "completed" and found.info.extra["faults"][0]["fault"] == "stuck"
    assert unit.record["tilt"].max() < np.radians(8.1) and unit.record["tilt"][-1] > np.radians(6.0)
    assert unit.record["demand"][-1] < np.radians(6.0)


def test_leading_vehicle_takes_the_lag_away():
    p = TiltParameters(follow_tolerance=np.radians(2.0))
    ahead = TiltUnit(Controller(p), SensorSet(seed=2))
    run(ahead, 9.4)
    late = p.filter_delay(p.lateral_cutoff) + p.latency + p.follow_delay
    law = LeadingSignals(Controller(p.with_(source="leading", ahead=25.9 + 9.5, lead=late)), ahead.record, 25.9, SPEED)
    unit = TiltUnit(law)
    run(unit, 8.0)
    assert law.distance == pytest.approx(25.9, abs=0.2)
    record = unit.record
    outputs = law.controller.replay(record.time, record)
    assert outputs.tobytes() == np.column_stack([record[name] for name in OUTPUTS]).tobytes()

    def middle(found):
        return np.interp(0.03, found["demand"][100:400], found.time[100:400])

    assert middle(ahead.record) - middle(record) == pytest.approx(late - 9.5 / SPEED, abs=0.1)
    with pytest.raises(TiltError, match="source='leading'"):
        LeadingSignals(Controller(p), ahead.record, 25.9, SPEED)
