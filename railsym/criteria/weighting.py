# SPDX-License-Identifier: BSD-3-Clause
"""Frequency weightings of EN 12299 and ISO 2631.

    H(s) = s^2/(s^2 + w1 s/Q1 + w1^2) * w2^2/(s^2 + w2 s/Q1 + w2^2)            band limits
         * (1 + s/w3)/(1 + s/(Q2 w4) + s^2/w4^2)                               acceleration-velocity transition
         * K (1 + s/(Q3 w5) + s^2/w5^2)/(1 + s/(Q4 w6) + s^2/w6^2)             upward step (Wb, Wk)
"""

from __future__ import annotations

from functools import cache

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data

_TAIL = 10.0      # s of zeros behind the record: the high-pass at 0.4 Hz rings for e^-1 = 0.56 s
RATE = 200.0      # Hz: 2.5 times the 80 Hz up to which the standards tabulate weights


def weighting(name, frequency):
    """Complex weight at frequencies.

    Parameters
    ----------
    name : str
        ``"Wb"``, ``"Wd"``, ``"Wc"`` (EN 12299), ``"Wk"`` (ISO 2631), ``"Wb_ISO8041"``.
    frequency : array_like
        Hz, at least 0.

    Returns
    -------
    ndarray, complex
        The modulus is the weight, the phase that of the analogue filter.

    Raises
    ------
    CriterionError
        An unknown name.
    """
    (f1, f2, f3, f4, *step), (q1, q2, *more), gain = _parameters(name)
    s = 1j * np.asarray(frequency, dtype=float)  # in Hz: H depends on s/w only
    result = gain * s ** 2 / (s ** 2 + s * f1 / q1 + f1 ** 2) * f2 ** 2 / (s ** 2 + s * f2 / q1 + f2 ** 2)
    result = result * (1 + s / f3) / (1 + s / (q2 * f4) + (s / f4) ** 2)
    if step:
        (f5, f6), (q3, q4) = step, more
        result = result * (1 + s / (q3 * f5) + (s / f5) ** 2) / (1 + s / (q4 * f6) + (s / f6) ** 2)
    return result


def weighted(values, rate, name):
    """A signal through a weighting, in the frequency domain: exact up to half of the sampling rate.

    Parameters
    ----------
    values : ndarray (n,)
        m/s^2; its mean is taken off first, so that the filter does not start with a step.
    rate : float
        Hz, at least 200.
    name : str

    Returns
    -------
    ndarray (n,)

    Raises
    ------
    CriterionError
    """
    if rate < RATE * (1 - 1e-6):
        raise CriterionError(f"weighting {name} needs a sampling rate of at least {RATE:g} Hz (weights up to 80 Hz); the signal has {rate:.5g} Hz")
    count = values.size + int(np.ceil(_TAIL * rate))
    lines = np.fft.rfft(values - values.mean(), count)
    return np.fft.irfft(lines * weighting(name, np.fft.rfftfreq(count, 1.0 / rate)), count)[:values.size]


@cache
def _parameters(name):
    table = data("comfort")["weightings"]
    if name not in table:
        raise CriterionError(f"there is no weighting {name!r}; there are {', '.join(table)}")
    return table[name]["f"][0], table[name]["Q"][0], table[name]["K"][0]
