# SPDX-License-Identifier: BSD-3-Clause
"""Speed of travel over time: pieces of constant acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np

from railsym.errors import SimulationError


@dataclass(frozen=True, eq=False)
class SpeedProfile:
    """Speed over time, straight between the points and constant outside them.

    Parameters
    ----------
    time : array_like, shape (n,)
        s, increasing.
    speed : array_like, shape (n,)
        m/s, positive: creepages are referred to it.
    start : float
        m, arc length of the vehicle's centre at t = 0.

    Raises
    ------
    SimulationError
        Times that do not increase, speeds that are not positive.
    """

    time: np.ndarray
    speed: np.ndarray
    start: float = 0.0

    def __post_init__(self):
        time, speed = (np.array(part, dtype=float, ndmin=1) for part in (self.time, self.speed))
        if time.shape != speed.shape or time.ndim != 1 or not time.size or not np.isfinite(time).all() or (np.diff(time) <= 0.0).any():
            raise SimulationError(f"speed profile: as many times (s, increasing) as speeds (m/s) are needed, got {time} and {speed}")
        if not np.isfinite(speed).all() or (speed <= 0.0).any():
            wrong = speed[~(speed > 0.0) | ~np.isfinite(speed)][0]
            raise SimulationError(f"speed {wrong:g} m/s: creepages are slips over the speed, so it must be finite and above 0 m/s everywhere")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "speed", speed)

    @classmethod
    def of(cls, speed, start=0.0):
        """From a number (m/s), pairs of time (s) and speed (m/s), a SpeedProfile, a SpeedOverDistance, or a file of one (`load_speed`)."""
        if isinstance(speed, (str, PathLike)):
            from railsym.simulation.speed_over_distance import load_speed

            speed = load_speed(speed)
        if isinstance(speed, cls):
            return cls(speed.time, speed.speed, start)
        if hasattr(speed, "profile"):
            return speed.profile(start)
        if np.ndim(speed) == 0:
            return cls([0.0], [speed], start)
        pairs = np.asarray(speed, dtype=float)
        if pairs.ndim != 2 or pairs.shape[1] != 2:
            raise SimulationError(f"speed: a number (m/s) or pairs of time (s) and speed (m/s) are needed, got shape {pairs.shape}")
        return cls(pairs[:, 0], pairs[:, 1], start)

    @property
    def pieces(self):
        """Start time (s), place (m), speed (m/s) and acceleration (m/s^2) of each piece, shape (n + 1, 4)."""
        slopes = np.diff(self.speed) / np.diff(self.time)
        times = np.concatenate([[min(0.0, self.time[0] - 1.0)], self.time])
        speeds = np.concatenate([self.speed[:1], self.speed])
        accelerations = np.concatenate([[0.0], slopes, [0.0]])
        lengths = np.diff(times)
        places = np.concatenate([[0.0], np.cumsum(lengths * (speeds[:-1] + 0.5 * accelerations[:-1] * lengths))])
        table = np.column_stack([times, places, speeds, accelerations])
        table[:, 1] += self.start - _place(table, np.zeros(1))[0]
        return table

    @property
    def constant(self):
        """True where the speed never changes."""
        return bool((self.speed == self.speed[0]).all())

    def at(self, time):
        """Speeds (m/s) at times (s)."""
        return np.interp(time, self.time, self.speed)

    def place(self, time):
        """Arc lengths (m) of the vehicle's centre at times (s)."""
        return _place(self.pieces, np.asarray(time, dtype=float))

    def rate(self, time):
        """Accelerations (m/s^2) at times (s)."""
        table = self.pieces
        return table[_piece(table, np.asarray(time, dtype=float)), 3]

    def when(self, places):
        """Times (s) at which the vehicle's centre is at places (m)."""
        table, places = self.pieces, np.asarray(places, dtype=float)
        row = table[np.clip(np.searchsorted(table[:, 1], places, side="right") - 1, 0, len(table) - 1)]
        ahead, speed, rate = places - row[..., 1], row[..., 2], row[..., 3]
        return row[..., 0] + 2.0 * ahead / (speed + np.sqrt(np.maximum(speed ** 2 + 2.0 * rate * ahead, 0.0)))


def _piece(table, time):
    return np.clip(np.searchsorted(table[:, 0], time, side="right") - 1, 0, len(table) - 1)


def _place(table, time):
    row = table[_piece(table, time)]
    t = time - row[..., 0]
    return row[..., 1] + t * (row[..., 2] + 0.5 * row[..., 3] * t)
