# SPDX-License-Identifier: BSD-3-Clause
"""What a track is at given places: frames and rails."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Frames:
    """Track frames; ``...`` is the shape of s.

    Attributes
    ----------
    place : ndarray, shape (..., 3)
        m, inertial: x along the track at s = 0, y to the right, z down.
    attitude : ndarray, shape (..., 3, 3)
        P = Rz(heading) Ry(slope) Rx(cant angle): frame to inertial components.
    turning : ndarray, shape (..., 3)
        1/m, angular velocity per metre of track, frame components.
    turning_rate : ndarray, shape (..., 3)
        1/m^2, d turning/ds.
    """

    place: np.ndarray
    attitude: np.ndarray
    turning: np.ndarray
    turning_rate: np.ndarray

    @classmethod
    def of(cls, found, shape):
        """From an array of railsym._core_track.FRAME."""
        return cls(*(found[name].reshape(shape + found[name].shape[1:]).copy() for name in ("place", "attitude", "turning", "turning_rate")))

    def gravity(self, gravity):
        """Gravity (m/s^2) in the frame, shape (..., 3)."""
        return gravity * self.attitude[..., 2, :]

    def motion(self, speed, speed_rate, gravity):
        """Inputs of the body kernels, as `railsym.track_frames.body_motion`: V, w0 ... grav2; SI."""
        turning = speed * self.turning
        rate = speed_rate * self.turning + speed**2 * self.turning_rate
        weight = self.gravity(gravity)
        found = {"V": speed, "dV": speed_rate}
        for k in range(3):
            found |= {f"w{k}": turning[..., k], f"dw{k}": rate[..., k], f"grav{k}": weight[..., k]}
        return found


@dataclass(frozen=True, eq=False)
class Rails:
    """Deviation of the rails from their design place, along the axes of the track frame (y to the right, z down).

    Attributes
    ----------
    left_y, left_z, right_y, right_z : ndarray
        m, with the shape of s.
    left_y_slope, left_z_slope, right_y_slope, right_z_slope : ndarray
        d/ds
    """

    left_y: np.ndarray
    left_z: np.ndarray
    right_y: np.ndarray
    right_z: np.ndarray
    left_y_slope: np.ndarray
    left_z_slope: np.ndarray
    right_y_slope: np.ndarray
    right_z_slope: np.ndarray

    @classmethod
    def of(cls, found, shape):
        """From an array (n, 8)."""
        return cls(*(column.reshape(shape).copy() for column in found.T))

    @property
    def alignment(self):
        """Mean deviation to the right, m."""
        return 0.5 * (self.left_y + self.right_y)

    @property
    def vertical(self):
        """Mean deviation downwards, m."""
        return 0.5 * (self.left_z + self.right_z)

    @property
    def cant(self):
        """Left rail higher than right, m."""
        return self.right_z - self.left_z

    @property
    def gauge(self):
        """Rails further apart, m."""
        return self.right_y - self.left_y
