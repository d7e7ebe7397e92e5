# SPDX-License-Identifier: BSD-3-Clause
"""A parametric switch: lateral deviation of one or both rails over a length. The shapes are assumed: the geometry of the ERRI
switch was not found."""

from dataclasses import dataclass

import numpy as np

from railsym.errors import TrackError
from railsym.track.layers import RAILS, REST, placed, smooth_step, spline_layer
from railsym.track.sections import choice, number

_STEP = 0.01          # m, distance of nodes
LARGEST = 0.1         # m


def _half_sine(x):
    """sin(pi x), with a corner at either end"""
    return np.where((x > 0.0) & (x < 1.0), np.sin(np.pi * np.clip(x, 0.0, 1.0)), 0.0)


def _bump(x):
    """(1 - cos(2 pi x))/2"""
    return 0.5 * (1.0 - np.cos(2.0 * np.pi * np.clip(x, 0.0, 1.0)))


def _blade(x):
    """straight to the amplitude at 0.3 and back at 1, with corners"""
    return np.interp(x, [0.0, 0.3, 1.0], [0.0, 1.0, 0.0])


# shape -> function, deviation behind it, where its slope jumps (parts of the length)
SHAPES = {
    "smooth_step": (smooth_step, 1.0, ()),
    "half_sine": (_half_sine, 0.0, (0.0, 1.0)),
    "bump": (_bump, 0.0, ()),
    "blade": (_blade, 0.0, (0.0, 0.3, 1.0)),
}
_MOVED = {"both": ("left", "right"), "left": ("left",), "right": ("right",)}


@dataclass(frozen=True)
class Switch:
    """Deviation of the rails in a switch.

    Parameters
    ----------
    start, length : float
        m, where, and over which length.
    amplitude : float
        m, largest lateral deviation, positive to the right.
    shape : {"smooth_step", "half_sine", "bump", "blade"}
        smooth_step stays at the amplitude behind the switch, the others return to zero. "blade": straight to the amplitude at
        0.3 of the length, straight back.
    rails : {"both", "left", "right"}
        Which are moved.
    crossing_start, crossing_length, crossing_depth : float, optional
        m: a crossing, where the moved rails also dip by the depth over the length (a "bump" downwards) from s = crossing_start.
    """

    start: float
    length: float
    amplitude: float
    shape: str = "half_sine"
    rails: str = "both"
    crossing_start: float | None = None
    crossing_length: float | None = None
    crossing_depth: float | None = None

    def __post_init__(self):
        choice(self.shape, SHAPES, "switch: shape")
        choice(self.rails, _MOVED, "switch: rails")
        crossing = (self.crossing_start, self.crossing_length, self.crossing_depth)
        if any(part is None for part in crossing) and any(part is not None for part in crossing):
            raise TrackError("switch: a crossing needs crossing_start, crossing_length and crossing_depth, all in m")
        limits = {"start": {"low": 0.0}, "length": {"low": 10 * _STEP}, "amplitude": {"low": -LARGEST, "high": LARGEST}}
        if crossing[0] is not None:
            limits |= {"crossing_start": {"low": 0.0}, "crossing_length": {"low": 10 * _STEP}, "crossing_depth": {"low": -LARGEST, "high": LARGEST}}
        for name, allowed in limits.items():
            object.__setattr__(self, name, number(getattr(self, name), f"switch: {name}", "m", **allowed))

    def layers(self, track_length):
        """Deviations of the rails on a track of that length (m): RailLayer of the blades, and of the crossing."""
        function, after, corners = SHAPES[self.shape]
        values = self.amplitude * function(_inside(self.length))
        found = [self._layer("switch", self.start, self.length, values, "y", self.amplitude * after, not corners, track_length)]
        if self.crossing_start is not None:
            dip = self.crossing_depth * _bump(_inside(self.crossing_length))
            found.append(self._layer("crossing", self.crossing_start, self.crossing_length, dip, "z", 0.0, True, track_length))
        return found

    def corners(self):
        """Places where the slope of the deviation changes within two nodes, m."""
        return [self.start + part * self.length for part in SHAPES[self.shape][2]]

    def _layer(self, what, start, length, values, axis, after, interpolate, track_length):
        placed(what, start, length, track_length)
        columns = [RAILS.index(f"{side}_{axis}") for side in _MOVED[self.rails]]
        rails, behind = np.zeros((len(values) + 2 * REST, 4)), np.zeros(4)
        rails[REST:-REST, columns], rails[-REST:, columns], behind[columns] = values[:, None], values[-1], after
        step = length / (len(values) - 1)
        return spline_layer(start - REST * step, step, rails, behind, interpolate)


def _inside(length):
    """Nodes over 0..1."""
    return np.linspace(0.0, 1.0, int(np.ceil(length / _STEP)) + 1)
