# SPDX-License-Identifier: BSD-3-Clause
"""Instability by sliding r.m.s.: of sum Y (normal method) or of the frame's acceleration (simplified method), EN 14363 / UIC 518."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.filters import Butterworth
from railsym.criteria.hunting import dominant_frequency
from railsym.criteria.limits import Assessed, limits, sum_Y_limit
from railsym.criteria.sliding import sliding_rms
from railsym.criteria.source import gather

SUM_Y, FRAME = "*.sum_Y", "*.above_*.ay"
_SEARCH = (2.5, 10.0)  # Hz, where the frequency of the instability is looked for; f0 - 2 Hz must stay above 0


@dataclass(frozen=True, eq=False)
class InstabilityRms:
    """Sliding r.m.s. of each signal in the band f0 +- 2 Hz.

    Attributes
    ----------
    frequency_hz : float
        f0.
    assessed : tuple of Assessed
        Largest sliding r.m.s. of each signal, against its limit where there is one.
    places : tuple of float
        Middle of the window of the largest value, m.
    distance, rms : dict of str to ndarray (m,)
        The sliding r.m.s. over distance.
    """

    frequency_hz: float
    assessed: tuple
    places: tuple
    distance: dict = field(repr=False)
    rms: dict = field(repr=False)

    @property
    def message(self):
        """The largest value in a sentence."""
        worst = max(self.assessed, key=lambda item: item.value)
        return f"band {self.frequency_hz - 2:.3g} to {self.frequency_hz + 2:.3g} Hz: {worst}"

    def __str__(self):
        return "\n".join([f"sliding r.m.s. in f0 +- 2 Hz, f0 = {self.frequency_hz:.3g} Hz",
                          *(f"{item} (s = {place:.1f} m)" for item, place in zip(self.assessed, self.places))])


def instability_rms(source, signal=None, *, method="sum_Y", channels=None, frequency=None, wheel_load=None, k1=None, bogie_mass=None, distance=None,
                    speed=None, length=None, step=None, order=4, zero_phase=True):
    """Sliding r.m.s. of sum Y or of the frame's lateral acceleration in the band about the instability's frequency.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s.
    signal : array_like (n,) or dict, optional
        N or m/s^2, when ``source`` is time.
    method : str
        ``"sum_Y"`` (normal method) or ``"acceleration"`` (simplified method).
    channels : str or sequence of str, optional
        ``*.sum_Y`` or ``*.above_*.ay`` if not given.
    frequency : float, optional
        f0, Hz; the dominant frequency between 2.5 and 10 Hz of the strongest signal if not given.
    wheel_load : float, optional
        Static load Q0 of a wheel, N: for the limit of sum Y.
    k1 : float, optional
        As for `railsym.criteria.limits.sum_Y_limit`.
    bogie_mass : float, optional
        kg, with its wheelsets: for the limit of the acceleration.
    distance, speed : array_like or float, optional
        m, m/s; the run's ``s`` and ``V`` if not given.
    length, step : float, optional
        m; 100 and 10 if not given.
    order, zero_phase : int, bool
        Of the Butterworth band-pass.

    Returns
    -------
    InstabilityRms

    Raises
    ------
    CriterionError
        As `railsym.criteria.instability`; less distance than one window; a frequency of 2 Hz or less.
    """
    if method not in ("sum_Y", "acceleration"):
        raise CriterionError(f"method {method!r}: there are 'sum_Y' and 'acceleration'")
    force = method == "sum_Y"
    unit = "N" if force else "m/s^2"
    found = gather(source, signal, channels or (SUM_Y if force else FRAME), unit, distance=distance, speed=speed, needs_distance=True, name=method)
    if frequency is None:
        frequency = dominant_frequency(found, _SEARCH).frequency_hz
    half = limits("half_band").value
    if not frequency > half:
        raise CriterionError(f"f0 = {frequency:.4g} Hz: the band f0 +- {half:g} Hz needs f0 above {half:g} Hz; "
                             "for slower motions look at the channels themselves")
    band_pass = Butterworth(frequency - half, frequency + half, order, zero_phase)
    length = limits("rms_length").value if length is None else float(length)
    step = limits("rms_step").value if step is None else float(step)
    limit = _force_limit(wheel_load, k1) if force else _acceleration_limit(bogie_mass)
    middles, rms = {}, {}
    for name, value in found.values.items():
        middles[name], rms[name] = sliding_rms(found.distance, band_pass.apply(value, found.rate, name), length, step)
    places = tuple(float(middles[name][np.argmax(rms[name])]) for name in rms)
    assessed = tuple(Assessed(f"r.m.s. {name}", float(rms[name].max()), unit, limit) for name in rms)
    return InstabilityRms(float(frequency), assessed, places, middles, rms)


def _force_limit(wheel_load, k1):
    if wheel_load is None:
        return None
    share, whole = limits("sum_Y_rms_share"), sum_Y_limit(wheel_load, k1)
    return whole.derived(share.value * whole.value, "N", "half of k1 (10 kN + 2 Q0/3)", share)


def _acceleration_limit(bogie_mass):
    if bogie_mass is None:
        return None
    constant, slope = limits("frame_rms_constant"), limits("frame_rms_slope")
    value = 0.5 * (constant.value - slope.value * bogie_mass / 1e3)
    if not value > 0.0:
        raise CriterionError(f"bogie_mass = {bogie_mass:g} kg: the limit (12 - m/5)/2 m/s^2, m in t, has no meaning above 60 t; give kg")
    return constant.derived(value, "m/s^2", "(12 - m/5)/2, m in t", slope)
