# SPDX-License-Identifier: BSD-3-Clause
"""Kalker's coefficients C11, C22, C23, C33 of linear rolling theory.

Between a/b = 0.1 and 10 they interpolate the table of Kalker (1990, table E.3):
1/C by a parabola in Poisson's ratio, log C by a cubic spline in log(a/b).
Outside the table Kalker's asymptotes are used (Kalker 1967, thesis, Delft),
scaled so that they join the table's last entry.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from railsym.errors import ContactError

_TABLE_RATIOS = (0.1, 10.0)
_TABLE_END = 0.1  # min(a/b, b/a) at both ends of the table


class KalkerCoefficients(NamedTuple):
    """Kalker's coefficients, dimensionless arrays of one shape (C32 = -C23)."""

    c11: np.ndarray
    c22: np.ndarray
    c23: np.ndarray
    c33: np.ndarray


def kalker_coefficients(axis_ratio, poisson_ratio: float) -> KalkerCoefficients:
    """Kalker's creepage and spin coefficients.

    Parameters
    ----------
    axis_ratio : float or ndarray
        a/b, semi-axis in the rolling direction over the lateral one; positive.
    poisson_ratio : float
        Poisson's ratio of both bodies, 0 to 0.5.

    Returns
    -------
    KalkerCoefficients
        Each of the shape of `axis_ratio`.

    Raises
    ------
    ContactError
        For a ratio that is not positive and finite or a Poisson's ratio
        outside 0..0.5.

    Notes
    -----
    The table is printed to three digits, so the coefficients are good to about
    0.5 %.  Continuous everywhere; twice continuously differentiable inside
    0.1 < a/b < 10, with a kink of slope at 0.1 and 10.
    """
    ratio = np.asarray(axis_ratio, dtype=float)
    if not (np.all(ratio > 0) and np.all(np.isfinite(ratio))):
        raise ContactError(f"axis ratio a/b must be positive and finite, got {axis_ratio!r}")
    spline, low, high = _interpolants(_checked_poisson_ratio(poisson_ratio))
    inside = np.clip(ratio, *_TABLE_RATIOS)
    values = np.exp(np.moveaxis(spline(np.log(inside)), -1, 0))
    if np.any(ratio != inside):
        small = np.minimum(ratio, 1.0 / ratio)
        # The correction to the asymptote vanishes with g, as the neglected terms do.
        fade = small / _TABLE_END
        for outside, asymptote, factor in ((ratio < _TABLE_RATIOS[0], _slender_across, low),
                                           (ratio > _TABLE_RATIOS[1], _slender_along, high)):
            g, f = small[outside], fade[outside]
            values[:, outside] = asymptote(g, poisson_ratio) * (1.0 + np.multiply.outer(factor - 1.0, f))
    return KalkerCoefficients(*values)


def table() -> np.ndarray:
    """Kalker's table E.3.

    Returns
    -------
    ndarray, shape (57, 6)
        Columns: Poisson's ratio, a/b, C11, C22, C23, C33.
    """
    path = files("railsym") / "data" / "contact" / "kalker_coefficients.csv"
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return np.array([[float(item) for item in line.split(",")] for line in lines[1:]])


def _checked_poisson_ratio(poisson_ratio) -> float:
    value = float(poisson_ratio)
    if not 0.0 <= value <= 0.5:
        raise ContactError(f"Poisson's ratio must lie between 0 and 0.5, got {value!r}")
    return value


@lru_cache(maxsize=32)
def _interpolants(poisson_ratio: float):
    """Spline of log C over log(a/b), and table over asymptote at both ends, (4,) each."""
    from scipy.interpolate import CubicSpline

    ratio, values = _table_at(poisson_ratio)
    low = values[0] / _slender_across(np.array(_TABLE_END), poisson_ratio)
    high = values[-1] / _slender_along(np.array(_TABLE_END), poisson_ratio)
    return CubicSpline(np.log(ratio), np.log(values)), low, high


def _table_at(poisson_ratio: float):
    """Ratios (n,) and coefficients (n, 4) at one Poisson's ratio: parabola through 1/C."""
    rows = table().reshape(3, -1, 6)
    nodes = rows[:, 0, 0]
    weights = [np.prod([(poisson_ratio - other) / (node - other) for other in nodes if other != node])
               for node in nodes]
    return rows[0, :, 1], 1.0 / np.tensordot(weights, 1.0 / rows[:, :, 2:], axes=1)


def _slender_across(g, nu):
    """Asymptote for a << b, g = a/b: array (4, ...)."""
    log_term = np.log(16.0 / g**2)
    one = np.ones_like(g)
    return np.array([
        np.pi**2 / (4.0 * (1.0 - nu)) * one,
        np.pi**2 / 4.0 * one,
        np.pi * np.sqrt(g) / (3.0 * (1.0 - nu)) * (1.0 + nu * (log_term / 2.0 + np.log(4.0) - 5.0)),
        np.pi**2 / (16.0 * (1.0 - nu) * g),
    ])


def _slender_along(g, nu):
    """Asymptote for a >> b, g = b/a: array (4, ...)."""
    log_term = np.log(16.0 / g**2)
    w11 = log_term - 2.0 * nu
    w22 = (1.0 - nu) * log_term + 2.0 * nu
    w23 = (1.0 - nu) * log_term - 2.0 + 4.0 * nu
    constant = 3.0 - np.log(4.0)
    return np.array([
        2.0 * np.pi / (w11 * g) * (1.0 + constant / w11),
        2.0 * np.pi / (w22 * g) * (1.0 + (1.0 - nu) * constant / w22),
        2.0 * np.pi / (3.0 * g**1.5 * w23),
        np.pi / 4.0 * (1.0 - nu * (log_term - 2.0) / w23),
    ])
