# SPDX-License-Identifier: BSD-3-Clause
"""A contact table from the columns of another program: one wheel over its lateral shift, at one or several static loads.

With both wheels touching (roll phi(y), positive right side down), eta = y - r0 phi and the contact at the lateral distance L, whose plane has
the angle to the axle and angle - phi to the track plane, the wheelset's centre stands at c(eta) - phi L over its right rail. A wheelset that
slides to dy and dphi keeps both touching, d(c - phi L) + L dphi = -tan(angle - phi) d(eta), so

    dc/d(eta) = phi dL/d(eta) - tan(angle - phi)       c(eta_right) - phi L(y) = c(eta_left) + phi L(-y)         (1)

eta and phi are found together by repetition. Load at the penetration p is K p^(3/2).
"""

from __future__ import annotations

import numpy as np

from railsym import _core_contact as core
from railsym.contact_table import ContactTable, WheelTable
from railsym.errors import ContactError

_ROLLS = 5                     # nodes of the roll, over which c is straight and nothing else changes
_ROLL_STEP = 1e-2              # rad
_LEVELS = 8
_STEP = 5e-5                   # m between nodes of the shift
_LIMITS = {"lateral_shift_m": (-0.05, 0.05), "normal_load_N": (1.0, 1e7), "contact_angle_rad": (-1.5, 1.5), "a_m": (1e-5, 0.1), "b_m": (1e-5, 0.1),
           "lateral_distance_m": (0.2, 1.2), "rolling_radius_m": (0.05, 1.5), "penetration_m": (1e-7, 5e-3)}


def table_of_rows(rows, spacing, wheel_radius, name):
    """`ContactTable` of the columns of `railsym.contact_table_files.read_rows`.

    Raises
    ------
    ContactError
        For numbers outside what a railway wheel can have, or columns that do not fit each other.
    """
    _check(rows, name)
    shift = np.unique(rows["lateral_shift_m"])
    if len(shift) < 8 or shift[0] > -1e-4 or shift[-1] < 1e-4:
        raise ContactError(f"{name}: lateral shifts from {1e3 * shift[0]:g} to {1e3 * shift[-1]:g} mm; at least 8, on both sides of the centre, are needed")
    loads = len(rows["lateral_shift_m"]) / len(shift)
    if loads != int(loads):
        raise ContactError(f"{name}: {len(rows['lateral_shift_m'])} rows for {len(shift)} lateral shifts; each needs the same loads")
    columns = {key: values.reshape(len(shift), int(loads)) for key, values in rows.items()}
    radius = float(np.interp(0.0, shift, columns["rolling_radius_m"].mean(axis=1))) if wheel_radius is None else float(wheel_radius)
    reach = min(-shift[0], shift[-1])
    eta, closure = _closure(shift, columns, radius, reach)
    table = _core_table(eta, closure, columns, radius, 0.5 * spacing)
    return ContactTable(WheelTable("left", table), WheelTable("right", table), float(spacing), radius, radius, name)


def _check(rows, name):
    for key, (low, high) in _LIMITS.items():
        bad = ~((rows[key] >= low) & (rows[key] <= high))
        if bad.any():
            raise ContactError(f"{name}: {key} is {rows[key][bad][0]:g} at lateral shift {1e3 * rows['lateral_shift_m'][bad][0]:g} mm; it must be from {low:g} "
                               f"to {high:g}: check its unit")


def _closure(shift, columns, radius, reach):
    """eta and c at each shift, equation (1)."""
    angle, distance = columns["contact_angle_rad"].mean(axis=1), columns["lateral_distance_m"].mean(axis=1)
    roll = np.zeros(len(shift))
    mirrored = lambda values: np.interp(-shift, shift, values)  # noqa: E731 beyond the last shift: the last value
    for _ in range(20):
        eta = shift - radius * roll
        slope = -np.tan(angle - roll)
        c = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(eta) + 0.5 * (roll[1:] + roll[:-1]) * np.diff(distance))])
        c -= np.interp(0.0, eta, c)
        found = (c - mirrored(c)) / (distance + mirrored(distance))
        found[np.abs(shift) > reach] = np.interp(shift[np.abs(shift) > reach], shift[np.abs(shift) <= reach], found[np.abs(shift) <= reach])
        if np.abs(found - roll).max() < 1e-12:
            break
        roll = found
    if not (np.diff(eta) > 0.0).all():
        raise ContactError("the table's contact angles let the wheelset roll back over its own shift; check sign and unit of contact_angle_rad")
    return eta, c


def _core_table(eta, closure, columns, radius, half_spacing):
    """The columns on the nodes of a table in C, with one zone."""
    half = int(min(-eta[0], eta[-1]) / _STEP) - 2
    nodes = _STEP * np.arange(-half - 1, half + 2)
    at = lambda values: np.interp(nodes, eta, values)  # noqa: E731
    angle, distance = (columns[k].mean(axis=1) for k in ("contact_angle_rad", "lateral_distance_m"))
    deepest = 3.0 * float((columns["penetration_m"] * np.cos(angle)[:, None]).max())
    rolls = _ROLL_STEP * (np.arange(_ROLLS) - _ROLLS // 2)
    radii = columns["rolling_radius_m"].mean(axis=1)
    c = np.stack([at(closure)[:, None] - at(distance)[:, None] * rolls,
                  *(np.broadcast_to(at(values)[:, None], (len(nodes), _ROLLS)) for values in (np.cos(angle), radii, distance))], axis=-1)
    field = np.zeros((len(nodes), _ROLLS, _LEVELS + 3, core.FIELDS))
    for level in range(_LEVELS + 3):
        normal = deepest * max((level - 1) / _LEVELS, 0.0) ** 2
        for k, values in enumerate(_fields(columns, angle, normal)):
            field[:, :, level, k] = at(values)[:, None]
    shape = [nodes[0], _STEP, len(nodes), rolls[0], _ROLL_STEP, _ROLLS, _LEVELS + 3, 1, deepest, radius, half_spacing]
    return core.Table.of_arrays(shape, [[nodes[0], _STEP, len(nodes)]], [c], [field], values=True)


def _fields(columns, angle, normal):
    """Stiffness, place, radius, angle to the axle, semi-axes over the root of the penetration, at a normal penetration (m); each (shifts,)."""
    penetration = columns["penetration_m"]
    values = (columns["normal_load_N"] / penetration**1.5, columns["lateral_distance_m"], columns["rolling_radius_m"],
              np.broadcast_to(angle[:, None], penetration.shape), columns["a_m"] / np.sqrt(penetration), columns["b_m"] / np.sqrt(penetration))
    return [np.array([np.interp(normal, p, v) for p, v in zip(penetration, value)]) for value in values]
