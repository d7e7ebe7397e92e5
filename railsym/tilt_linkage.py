# SPDX-License-Identifier: BSD-3-Clause
"""Geometry of a tilting mechanism: a body that hangs by two pairs of equal links from a bolster, as a four-bar linkage across the vehicle.

The body's centre moves by P and turns by theta against the bolster (roll, positive: right side down, as in a curve to the right).
With b the place of a link's pivot on the body from its centre, R(theta) b + P - q is the link, q its pivot on the bolster from the
same point. Its length stays l, so P lies on the circles of radius l about -(R b - q) of the left and the right link:

    P = (c_left + c_right)/2 + n sqrt(l^2 - |c_right - c_left|^2/4),     c = q - R b,     n the unit vector across c_right - c_left
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ModelError

_ACROSS = [1, 2]  # y and z of a point
_FINE = 2001      # angles of the table that is read backwards: 0.01 degrees apart, straight between them, 1e-7 rad wrong
_WIDEST = np.radians(10.0)


class TiltLinkage:
    """The linkage between one bolster and the body that hangs from it.

    Parameters
    ----------
    vehicle : Vehicle
    bolster : str
        Body that the links hang from.
    links, jacks : str
        Groups of elements: rigid links (traction_rod), and actuators.

    Attributes
    ----------
    body : str
        The body that tilts.
    jacks : tuple of str
        Names of the actuators.

    Raises
    ------
    ModelError
        No such elements on the bolster, or links that are not the mirror images of each other.
    """

    def __init__(self, vehicle, bolster="bolster1", links="swing_link", jacks="tilt_actuator"):
        found = [e for e in vehicle.elements if e.group == links and e.first.body == bolster]
        if not found:
            raise ModelError(f"vehicle {vehicle.name!r} has no elements {links!r} that begin on {bolster!r}: its tilting mechanism is not known")
        self.body = found[0].second.body
        self._centre = vehicle.body(self.body).position[_ACROSS]
        self._pivots = self._of(found, -1.0), self._of(found, 1.0)
        (q_left, b_left), (q_right, b_right) = self._pivots
        self._length = float(np.linalg.norm(q_right - b_right))
        mirror = np.array([-1.0, 1.0])
        if not (np.allclose(q_left, mirror * q_right, atol=1e-9) and np.allclose(b_left, mirror * b_right, atol=1e-9)):
            raise ModelError(f"{links}: the links of {bolster!r} on the left and on the right are not mirror images of each other")
        own = [e for e in vehicle.elements if e.group == jacks and e.first.body == bolster and e.second.body == self.body]
        self.jacks = tuple(e.name for e in own)
        self._ends = {e.name: (self._from_centre(e.first), self._from_centre(e.second)) for e in own}

    def _from_centre(self, end):
        return end.position[_ACROSS] - self._centre

    def _of(self, links, side):
        """Pivots on the bolster and on the body of the links of one side, from the body's centre."""
        ends = {(tuple(self._from_centre(e.first)), tuple(self._from_centre(e.second))) for e in links if e.second.position[1] * side > 0.0}
        if len(ends) != 1:
            raise ModelError(f"{links[0].group}: the links of one side are one behind the other, at one place across the vehicle; found {len(ends)} places")
        return tuple(map(np.array, ends.pop()))

    @property
    def roll_centre(self):
        """Height above the rail (m) at which the lines of the links meet at the design position."""
        y, z = self.centre(0.0)
        return float(-(z + self._centre[1]))

    def shift(self, angle):
        """Displacement [y, z] of the body's centre against the bolster, shape (..., 2), m, at an angle (...) in rad."""
        left, right = (q - self._turned(b, angle) for q, b in self._pivots)
        apart = right - left
        half = 0.5 * np.linalg.norm(apart, axis=-1, keepdims=True)
        down = np.stack([-apart[..., 1], apart[..., 0]], axis=-1) / (2.0 * half)
        down = down * np.where(self._hangs, 1.0, -1.0)
        return 0.5 * (left + right) + down * np.sqrt(self._length ** 2 - half ** 2)

    @property
    def _hangs(self):
        """Of the two intersections the one that is the design position."""
        (q, b), (other, at) = self._pivots
        left, right = q - b, other - at
        return (0.5 * (left + right))[1] * (right - left)[0] < 0.0

    @staticmethod
    def _turned(point, angle):
        s, c = np.sin(angle), np.cos(angle)
        return np.stack([c * point[0] - s * point[1], s * point[0] + c * point[1]], axis=-1)

    def travel(self, point, angle):
        """Displacement [y, z] (..., 2), m, of a point of the body, given by [y, z] in vehicle coordinates at the design position."""
        arm = np.asarray(point, dtype=float) - self._centre
        return self.shift(angle) + self._turned(arm, angle) - arm

    def centre(self, angle):
        """Centre [y, z] (2,), m, about which the body turns, from its centre's design position: where the lines of the links meet."""
        (q1, b1), (q2, b2) = self._pivots
        ends = [self._turned(b, angle) + self.shift(angle) for b in (b1, b2)]
        along = np.column_stack([q1 - ends[0], -(q2 - ends[1])])
        return q1 + (q1 - ends[0]) * np.linalg.solve(along, q2 - q1)[0]

    def jack_length(self, jack, angle):
        """By how much a jack is longer than at the design position, m, shape of ``angle`` (rad)."""
        first, second = self._ends[jack]
        return np.linalg.norm(self.shift(angle) + self._turned(second, angle) - first, axis=-1) - np.linalg.norm(second - first)

    def angle(self, jack, length):
        """Tilt angle (rad) at which a jack is longer by ``length`` (m).

        Raises
        ------
        ModelError
            A length beyond 10 degrees of tilt.
        """
        angles = np.linspace(-_WIDEST, _WIDEST, _FINE)
        table = self.jack_length(jack, angles)
        if table[0] > table[-1]:
            angles, table = angles[::-1], table[::-1]
        if np.any((length < table[0]) | (length > table[-1])):
            raise ModelError(f"{jack}: {length} m is beyond {np.degrees(_WIDEST):g} degrees of tilt, {table[0]:.4g} to {table[-1]:.4g} m")
        return np.interp(length, table, angles)
