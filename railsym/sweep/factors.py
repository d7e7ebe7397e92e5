# SPDX-License-Identifier: BSD-3-Clause
"""What a factor of a study may be: a grid, a list, a distribution.

Every factor is a quantile function: ``quantile(u)`` turns probabilities u in [0, 1) into values, so any plan in the unit cube serves any
mixture of factors. Numbers are in ``unit``: SI when none is given, and "%" of the vehicle's own value.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from railsym.sweep.errors import SweepError

PERCENT = "%"
_EDGE = 2.0**-54        # half the spacing of doubles below 1: probabilities are kept inside (0, 1), where every quantile is finite


class Factor:
    """Base of all factors."""

    kind = ""
    unit = None

    def __post_init__(self):
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "float" and not (isinstance(value, (int, float, np.number)) and np.isfinite(value)):
                raise SweepError(f"{self!r}: {field.name} = {value!r}; a finite number is needed")
        self.check()

    def check(self):
        """Refuse numbers that make no factor."""

    def quantile(self, u):
        """Values at probabilities u, array like u."""
        raise NotImplementedError

    def levels(self, count):
        """Values for a grid, (m,): `count` of a distribution, from its 5 % to its 95 % quantile."""
        return self.quantile(np.linspace(0.05, 0.95, count))

    def labels(self):
        """Texts that the values stand for, or None."""
        return None

    def refuse(self, need):
        """Raise the error of a factor whose numbers do not fit."""
        raise SweepError(f"factor {self!r}: {need}")


class _Listed(Factor):
    """A factor with a number of values of its own."""

    def quantile(self, u):
        values = self.levels(0)
        return values[np.minimum((np.asarray(u) * len(values)).astype(np.int64), len(values) - 1)]


@dataclass(frozen=True)
class Grid(_Listed):
    """``points`` values from ``low`` to ``high``, evenly spaced, or by equal ratios with ``spacing="log"``."""

    low: float
    high: float
    points: int
    unit: str | None = None
    spacing: str = "linear"
    kind = "grid"

    def check(self):
        if isinstance(self.points, bool) or not isinstance(self.points, (int, np.integer)) or self.points < 1:
            self.refuse("points must be a whole number, at least 1")
        if self.spacing not in ("linear", "log"):
            self.refuse("spacing must be 'linear' or 'log'")
        if self.spacing == "log" and not 0.0 < self.low < self.high:
            self.refuse("spacing 'log' needs 0 < low < high")
        if not (self.low < self.high or (self.points == 1 and self.low == self.high)):
            self.refuse("low must lie below high")

    def levels(self, count):
        return (np.linspace if self.spacing == "linear" else np.geomspace)(self.low, self.high, self.points)


@dataclass(frozen=True)
class List(_Listed):
    """Values as listed: numbers, or texts (names of configurations or curves)."""

    values: tuple
    unit: str | None = None
    kind = "values"

    def __post_init__(self):
        object.__setattr__(self, "values", tuple(v if isinstance(v, str) else float(v) for v in self.values))
        if not self.values:
            self.refuse("at least one value is needed")
        texts = sum(isinstance(v, str) for v in self.values)
        if texts not in (0, len(self.values)) or not all(isinstance(v, str) or np.isfinite(v) for v in self.values):
            self.refuse("finite numbers only, or texts only")
        if len(set(self.values)) < len(self.values):
            self.refuse("a value is listed twice")

    def levels(self, count):
        return np.arange(float(len(self.values))) if self.labels() else np.array(self.values)

    def labels(self):
        return self.values if isinstance(self.values[0], str) else None


@dataclass(frozen=True)
class Uniform(Factor):
    """Evenly distributed from ``low`` to ``high``."""

    low: float
    high: float
    unit: str | None = None
    kind = "uniform"

    def check(self):
        if not self.low < self.high:
            self.refuse("low must lie below high")

    def quantile(self, u):
        return self.low + (self.high - self.low) * np.asarray(u)


@dataclass(frozen=True)
class Triangular(Factor):
    """Density rises linearly from ``low`` to ``mode`` and falls to ``high``."""

    low: float
    mode: float
    high: float
    unit: str | None = None
    kind = "triangular"

    def check(self):
        if not (self.low <= self.mode <= self.high and self.low < self.high):
            self.refuse("low <= mode <= high is needed, low below high")

    def quantile(self, u):
        u, span = np.asarray(u, dtype=float), self.high - self.low
        rise = (self.mode - self.low) / span
        below = self.low + span * np.sqrt(u * rise)
        return np.where(u < rise, below, self.high - span * np.sqrt((1.0 - u) * (1.0 - rise)))


@dataclass(frozen=True)
class Normal(Factor):
    """Normal with ``mean`` and ``std``, cut off at ``low`` and ``high`` where they are given."""

    mean: float
    std: float
    low: float | None = None
    high: float | None = None
    unit: str | None = None
    kind = "normal"

    def check(self):
        _check_bounds(self)
        if self.std <= 0.0:
            self.refuse("std must be above 0")

    def quantile(self, u):
        from scipy.special import ndtr, ndtri

        return self.mean + self.std * ndtri(_inside(u, *(ndtr(_cut(b, self.mean, self.std, s)) for b, s in ((self.low, -1), (self.high, 1)))))


@dataclass(frozen=True)
class LogNormal(Factor):
    """The logarithm is normal: ``median``, and standard deviation ``sigma`` of the logarithm; cut off at ``low`` and ``high``."""

    median: float
    sigma: float
    low: float | None = None
    high: float | None = None
    unit: str | None = None
    kind = "lognormal"

    def check(self):
        _check_bounds(self)
        if self.median <= 0.0 or self.sigma <= 0.0:
            self.refuse("median and sigma must be above 0")
        if (self.low is not None and self.low < 0.0) or (self.high is not None and self.high <= 0.0):
            self.refuse("the bounds must be positive: a lognormal value always is")

    def quantile(self, u):
        from scipy.special import ndtr, ndtri

        bounds = [None if not b else np.log(b) for b in (self.low, self.high)]
        cut = [ndtr(_cut(b, np.log(self.median), self.sigma, s)) for b, s in zip(bounds, (-1, 1))]
        return self.median * np.exp(self.sigma * ndtri(_inside(u, *cut)))


def _check_bounds(factor):
    low, high = (-np.inf if factor.low is None else factor.low), (np.inf if factor.high is None else factor.high)
    if not low < high:
        factor.refuse("low must lie below high")
    middle = factor.mean if isinstance(factor, Normal) else factor.median
    if not low <= middle <= high:
        factor.refuse("the bounds must lie on both sides of the middle: nearly all of the distribution would be cut off")


def _cut(bound, middle, width, side):
    return side * np.inf if bound is None else (bound - middle) / width


def _inside(u, low, high):
    """Probabilities within the part of the distribution that is kept, and where the quantile is finite."""
    return np.clip(low + (high - low) * np.asarray(u, dtype=float), _EDGE, 1.0 - 2.0 * _EDGE)


KINDS = {factor.kind: factor for factor in (Grid, List, Uniform, Triangular, Normal, LogNormal)}
