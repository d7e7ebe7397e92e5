# SPDX-License-Identifier: BSD-3-Clause
"""Bodies without a vehicle file, and their kinetic energy and momentum by hand."""

from types import SimpleNamespace

import numpy as np
from oracles.element_pair import attitude, turn


def full_tensor(principal, seed):
    """Inertia tensor with these principal values on skew axes."""
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return axes @ np.diag(principal) @ axes.T


def rigid_body(position=(0.0, 0.3, -1.2)):
    return SimpleNamespace(name="body", kind="rigid_body", position=np.array(position), mass=2.5,
                           inertia=full_tensor([1.1, 2.3, 2.9], 31), axleboxes=())


def wheelset(axleboxes, position=(0.0, 0.2, -0.46)):
    boxes = [SimpleNamespace(name=f"body.axlebox_{label}", side=side, mass=0.4 + 0.1 * side,
                             inertia=full_tensor([0.11, 0.13, 0.2], 32 + side), lateral_position=side * 1.0,
                             centre_offset=np.array([0.2, 0.05 * side, -0.1]))
             for side, label in ((-1, "left"), (1, "right"))]
    return SimpleNamespace(name="body", kind="wheelset", position=np.array(position), mass=1.9,
                           inertia=np.diag([1.2, 0.3, 1.2]), wheel_radius=0.46, contact_half_spacing=0.75,
                           axleboxes=tuple(boxes) if axleboxes else ())


def vehicle(*bodies, gravity=0.0):
    return SimpleNamespace(name="free", bodies=bodies, elements=(), gravity=gravity)


def parts(body, q, u):
    """Mass, inertia, attitude, position, velocity and angular velocity of each rigid part.

    Everything in the axes that q and u are counted in, which rest.
    """
    centre = np.array([0.0, *body.position[1:]]) + q[:3]
    yawed = turn(2, q[3])
    rolled = yawed @ turn(0, q[4])
    axle, guided = rolled[:, 1], u[3] * np.eye(3)[2] + u[4] * yawed[:, 0]
    found = [(body.mass, body.inertia, attitude(q[3:6]), centre, u[:3], guided + u[5] * axle)]
    for k, box in enumerate(body.axleboxes, start=6):
        turned, omega = rolled @ turn(1, q[k]), guided + u[k] * axle
        arm = turned @ (np.array([0.0, box.lateral_position, 0.0]) + box.centre_offset)
        found.append((box.mass, box.inertia, turned, centre + arm, u[:3] + np.cross(omega, arm), omega))
    return found


def invariants(body, q, u):
    """Kinetic energy (1), linear momentum (3), angular momentum about the origin (3); shape (7,)."""
    energy, momentum, spin = 0.0, np.zeros(3), np.zeros(3)
    for mass, inertia, turned, place, velocity, omega in parts(body, q, u):
        own = turned @ inertia @ turned.T @ omega
        energy += 0.5 * mass * velocity @ velocity + 0.5 * omega @ own
        momentum += mass * velocity
        spin += own + mass * np.cross(place, velocity)
    return np.concatenate([[energy], momentum, spin])
