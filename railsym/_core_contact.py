# SPDX-License-Identifier: BSD-3-Clause
"""The contact table in C: built, kept as arrays, read (csrc/contact)."""

from dataclasses import dataclass

import numpy as np

from railsym._core import _check, _doubles, _vector, ffi, lib
from railsym.errors import ContactError, CoreError

ZONES, FIELDS = lib.RS_ZONES, 8
SHAPE = ("shift_start", "shift_step", "shifts", "roll_start", "roll_step", "rolls", "levels", "zones", "deepest", "wheel_radius", "spacing")
# one record a patch: seven quantities with their slopes over y, roll, drop, yaw; the zone
PATCH = np.dtype([(name, np.float64, 5) for name in ("load", "x", "across", "radius", "angle", "a", "b")] + [("zone", np.intc)], align=True)
assert PATCH.itemsize == ffi.sizeof("rs_patch")


@dataclass(frozen=True)
class Outside:
    """Where a place of a wheel left the table: which of the places, and which of its quantities."""

    number: int
    quantity: str


class Surfaces:
    """A wheel and a rail as the table is built from them; arrays are kept alive here.

    Parameters
    ----------
    rail : tuple
        Step of the arc (m), and y, z, cosine and sine of the slope of its points, arrays (n,).
    wheel : tuple
        Start and step along the axle (m), and radius and its slope there, arrays (m,).
    wheel_radius, spacing : float
        m.
    """

    def __init__(self, rail, wheel, wheel_radius, spacing):
        (rail_step, *rail_arrays), (start, step, *wheel_arrays) = rail, wheel
        rail_arrays, wheel_arrays = ([np.ascontiguousarray(part, dtype=float) for part in parts] for parts in (rail_arrays, wheel_arrays))
        self._keep = (*rail_arrays, *wheel_arrays)
        names = ("rail_y", "rail_z", "rail_cosine", "rail_sine", "wheel_radius_at", "wheel_slope_at")
        self.pointer = ffi.new("rs_surfaces *", {
            "rail_count": len(rail_arrays[0]), "rail_step": rail_step, "wheel_count": len(wheel_arrays[0]), "wheel_start": start, "wheel_step": step,
            "wheel_radius": wheel_radius, "spacing": spacing, **{name: _doubles(part) for name, part in zip(names, self._keep, strict=True)}})

    def rigid_contact(self, shift, roll):
        """Drop (m), place on the wheel (m), slope of the wheel, and whether it is inside both profiles; arrays (n,)."""
        place = np.ascontiguousarray(np.column_stack(np.broadcast_arrays(shift, roll)), dtype=float)
        found = np.empty((len(place), 4))
        _check(lib.rs_rigid_contact(self.pointer, len(place), _doubles(place), _doubles(found)), "rigid contact")
        return found[:, 0], found[:, 1], found[:, 2], found[:, 3] > 0.5


class Table:
    """One immutable contact table in C memory."""

    def __init__(self, pointer):
        self.pointer = ffi.gc(pointer, lib.rs_contact_table_free)
        shape = np.empty(len(SHAPE))
        lib.rs_contact_table_shape(self.pointer, _doubles(shape))
        self.shape = shape

    @classmethod
    def built(cls, surfaces, axes, levels, cuts, modulus, deepest):
        """From surfaces; axes: start, step, nodes of the shift and of the roll; cuts: places on the wheel (m), from + to -infinity."""
        made = ffi.new("rs_contact_table **")
        _check(lib.rs_contact_table_build(surfaces.pointer, _doubles(_vector(axes, 6, "axes")), levels, len(cuts) - 1,
                                          _doubles(np.ascontiguousarray(cuts, dtype=float)), modulus, deepest, made), "building a contact table")
        return cls(made[0])

    @classmethod
    def of_arrays(cls, shape, closure, field):
        """From what `arrays` returns."""
        shape = _vector(shape, len(SHAPE), "shape of a contact table")
        sizes = [int(shape[SHAPE.index(name)]) for name in ("shifts", "rolls", "levels", "zones")]
        nodes = sizes[0] * sizes[1] * FIELDS
        made = ffi.new("rs_contact_table **")
        _check(lib.rs_contact_table_of_arrays(_doubles(shape), _doubles(_vector(closure, nodes, "closure")),
                                              _doubles(_vector(field, nodes * sizes[2] * sizes[3], "field")), made), "contact table from arrays")
        return cls(made[0])

    def value(self, name):
        """One number of the shape."""
        return self.shape[SHAPE.index(name)]

    def arrays(self):
        """closure (shifts, rolls, fields) and field (zones, shifts, rolls, levels, fields)."""
        shifts, rolls, levels, zones = (int(self.value(name)) for name in ("shifts", "rolls", "levels", "zones"))
        closure, field = np.empty((shifts, rolls, FIELDS)), np.empty((zones, shifts, rolls, levels, FIELDS))
        lib.rs_contact_table_arrays(self.pointer, _doubles(closure), _doubles(field))
        return closure, field

    def lookup(self, place):
        """Patches (n, zones) as records `PATCH`, their number (n,), and `Outside` or None; place (n, 4): y, roll, drop, yaw."""
        place = np.ascontiguousarray(place, dtype=float)
        if place.ndim != 2 or place.shape[1] != lib.RS_PLACE_SIZE:
            raise ContactError(f"places of a wheel must be (n, {lib.RS_PLACE_SIZE}): y, roll, drop, yaw; got {place.shape}")
        n = len(place)
        patch, count = np.zeros((n, ZONES), dtype=PATCH), np.zeros(n, dtype=np.intc)
        failed, beyond = ffi.new("int *"), ffi.new("int *")
        status = lib.rs_contact_lookup_many(self.pointer, n, _doubles(place), ffi.from_buffer("rs_patch[]", patch), ffi.from_buffer("int[]", count),
                                            failed, beyond)
        if status == lib.RS_OUT_OF_TABLE:
            return patch, count, Outside(failed[0], ("lateral shift", "roll", "penetration")[beyond[0]])
        if status != lib.RS_OK:
            raise CoreError(f"contact table: place {failed[0]} is not finite: y, roll, drop, yaw = {place[failed[0]].tolist()}")
        return patch, count, None
