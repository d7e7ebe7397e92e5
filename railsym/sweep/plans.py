# SPDX-License-Identifier: BSD-3-Clause
"""Plans: which cases a study has. Rows are made block by block, so that a million cases need no more memory than a block.

A plan sees the factors as a `Space`: quantile functions, levels and the vehicle's own values, all in SI.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, field

import numpy as np

from railsym.sweep.errors import SweepError

MOST = 2**31 - 1          # cases; the store counts them with 32 bits


class Plan:
    """Base of all plans."""

    kind = ""

    def size(self, space):
        """Number of cases."""
        raise NotImplementedError

    def rows(self, space, start, stop, seed):
        """Values of the cases from start to stop, (m, k), SI (texts by their place in the list)."""
        raise NotImplementedError


def _whole(plan, name, least):
    value = getattr(plan, name)
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= MOST:
        raise SweepError(f"{plan!r}: {name} must be a whole number from {least} to {MOST}")


@dataclass(frozen=True)
class FullGrid(Plan):
    """Every combination: grids and lists with their own values, distributions with ``levels`` from their 5 % to their 95 % quantile.

    The last factor changes fastest.
    """

    levels: int = 5
    kind = "full_grid"

    def __post_init__(self):
        _whole(self, "levels", 1)

    def size(self, space):
        from math import prod

        return prod(len(levels) for levels in space.levels(self.levels))

    def rows(self, space, start, stop, seed):
        levels = space.levels(self.levels)
        index = np.unravel_index(np.arange(start, stop), [len(v) for v in levels])
        return np.column_stack([v[i] for v, i in zip(levels, index)])


@dataclass(frozen=True)
class OneAtATime(Plan):
    """The vehicle as it is (case 0), then each factor through its levels while the others stay as they are.

    Where a factor has no value of its own in vehicle or analysis, its median stands for it.
    """

    levels: int = 5
    kind = "one_at_a_time"

    def __post_init__(self):
        _whole(self, "levels", 1)

    def size(self, space):
        return 1 + sum(len(levels) for levels in space.levels(self.levels))

    def rows(self, space, start, stop, seed):
        levels = space.levels(self.levels)
        ends = 1 + np.cumsum([0, *(len(v) for v in levels)])
        cases = np.arange(start, stop)
        rows = np.tile(space.nominal, (len(cases), 1))
        for k, values in enumerate(levels):
            mine = (cases >= ends[k]) & (cases < ends[k + 1])
            rows[mine, k] = values[cases[mine] - ends[k]]
        return rows


@dataclass(frozen=True)
class LatinHypercube(Plan):
    """Latin hypercube (McKay, Beckman and Conover 1979): of every factor one value from each of ``cases`` equally probable parts.

    The columns are drawn apart, each from a stream of its own that the seed and the factor's name give: another factor more leaves the
    values of the others as they are.
    """

    cases: int
    kind = "latin_hypercube"

    def __post_init__(self):
        _whole(self, "cases", 1)

    def size(self, space):
        return int(self.cases)

    def rows(self, space, start, stop, seed):
        return np.column_stack([space.quantile(k, self._column(seed, name)[start:stop]) for k, name in enumerate(space.names)])

    def _column(self, seed, name):
        """One column of the hypercube by SciPy, kept with the plan: 8 bytes a case. Columns of a plain Latin hypercube are independent."""
        kept = self.__dict__.setdefault("_kept", {})
        if (seed, name) not in kept:
            kept[seed, name] = _engine("LatinHypercube", 1, _stream(seed, name)).random(int(self.cases))[:, 0]
        return kept[seed, name]


def _stream(seed, name):
    return np.random.default_rng([seed, zlib.crc32(name.encode())])


@dataclass(frozen=True)
class Sobol(Plan):
    """Sobol's sequence with Owen's scrambling (`scipy.stats.qmc.Sobol`); balanced where ``cases`` is a power of two."""

    cases: int
    scramble: bool = True
    kind = "sobol"

    def __post_init__(self):
        _whole(self, "cases", 1)
        if self.cases > 2**30:
            raise SweepError(f"{self!r}: Sobol's sequence has 2^30 points here")

    def size(self, space):
        return int(self.cases)

    def rows(self, space, start, stop, seed):
        import warnings

        engine = _engine("Sobol", len(space.names), np.random.default_rng(seed), scramble=bool(self.scramble))
        if start:
            engine.fast_forward(start)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="The balance properties", category=UserWarning)
            unit = engine.random(stop - start)
        return np.column_stack([space.quantile(k, column) for k, column in enumerate(unit.T)])


def _engine(name, dimensions, stream, **options):
    """A generator of scipy.stats.qmc; its argument for the random stream was renamed in SciPy 1.15."""
    from inspect import signature

    from scipy.stats import qmc

    engine = getattr(qmc, name)
    word = "rng" if "rng" in signature(engine).parameters else "seed"
    return engine(d=dimensions, **{word: stream}, **options)


@dataclass(frozen=True, eq=False)
class Table(Plan):
    """Cases as listed.

    Parameters
    ----------
    values : array_like, shape (n, k)
        A row a case, a column a factor in their order.
    scale : {"units", "si", "unit_cube"}
        Values in the factors' units (texts by their place in the list), in SI, or probabilities in [0, 1] as samplers of other libraries
        give them, turned into values by the factors' distributions.
    """

    values: np.ndarray = field(repr=False)
    scale: str = "units"
    kind = "table"

    def __post_init__(self):
        values = np.array(self.values, dtype=float, ndmin=2)
        values.flags.writeable = False
        if values.ndim != 2 or not values.size or not np.isfinite(values).all():
            raise SweepError(f"a plan by table needs finite numbers of shape (cases, factors); given is {values.shape}")
        if self.scale not in ("units", "si", "unit_cube"):
            raise SweepError(f"a plan by table has scale {self.scale!r}; 'units', 'si' or 'unit_cube' is needed")
        if self.scale == "unit_cube" and not ((values >= 0.0) & (values <= 1.0)).all():
            raise SweepError("a plan by table in the unit cube needs numbers from 0 to 1")
        object.__setattr__(self, "values", values)

    def size(self, space):
        if self.values.shape[1] != len(space.names):
            raise SweepError(f"the plan has {self.values.shape[1]} columns for {len(space.names)} factors: {', '.join(space.names)}")
        return len(self.values)

    def rows(self, space, start, stop, seed):
        rows = self.values[start:stop]
        if self.scale == "si":
            return rows.copy()
        take = space.quantile if self.scale == "unit_cube" else space.converted
        return np.column_stack([take(k, column) for k, column in enumerate(rows.T)])


KINDS = {plan.kind: plan for plan in (FullGrid, OneAtATime, LatinHypercube, Sobol, Table)}
