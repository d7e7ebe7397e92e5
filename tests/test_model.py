# SPDX-License-Identifier: BSD-3-Clause
"""The assembled model: what elements feel in a curve, and names and order of its coordinates."""

import numpy as np
import pytest

from railsym.model import Model
from railsym.track_frames import UniformTrack
from railsym.vehicle import load_vehicle

RADIUS = 300.0


def rows(name, track=UniformTrack()):
    """Residual at rest at the design position, by coordinate name."""
    model = Model(load_vehicle(name), track)
    model.set_speed(0.0)
    return dict(zip(model.topology.coordinates, model.residual(), strict=True))


def test_bogie_in_a_right_curve_turns_its_wheelsets_towards_parallel():
    """Axles radial, frame on the chord: springs are stretched by the curve's own geometry."""
    straight, curve = rows("bogie"), rows("bogie", UniformTrack(curvature=1 / RADIUS))
    stiffness = load_vehicle("bogie").parameters["primary.stiffness"].value
    angle, half_axle = 1.35 / RADIUS, 1.0
    moment = 2 * stiffness[0] * half_axle**2 * angle
    offset = 1.35**2 / (2 * RADIUS)  # of the wheelset from the tangent under the frame, to the right
    change = {key: curve[key] - straight[key] for key in straight}
    # A residual is minus the force; the next terms of the curve are angle^2 smaller, 2e-5.
    assert change["wheelset1.yaw"] == pytest.approx(moment, rel=1e-4)
    assert change["wheelset2.yaw"] == pytest.approx(-moment, rel=1e-4)
    assert change["wheelset1.y"] == pytest.approx(2 * stiffness[1] * offset, rel=1e-4)
    assert change["frame.y"] == pytest.approx(-4 * stiffness[1] * offset, rel=1e-4)


def test_mirrored_curves_give_mirrored_forces():
    left, right = (rows("bogie", UniformTrack(curvature=c, cant_angle=np.sign(c) * 0.1)) for c in (-1 / RADIUS, 1 / RADIUS))
    for name, value in right.items():
        odd = name.rsplit(".", 1)[1] in ("y", "yaw", "roll")
        other = name.replace("left", "?").replace("right", "left").replace("?", "right")
        # Weights of 190 kN at roundoff.
        assert left[other] == pytest.approx(-value if odd else value, abs=1e-8)


def test_cant_alone_moves_nothing_but_gravity():
    """On a canted straight every frame is canted alike: weight m g along y and z, no element works."""
    cant, vehicle = 0.12, load_vehicle("bogie")
    found = rows("bogie", UniformTrack(cant_angle=cant))
    for body in vehicle.bodies:
        mass = body.mass + sum(box.mass for box in body.axleboxes)
        assert found[f"{body.name}.y"] == pytest.approx(-mass * 9.81 * np.sin(cant), rel=1e-12)
        assert found[f"{body.name}.z"] == pytest.approx(-mass * 9.81 * np.cos(cant), rel=1e-12)


def test_running_through_a_curve_needs_the_centripetal_force():
    """At speed V the whole vehicle is pulled to the inside by m V^2 / R: the residual is m a - F."""
    vehicle, speed = load_vehicle("cooperrider"), 20.0
    model = Model(vehicle, UniformTrack(curvature=1 / RADIUS))
    model.set_speed(0.0)
    rest = model.residual()
    model.set_speed(speed)
    change = dict(zip(model.topology.coordinates, model.residual() - rest, strict=True))
    for body in vehicle.bodies:
        assert change[f"{body.name}.y"] == pytest.approx(body.mass * speed**2 / RADIUS, rel=1e-9)


def test_coordinates_come_body_by_body_then_the_maxwell_states():
    names = Model(load_vehicle("bogie")).topology.coordinates
    own = [f"wheelset1.{c}" for c in ("x", "y", "z", "yaw", "roll", "spin", "axlebox_left.pitch", "axlebox_right.pitch")]
    start = names.index("wheelset1.x")
    assert list(names[start:start + 8]) == own
    assert names[-1].endswith(".s") and not any(n.endswith(".s") for n in names[:start + 16])
