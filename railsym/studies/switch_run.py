# SPDX-License-Identifier: BSD-3-Clause
"""One crossing of a switch: the run, its verdict, and the motion that stays behind."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from railsym.criteria import CriterionError, hunting_frequency, instability
from railsym.errors import SimulationError
from railsym.track import Track

CHANNELS = ("s", "V", "*.above_*.ay", "wheelset*.y", "wheelset*.sum_Y")
START = 20.0         # m of straight before the switch
_MARGIN = 5.0        # m of track beyond the end of a run
SETTLE = 0.3        # s behind the switch, before the motion that stays is looked at
_WINDOW = 1.5        # s at the end of a run: whether motion goes on is read there
_STILL = 5e-5        # m
_STEADY = 0.03       # relative change of the amplitude from one window to the next that counts as none
_BAND = (1.0, 12.0)  # Hz, in which the frequency of the motion behind the switch is looked for


@dataclass(frozen=True, eq=False)
class SwitchRun:
    """A vehicle over a switch at one speed.

    Attributes
    ----------
    speed : float
        m/s.
    ratio : float
        Speed over V0.
    run : railsym.Run
    verdict : railsym.criteria.Instability or None
        Frame accelerations above the axleboxes; None where the run ended before the filter could be used (0.75 s).
    passed : float
        s, when the last wheelset is off the switch.
    frequency_hz, amplitude : float
        Of the leading line of the spectra behind the switch (Hz, m/s^2); nan where nothing moves.
    channel : str
        Where that line is.
    motion, earlier_motion, late_motion : float
        m, largest lateral amplitude of a wheelset in the first 1.5 s behind the switch, in the last but one and in the last 1.5 s of the run.
    mean_motion : float
        m, amplitude of the sine with the same r.m.s. as the largest of them behind the switch.
    late : float
        m/s^2, largest filtered acceleration in the last 1.5 s.
    growth : float
        1/s, rate at which the motion of the wheelset that moves most grows (+) or decays (-) behind the switch: straight line
        through the logarithm of its half-waves above 0.05 mm; nan with fewer than four.
    """

    speed: float
    ratio: float
    run: Any = field(repr=False)
    verdict: Any = field(repr=False)
    passed: float
    frequency_hz: float
    amplitude: float
    channel: str
    motion: float
    earlier_motion: float
    late_motion: float
    mean_motion: float
    late: float
    growth: float

    @property
    def unstable(self):
        """By the criterion; a derailed run is unstable. None where there is no verdict: the run stopped before six cycles were over the limit."""
        if self.run.status == "derailed" or (self.verdict is not None and self.verdict.unstable):
            return True
        return False if self.run.status == "completed" else None

    @property
    def worst(self):
        """The axlebox with the highest six cycles, `railsym.criteria.instability.AxleboxStability`; None without verdict."""
        return None if self.verdict is None else max(self.verdict.axleboxes, key=lambda box: (box.sustained, box.peak))

    @property
    def fate(self):
        """What becomes of the motion, from the last two spans of 1.5 s: "derails", "dies out" (below 0.05 mm), "decays", "goes on", "grows"."""
        if self.run.status != "completed":
            return {"derailed": "derails"}.get(self.run.status, self.run.status.replace("_", " "))
        if self.late_motion < _STILL:
            return "dies out"
        change = self.late_motion / self.earlier_motion
        return "goes on" if abs(change - 1.0) < _STEADY else "grows" if change > 1.0 else "decays"

    def spectrum(self, band=_BAND):
        """Spectrum of the acceleration behind the switch where it is largest, unfiltered."""
        return self.run.between(self.passed + SETTLE, np.inf).spectrum(self.channel, band=band)


def switch_track(switch, length):
    """Straight track with a switch.

    Parameters
    ----------
    switch : railsym.track.Switch
    length : float
        m

    Returns
    -------
    railsym.Track
    """
    return replace(Track.straight(length), switches=(switch,), name="switch")


def cross(vehicle, contact, switch, speed, *, reference, after, progress=False, channels=CHANNELS, **options):
    """Simulate and judge one crossing.

    Parameters
    ----------
    vehicle : Vehicle
    contact : ContactTable
    switch : railsym.track.Switch
    speed : float
        m/s
    reference : float
        V0, m/s.
    after : float
        s of motion behind the switch.
    options
        Of `railsym.simulate`.

    Returns
    -------
    SwitchRun
    """
    from railsym.simulation import simulate

    if after < SETTLE + 2.0 * _WINDOW:
        raise SimulationError(f"after = {after!r} s: at least {SETTLE + 2.0 * _WINDOW:g} s of motion behind the switch are needed")
    places = [body.position[0] for body in vehicle.bodies]
    ahead, behind = max(places), min(places)
    passed = (switch.start + switch.length + ahead - behind) / speed
    duration = passed + after
    track = switch_track(switch, speed * duration + _MARGIN)
    run = simulate(vehicle, speed=speed, duration=duration, track=track, contact=contact, channels=channels, progress=progress, **options)
    return judged(run, speed, speed / reference, passed)


def judged(run, speed, ratio, passed):
    """The `SwitchRun` of a run whose last wheelset left the switch at ``passed`` (s)."""
    nothing = SwitchRun(speed, ratio, run, None, passed, *[np.nan] * 2, "", *[np.nan] * 6)
    try:
        verdict = instability(run)
    except CriterionError:
        if run.status == "completed":
            raise
        return nothing                    # stopped too early for the filter
    if run.time[-1] < passed + SETTLE + 2.0 * _WINDOW:
        return replace(nothing, verdict=verdict)
    tail = run.between(passed + SETTLE, np.inf)
    left = run.time[-1] - tail.time
    spans = tail.time <= tail.time[0] + _WINDOW, (left <= 2.0 * _WINDOW) & (left > _WINDOW), left <= _WINDOW
    moves = [tail[name] for name in run.channels.match("wheelset*.y")]
    lead = max(moves, key=np.std)
    filtered = max(float(np.abs(value[run.time >= run.time[-1] - _WINDOW]).max()) for value in verdict.filtered.values())
    return SwitchRun(speed, ratio, run, verdict, passed, *_line(tail), *(max(_swing(y[span]) for y in moves) for span in spans),
                     float(np.sqrt(2.0) * np.std(lead)), filtered, _growth(tail.time, lead))


def _swing(values):
    """Half of what lies between the extremes."""
    return 0.5 * float(np.ptp(values))


def _line(tail):
    """Frequency, amplitude and place of the leading line behind the switch."""
    found = hunting_frequency(tail, band=_BAND)
    return found.frequency_hz, found.amplitude, found.channel


def _growth(time, values):
    """1/s, from the peaks of half-waves."""
    from railsym.criteria.instability import half_waves

    peaks, places = half_waves(values - values.mean())
    peaks, places = peaks[peaks > _STILL], places[peaks > _STILL]
    if len(peaks) < 4:
        return np.nan
    return float(np.polyfit(time[places], np.log(peaks), 1)[0])
