# SPDX-License-Identifier: BSD-3-Clause
"""A curving study as text and as plain data."""

from __future__ import annotations

import numpy as np

from railsym.cli_output import table as text_table


def table(found, row=None):
    """A line a curve; see `Curving.table`."""
    header = ["R, m", "V, km/h", "deficiency, mm", "Y lead, kN", "Q lead, kN", "Y/Q", "of", "sum Y, kN", "of", "attack lead, mrad",
              "T-gamma, N", "largest, N", "of"]
    if found.largest is not None:
        header += ["Y/Q 99.85 %", "sum Y 99.85 %, kN"]
    rows = []
    for j in range(len(found.speed)) if row is None else [row]:
        rows += [_line(found, j, k) for k in np.argsort(-found.radius)]
    return text_table(header, rows, left=(6, 8, 12))


def _line(found, j, k):
    start = [f"{found.radius[k]:.1f}".removesuffix(".0"), f"{3.6 * found.speed[j, k]:.1f}", f"{1e3 * found.cant_deficiency[j, k]:.1f}"]
    empty = 10 + (2 if found.largest is not None else 0)
    if np.isnan(found.Q[j, k]).all():
        return [*start, *["-"] * empty]
    lead, ratio, shift, wear = found.outer[0], _top(found.YQ[j, k]), _top(found.sum_Y[j, k]), _top(found.t_gamma[j, k])
    line = [*start, f"{1e-3 * found.Y[j, k, lead]:.2f}", f"{1e-3 * found.Q[j, k, lead]:.2f}", f"{found.YQ[j, k, ratio]:.3f}", _short(found.wheels[ratio]),
            f"{1e-3 * found.sum_Y[j, k, shift]:.2f}", _short(found.wheelsets[shift]), f"{1e3 * found.angle_of_attack[j, k, 0]:.2f}",
            f"{found.t_gamma[j, k].sum():.1f}", f"{found.t_gamma[j, k, wear]:.1f}", _short(found.wheels[wear])]
    if found.largest is not None:
        line += [_number(found.largest["YQ"][j, k], 1.0, 3), _number(found.largest["sum_Y"][j, k], 1e-3, 2)]
    return line


def _top(values):
    return int(np.nanargmax(np.abs(values)))


def _number(values, factor, digits):
    return "-" if np.isnan(values).all() else f"{factor * values[_top(values)]:.{digits}f}"


def _short(name):
    """"wheelset1.left" as "1 left"."""
    return name.removeprefix("wheelset").replace(".", " ").strip() or name


def message(found):
    """Heading, table, limits and failures."""
    name = f"{found.vehicle}, {found.configuration}" if found.configuration else found.vehicle
    lines = [f"{name}: curves to the {found.direction}, {_cants(found)}, {found.contact}, {found.law}", found.table(), ""]
    lines += [f"{item} ({where})" for item, where in found.assessed()]
    if found.failures:
        count = len(found.failures)
        lines += ["", f"{count} of {found.speed.size * (1 if found.largest is None else 2)} without result:"]
        lines += [f"  {failure}" for failure in found.failures]
    return "\n".join(lines)


def _cants(found):
    cants = sorted(set((1e3 * found.cant).round(6).tolist()))
    return f"cant {cants[0]:g} mm" if len(cants) == 1 else f"cant {cants[0]:g} to {cants[-1]:g} mm"


def as_data(found):
    """Plain data, SI units."""
    data = {name: getattr(found, name) for name in ("vehicle", "configuration", "direction", "contact", "law")}
    data |= {"wheelsets": list(found.wheelsets), "wheels": list(found.wheels), "units": found.units, "radius": _plain(found.radius),
             "cant": _plain(found.cant), "speed": _plain(found.speed), "cant_deficiency": _plain(found.cant_deficiency)}
    data["quasi_static"] = {name: _plain(values) for name, values in found.values.items()}
    if found.largest is not None:
        data["dynamic"] = {name: _plain(values) for name, values in found.largest.items()}
    data["limits"] = [{"quantity": item.name, "value": item.value, "unit": item.unit, "limit": item.limit.value, "trust": item.limit.trust,
                       "verdict": item.verdict, "where": where} for item, where in found.assessed()]
    data["failures"] = [{"analysis": f.analysis, "radius": f.radius, "speed": f.speed, "reason": f.reason} for f in found.failures]
    return data


def _plain(values):
    """Nested lists; None for NaN, the text "inf" for infinity."""
    if np.ndim(values) == 0:
        value = float(values)
        return None if np.isnan(value) else value if np.isfinite(value) else str(value)
    return [_plain(one) for one in values]
