# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that nothing touches, integrated through the assembled residual.

At rest of the frame they keep energy and momentum; seen from a frame that moves in any way
along a track they still fly straight (or fall) and turn as Euler's equations say.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from oracles import free_bodies
from oracles.element_pair import attitude, cross_matrix, partial_omega
from scipy.integrate import solve_ivp

from railsym.model import Model
from railsym.track_frames import UniformTrack, relative_pose

# The integrator's own tolerance; what it makes of it over a second is checked below at 1e-9.
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}
BODIES = {
    "rigid_body": free_bodies.rigid_body(),
    "wheelset": free_bodies.wheelset(axleboxes=False),
    "wheelset_with_axleboxes": free_bodies.wheelset(axleboxes=True),
}
SINGLE = ("rigid_body", "wheelset")
CURVE = UniformTrack(curvature=1 / 250.0, cant_angle=0.1, gradient=-0.03)


def start(model, spin=1.5):
    """A state with large angles and rates."""
    rng = np.random.default_rng(41)
    q, u = rng.uniform(-0.8, 0.8, (2, model.size))
    u[5] = spin
    return np.concatenate([q, u])


def acceleration(model, q, u):
    """a = -M^-1 r(q, u, 0)."""
    return np.linalg.solve(model.pencil((0, 0, 1), q=q, u=u), -model.residual(q, u))


def motion(model, state):
    q, u = np.split(state, 2)
    return np.concatenate([u, acceleration(model, q, u)])


@pytest.mark.parametrize("name", BODIES)
def test_energy_and_momentum_are_kept(name):
    body = BODIES[name]
    model = Model(free_bodies.vehicle(body))
    model.set_speed(0.0)
    first = start(model)
    run = solve_ivp(lambda t, x: motion(model, x), (0.0, 2.0), first, **TIGHT)
    kept = np.array([free_bodies.invariants(body, *np.split(x, 2)) for x in run.y.T])
    assert np.ptp(run.y[3:6], axis=1).min() > 0.1  # it did turn, about every axis
    np.testing.assert_allclose(kept, kept[:1].repeat(len(kept), axis=0), rtol=0, atol=1e-9 * np.abs(kept[0]).max())


@pytest.mark.parametrize("name", BODIES)
def test_kinetic_energy_is_that_of_the_mass_matrix(name):
    body = BODIES[name]
    model = Model(free_bodies.vehicle(body))
    q, u = np.split(start(model), 2)
    energy = 0.5 * u @ model.pencil((0, 0, 1), q=q, u=u) @ u
    assert energy == pytest.approx(free_bodies.invariants(body, q, u)[0], rel=1e-13)  # roundoff


@pytest.mark.parametrize("name", BODIES)
def test_conservation_check_can_fail(name):
    """An acceleration off by a thousandth is seen in the energy's rate."""
    body = BODIES[name]
    model = Model(free_bodies.vehicle(body))
    model.set_speed(0.0)
    q, u = np.split(start(model), 2)

    def rate(factor):
        a, h = factor * acceleration(model, q, u), 1e-4
        after, before = (free_bodies.invariants(body, q + s * u + 0.5 * s * s * a, u + s * a) for s in (h, -h))
        return np.abs(after - before).max() / (2 * h)

    assert rate(1.0) < 1e-6  # central difference, h^2
    assert rate(1.001) > 1e-5


@dataclass
class Flight:
    """A body seen from a frame that moves with V(t) along its x and turns with w(t), both linear in time."""

    body: object
    speed: float
    speed_rate: float
    omega: np.ndarray
    omega_rate: np.ndarray
    gravity: float = 9.81

    def __post_init__(self):
        self.model = Model(free_bodies.vehicle(self.body, gravity=self.gravity))
        self.kernel = self.body.kind + ("_with_axleboxes" if self.body.axleboxes else "")

    def frame(self, time):
        return self.speed + time * self.speed_rate, self.omega + time * self.omega_rate

    def set_frame(self, time, turned):
        """Give the kernel the frame's motion, component by component."""
        speed, omega = self.frame(time)
        motion = {"V": speed, "dV": self.speed_rate}
        vectors = {"w": omega, "dw": self.omega_rate, "grav": turned.T @ [0.0, 0.0, self.gravity]}
        motion |= {f"{key}{k}": value[k] for key, value in vectors.items() for k in range(3)}
        for key, value in motion.items():
            self.model.assembly.set_input(self.kernel, key, [value])

    def rate(self, time, state):
        """Rates of the frame's origin and attitude (P' = P [w]) and of the coordinates."""
        turned = state[3:12].reshape(3, 3)
        speed, omega = self.frame(time)
        self.set_frame(time, turned)
        return np.concatenate([speed * turned[:, 0], (turned @ cross_matrix(omega)).ravel(), motion(self.model, state[12:])])

    def inertial(self, time, state):
        """Position, velocity, attitude and angular velocity of the body in inertial axes."""
        origin, turned = state[:3], state[3:12].reshape(3, 3)
        q, u = np.split(state[12:], 2)
        speed, omega = self.frame(time)
        place = np.array([0.0, *self.body.position[1:]]) + q[:3]
        velocity = turned @ (speed * np.eye(3)[0] + np.cross(omega, place) + u[:3])
        spin = omega + partial_omega(q[3:6]) @ u[3:6]
        return origin + turned @ place, velocity, turned @ attitude(q[3:6]), turned @ spin


def torque_free(inertia, turned, omega, duration):
    """Attitude after Euler's equations I w' = -w x I w, R' = R [w], w in the body."""
    def rate(_, state):
        w, r = state[:3], state[3:].reshape(3, 3)
        return np.concatenate([np.linalg.solve(inertia, -np.cross(w, inertia @ w)), (r @ cross_matrix(w)).ravel()])

    run = solve_ivp(rate, (0.0, duration), np.concatenate([turned.T @ omega, turned.ravel()]), **TIGHT)
    return run.y[3:, -1].reshape(3, 3)


def check_flight(flight, first, last, duration):
    """Compare start and end of a flight in inertial axes with a parabola and Euler's equations."""
    place0, velocity0, turned0, omega0 = flight.inertial(0.0, first)
    place, velocity, turned, _ = flight.inertial(duration, last)
    fall = np.array([0.0, 0.0, flight.gravity])
    expected = place0 + duration * velocity0 + 0.5 * duration**2 * fall
    # Some 60 m are covered; the integrator keeps 12 digits a step.
    np.testing.assert_allclose(place, expected, rtol=0, atol=1e-8)
    np.testing.assert_allclose(velocity, velocity0 + duration * fall, rtol=0, atol=1e-8)
    np.testing.assert_allclose(turned, torque_free(flight.body.inertia, turned0, omega0, duration), rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", SINGLE)
def test_flight_seen_from_a_frame_that_turns_and_speeds_up(name):
    """V, w and their rates by hand; gravity, in inertial axes, turns in the frame."""
    flight = Flight(BODIES[name], 40.0, 3.0, np.array([0.3, -0.2, 0.4]), np.array([-0.5, 0.6, 0.2]))
    first = np.concatenate([np.zeros(3), np.eye(3).ravel(), start(flight.model)])
    run = solve_ivp(flight.rate, (0.0, 1.0), first, **TIGHT)
    check_flight(flight, first, run.y[:, -1], 1.0)


def test_momentum_with_axleboxes_seen_from_a_frame_that_turns_and_speeds_up():
    """Without gravity: total energy and momentum in inertial axes, axleboxes turning on the axle."""
    body = BODIES["wheelset_with_axleboxes"]
    flight = Flight(body, 4.0, 3.0, np.array([0.3, -0.2, 0.4]), np.array([-0.5, 0.6, 0.2]), gravity=0.0)
    first = np.concatenate([np.zeros(3), np.eye(3).ravel(), start(flight.model)])
    run = solve_ivp(flight.rate, (0.0, 1.0), first, **TIGHT)
    kept = np.array([inertial_invariants(flight, t, x) for t, x in zip(run.t, run.y.T, strict=True)])
    np.testing.assert_allclose(kept, kept[:1].repeat(len(kept), axis=0), rtol=0, atol=1e-9 * np.abs(kept).max())


def inertial_invariants(flight, time, state):
    """Energy and momentum of all parts in inertial axes."""
    origin, turned = state[:3], state[3:12].reshape(3, 3)
    speed, omega = flight.frame(time)
    total = np.zeros(7)
    for mass, inertia, own, place, velocity, spin in free_bodies.parts(flight.body, *np.split(state[12:], 2)):
        velocity = turned @ (velocity + speed * np.eye(3)[0] + np.cross(omega, place))
        spin, place, axes = turned @ (spin + omega), origin + turned @ place, turned @ own
        moment = axes @ inertia @ axes.T @ spin
        energy = 0.5 * mass * velocity @ velocity + 0.5 * spin @ moment
        total += np.concatenate([[energy], mass * velocity, moment + mass * np.cross(place, velocity)])
    return total


@pytest.mark.parametrize("speed_rate", [0.0, 2.0])
@pytest.mark.parametrize("name", SINGLE)
def test_flight_seen_from_a_canted_graded_curve(name, speed_rate):
    """The track's own position and attitude bring the motion to inertial axes."""
    speed, duration, body = 50.0, 1.0, BODIES[name]
    model = Model(free_bodies.vehicle(body, gravity=9.81), CURVE)

    def rate(time, state):
        model.set_speed(speed + time * speed_rate, speed_rate)
        return motion(model, state)

    def placed(time, state):
        s = speed * time + 0.5 * speed_rate * time**2
        return np.concatenate([CURVE.position(s), CURVE.attitude(s).ravel(), state])

    first = start(model, spin=-4.0)
    run = solve_ivp(rate, (0.0, duration), first, **TIGHT)
    flight = Flight(body, speed, speed_rate, speed * CURVE.turning(), speed_rate * CURVE.turning())
    check_flight(flight, placed(0.0, first), placed(duration, run.y[:, -1]), duration)


# Central differences: h^2/6 times the third derivative (curvature^2), and roundoff of 300 m over h.
STEP, DIFFERENCE = 1e-2, 1e-9


@pytest.mark.parametrize("s", [-40.0, 0.0, 300.0])
@pytest.mark.parametrize("track", [CURVE, UniformTrack(-1 / 400.0, -0.08, 0.02), UniformTrack(gradient=0.04)])
def test_track_frame_follows_the_centreline(track, s):
    """o' = P e_x and P' = P [turning]."""
    ahead, behind = s + STEP, s - STEP
    slope = (track.position(ahead) - track.position(behind)) / (2 * STEP)
    turned = (track.attitude(ahead) - track.attitude(behind)) / (2 * STEP)
    np.testing.assert_allclose(slope, track.attitude(s)[:, 0], rtol=0, atol=1e-8)
    np.testing.assert_allclose(turned, track.attitude(s) @ cross_matrix(track.turning()), rtol=0, atol=DIFFERENCE)


def test_signs_of_curve_cant_and_gradient():
    """Right curves turn right, cant lifts the left rail, a positive gradient climbs."""
    right = UniformTrack(curvature=1 / 300.0)
    assert right.position(10.0)[1] > 0.0 and right.turning()[2] > 0.0
    assert UniformTrack(cant_angle=0.1).gravity(9.81)[1] == pytest.approx(9.81 * np.sin(0.1))  # towards the right, lower rail
    uphill = UniformTrack(gradient=0.02)
    assert uphill.position(100.0)[2] == pytest.approx(-100.0 * np.sin(0.02))  # z is down
    assert uphill.gravity(9.81)[0] == pytest.approx(-9.81 * np.sin(0.02))


def frame_of(track, place, travelled):
    """Attitude of a body's frame and its design position, inertial, after the vehicle travelled."""
    s = place[0] + travelled
    return track.attitude(s), track.position(s) + track.attitude(s) @ [0.0, *place[1:]]


def test_relative_pose_and_its_rates():
    """D and C from positions and attitudes; their rates by differences in time.

    A uniform track is a screw: two frames on it keep their relative pose, so each rate is a
    sum of terms of some metres a second that must cancel.
    """
    places, speed = (np.array([9.5, 0.4, -0.6]), np.array([-3.0, -0.7, -1.8])), 60.0

    def pose(travelled):
        (turned1, point1), (turned2, point2) = (frame_of(CURVE, p, travelled) for p in places)
        return turned1.T @ (point2 - point1), turned1.T @ turned2

    found = relative_pose(CURVE, speed, *places)
    between, turned = pose(0.0)
    np.testing.assert_allclose(found["D"], between, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found["C"], turned, rtol=0, atol=1e-14)
    (ahead, turned_ahead), (behind, turned_behind) = pose(STEP), pose(-STEP)
    np.testing.assert_allclose(found["dD"], speed * (ahead - behind) / (2 * STEP), rtol=0, atol=1e-8)
    spin = speed * turned.T @ (turned_ahead - turned_behind) / (2 * STEP)
    np.testing.assert_allclose(cross_matrix(found["wf"]), spin, rtol=0, atol=1e-9)
    assert np.abs(speed * np.cross(CURVE.turning(), between)).max() > 1.0  # what cancels is not small
