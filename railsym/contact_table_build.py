# SPDX-License-Identifier: BSD-3-Clause
"""Building the contact table of a pair of profiles: surfaces sampled, the wheel cut into zones, the range found; the rest is in C."""

from __future__ import annotations

import numpy as np

from railsym import _core_contact as core
from railsym.contact_table import ContactTable, WheelTable
from railsym.errors import ContactError
from railsym.hertz import contact_modulus

_RAIL_STEP = 1e-4            # m of arc
_WHEEL_STEP = 2e-5           # m along the axle
_PATH_STEP = 5e-5            # m of shift, of the rigid contact that is searched for jumps
_JUMP = 0.1                  # rad: a jump of the contact angle that parts two zones, far more than the wheelset rolls
_SHIFT_STEP = 2e-4           # m between the nodes of the tread
_ROLL_STEP, _ROLL = 2.5e-3, 10e-3   # rad
_LEVELS, _USUAL = 11, 3e-4   # of sqrt(penetration) down to a penetration (m); deeper tables have more, equally far apart: with 6, place and
                             # slopes of a patch that grows over a change of curvature err by 3 %, and critical speeds too
_MOST_FAILURES = 0.01        # of the nodes: at edges of a profile, where the table then ends
_FINE = (1, 4, 2)            # parts of a step of the shift: contact moves fastest through the flange root


def build(pair, young_modulus, poisson_ratio, deepest, reach):
    """`ContactTable` of a pair; see `ContactPair.table`.

    Raises
    ------
    ContactError
        For material constants or ranges that make no sense, or contact that could not be computed.
    """
    for name, value, (low, high) in (("young_modulus", young_modulus, (1e6, 1e13)), ("poisson_ratio", poisson_ratio, (0.0, 0.5)),
                                     ("deepest", deepest, (1e-5, 2e-3)), ("reach", reach, (1e-3, 0.05))):
        if not (np.isfinite(value) and low <= value <= high):
            raise ContactError(f"{name} is {value}; it must be from {low:g} to {high:g} (SI)")
    modulus = contact_modulus(young_modulus, poisson_ratio)
    left, right = pair.sides
    tables = {"right": _side_table(right, modulus, deepest, reach)}
    tables["left"] = tables["right"] if pair.symmetric else _side_table(left, modulus, deepest, reach)
    about = f"{pair.wheel.name} on {pair.rail.name}, gauge {1e3 * pair.track_gauge:.1f} mm"
    failures = {side: table.failures for side, table in tables.items() if table.failures}
    message = "; ".join(f"{side} wheel: the table ends at {count} nodes where the patch could not be computed (an edge of a profile)"
                        for side, count in failures.items())
    return ContactTable(WheelTable("left", tables["left"]), WheelTable("right", tables["right"]), pair.tape_circle_spacing, pair.wheel_radius,
                        pair.wheel_radius_left, about, message)


def surfaces(side):
    """`railsym._core_contact.Surfaces` of a `railsym.contact_geometry.Side`."""
    from scipy.interpolate import CubicHermiteSpline

    rail, wheel = side.rail, side.wheel
    height, angle = rail.z(rail.y), np.arctan(rail.slope(rail.y))
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(rail.y), np.diff(height)))])
    at = np.linspace(0.0, arc[-1], int(arc[-1] / _RAIL_STEP) + 1)
    turned = np.interp(at, arc, angle)
    y, z = (CubicHermiteSpline(arc, value, slope)(at) for value, slope in ((rail.y, np.cos(angle)), (height, np.sin(angle))))
    across = np.arange(wheel.y[0], wheel.y[-1], _WHEEL_STEP)
    return core.Surfaces((at[1], y, z, np.cos(turned), np.sin(turned)), (across[0], _WHEEL_STEP, wheel.z(across), wheel.slope(across)),
                         side.radius, side.tape_circle)


def _side_table(side, modulus, deepest, reach):
    made_of = surfaces(side)
    shift, across, angle = _path(side, made_of, reach)
    cuts = [np.inf, *_cuts(across, angle), -np.inf]
    half = int(round(min(-shift[0], shift[-1]) / _SHIFT_STEP)) - 1       # both directions: a left wheel meets what a right one leaves
    rolls, levels = int(round(_ROLL / _ROLL_STEP)), max(_LEVELS, int(np.ceil(_LEVELS * np.sqrt(deepest / _USUAL))))
    shape = [-(half + 1) * _SHIFT_STEP, _SHIFT_STEP, 2 * half + 3, -(rolls + 1) * _ROLL_STEP, _ROLL_STEP, 2 * rolls + 3, levels + 3,
             len(cuts) - 1, deepest, side.radius, side.tape_circle]
    table = core.Table.built(made_of, shape, cuts, _FINE[:len(cuts) - 1], modulus)
    nodes = table.axes[:, 2].sum() * table.value("rolls")
    if table.failures > _MOST_FAILURES * nodes:
        raise ContactError(f"{side.name} wheel: elastic contact could not be computed at {table.failures} of {nodes:.0f} nodes of the table; the profiles may "
                           "be too rough: read them with smoothing (load_profile(..., smoothing=20e-6))")
    return table


def _path(side, made_of, reach):
    """Rigid contact without roll as far as the wheel is on the rail: shift, place on the wheel, contact angle."""
    count = int(round(reach / _PATH_STEP))
    shift = _PATH_STEP * np.arange(-count, count + 1)
    _, across, slope, inside = made_of.rigid_contact(shift, 0.0)
    middle = count
    if not inside[middle]:
        raise ContactError(f"{side.name} wheel: it does not touch the rail in the central position; check gauge, flange_back_distance and profiles")
    first, last = middle, middle
    while first > 0 and inside[first - 1]:
        first -= 1
    while last < len(shift) - 1 and inside[last + 1]:
        last += 1
    if min(-shift[first], shift[last]) < 1e-3:
        raise ContactError(f"{side.name} wheel: it is on the rail only from {1e3 * shift[first]:.2f} to {1e3 * shift[last]:.2f} mm; a table needs 1 mm at least")
    on = slice(first, last + 1)
    return shift[on], across[on], -np.arctan(slope[on])


def _cuts(across, angle):
    """Places on the wheel, from the field side to the flange, where zones part: in the widest jumps of the rigid contact."""
    size = np.abs(np.diff(angle))
    jumps = np.flatnonzero((size > _JUMP) & (np.abs(np.diff(across)) > 1e-3))
    chosen = np.sort(jumps[np.argsort(-size[jumps])[:core.ZONES - 1]])
    return sorted((0.5 * (across[k] + across[k + 1]) for k in chosen), reverse=True)
