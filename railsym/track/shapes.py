# SPDX-License-Identifier: BSD-3-Clause
"""How curvature and cant grow along a transition: shapes f(x), f(0) = 0, f(1) = 1, as piecewise polynomials.

Names as in IFC 4.3 (IfcAlignmentHorizontalSegment, IfcAlignmentCantSegment): clothoid, Bloss, cosine, sine, Helmert.
"""

from functools import cache

import numpy as np

from railsym.errors import TrackError
from railsym.track.piecewise import PiecewisePolynomial
from railsym.vehicle_checks import unknown

_COSINE_PIECES, _SINE_PIECES = 16, 32      # two-point Taylor polynomials of degree 7 are then right to 1e-13


def _clothoid():
    """f = x"""
    return PiecewisePolynomial.of([0.0, 1.0], [[0.0, 1.0]])


def _bloss():
    """f = 3 x^2 - 2 x^3"""
    return PiecewisePolynomial.of([0.0, 1.0], [[0.0, 0.0, 3.0, -2.0]])


def _helmert():
    """f = 2 x^2 up to the middle, then 1 - 2 (1 - x)^2: two parabolas"""
    return PiecewisePolynomial.of([0.0, 0.5, 1.0], [[0.0, 0.0, 0.5], [0.5, 1.0, -0.5]])


def _cosine():
    """f = (1 - cos(pi x))/2"""
    def derivatives(x):
        c, s = np.cos(np.pi * x), np.sin(np.pi * x)
        return [0.5 * (1.0 - c), 0.5 * np.pi * s, 0.5 * np.pi**2 * c, -0.5 * np.pi**3 * s]
    return PiecewisePolynomial.two_point_taylor(np.linspace(0.0, 1.0, _COSINE_PIECES + 1), derivatives)


def _sine():
    """f = x - sin(2 pi x)/(2 pi)"""
    def derivatives(x):
        c, s = np.cos(2 * np.pi * x), np.sin(2 * np.pi * x)
        return [x - s / (2 * np.pi), 1.0 - c, 2 * np.pi * s, 4 * np.pi**2 * c]
    return PiecewisePolynomial.two_point_taylor(np.linspace(0.0, 1.0, _SINE_PIECES + 1), derivatives)


SHAPES = {"clothoid": _clothoid, "bloss": _bloss, "cosine": _cosine, "sine": _sine, "helmert": _helmert}


def check_kind(kind, what):
    """Raise TrackError unless ``kind`` is a shape."""
    if kind not in SHAPES:
        raise TrackError(f"{what} {kind!r} is {unknown(kind, SHAPES)}")


@cache
def shape(kind):
    """Shape by name, on 0..1.

    Returns
    -------
    PiecewisePolynomial
    """
    return SHAPES[kind]()
