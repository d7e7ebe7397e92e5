# SPDX-License-Identifier: BSD-3-Clause
"""Sliding mean and r.m.s. over distance."""

from __future__ import annotations

import numpy as np

from railsym.criteria.errors import CriterionError


def sliding_mean(distance, values, length=2.0, step=0.5):
    """Mean over a window of distance, exact for a signal that is linear between its samples.

    Parameters
    ----------
    distance, values : array_like (n,)
        m, strictly increasing.
    length, step : float
        m, of the window, and between windows.

    Returns
    -------
    middle, mean : ndarray (m,)
        Middle of each window (m), mean there; windows lie wholly within the record.

    Raises
    ------
    CriterionError
        The record is shorter than one window.
    """
    distance, values = np.asarray(distance, dtype=float), np.asarray(values, dtype=float)
    starts = _starts(distance, length, step)
    total = _integral(distance, values, np.concatenate((starts, starts + length)))
    return starts + 0.5 * length, (total[starts.size:] - total[:starts.size]) / length


def sliding_rms(distance, values, length=100.0, step=10.0):
    """Root of the mean square over a window of distance; as `sliding_mean`."""
    middle, mean = sliding_mean(distance, np.square(np.asarray(values, dtype=float)), length, step)
    return middle, np.sqrt(np.maximum(mean, 0.0))  # a mean square of zeros may be -1e-17


def _starts(distance, length, step):
    if not (length > 0.0 and step > 0.0):
        raise CriterionError(f"window {length:g} m every {step:g} m: both must be above 0")
    covered = distance[-1] - distance[0]
    if covered < length * (1 - 1e-9):
        raise CriterionError(f"a window of {length:g} m needs at least that distance; the record covers {covered:.4g} m")
    return distance[0] + step * np.arange(int(np.floor((covered - length) / step * (1 + 1e-12) + 1e-9)) + 1)


def _integral(distance, values, places):
    """Integral from the first place to each of ``places``, of the signal joined by straight lines."""
    gaps = np.diff(distance)
    sums = np.concatenate(([0.0], np.cumsum(0.5 * gaps * (values[1:] + values[:-1]))))
    before = np.clip(np.searchsorted(distance, places, side="right") - 1, 0, gaps.size - 1)
    run = np.clip(places - distance[before], 0.0, gaps[before])
    slope = np.diff(values)[before] / gaps[before]
    return sums[before] + run * (values[before] + 0.5 * slope * run)
