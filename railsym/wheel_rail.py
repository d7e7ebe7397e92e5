# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces of a vehicle in motion.

    forces = WheelRail(vehicle, contact, law="fastsim")
    rows, blocks = forces.rows(q, u, speed, seed=(1.0, 0.0))
    forces.outputs().Q

``docs/wheel_rail_forces.md`` says what is computed; csrc/wheel_rail computes it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from railsym.creep import Material, _checked_grid, _known
from railsym.errors import ContactError
from railsym.kalker import kalker_coefficients

DECADES, NODES_A_DECADE = 3, 64  # of a/b on both sides of 1: cubics between err by 1e-5, the table by 5e-3
LARGEST_MISFIT = 5e-3  # m, between the height of a wheelset's centre and the wheel radius of its contact: wear, not another wheel
CONTACT_DAMPING = 1.0  # s/m, assumed: 3 % of critical for a wheelset of 1.8 t on Hertzian contact at 66 kN a wheel


@lru_cache(maxsize=32)
def kalker_table(poisson):
    """Kalker's coefficients as cubics over ln(a/b).

    Parameters
    ----------
    poisson : float

    Returns
    -------
    start, step : float
        First node and distance of the nodes, ln(a/b).
    cubics : ndarray, shape (pieces, 4, 4)
        C11, C22, C23, C33 = c0 + t (c1 + t (c2 + t c3)), t from the piece's first node.
    """
    from scipy.interpolate import CubicSpline

    step = np.log(10.0) / NODES_A_DECADE
    parts = []
    # The coefficients' slopes jump at a/b = 0.1 and 10 (railsym.kalker), which are nodes: a spline for each part.
    for low, high in ((-DECADES, -1), (-1, 1), (1, DECADES)):
        nodes = step * np.arange(low * NODES_A_DECADE, high * NODES_A_DECADE + 1)
        values = np.array(kalker_coefficients(np.exp(nodes), poisson)).T
        parts.append(np.transpose(CubicSpline(nodes, values).c[::-1], (1, 2, 0)))
    cubics = np.concatenate(parts)
    cubics.setflags(write=False)
    return -DECADES * np.log(10.0), step, cubics


@dataclass(frozen=True, eq=False)
class WheelOutputs:
    """Forces of every wheel at one state; wheels in the order left, right of the first wheelset, of the second, ...

    Attributes
    ----------
    Y, Q : ndarray, shape (wheels,)
        N, of the wheel on the rail in the track's axes: lateral, positive outwards; vertical, positive down.
    X : ndarray, shape (wheels,)
        N, of the rail on the wheel, positive forward.
    t_gamma : ndarray, shape (wheels,)
        N, sum of |Fx xi| + |Fy eta| of the patches.
    patches : ndarray of int, shape (wheels,)
    load : ndarray, shape (wheels, zones)
        N; 0 where a zone carries nothing, and all of its numbers are 0.
    creepage, force : ndarray, shape (wheels, zones, 3)
        xi -, eta -, phi 1/m; Fx N, Fy N, Mz N m on the wheel, in the contact plane.
    x, across, radius, angle, a, b : ndarray, shape (wheels, zones)
        Place of the contact m, its plane rad and semi-axes m; axes of csrc/contact/contact_table.h.
    """

    Y: np.ndarray
    Q: np.ndarray
    X: np.ndarray
    t_gamma: np.ndarray
    patches: np.ndarray
    load: np.ndarray
    creepage: np.ndarray
    force: np.ndarray
    x: np.ndarray
    across: np.ndarray
    radius: np.ndarray
    angle: np.ndarray
    a: np.ndarray
    b: np.ndarray


@dataclass(frozen=True)
class WheelsetPlace:
    """Where a wheelset's coordinates and its design position are.

    Attributes
    ----------
    name : str
    first : int
        Number of its coordinate x; y z yaw roll spin follow.
    offset : sequence of 3 float
        m, design position of its centre in its track frame.
    """

    name: str
    first: int
    offset: tuple


class WheelRail:
    """Wheel-rail forces of all wheels of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle or list of WheelsetPlace
    contact : ContactPair, ContactTable or ConicalContact, or pair of them (left, right)
        What else has ``wheel_shape(side)`` serves as well.
    law : str
        Creep law, see `railsym.creep_laws`.
    grid : pair of int
        Strips and cells of FASTSIM and FaStrip.
    friction, kalker_weight : float or ndarray, shape (wheels,), optional
        Of the vehicle file's [contact] where it has them; else 0.3 and 1.
    damping : float
        chi, s/m: load = elastic load (1 + chi penetration rate), not below zero.
    material : Material, optional
        Of both bodies; the vehicle file's, else steel.
    reduction : pair of float
        Polach's factors kA, kS.
    rail_spacing : float, optional
        m, distance of the rail heads; their cross level turns both rails by itself over this. Default: that of the contact's tape circles.
    wheel_loads : ndarray, shape (wheels,), optional
        N: every wheel sinks into its rail by what carries its load, so that the coordinates at zero are in equilibrium.
        Default: the static wheel loads of a Vehicle; none of a list of WheelsetPlace, which then does not sink.

    Raises
    ------
    ContactError
        For values outside their range, an unknown law, loads that the contact cannot carry.
    """

    def __init__(self, vehicle, contact, *, law="fastsim", grid=(20, 20), friction=None, kalker_weight=None, damping=CONTACT_DAMPING,
                 material=None, reduction=(1.0, 1.0), rail_spacing=None, wheel_loads=None):
        from railsym import _core
        from railsym._core_wheel_rail import shape_of

        self.wheelsets, given, loads = _places(vehicle)
        self._law, self._grid, self._reduction = _known(law, _core.CREEP_LAWS), _checked_grid(grid), _checked_reduction(reduction)
        self._material = material or _material(given)
        left, right = contact if isinstance(contact, (tuple, list)) else (contact, contact)
        shapes = (shape_of(left, -1), shape_of(right, 1))
        wheels = len(self.wheelsets) * 2
        self._spacing = _positive(shapes[0].half_spacing + shapes[1].half_spacing if rail_spacing is None else rail_spacing, "rail_spacing", "m")
        self._wheel_values = {
            "friction": _each(given.get("friction", 0.3) if friction is None else friction, wheels, "friction", "-"),
            "weight": _each(given.get("kalker_weight", 1.0) if kalker_weight is None else kalker_weight, wheels, "kalker_weight", "-"),
            "damping": _each(damping, wheels, "damping", "s/m"),
        }
        if not np.all(self._wheel_values["weight"] > 0.0):
            raise ContactError(f"kalker_weight must be positive, got {kalker_weight!r}")
        self.sink = np.zeros(wheels)
        self._height = np.array([_height(one, shape) for one in self.wheelsets for shape in shapes])
        self._core = self._made(shapes)
        loads = loads if wheel_loads is None else wheel_loads
        if loads is not None:
            self.sink = self._sinks(_each(loads, wheels, "wheel_loads", "N"))
            self._core = self._made(shapes)

    def _made(self, shapes):
        from railsym._core_wheel_rail import WheelRailCore

        start, step, cubics = kalker_table(self._material.poisson)
        creep = {"law": self._law, "strips": self._grid[0], "cells": self._grid[1], "modulus": self._material.shear_modulus,
                 "adhesion": self._reduction[0], "slip": self._reduction[1], "start": start, "step": step, "c": cubics}
        wheel = lambda k: {"shape": shapes[k % 2], "sink": self.sink[k]} | {  # noqa: E731
            name: values[k] for name, values in self._wheel_values.items()}
        core = WheelRailCore([{"first": one.first, "offset": one.offset, "spacing": self._spacing, "wheels": (wheel(2 * k), wheel(2 * k + 1))}
                              for k, one in enumerate(self.wheelsets)], creep)
        core.names = [f"{one.name}, {side}" for one in self.wheelsets for side in ("left", "right")]
        return core

    @property
    def pointer(self):
        """The C object rs_wheel_rail, for other parts of the library; it lives as long as this one."""
        return self._core.pointer

    @property
    def size(self):
        """Number of coordinates that q and u need at least."""
        return max(one.first for one in self.wheelsets) + 6

    def rows(self, q, u, speed, w=None, rail=None, seed=None):
        """What the wheels add to the residual, and to the pencil if asked.

        Parameters
        ----------
        q, u : array_like, shape (n,)
            Coordinates of the model and their rates.
        speed : float
            V of the track frames, m/s, positive.
        w : array_like, shape (wheelsets, 3), optional
            Angular velocities of the track frames, rad/s.
        rail : array_like, shape (wheelsets, 8), optional
            Left y, left z, right y, right z of the rails, m, then their derivatives d/ds in this order.
        seed : pair of float, optional
            (cq, cu).

        Returns
        -------
        rows : ndarray, shape (wheelsets, 6)
        blocks : ndarray, shape (wheelsets, 6, 6), or None
            cq drows/dq + cu drows/du.

        Raises
        ------
        OutOfTableError
            A wheel outside its contact table.
        ContactError
            Speed not positive; a state that is not finite.
        """
        return self._core.rows(q, u, speed, w, rail, seed)

    def explain(self, status, speed, time=None):
        """Raise the error that a status of rs_wheel_rail_rows stands for; for callers of the C function.

        Parameters
        ----------
        status : int
        speed : float
            m/s, as it was given.
        time : float, optional
            s, for the message.
        """
        self._core.explain(status, speed, time)

    def outputs(self):
        """`WheelOutputs` of the last `rows`."""
        from railsym._core_wheel_rail import PATCH, WHEEL

        wheel, patch = self._core.outputs()
        found = {name: wheel[:, k] for name, k in WHEEL.items()}
        found["patches"] = found["patches"].astype(int)
        found["creepage"], found["force"] = (patch[:, :, PATCH[first]:PATCH[first] + 3] for first in ("xi", "Fx"))
        return WheelOutputs(**found, **{name: patch[:, :, PATCH[name]] for name in ("load", "x", "across", "radius", "angle", "a", "b")})

    def _sinks(self, loads):
        """Displacements downwards at which each wheel, centred, carries its load."""
        from scipy.optimize import brentq

        def lack(drop, wheel):
            q = np.zeros(self.size)
            for one in self.wheelsets:
                q[one.first + 2] = drop
            self.rows(q, np.zeros(self.size), 1.0)
            found = self.outputs()
            return float(np.sum(found.load[wheel] * np.cos(found.angle[wheel]))) - loads[wheel]

        def sink(wheel):
            start, reach = self._height[wheel], 1e-5
            low = high = start
            try:
                while lack(low, wheel) > 0.0:
                    low, reach = start - reach, 2.0 * reach
                while lack(high, wheel) < 0.0:
                    high, reach = start + reach, 2.0 * reach
            except ContactError as error:
                raise ContactError(f"the contact cannot carry the static load of {self._core.names[wheel]}, {loads[wheel]:.6g} N: {error}") from None
            return brentq(lack, low, high, args=(wheel,), xtol=1e-15, rtol=1e-14)

        return np.array([sink(wheel) for wheel in range(len(loads))])


def _places(vehicle):
    """WheelsetPlaces, the vehicle's [contact] and its static wheel loads."""
    if isinstance(vehicle, (list, tuple)):
        if not vehicle:
            raise ContactError("wheel-rail forces need at least one wheelset, none was given")
        return list(vehicle), {}, None
    from railsym.linear import rolling_vehicle

    rolling = rolling_vehicle(vehicle)
    start = rolling.model.topology.start
    bodies = [body for body, side in rolling.model.wheels if side < 0]
    places = [WheelsetPlace(b.name, start[b.name], (0.0, b.position[1], b.position[2])) for b in bodies]
    return places, vehicle.contact, rolling.preload.wheel_loads


def _height(one, shape):
    """How far the wheelset's centre lies above the height of its wheel's radius, m."""
    height = -one.offset[2] - shape.r0
    if not abs(height) <= LARGEST_MISFIT:
        raise ContactError(f"{one.name}: its centre is {-one.offset[2]:.6g} m above the rails, the contact is for wheels of {shape.r0:.6g} m; "
                           "make the contact for the vehicle's wheel_radius")
    return height


def _material(given):
    if "young_modulus" not in given or "poisson_ratio" not in given:
        return Material()
    poisson = float(given["poisson_ratio"])
    return replace(Material(), shear_modulus=float(given["young_modulus"]) / (2.0 * (1.0 + poisson)), poisson=poisson)


def _each(value, wheels, name, unit):
    """One number a wheel, finite and not negative."""
    array = np.asarray(value, dtype=float)
    if array.ndim > 1 or array.ndim == 1 and len(array) != wheels:
        raise ContactError(f"{name} needs one number or one a wheel ({wheels}), got shape {array.shape}")
    if not np.all(np.isfinite(array) & (array >= 0.0)):
        raise ContactError(f"{name} ({unit}) must be finite and not negative, got {value!r}")
    return np.broadcast_to(array, wheels).copy()


def _positive(value, name, unit):
    if not (np.isfinite(value) and value > 0.0):
        raise ContactError(f"{name} is {value!r} {unit}; it must be positive")
    return float(value)


def _checked_reduction(reduction):
    adhesion, slip = (float(part) for part in reduction)
    if not 0.0 < slip <= adhesion <= 1.0:
        raise ContactError(f"Polach's factors need 0 < kS <= kA <= 1, got kA = {adhesion}, kS = {slip}")
    return adhesion, slip
