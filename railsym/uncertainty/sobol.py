# SPDX-License-Identifier: BSD-3-Clause
"""Sobol indices: which share of a result's variance each parameter carries alone (first order) and with all others (total).

Cases and estimators are SALib's: Saltelli's scheme on a scrambled Sobol sequence, first and total order after Saltelli et al. (Computer
Physics Communications 181, 2010), intervals by bootstrap over the base points.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.uncertainty.errors import UncertaintyError
from railsym.uncertainty.packages import needed


@dataclass(frozen=True, eq=False)
class Sobol:
    """Sobol indices of one output.

    Attributes
    ----------
    names : tuple of str
    first, total : ndarray, shape (k,)
    first_half, total_half : ndarray, shape (k,)
        Half widths of their intervals.
    second, second_half : ndarray, shape (k, k), or None
        Upper triangle: interactions of two parameters beyond their first order; nan elsewhere.
    base : int
        Base points used.
    dropped : int
        Base points left out because one of their cases failed.
    cases : int
        Cases used.
    confidence : float
    mean, deviation : float
        Of the output over the independent points.
    """

    names: tuple[str, ...]
    first: np.ndarray
    first_half: np.ndarray
    total: np.ndarray
    total_half: np.ndarray
    second: np.ndarray | None
    second_half: np.ndarray | None
    base: int
    dropped: int
    cases: int
    confidence: float
    mean: float
    deviation: float

    @property
    def message(self) -> str:
        """In one line."""
        k = int(np.argmax(self.total))
        text = (f"{self.base} base points, {self.cases} cases: first-order indices add to {self.first.sum():.3f}; largest total index "
                f"{self.total[k]:.3f} +- {self.total_half[k]:.3f} ({self.names[k]})")
        if self.dropped:
            text += f"; {self.dropped} base points left out, where a case failed: the indices are those of the rest"
        return text

    def __str__(self):
        lines = [self.message, f"{'parameter':44} {'first':>8} {'+-':>7} {'total':>8} {'+-':>7}"]
        for k in np.argsort(-self.total):
            lines.append(f"{self.names[k]:44} {self.first[k]:8.4f} {self.first_half[k]:7.4f} {self.total[k]:8.4f} {self.total_half[k]:7.4f}")
        return "\n".join(lines)

    def plot(self, **options):
        """Draw bars; options and axes as `railsym.plots.plot_sobol`."""
        from railsym.plots import plot_sobol
        return plot_sobol(self, **options)


def saltelli(count: int, base: int, *, second_order: bool = False, seed: int = 1) -> np.ndarray:
    """Cases of Saltelli's scheme in the unit cube.

    Parameters
    ----------
    count : int
        Parameters.
    base : int
        Base points, a power of two.
    second_order : bool
        For the interactions of two parameters as well.
    seed : int
        Of the scrambling.

    Returns
    -------
    ndarray, shape (base (count + 2), count), or (base (2 count + 2), count) with `second_order`
        Probabilities; parameters are the quantiles of their distributions there.

    Raises
    ------
    UncertaintyError
        Base points that are no power of two.
    """
    sample = needed("SALib.sample.sobol", "Sobol indices").sample
    if base < 2 or base & (base - 1):
        raise UncertaintyError(f"{base} base points: a power of two from 2 on is needed (64, 128, 256), or the Sobol sequence loses its balance")
    return sample(_problem(count), base, calc_second_order=second_order, seed=np.random.default_rng(seed))


def sobol_indices(names, values, *, second_order: bool = False, confidence: float = 0.95, resamples: int = 1000, seed: int = 1) -> Sobol:
    """Sobol indices from the results of `saltelli`'s cases, in their order.

    Parameters
    ----------
    names : sequence of str
        Parameters, in the order of the columns.
    values : array_like, shape (n,)
        One output; nan (or masked) where a case failed.
    second_order : bool
        As the cases were made.
    confidence : float
    resamples : int
        Of the bootstrap.
    seed : int
        Of the bootstrap.

    Returns
    -------
    Sobol

    Raises
    ------
    UncertaintyError
        A number of values that is not that of the scheme, fewer than two base points without failure, or an output that does not vary.
    """
    analyze = needed("SALib.analyze.sobol", "Sobol indices").analyze
    names = tuple(names)
    values = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    block = (2 if second_order else 1) * len(names) + 2
    if len(values) % block or not len(values):
        raise UncertaintyError(f"{len(values)} values are no multiple of {block}, the cases of a base point with {len(names)} parameters "
                               f"{'with' if second_order else 'without'} second order; take the cases of railsym.uncertainty.saltelli")
    blocks = values.reshape(-1, block)
    good = ~np.isnan(blocks).any(axis=1)
    if good.sum() < 2:
        raise UncertaintyError(f"{len(good) - good.sum()} of {len(good)} base points hold a failed case: nothing is left to estimate from")
    kept = blocks[good]
    if np.ptp(kept) <= 1e-12 * np.abs(kept).max():
        raise UncertaintyError(f"the output is {kept.flat[0]:g} in all {kept.size} cases: without variance there are no indices")
    # SALib takes seed 0 as none
    found = analyze(_problem(len(names)), kept.ravel(), calc_second_order=second_order, num_resamples=resamples, conf_level=confidence, seed=seed + 1)
    second = (found["S2"], found["S2_conf"]) if second_order else (None, None)
    free = kept[:, [0, -1]]
    return Sobol(names, found["S1"], found["S1_conf"], found["ST"], found["ST_conf"], *second, int(good.sum()), int((~good).sum()), kept.size, confidence,
                 float(free.mean()), float(free.std(ddof=1)))


def unit_points(count: int, cases: int, seed: int = 1) -> np.ndarray:
    """Points of a scrambled Sobol sequence in the open unit cube, shape (cases, count)."""
    from inspect import signature

    from scipy.stats import qmc

    word = "rng" if "rng" in signature(qmc.Sobol).parameters else "seed"      # renamed in SciPy 1.15
    points = qmc.Sobol(count, **{word: np.random.default_rng(seed)}).random(cases)
    return np.clip(points, 1e-9, 1.0 - 1e-9)


def _problem(count):
    return {"num_vars": count, "names": [f"x{k}" for k in range(count)], "bounds": [[0.0, 1.0]] * count}
