# SPDX-License-Identifier: BSD-3-Clause
"""Deformations under finite motion, for checking the hand expansion of `deformations` by complex steps.

All functions are analytic (no abs, no conjugation), so they accept complex coordinates.
"""

import numpy as np


def finite_rotation(yaw, roll, pitch):
    """R = Rz(yaw) Rx(roll) Ry(pitch), body to track frame."""
    cz, sz, cx, sx, cy, sy = (f(a) for a in (yaw, roll, pitch) for f in (np.cos, np.sin))
    rz = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    rx = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    ry = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return rz @ rx @ ry


def finite_marker(q, position, centre):
    """Position and rotation of a marker for its 0, 5 or 6 coordinates."""
    if not len(q):
        return np.asarray(position, float), np.eye(3)
    angles = list(q[3:]) + [0.0] * (6 - len(q))
    turn = finite_rotation(*angles)
    centre = np.asarray(centre, float)
    return centre + q[:3] + turn @ (position - centre), turn


def finite_deformation(kind, first, second, axes):
    """Deformation of (position, rotation) pairs; `kind` is translation, rotation or elongation."""
    (r1, turn1), (r2, turn2) = first, second
    if kind == "translation":
        return (turn1 @ axes).T @ (r2 - r1)
    if kind == "elongation":
        gap = r2 - r1
        return np.array([np.sqrt((gap * gap).sum())])
    relative = axes.T @ turn1.T @ turn2 @ axes
    skew = 0.5 * (relative - relative.T)
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
