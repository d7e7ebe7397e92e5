# SPDX-License-Identifier: BSD-3-Clause
"""Mass, gyroscopic and gravity terms of one body about straight running, by Lagrange's equations on paper.

Rigid body, coordinates x y z yaw roll pitch of its centre of mass.  At the design position the angular velocity is
(roll', pitch', yaw'), so T2 = m |u'|^2 / 2 + w^T I w / 2 with the rates sorted into x y z; on straight track the
constant speed V only adds the total time derivative m V x', and gravity only the constant force m g.

Wheelset, spin Omega = -V/r0 + spin'.  In the axle's yaw-roll axes w = (roll', Omega + yaw' sin roll, yaw' cos roll), so

    T = (Ixx roll'^2 + Iyy (Omega + yaw' sin roll)^2 + Izz yaw'^2 cos^2 roll) / 2

gives, to first order, yaw: Izz yaw'' - (Iyy V/r0) roll', roll: Ixx roll'' + (Iyy V/r0) yaw', spin: Iyy spin''.

Axlebox: turns on the axle by its own pitch p; centre of mass r = u + Rz Rx Ry(p) s with s = lateral_position e_y +
centre_offset.  The potential -m g r_z has the second derivative -m g (E_i E_j s)_z: the pendulum term.
"""

from dataclasses import dataclass

import numpy as np

from .small_rotations import marker_motion

# Places of the x, y, z components of angular velocity among the rates (yaw, roll, pitch).
_ANGULAR_VELOCITY = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


@dataclass(frozen=True)
class BodyTerms:
    """Matrices (n, n) over the body's own coordinates.

    mass; gyroscopic (per unit speed V, so C = V * gyroscopic); gravity_stiffness; gravity_force (n,), N and N m.
    """

    mass: np.ndarray
    gyroscopic: np.ndarray
    gravity_stiffness: np.ndarray
    gravity_force: np.ndarray


def body_coordinates(body):
    """Names of a body's coordinates after its own name, in the order of q_all."""
    if body.kind == "rigid_body":
        return ("x", "y", "z", "yaw", "roll", "pitch")
    boxes = tuple(box.name.split(".")[-1] + ".pitch" for box in body.axleboxes)
    return ("x", "y", "z", "yaw", "roll", "spin") + boxes


def body_terms(body, gravity):
    """Terms of a `vehicle.Body`; gravity in m/s^2 along +z."""
    n = len(body_coordinates(body))
    terms = BodyTerms(np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n)), np.zeros(n))
    if body.kind == "wheelset":
        _add_axle(terms, body, gravity)
        for place, box in enumerate(body.axleboxes):
            _add_axlebox(terms, box, 6 + place, gravity)
    else:
        terms.mass[:3, :3] = body.mass * np.eye(3)
        terms.mass[3:, 3:] = _ANGULAR_VELOCITY.T @ _tensor(body.inertia) @ _ANGULAR_VELOCITY
        terms.gravity_force[2] = body.mass * gravity
    return terms


def _tensor(inertia):
    inertia = np.asarray(inertia, float)
    return np.diag(inertia) if inertia.ndim == 1 else inertia


def _add_axle(terms, body, gravity):
    inertia = _tensor(body.inertia)
    spin_inertia = inertia[1, 1]
    terms.mass[:6, :6] = np.diag([body.mass] * 3 + [inertia[2, 2], inertia[0, 0], spin_inertia])
    terms.gyroscopic[3, 4] = -spin_inertia / body.wheel_radius
    terms.gyroscopic[4, 3] = spin_inertia / body.wheel_radius
    terms.gravity_force[2] = body.mass * gravity


def _add_axlebox(terms, box, pitch_place, gravity):
    arm = np.array([0.0, box.lateral_position, 0.0]) + np.asarray(box.centre_offset, float)
    motion = marker_motion([0, 1, 2, 3, 4, pitch_place], arm, np.zeros(3))
    places = np.ix_(motion.indices, motion.indices)
    velocity = motion.position_gradient
    spinning = np.zeros((3, 6))
    spinning[:, 3:] = _ANGULAR_VELOCITY
    terms.mass[places] += box.mass * velocity.T @ velocity + spinning.T @ _tensor(box.inertia) @ spinning
    terms.gravity_stiffness[places] -= box.mass * gravity * motion.position_hessian[2]
    terms.gravity_force[motion.indices] += box.mass * gravity * velocity[2]
