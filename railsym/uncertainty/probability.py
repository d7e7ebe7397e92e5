# SPDX-License-Identifier: BSD-3-Clause
"""Probability that a result lies below a limit, from cases that were drawn, with its interval."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.uncertainty.errors import UncertaintyError


@dataclass(frozen=True)
class Probability:
    """Share of cases below a limit.

    Attributes
    ----------
    limit : float
        In the unit of the values.
    below, cases, unknown : int
        Cases below the limit, cases whose side of the limit is known, cases that failed.
    value : float
        below/cases.
    wilson, exact : (float, float)
        Intervals of Wilson (1927) and of Clopper and Pearson (1934) for independent cases.
    bounds : (float, float)
        The exact interval if all cases that failed lay above, or all below: what is certain whatever they are. The same as `exact`
        where none failed.
    confidence : float
    """

    limit: float
    below: int
    cases: int
    unknown: int
    value: float
    wilson: tuple[float, float]
    exact: tuple[float, float]
    bounds: tuple[float, float]
    confidence: float

    @property
    def message(self) -> str:
        """In one line."""
        text = (f"{self.below} of {self.cases} cases below {self.limit:g}: probability {self.value:.3g}, {100 * self.confidence:g} % interval "
                f"[{self.exact[0]:.3g}, {self.exact[1]:.3g}] (Clopper-Pearson), [{self.wilson[0]:.3g}, {self.wilson[1]:.3g}] (Wilson)")
        if self.unknown:
            text += f"; {self.unknown} failed, with any outcome of theirs [{self.bounds[0]:.3g}, {self.bounds[1]:.3g}]"
        return text

    def __str__(self):
        return self.message


def probability_below(values, limit: float, *, above=None, confidence: float = 0.95) -> Probability:
    """Probability that a value lies below a limit.

    Parameters
    ----------
    values : array_like, shape (n,)
        One a case, nan (or masked) where there is none.
    limit : float
        In the unit of the values.
    above : array_like of bool, shape (n,), optional
        Cases without a value that are known to lie above the limit, such as a vehicle that stays stable over the whole range of speeds.
    confidence : float
        Of both intervals.

    Returns
    -------
    Probability

    Raises
    ------
    UncertaintyError
        No case with a known side, or a confidence or limit that cannot be used.

    Notes
    -----
    The intervals hold for independent cases. A Latin hypercube estimates a mean at least as well as n - 1 independent cases (Owen, Annals
    of Statistics 25, 1997, p. 1557), so for it they are, if anything, too wide.

    Examples
    --------
    >>> found = probability_below([1.0, 2.0, 3.0, 4.0], 2.5)
    >>> found.value, found.cases
    (0.5, 4)
    """
    values = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    above = np.zeros(len(values), bool) if above is None else np.asarray(above, bool).ravel()
    if len(above) != len(values):
        raise UncertaintyError(f"above: {len(values)} truth values are needed, one a case; got {len(above)}")
    above = above & np.isnan(values)
    if not np.isfinite(limit) or not 0.0 < confidence < 1.0:
        raise UncertaintyError(f"limit {limit!r}, confidence {confidence!r}: a finite limit and a confidence between 0 and 1 are needed")
    below = int((values < limit).sum())
    cases = int((~np.isnan(values)).sum() + above.sum())
    unknown = len(values) - cases
    if cases == 0:
        raise UncertaintyError(f"none of the {len(values)} cases has a value: the probability cannot be estimated; look at the errors of the cases")
    exact = _interval(below, cases, confidence, "exact")
    bounds = (_interval(below, len(values), confidence, "exact")[0], _interval(below + unknown, len(values), confidence, "exact")[1])
    return Probability(float(limit), below, cases, unknown, below / cases, _interval(below, cases, confidence, "wilson"), exact, bounds, confidence)


def _interval(count, cases, confidence, method):
    from scipy.stats import binomtest

    found = binomtest(count, cases).proportion_ci(confidence, method)
    return float(found.low), float(found.high)
