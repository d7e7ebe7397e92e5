# SPDX-License-Identifier: BSD-3-Clause
"""Contact tables: elastic contact of wheels on rails, computed once, read in a tenth of a microsecond.

A wheel's place against its rail is its lateral shift y, its roll, the drop of the wheelset's centre below the height at which
its tape circle would touch the top of the rail, and its yaw. The table gives the patches of contact there (at most one a zone
of the wheel: tread, flange root, flange), each with load, place, rolling radius, contact angle and semi-axes, and with the slopes
of all of them. What it is made of: docs/contact_table.md and ``csrc/contact``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from railsym import _core_contact as core
from railsym.errors import ContactError, ConvergenceError

SIDES = ("left", "right")
_SIGN = {"left": -1.0, "right": 1.0}
_MIRRORED = np.array([-1.0, -1.0, 1.0, -1.0])          # y, roll, drop, yaw of a left wheel as a right-hand side
_QUANTITIES = core.PATCH.names[:-1]
_FAR = 0.1                                            # m: a wheel is off its rail long before
_UNITS = {"lateral shift": (1e3, "mm"), "roll": (1e3, "mrad"), "penetration": (1e3, "mm")}


class OutOfTableError(ContactError):
    """A wheel left the range of its contact table: off the rail, or pressed deeper than the table goes.

    Attributes
    ----------
    wheel : str
    quantity : {"lateral shift", "roll", "penetration"}
    value : float
        SI.
    limits : tuple of float
        SI.
    time : float or None
        s.
    """

    def __init__(self, wheel, quantity, value, limits, time=None):
        self.wheel, self.quantity, self.value, self.limits, self.time = wheel, quantity, value, limits, time
        scale, unit = _UNITS[quantity]
        at = "" if time is None else f" at t = {time:.6g} s"
        inside = limits[0] <= value <= limits[1]         # the range holds for the wheel as a whole; this posture ends sooner
        if inside:
            super().__init__(f"{wheel}: at a lateral shift of {scale * value:.4g} {unit} in this posture it meets the rail at an end of its profile{at}; "
                             "the wheel is off the rail, or a profile too short")
            return
        what = {"lateral shift": "the wheel is off the rail, or its profile too short", "roll": "the wheelset rolls more than the table covers",
                "penetration": "the wheel is pressed into the rail deeper than the table goes"}[quantity]
        super().__init__(f"{wheel}: {quantity} {scale * value:.4g} {unit} is outside the contact table [{scale * limits[0]:.4g}, "
                         f"{scale * limits[1]:.4g}] {unit}{at}; {what}")


@dataclass(frozen=True, eq=False)
class Patches:
    """Contact of one wheel at n places; arrays (n, 3), one column a zone in the order of what is touched, or (n, 3, 4) for slopes.

    Attributes
    ----------
    count : ndarray of int, shape (n,)
        Patches that carry load.
    zone : ndarray of int, shape (n, 3)
        0 tread, then towards the flange; -1 where there is no patch.
    load : ndarray
        Elastic normal force, N; 0 where there is no patch.
    x, lateral : ndarray
        Place of the contact from the wheelset's centre in its axes, m: forward, to the right.
    radius : ndarray
        Distance below the axle, m.
    angle : ndarray
        rad, contact plane to the track plane, positive as at a flange.
    a, b : ndarray
        Semi-axes along and across, m.
    slopes : dict of str to ndarray, shape (n, 3, 4)
        Of each of these over y, roll, drop, yaw.
    """

    count: np.ndarray
    zone: np.ndarray
    load: np.ndarray
    x: np.ndarray
    lateral: np.ndarray
    radius: np.ndarray
    angle: np.ndarray
    a: np.ndarray
    b: np.ndarray
    slopes: dict

    def mean(self, name):
        """Mean of a quantity over the patches, weighted by load, shape (n,); NaN in the air."""
        total = self.load.sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            return (self.load * getattr(self, name)).sum(axis=1) / total

    @property
    def vertical_load(self):
        """Sum of the patches' forces down on the rail, N, shape (n,)."""
        return (self.load * np.cos(self.angle)).sum(axis=1)

    @property
    def lateral_load(self):
        """Sum of the normal forces' parts outward on the rail (as at a flange), N, shape (n,)."""
        return (self.load * np.sin(self.angle)).sum(axis=1)


class WheelTable:
    """Contact table of one wheel; immutable.

    Attributes
    ----------
    side : {"left", "right"}
    core : railsym._core_contact.Table
        The table in C, as a right-hand side.
    """

    def __init__(self, side, table):
        self.side, self.core = side, table

    @cached_property
    def limits(self):
        """Range of each quantity: lateral shift at the height of the contact, y - r0 roll (m), roll (rad), normal penetration (m)."""
        value = self.core.value
        shift, roll = ((value(f"{n}_start") + value(f"{n}_step"), value(f"{n}_start") + (value(f"{n}s") - 2) * value(f"{n}_step")) for n in ("shift", "roll"))
        if self.side == "left":
            shift = (-shift[1], -shift[0])
        return {"lateral shift": shift, "roll": roll, "penetration": (0.0, float(value("deepest")))}

    def lookup(self, y, roll=0.0, drop=0.0, yaw=0.0, *, time=None):
        """Patches at places of the wheel.

        Parameters
        ----------
        y : array_like, shape (n,)
            Lateral shift of the wheelset against the rail, m, to the right.
        roll, drop, yaw : array_like, shape (n,) or float
            rad, m, rad; broadcast.
        time : float, optional
            s, for errors.

        Returns
        -------
        Patches

        Raises
        ------
        OutOfTableError
            Where a place is outside the table.
        ContactError, CoreError
            For shapes that do not fit, or places that are not finite.
        """
        places = np.stack(np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, dtype=float)) for v in (y, roll, drop, yaw))), axis=-1)
        if places.ndim != 2:
            raise ContactError(f"places of a wheel must be lists of numbers, got shape {places.shape[:-1]}")
        own = places * _MIRRORED if self.side == "left" else places
        records, count, beyond = self.core.lookup(own)
        if (beyond >= 0).any():
            k = int((beyond >= 0).argmax())
            raise self._error(core.QUANTITIES[beyond[k]], own[k], time)
        return _patches(records, count, self.side)

    def _error(self, quantity, own, time):
        """Error of a place (y, roll, drop, yaw of a right-hand side)."""
        sign = _SIGN[self.side]
        value = (sign * (own[0] - self.core.value("wheel_radius") * own[1]) if quantity == "lateral shift" else
                 sign * own[1] if quantity == "roll" else self._depth(own))
        return OutOfTableError(f"{self.side} wheel", quantity, float(value), self.limits[quantity], time)

    def _depth(self, own):
        """Penetration of a place that is too deep: the table's limit, and what the wheel was lowered since it was there."""
        return float(self.core.value("deepest") + own[2] - self._boundary(own[None], lambda count, beyond: beyond == 2)[0])

    def _boundary(self, own, is_below):
        """Drop (n,) at which a wheel passes from not being `is_below`(count, beyond) to being it, within 0.1 m."""
        low, high = np.full(len(own), -_FAR), np.full(len(own), _FAR)
        for _ in range(60):
            middle = 0.5 * (low + high)
            _, count, beyond = self.core.lookup(np.column_stack([own[:, :2], middle, own[:, 3]]))
            for k in np.flatnonzero((beyond == 0) | (beyond == 1)):
                raise self._error(core.QUANTITIES[beyond[k]], own[k], None)
            below = is_below(count, beyond)
            low, high = np.where(below, low, middle), np.where(below, middle, high)
        return low

    def under_load(self, y, load, roll=0.0, yaw=0.0):
        """Drop at which the wheel bears a vertical load, and its patches there.

        Parameters
        ----------
        y, load, roll, yaw : array_like, shape (n,) or float
            m, N, rad, rad.

        Returns
        -------
        drop : ndarray, shape (n,)
            m.
        patches : Patches

        Raises
        ------
        OutOfTableError
            Where the wheel is off the rail, or the load more than the table covers.
        """
        y, load, roll, yaw = (np.array(v, dtype=float) for v in np.broadcast_arrays(*(np.atleast_1d(v) for v in (y, load, roll, yaw))))
        good = np.isfinite(load) & (load > 0.0)
        if not good.all():
            raise ContactError(f"load must be positive and finite (N), got {load[~good][0]}")
        own = np.column_stack([y, roll, np.zeros(len(y)), yaw]) * (_MIRRORED if self.side == "left" else 1.0)
        touching = self._boundary(own, lambda count, beyond: (count > 0) | (beyond == 2))
        room = self._boundary(own, lambda count, beyond: beyond == 2) - touching
        step = np.minimum(1e-5, 0.5 * room)
        for _ in range(100):            # from touching: Newton's method on load^(2/3), nearly straight over the drop
            found = self.lookup(y, roll, touching + step, yaw)
            vertical = found.vertical_load
            slope = (found.slopes["load"][..., 2] * np.cos(found.angle) - found.load * np.sin(found.angle) * found.slopes["angle"][..., 2]).sum(axis=1)
            change = ((load / vertical) ** (2.0 / 3.0) - 1.0) * 1.5 * vertical / slope
            if np.abs(vertical / load - 1.0).max() < 1e-12 or np.abs(change).max() < 1e-15:
                return touching + step, found
            step = np.clip(step + change, 0.2 * step, np.minimum(3.0 * step, room))
        k = int(np.abs(vertical / load - 1.0).argmax())
        if abs(step[k] - room[k]) < 1e-9:
            raise ContactError(f"{self.side} wheel: at a lateral shift of {1e3 * y[k]:.4g} mm the contact table ends at a vertical load of {vertical[k] / 1e3:.4g} kN, "
                               f"and {load[k] / 1e3:.4g} kN is asked; build it deeper: table(deepest=...)")
        if abs(vertical[k] / load[k] - 1.0) < 1e-9:
            return touching + step, found
        raise ConvergenceError(f"{self.side} wheel: no drop found at a lateral shift of {1e3 * y[k]:.4g} mm: {vertical[k]:.6g} N of {load[k]:.6g} N")


def _patches(records, count, side):
    there = np.arange(core.ZONES) < count[:, None]
    values, slopes = {}, {}
    for name in _QUANTITIES:
        both = np.where(there[..., None], records[name], 0.0)
        sign = -1.0 if side == "left" and name == "across" else 1.0
        key = "lateral" if name == "across" else name
        values[key] = sign * both[..., 0]
        slopes[key] = sign * both[..., 1:] * (_MIRRORED if side == "left" else 1.0)
    return Patches(count=count, zone=np.where(there, records["zone"], -1), slopes=slopes, **values)


@dataclass(frozen=True, eq=False)
class ElasticContact:
    """Elastic contact of a wheelset over lateral shifts.

    Attributes
    ----------
    y : ndarray, shape (n,)
        m, to the right.
    left, right : Patches
    roll : ndarray
        rad, right side down.
    load : float
        Vertical load of each wheel, N.
    """

    y: np.ndarray
    left: Patches
    right: Patches
    roll: np.ndarray
    load: float

    @property
    def rolling_radius_difference(self):
        """Rolling radius right minus left, m: means over the patches weighted by load."""
        return self.right.mean("radius") - self.left.mean("radius")


@dataclass(frozen=True, eq=False)
class ContactTable:
    """Contact tables of the two wheels of a wheelset.

    Attributes
    ----------
    left, right : WheelTable
    tape_circle_spacing, wheel_radius, wheel_radius_left : float
        m.
    description : str
        Of what it was made.
    message : str
        What could not be computed; empty where all could.
    """

    left: WheelTable
    right: WheelTable
    tape_circle_spacing: float
    wheel_radius: float
    wheel_radius_left: float
    description: str = ""
    message: str = ""

    @property
    def nbytes(self):
        """Memory of the table in C, bytes (a symmetric pair has one for both wheels)."""
        return self.right.core.nbytes + (0 if self.left.core is self.right.core else self.left.core.nbytes)

    def contact(self, y, load, *, with_roll=False):
        """Elastic contact of a wheelset whose wheels bear the same vertical load.

        Parameters
        ----------
        y : array_like, shape (n,)
            Lateral shift, m, to the right.
        load : float
            Vertical load of each wheel, N.
        with_roll : bool
            The wheelset rolls so that both wheels bear it; otherwise each is lowered by itself without roll, as EN 15302 does.

        Returns
        -------
        ElasticContact

        Raises
        ------
        OutOfTableError
            Where a wheel is off its rail.
        ContactError
            For a load that is not positive.
        """
        y = np.atleast_1d(np.asarray(y, dtype=float))
        roll = np.zeros(len(y))
        for _ in range(40 if with_roll else 1):
            (low, left), (down, right) = (table.under_load(y, load, roll) for table in (self.left, self.right))
            # drop of the right less that of the left grows with the roll by minus the distance of the contacts
            change = (down - low) / (right.mean("lateral") - left.mean("lateral"))
            if not with_roll or np.abs(change).max() < 1e-13:
                break
            roll = roll + change
        return ElasticContact(y, left, right, roll, float(load))

    def save(self, path):
        """Write the table as NumPy archive; `load_contact_table` reads it."""
        from railsym.contact_table_files import save

        save(self, path)


def load_contact_table(path):
    """Read a contact table written by `ContactTable.save`, or an external one; see `railsym.contact_table_files.load`."""
    from railsym.contact_table_files import load

    return load(path)
