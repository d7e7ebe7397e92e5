# SPDX-License-Identifier: BSD-3-Clause
"""Hertz contact of two smooth bodies: contact ellipse, approach and normal stiffness.

Hertz's integrals are used in their symmetric (Carlson) form, which has no
cancellation at the circle and needs no swapping of axes.  With A, B half the
sums of the two bodies' curvatures along x and y, and E' the contact modulus,

    A     = N/(2 pi E') R_D(0, b^2, a^2)                                  (1)
    B     = N/(2 pi E') R_D(0, a^2, b^2)                                  (2)
    delta = 3 N/(2 pi E') R_F(0, a^2, b^2)                                (3)

These are equations (4.26a-c) of K.L. Johnson, Contact Mechanics, Cambridge
1985, with K and E rewritten by DLMF 19.25.1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from railsym.errors import ContactError, ConvergenceError

_TOLERANCE = 1e-13  # on log(B/A), where rounding of R_D is about 1e-15
_MAX_ITERATIONS = 30


class HertzContact(NamedTuple):
    """Contact ellipse and normal compliance; arrays of one common shape.

    Attributes
    ----------
    a, b : ndarray
        Semi-axes along x (rolling direction) and y (lateral), m.
    approach : ndarray
        Approach of the two bodies, m.
    normal_stiffness : ndarray
        dN/d(approach) at the given load, N/m.
    """

    a: np.ndarray
    b: np.ndarray
    approach: np.ndarray
    normal_stiffness: np.ndarray


def contact_modulus(young_modulus, poisson_ratio, young_modulus_2=None, poisson_ratio_2=None):
    """Contact modulus E' of two elastic bodies.

    ``1/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2`` (Johnson 1985, section 4.2).

    Parameters
    ----------
    young_modulus, young_modulus_2 : float or ndarray
        Young's moduli of the first and second body, N/m^2; the second is that
        of the first unless given.
    poisson_ratio, poisson_ratio_2 : float or ndarray
        Poisson's ratios, 0 to 0.5.

    Returns
    -------
    float or ndarray
        Contact modulus, N/m^2.

    Raises
    ------
    ContactError
        For a modulus that is not positive or a Poisson's ratio outside 0..0.5.
    """
    second_modulus = young_modulus if young_modulus_2 is None else young_modulus_2
    second_ratio = poisson_ratio if poisson_ratio_2 is None else poisson_ratio_2
    for modulus in (young_modulus, second_modulus):
        _require(modulus, lambda v: (v > 0) & np.isfinite(v), "Young's modulus", "N/m^2", "positive and finite")
    for ratio in (poisson_ratio, second_ratio):
        _require(ratio, lambda v: (v >= 0) & (v <= 0.5), "Poisson's ratio", "-", "between 0 and 0.5")
    first, second = np.square(poisson_ratio), np.square(second_ratio)
    return 1.0 / ((1.0 - first) / young_modulus + (1.0 - second) / second_modulus)


def axis_ratio(curvature_ratio):
    """Ratio a/b of the contact ellipse's semi-axes.

    Solves ``R_D(0, g^2, 1)/R_D(0, 1, g^2) = B/A`` for g = a/b, (1) and (2), by
    the secant method in log(g), where the function is nearly straight.

    Parameters
    ----------
    curvature_ratio : float or ndarray
        B/A: lateral over longitudinal sum of curvatures; positive.

    Returns
    -------
    ndarray
        a/b, same shape.

    Raises
    ------
    ContactError
        For a ratio that is not positive and finite.
    ConvergenceError
        If the iteration fails (not seen for a/b from 1e-6 to 1e6).
    """
    from scipy.special import elliprd

    _require(curvature_ratio, lambda v: (v > 0) & np.isfinite(v), "ratio of curvatures B/A", "-",
             "positive and finite")
    target = np.log(curvature_ratio)

    def residual(log_ratio):
        square = np.exp(2.0 * log_ratio)
        return np.log(elliprd(0.0, square, 1.0) / elliprd(0.0, 1.0, square)) - target

    # Near the circle log(B/A) = 1.5 log(a/b) + O(log^3); towards line contact the slope is 2.
    previous, current = target / 1.5, target / 1.6
    r_previous, r_current = residual(previous), residual(current)
    for _ in range(_MAX_ITERATIONS):
        if np.all(np.abs(r_current) <= _TOLERANCE * np.maximum(1.0, np.abs(target))):
            return np.exp(current)
        difference = r_current - r_previous
        slope = np.where(difference == 0.0, 1.5, difference) / np.where(
            difference == 0.0, 1.0, current - previous)
        previous, r_previous = current, r_current
        current = current - r_current / slope
        r_current = residual(current)
    raise ConvergenceError(
        f"Hertz axis ratio did not converge in {_MAX_ITERATIONS} iterations for B/A = {curvature_ratio!r}; "
        "check the curvatures (1/m)")


def hertz(load, curvature_x, curvature_y, modulus) -> HertzContact:
    """Hertz contact from load and local curvatures.

    Parameters
    ----------
    load : float or ndarray
        Normal load N, N; positive.
    curvature_x, curvature_y : float or ndarray
        Sum of the two bodies' curvatures in the planes x-z and y-z, 1/m, each
        body's curvature being 1/R, positive where the body is convex.  For a
        wheel on a straight rail ``curvature_x = 1/r0`` and ``curvature_y =
        1/R_wheel + 1/R_rail`` (transverse; R_wheel = inf for a cone, negative
        for a hollow tread).  The sums must be positive.
    modulus : float or ndarray
        Contact modulus, N/m^2; see `contact_modulus`.

    Returns
    -------
    HertzContact
        Arrays of the broadcast shape of the arguments.

    Raises
    ------
    ContactError
        For a load, a curvature sum or a modulus that is not positive: the
        bodies then do not touch in an ellipse.

    Notes
    -----
    Principal planes of both bodies are x-z and y-z (no yaw in the ellipse).
    """
    from scipy.special import elliprd, elliprf

    _require(load, lambda v: (v > 0) & np.isfinite(v), "normal load", "N", "positive and finite")
    _require(modulus, lambda v: (v > 0) & np.isfinite(v), "contact modulus", "N/m^2", "positive and finite")
    for name, value in (("longitudinal", curvature_x), ("lateral", curvature_y)):
        _require(value, lambda v: (v > 0) & np.isfinite(v), f"{name} sum of curvatures", "1/m",
                 "positive and finite (the contact must be convex, not a line and not conformal)")
    load, curvature_x, curvature_y, modulus = np.broadcast_arrays(
        *(np.asarray(v, dtype=float) for v in (load, curvature_x, curvature_y, modulus)))
    ratio = axis_ratio(curvature_y / curvature_x)
    compliance = load / (2.0 * np.pi * modulus)
    # R_D is homogeneous of degree -3/2: R_D(0, a^2, b^2) = R_D(0, g^2, 1)/b^3, (2) then gives b.
    b = np.cbrt(compliance * elliprd(0.0, ratio**2, 1.0) / (0.5 * curvature_y))
    a = ratio * b
    approach = 3.0 * compliance * elliprf(0.0, a**2, b**2)
    # approach ~ N^(2/3), so dN/d(approach) = 3 N/(2 approach).
    return HertzContact(a, b, approach, 1.5 * load / approach)


def _require(value, allowed, name, unit, wanted):
    """Raise ContactError naming the first value that is not allowed."""
    array = np.asarray(value, dtype=float)
    good = allowed(array)
    if not np.all(good):
        index = tuple(int(i) for i in np.argwhere(~good)[0])
        where = f" at index {index[0] if len(index) == 1 else index}" if index else ""
        raise ContactError(f"{name}{where} is {float(array[index])!r} {unit}; it must be {wanted}")
