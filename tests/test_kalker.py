# SPDX-License-Identifier: BSD-3-Clause
"""Kalker's coefficients: the printed table, its asymptotes, smoothness and errors."""

from math import pi

import numpy as np
import pytest

from railsym.errors import ContactError
from railsym.kalker import kalker_coefficients, table

# Kalker 1990, table E.3: (nu, a/b): C11, C22, C23, C33.  Typed here apart from the shipped file.
PRINTED = {
    (0.25, 0.1): (3.31, 2.52, 0.473, 8.28),
    (0.25, 1.0): (4.12, 3.67, 1.47, 1.19),
    (0.25, 10.0): (11.7, 12.8, 14.6, 0.526),
    (0.0, 0.5): (2.88, 2.88, 0.827, 1.74),
    (0.5, 2.0): (6.11, 5.56, 2.96, 0.65),
}


@pytest.mark.parametrize("point, printed", PRINTED.items())
def test_printed_values(point, printed):
    nu, ratio = point
    assert kalker_coefficients(ratio, nu) == pytest.approx(printed, rel=1e-12)


def test_every_table_point_is_reproduced():
    rows = table()
    assert rows.shape == (57, 6)
    for nu in (0.0, 0.25, 0.5):
        part = rows[rows[:, 0] == nu]
        # Interpolation passes through its points; rounding of exp(log) only.
        assert np.array(kalker_coefficients(part[:, 1], nu)).T == pytest.approx(part[:, 2:], rel=1e-12)


def test_the_table_is_plausible():
    rows = table().reshape(3, 19, 6)
    assert np.all(np.diff(rows[:, :, 1], axis=1) > 0)
    assert np.all(np.diff(rows[:, :, 3:5], axis=1) > 0)  # C22, C23 grow with a/b
    assert np.all(np.diff(rows[:, :, 5], axis=1) < 0)  # C33 falls
    # Shear modulus alone decides for nu = 0: C11(a/b) = C22(a/b).
    assert rows[0, :, 2] == pytest.approx(rows[0, :, 3], abs=1e-12)


@pytest.mark.parametrize("nu", (0.0, 0.25, 0.28, 0.3, 0.5))
def test_limits_of_slender_ellipses(nu):
    g = 1e-7
    across = kalker_coefficients(g, nu)
    # The correction that joins the table fades as g/0.1, below 1e-6 here.  C11, C22 and C33 of strip theory
    # (Carter: 2-D rolling of each strip); C33 = int y^2 over the same strips.
    assert across.c11 == pytest.approx(pi**2 / (4 * (1 - nu)), rel=1e-6)
    assert across.c22 == pytest.approx(pi**2 / 4, rel=1e-6)
    assert across.c33 == pytest.approx(pi**2 / (16 * (1 - nu) * g), rel=1e-6)
    along = kalker_coefficients(1 / g, nu)
    log_term = np.log(16 / g**2)
    assert along.c11 == pytest.approx(2 * pi / ((log_term - 2 * nu) * g) * (
        1 + (3 - np.log(4)) / (log_term - 2 * nu)), rel=1e-6)
    assert along.c23 == pytest.approx(2 * pi / (3 * g**1.5) / ((1 - nu) * log_term - 2 + 4 * nu), rel=1e-6)


@pytest.mark.parametrize("nu", (0.0, 0.25, 0.28, 0.5))
@pytest.mark.parametrize("end", (0.1, 10.0))
def test_asymptotes_join_the_table(nu, end):
    below, above = (np.array(kalker_coefficients(end * (1 + s * 1e-9), nu)) for s in (-1, 1))
    assert above == pytest.approx(below, rel=1e-7)  # 2e-9 times a logarithmic slope below 2
    # No jump of slope that shows: values at end^0.9 and end^1.1 are near a power law through the end.  C33 has
    # the coarsest asymptote (8 % off at a/b = 10, nu = 0.28, against 5 % at most for the others).
    inner, outer = (np.array(kalker_coefficients(end**s, nu)) for s in (0.9, 1.1))
    curvature = inner * outer / np.array(kalker_coefficients(end, nu)) ** 2
    assert curvature[:3] == pytest.approx(np.ones(3), abs=0.03)
    assert curvature[3] == pytest.approx(1.0, abs=0.08)


def test_smooth_and_monotonic_inside():
    ratio = np.geomspace(0.1, 10.0, 2001)
    for nu in (0.25, 0.28, 0.3):
        values = kalker_coefficients(ratio, nu)
        for name in ("c11", "c22", "c23"):
            assert np.all(np.diff(getattr(values, name)) > 0), name
        assert np.all(np.diff(values.c33) < 0)


def test_steel_lies_between_its_neighbours_and_poisson_parabola_is_exact_on_the_reciprocal():
    nodes = [1 / np.array(kalker_coefficients(1.3, nu)) for nu in (0.0, 0.25, 0.5)]
    steel = 1 / np.array(kalker_coefficients(1.3, 0.28))
    # Lagrange weights at nu = 0.28 over 0, 1/4, 1/2; the spline acts on logarithms, so the order of the two
    # interpolations shows at 1e-4.
    expected = -0.0528 * nodes[0] + 0.9856 * nodes[1] + 0.0672 * nodes[2]
    assert steel == pytest.approx(expected, rel=3e-4)


def test_scalar_and_array_shapes():
    assert kalker_coefficients(0.01, 0.3).c11.shape == ()
    assert kalker_coefficients(np.ones((2, 3)), 0.3).c33.shape == (2, 3)
    mixed = kalker_coefficients(np.array([[0.01, 1.0], [1.0, 40.0]]), 0.3)
    assert mixed.c22[1, 1] == kalker_coefficients(40.0, 0.3).c22
    assert mixed.c22[0, 0] == kalker_coefficients(0.01, 0.3).c22


@pytest.mark.parametrize("ratio, nu, words", [
    (0.0, 0.3, "a/b must be positive"), (float("nan"), 0.3, "a/b must be positive"),
    (float("inf"), 0.3, "a/b must be positive"), (1.0, 0.51, "Poisson's ratio"), (1.0, float("nan"), "Poisson")])
def test_errors(ratio, nu, words):
    with pytest.raises(ContactError, match=words):
        kalker_coefficients(ratio, nu)
