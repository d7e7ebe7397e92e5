# SPDX-License-Identifier: BSD-3-Clause
"""Elements between two bodies in two moving track frames, written from their finite deformation alone.

Nothing is differentiated by hand: rates and partial velocities are complex steps of the
deformation, and the generalised forces follow from the virtual power f . d(de/dt)/du.
"""

import numpy as np
from oracles.kernel_inputs import STEP


def turn(axis, angle):
    """Rotation about one axis; the angle may be complex."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3, dtype=np.result_type(angle, float))
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
    return matrix


def attitude(angles):
    """Body to track frame: yaw about z, then roll about x, then pitch about y."""
    yaw, roll, pitch = angles
    return turn(2, yaw) @ turn(0, roll) @ turn(1, pitch)


def partial_omega(angles):
    """Columns: angular velocity, track frame components, of unit rates of yaw, roll, pitch."""
    yaw, roll, _ = angles
    return np.column_stack([[0, 0, 1], turn(2, yaw)[:, 0], (turn(2, yaw) @ turn(0, roll))[:, 1]])


def cross_matrix(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def deformation(one, q, time=0.0):
    """Deformation (1 or 6 numbers) of an instance at coordinates q, ``time`` after its frames lay as given."""
    turned = one.matrix("C") @ (np.eye(3) + time * cross_matrix(one.get("wf0", 3)))
    first, second = attitude(q[3:6]), attitude(q[9:12])
    reach = q[6:9] + second @ one.get("m2_0", 3)
    apart = one.get("D0", 3) + time * one.get("dD0", 3) + turned @ reach - q[:3] - first @ one.get("m1_0", 3)
    if one.name == "line":
        return np.array([np.sqrt(apart @ apart) - one.get("e0")])
    if one.name == "axis":
        return np.array([first @ one.get("ax0", 3) @ apart - one.get("e0")])
    axes1, axes2 = first @ one.matrix("A1_"), turned @ second @ one.matrix("A2_")
    q = axes1.T @ axes2
    rotation = 0.5 * np.array([q[2, 1] - q[1, 2], q[0, 2] - q[2, 0], q[1, 0] - q[0, 1]])
    return np.concatenate([axes1.T @ apart, rotation])


def partial_rates(one):
    """de/dq = d(de/dt)/du, shape (1 or 6, 12)."""
    columns = [deformation(one, one.q[:12] + 1j * STEP * e).imag / STEP for e in np.eye(12)]
    return np.array(columns).T


def deformation_rate(one):
    """de/dt with the coordinates' rates and the motion of the second frame in the first."""
    return deformation(one, one.q[:12] + 1j * STEP * one.u[:12], 1j * STEP).imag / STEP


def bushing_force(one):
    """f0 + k (e - e0) + c de/dt, six components."""
    stretch = deformation(one, one.q) - one.get("e0_0", 6)
    return one.get("f0_0", 6) + one.get("k0", 6) * stretch + one.get("c0", 6) * deformation_rate(one)


def wrenches(one, residual):
    """Force and moment about each body's centre that an element exerts on it, from its residual rows.

    Each in the body's own track frame: F1, T1, F2, T2.
    """
    found = []
    for k in (0, 6):
        rows = -residual[k:k + 6]
        found += [rows[:3], np.linalg.solve(partial_omega(one.q[k + 3:k + 6]).T, rows[3:])]
    return found
