# SPDX-License-Identifier: BSD-3-Clause
"""Rigid contact of a wheelset on two rails.

Each side is looked at as a right-hand side (y towards the field, z down); on the left lateral shift and roll change sign. With the
wheelset's centre at (u, zc) and its roll p, a point (Y, Z) of the rail lies in the wheelset's axes at

    Y' = cos p (Y - u) + sin p (Z - zc)        Z' = -sin p (Y - u) + cos p (Z - zc)                    (1)

and is g = Z' - r(Y') below the wheel, r(Y') the wheel's rolling radius at that place. Contact is at the least g. Without roll each side
closes by a height of its own; with roll zc and p are such that the least g of both sides is zero. Newton's method needs dg/dzc and
dg/dp at fixed place on the rail only, because g is least there:

    dg/dzc = r' sin p - cos p                  dg/dp = -Y' - r' Z'                                      (2)

A wheelset yawed by psi shows the rail the outline of its wheels. The point of the wheel at the place y whose normal has no part along
the track lies at the angle t ahead, sin t = -r' tan psi, so that the outline is

    Y = y cos psi + r sin t sin psi            Z = r cos t           dZ/dY = r'/(cos psi cos t)         (3)

with the contact r sin t ahead of the axle in the wheel's plane (exact without roll; with it to the first order in yaw times roll).
"""

from __future__ import annotations

from copy import copy
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
_MOST_YAW, _MOST_ROLL = 0.1, 0.1     # rad


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

    def yawed(self, yaw):
        """Outline of this wheel when it is yawed, equation (3)."""
        return Outline(self, yaw)

    def z(self, y):
        """Height (m, down); NaN outside the profile."""
        return self._z(y)

    def slope(self, y):
        """dz/dy; NaN outside the profile."""
        return self._slope(y)

    def curvature(self, y):
        """Curvature, 1/m, convex positive."""
        return np.interp(y, self.y, self._curvature)


class Outline(Surface):
    """Outline of a yawed wheel; its places are those of the track, `place` gives those of the wheel."""

    def __init__(self, wheel, yaw):
        from scipy.interpolate import CubicHermiteSpline

        radius, slope = wheel.z(wheel.y), wheel.slope(wheel.y)
        sine = -slope * np.tan(yaw)
        cosine = np.sqrt(np.maximum(1.0 - sine**2, 0.0))
        y = wheel.y * np.cos(yaw) + radius * sine * np.sin(yaw)
        rising = np.concatenate([[True], y[1:] > np.maximum.accumulate(y)[:-1]]) & (cosine > 0.1)
        self.y, self._place, self._source, self._yaw = y[rising], wheel.y[rising], wheel, yaw
        self._z = CubicHermiteSpline(self.y, (radius * cosine)[rising], (slope / (np.cos(yaw) * cosine))[rising], extrapolate=False)
        self._slope = self._z.derivative()

    def place(self, y):
        """Place on the wheel (m) that is touched at a place of the outline."""
        return np.interp(y, self.y, self._place)

    def curvature(self, y):
        """Of the wheel where it is touched, 1/m, convex positive."""
        return self._source.curvature(self.place(y))

    def ahead(self, y):
        """How far the contact lies ahead of the axle (m), in the wheelset's axes."""
        place = self.place(y)
        return -self._source.z(place) * self._source.slope(place) * np.tan(self._yaw)

    def radius(self, y):
        """Radius of the wheel at the contact, m."""
        return self._source.z(self.place(y))


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
    ahead : ndarray
        How far the contact lies ahead of the axle, m; 0 without yaw.
    """

    wheel_y: np.ndarray
    rail_y: np.ndarray
    rolling_radius: np.ndarray
    contact_angle: np.ndarray
    wheel_curvature: np.ndarray
    rail_curvature: np.ndarray
    ahead: np.ndarray


@dataclass(frozen=True, eq=False)
class RigidContact:
    """Rigid contact of a wheelset over lateral shifts.

    Attributes
    ----------
    y : ndarray, shape (n,)
        Lateral shift of the wheelset's centre, m, positive to the right.
    left, right : SideContact
    roll : ndarray
        rad, positive right side down; zero where roll was left out, or the roll given.
    lift : ndarray
        Height of the wheelset's centre above that at y = 0, m; where each wheel is lowered by itself the mean of the two sides.
    with_roll : bool
        Both wheels touch.
    yaw : float
        rad, nose to the right positive.
    """

    y: np.ndarray
    left: SideContact
    right: SideContact
    roll: np.ndarray
    lift: np.ndarray
    with_roll: bool
    yaw: float = 0.0

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

    def yawed(self, yaw):
        """This side with its wheel yawed (rad, positive about z down)."""
        if not yaw:
            return self
        other = copy(self)
        other.wheel = self.wheel.yawed(yaw)
        return other

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
        outline = isinstance(self.wheel, Outline)
        place = self.wheel.place(across) if outline else across
        return SideContact(wheel_y=place - self.tape_circle, rail_y=y - self.rail_offset,
                           rolling_radius=self.wheel.radius(across) if outline else self.wheel.z(across), contact_angle=angle,
                           wheel_curvature=self.wheel.curvature(across), rail_curvature=self.rail.curvature(y),
                           ahead=self.wheel.ahead(across) if outline else np.zeros(len(across)))


def _sorted(y, z):
    order = np.argsort(y, kind="stable")
    return y[order], z[order]


def rigid_contact(left, right, y, with_roll=True, *, roll=None, yaw=0.0):
    """Rigid contact of a wheelset.

    Parameters
    ----------
    left, right : Side
    y : array_like, shape (n,)
        Lateral shift, m, positive to the right.
    with_roll : bool
        Both wheels touch; otherwise each wheel is lowered onto its rail by itself (EN 15302).
    roll : array_like, shape (n,) or float, optional
        Roll that the wheelset has, rad, positive right side down; each wheel is then lowered by itself.
    yaw : float
        rad, positive about z (down): the nose to the right.

    Returns
    -------
    RigidContact

    Raises
    ------
    ContactError
        Where a wheel is off its rail, or a number makes no sense.
    ConvergenceError
        If the roll cannot be found.
    """
    y = np.atleast_1d(np.asarray(y, dtype=float))
    if y.ndim != 1 or not np.isfinite(y).all():
        raise ContactError(f"lateral shifts must be a list of finite numbers (m), got shape {y.shape}")
    given = _given_roll(roll, len(y))
    if not (np.isscalar(yaw) and abs(yaw) <= _MOST_YAW):
        raise ContactError(f"yaw is {yaw!r} rad; it must be a number of at most {_MOST_YAW} rad")
    left, right = left.yawed(-yaw), right.yawed(yaw)
    shifts = np.append(y, 0.0)                    # the last: lift is counted from the central position
    rolls = np.append(given, 0.0)
    heights = [_lowered(side, sign * shifts, sign * rolls) for side, sign in ((left, -1.0), (right, 1.0))]
    found, height = rolls, 0.5 * (heights[0] + heights[1])
    if with_roll and roll is None:
        found, height = _closed(left, right, shifts, height)
        heights = [height, height]
    sides = []
    for side, sign, own in zip((left, right), (-1.0, 1.0), heights):
        place, _ = side.closest(sign * shifts, own, sign * found)
        sides.append(side.contact(*(v[:-1] for v in (place, sign * shifts, own, sign * found))))
    return RigidContact(y=y, left=sides[0], right=sides[1], roll=found[:-1].copy(), lift=height[-1] - height[:-1],
                        with_roll=with_roll and roll is None, yaw=float(yaw))


def _given_roll(roll, count):
    try:
        given = np.broadcast_to(0.0 if roll is None else np.asarray(roll, dtype=float), (count,))
    except ValueError:
        raise ContactError(f"roll has shape {np.shape(roll)}; it must be one number, or one for each of the {count} shifts") from None
    if not (np.abs(given) <= _MOST_ROLL).all():
        raise ContactError(f"roll must be at most {_MOST_ROLL} rad and finite, got {given[~(np.abs(given) <= _MOST_ROLL)][0]}")
    return given


def _lowered(side, shift, roll):
    """Height (m, down) of the wheelset's centre with one wheel on its rail: without roll the gap falls by what it sinks."""
    height = np.full(len(shift), -side.radius)
    for _ in range(_MOST_STEPS if roll.any() else 1):
        place, gap = side.closest(shift, height, roll)
        height = height - gap / side.gap_derivatives(place, shift, height, roll)[0]
        if np.abs(gap).max() < _CLOSED:
            break
    return height


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
