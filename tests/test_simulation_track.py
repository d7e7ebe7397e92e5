# SPDX-License-Identifier: BSD-3-Clause
"""Runs on curved and irregular track: frames in motion, kinks, symmetry, steady curves, order."""

import numpy as np
import pytest

import railsym as rs
from railsym.model import Model
from railsym.simulation import Simulation
from railsym.track import Curve, Straight, Track, Transition
from railsym.track_frames import UniformTrack, body_motion, relative_poses
from railsym.conical_contact import Cone, ConicalContact

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = ConicalContact(zones=(Cone(0.1),))


def entry(direction="right", radius=1500.0):
    return Track([Straight(10.0), Transition(40.0), Curve(radius, 200.0, 0.06, direction)])


def simulated(track, dt=1e-3, duration=2.0, **options):
    simulation = Simulation(BOGIE, speed=20.0, track=track, dt=dt, channels=["*.y", "*.yaw", "*.roll", "*.rate", "*.s"], rate=100.0, **options)
    simulation.run(duration)
    assert simulation.ending.reason == "completed", simulation.ending
    return simulation


def test_straight_track_object_is_no_track():
    """Frames that move on a straight track give the same motion as inputs that stand still."""
    moved = {"frame.y": 2e-3}
    with_track = simulated(Track.straight(200.0), duration=0.5, initial=moved).result()
    without = simulated(None, duration=0.5, initial=moved).result()
    for name in without.channels:
        np.testing.assert_allclose(with_track[name], without[name], rtol=0, atol=1e-12 * (1.0 + np.abs(without[name]).max()))


def test_inputs_in_a_curve_are_those_of_uniform_track():
    """What C writes into the kernels on a circular curve against the constant inputs of a model of that curve."""
    sim = Simulation(BOGIE, speed=30.0, track=Track([Curve(400.0, 300.0, 0.1)], rounding=1.0), start=150.0, channels="s")
    integrator, model = sim.parts.integrator, Model(BOGIE, UniformTrack(1.0 / 400.0, float(np.arcsin(0.1 / 1.5)), 0.0))
    model.set_preload(sim.parts.preload.bushing_forces, sim.parts.preload.law_forces)
    model.set_speed(30.0)
    from railsym.contact import LinearContact
    from railsym.linear import RollingVehicle

    model.add_wheels(RollingVehicle(BOGIE).contacts(LinearContact().resolved(BOGIE.contact)))
    model.set_speed(30.0)
    rng = np.random.default_rng(3)
    q, u, a = 1e-3 * rng.normal(size=(3, model.size))
    u += model.rolling(30.0)
    expected = model.residual(q, u, a)
    hold = sim.parts.names.index("car.x")
    found = integrator.residual(0.0, q, u, a)
    found[hold] = expected[hold]  # the drive holds the car body
    np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("contact", ["linear", CONES])
def test_mirrored_curve_gives_mirrored_motion(contact):
    right, left = (simulated(entry(direction), contact=contact, duration=3.0).result() for direction in ("right", "left"))
    worst = max(np.abs(right[f"{b.name}.y"]).max() for b in BOGIE.bodies)
    assert worst > 1e-3
    for body in BOGIE.bodies:
        for name in ("y", "yaw", "roll"):
            np.testing.assert_allclose(left[f"{body.name}.{name}"], -right[f"{body.name}.{name}"], atol=1e-8 * worst)


def test_second_order_through_a_curve_entry():
    """The clothoid's ends are kinks, where steps land; each body passes them at its own time."""
    track, ends = entry(), []
    for dt in (1e-3, 5e-4, 5e-4 / 8):
        sim = simulated(track, dt, 2.6, tolerance=1e-6)
        ends.append(sim.parts.integrator.state())
        assert sim.parts.kinks(2.6).size >= 4
    used = ~sim.parts.model.topology.cyclic
    for part in (0, 1):
        coarse, fine = (np.abs(ends[k][part] - ends[2][part])[used].max() for k in (0, 1))
        assert np.log2(coarse / fine) > 1.75, (part, coarse, fine)


def test_steady_curve_is_an_equilibrium():
    """After the transients the residual of the motion at rest in the curve vanishes: attitude against Newton's solution."""
    from scipy.optimize import root

    sim = simulated(entry(radius=1000.0), duration=12.0, drive="held")
    q, u, a = sim.parts.integrator.state()
    names = list(sim.parts.names)
    spins = [names.index(f"{b.name}.spin") for b in BOGIE.bodies if b.kind == "wheelset"]
    second = np.arange(sim.parts.second)

    def unbalance(x):
        """Coordinates at rest, wheelsets turning at constant rates: their spins are unknown in place of their angles."""
        place, rate = q.copy(), np.zeros_like(u)
        place[:] = x
        rate[spins], place[spins] = x[spins], 0.0
        return sim.parts.integrator.residual(sim.time, place, rate, np.zeros_like(a))

    first = q.copy()
    first[spins] = u[spins]
    scale = np.where(np.isin(np.arange(len(q)), spins), 1.0, 1e-4)
    found = root(lambda y: unbalance(first + scale * y) / 1e3, np.zeros(len(q)), method="hybr", tol=1e-12)
    assert np.abs(found.fun).max() < 1e-6
    steady = first + scale * found.x
    lateral = [k for k in second if names[k].endswith((".y", ".yaw", ".roll"))]
    np.testing.assert_allclose(q[lateral], steady[lateral], atol=2e-6)  # what is left of the entry after 10 s
    assert np.abs(steady[lateral]).max() > 1e-3


def test_irregular_track_shakes_and_repeats():
    track = Track.straight(300.0).with_irregularity("erri_b176_low", seed=1)
    first, second = (simulated(track, contact=CONES, duration=3.0).result() for _ in range(2))
    for name in first.channels:
        assert first[name].tobytes() == second[name].tobytes()
    assert 1e-5 < np.abs(first["wheelset1.y"]).max() < 2e-2
    other = simulated(Track.straight(300.0).with_irregularity("erri_b176_low", seed=2), contact=CONES, duration=3.0).result()
    assert np.abs(other["wheelset1.y"] - first["wheelset1.y"]).max() > 1e-5


def test_poses_and_motions_are_used():
    """The oracle of the inputs is itself curved: poses of far bodies differ from straight ones."""
    track = UniformTrack(1.0 / 400.0)
    pair = Model(BOGIE).bushing_pairs
    assert np.abs(relative_poses(track, 30.0, pair)["dD"]).max() > 0.0 and body_motion(track, 30.0, 0.0, 9.81)["w2"] == 30.0 / 400.0


def test_slow_wheelsets_follow_their_rails():
    """At 4 m/s a wheelset's height and roll are those of the rails under it: what comes from the track arrives at the right wheel."""
    track = Track.straight(60.0).with_irregularity("erri_b176_low", seed=1, fade=3.0)
    sim = Simulation(BOGIE, speed=4.0, track=track, contact=CONES, channels=["s", "wheelset?.z", "wheelset?.roll", "wheelset?.y"], rate=50.0)
    sim.run(10.0)
    run = sim.result()
    for wheelset in (body for body in BOGIE.bodies if body.kind == "wheelset"):
        rails = track.rails(run["s"] + wheelset.position[0])
        height, name = 0.5 * (rails.left_z + rails.right_z), wheelset.name
        assert np.std(height) > 5e-4
        np.testing.assert_allclose(run[f"{name}.z"], height, atol=0.05 * np.abs(height).max())
        # the cone rolls by the cross level, and by its own lateral shift against the rails
        shift = run[f"{name}.y"] - 0.5 * (rails.left_y + rails.right_y)
        roll = (rails.right_z - rails.left_z) / 1.5 - 0.1 * shift / (0.75 - 0.46 * 0.1)
        np.testing.assert_allclose(run[f"{name}.roll"], roll, atol=0.08 * np.abs(roll).max())


@pytest.mark.parametrize("speed", [20.0, [(0.0, 20.0), (0.5, 26.0)]])
def test_free_body_flies_straight_past_a_transition(speed):
    """Nothing touches it: seen from a frame that turns, cants, climbs and speeds up, its motion in space stays uniform."""
    from oracles import free_bodies
    from oracles.stepping import integrator

    from railsym import _core
    from railsym._core_integrator import Travel
    from railsym.simulation import SpeedProfile

    body, track, profile = free_bodies.rigid_body(), Track([Straight(4.0), Transition(12.0), Curve(80.0, 60.0, 0.1)]), SpeedProfile.of(speed)
    model = Model(free_bodies.vehicle(body))
    travel = Travel(track.core.pointer, [0.0], profile.pieces, 0.0, keep=track)
    travel.add_bodies(model.assembly, _core.kernels()["rigid_body"].number, [0])
    offset = np.array([0.0, *body.position[1:]])

    def place(time, q):
        frame = track.core.frames(np.array([float(profile.place(time))]))[0]
        return frame["place"] + frame["attitude"] @ (offset + q[:3])

    error = []
    for step in (1e-3, 5e-4):
        it = integrator(model, step, tolerance=1e-8)
        it.set_travel(travel)
        it.set_kinks(np.sort(np.append(profile.when(track.kinks[track.kinks > 0.0]), 0.5)))
        assert it.start(0.0, np.zeros(6), np.zeros(6)) == 0
        it.set_channels([])
        assert it.run(round(1.0 / step), 1, np.empty((2000, 0)))[0] == 0
        error.append(np.abs(place(1.0, it.state()[0]) - place(0.0, np.zeros(6)) - [20.0, 0.0, 0.0]).max())
    assert error[1] < 5e-4 and np.log2(error[0] / error[1]) > 1.7
