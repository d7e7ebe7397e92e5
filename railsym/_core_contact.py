# SPDX-License-Identifier: BSD-3-Clause
"""The contact table in C: built, kept as arrays, read (csrc/contact)."""

import numpy as np

from railsym._core import _check, _doubles, _vector, ffi, lib
from railsym.errors import ContactError, CoreError

ZONES, FIELDS, CLOSURE = lib.RS_ZONES, 8, 4
SHAPE = ("shift_start", "shift_step", "shifts", "roll_start", "roll_step", "rolls", "levels", "zones", "deepest", "wheel_radius", "spacing")
# one record a patch: seven quantities with their slopes over y, roll, drop, yaw; the zone
PATCH = np.dtype([(name, np.float64, 5) for name in ("load", "x", "across", "radius", "angle", "a", "b")] + [("zone", np.intc)], align=True)
assert PATCH.itemsize == ffi.sizeof("rs_patch")


QUANTITIES = ("lateral shift", "roll", "penetration")       # what may be beyond the table, in the order of its numbers


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
    """One immutable contact table in C memory.

    Attributes
    ----------
    shape : ndarray (11,)
        `SHAPE`.
    axes : ndarray (zones, 3)
        Start, step and number of the shift nodes of each zone.
    failures : int
        Nodes that could not be computed.
    """

    def __init__(self, pointer, failures=0):
        self.pointer, self.failures = ffi.gc(pointer, lib.rs_contact_table_free), failures
        self.shape, axes = np.empty(len(SHAPE)), np.zeros((ZONES, 3))
        lib.rs_contact_table_shape(self.pointer, _doubles(self.shape), _doubles(axes))
        self.axes = axes[:int(self.value("zones"))].copy()

    @classmethod
    def built(cls, surfaces, shape, cuts, parts, modulus):
        """From surfaces; cuts (zones + 1,): places on the wheel (m), from + to -infinity; parts (zones,): of each interval of the shift."""
        made, failures = ffi.new("rs_contact_table **"), ffi.new("int *")
        _check(lib.rs_contact_table_build(surfaces.pointer, _doubles(_vector(shape, len(SHAPE), "shape")), _doubles(np.ascontiguousarray(cuts, dtype=float)),
                                          ffi.new("int[]", list(parts)), modulus, made, failures), "building a contact table")
        return cls(made[0], failures[0])

    @classmethod
    def of_arrays(cls, shape, axes, closures, fields, values=False):
        """From `shape`, `axes` and one array of each a zone, as `arrays` returns them; ``values``: fields are values at the nodes."""
        shape, axes = _vector(shape, len(SHAPE), "shape of a contact table"), np.ascontiguousarray(axes, dtype=float).reshape(-1, 3)
        rolls, levels, zones = (int(shape[SHAPE.index(name)]) for name in ("rolls", "levels", "zones"))
        if not len(axes) == len(closures) == len(fields) == zones:
            raise ContactError(f"a contact table of {zones} zones needs as many axes, closures and fields; got {len(axes)}, {len(closures)}, {len(fields)}")
        keep = [(_vector(c, int(axis[2]) * rolls * CLOSURE, "closure"), _vector(f, int(axis[2]) * rolls * levels * FIELDS, "field"))
                for axis, c, f in zip(axes, closures, fields)]
        pointers = [ffi.new("double *[]", [ffi.cast("double *", ffi.from_buffer(pair[k])) for pair in keep]) for k in range(2)]
        made = ffi.new("rs_contact_table **")
        _check(lib.rs_contact_table_of_arrays(_doubles(shape), _doubles(axes), *pointers, int(values), made), "contact table from arrays")
        return cls(made[0])

    def value(self, name):
        """One number of the shape."""
        return self.shape[SHAPE.index(name)]

    def arrays(self, zone):
        """closure (shifts, rolls, 4) and field (shifts, rolls, levels, 8) of a zone."""
        shifts, rolls, levels = int(self.axes[zone, 2]), int(self.value("rolls")), int(self.value("levels"))
        closure, field = np.empty((shifts, rolls, CLOSURE)), np.empty((shifts, rolls, levels, FIELDS))
        lib.rs_contact_table_arrays(self.pointer, zone, _doubles(closure), _doubles(field))
        return closure, field

    @property
    def nbytes(self):
        """Size in memory, bytes."""
        nodes = self.axes[:, 2].sum() * self.value("rolls")
        return int(8 * nodes * (CLOSURE + self.value("levels") * FIELDS))

    def lookup(self, place):
        """Patches (n, zones) as records `PATCH`, their number (n,), and what is beyond the table (n,): -1 nothing, else a place in `QUANTITIES`.

        place (n, 4): y, roll, drop, yaw.

        Raises
        ------
        ContactError, CoreError
            For a shape that does not fit, or a place that is not finite.
        """
        place = np.ascontiguousarray(place, dtype=float)
        if place.ndim != 2 or place.shape[1] != lib.RS_PLACE_SIZE:
            raise ContactError(f"places of a wheel must be (n, {lib.RS_PLACE_SIZE}): y, roll, drop, yaw; got {place.shape}")
        patch, count, beyond = found = room(len(place))
        self.lookup_into(place, *found)
        if (beyond == lib.RS_PLACE_SIZE).any():
            k = int((beyond == lib.RS_PLACE_SIZE).argmax())
            raise CoreError(f"contact table: place {k} is not finite: y, roll, drop, yaw = {place[k].tolist()}")
        return patch, count, beyond

    def lookup_into(self, place, patch, count, beyond):
        """`lookup` without checks into arrays of `room`: for loops that keep them."""
        lib.rs_contact_lookup_many(self.pointer, len(place), _doubles(place), ffi.from_buffer("rs_patch[]", patch), ffi.from_buffer("int[]", count),
                                   ffi.from_buffer("int[]", beyond))


def room(count):
    """Arrays for `Table.lookup_into` of so many places."""
    return np.zeros((count, ZONES), dtype=PATCH), np.zeros(count, dtype=np.intc), np.zeros(count, dtype=np.intc)
