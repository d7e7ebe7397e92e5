# SPDX-License-Identifier: BSD-3-Clause
"""Units: conversion to SI, dimensions, and what is refused."""

import math

import numpy as np
import pytest

from railsym.errors import RailsymError
from railsym.units import SYMBOLS, UnitError, parse_unit, same_dimension, to_si


@pytest.mark.parametrize(
    "value, unit, expected, si",
    [
        (3, "t", "kg", 3000.0),
        (25, "mm", "m", 0.025),
        (180, "km/h", "m/s", 50.0),
        (2, "kN/mm", "N/m", 2e6),
        (5, "MN/m", "N/m", 5e6),
        (1.2, "kN*s/mm", "N*s/m", 1.2e6),
        (180, "deg", "rad", math.pi),
        (7, "kN*m/rad", "N*m/rad", 7000.0),
        (7, "t*m^2", "kg*m^2", 7000.0),
        (210, "GPa", "N/m^2", 2.1e11),
        (4, "kg*m/s^2", "N", 4.0),
        (6, "N*s*m^-1", "N*s/m", 6.0),
        (8, "N/mm/mm", "Pa", 8e6),
        (0.5, "1/m", "1/m", 0.5),
        (0.3, "-", "-", 0.3),
    ],
)
def test_converts_to_si(value, unit, expected, si):
    # One multiplication and one division: within two roundings.
    assert to_si(value, unit, expected) == pytest.approx(si, rel=4e-16)


def test_millimetres_give_the_nearest_double():
    for number in (3, 25, 460, 1435):
        assert to_si(number, "mm", "m") == number / 1000


def test_arrays_and_infinity_convert():
    np.testing.assert_array_equal(to_si(np.array([1.0, 2.0]), "kN", "N"), [1000.0, 2000.0])
    assert to_si(math.inf, "mm", "m") == math.inf


def test_quotients_are_read_from_left_to_right():
    assert same_dimension("N*m/rad*s", "N*m*s/rad")
    assert not same_dimension("N*m/rad/s", "N*m*s/rad")


@pytest.mark.parametrize(
    "unit, expected",
    [("N/m", "N*s/m"), ("N*m", "N*m/rad"), ("kg", "N"), ("deg", "-"), ("-", "rad"), ("m", "m/s"), ("kg*m", "kg*m^2")],
)
def test_a_wrong_dimension_names_what_is_allowed(unit, expected):
    with pytest.raises(UnitError) as caught:
        to_si(1.0, unit, expected)
    assert repr(unit) in str(caught.value)
    assert repr(expected) in str(caught.value)


@pytest.mark.parametrize("unit", ["", "N m", "N**s", "N*", "/s", "m^", "m^0", "m^1.5", "(N)", "N*(s/m)", "2*N"])
def test_a_badly_written_unit_is_refused(unit):
    with pytest.raises(UnitError):
        parse_unit(unit)


def test_an_unknown_symbol_names_the_nearest():
    with pytest.raises(UnitError, match="'kNN'.*nearest: 'kN'"):
        parse_unit("kNN/mm")
    with pytest.raises(UnitError, match="'newton'"):
        parse_unit("newton")


def test_letter_case_matters():
    with pytest.raises(UnitError):
        parse_unit("n/m")


def test_errors_are_value_errors_of_railsym():
    assert issubclass(UnitError, ValueError) and issubclass(UnitError, RailsymError)


def test_derived_symbols_agree_with_their_definition():
    for symbol, definition in {"N": "kg*m/s^2", "Pa": "N/m^2", "Hz": "1/s"}.items():
        assert SYMBOLS[symbol].dimension == parse_unit(definition).dimension
