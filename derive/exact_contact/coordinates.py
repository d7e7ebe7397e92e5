# SPDX-License-Identifier: BSD-3-Clause
"""The table's coordinates, as csrc/creep/exact_table.c computes them.

    v = (u1, u2, k u3/C23)    k = 0.6 sqrt((C22^2 a/b + C11^2 b/a)/2)    s = v/(r0 + |v|)

All creepages fit into the unit ball; its surface is full slip. u is Kalker's linear force over mu N (csrc/creep.h). The
spline's own coordinates have the same direction, and are finer where forces turn from adhesion to slip:

    z = v (e + |v|)/(|v|^2 + (e + 1) |v| + f), e = 0.4, f = 1.5
"""

from __future__ import annotations

import numpy as np

from railsym.kalker import kalker_coefficients

RADIUS = 1.5       # r0
SPIN_SHARE = 0.6
LINEAR, MIDDLE = 0.4, 1.5  # e, f


def constants(ratio, poisson=0.28):
    """C11, C22, C23, C33 and the weight k of spin."""
    c = np.array([float(x) for x in kalker_coefficients(ratio, poisson)])
    return c, SPIN_SHARE * np.sqrt((c[1] ** 2 * ratio + c[0] ** 2 / ratio) / 2)


def scales(ratio, poisson=0.28):
    """v over e, shape (3,)."""
    c, spin = constants(ratio, poisson)
    return np.array([c[0], c[1], spin])


def to_ball(v):
    """s (n, 3) of v (n, 3)."""
    return v / (RADIUS + np.linalg.norm(v, axis=-1, keepdims=True))


def from_ball(s):
    """v (n, 3) of s (n, 3), |s| < 1."""
    return RADIUS * s / (1 - np.linalg.norm(s, axis=-1, keepdims=True))


def stretched(s):
    """z (n, 3) of s (n, 3), |s| <= 1."""
    rho = np.linalg.norm(s, axis=-1, keepdims=True)
    size, left = RADIUS * rho, 1 - rho  # |v| = size/left
    return s * RADIUS * (LINEAR * left + size) / (size**2 + (LINEAR + 1) * size * left + MIDDLE * left**2)
