# SPDX-License-Identifier: BSD-3-Clause
"""Periodic signals: uniform sampling, frequency by a sine fit, samples on a grid of phases, the steady cycles."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

_JITTER = 1e-3          # of a step: below it samples count as uniform
_GAP = 1.6              # steps: a longer one is a gap
_SPLINED = 20           # steps: the longest gap that a spline fills
_STEADY = 0.003         # of the first harmonic: a cycle that differs by less belongs to the steady ones
FEWEST_CYCLES = 3


def uniform(time, channels):
    """Channels on a uniform grid of times.

    Parameters
    ----------
    time : ndarray (n,)
    channels : list of ndarray (n,)

    Returns
    -------
    step : float
    channels : ndarray (len(channels), m)
        Unchanged where the samples are uniform, else by a cubic spline.
    gap : float
        Length of the longest gap, in the unit of time; 0 without one.
    """
    steps, channels = np.diff(time), np.array(channels)
    step = float((time[-1] - time[0]) / (time.size - 1))
    largest = float(steps.max())
    if largest < _GAP * step and np.abs(time - time[0] - step * np.arange(time.size)).max() < _JITTER * step * np.sqrt(time.size):
        return step, channels, 0.0
    step = float(np.median(steps))
    gap = largest if largest > _GAP * step else 0.0
    from scipy.interpolate import CubicSpline

    grid = np.arange(time[0], time[-1], step)
    if gap > _SPLINED * step:
        # a spline through a long gap would swing far out; the gap is refused later, with its place
        return step, np.array([np.interp(grid, time, one) for one in channels]), gap
    return step, CubicSpline(time, channels, axis=1)(grid), gap


def block_means(channels, block):
    """Means (m, n // block) of blocks of samples, and the mean square of what is inside of the blocks of the second channel."""
    if block == 1:
        return channels, 0.0
    count = channels.shape[1] // block
    parts = channels[:, :count * block].reshape(len(channels), count, block)
    means = parts @ np.full(block, 1.0 / block)
    middle = parts[1].mean()                                # a force far from 0 would leave too few digits
    inside = parts[1] - middle
    left = float(np.vdot(inside, inside)) - block * float(np.sum((means[1] - middle) ** 2))
    return means, max(left, 0.0) / (count * block)


@lru_cache(maxsize=16)
def _window(n):
    return np.hanning(n)


def moving_part(displacement):
    """Slice without the bench at rest: from the first to the last sample beyond half of the amplitude, if that leaves out much."""
    low, high, n = displacement.min(), displacement.max(), displacement.size
    far = np.flatnonzero(np.abs(displacement - 0.5 * (low + high)) >= 0.25 * (high - low))
    # a sine leaves out less than a 30th of three cycles
    begin, end = int(far[0]), int(far[-1]) + 1
    return slice(begin if begin > 0.05 * n else 0, end if n - end > 0.05 * n else n)


def frequency_of(signal, step):
    """Frequency of the strongest component by the spectrum and a four-parameter sine fit (IEEE Std 1057), with a drift.

    Parameters
    ----------
    signal : ndarray (n,)
    step : float
        s.

    Returns
    -------
    frequency : float
        Hz; 0 for a signal without motion.
    phase : float
        rad, of the sine at the first sample.
    """
    turns = _turns(signal)
    means, time = _blocks(signal, step, turns // 2)
    peak = _strongest(means)
    if abs(peak - 0.5 * turns) > max(2.0, 0.2 * peak):      # an outlier or much else than a sine: by the whole spectrum
        means, time = _blocks(signal, step, int(_strongest(signal)))
        peak = _strongest(means)
    return _sine_fit(means, time, peak) if peak else (0.0, 0.0)


def _blocks(signal, step, cycles):
    """Means of blocks of samples, some 40 a cycle, and their times: as good as all samples, and quick."""
    block = max(1, signal.size // (40 * max(1, cycles)))
    count = signal.size // block
    time = step * (block * np.arange(count) + 0.5 * (block - 1))
    return (signal[:block * count].reshape(-1, block) @ np.full(block, 1.0 / block) if block > 1 else signal), time


def _strongest(signal):
    """Cycles of the strongest line of the spectrum, between lines by a parabola; 0 for no motion."""
    power = np.abs(np.fft.rfft((signal - signal.mean()) * _window(signal.size)))
    peak = int(np.argmax(power[1:])) + 1
    return peak + _parabola(power, peak) if power[peak] > 0.0 else 0.0


def _sine_fit(signal, time, cycles):
    """Frequency (Hz) and phase (rad) of sine, constant and drift by Gauss-Newton, from a number of cycles."""
    line = 2.0 * np.pi / (time.size * (time[1] - time[0]))
    angular, basis = cycles * line, np.ones((5, time.size))
    basis[3] = np.linspace(-1.0, 1.0, time.size)
    cosine = sine = None
    for _ in range(4):
        basis[0], basis[1] = np.cos(angular * time), np.sin(angular * time)
        if sine is None:
            cosine, sine = np.linalg.solve(basis[:4] @ basis[:4].T, basis[:4] @ signal)[:2]
        basis[4] = time * (sine * basis[0] - cosine * basis[1])
        table, wanted = basis @ basis.T, basis @ signal
        scale = np.sqrt(table.diagonal()) + 1e-300
        table = table / scale / scale[:, None]
        table.flat[::6] += 1e-13                            # no slope without a sine
        cosine, sine, _, _, change = np.linalg.solve(table, wanted / scale) / scale
        # half a line of the spectrum at most: beyond it the fit has left its peak
        change = max(-0.5 * line, min(0.5 * line, float(change)))
        angular += change
        if abs(change) < 1e-7 * line:
            break
    return float(angular / (2.0 * np.pi)), float(np.arctan2(cosine, sine))


def _turns(signal):
    """How often the signal goes from beyond a quarter of its range on one side of the middle to the same on the other."""
    low, high = signal.min(), signal.max()
    middle, far = 0.5 * (low + high), 0.25 * (high - low)
    side = signal[np.abs(signal - middle) >= far] > middle
    return int(np.count_nonzero(side[1:] != side[:-1]))


def _parabola(power, peak):
    """Place of the maximum between lines of the spectrum, in lines."""
    if not 0 < peak < power.size - 1 or min(power[peak - 1:peak + 2]) <= 0.0:
        return 0.0
    left, middle, right = np.log(power[peak - 1:peak + 2])
    return float(np.clip(0.5 * (left - right) / (left - 2.0 * middle + right), -0.5, 0.5))


def on_phases(channels, step, frequency, phase):
    """Samples of all whole cycles up to the end of the record.

    Parameters
    ----------
    channels : ndarray (m, n)
        Uniform samples, ``step`` s apart.
    frequency, phase : float
        Hz, and phase in rad of the displacement's sine at the first sample.

    Returns
    -------
    ndarray (m, cycles, samples_per_cycle)
        Each cycle begins at the same phase.
    start : int
        Sample of the cycle at which the displacement passes 0 upwards.
    first : float
        Place of the first sample of the first cycle among the uniform samples.
    """
    count = samples_per_cycle(step, frequency)
    per_step = count * frequency * step                       # new samples per old one, near 1
    zero = -phase / (2.0 * np.pi) * count / per_step          # old sample at which the sine is 0
    # up to half a sample beyond the ends, so that ten cycles of samples are ten cycles
    last = int(np.floor((channels.shape[1] - 1 - zero) * per_step + 0.5))
    first = int(np.ceil(-zero * per_step - 0.5))
    cycles = (last - first + 1) // count
    index = np.arange(last + 1 - cycles * count, last + 1)
    place = zero + index / per_step
    found = _lagrange(channels, place).reshape(len(channels), cycles, count)
    return (found, int(-index[0] % count), float(place[0])) if cycles else (found, 0, 0.0)


def samples_per_cycle(step, frequency):
    """The even number of samples in a cycle that is nearest to the sampling."""
    return 2 * int(round(0.5 / (frequency * step)))


def _lagrange(channels, place):
    """Cubic interpolation between uniform samples; its error is 0.023 (omega step)^4."""
    left = np.clip(np.floor(place).astype(int), 1, channels.shape[1] - 3)
    t = place - left
    weights = (-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6)
    return sum(weight * np.take(channels, left + shift, axis=1) for shift, weight in zip((-1, 0, 1, 2), weights))


def steady_cycles(channels):
    """First and last of the steady cycles.

    A cycle is steady when the first harmonics of the channels differ from their medians over the last 60 % of the cycles, and
    its means from the line through theirs, by less than 0.3 % of the first harmonic or three times their scatter.

    Parameters
    ----------
    channels : ndarray (m, cycles, samples_per_cycle)

    Returns
    -------
    slice
    departure : float
        Largest departure left, as a part of the first harmonic.
    """
    cycles, count = channels.shape[1:]
    wave = np.exp(-2j * np.pi * np.arange(count) / count) * (2.0 / count)
    first, mean, number = channels @ wave, channels.mean(axis=2), np.arange(cycles)
    late = slice(int(0.4 * cycles), cycles)
    reference = _median(first.real[:, late]) + 1j * _median(first.imag[:, late])
    at = number - number[late].mean()
    tilt = mean[:, late] @ at[late] / (at[late] @ at[late]) if cycles > 5 else np.zeros(len(mean))
    line = mean[:, late].mean(axis=1)[:, None] + tilt[:, None] * at
    size = np.abs(reference)
    departure = np.maximum(np.abs(first - reference[:, None]), np.abs(mean - line)) / np.where(size > 0.0, size, 1.0)[:, None]
    limit = np.maximum(_STEADY, 3.0 * _median(departure[:, late]) / 0.83)
    bad = (departure > limit[:, None]).any(axis=0)
    begin = 1 + int(np.flatnonzero(bad[:cycles // 2])[-1]) if bad[:cycles // 2].any() else 0
    middle = max(begin, cycles // 2)
    end = middle + int(np.flatnonzero(bad[middle:])[0]) if bad[middle:].any() else cycles
    if end - begin < FEWEST_CYCLES:                             # then the last ones, whatever they are
        begin, end = max(0, cycles - FEWEST_CYCLES), cycles
    return slice(begin, end), float((departure[:, begin:end] / limit[:, None]).max() * _STEADY)


def _median(rows):
    """Median of each row; `numpy.median` takes ten times as long for so few."""
    ordered, count = np.sort(rows, axis=1), rows.shape[1]
    return 0.5 * (ordered[:, (count - 1) // 2] + ordered[:, count // 2])
