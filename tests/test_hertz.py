# SPDX-License-Identifier: BSD-3-Clause
"""Hertz contact against an independent table, the sphere and power laws of the load."""

from math import cos, radians

import numpy as np
import pytest

from railsym.errors import ContactError
from railsym.hertz import axis_ratio, contact_modulus, hertz

# theta in degrees, m (larger semi-axis), n (smaller), r (approach), from complete elliptic integrals K and E
# (a computation apart from this package), in the classical form with cos(theta) = |B - A|/(A + B):
# a = m q, b = n q, q = (3 N/(4 E' (A + B)))^(1/3);  approach = r ((3 N/(4 E'))^2 (A + B))^(1/3).
HERTZ_TABLE = [
    (1.0, 36.931940, 0.131295, 0.121107), (2.0, 22.243170, 0.169191, 0.179314),
    (5.0, 11.238062, 0.238136, 0.296894), (10.0, 6.611455, 0.310983, 0.428013),
    (20.0, 3.816011, 0.412150, 0.603842), (45.0, 1.926462, 0.603828, 0.854714),
    (70.0, 1.285071, 0.799904, 0.972640), (85.0, 1.060871, 0.944220, 0.998307), (90.0, 1.0, 1.0, 1.0)]
STEEL = contact_modulus(2.1e11, 0.28)
LOAD = 66e3  # N


@pytest.mark.parametrize("along", (True, False), ids=("long along x", "long along y"))
@pytest.mark.parametrize("theta, m, n, r", HERTZ_TABLE)
def test_classical_coefficients(theta, m, n, r, along):
    total = 3.0  # A + B, 1/m
    flat, sharp = (0.5 * total * (1.0 - cos(radians(theta))), 0.5 * total * (1.0 + cos(radians(theta))))
    x, y = (flat, sharp) if along else (sharp, flat)
    contact = hertz(LOAD, 2.0 * x, 2.0 * y, STEEL)
    q = (3.0 * LOAD / (4.0 * STEEL * total)) ** (1.0 / 3.0)
    large, small = (contact.a, contact.b) if along else (contact.b, contact.a)
    # The table has 6 decimals: 0.5e-6/0.13 = 4e-6 relative at worst.
    assert large / q == pytest.approx(m, rel=5e-6)
    assert small / q == pytest.approx(n, rel=5e-6)
    scale = ((3.0 * LOAD / (4.0 * STEEL)) ** 2 * total) ** (1.0 / 3.0)
    assert contact.approach / scale == pytest.approx(r, rel=5e-6)


def test_circle_is_the_sphere_on_a_plane():
    radius = 0.4
    contact = hertz(LOAD, 1.0 / radius, 1.0 / radius, STEEL)
    a = (3.0 * LOAD * radius / (4.0 * STEEL)) ** (1.0 / 3.0)
    # Closed forms; only rounding separates them.
    assert contact.a == pytest.approx(a, rel=1e-12)
    assert contact.b == pytest.approx(a, rel=1e-12)
    assert contact.approach == pytest.approx(a**2 / radius, rel=1e-12)
    assert contact.normal_stiffness == pytest.approx(2.0 * STEEL * a, rel=1e-12)


@pytest.mark.parametrize("ratio", (0.02, 0.1, 0.999999, 1.0, 1.000001, 7.0, 50.0))
def test_axis_ratio_inverts_the_integrals_of_the_ellipse(ratio):
    from scipy.special import ellipe, ellipk

    g = max(ratio, 1.0 / ratio)
    m = 1.0 - 1.0 / g**2
    # Johnson 1985 (4.26): B/A = ((a/b)^2 E - K)/(K - E), long axis along A; cancels near the circle.
    curvatures = (g**2 * ellipe(m) - ellipk(m)) / (ellipk(m) - ellipe(m)) if g > 1.0 else 1.0
    tolerance = 1e-9 if abs(ratio - 1.0) < 1e-3 else 1e-12
    found = axis_ratio(curvatures if ratio >= 1.0 else 1.0 / curvatures)
    assert found == pytest.approx(ratio, rel=tolerance)


def test_arrays_agree_with_single_calls_and_stiffness_is_the_derivative():
    loads = np.array([1e3, 66e3, 2e5])
    x, y = np.array([1 / 0.46, 1 / 0.3, 1 / 50.0]), np.array([1 / 0.3, 1 / 0.46, 10.0])
    together = hertz(loads, x, y, STEEL)
    for i in range(3):
        for many, one in zip(together, hertz(loads[i], x[i], y[i], STEEL)):
            assert many[i] == pytest.approx(one, rel=1e-13)
    step = 1e-4
    approach = hertz(np.outer([1 - step, 1 + step], loads), x, y, STEEL).approach
    slope = 2 * step * loads / (approach[1] - approach[0])
    assert together.normal_stiffness == pytest.approx(slope, rel=1e-7)  # central difference: step^2


def test_a_soft_body_on_a_hard_one():
    assert contact_modulus(2.1e11, 0.28) == pytest.approx(2.1e11 / (2 * (1 - 0.28**2)), rel=1e-15)
    mixed = contact_modulus(2.1e11, 0.28, 7e10, 0.33)
    assert mixed == pytest.approx(1 / ((1 - 0.28**2) / 2.1e11 + (1 - 0.33**2) / 7e10), rel=1e-15)
    assert contact_modulus(7e10, 0.33, 2.1e11, 0.28) == pytest.approx(mixed, rel=1e-15)


@pytest.mark.parametrize("arguments, words", [
    ((0.0, 2.0, 3.0, STEEL), "normal load is 0.0 N"),
    (([1e3, -5.0], 2.0, 3.0, STEEL), "normal load at index 1 is -5.0 N"),
    ((float("nan"), 2.0, 3.0, STEEL), "normal load is nan"),
    ((1e3, 2.0, 0.0, STEEL), "lateral sum of curvatures is 0.0 1/m.*convex"),
    ((1e3, -2.0, 3.0, STEEL), "longitudinal sum of curvatures"),
    ((1e3, 2.0, 3.0, 0.0), "contact modulus"),
])
def test_errors_name_the_value_and_the_unit(arguments, words):
    with pytest.raises(ContactError, match=words):
        hertz(*arguments)


def test_material_errors():
    with pytest.raises(ContactError, match="Poisson's ratio is 0.6"):
        contact_modulus(2.1e11, 0.6)
    with pytest.raises(ContactError, match="Young's modulus is -1.0 N/m"):
        contact_modulus(2.1e11, 0.28, -1.0)
