# SPDX-License-Identifier: BSD-3-Clause
"""rs.simulate: runs in pieces, channels, speed profiles, controllers, and how a run ends."""

import numpy as np
import pytest

import railsym as rs
from railsym.errors import SimulationError, TrackError
from railsym.simulation import Simulation, SpeedProfile
from railsym.conical_contact import Cone, ConicalContact

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = ConicalContact(zones=(Cone(0.1),))
MOVED = {"frame.y": 2e-3, "frame.roll.rate": 0.01}


def bogie(**options):
    return Simulation(BOGIE, **{"speed": 40.0, "initial": MOVED, "channels": "all", "rate": 1000.0} | options)


@pytest.mark.parametrize("contact", ["linear", CONES])
def test_one_piece_and_ten_pieces_are_the_same_bytes(contact):
    whole, pieces = bogie(contact=contact), bogie(contact=contact)
    whole.run(0.2)
    for _ in range(10):
        pieces.run(0.02)
    first, second = whole.result(), pieces.result()
    assert len(first) == 201 and first.status == second.status == "completed"
    for name in ("time", *first.channels):
        assert first[name].tobytes() == second[name].tobytes(), name
    again = bogie(contact=contact)
    again.run(0.2)
    assert again.parts.integrator.state().tobytes() == whole.parts.integrator.state().tobytes()


def test_pieces_that_end_at_a_bend_are_the_same_bytes_too():
    speed, track = [(0.02, 20.0), (0.0712, 20.5), (0.1, 20.2)], rs.Track.curve(800.0, 50.0, transition=20.0, cant=0.05, before=0.5)
    ends = []
    for pieces in (1, 10):
        simulation = bogie(speed=speed, track=track, contact=CONES, channels="s")
        for _ in range(pieces):
            simulation.run(0.2 / pieces)
        ends.append(simulation.parts.integrator.state().tobytes())
    assert ends[0] == ends[1] and len(simulation.parts.kinks(0.2)) > 3


def test_accelerations_are_second_derivatives_of_where_the_points_are():
    """A point of the frame, by differences of its place at the ends of steps; and falling freely it reads -g."""
    run = rs.simulate(BOGIE, speed=40.0, duration=0.3, dt=2.5e-4, rate=4000.0, initial=MOVED, channels="all",
                      markers={"probe": ("frame", BOGIE.body("frame").position + [0.7, -0.4, 0.2])})
    angles = np.array([run[f"frame.{name}"] for name in ("yaw", "roll", "pitch")])
    from railsym.simulation.markers import rotations

    turn = rotations(angles)
    place = np.array([run[f"frame.{name}"] for name in "xyz"]).T + turn @ [0.7, -0.4, 0.2]
    second = (place[2:] - 2.0 * place[1:-1] + place[:-2]) * 4000.0 ** 2
    reads = np.einsum("nji,nj->ni", turn[1:-1], second - [0.0, 0.0, BOGIE.gravity]) + [0.0, 0.0, BOGIE.gravity]
    found = np.array([run[f"probe.a{axis}"] for axis in "xyz"]).T[1:-1]
    size = np.abs(found[20:]).max()
    np.testing.assert_allclose(found[20:], reads[20:], atol=0.02 * size)  # differences over 0.25 ms of motions at 200 Hz


def test_element_forces_are_those_of_the_laws():
    """A bushing's force is -k e, a Maxwell damper's k_s (e - s): by hand from the coordinates."""
    run = rs.simulate(BOGIE, speed=40.0, duration=0.05, initial=MOVED, channels="all")
    maxwell = next(e for e in BOGIE.elements if e.type == "maxwell")
    e0 = maxwell.second.position - maxwell.first.position
    bodies = {end.body: BOGIE.body(end.body) for end in (maxwell.first, maxwell.second)}
    from railsym.simulation.markers import rotations

    ends = []
    for end in (maxwell.first, maxwell.second):
        q = np.array([run[f"{end.body}.{name}"] for name in ("x", "y", "z", "yaw", "roll", "pitch")])
        ends.append(bodies[end.body].position + q[:3].T + rotations(q[3:]) @ (end.position - bodies[end.body].position))
    stretch = np.linalg.norm(ends[1] - ends[0], axis=1) - np.linalg.norm(e0)
    force = maxwell.parameters["series_stiffness"] * (stretch - run[f"{maxwell.name}.s"])
    scale = np.abs(force).max()
    assert scale > 100.0
    np.testing.assert_allclose(run[f"{maxwell.name}.force"], force, atol=1e-6 * scale)


def test_wheel_forces_carry_the_vehicle():
    vehicle = rs.load_vehicle("pendolino")
    run = rs.simulate(vehicle, speed=50.0, duration=0.2, contact=CONES, channels=["*.Q", "*.sum_Y", "*.zone0.load", "wheelset?.y"])
    weight = vehicle.gravity * sum(b.mass + sum(box.mass for box in b.axleboxes) for b in vehicle.bodies)
    total = np.sum([run[name] for name in run.channels.match("*.Q")], axis=0)
    np.testing.assert_allclose(total[:2], weight, rtol=0.01)   # the design position is that of wheels that do not roll
    np.testing.assert_allclose(total[20:], weight, rtol=1e-3)
    assert np.abs(run["wheelset1.y"]).max() < 1e-9
    assert run.info.creep_law == "fastsim" and run.info.extra["counts"]["steps"] == 200


def test_speed_profile():
    profile = SpeedProfile([1.0, 3.0, 5.0], [20.0, 30.0, 30.0], start=7.0)
    t = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 9.0])
    np.testing.assert_allclose(profile.place(t), [7.0, 27.0, 49.5, 77.0, 107.0, 257.0], rtol=1e-14)
    np.testing.assert_allclose(profile.when(profile.place(t)), t, atol=1e-13)
    np.testing.assert_allclose(profile.at(t), [20.0, 20.0, 25.0, 30.0, 30.0, 30.0])
    for wrong in (0.0, -3.0, np.nan, [(0.0, 10.0), (0.0, 20.0)], [(0.0, 10.0), (1.0, 0.0)], [1.0, 2.0]):
        with pytest.raises(SimulationError, match="speed"):
            SpeedProfile.of(wrong)


def test_held_vehicle_follows_an_acceleration():
    """0.5 m/s^2 for 4 s: the vehicle stays within centimetres of its frames and its wheels turn as fast as it rolls."""
    simulation = bogie(speed=[(0.0, 20.0), (0.5, 20.0), (4.5, 22.0)], initial=None, rate=10.0)
    simulation.run(5.0)
    run = simulation.result()
    assert run.status == "completed" and run["V"][-1] == 22.0
    assert max(np.abs(run[f"{b.name}.x"]).max() for b in BOGIE.bodies) < 0.02
    wheelset = BOGIE.body("wheelset1")
    assert run["wheelset1.spin.rate"][-1] == pytest.approx(-22.0 / wheelset.wheel_radius, rel=1e-4)
    assert run["car.ax"][20] == pytest.approx(0.5, abs=0.05)


def test_free_vehicle_coasts_as_held_one_on_straight_track():
    free, held = (bogie(drive=drive, initial={"frame.y": 2e-3}) for drive in ("free", "held"))
    for simulation in (free, held):
        simulation.run(0.3)
    np.testing.assert_allclose(free.result()["frame.y"], held.result()["frame.y"], atol=1e-6 * 2e-3)
    with pytest.raises(SimulationError, match="drive 'towed'"):
        bogie(drive="towed")


def test_controller_sets_forces_at_its_rate():
    seen = []

    def push(controls):
        seen.append(controls.time)
        controls.force("car.y", 1000.0 if controls.time < 0.05 else 0.0)
        assert controls.position("car.y") == controls._state[1][0][controls._parts.names.index("car.y")]

    simulation = bogie(initial=None)
    simulation.run(0.1, controllers=[(push, 100.0)])
    np.testing.assert_allclose(seen, np.arange(10) * 0.01, atol=1e-12)
    assert abs(simulation.result()["car.y"]).max() > 1e-6
    with pytest.raises(SimulationError, match="car.wobble"):
        bogie().run(0.01, controllers=[(lambda c: c.force("car.wobble", 1.0), 100.0)])
    with pytest.raises(SimulationError, match="actuators of this vehicle are none"):
        bogie().run(0.01, controllers=[(lambda c: c.command("primary.x", 1.0), 100.0)])


def test_a_c_controller_does_what_the_python_one_does():
    """Called from the loop in C before every tenth step, by its pointer: the same bytes; and what it returns ends the run."""
    from railsym._railsym import ffi

    python, compiled, stopped = (bogie(initial=None) for _ in range(3))
    number = python.parts.names.index("car.y")
    python.run(0.1, controllers=[(lambda c: c.force("car.y", 1000.0 * (c.time < 0.05)), 100.0)])

    def push(context, time, q, u, a):
        compiled.parts.integrator.force[number] = 1000.0 * (time < 0.05 - 1e-9)
        return 0

    pointer = ffi.callback("rs_controller", push)
    compiled.parts.integrator.set_controller(pointer, 10)
    compiled.run(0.1)
    assert np.array_equal(compiled.result()["car.y"], python.result()["car.y"])
    ends = ffi.callback("rs_controller", lambda context, time, q, u, a: int(time > 0.0449))
    stopped.parts.integrator.set_controller(ends, 10)
    stopped.run(0.1)
    assert stopped.ending.reason == "interrupted" and "controller stopped the run" in str(stopped.ending)
    assert 0.04 < stopped.time < 0.06


def test_not_finite_is_named():
    simulation = bogie()
    simulation.run(0.02)
    simulation.parts.integrator.force[simulation.parts.names.index("frame.yaw")] = np.nan
    simulation.run(0.02)
    run = simulation.result()
    assert run.status == "not_converged" and "frame.yaw" in run.message and "not finite" in run.message
    assert run.time[-1] == pytest.approx(0.02) and np.isfinite(run["frame.y"]).all()


@pytest.mark.parametrize(("dt", "rates"), [(0.02, {"frame.yaw.rate": 30.0}), (0.05, {"frame.yaw.rate": 100.0, "frame.roll.rate": 50.0})])
def test_step_too_large_stops_with_what_there_is(dt, rates):
    """A frame thrown at several turns a second, at a step in which its attitude changes by a radian or more."""
    run = rs.simulate(BOGIE, speed=40.0, duration=2.0, dt=dt, rate=1.0 / dt, initial=rates)
    assert run.status == "not_converged" and run.time[-1] == pytest.approx(run.info.ending.time, abs=1e-12) and run.time[-1] < 0.5
    assert f"the iteration of a step of {dt:g} s stuck at " in run.message and f"dt={dt / 4:g}" in run.message
    assert any(name in run.message for name in bogie().parts.names)


def test_derailment_names_the_wheel():
    run = rs.simulate(BOGIE, speed=20.0, duration=3.0, contact=CONES, initial={"wheelset2.y.rate": 8.0})
    assert run.status == "derailed" and run.info.ending.wheel in ("wheelset2.left", "wheelset2.right")
    front = max(body.position[0] for body in BOGIE.bodies)
    assert "outside the contact table" in run.message and run.info.ending.time == pytest.approx((run.info.ending.distance + front) / 20.0)


def test_interruption_keeps_the_run():
    def interrupt(controls):
        if controls.time > 0.045:
            raise KeyboardInterrupt

    run = rs.simulate(BOGIE, speed=40.0, duration=5.0, rate=1000.0, controllers=[(interrupt, 100.0)])
    assert run.status == "interrupted" and len(run) == 51


def test_run_is_saved_as_it_goes(tmp_path):
    pytest.importorskip("netCDF4")
    run = rs.simulate(BOGIE, speed=40.0, duration=0.3, initial=MOVED, save=tmp_path / "run.nc")
    read = rs.Run.from_netcdf(tmp_path / "run.nc")
    assert read.status == "completed"
    for name in run.channels:
        assert read[name].tobytes() == run[name].tobytes()


@pytest.mark.parametrize(("options", "message"), [
    ({"dt": 0.0}, "dt = 0.0"), ({"rho": 1.5}, "from 0 to 1"), ({"tolerance": -1.0}, "tolerance"), ({"rate": 5000.0}, "rate 5000.0 Hz"),
    ({"channels": "bogey.y"}, "no channel"), ({"initial": {"frame.why": 1.0}}, "frame.why"), ({"law": "polach"}, "law: these belong to"),
    ({"contact": CONES, "laws": "polach"}, "argument 'laws' is unknown; nearest: 'law'"),
    ({"initial": (np.zeros(3), np.zeros(3))}, "shapes"), ({"markers": {"m": ("frame", [0.0, np.nan, 0.0])}}, "marker 'm'"),
])
def test_bad_input_says_what_and_why(options, message):
    with pytest.raises(SimulationError, match=message):
        bogie(**options)


def test_bad_runs_say_what_and_why():
    for duration in (0.0, -1.0, np.inf, 1e-5):
        with pytest.raises(SimulationError, match="duration"):
            bogie().run(duration)
    with pytest.raises(TrackError, match="beyond its end"):
        bogie(track=rs.Track.straight(100.0), contact=CONES).run(5.0)
    with pytest.raises(SimulationError, match="irregularities, which the linear contact does not see"):
        bogie(track=rs.Track.straight(500.0).with_irregularity("erri_b176_low", seed=1))


def test_steps_land_where_the_speed_bends(monkeypatch):
    """Bends within steps: second order; without landing there the errors are many times larger and fall irregularly."""
    from railsym.simulation.assembled import Assembled

    def errors():
        ends = []
        for dt in (1e-3, 5e-4, 2.5e-4 / 16):
            simulation = Simulation(BOGIE, speed=[(0.02037, 20.0), (0.12051, 20.8)], dt=dt, tolerance=1e-6, channels="s")
            simulation.run(0.15)
            ends.append(simulation.parts.integrator.state())
        used = ~simulation.parts.model.topology.cyclic
        return [np.abs(ends[k][1] - ends[2][1])[used].max() for k in (0, 1)]

    landed = errors()
    monkeypatch.setattr(Assembled, "kinks", lambda self, end: np.empty(0))
    assert np.log2(landed[0] / landed[1]) == pytest.approx(2.0, abs=0.1)
    assert errors()[1] > 5.0 * landed[1]


def test_factors_are_kept_and_serve():
    """One matrix for the run, and hardly more than one residual a step: what a wrong derivative or elimination would cost shows here."""
    vehicle = rs.load_vehicle("pendolino").configured("AS_K")
    simulation = Simulation(vehicle, speed=60.0, initial={"bogie1.y": 1e-3}, channels="s")
    simulation.run(1.0)
    counts = simulation.result().info.extra["counts"]
    assert counts["steps"] == 1000 and counts["pencils"] <= 3 and counts["residuals"] < 1750
