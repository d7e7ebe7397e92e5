# SPDX-License-Identifier: BSD-3-Clause
"""The paper's instability criterion, citing UIC 518: six consecutive cycles over 8.0 m/s^2 above an axlebox, 4 to 8 Hz.

A **half-wave** is the band-passed signal between two zero crossings, its peak the largest modulus there. A **cycle** is two
half-waves that follow each other: consecutive alternating peaks. N consecutive cycles over the limit are 2 N consecutive half-waves
whose peaks all exceed it. What lies before the first and after the last zero crossing is no whole half-wave and does not count.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.filters import Butterworth
from railsym.criteria.limits import Assessed, Limit, limits
from railsym.criteria.source import gather

CHANNELS = "*.above_*.ay"


@dataclass(frozen=True, eq=False)
class AxleboxStability:
    """The criterion above one axlebox.

    Attributes
    ----------
    channel : str
    unstable : bool
    cycles : float
        Longest run of consecutive cycles over the limit, in halves.
    peak : float
        Largest modulus of the band-passed acceleration, m/s^2.
    sustained : float
        The level that the required cycles reached: the limit could be this high and the verdict "unstable" would just be missed,
        m/s^2; 0 when there are fewer half-waves.
    time, distance : float or None
        First peak of the first run that is long enough, s and m (None without distance).
    detected : float or None
        Last peak that the run needed, s: the moment at which the criterion is met.
    """

    channel: str
    unstable: bool
    cycles: float
    peak: float
    sustained: float
    time: float | None
    distance: float | None
    detected: float | None


@dataclass(frozen=True, eq=False)
class Instability:
    """The criterion above every axlebox.

    Attributes
    ----------
    axleboxes : tuple of AxleboxStability
    limit : Limit
        m/s^2.
    required : int
        Consecutive cycles.
    band : (float, float)
        Hz.
    filtered : dict of str to ndarray (n,)
        Band-passed accelerations, m/s^2.
    run_time : ndarray (n,)
        s.
    """

    axleboxes: tuple
    limit: Limit
    required: int
    band: tuple
    filtered: dict = field(repr=False)
    run_time: np.ndarray = field(repr=False)

    @property
    def unstable(self):
        """Whether any axlebox is."""
        return any(box.unstable for box in self.axleboxes)

    @property
    def assessed(self):
        """The sustained level of each axlebox against the limit, tuple of Assessed."""
        return tuple(Assessed(box.channel, box.sustained, "m/s^2", self.limit) for box in self.axleboxes)

    @property
    def message(self):
        """The verdict in a sentence."""
        rule = f"{self.required} consecutive cycles over {self.limit.value:g} m/s^2, {self.band[0]:g} to {self.band[1]:g} Hz"
        first = min((box for box in self.axleboxes if box.unstable), key=lambda box: box.time, default=None)
        if first is None:
            worst = max(self.axleboxes, key=lambda box: box.sustained)
            return f"stable: nowhere {rule}; {self.required} cycles reach {worst.sustained:.3g} m/s^2 at most ({worst.channel})"
        where = "" if first.distance is None else f", s = {first.distance:.2f} m"
        count = sum(box.unstable for box in self.axleboxes)
        return f"unstable: {rule} at {count} of {len(self.axleboxes)} places, first {first.channel} from t = {first.time:.3f} s{where}"

    def __str__(self):
        from railsym.cli_output import table

        rows = [[box.channel, "unstable" if box.unstable else "stable", f"{box.cycles:g}", f"{box.peak:.2f}", f"{box.sustained:.2f}",
                 *("--" if value is None else f"{value:.3f}" for value in (box.time, box.distance))] for box in self.axleboxes]
        head = ["above axlebox", "verdict", "cycles over", "peak, m/s^2", f"{self.required} cycles, m/s^2", "from t, s", "s, m"]
        trust = f"limit {self.limit.value:g} m/s^2: {self.limit.trust}, {self.limit.edition}"
        return "\n".join([self.message, table(head, rows, left=(0, 1)), trust])

    def plot(self, *, axes=None):
        """Draw the band-passed accelerations and the limit; returns the axes."""
        from railsym.plots.criteria import plot_instability

        return plot_instability(self, axes=axes)


def instability(source, signal=None, *, channels=CHANNELS, limit=None, cycles=None, band=None, order=4, zero_phase=True, distance=None,
                speed=None):
    """Judge the running stability by the bogie frames' lateral accelerations above the axleboxes.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s (uniform).
    signal : array_like (n,) or dict of str to array_like (n,), optional
        Acceleration(s), m/s^2, when ``source`` is time.
    channels : str or sequence of str
        Channels of the run.
    limit : float, optional
        m/s^2; 8.0 if not given.
    cycles : int, optional
        Consecutive cycles; 6 if not given.
    band : (float, float), optional
        Hz; 4 to 8 if not given.
    order, zero_phase : int, bool
        Of the Butterworth band-pass; see `railsym.criteria.Butterworth`.
    distance, speed : array_like or float, optional
        m, m/s; the run's ``s`` and ``V`` if not given.

    Returns
    -------
    Instability

    Raises
    ------
    CriterionError
        Too short for the filter (0.75 s at 4 Hz), sampled too slowly (40 Hz for 8 Hz), not finite, another unit.

    Notes
    -----
    A record shorter than the required cycles cannot become unstable. Within about one period of the ends the filter has seen one
    side only.
    """
    bound = limits("frame_acceleration")
    if limit is not None:
        bound = Limit("frame_acceleration", float(limit), "m/s^2", "given", *["given by the caller"] * 3, bound.meaning)
    cycles = int(limits("cycles").value if cycles is None else cycles)
    band = (limits("lowest_frequency").value, limits("highest_frequency").value) if band is None else tuple(map(float, band))
    found = gather(source, signal, channels, "m/s^2", distance=distance, speed=speed, name="frame.ay")
    band_pass = Butterworth(*band, order, zero_phase)
    filtered = {name: band_pass.apply(value, found.rate, name) for name, value in found.values.items()}
    boxes = tuple(_judge(name, value, found, bound.value, cycles) for name, value in filtered.items())
    return Instability(boxes, bound, cycles, band, filtered, found.time)


def half_waves(values):
    """Peaks between zero crossings.

    Parameters
    ----------
    values : ndarray (n,)

    Returns
    -------
    peaks : ndarray (m,)
        Largest modulus of each whole half-wave.
    places : ndarray of int (m,)
        Sample of each peak.
    """
    sign = np.sign(values)
    crossings = np.flatnonzero(sign[1:] != sign[:-1]) + 1
    if crossings.size < 2:
        return np.empty(0), np.empty(0, dtype=int)
    size = np.abs(values)
    places = np.array([a + int(np.argmax(size[a:b])) for a, b in zip(crossings[:-1], crossings[1:])])
    kept = sign[places] != 0.0  # stretches of zeros are no waves
    return size[places[kept]], places[kept]


def _judge(name, values, found, limit, cycles):
    peaks, places = half_waves(values)
    over = peaks > limit
    # number of half-waves over the limit up to and with each one, from the last one that was not
    count = np.arange(1, over.size + 1)
    run = np.where(over, count - np.maximum.accumulate(np.where(over, 0, count)), 0)
    met = np.flatnonzero(run >= 2 * cycles)
    first = None if not met.size else (places[met[0] - 2 * cycles + 1], places[met[0]])
    sustained = 0.0
    if peaks.size >= 2 * cycles:
        sustained = float(np.lib.stride_tricks.sliding_window_view(peaks, 2 * cycles).min(axis=1).max())
    time, detected = (None, None) if first is None else (float(found.time[first[0]]), float(found.time[first[1]]))
    distance = None if first is None or found.distance is None else float(found.distance[first[0]])
    return AxleboxStability(name, bool(met.size), float(run.max(initial=0)) / 2, float(np.abs(values).max()), sustained, time, distance, detected)
