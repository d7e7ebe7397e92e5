# SPDX-License-Identifier: BSD-3-Clause
"""Amplitude spectrum of a channel, with its dominant frequency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import optimize, signal

from railsym.results.errors import ResultError
from railsym.results.run import uniform_step


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Single-sided amplitude spectrum: a sine of amplitude A at f gives A at f.

    Attributes
    ----------
    frequency, amplitude : ndarray (m,)
        Hz; in ``unit``.
    unit, channel : str
    band : tuple of float
        Hz, in which the dominant frequency was looked for.
    dominant_hz, dominant_amplitude : float
        Of the highest peak in the band, between the lines of the spectrum; nan when the signal is constant there.
    resolution_hz : float
        Two sines nearer to each other than this are not told apart.
    """

    frequency: np.ndarray
    amplitude: np.ndarray
    unit: str
    channel: str
    band: tuple
    dominant_hz: float
    dominant_amplitude: float
    resolution_hz: float

    @property
    def message(self):
        """The dominant frequency in words."""
        where = f"between {self.band[0]:.3g} and {self.band[1]:.3g} Hz"
        if not np.isfinite(self.dominant_hz):
            return f"{self.channel}: nothing moves {where}"
        return f"{self.channel}: {self.dominant_hz:.3f} Hz dominates {where}, amplitude {self.dominant_amplitude:.4g} {self.unit}"

    def plot(self, *, axes=None):
        """Draw; returns the Matplotlib axes."""
        from railsym.plots.runs import plot_spectrum

        return plot_spectrum(self, axes=axes)


def spectrum_of(run, channel, band=None, window="hann"):
    """Spectrum of a channel of a run; see `amplitude_spectrum`."""
    return amplitude_spectrum(run.time, run[channel], band, window, unit=run.unit(channel), name=channel)


def amplitude_spectrum(time, values, band=None, window="hann", *, unit="", name="signal"):
    """Amplitude spectrum of a signal less its mean.

    Parameters
    ----------
    time, values : array_like (n,)
        s, uniform; finite.
    band : (float, float), optional
        Hz, where the dominant frequency is looked for; from two lines above 0 to half of the sampling rate if not given.
    window : str or tuple
        As for ``scipy.signal.get_window``.
    unit, name : str

    Returns
    -------
    Spectrum

    Raises
    ------
    ResultError
        Not uniform, not finite, less than 16 samples, or a band that the signal is too short or sampled too slowly for.
    """
    time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    step = uniform_step(time)
    if values.size < 16:
        raise ResultError(f"{name}: {values.size} samples give no spectrum; at least 16 are needed")
    if not np.isfinite(values).all():
        raise ResultError(f"{name} is not finite at t = {time[np.argmin(np.isfinite(values))]:.6g} s")
    weights = signal.get_window(window, values.size)
    resolution = 1.0 / (step * values.size)
    band = (2 * resolution, 0.5 / step) if band is None else tuple(map(float, band))
    _check_band(name, band, step, values.size)
    moving = (values - np.average(values, weights=weights)) * weights * (2.0 / weights.sum())
    lines = np.abs(np.fft.rfft(moving))
    lines[0] *= 0.5
    frequency = np.fft.rfftfreq(values.size, step)
    peak, height = _dominant(moving, step, frequency, lines, band)
    return Spectrum(frequency, lines, unit, name, band, peak, height, 2 * resolution)


def _check_band(name, band, step, count):
    low, high = band
    if not 0.0 <= low < high:
        raise ResultError(f"{name}: band {band} Hz: two frequencies in ascending order are needed")
    if high > 0.5 / step * (1 + 1e-9):
        raise ResultError(f"{name} is sampled at {1 / step:.6g} Hz; a band up to {high:g} Hz needs at least {2 * high:g} Hz")
    # a Hann window's main lobe is two lines to either side
    if high - low < 2.0 / (step * count):
        raise ResultError(f"{name} is {step * count:.4g} s long; to look between {low:g} and {high:g} Hz "
                          f"at least {2.0 / (high - low):.4g} s are needed")


def _dominant(moving, step, frequency, lines, band):
    inside = np.flatnonzero((frequency >= band[0]) & (frequency <= band[1]) & (frequency > 0))
    if not inside.size or not lines[inside].max() > 0.0:
        return np.nan, np.nan
    first = frequency[inside[np.argmax(lines[inside])]]
    turns = -2j * np.pi * step * np.arange(moving.size)

    def height(f):
        return float(np.abs(np.exp(turns * f) @ moving))

    bounds = max(band[0], first - frequency[1]), min(band[1], first + frequency[1])
    found = optimize.minimize_scalar(lambda f: -height(f), bounds=bounds, method="bounded", options={"xatol": 1e-6 * frequency[1]})
    best = found.x if -found.fun >= height(first) else first
    return float(best), height(best)
