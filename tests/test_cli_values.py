# SPDX-License-Identifier: BSD-3-Clause
"""Values on the command line: units, ranges, criteria, and the text of what is refused."""

import numpy as np
import pytest

from railsym.cli_modes import speeds
from railsym.cli_values import CommandError, criterion, number, numbers, quantity, speed_range


@pytest.mark.parametrize("text, unit, value", [
    ("200km/h", "m/s", 200 / 3.6), ("200 km/h", "m/s", 200 / 3.6), ("55m/s", "m/s", 55.0), (".5e2 m/s", "m/s", 50.0),
    ("3mm", "m", 0.003), ("0.003m", "m", 0.003), ("-1 mm", "m", -0.001)])
def test_quantity(text, unit, value):
    assert quantity(text, unit, "value") == pytest.approx(value, rel=1e-15)      # one rounding of a quotient


@pytest.mark.parametrize("text, unit, words", [
    ("200", "m/s", ["speed '200' has no unit", "200km/h"]), ("fast", "m/s", ["a number with its unit"]),
    ("200kmh", "m/s", ["'kmh'", "km"]), ("3kg", "m", ["wrong dimension", "'mm'"]), ("m", "m", ["needed"])])
def test_quantity_refused(text, unit, words):
    with pytest.raises(CommandError) as caught:
        quantity(text, unit, "speed")
    assert all(word in str(caught.value) for word in words)


def test_numbers_of_three_forms():
    assert numbers("0.2", "conicity").tolist() == [0.2]
    assert numbers("0.1,0.2, 0.4", "conicity").tolist() == [0.1, 0.2, 0.4]
    np.testing.assert_array_equal(numbers("0.05:0.5:10", "conicity"), np.linspace(0.05, 0.5, 10))


@pytest.mark.parametrize("text", ["0.1:0.2", "0.1:0.2:1", "0.1:0.2:x", "0.3,0.1", "0.1,0.1", "0.2:0.1:3", "a", "nan", "inf", ""])
def test_numbers_refused(text):
    with pytest.raises(CommandError, match="conicity"):
        numbers(text, "conicity")


def test_number_refuses_what_is_not_finite():
    with pytest.raises(CommandError, match="a number is needed"):
        number("inf", "damping ratio")


@pytest.mark.parametrize("text", ["20:700km/h", "20:700 km/h", "20km/h:700km/h"])
def test_speed_range(text):
    assert speed_range(text) == pytest.approx((20 / 3.6, 700 / 3.6), rel=1e-15)


def test_speed_range_of_two_units():
    assert speed_range("5m/s:360km/h") == pytest.approx((5.0, 100.0), rel=1e-15)


@pytest.mark.parametrize("text", ["20", "20:700", "700:20km/h", "0:100km/h", "a:b", "20:"])
def test_speed_range_refused(text):
    with pytest.raises(CommandError, match="speed"):
        speed_range(text)


def test_criterion():
    assert [criterion(text) for text in ("real_part", "damping_ratio=0.05", "damping_ratio=5%")] == [0.0, 0.05, 0.05]


@pytest.mark.parametrize("text, words", [
    ("damping_ration=0.05", "nearest: damping_ratio"), ("real_prt", "nearest: real_part"), ("damping_ratio", "write"),
    ("damping_ratio=5", "5 % is 0.05"), ("real_part=0", "write")])
def test_criterion_refused(text, words):
    with pytest.raises(CommandError, match=words):
        criterion(text)


def test_speeds_of_modes():
    np.testing.assert_allclose(speeds("200 km/h"), [200 / 3.6], rtol=1e-15)
    np.testing.assert_allclose(speeds("50:300:6 km/h") * 3.6, [50, 100, 150, 200, 250, 300], rtol=1e-14)
    with pytest.raises(CommandError, match="above 0"):
        speeds("0km/h")
