# SPDX-License-Identifier: BSD-3-Clause
"""Butterworth filters whose cut-offs hold for the signal that comes out, with or without phase."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt, tan

import numpy as np
from scipy import signal as scipy_signal

from railsym.criteria.errors import CriterionError

_RATE = 5.0      # samples in a period of the upper cut-off: at 4 the bilinear transform bends the skirt above it by 10 %
_PERIODS = 3.0   # of the lower cut-off: the ends of a record reach about one period into it


@dataclass(frozen=True)
class Butterworth:
    """Low-pass (low = 0) or band-pass filter, -3 dB at its cut-offs.

    With ``zero_phase`` a filter of half the order runs forward and backward (SciPy's sosfiltfilt): the signal is not shifted in
    time. Its cut-offs are moved so that the two runs together have -3 dB at ``low`` and ``high``, and together the slope of ``order``.

    Parameters
    ----------
    low, high : float
        Hz.
    order : int
        Even with zero_phase. 4: 24 dB an octave beyond a cut-off.
    zero_phase : bool

    Raises
    ------
    CriterionError
        Cut-offs that are no band, an order that cannot be.
    """

    low: float
    high: float
    order: int = 4
    zero_phase: bool = True

    def __post_init__(self):
        if not 0.0 <= self.low < self.high < np.inf:
            raise CriterionError(f"band {self.low:g} to {self.high:g} Hz: 0 <= low < high is needed")
        if self.order < 1 or self.order != int(self.order) or (self.zero_phase and self.order % 2):
            raise CriterionError(f"order {self.order}: a whole number above 0 is needed, an even one with zero_phase")

    @property
    def shortest(self):
        """Shortest record, s."""
        return _PERIODS / (self.low or self.high)

    @property
    def slowest(self):
        """Lowest sampling rate, Hz."""
        return _RATE * self.high

    def __str__(self):
        band = f"{self.low:g} to {self.high:g} Hz" if self.low else f"below {self.high:g} Hz"
        return f"Butterworth {band}, order {self.order}, {'zero phase' if self.zero_phase else 'causal'}"

    def sections(self, rate):
        """Second-order sections at a sampling rate (Hz), of one run of the filter."""
        order, widening = self.order, 1.0
        if self.zero_phase:
            order //= 2
            # |H|^2 = 1/(1 + W^(2n)) = 1/sqrt(2) for one of two runs: W = (sqrt(2) - 1)^(1/2n) where both together have -3 dB
            widening = (sqrt(2.0) - 1.0) ** (-0.5 / order)
        low, high = (2.0 * rate * tan(pi * f / rate) for f in (self.low, self.high))
        if not self.low:
            analogue = scipy_signal.butter(order, high * widening, analog=True, output="zpk")
        else:
            centre, half = sqrt(low * high), 0.5 * widening * (high - low)
            edge = sqrt(half * half + centre * centre)  # edges with the same product and a wider difference
            analogue = scipy_signal.butter(order, (edge - half, edge + half), "bandpass", analog=True, output="zpk")
        return scipy_signal.zpk2sos(*scipy_signal.bilinear_zpk(*analogue, fs=rate))

    def apply(self, values, rate, what="signal"):
        """Filter a signal.

        Parameters
        ----------
        values : array_like (n,)
        rate : float
            Hz.

        Returns
        -------
        ndarray (n,)

        Raises
        ------
        CriterionError
            Too short, or sampled too slowly.
        """
        values = np.asarray(values, dtype=float)
        if rate < self.slowest * (1 - 1e-6):
            raise CriterionError(f"{what}: filter {self} needs a sampling rate of at least {self.slowest:g} Hz; the signal has {rate:.5g} Hz")
        if (values.size - 1) / rate < self.shortest * (1 - 1e-9):
            raise CriterionError(f"{what}: filter {self} needs at least {self.shortest:.4g} s; the signal is {(values.size - 1) / rate:.4g} s long")
        sections = self.sections(rate)
        if not self.zero_phase:
            # started as if the signal had stood at its first value for ever
            return scipy_signal.sosfilt(sections, values, zi=scipy_signal.sosfilt_zi(sections) * values[0])[0]
        pad = min(values.size - 1, int(np.ceil(self.shortest * rate)))
        return scipy_signal.sosfiltfilt(sections, values, padlen=pad)

    def response(self, frequency, rate):
        """Complex response at frequencies (Hz), both runs together.

        Returns
        -------
        ndarray, complex
        """
        _, one = scipy_signal.freqz_sos(self.sections(rate), worN=np.asarray(frequency, dtype=float), fs=rate)
        return np.abs(one) ** 2 + 0j if self.zero_phase else one
