# SPDX-License-Identifier: BSD-3-Clause
"""Binding of csrc/wheel_rail.h: wheel-rail forces of all wheels of a vehicle."""

from dataclasses import dataclass

import numpy as np

from railsym._core import CREEP_LAWS, _check, _doubles, _vector, ffi, lib
from railsym.contact_pair import DEEPEST_IN_MOTION, ContactPair
from railsym.contact_table import ContactTable, OutOfTableError
from railsym.errors import ContactError, CoreError

PLACE = ("lateral shift", "roll", "drop", "yaw")
WHEEL = {"Y": lib.RS_WHEEL_Y, "Q": lib.RS_WHEEL_Q, "X": lib.RS_WHEEL_X, "t_gamma": lib.RS_WHEEL_TGAMMA,
         "patches": lib.RS_WHEEL_PATCHES}
PATCH = {"load": lib.RS_PATCH_LOAD, "xi": lib.RS_PATCH_XI, "eta": lib.RS_PATCH_XI + 1, "phi": lib.RS_PATCH_XI + 2,
         "Fx": lib.RS_PATCH_FX, "Fy": lib.RS_PATCH_FX + 1, "Mz": lib.RS_PATCH_FX + 2, "x": lib.RS_PATCH_X,
         "across": lib.RS_PATCH_ACROSS, "radius": lib.RS_PATCH_RADIUS, "angle": lib.RS_PATCH_ANGLE,
         "a": lib.RS_PATCH_A, "b": lib.RS_PATCH_B}


@dataclass(frozen=True)
class Shape:
    """What one wheel is looked up in, in C memory.

    Attributes
    ----------
    kind : int
        lib.RS_CONTACT_...
    pointer : cdata
        The shape; `keep` holds its memory.
    r0 : float
        m, height of the wheelset's centre over the top of rail at drop = 0.
    half_spacing : float
        m, lateral place of the tape circle from the wheelset's centre, and of the rail's head from the track's.
    outside : callable
        (number of the quantity that left its range, place (4)) -> its name, value and limits, as `OutOfTableError` takes them.
    keep : object
    """

    kind: int
    pointer: object
    r0: float
    half_spacing: float
    outside: object
    keep: object


def cones(r0, zones, limits, half_spacing=0.75, outside=None):
    """Shape of cones on round rails.

    Parameters
    ----------
    zones : list of dict
        Fields of rs_cone in interface.h, 1 to 3 zones.
    limits : sequence of float, length 3
        Largest |lateral shift| m, |roll| rad, penetration m.
    """
    memory = ffi.new("rs_contact_cones *")
    memory.cones, memory.r0, memory.limit = len(zones), r0, list(limits)
    for cone, zone in zip(memory.cone, zones):
        for name, value in zone.items():
            setattr(cone, name, value)
    return Shape(lib.RS_CONTACT_CONES, memory, r0, half_spacing, outside, memory)


def table(wheel):
    """Shape of a wheel's contact table, a `railsym.contact_table.WheelTable`."""
    made, sign = wheel.core, -1.0 if wheel.side == "left" else 1.0
    r0 = made.value("wheel_radius")

    def outside(number, place):
        name = ("lateral shift", "roll", "penetration")[number]
        value = (sign * (place[0] - r0 * place[1]), sign * place[1], None)[number]
        return name, wheel._depth(place) if value is None else value, wheel.limits[name]

    return Shape(lib.RS_CONTACT_TABLE, made.pointer, r0, made.value("spacing"), outside, wheel)


def shape_of(contact, side):
    """Shape of one wheel (side -1, 1) of a contact: a ContactPair or its table, or anything with ``wheel_shape(side)``."""
    if isinstance(contact, ContactPair):
        contact = contact.table(deepest=DEEPEST_IN_MOTION)
    if isinstance(contact, ContactTable):
        return table(contact.left if side < 0 else contact.right)
    if not hasattr(contact, "wheel_shape"):
        raise ContactError(f"contact is {type(contact).__name__}; wheel-rail forces need a ContactPair, its table, or a ConicalContact")
    return contact.wheel_shape(side)


class WheelRailCore:
    """The object rs_wheel_rail.

    Parameters
    ----------
    wheelsets : list of dict
        Keys first, offset (3), spacing, and wheels: two dicts of sink, friction, weight, damping and shape (`Shape`).
    creep : dict
        Fields of rs_creep_settings, the law by name, coefficients as ``c`` (pieces, 4, 4).
    """

    def __init__(self, wheelsets, creep):
        self.count = len(wheelsets)
        self._shapes = [wheel["shape"] for one in wheelsets for wheel in one["wheels"]]
        table = ffi.new("rs_wheelset[]", self.count)
        for target, given in zip(table, wheelsets):
            target.first, target.offset, target.spacing = given["first"], list(given["offset"]), given["spacing"]
            for wheel, values in zip(target.wheel, given["wheels"]):
                _fill_wheel(wheel, values)
        coefficients = np.ascontiguousarray(creep["c"], dtype=float)
        settings = ffi.new("rs_creep_settings *", {k: v for k, v in creep.items() if k not in ("c", "law")})
        settings.law, settings.pieces = getattr(lib, CREEP_LAWS[creep["law"]]), len(coefficients)
        settings.c = _doubles(coefficients)
        if creep["law"] == "exact":
            from railsym._core_exact import creep_table

            settings.table = creep_table()
        wr = lib.rs_wheel_rail_create(self.count, table, settings)
        if wr == ffi.NULL:
            raise ContactError(f"wheel-rail forces of {self.count} wheelsets cannot be made: at least one wheelset, a grid of at least 1 x 1 "
                               f"and a contact that this build knows are needed (law {creep['law']}, grid {creep['strips']} x {creep['cells']})")
        self.pointer = ffi.gc(wr, lib.rs_wheel_rail_free)
        self._last = max(one["first"] for one in wheelsets) + 6
        self.names = [f"wheelset {k + 1}, {side}" for k in range(self.count) for side in ("left", "right")]

    def rows(self, q, u, speed, w, rail, seed):
        """Rows (n, 6) and, with a seed (cq, cu), blocks (n, 6, 6), else None; see csrc/wheel_rail.h."""
        state = [np.ascontiguousarray(part, dtype=float) for part in (q, u)]
        for part, what in zip(state, ("q", "u"), strict=True):
            if part.ndim != 1 or part.size < self._last:
                raise ContactError(f"{what}: the wheelsets' coordinates reach number {self._last - 1}, an array of shape {part.shape} was given")
        w = _vector(np.zeros(3 * self.count) if w is None else w, 3 * self.count, "angular velocities of the track frames")
        rail = None if rail is None else _vector(rail, 8 * self.count, "deviations of the rails")
        rows, blocks = np.empty((self.count, 6)), None if seed is None else np.empty((self.count, 6, 6))
        seed = _vector(seed if seed is not None else (0.0, 0.0), 2, "seed")
        status = lib.rs_wheel_rail_rows(self.pointer, *map(_doubles, state), speed, _doubles(w), _or_null(rail), _doubles(seed),
                                        _doubles(rows), _or_null(blocks))
        if status != lib.RS_OK:
            self.explain(status, speed)
        return rows, blocks

    def explain(self, status, speed, time=None):
        """Raise the error that a status of rs_wheel_rail_rows stands for."""
        wheel, variable, value, place = ffi.new("int *"), ffi.new("int *"), ffi.new("double *"), np.empty(lib.RS_PLACE_SIZE)
        lib.rs_wheel_rail_failure(self.pointer, wheel, variable, value, _doubles(place))
        number, value, at = variable[0], value[0], "" if time is None else f" at t = {time:.6g} s"
        if status == lib.RS_BAD_SPEED:
            raise ContactError(f"speed is {speed!r} m/s{at}; creepages are slips over the speed, so it must be positive and finite")
        if wheel[0] < 0:
            raise CoreError(f"status {status} is not one of the wheels")
        where = self.names[wheel[0]]
        if status == lib.RS_OUT_OF_TABLE and number < len(PLACE):
            raise _left_table(where, *self._shapes[wheel[0]].outside(number, place), time)
        if status == lib.RS_OUT_OF_TABLE:
            raise ContactError(f"{where}{at}: a contact ellipse with a/b = {np.exp(value):.4g} is outside the creep coefficients' range, 0.001 to 1000")
        if status == lib.RS_NOT_FINITE:
            what = f"its {PLACE[number]} against the rail is {value}" if 0 <= number < len(PLACE) else "its forces are not finite"
            raise ContactError(f"{where}{at}: {what}; look at the state of its wheelset")
        _check(status, where)

    def outputs(self):
        """Wheel (2 n, WHEEL) and patch (2 n, zones, PATCH) outputs of the last `rows`."""
        wheel = np.empty((2 * self.count, lib.RS_WHEEL_OUTPUTS))
        patch = np.empty((2 * self.count, lib.RS_ZONES, lib.RS_PATCH_OUTPUTS))
        lib.rs_wheel_rail_outputs(self.pointer, _doubles(wheel), _doubles(patch))
        return wheel, patch


def _left_table(where, quantity, value, limits, time):
    error = OutOfTableError(where, quantity, float(value), limits, time)
    if limits[0] <= value <= limits[1]:  # the table ends there as well, where a zone meets the rail beyond an end of a profile
        error.args = (f"{where}: at {quantity} {value:.4g} it meets its rail beyond an end of one of the profiles"
                      + ("" if time is None else f", t = {time:.6g} s"),)
    return error


def _fill_wheel(wheel, values):
    shape = values["shape"]
    wheel.kind, wheel.shape, wheel.r0 = shape.kind, ffi.cast("void *", shape.pointer), shape.r0
    for name in ("sink", "friction", "weight", "damping"):
        setattr(wheel, name, values[name])


def _or_null(array):
    return ffi.NULL if array is None else _doubles(array)
