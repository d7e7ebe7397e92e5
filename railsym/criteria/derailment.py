# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces after UIC 518 / EN 14363: Y/Q, sum of Y (track shift), wheel loads, unloading, quasi-static values."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.filters import Butterworth
from railsym.criteria.limits import Assessed, limits, sum_Y_limit, wheel_load_limit
from railsym.criteria.percentiles import percentile_analysis
from railsym.criteria.sliding import sliding_mean
from railsym.criteria.source import gather

_WHEEL = re.compile(r"(?P<wheelset>.+)\.(?P<side>left|right)\.Q")


@dataclass(frozen=True, eq=False)
class Derailment:
    """Quantities by wheel and wheelset.

    Attributes
    ----------
    assessed : tuple of Assessed
        ``"Y/Q wheelset1.left"``, ``"sum Y wheelset1"``, ``"Q ..."``, ``"unloading ..."``, ``"Y quasi-static ..."``, ``"Q quasi-static ..."``.
    statistics : dict of str to SectionStatistics
        Percentiles by section behind each of them, under the same names.
    distance, signals : dict of str to ndarray
        Sliding means of Y/Q (-) and of sum Y (N), under the same names; distances in m.
    wheel_load : dict of str to float
        Q0 of each wheel, N.
    notes : tuple of str
        Assumptions and findings.
    """

    assessed: tuple
    statistics: dict = field(repr=False)
    distance: dict = field(repr=False)
    signals: dict = field(repr=False)
    wheel_load: dict = field(repr=False)
    notes: tuple = ()

    def __getitem__(self, name):
        for item in self.assessed:
            if item.name == name:
                return item
        raise CriterionError(f"there is no {name!r}; there are {', '.join(item.name for item in self.assessed)}")

    def worst(self, quantity):
        """The wheel or wheelset with the largest modulus of a quantity, such as ``"Y/Q"`` or ``"sum Y"``.

        Returns
        -------
        Assessed
        """
        found = [item for item in self.assessed if item.name.rpartition(" ")[0] == quantity]
        if not found:
            kinds = dict.fromkeys(item.name.rpartition(" ")[0] for item in self.assessed)
            raise CriterionError(f"there is no quantity {quantity!r}; there are {', '.join(kinds)}")
        return max(found, key=lambda item: abs(item.value))

    @property
    def message(self):
        """The worst of each quantity, a line each, and the notes."""
        kinds = dict.fromkeys(item.name.rpartition(" ")[0] for item in self.assessed)
        return "\n".join([*(str(self.worst(kind)) for kind in kinds), *self.notes])

    def __str__(self):
        return self.message

    def plot(self, quantity="Y/Q", *, axes=None):
        """Draw the sliding means of ``"Y/Q"`` or ``"sum Y"`` over distance with the limit; returns the axes."""
        from railsym.plots.criteria import plot_sliding

        return plot_sliding(self, quantity, axes=axes)


def derailment(run, *, wheels="*.Q", wheel_load=None, k1=None, vehicle_speed=None, radius=None, sections=None, order=4, zero_phase=True,
               distance=None, speed=None):
    """Assess the wheel-rail forces of a run.

    Parameters
    ----------
    run : Run
        With ``WHEELSET.left.Q``, ``.Y`` and ``.right...`` in N (and ``WHEELSET.sum_Y`` if it differs from the sum of the two).
    wheels : str or sequence of str
        Patterns of the channels Q.
    wheel_load : float or dict of str to float, optional
        Static load Q0 of a wheel, N, one or by wheel; ``run.info.extra["wheel_loads"]`` if not given, else the median of Q.
    k1 : float, optional
        As for `railsym.criteria.limits.sum_Y_limit`.
    vehicle_speed : float, optional
        Highest speed of the vehicle, m/s, for the limit of Q.
    radius : float, optional
        m, of the curve: the quasi-static limits hold in curves only. On straight track leave it out.
    sections : float or sequence of (float, float), optional
        m, as for `railsym.criteria.percentile_analysis`; the whole run if not given.
    order, zero_phase : int, bool
        Of the 20 Hz Butterworth low-pass.
    distance, speed : array_like or float, optional
        m, m/s; the run's ``s`` and ``V`` if not given.

    Returns
    -------
    Derailment

    Raises
    ------
    CriterionError
        Not finite, too short, sampled below 100 Hz, another unit, a wheel without Y.

    Notes
    -----
    Y/Q is the ratio of the low-passed forces, with either sign of Y. Where the low-passed Q is not above 0 the wheel has lifted:
    windows that contain such a sample have an infinite Y/Q. Wheelsets are taken one after the other: of a run that is left in its
    file some twelve channels are in memory at once, and two numbers a wheel or wheelset and 0.5 m in the result.
    """
    names = _wheels(run, wheels)
    low_pass = Butterworth(0.0, limits("low_pass").value, order, zero_phase)
    given, notes = _given_loads(run, names, wheel_load)
    work = _Work(sections, notes)
    for wheelset in dict.fromkeys(wheel.rpartition(".")[0] for wheel in names):      # one at a time: a run in a file may be long
        own = [wheel for wheel in names if wheel.rpartition(".")[0] == wheelset]
        found = gather(run, None, [f"{wheel}.{force}" for wheel in own for force in "QY"], "N", distance=distance, speed=speed, needs_distance=True)
        work.distance = distance = found.distance if work.distance is None else work.distance
        smooth = {name: low_pass.apply(value, found.rate, name) for name, value in found.values.items()}
        work.wheelset(run, wheelset, own, smooth, low_pass, found.rate, given, k1, vehicle_speed, radius)
    return Derailment(work.in_order(), work.statistics, work.places, work.signals, work.static, tuple(work.notes))


class _Work:
    """Collects the assessed quantities of one run."""

    def __init__(self, sections, notes):
        self.distance, self.sections, self.notes = None, sections, notes
        self.assessed, self.statistics, self.places, self.signals, self.static = [], {}, {}, {}, {}
        self.mean = (limits("mean_length").value, limits("mean_step").value)
        self.both = (limits("low_percentile").value, limits("high_percentile").value)

    def wheelset(self, run, wheelset, wheels, smooth, low_pass, rate, given, k1, vehicle_speed, radius):
        """All quantities of one wheelset, from its low-passed forces."""
        for wheel in wheels:
            self.static[wheel] = float(np.median(smooth[f"{wheel}.Q"])) if given is None else given[wheel]
            self.ratio(wheel, smooth)
            self.loads(wheel, smooth[f"{wheel}.Q"], self.static[wheel], vehicle_speed)
            self.quasi_static(wheel, smooth, radius)
        self.sum_of_Y(run, wheelset, wheels, smooth, low_pass, rate, k1)

    def in_order(self):
        """Assessed quantities: all of one kind together, Y/Q first."""
        kinds = [("Y/Q",), ("sum Y",), ("Q", "unloading"), ("Y quasi-static", "Q quasi-static")]
        return tuple(item for group in kinds for item in self.assessed if item.name.rpartition(" ")[0] in group)

    def add(self, name, distance, values, unit, percentiles, limit):
        found = percentile_analysis(distance, values, percentiles, self.sections)
        self.statistics[name] = found
        self.assessed.append(Assessed(name, found.largest, unit, limit))

    def sliding(self, name, values):
        places, self.signals[name] = sliding_mean(self.distance, values, *self.mean)
        self.places[name] = next(iter(self.places.values()), places)      # the same for all

    def ratio(self, wheel, smooth):
        name, load = f"Y/Q {wheel}", smooth[f"{wheel}.Q"]
        lifted = load <= 0.0
        self.sliding(name, np.divide(smooth[f"{wheel}.Y"], load, out=np.zeros_like(load), where=~lifted))
        if lifted.any():
            at = self.distance[int(np.argmax(lifted))]
            self.notes.append(f"{wheel} lifts at s = {at:.2f} m: Y/Q has no value there and counts as infinite")
            _, share = sliding_mean(self.distance, lifted.astype(float), *self.mean)
            self.signals[name] = np.where(share > 0.0, np.inf, self.signals[name])
        self.add(name, self.places[name], self.signals[name], "-", self.both, limits("YQ"))

    def sum_of_Y(self, run, wheelset, own, smooth, low_pass, rate, k1):
        name = f"sum Y {wheelset}"
        if f"{wheelset}.sum_Y" in run:
            given = gather(run, None, f"{wheelset}.sum_Y", "N").values[f"{wheelset}.sum_Y"]
            total = low_pass.apply(given, rate, f"{wheelset}.sum_Y")
        elif len(own) == 2:
            total = smooth[f"{own[0]}.Y"] + smooth[f"{own[1]}.Y"]
        else:
            self.notes.append(f"{wheelset}: only {own[0]} is there and no {wheelset}.sum_Y, so no sum of Y")
            return
        self.sliding(name, total)
        limit = sum_Y_limit(float(np.mean([self.static[wheel] for wheel in own])), k1)
        self.add(name, self.places[name], self.signals[name], "N", self.both, limit)

    def loads(self, wheel, load, static, vehicle_speed):
        limit = None if vehicle_speed is None else wheel_load_limit(static, vehicle_speed)
        self.add(f"Q {wheel}", self.distance, load, "N", self.both[1:], limit)
        self.add(f"unloading {wheel}", self.distance, 1.0 - load / static, "-", self.both[1:], None)

    def quasi_static(self, wheel, smooth, radius):
        bounds = (None, None) if radius is None else (quasi_static_Y_limit(radius), limits("Q_quasi_static"))
        for force, limit in zip("YQ", bounds):
            self.add(f"{force} quasi-static {wheel}", self.distance, smooth[f"{wheel}.{force}"], "N", (50.0,), limit)


def _wheels(run, patterns):
    names = run.channels.require(*((patterns,) if isinstance(patterns, str) else patterns))
    wheels = [name[:-2] for name in names if _WHEEL.fullmatch(name)]
    if not wheels:
        raise CriterionError(f"wheels {patterns!r}: names such as wheelset1.left.Q are needed; these fit: {', '.join(names)}")
    return wheels


def _given_loads(run, wheels, given):
    """Static load of each wheel (N) if it is given, and what is assumed without it."""
    given = run.info.extra.get("wheel_loads") if given is None else given
    if given is None:
        return None, ["static wheel loads Q0 are the medians of Q: none were given (wheel_load=...)"]
    loads = {wheel: given for wheel in wheels} if np.ndim(given) == 0 and not isinstance(given, dict) else given
    for wheel in wheels:
        if wheel not in loads:
            raise CriterionError(f"wheel_load has no entry for {wheel}; it has {', '.join(loads)}")
        if not 0.0 < loads[wheel] < np.inf:
            raise CriterionError(f"static load of {wheel}: {loads[wheel]} N; it must be above 0")
    return {wheel: float(loads[wheel]) for wheel in wheels}, []


def quasi_static_Y_limit(radius):
    """Largest quasi-static Y (N) in a curve of a radius (m): 60 kN, in narrow curves 30 kN + 10500 kN m/R.

    Returns
    -------
    Limit

    Raises
    ------
    CriterionError
        Radius 0.
    """
    if not abs(radius) > 0.0:
        raise CriterionError("radius = 0 m: give the radius of the curve, or leave it out on straight track")
    fixed, offset, slope = limits("Y_quasi_static"), limits("Y_quasi_static_offset"), limits("Y_quasi_static_slope")
    # the newer rule a + b/R gives more than the older 60 kN below 350 m only; the larger one is the later allowance
    value = max(fixed.value, offset.value + slope.value / abs(radius))
    return offset.derived(value, "N", "60 kN, in narrow curves 30 kN + 10500 kN m/R", fixed, slope)
