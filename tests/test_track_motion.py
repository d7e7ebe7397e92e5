# SPDX-License-Identifier: BSD-3-Clause
"""The track's frames in the equations of motion: a body that nothing touches flies straight, whatever the track does under it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import free_bodies
from oracles.element_pair import attitude, partial_omega
from scipy.integrate import solve_ivp
from test_free_body_motion import BODIES, TIGHT, motion, start, torque_free

from railsym.model import Model
from railsym.track import Curve, Gradient, Straight, Track, Transition, VerticalCurve

SPEED, SPEED_RATE, GRAVITY, START = 55.0, -4.0, 9.81, 70.0


def winding():
    """Twisting everywhere on the way, with a continuous turning rate: tighter than any railway, so that an error is seen."""
    track = Track([Straight(50), Transition(60, "sine"), Curve(150, 1, cant=0.25), Transition(60, "sine", end_radius=180, end_direction="left", end_cant=0.2),
                   Curve(180, 40, cant=0.2, direction="left")], vertical=[Gradient(60, 0.1), VerticalCurve(length=140), Gradient(11, -0.2)])
    assert not len(track.jumps)
    return track


class Flight:
    """A body in the frame of a track, at s(t) = START + V0 t + dV t^2/2."""

    def __init__(self, body, track):
        self.body, self.track = body, track
        self.model = Model(free_bodies.vehicle(body, gravity=GRAVITY))
        self.kernel = body.kind + ("_with_axleboxes" if body.axleboxes else "")

    def frame(self, time):
        return self.track.frame(START + SPEED * time + 0.5 * SPEED_RATE * time**2), SPEED + SPEED_RATE * time

    def rate(self, time, state):
        frame, speed = self.frame(time)
        for key, value in frame.motion(speed, SPEED_RATE, GRAVITY).items():
            self.model.assembly.set_input(self.kernel, key, [float(value)])
        return motion(self.model, state)

    def inertial(self, time, state):
        """Position, velocity, attitude and angular velocity in inertial axes."""
        frame, speed = self.frame(time)
        q, u = np.split(state, 2)
        omega, turned = speed * frame.turning, frame.attitude
        place = np.array([0.0, *self.body.position[1:]]) + q[:3]
        velocity = turned @ (speed * np.eye(3)[0] + np.cross(omega, place) + u[:3])
        return frame.place + turned @ place, velocity, turned @ attitude(q[3:6]), turned @ (omega + partial_omega(q[3:6]) @ u[3:6])


def test_a_free_body_falls_and_tumbles_as_without_a_track():
    flight, duration = Flight(BODIES["rigid_body"], winding()), 1.6
    first = start(flight.model)
    run = solve_ivp(flight.rate, (0.0, duration), first, **TIGHT)
    place, velocity, turned, omega = flight.inertial(0.0, first)
    found = flight.inertial(duration, run.y[:, -1])
    fall = np.array([0.0, 0.0, GRAVITY])
    assert np.abs(found[0] - (place + duration * velocity + 0.5 * duration**2 * fall)).max() < 1e-8      # 80 m of flight
    assert np.abs(found[1] - (velocity + duration * fall)).max() < 1e-8
    inertia = flight.model.pencil((0, 0, 1), q=np.zeros(6), u=np.zeros(6))[3:6, 3:6]
    order = [1, 2, 0]      # coordinates yaw roll pitch; tensor of x y z = roll pitch yaw
    expected = torque_free(inertia[np.ix_(order, order)], turned, omega, duration)
    assert np.abs(found[2] - expected).max() < 1e-8
    assert np.abs(run.y[:3, -1] - first[:3]).max() > 5.0      # in the frame it went far: the track did turn away


@pytest.mark.parametrize("part", ["turning", "turning_rate"])
def test_the_flight_would_show_a_wrong_frame(part):
    """A thousandth off in what the kernel takes is seen."""
    flight = Flight(BODIES["rigid_body"], winding())
    right = flight.frame

    def wrong(time):
        frame, speed = right(time)
        getattr(frame, part)[...] *= 1.001
        return frame, speed

    first = start(flight.model)
    place, velocity, *_ = flight.inertial(0.0, first)
    flight.frame = wrong
    run = solve_ivp(flight.rate, (0.0, 1.6), first, method="DOP853", rtol=1e-9, atol=1e-9)
    flight.frame = right
    assert np.abs(flight.inertial(1.6, run.y[:, -1])[0] - (place + 1.6 * velocity + [0.0, 0.0, 0.5 * 1.6**2 * GRAVITY])).max() > 1e-5


lengths = st.floats(5.0, 300.0)
curves = st.builds(Curve, radius=st.floats(100.0, 5000.0), length=lengths, cant=st.floats(-0.1, 0.2), direction=st.sampled_from(["left", "right"]))
kinds = st.sampled_from(["clothoid", "bloss", "cosine", "sine", "helmert"])


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.lists(st.tuples(curves, lengths, kinds), min_size=1, max_size=6), st.data())
def test_poses_along_any_track_add_up(parts, data):
    """Frame 3 from frame 1 is frame 3 from frame 2 and frame 2 from frame 1; and frames are rotations."""
    sections = [Straight(20.0)]
    for curve, length, kind in parts:
        sections += [Transition(length, kind), curve]
    track = Track(sections)
    s1, s2, s3 = (data.draw(st.floats(0.0, 1.0)) * track.length for _ in range(3))
    P = track.frame([s1, s2, s3]).attitude
    assert np.abs(np.einsum("nij,nik->njk", P, P) - np.eye(3)).max() < 2e-15 and (np.linalg.det(P) > 0).all()
    speed, offset = 30.0, np.array([0.0, 0.4, -1.1])
    a, b, c = (track.relative_pose(*ends, speed, offset, offset) for ends in ((s1, s2), (s2, s3), (s1, s3)))
    scale = 1.0 + np.abs(s1 - s2) + np.abs(s2 - s3)
    assert np.abs(a["C"] @ b["C"] - c["C"]).max() < 5e-15
    # design places differ from frames' origins by the offset
    assert np.abs(a["D"] + offset + a["C"] @ (b["D"] + offset) - a["C"] @ offset - (c["D"] + offset)).max() < 3e-15 * scale
    assert np.abs(b["wf"] + b["C"].T @ a["wf"] - c["wf"]).max() < 1e-14
