# SPDX-License-Identifier: BSD-3-Clause
"""Comfort on discrete events, P_DE of EN 12299: the share of passengers who find a jolt uncomfortable.

    P_DE = max(A y_p + B y_m - C, 0)        per cent

y_p is the difference of the largest and the smallest lateral acceleration within 2 s, y_m the modulus of its mean there. Formula, constants and
window are recalled (trust R): use it to compare events, not to judge one.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data
from railsym.criteria.source import gather

_WINDOW = 2.0      # s


@dataclass(frozen=True, eq=False)
class DiscreteComfort:
    """P_DE over time.

    Attributes
    ----------
    percent : float
        The largest.
    time : float
        s, middle of its window.
    peak_to_peak, mean : float
        m/s^2, there.
    middle, values : ndarray (m,)
        s and per cent, of all windows.
    posture, trust : str
    """

    percent: float
    time: float
    peak_to_peak: float
    mean: float
    middle: np.ndarray = field(repr=False)
    values: np.ndarray = field(repr=False)
    posture: str = "standing"
    trust: str = "R"

    @property
    def message(self):
        """In a sentence."""
        return (f"P_DE = {self.percent:.3g} % at t = {self.time:.4g} s ({self.posture}; formula recalled and unverified, {self.trust}): "
                f"lateral acceleration {self.peak_to_peak:.3g} m/s^2 peak to peak, {self.mean:.3g} m/s^2 mean")

    def __str__(self):
        return self.message


def discrete_event_comfort(time, lateral, posture="standing"):
    """P_DE of a record.

    Parameters
    ----------
    time : array_like (n,)
        s, uniform, at least 2 s.
    lateral : array_like (n,)
        Lateral acceleration of the floor, m/s^2, without what passengers do not feel as a jolt (filter it to some 2 Hz first).
    posture : str
        ``"standing"`` or ``"seated"``.

    Returns
    -------
    DiscreteComfort

    Raises
    ------
    CriterionError
        Shorter than 2 s, sampled below 20 Hz, not finite, an unknown posture.
    """
    from scipy.ndimage import maximum_filter1d, minimum_filter1d

    table = data("comfort")["discrete_event"]
    if posture not in table:
        raise CriterionError(f"posture {posture!r}: there are {', '.join(table)}")
    found = gather(time, {"lateral": lateral}, (), "")
    found.need(_WINDOW, 20.0, "P_DE")
    values, half = found.values["lateral"], int(round(0.5 * _WINDOW / found.step))
    size, inner = 2 * half + 1, slice(half, values.size - half)
    swing = (maximum_filter1d(values, size) - minimum_filter1d(values, size))[inner]
    sums = np.concatenate([[0.0], np.cumsum(values)])
    mean = np.abs(sums[size:] - sums[:-size]) / size
    a, b, c = (table[posture][key][0] for key in "ABC")
    percent = np.maximum(a * swing + b * mean - c, 0.0)
    k = int(percent.argmax())
    middle = found.time[inner]
    return DiscreteComfort(float(percent[k]), float(middle[k]), float(swing[k]), float(mean[k]), middle, percent, posture, table[posture]["trust"])
