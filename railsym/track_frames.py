# SPDX-License-Identifier: BSD-3-Clause
"""Track frames: where each body's frame lies, how it moves, and how two of them lie to each other.

A frame at arc length s has x along the track, y to the right and z down, both in the canted
plane. Its inertial attitude is P(s) = Rz(heading) Ry(slope) Rx(cant angle).
"""

from dataclasses import dataclass

import numpy as np


def rotation(axis, angle):
    """Matrix of a rotation about axis 0, 1 or 2 by ``angle`` (rad), shape (3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i] = np.sin(angle)
    matrix[i, j] = -matrix[j, i]
    return matrix


@dataclass(frozen=True)
class UniformTrack:
    """Track of constant curvature, cant and gradient; the default is straight and level.

    Parameters
    ----------
    curvature : float
        1/m, positive to the right, in the horizontal plane along the centreline.
    cant_angle : float
        rad, positive when the left rail is higher.
    gradient : float
        rad, positive uphill.
    """

    curvature: float = 0.0
    cant_angle: float = 0.0
    gradient: float = 0.0

    def attitude(self, s):
        """P(s): frame to inertial components, shape (3, 3)."""
        return rotation(2, self.curvature * s) @ self._tilt()

    def _tilt(self):
        return rotation(1, self.gradient) @ rotation(0, self.cant_angle)

    def position(self, s):
        """Centreline at arc length s (m), inertial components, shape (3,); o' = P e_x."""
        heading = self.curvature * s
        level = np.cos(self.gradient)
        along = np.sinc(heading / np.pi) * s
        across = 0.5 * heading * s * np.sinc(heading / (2 * np.pi)) ** 2
        return np.array([level * along, level * across, -np.sin(self.gradient) * s])

    def turning(self):
        """Angular velocity of the frame per metre of track, frame components, shape (3,), 1/m."""
        return self._tilt().T @ np.array([0.0, 0.0, self.curvature])

    def gravity(self, gravity):
        """Gravity in the frame, shape (3,), m/s^2."""
        return self._tilt().T @ np.array([0.0, 0.0, gravity])


def body_motion(track, speed, speed_rate, gravity):
    """Motion of a body's track frame as the body kernels take it.

    Returns
    -------
    dict of str to float
        V, w0 w1 w2, dV, dw0 dw1 dw2, grav0 grav1 grav2; SI.
    """
    turning, weight = track.turning(), track.gravity(gravity)
    motion = {"V": speed, "dV": speed_rate}
    for k in range(3):
        motion[f"w{k}"] = speed * turning[k]
        motion[f"dw{k}"] = speed_rate * turning[k]
        motion[f"grav{k}"] = weight[k]
    return motion


def relative_pose(track, speed, first, second):
    """Track frame of a second body seen from that of a first one.

    Parameters
    ----------
    first, second : array_like, shape (3,)
        Design positions in vehicle coordinates: x is the arc length of the body's frame.

    Returns
    -------
    dict
        D (3,): design position of the second body from the first's, in track frame 1, m.
        C (3, 3): track frame 2 to track frame 1. dD (3,): rate of D seen in frame 1, m/s.
        wf (3,): angular velocity of frame 2 in frame 1, components of frame 2, rad/s.
    """
    here, there = track.attitude(first[0]), track.attitude(second[0])
    turn = here.T @ there
    offset1, offset2 = (np.array([0.0, *p[1:]]) for p in (first, second))
    origin = track.position(second[0]) - track.position(first[0]) + there @ offset2
    omega = speed * track.turning()
    from_origin = here.T @ origin
    moving = speed * (turn[:, 0] - [1.0, 0.0, 0.0]) + turn @ np.cross(omega, offset2)
    return {
        "D": from_origin - offset1,
        "C": turn,
        "dD": moving - np.cross(omega, from_origin),
        "wf": omega - turn.T @ omega,
    }


def relative_poses(track, speed, pairs):
    """`relative_pose` of many elements (a `railsym.topology.Pairs`): arrays with one row an element."""
    count = len(pairs.place1)
    if not track.curvature:  # frames of one attitude, at rest against each other
        rest = np.zeros((count, 3))
        return {"D": pairs.place2 - pairs.place1, "C": np.broadcast_to(np.eye(3), (count, 3, 3)), "dD": rest, "wf": rest}
    found = [relative_pose(track, speed, *places) for places in zip(pairs.place1, pairs.place2, strict=True)]
    return {key: np.array([pose[key] for pose in found]) for key in found[0]}
