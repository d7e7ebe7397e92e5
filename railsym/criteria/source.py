# SPDX-License-Identifier: BSD-3-Clause
"""Signals for a criterion: from a run or from arrays, checked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.results.errors import UnknownChannelError
from railsym.results.run import Run, uniform_step

DISTANCE, SPEED = "s", "V"


@dataclass(frozen=True, eq=False)
class Signals:
    """Checked signals over uniform time.

    Attributes
    ----------
    time : ndarray (n,)
        s.
    step : float
        s.
    distance : ndarray (n,) or None
        m, strictly increasing.
    values : dict of str to ndarray (n,)
    """

    time: np.ndarray
    step: float
    distance: np.ndarray | None
    values: dict

    @property
    def rate(self):
        """Samples in a second, Hz."""
        return 1.0 / self.step

    def need(self, seconds, rate, what):
        """Refuse a record shorter than ``seconds`` or sampled more slowly than ``rate`` (Hz).

        Raises
        ------
        CriterionError
        """
        duration = self.step * (self.time.size - 1)
        if self.rate < rate * (1 - 1e-6):
            raise CriterionError(f"{what} needs a sampling rate of at least {rate:g} Hz; the signal has {self.rate:.5g} Hz")
        if duration < seconds * (1 - 1e-9):
            raise CriterionError(f"{what} needs at least {seconds:.4g} s; the signal is {duration:.4g} s long")


def gather(source, signal, patterns, unit, *, distance=None, speed=None, needs_distance=False, name="signal"):
    """Signals of a run (by patterns) or of arrays.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s.
    signal : array_like (n,), dict of str to array_like, or None
        With time as the source.
    patterns : str or sequence of str
        Channels of a run.
    unit : str
        That the channels must have.
    distance, speed : array_like (n,) or float, optional
        m and m/s, in place of the run's channels ``s`` and ``V``.
    needs_distance : bool

    Returns
    -------
    Signals

    Raises
    ------
    CriterionError
    railsym.results.UnknownChannelError
    railsym.results.ResultError
        Time that is not uniform.
    """
    if isinstance(source, Run):
        if signal is not None:
            raise CriterionError("give a run, or time and signal; not both")
        names = _named(source, (patterns,) if isinstance(patterns, str) else tuple(patterns))
        for channel in names:
            if source.unit(channel) != unit:
                raise CriterionError(f"channel {channel} is in {source.unit(channel)}; {unit} is needed")
        time, values = source.time, {channel: source[channel] for channel in names}
    else:
        if signal is None:
            raise CriterionError("give a run, or time (s) and signal as two arrays")
        time = np.asarray(source, dtype=float)
        values = {key: np.asarray(value, dtype=float) for key, value in (signal if isinstance(signal, dict) else {name: signal}).items()}
    check(time, values)
    step = uniform_step(time)
    return Signals(time, step, _distance(source, time, step, distance, speed, needs_distance), values)


def _named(run, patterns):
    try:
        return run.channels.require(*patterns)
    except UnknownChannelError as error:
        raise UnknownChannelError(f"{error}; this criterion looks for {', '.join(patterns[:4])}, other channels can be given to it") from error


def check(time, values):
    """Refuse signals of another length than time, and values that are not finite."""
    for name, value in {"time": time, **values}.items():
        if value.shape != time.shape or time.ndim != 1:
            raise CriterionError(f"{name} has shape {value.shape}, time {time.shape}; both must be (n,)")
        if not np.isfinite(value).all():
            at = int(np.argmin(np.isfinite(value)))
            where = f" at t = {time[at]:.6g} s" if np.isfinite(time[at]) else f" at sample {at}"
            raise CriterionError(f"{name} is not finite{where} ({value[at]}); cut it off with run.between(start, end)")


def _distance(source, time, step, distance, speed, needed):
    run = source if isinstance(source, Run) else None
    if distance is None and run is not None and DISTANCE in run and speed is None:
        distance = run[DISTANCE]
    if distance is None:
        if speed is None and run is not None:
            speed = run[SPEED] if SPEED in run else run.info.speed
        if speed is None:
            if needed:
                raise CriterionError("distance is needed: a run with channel 's' (m) or 'V' (m/s), or distance=... or speed=...")
            return None
        speed = np.broadcast_to(np.asarray(speed, dtype=float), time.shape)
        distance = np.concatenate(([0.0], np.cumsum(0.5 * step * (speed[1:] + speed[:-1]))))
    distance = np.asarray(distance, dtype=float)
    check(time, {"distance": distance})
    if (np.diff(distance) <= 0.0).any():
        at = int(np.argmax(np.diff(distance) <= 0.0))
        raise CriterionError(f"distance does not increase at t = {time[at]:.6g} s ({distance[at]:.6g} m, then {distance[at + 1]:.6g} m); "
                             "a criterion over distance needs a vehicle that moves forward")
    return distance
