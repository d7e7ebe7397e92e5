# SPDX-License-Identifier: BSD-3-Clause
"""Accelerations of the car body after UIC 518 / EN 14363: 0.4 to 10 Hz percentiles and r.m.s., quasi-static value."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.filters import Butterworth
from railsym.criteria.limits import Assessed, limits
from railsym.criteria.percentiles import percentile_analysis
from railsym.criteria.source import gather


@dataclass(frozen=True, eq=False)
class BodyAcceleration:
    """Percentile, r.m.s. and quasi-static value of each signal.

    Attributes
    ----------
    assessed : tuple of Assessed
        ``"peak NAME"``, ``"r.m.s. NAME"``, ``"quasi-static NAME"``.
    statistics : dict of str to SectionStatistics
        Of the peaks by section, under the channel's name.
    """

    assessed: tuple
    statistics: dict = field(repr=False)

    def __getitem__(self, name):
        return next(item for item in self.assessed if item.name == name)

    @property
    def message(self):
        """A line a value."""
        return "\n".join(map(str, self.assessed))

    def __str__(self):
        return self.message


def body_acceleration(source, signal=None, *, channels=("car*.ay", "car*.az"), band=None, sections=None, order=4, zero_phase=True,
                      distance=None, speed=None):
    """Peak (percentiles 0.15 and 99.85), r.m.s. and quasi-static body accelerations.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s.
    signal : array_like (n,) or dict, optional
        m/s^2, when ``source`` is time.
    channels : str or sequence of str
        Lateral ones end in ``.ay``, vertical ones in ``.az`` (limits of a coach).
    band : (float, float), optional
        Hz; 0.4 to 10 if not given.
    sections : float or sequence of (float, float), optional
        m, as for `railsym.criteria.percentile_analysis`; needs a distance.
    order, zero_phase : int, bool
        Of the Butterworth filters; the quasi-static value is the median of the 20 Hz low-passed signal.
    distance, speed : array_like or float, optional
        m, m/s.

    Returns
    -------
    BodyAcceleration

    Raises
    ------
    CriterionError
        As `railsym.criteria.instability`; 0.4 Hz needs 7.5 s.
    """
    found = gather(source, signal, channels, "m/s^2", distance=distance, speed=speed, needs_distance=sections is not None, name="car.ay")
    band = (limits("body_low").value, limits("body_high").value) if band is None else tuple(map(float, band))
    band_pass, low_pass = Butterworth(*band, order, zero_phase), Butterworth(0.0, limits("low_pass").value, order, zero_phase)
    both = (limits("low_percentile").value, limits("high_percentile").value)
    along = found.time if found.distance is None else found.distance
    assessed, statistics = [], {}
    for name, value in found.values.items():
        moving = band_pass.apply(value, found.rate, name)
        peaks = statistics[name] = percentile_analysis(along, moving, both, sections)
        assessed.append(Assessed(f"peak {name}", peaks.largest, "m/s^2", limits("body_peak")))
        rms = limits("body_rms_vertical" if name.endswith(".az") else "body_rms_lateral")
        assessed.append(Assessed(f"r.m.s. {name}", float(np.sqrt(np.mean(moving ** 2))), "m/s^2", rms))
        steady = float(np.median(low_pass.apply(value, found.rate, name)))
        assessed.append(Assessed(f"quasi-static {name}", steady, "m/s^2", None if name.endswith(".az") else limits("body_quasi_static")))
    return BodyAcceleration(tuple(assessed), statistics)


def acceleration_rms(time, values, band=(0.4, 10.0), order=4, zero_phase=True):
    """r.m.s. (m/s^2) of an acceleration (n,) in a band (Hz)."""
    found = gather(time, values, (), "m/s^2")
    moving = Butterworth(*band, order, zero_phase).apply(found.values["signal"], found.rate)
    return float(np.sqrt(np.mean(moving ** 2)))
