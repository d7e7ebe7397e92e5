# SPDX-License-Identifier: BSD-3-Clause
"""Limit cycles by ramps of the speed: hold every speed until the motion has settled, then go to the next with that motion.

A continuous ramp never settles: near a critical speed growth and decay are slow, and a ramp overshoots it by what the motion does in the
meantime (True 1999). Holding costs more where motions are slow and less elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import ContactError
from railsym.nonlinear.rolling import FlowError

WINDOW = 2.0         # s, over which amplitudes are taken: some periods of the slowest hunting
SETTLED = 2e-3       # of the amplitude, from window to window and over three of them
KICK = 1e-4          # m
AT_REST = 2e-5       # m: amplitude of the wheelset that moves most; below it steady rolling is reached
_STRIDE = 1e-4       # m, of a displacement, so that contacts follow
_ITERATIONS = 6      # of the loads, a stride
_LOAD = 1e-3         # of the load: settled enough to begin with
_HEAVE_ROLL = [2, 4]


@dataclass(frozen=True, eq=False)
class Ramp:
    """Amplitudes along a ramp.

    Attributes
    ----------
    speed : ndarray (k,)
        m/s, in the order of the ramp; speeds whose motion could not be followed are left out.
    amplitude : ndarray (k, wheelsets)
        m, over the last window; 0 where the vehicle came to rest against its track.
    settled : ndarray of bool (k,)
        False where the amplitude still changed after the longest hold.
    lasting : ndarray of bool (k,)
        Whether a motion went on: settled above zero, or changing without decay (not periodic, or growing).
    held : ndarray (k,)
        s, how long each speed was held.
    frequency_hz : ndarray (k,)
        From the crossings of the middle by the wheelset that moves most; nan at rest.
    states : tuple of ndarray
        At the end of each hold.
    failures : tuple of (float, str)
        Speeds at which a wheel left its contact table or a step failed, and what happened.
    """

    speed: np.ndarray
    amplitude: np.ndarray
    settled: np.ndarray
    lasting: np.ndarray
    held: np.ndarray
    frequency_hz: np.ndarray
    states: tuple
    failures: tuple = ()

    @property
    def largest(self):
        """m, amplitude of the wheelset that moves most, (k,)"""
        return self.amplitude.max(axis=1, initial=0.0)


def disturbed(system, z, size):
    """A state of rolling with the whole vehicle displaced sideways by ``size`` (m), as by a step of the track's alignment.

    Wheelsets rise and roll with it so that their wheels press on the rails as before: else one wheel would hang in the air and the
    other be pressed into its rail by the conicity times the size.
    """
    z, across = z.copy(), np.array([name.endswith(".y") for name in system.names])
    count = max(1, int(np.ceil(abs(size) / _STRIDE)))
    free = [[system.names.index(f"{name}.{part}") for part in ("z", "roll")] for name in system.wheelsets]
    wanted = _pressed(system, z)[0]
    for _ in range(count):
        z[across] += size / count
        for _ in range(_ITERATIONS):
            try:
                rows, blocks = _pressed(system, z)
            except ContactError as error:
                raise FlowError(f"a sideways displacement of {1e3 * size:.3g} mm: {error}") from None
            for own, r, block, goal in zip(free, rows, blocks, wanted):
                z[own] += np.clip(np.linalg.solve(block, goal - r), -_STRIDE, _STRIDE)
            if np.abs(rows - wanted).max() < _LOAD * np.abs(wanted).max():
                break
    return z


def _pressed(system, z):
    """Rows of z and roll (wheelsets, 2) of the wheel-rail forces, and their slopes over z and roll."""
    q, u = system.coordinates_of(z)
    rows, blocks = system.parts.wheels.rows(q, u, system.speed, seed=(1.0, 0.0))
    return rows[:, _HEAVE_ROLL], blocks[:, _HEAVE_ROLL][:, :, _HEAVE_ROLL]


def ramp(system, speeds, disturbance, longest=40.0, progress=None):
    """Hold the speeds (m/s) one after the other, each with the motion that the one before ended in.

    Parameters
    ----------
    system : RollingSystem
    speeds : array_like (k,)
    disturbance : float
        m, sideways displacement of the whole vehicle at the first speed, and again after a failure. After a speed at which the
        motion died out it is `KICK`, enough to leave an unstable equilibrium.
    longest : float
        s, of a hold.
    progress : callable, optional
        Gets speed, amplitude (wheelsets,).
    """
    rows, states, failures, z, kick = [], [], [], None, disturbance
    for speed in speeds:
        try:
            begin = disturbed(system, system.equilibrium(speed), kick) if z is None else system.faster(z, speed)
            z, row = _hold(system, begin, longest)
        except FlowError as error:
            failures.append((float(speed), str(error)))
            z, kick = None, disturbance
            continue
        rows.append((speed, *row))
        states.append(z)
        if not row[0].any():
            z, kick = None, KICK
        if progress is not None:
            progress(speed, row[0])
    columns = zip(*rows) if rows else ((),) * 6
    speed, amplitude, settled, lasting, held, frequency = (np.array(column) for column in columns)
    return Ramp(speed.astype(float), amplitude.reshape(-1, len(system.wheelsets)), settled.astype(bool), lasting.astype(bool), held.astype(float),
                frequency.astype(float), tuple(states), tuple(failures))


def _hold(system, z, longest):
    """State at the end, and amplitude, settled, lasting, held, frequency."""
    dt = system.dt
    system.parts.integrator.set_step(dt)
    system.start(z)
    steps, past = round(WINDOW / dt), []
    while True:
        z, lateral = system.run(steps, 1)
        amplitude = 0.5 * np.ptp(lateral, axis=0)
        past.append(amplitude)
        held = len(past) * WINDOW
        if amplitude.max() < AT_REST:
            return z, (np.zeros_like(amplitude), True, False, held, np.nan)
        recent = np.array(past[-4:])
        settled = len(past) > 4 and bool((np.ptp(recent, axis=0) <= SETTLED * recent.max()).all())
        if settled or held + WINDOW > longest:
            return z, (amplitude, settled, settled or _goes_on(past), held, _frequency(lateral[:, amplitude.argmax()], dt))


def _goes_on(past):
    """Whether the last third of the hold is no smaller than the third before it, within a tenth."""
    largest, third = np.array(past).max(axis=1), max(1, len(past) // 3)
    return bool(largest[-third:].max() >= 0.9 * largest[-2 * third:-third].max()) if len(past) >= 2 else False


def _frequency(y, dt):
    """Hz, of a periodic signal, from its rising crossings of the middle; nan with fewer than two."""
    y = y - 0.5 * (y.max() + y.min())
    k = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    if len(k) < 2:
        return np.nan
    times = k + y[k] / (y[k] - y[k + 1])
    return (len(k) - 1) / ((times[-1] - times[0]) * dt)
