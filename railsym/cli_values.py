# SPDX-License-Identifier: BSD-3-Clause
"""Values on the command line: speeds and lengths with their unit, ranges, criteria."""

from __future__ import annotations

import difflib
import math
import re

import numpy as np

from railsym.errors import RailsymError
from railsym.units import UnitError, to_si

_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_MOST_POINTS = 1000


class CommandError(RailsymError, ValueError):
    """Something on the command line that cannot be used."""


def quantity(text, unit, what):
    """A number with its unit, such as ``200km/h`` or ``3 mm``, in SI.

    Parameters
    ----------
    text : str
    unit : str
        SI unit of the wanted dimension.
    what : str
        Name of the value, for the error.

    Returns
    -------
    float

    Raises
    ------
    CommandError
        If there is no number or no unit, or the unit measures something else.
    """
    match = _QUANTITY.fullmatch(text)
    example = {"m/s": "200km/h or 55m/s", "m": "3mm or 0.003m"}.get(unit, f"1{unit}")
    if match is None:
        raise CommandError(f"{what} {text!r}: a number with its unit is needed, such as {example}")
    if not match[2]:
        raise CommandError(f"{what} {text!r} has no unit: write {example}")
    try:
        return to_si(float(match[1]), match[2], unit)
    except UnitError as error:
        raise CommandError(f"{what} {text!r}: {error}") from None


def number(text, what):
    """A finite number without unit.

    Raises
    ------
    CommandError
        If it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise CommandError(f"{what} {text!r}: a number is needed")
    return value


def numbers(text, what):
    """``0.2``, ``0.1,0.2,0.4`` or ``0.05:0.5:10`` (ten values from 0.05 to 0.5), ascending, as an array.

    Raises
    ------
    CommandError
        If it is none of these, or the values are not ascending.
    """
    form = f"{what} {text!r}: write one value (0.2), several (0.1,0.2,0.4) or first:last:count (0.05:0.5:10)"
    if ":" in text:
        parts = text.split(":")
        if len(parts) != 3 or not parts[2].strip().isdigit() or not 2 <= int(parts[2]) <= _MOST_POINTS:
            raise CommandError(f"{form}, with a count from 2 to {_MOST_POINTS}")
        values = np.linspace(number(parts[0], what), number(parts[1], what), int(parts[2]))
    else:
        values = np.array([number(part, what) for part in text.split(",")])
    if (np.diff(values) <= 0).any():
        raise CommandError(f"{form}, in ascending order")
    return values


def speed_range(text):
    """``20:700 km/h`` as a pair in m/s; each speed may have a unit of its own.

    Raises
    ------
    CommandError
        If it is not two ascending positive speeds.
    """
    low, colon, high = text.partition(":")
    if not colon:
        raise CommandError(f"speed range {text!r}: write lowest:highest with their unit, such as 20:700km/h")
    match = _QUANTITY.fullmatch(high)
    shared = match[2] if match else ""
    if re.fullmatch(r"\s*[-+.\deE]+\s*", low):
        low += shared
    speeds = quantity(low, "m/s", "lowest speed"), quantity(high, "m/s", "highest speed")
    if not 0.0 < speeds[0] < speeds[1]:
        raise CommandError(f"speed range {text!r}: two speeds above 0 in ascending order are needed")
    return speeds


def criterion(text):
    """``real_part`` or ``damping_ratio=0.05`` (also ``damping_ratio=5%``) as a damping ratio.

    Raises
    ------
    CommandError
        If it is neither, or the damping ratio is not from 0 to 1.
    """
    name, equals, value = text.partition("=")
    if name == "real_part" and not equals:
        return 0.0
    if name != "damping_ratio" or not equals:
        near = difflib.get_close_matches(name, ("real_part", "damping_ratio"), n=1, cutoff=0.5)
        hint = f" (nearest: {near[0]})" if near and near[0] != name else ""
        raise CommandError(f"criterion {text!r}: write real_part or damping_ratio=0.05{hint}")
    percent = value.endswith("%")
    ratio = number(value.rstrip("%"), "damping ratio") / (100.0 if percent else 1.0)
    if not 0.0 <= ratio < 1.0:
        raise CommandError(f"criterion {text!r}: a damping ratio from 0 up to, not including, 1 is needed; 5 % is 0.05")
    return ratio
