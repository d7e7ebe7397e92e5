# SPDX-License-Identifier: BSD-3-Clause
"""Units of a vehicle file: a small strict table, converted to SI with their dimensions checked.

A unit is a product or quotient of the symbols in `SYMBOLS`, each with an optional integer power: ``"N*s/m"``, ``"kN/mm"``,
``"kg*m^2"``, ``"km/h"``; ``"-"`` stands for a pure number. Products and quotients are read from left to right. The angle is a
dimension of its own, so a rotational stiffness is in N*m/rad and not in N*m.
"""

import difflib
import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from railsym.errors import RailsymError


class UnitError(RailsymError, ValueError):
    """A unit that is not in the table, is badly written, or has the wrong dimension."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as its factor to SI and its dimension.

    Attributes
    ----------
    factor : Fraction
        Value in SI units of one of this unit (pi enters rounded to double precision).
    dimension : tuple of int
        Exponents of mass, length, time and angle.
    """

    factor: Fraction
    dimension: tuple[int, int, int, int]


_MASS, _LENGTH, _TIME, _ANGLE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
_FORCE, _STRESS, _NUMBER = (1, 1, -2, 0), (1, -1, -2, 0), (0, 0, 0, 0)

SYMBOLS = {
    "kg": Unit(Fraction(1), _MASS),
    "t": Unit(Fraction(1000), _MASS),
    "g": Unit(Fraction(1, 1000), _MASS),
    "m": Unit(Fraction(1), _LENGTH),
    "mm": Unit(Fraction(1, 1000), _LENGTH),
    "cm": Unit(Fraction(1, 100), _LENGTH),
    "km": Unit(Fraction(1000), _LENGTH),
    "s": Unit(Fraction(1), _TIME),
    "ms": Unit(Fraction(1, 1000), _TIME),
    "min": Unit(Fraction(60), _TIME),
    "h": Unit(Fraction(3600), _TIME),
    "Hz": Unit(Fraction(1), (0, 0, -1, 0)),
    "N": Unit(Fraction(1), _FORCE),
    "kN": Unit(Fraction(1000), _FORCE),
    "MN": Unit(Fraction(10**6), _FORCE),
    "Pa": Unit(Fraction(1), _STRESS),
    "MPa": Unit(Fraction(10**6), _STRESS),
    "GPa": Unit(Fraction(10**9), _STRESS),
    "rad": Unit(Fraction(1), _ANGLE),
    "deg": Unit(Fraction(math.pi) / 180, _ANGLE),
    "1": Unit(Fraction(1), _NUMBER),
}

_FACTOR = re.compile(r"([A-Za-z]+|1)(?:\^(-?[1-9]))?")


@lru_cache(maxsize=None)
def parse_unit(text):
    """Read a unit.

    Parameters
    ----------
    text : str
        For example ``"kN*s/m"``; ``"-"`` is the pure number.

    Returns
    -------
    Unit

    Raises
    ------
    UnitError
        If the text is empty or badly written, or names a symbol that is not in `SYMBOLS`.
    """
    if text == "-":
        return Unit(Fraction(1), _NUMBER)
    parts = re.split(r"([*/])", text.replace(" ", ""))
    factor, dimension, sign = Fraction(1), _NUMBER, 1
    for part in parts:
        if part in ("*", "/"):
            sign = 1 if part == "*" else -1
            continue
        symbol, power = _read_factor(part, text)
        power *= sign
        factor *= symbol.factor**power
        dimension = tuple(d + power * e for d, e in zip(dimension, symbol.dimension))
    return Unit(factor, dimension)


def _read_factor(part, text):
    """Symbol and power of one factor such as ``"m^2"``."""
    match = _FACTOR.fullmatch(part)
    if match is None:
        raise UnitError(
            f"unit {text!r} cannot be read at {part!r}: write products, quotients and whole powers of symbols, "
            'such as "N*s/m" or "kg*m^2", and "-" for a pure number'
        )
    if match[1] not in SYMBOLS:
        near = difflib.get_close_matches(match[1], SYMBOLS, n=1, cutoff=0.5)
        hint = f" (nearest: {near[0]!r})" if near else ""
        raise UnitError(
            f"unit {text!r} holds {match[1]!r}, which is not one of {', '.join(s for s in SYMBOLS if s != '1')}{hint}"
        )
    return SYMBOLS[match[1]], int(match[2] or 1)


def same_dimension(first, second):
    """True when the two units (text) measure the same kind of quantity.

    Raises
    ------
    UnitError
        If one of them cannot be read.
    """
    return parse_unit(first).dimension == parse_unit(second).dimension


def examples(unit):
    """A few ways to write the dimension of `unit` (text), the SI one first."""
    return _EXAMPLES.get(unit, (unit,))


_EXAMPLES = {
    "-": ("-",),
    "kg": ("kg", "t"),
    "m": ("m", "mm"),
    "m/s": ("m/s", "mm/s", "km/h"),
    "m/s^2": ("m/s^2",),
    "N": ("N", "kN"),
    "Pa": ("Pa", "GPa", "N/m^2"),
    "rad": ("rad", "deg"),
    "N/m": ("N/m", "kN/mm", "MN/m"),
    "N*s/m": ("N*s/m", "kN*s/m"),
    "N*m/rad": ("N*m/rad", "kN*m/rad"),
    "N*m*s/rad": ("N*m*s/rad", "kN*m*s/rad"),
    "kg*m^2": ("kg*m^2", "t*m^2"),
}


def to_si(value, unit, expected):
    """Convert a value to SI, checking the dimension.

    Parameters
    ----------
    value : float or ndarray
    unit : str
        The unit the value is given in.
    expected : str
        An SI unit of the wanted dimension, such as ``"N*s/m"``.

    Returns
    -------
    float or ndarray
        The value in `expected`.

    Raises
    ------
    UnitError
        If `unit` cannot be read or measures another kind of quantity.
    """
    given = parse_unit(unit)
    if given.dimension != parse_unit(expected).dimension:
        allowed = ", ".join(repr(name) for name in examples(expected))
        raise UnitError(f"unit {unit!r} has the wrong dimension: allowed are {allowed} and others of the same dimension")
    # Numerator and denominator apart: 25 mm is then the double nearest to 0.025.
    return value * float(given.factor.numerator) / float(given.factor.denominator)
