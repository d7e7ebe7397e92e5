# SPDX-License-Identifier: BSD-3-Clause
"""Comfort in curve transitions, P_CT of EN 12299: the share of passengers who find a transition uncomfortable.

    P_CT = max(A |y''|_1s + B |y'''|_1s - C, 0) + D |roll rate|_1s^E        per cent

Formula and constants are recalled (trust R): use it to compare transitions, not to judge one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data
from railsym.criteria.sliding import sliding_mean
from railsym.criteria.source import gather

_WINDOW = 1.0      # s, of the means, and over which the jerk is taken
_LATER, _BEFORE = 1.6, 1.0  # s: acceleration up to 1.6 s after the end, jerk from 1 s before the start (recalled)


@dataclass(frozen=True)
class CurveComfort:
    """P_CT of one transition.

    Attributes
    ----------
    percent : float
    acceleration, jerk, roll_rate : float
        The maxima that it was computed from, m/s^2, m/s^3, rad/s.
    posture, trust : str
    """

    percent: float
    acceleration: float
    jerk: float
    roll_rate: float
    posture: str
    trust: str

    @property
    def message(self):
        """In a sentence."""
        return (f"P_CT = {self.percent:.3g} % ({self.posture}; formula recalled and unverified, {self.trust}): "
                f"lateral acceleration {self.acceleration:.3g} m/s^2, jerk {self.jerk:.3g} m/s^3, roll rate {np.degrees(self.roll_rate):.3g} deg/s")

    def __str__(self):
        return self.message


def curve_transition_comfort(time, lateral, roll_rate, start, end, posture="standing"):
    """P_CT of one transition into a curve.

    Parameters
    ----------
    time : array_like (n,)
        s, uniform; from 1.5 s before ``start`` to 2.1 s after ``end``.
    lateral : array_like (n,)
        Lateral acceleration of the floor with the share of gravity that a tilted floor feels, m/s^2.
    roll_rate : array_like (n,)
        rad/s.
    start, end : float
        s, of the transition.
    posture : str
        ``"standing"`` or ``"seated"``.

    Returns
    -------
    CurveComfort

    Raises
    ------
    CriterionError
        The record does not cover the windows, sampled below 20 Hz.
    """
    table = data("comfort")["curve_transition"]
    if posture not in table:
        raise CriterionError(f"posture {posture!r}: there are {', '.join(table)}")
    found = gather(time, {"lateral": lateral, "roll_rate": roll_rate}, (), "")
    found.need(_WINDOW, 20.0, "P_CT")
    half = 0.5 * _WINDOW
    first, last = start - _BEFORE - half, end + _LATER + half
    if not start < end or found.time[0] > first + 1e-9 or found.time[-1] < last - 1e-9:
        raise CriterionError(f"a transition from {start:g} to {end:g} s needs the signals from {first:g} to {last:g} s; they cover "
                             f"{found.time[0]:.4g} to {found.time[-1]:.4g} s")
    middle, steady = sliding_mean(found.time, found.values["lateral"], _WINDOW, found.step)
    _, turning = sliding_mean(found.time, found.values["roll_rate"], _WINDOW, found.step)
    lag = int(round(_WINDOW / found.step))
    jerk = (steady[lag:] - steady[:-lag]) / _WINDOW
    maxima = (_largest(middle, steady, start, end + _LATER), _largest(middle[:-lag], jerk, start - _BEFORE, end),
              _largest(middle, turning, start, end))
    return CurveComfort(_percent(table[posture], *maxima), *maxima, posture, table[posture]["trust"])


def _largest(time, values, start, end):
    return float(np.abs(values[(time >= start - 1e-9) & (time <= end + 1e-9)]).max())


def _percent(constants, acceleration, jerk, roll_rate):
    a, b, c, d, e = (constants[key][0] for key in "ABCDE")
    return max(a * acceleration + b * jerk - c, 0.0) + d * float(np.degrees(roll_rate)) ** e
