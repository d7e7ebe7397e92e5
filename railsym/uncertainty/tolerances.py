# SPDX-License-Identifier: BSD-3-Clause
"""Independent distributions of parameters, seen from the standard normal space u: x = ppf(Phi(u))."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from railsym.uncertainty.errors import UncertaintyError

_STEP = 1e-4      # of u: the difference quotient of ppf(Phi(u)) is then good to 1e-8, and rounding stays below that
FARTHEST = 7.0    # |u| beyond which Phi(u) is 1 to 1e-12 and quantiles mean nothing


class Tolerances:
    """Distributions by name.

    Parameters
    ----------
    distributions : mapping of str to distribution
        SciPy's (anything with ``ppf``), or factors of `railsym.sweep` in SI.

    Raises
    ------
    UncertaintyError
        Nothing given, something that is no distribution, or a factor in a unit of its own: `of` a study knows those.
    """

    def __init__(self, distributions: Mapping):
        if not distributions:
            raise UncertaintyError("no tolerances were given: a mapping of names to distributions is needed")
        self.names = tuple(distributions)
        self._quantile = tuple(_quantile(name, distribution) for name, distribution in distributions.items())

    def __len__(self):
        return len(self.names)

    @classmethod
    def of(cls, study):
        """Those of a study's factors, in SI."""
        space = study.space
        return cls({name: _Quantile(space, k) for k, name in enumerate(space.names)})

    def quantile(self, probability) -> np.ndarray:
        """Parameters at a probability, or one each: shape (k,)."""
        given = np.broadcast_to(np.asarray(probability, float), len(self))
        found = np.array([float(quantile(p)) for quantile, p in zip(self._quantile, given)])
        if not np.isfinite(found).all():
            k = int(np.argmin(np.isfinite(found)))
            raise UncertaintyError(f"tolerance of {self.names[k]!r}: its quantile at {given[k]:g} is {found[k]}")
        return found

    def columns(self, unit) -> np.ndarray:
        """Parameters at points of the unit cube, both of shape (n, k)."""
        return np.column_stack([np.asarray(quantile(column), float) for quantile, column in zip(self._quantile, np.asarray(unit, float).T)])

    def from_normal(self, u) -> np.ndarray:
        """x of a point u of the standard normal space."""
        from scipy.special import ndtr

        return self.quantile(ndtr(u))

    def slope(self, u) -> np.ndarray:
        """dx/du at a point, shape (k,)."""
        u = np.asarray(u, float)
        return (self.from_normal(u + _STEP) - self.from_normal(u - _STEP)) / (2 * _STEP)

    def deviation(self) -> np.ndarray:
        """Standard deviations, shape (k,): by Gauss-Hermite quadrature of x(u), 64 points."""
        points, weights = np.polynomial.hermite_e.hermegauss(64)
        weights = weights / weights.sum()
        x = np.array([self.from_normal(np.full(len(self), u)) for u in np.clip(points, -FARTHEST, FARTHEST)])
        mean = weights @ x
        return np.sqrt(weights @ (x - mean)**2)


def as_tolerances(given):
    """`Tolerances` of a mapping, or as they are."""
    return given if isinstance(given, Tolerances) else Tolerances(given)


class _Quantile:
    """One factor of a study."""

    def __init__(self, space, k):
        self.ppf = lambda probability: space.quantile(k, probability)


def _quantile(name, distribution):
    if getattr(distribution, "unit", None):
        raise UncertaintyError(f"tolerance of {name!r} is in {distribution.unit}: give it in SI without a unit, or take it from a study")
    found = getattr(distribution, "ppf", None) or getattr(distribution, "quantile", None)
    if not callable(found):
        raise UncertaintyError(f"tolerance of {name!r}: {distribution!r} is no distribution; give one with ppf, such as "
                               "railsym.sweep.Uniform(low, high) or scipy.stats.norm(mean, deviation)")
    return found
