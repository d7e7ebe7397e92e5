# SPDX-License-Identifier: BSD-3-Clause
"""Factors in a study file: ``{ uniform = [[4, 6], "MN/m"] }``, ``{ grid = [[0.05, 0.4], "-"], points = 8 }`` and so on.

A number is written with its unit, as in vehicle files; "%" is of the vehicle's own value.
"""

from __future__ import annotations

import numpy as np

from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.factors import PERCENT, Grid, List, LogNormal, Normal, Triangular, Uniform
from railsym.units import UnitError, parse_unit
from railsym.vehicle_parts import Quantity

# the numbers in brackets, and the keys beside them
_FORMS = {"grid": (Grid, ("low", "high"), ("points", "spacing")), "values": (List, (), ()), "uniform": (Uniform, ("low", "high"), ()),
          "triangular": (Triangular, ("low", "mode", "high"), ()), "normal": (Normal, ("mean", "std"), ("low", "high")),
          "lognormal": (LogNormal, ("median",), ("sigma", "low", "high"))}
_EXAMPLES = {"grid": '{ grid = [[0.05, 0.4], "-"], points = 8 }', "values": '{ values = [[4, 5, 6], "MN/m"] }',
             "uniform": '{ uniform = [[90, 110], "%"] }', "triangular": '{ triangular = [[4, 5, 6], "MN/m"] }',
             "normal": '{ normal = [[5, 0.2], "MN/m"], low = 4.5, high = 5.5 }', "lognormal": '{ lognormal = [[5], "MN/m"], sigma = 0.1 }'}


def factor_from_table(name, table):
    """A factor from its table.

    Raises
    ------
    SweepError
    """
    kinds = [kind for kind in _FORMS if isinstance(table, dict) and kind in table]
    if len(kinds) != 1:
        shown = unknown(next(iter(table), ""), _FORMS, "kinds") if isinstance(table, dict) and not kinds else "not clear"
        raise SweepError(f"factor {name!r}: its kind is {shown}; write for example {_EXAMPLES['uniform']}")
    kind, = kinds
    made, inside, beside = _FORMS[kind]
    for key in table:
        if key != kind and key not in beside:
            raise SweepError(f"factor {name!r}: {key} is {unknown(key, (kind, *beside), 'keys')}")
    entry = table[kind]
    if made is List and isinstance(entry, list) and entry and all(isinstance(v, str) for v in entry):
        return List(entry)
    numbers, unit = _numbers(name, kind, entry, None if made is List else len(inside))
    extra = {key: value for key, value in table.items() if key != kind}
    try:
        return List(numbers, unit) if made is List else made(*numbers, unit=unit, **extra)
    except TypeError as error:
        raise SweepError(f"factor {name!r}: {error}; write for example {_EXAMPLES[kind]}") from None
    except SweepError as error:
        raise SweepError(f"factor {name!r}: {error}") from None


def _numbers(name, kind, entry, count):
    good = isinstance(entry, list) and len(entry) == 2 and isinstance(entry[0], list) and isinstance(entry[1], str)
    if not good or not all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in entry[0]) or count not in (None, len(entry[0])):
        raise SweepError(f"factor {name!r}: {kind} = {entry!r} cannot be read; write numbers and their unit, for example {_EXAMPLES[kind]}")
    unit = entry[1]
    try:
        if unit != PERCENT:
            parse_unit(unit)
    except UnitError as error:
        raise SweepError(f"factor {name!r}: {error}") from None
    return [float(v) for v in entry[0]], unit


def factor_to_table(factor):
    """A factor as plain data."""
    made, inside, beside = _FORMS[factor.kind]
    if factor.labels():
        return {"values": list(factor.labels())}
    numbers = list(factor.values) if made is List else [float(getattr(factor, key)) for key in inside]
    extra = {key: getattr(factor, key) for key in beside if getattr(factor, key) is not None}
    extra = {key: value.item() if isinstance(value, np.generic) else value for key, value in extra.items()}
    return {factor.kind: [numbers, factor.unit]} | extra


def set_to_table(study, name):
    """What a study sets, as plain data."""
    value = study.set[name]
    if isinstance(value, str):
        return value
    unit = study.inputs[name].unit if name in study.inputs else study.base().parameters[name].unit
    return [value.tolist() if isinstance(value, np.ndarray) else float(value), unit]


def set_from_table(table):
    """Fixed parameters of a study: ``"anti_yaw_damper.damping" = [600, "kN*s/m"]``, or a text."""
    if not isinstance(table, dict):
        raise SweepError('[set] must be a table: "car.mass" = [38, "t"]')
    found = {}
    for name, entry in table.items():
        if isinstance(entry, list) and len(entry) == 2 and isinstance(entry[1], str):
            found[name] = Quantity(entry[0], entry[1], "set by the study")
        elif isinstance(entry, str):
            found[name] = entry
        else:
            raise SweepError(f'[set] {name!r} = {entry!r}: a number is written [value, "unit"], a curve by its name')
    return found
