# SPDX-License-Identifier: BSD-3-Clause
"""Tornado chart: what each tolerance alone does to a result, from its analytic gradient.

With the medians p0 of the tolerances and the gradient g there, parameter i at its quantiles moves the result by g_i (p_i - p0_i), and
all of them together by the standard deviation sqrt(sum (g_i sigma_i)^2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.uncertainty.errors import UncertaintyError
from railsym.uncertainty.tolerances import as_tolerances


@dataclass(frozen=True, eq=False)
class Tornado:
    """Changes of a result by tolerances, the widest first.

    Attributes
    ----------
    names, units : tuple of str
    nominal : float
        The result at the medians.
    medians, low, high : ndarray, shape (k,)
        Parameters, SI.
    gradient : ndarray, shape (k,)
        Of the result, per SI unit.
    change_low, change_high : ndarray, shape (k,)
        Of the result with one parameter at `low` or `high`, to first order.
    computed_low, computed_high : ndarray, shape (k,), or None
        The same by computing anew; nan where that failed.
    deviation : float
        First-order standard deviation of the result.
    share : ndarray, shape (k,)
        Of the variance, to first order.
    levels : (float, float)
        Probabilities of `low` and `high`.
    output, unit : str
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    nominal: float
    medians: np.ndarray
    low: np.ndarray
    high: np.ndarray
    gradient: np.ndarray
    change_low: np.ndarray
    change_high: np.ndarray
    computed_low: np.ndarray | None
    computed_high: np.ndarray | None
    deviation: float
    share: np.ndarray
    levels: tuple[float, float]
    output: str
    unit: str

    @property
    def message(self) -> str:
        """In one line."""
        return (f"{self.output} {self.nominal:.5g} {self.unit}, first-order standard deviation {self.deviation:.3g} {self.unit}; "
                f"{self.names[0]} carries {100 * self.share[0]:.0f} % of the variance")

    def __str__(self):
        lines = [self.message, f"{'parameter':44} {'low':>11} {'high':>11} {'unit':10} {'change low':>11} {'change high':>11} {'variance':>9}"]
        for k, name in enumerate(self.names):
            lines.append(f"{name:44} {self.low[k]:11.5g} {self.high[k]:11.5g} {self.units[k]:10} {self.change_low[k]:11.4g} "
                         f"{self.change_high[k]:11.4g} {100 * self.share[k]:7.1f} %")
        return "\n".join(lines)

    def plot(self, **options):
        """Draw it; options and axes as `railsym.plots.plot_tornado`."""
        from railsym.plots import plot_tornado
        return plot_tornado(self, **options)


def tornado(model, tolerances, *, levels=(0.025, 0.975), check: bool = False) -> Tornado:
    """Tornado chart of a result from one gradient.

    Parameters
    ----------
    model : callable
        Parameters (k,) in the order of `tolerances` to (value, gradient (k,)), such as a `SpeedModel`.
    tolerances : mapping of str to distribution
    levels : (float, float)
        Probabilities of the low and high value of each parameter.
    check : bool
        Compute the result at each low and high value too (2 k evaluations): shows where the first order does not hold.

    Returns
    -------
    Tornado

    Raises
    ------
    UncertaintyError
        Levels or tolerances that cannot be used.
    RailsymError
        No result at the medians.
    """
    from railsym.errors import RailsymError

    given = as_tolerances(tolerances)
    if not 0.0 < levels[0] < levels[1] < 1.0:
        raise UncertaintyError(f"levels {levels}: two ascending probabilities between 0 and 1 are needed")
    middle, low, high = (given.quantile(level) for level in (0.5, *levels))
    nominal, gradient = model(middle)
    gradient = np.asarray(gradient, float)

    def computed(ends):
        found = np.full(len(given), np.nan)
        for k, end in enumerate(ends):
            point = middle.copy()
            point[k] = end
            try:
                found[k] = getattr(model, "value", lambda x: model(x)[0])(point) - nominal
            except RailsymError:
                continue
        return found

    variance = (gradient * given.deviation())**2
    total = variance.sum()
    share = variance / total if total > 0.0 else np.zeros(len(given))
    order = np.argsort(-np.abs(gradient * (high - low)), kind="stable")
    ends = [computed(low)[order], computed(high)[order]] if check else [None, None]
    units = getattr(model, "units", ("",) * len(given))
    return Tornado(tuple(given.names[k] for k in order), tuple(units[k] for k in order), float(nominal), middle[order], low[order], high[order],
                   gradient[order], (gradient * (low - middle))[order], (gradient * (high - middle))[order], *ends, float(np.sqrt(total)),
                   share[order], tuple(levels), getattr(model, "output", "result"), getattr(model, "unit", ""))
