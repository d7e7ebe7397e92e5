# SPDX-License-Identifier: BSD-3-Clause
"""Sperling's Wz: ride comfort and ride quality.

    Wz = (2 integral of B(f)^2 G(f) df)^(3/20)        a in cm/s^2, G the one-sided power spectral density

For a sine of amplitude A this is (A^2 B^2)^(3/20). (3/20 = 1/6.67 of the usual form.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import signal as scipy_signal

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data, limits, scale_class
from railsym.criteria.source import gather

_SHORTEST = 5.0     # s: ten periods of 2 Hz; the lower end of the band then has 2.5


@dataclass(frozen=True)
class Sperling:
    """Wz of one signal.

    Attributes
    ----------
    value : float
    direction, kind : str
    trust : str
        Of the formula.
    """

    value: float
    direction: str
    kind: str
    trust: str

    @property
    def message(self):
        """In a sentence."""
        return f"Wz {self.kind}, {self.direction}: {self.value:.2f}, {scale_class(f'Wz_{self.kind}', self.value)}; formula {self.trust}"

    def __str__(self):
        return self.message


def sperling_weight(frequency, direction="vertical", kind="comfort"):
    """Sperling's B(f), acceleration in cm/s^2.

    Parameters
    ----------
    frequency : array_like
        Hz.
    direction : str
        ``"lateral"`` or ``"vertical"``.
    kind : str
        ``"comfort"`` (of passengers) or ``"quality"`` (of the vehicle's ride).

    Returns
    -------
    ndarray
    """
    table = data("comfort")["sperling"]
    if kind not in table or direction not in ("lateral", "vertical"):
        raise CriterionError(f"kind {kind!r}, direction {direction!r}: there are {', '.join(table)} and lateral, vertical")
    c = {key: entry[0] for key, entry in table[kind].items() if isinstance(entry, list)}
    f2 = np.asarray(frequency, dtype=float) ** 2
    below = (1 - c["a"] * f2) ** 2 + f2 * (c["b"] - c["c"] * f2) ** 2
    if kind == "comfort":
        return c[direction] * np.sqrt((c["n2"] * f2 + c["n4"] * f2 ** 2) / below)
    return c[direction] * np.sqrt(((1 - c["p"] * f2) ** 2 + c["q"] ** 2 * c["r"] * f2 ** 2) / (below * (1 + c["r"] * f2)))


def sperling(time, acceleration, direction="vertical", kind="comfort", band=None):
    """Sperling's Wz of an acceleration of the floor.

    Parameters
    ----------
    time, acceleration : array_like (n,)
        s (uniform), m/s^2.
    direction, kind : str
        As for `sperling_weight`.
    band : (float, float), optional
        Hz, summed over; 0.5 to 30 if not given.

    Returns
    -------
    Sperling

    Raises
    ------
    CriterionError
        Less than 5 s, sampled below 75 Hz, not finite.
    """
    band = (limits("wz_low").value, limits("wz_high").value) if band is None else tuple(map(float, band))
    found = gather(time, acceleration, (), "m/s^2")
    found.need(_SHORTEST, 2.5 * band[1], "Sperling's Wz")
    frequency, density = scipy_signal.periodogram(100.0 * found.values["signal"], found.rate, window="hann", detrend="linear")
    inside = (frequency >= band[0]) & (frequency <= band[1])
    weight = sperling_weight(frequency[inside], direction, kind)
    total = 2.0 * float(np.sum(weight ** 2 * density[inside])) * frequency[1]
    table = data("comfort")["sperling"][kind]
    return Sperling(total ** table["exponent"][0], direction, kind, table["trust"])
