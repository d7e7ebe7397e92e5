# SPDX-License-Identifier: BSD-3-Clause
"""Rigid contact of a wheelset on two rails.

Each side is looked at as a right-hand side (y towards the field, z down); on the left lateral shift and roll change sign. With the
wheelset's centre at (u, zc) and its roll p, a point (Y, Z) of the rail lies in the wheelset's axes at

    Y' = cos p (Y - u) + sin p (Z - zc)        Z' = -sin p (Y - u) + cos p (Z - zc)                    (1)

and is g = Z' - r(Y') below the wheel, r(Y') the wheel's rolling radius at that place. Contact is at the least g. Without roll each side
closes by a height of its own; with roll zc and p are such that the least g of both sides is zero. Newton's method needs dg/dzc and
dg/dp at fixed place on the rail only, because g is least there:

    dg/dzc = r' sin p - cos p                  dg/dp = -Y' - r' Z'                                      (2)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import ContactError, ConvergenceError
from railsym.profiles import ProfileError

GAUGE_HEIGHT = 0.014         # m below the top of rail (EN 13848-1)
_STEEPEST = np.radians(86.0)  # parts of a profile beyond are not touched from above
_BISECTIONS = 40             # of a bracket of 0.2 mm: below rounding
_SEARCH_STEP = 1e-4          # m along the rail between the points searched
_CLOSED = 1e-12              # m, gap left by Newton's method
_MOST_STEPS = 60


class Surface:
    """A profile as function z(y) with slope, where it can be touched from above (wheel: from below)."""

    def __init__(self, profile, y_shift=0.0, z_shift=0.0):
        from scipy.interpolate import CubicHermiteSpline

        keep = _touchable(profile)
        y = profile.y[keep] + y_shift
        self.y, self.nodes = y, keep
        self._z = CubicHermiteSpline(y, profile.z[keep] + z_shift, np.tan(profile.angle[keep]), extrapolate=False)
        self._slope = self._z.derivative()
        self._curvature = profile.curvature[keep]

    def z(self, y):
        """Height (m, down); NaN outside the profile."""
        return self._z(y)

    def slope(self, y):
        """dz/dy; NaN outside the profile."""
        return self._slope(y)

    def curvature(self, y):
        """Curvature, 1/m, convex positive."""
        return np.interp(y, self.y, self._curvature)


def _touchable(profile):
    """The longest run of nodes that is no steeper than 86 degrees and goes on in y."""
    good = np.abs(profile.angle) < _STEEPEST
    good[1:] &= np.diff(profile.y) > 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        raise ProfileError(f"profile {profile.name!r}: no part of it can be touched")
    k = int(np.argmax([profile.y[e - 1] - profile.y[s] for s, e in zip(starts, ends)]))
    return slice(starts[k], ends[k])


@dataclass(frozen=True, eq=False)
class SideContact:
    """Rigid contact of one wheel over a range of shifts; arrays (n,).

    Attributes
    ----------
    wheel_y, rail_y : ndarray
        Place of the contact on the wheel and on the rail, m, in the axes of the profiles (+ towards the field); the rail as it lies.
    rolling_radius : ndarray
        m.
    contact_angle : ndarray
        rad, of the contact plane to the track plane, positive as at a flange.
    wheel_curvature, rail_curvature : ndarray
        1/m, of the profiles, convex positive.
    """

    wheel_y: np.ndarray
    rail_y: np.ndarray
    rolling_radius: np.ndarray
    contact_angle: np.ndarray
    wheel_curvature: np.ndarray
    rail_curvature: np.ndarray


@dataclass(frozen=True, eq=False)
class RigidContact:
    """Rigid contact of a wheelset over lateral shifts.

    Attributes
    ----------
    y : ndarray, shape (n,)
        Lateral shift of the wheelset's centre, m, positive to the right.
    left, right : SideContact
    roll : ndarray
        rad, positive right side down; zero where roll was left out.
    lift : ndarray
        Height of the wheelset's centre above that at y = 0, m; without roll the mean of the two sides.
    with_roll : bool
    """

    y: np.ndarray
    left: SideContact
    right: SideContact
    roll: np.ndarray
    lift: np.ndarray
    with_roll: bool

    @property
    def rolling_radius_difference(self):
        """Rolling radius right minus left, m."""
        return self.right.rolling_radius - self.left.rolling_radius


class Side:
    """One wheel on one rail, as a right-hand side; z = 0 at the top of rail."""

    def __init__(self, name, wheel, rail, tape_circle, rail_offset, radius):
        at_tape = np.interp(0.0, *_sorted(wheel.y, wheel.z))
        self.name, self.tape_circle, self.rail_offset, self.radius = name, tape_circle, rail_offset, radius
        self.wheel = Surface(wheel, y_shift=tape_circle, z_shift=radius - at_tape)
        self.rail = Surface(rail, y_shift=rail_offset, z_shift=-rail.z.min())
        # all of both profiles, for drawings
        self.wheel_outline = wheel.y + tape_circle, wheel.z + radius - at_tape
        self.rail_outline = rail.y + rail_offset, rail.z - rail.z.min()
        arc = rail.arc_length[self.rail.nodes]
        count = int((arc[-1] - arc[0]) / _SEARCH_STEP) + 2
        self._grid_y = np.interp(np.linspace(arc[0], arc[-1], count), arc, self.rail.y)
        self._grid_z = self.rail.z(self._grid_y)

    def closest(self, shift, height, roll):
        """Place on the rail (its lateral coordinate, m) with the least gap, and that gap; arrays (n,).

        Raises
        ------
        ContactError
            Where the contact would be beyond an end of a profile.
        """
        gap = self._gap(self._grid_y, self._grid_z, shift[:, None], height[:, None], roll[:, None])
        gap = np.where(np.isnan(gap), np.inf, gap)
        k = gap.argmin(axis=1)
        self._check_ends(k, gap, shift)
        low, high = self._grid_y[k - 1], self._grid_y[k + 1]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            rising = self._gap_slope(middle, shift, height, roll) > 0.0
            low, high = np.where(rising, low, middle), np.where(rising, middle, high)
        place = 0.5 * (low + high)
        return place, self._gap(place, self.rail.z(place), shift, height, roll)

    def _check_ends(self, k, gap, shift):
        last = gap.shape[1] - 1
        rows = np.arange(len(k))
        ends = (k == 0) | (k == last)
        inner = np.where(ends, 1, k)
        ends |= np.isinf(gap[rows, inner - 1]) | np.isinf(gap[rows, np.minimum(inner + 1, last)])
        if ends.any():
            j = int(ends.argmax())
            sign = -1.0 if self.name == "left" else 1.0
            raise ContactError(f"{self.name} wheel: at a lateral shift of {1e3 * sign * shift[j]:.3f} mm it touches only at the end of a profile "
                               f"(rail y = {1e3 * (self._grid_y[k[j]] - self.rail_offset):.1f} mm); the wheel is off the rail, or the profile too short")

    def _body(self, y, z, shift, height, roll):
        """Equation (1)."""
        c, s = np.cos(roll), np.sin(roll)
        return c * (y - shift) + s * (z - height), c * (z - height) - s * (y - shift)

    def _gap(self, y, z, shift, height, roll):
        across, down = self._body(y, z, shift, height, roll)
        return down - self.wheel.z(across)

    def _gap_slope(self, y, shift, height, roll):
        """d gap/dy along the rail."""
        c, s = np.cos(roll), np.sin(roll)
        slope = self.rail.slope(y)
        across, _ = self._body(y, self.rail.z(y), shift, height, roll)
        return (c * slope - s) - self.wheel.slope(across) * (c + s * slope)

    def gap_derivatives(self, y, shift, height, roll):
        """Equation (2): dg/dzc, dg/dp."""
        across, down = self._body(y, self.rail.z(y), shift, height, roll)
        slope = self.wheel.slope(across)
        return slope * np.sin(roll) - np.cos(roll), -across - slope * down

    def contact(self, y, shift, height, roll):
        """What there is to know of the contact at the place y on the rail."""
        across, _ = self._body(y, self.rail.z(y), shift, height, roll)
        # at an edge the rail has no tangent: the wheel's counts
        angle = -(np.arctan(self.wheel.slope(across)) + roll)
        return SideContact(wheel_y=across - self.tape_circle, rail_y=y - self.rail_offset, rolling_radius=self.wheel.z(across), contact_angle=angle,
                           wheel_curvature=self.wheel.curvature(across), rail_curvature=self.rail.curvature(y))


def _sorted(y, z):
    order = np.argsort(y, kind="stable")
    return y[order], z[order]


def rigid_contact(left, right, y, with_roll=True):
    """Rigid contact of a wheelset.

    Parameters
    ----------
    left, right : Side
    y : array_like, shape (n,)
        Lateral shift, m, positive to the right.
    with_roll : bool
        Both wheels touch; otherwise each wheel is lowered onto its rail by itself (EN 15302).

    Returns
    -------
    RigidContact

    Raises
    ------
    ContactError
        Where a wheel is off its rail.
    ConvergenceError
        If the roll cannot be found.
    """
    y = np.atleast_1d(np.asarray(y, dtype=float))
    if y.ndim != 1 or not np.isfinite(y).all():
        raise ContactError(f"lateral shifts must be a list of finite numbers (m), got shape {y.shape}")
    shifts = np.append(y, 0.0)                    # the last: lift is counted from the central position
    zero = np.zeros(len(shifts))
    heights = [_lowered(side, sign * shifts) for side, sign in ((left, -1.0), (right, 1.0))]
    roll, height = zero, 0.5 * (heights[0] + heights[1])
    if with_roll:
        roll, height = _closed(left, right, shifts, height)
        heights = [height, height]
    sides = []
    for side, sign, own in zip((left, right), (-1.0, 1.0), heights):
        place, _ = side.closest(sign * shifts, own, sign * roll)
        sides.append(side.contact(*(v[:-1] for v in (place, sign * shifts, own, sign * roll))))
    return RigidContact(y=y, left=sides[0], right=sides[1], roll=roll[:-1].copy(), lift=height[-1] - height[:-1], with_roll=with_roll)


def _lowered(side, shift):
    """Height (m, down) of the wheelset's centre with one wheel on its rail, without roll: there the gap falls by what it sinks."""
    zero = np.zeros(len(shift))
    start = np.full(len(shift), -side.radius)
    return start + side.closest(shift, start, zero)[1]


def _closed(left, right, shift, height):
    """Roll and height at which both wheels touch, by Newton's method."""
    roll = np.zeros(len(shift))
    for _ in range(_MOST_STEPS):
        rows = []
        for side, sign in ((left, -1.0), (right, 1.0)):
            place, gap = side.closest(sign * shift, height, sign * roll)
            along_z, along_roll = side.gap_derivatives(place, sign * shift, height, sign * roll)
            rows.append((gap, along_z, sign * along_roll))
        (g0, a0, b0), (g1, a1, b1) = rows
        if max(np.abs(g0).max(), np.abs(g1).max()) < _CLOSED:
            return roll, height
        determinant = a0 * b1 - a1 * b0
        # a least gap is a minimum of smooth functions: full steps, but no more than 20 mrad at once
        step = (a0 * g1 - a1 * g0) / determinant
        height = height - (g0 * b1 - g1 * b0) / determinant
        roll = roll - np.clip(step, -0.02, 0.02)
    worst = int(np.maximum(np.abs(g0), np.abs(g1)).argmax())
    raise ConvergenceError(f"no roll of the wheelset found at a lateral shift of {1e3 * shift[worst]:.3f} mm: a gap of "
                           f"{1e3 * max(abs(g0[worst]), abs(g1[worst])):.2g} mm remains after {_MOST_STEPS} steps")
