# SPDX-License-Identifier: BSD-3-Clause
"""Accelerations of points of bodies, as an accelerometer fixed there reads them."""

from __future__ import annotations

import numpy as np


def rotations(angles):
    """Rz(yaw) Rx(roll) Ry(pitch) of many attitudes; angles (3, n) in rad, matrices (n, 3, 3)."""
    (cz, cx, cy), (sz, sx, sy) = np.cos(angles), np.sin(angles)
    rows = [[cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy],
            [sz * cy + cz * sx * sy, cz * cx, sz * sy - cz * sx * cy],
            [-cx * sy, sx, cx * cy]]
    return np.moveaxis(np.array(rows), -1, 0)


def _turning(angles, rates, seconds):
    """Angular velocity and acceleration (n, 3) in frame axes from yaw, roll, pitch and their derivatives (3, n)."""
    (cz, cx), (sz, sx) = np.cos(angles[:2]), np.sin(angles[:2])
    yaw, roll, pitch = rates
    across, zero = np.stack([cz, sz, 0.0 * cz], -1), np.zeros_like(cz)   # axis of roll, turned by yaw
    axle = np.stack([-sz * cx, cz * cx, sx], -1)                         # axis of pitch, turned by yaw and roll
    up = np.stack([zero, zero, zero + 1.0], -1)
    omega = up * yaw[:, None] + across * roll[:, None] + axle * pitch[:, None]
    first = up * yaw[:, None]
    second = first + across * roll[:, None]
    alpha = up * seconds[0][:, None] + across * seconds[1][:, None] + axle * seconds[2][:, None]
    return omega, alpha + np.cross(first, across) * roll[:, None] + np.cross(second, axle) * pitch[:, None]


def accelerometer(q, u, a, arm, offset, frame, gravity):
    """Acceleration of a point of a body against free fall, body axes, less what it reads standing on level track.

    Parameters
    ----------
    q, u, a : ndarray, shape (6, n)
        x y z yaw roll pitch of the body in its track frame, their rates and accelerations.
    arm : ndarray, shape (3,)
        m, the point from the body's design position.
    offset : ndarray, shape (3,)
        m, design position of the body in its track frame.
    frame : dict
        V, dV (n,) and w, dw, gravity (n, 3) of the track frame, its axes.
    gravity : float
        m/s^2

    Returns
    -------
    ndarray, shape (n, 3)
        m/s^2
    """
    turn = rotations(q[3:])
    omega, alpha = _turning(q[3:], u[3:], a[3:])
    lever = turn @ arm
    place = offset + q[:3].T + lever
    rate = u[:3].T + np.cross(omega, lever)
    second = a[:3].T + np.cross(alpha, lever) + np.cross(omega, np.cross(omega, lever))
    w, along = frame["w"], np.zeros_like(second)
    along[:, 0] = frame["V"]
    second = second + np.cross(w, along) + np.cross(frame["dw"], place) + np.cross(w, np.cross(w, place)) + 2.0 * np.cross(w, rate)
    second[:, 0] += frame["dV"]
    return np.einsum("nji,nj->ni", turn, second - frame["gravity"]) + [0.0, 0.0, gravity]


def frame_motion(track, speed, time, ahead, gravity):
    """Motion of a track frame at times (n,): V, dV (n,) and w, dw, gravity (n, 3); ``ahead``: m ahead of the vehicle's centre."""
    n = len(time)
    V, dV = speed.at(time), np.broadcast_to(speed.rate(time), n)
    if track is None:
        zero = np.zeros((n, 3))
        return {"V": V, "dV": dV, "w": zero, "dw": zero, "gravity": zero + [0.0, 0.0, gravity]}
    found = track.core.frames(np.ascontiguousarray(speed.place(time) + ahead))
    turning, rate = found["turning"], found["turning_rate"]
    return {"V": V, "dV": dV, "w": V[:, None] * turning, "dw": dV[:, None] * turning + (V ** 2)[:, None] * rate,
            "gravity": gravity * found["attitude"][:, 2, :]}
