# SPDX-License-Identifier: BSD-3-Clause
"""Second-order Taylor expansion of where a marker is and how it is turned.

Everything here is vector algebra on paper.  A body turns by yaw psi about z, roll phi about x and pitch theta about
y, R = Rz(psi) Rx(phi) Ry(theta).  With E_k the cross-product matrix of the unit vector k, each elementary rotation is
I + a E_k + a^2/2 E_k^2 + O(a^3), so the product has

    dR/da_i = E_i          d2R/(da_i da_j) = E_i E_j   with i standing left of j in the product

and nothing else is needed for the linear model with preload.
"""

from dataclasses import dataclass

import numpy as np


def cross_matrix(vector):
    """Matrix E with E @ u = vector x u."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


# In the order of the angles: yaw (z), roll (x), pitch (y).
ANGLE_AXES = (cross_matrix((0, 0, 1)), cross_matrix((1, 0, 0)), cross_matrix((0, 1, 0)))


def rotation_expansion(angles):
    """Gradient (3, 3, n) and Hessian (3, 3, n, n) of R at zero for the first n of yaw, roll, pitch.

    `angles` is 0 (does not turn), 2 (axle of a wheelset: its spin does not turn its markers) or 3.
    """
    gradient = np.zeros((3, 3, angles))
    hessian = np.zeros((3, 3, angles, angles))
    for i in range(angles):
        gradient[:, :, i] = ANGLE_AXES[i]
        for j in range(angles):
            left, right = min(i, j), max(i, j)
            hessian[:, :, i, j] = ANGLE_AXES[left] @ ANGLE_AXES[right]
    return gradient, hessian


@dataclass(frozen=True)
class MarkerMotion:
    """Motion of one marker to second order in its n coordinates.

    indices : (n,) places of the coordinates in q_all
    position : (3,) design position, vehicle axes, m
    position_gradient : (3, n); position_hessian : (3, n, n)
    rotation_gradient : (3, 3, n); rotation_hessian : (3, 3, n, n); the rotation itself is the identity at q = 0
    """

    indices: np.ndarray
    position: np.ndarray
    position_gradient: np.ndarray
    position_hessian: np.ndarray
    rotation_gradient: np.ndarray
    rotation_hessian: np.ndarray


def marker_motion(indices, position, centre):
    """Expand r = r_centre + u + R s, s = position - centre, in u (3) and the angles.

    `indices` holds 0 places (fixed to the track frame), 5 (axle of a wheelset) or 6 (rigid body; an axlebox, whose
    sixth coordinate is its own pitch: turning about the axle line does not move the axle line, so s may be measured
    from the wheelset's centre).
    """
    indices = np.asarray(indices, dtype=int)
    n = len(indices)
    arm = np.asarray(position, float) - np.asarray(centre, float)
    first = np.zeros((3, n))
    second = np.zeros((3, n, n))
    turn_first = np.zeros((3, 3, n))
    turn_second = np.zeros((3, 3, n, n))
    if n:
        first[:, :3] = np.eye(3)
        turn_first[:, :, 3:], turn_second[:, :, 3:, 3:] = rotation_expansion(n - 3)
        first[:, 3:] = np.einsum("kla,l->ka", turn_first[:, :, 3:], arm)
        second = np.einsum("klab,l->kab", turn_second, arm)
    return MarkerMotion(indices, np.asarray(position, float), first, second, turn_first, turn_second)
