# SPDX-License-Identifier: BSD-3-Clause
"""Periodic motions by shooting, and their Floquet multipliers.

    phi(z, T, V) - z = 0,        f(z0)' D^-2 (z - z0) = 0,        one more equation that picks a point of the branch

phi is what the integrator makes of z in N equal steps of T/N: an orbit is one of the discrete motion, and differs from that of the
equations by the error of the step, of second order. D scales displacements by 1 mm and rates by 1 mm times the frequency. The
monodromy matrix dphi/dz is taken column by column by differences. A vehicle has some hundred states and a period some hundred
steps, so that all of it costs a second or less; it gives all multipliers, and it serves as it is for the Newton steps of the next
point, which then cost one period each. (A Krylov method would ask for fewer columns at each of several Newton steps.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.nonlinear.rolling import FlowError

LENGTH = 1e-3        # m: size of a motion
_DIFFERENCE = 1e-3   # of a scale: 1 um; over less the corners of FASTSIM and of contact tables make noise
_CLOSED = 1e-5       # of the amplitude, but not of more than 1 mm, that an orbit may be open
_STALLED = 1e-4      # the same, that is taken where corners of the contact let the iteration come no nearer
_ITERATIONS = 12
_SHORTENED = 2       # times that a step is quartered
_DIVERGED = 5.0      # times the smallest residual so far
_NEUTRAL = 1e-3      # that a multiplier of 1 may be off: differences over 1 um at amplitudes of a millimetre
SAMPLES = 64         # of the lateral displacement in a period, at least


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion at one speed.

    Attributes
    ----------
    speed : float
        m/s
    period : float
        s
    state : ndarray (size,)
    steps : int
        In a period.
    amplitude, offset : ndarray (wheelsets,)
        m, half of what lies between the extremes of the lateral displacement, and the middle of them.
    multipliers : ndarray (size,), complex
        Floquet multipliers, the largest first, that of the motion along the orbit included.
    """

    speed: float
    period: float
    state: np.ndarray
    steps: int
    amplitude: np.ndarray
    offset: np.ndarray
    multipliers: np.ndarray

    @property
    def trivial(self):
        """Number of the multiplier of the motion along the orbit: the one nearest 1."""
        return int(np.argmin(np.abs(self.multipliers - 1.0)))

    @property
    def dominant(self):
        """The largest other multiplier."""
        return complex(np.delete(self.multipliers, self.trivial)[0])

    @property
    def stable(self):
        """Whether disturbed motions return to it, as far as differences can tell."""
        return abs(self.dominant) < 1.0 + _NEUTRAL


class Shooting:
    """Newton's iteration for orbits near one another.

    Unknown is x = (z/D, ln T, V/speed_scale).

    Parameters
    ----------
    system : RollingSystem
    frequency : float
        rad/s, of the scales.
    speed_scale : float
        m/s that weigh as much as 1 mm of every wheelset.
    """

    def __init__(self, system, frequency, speed_scale):
        self.system, self.speed_scale = system, float(speed_scale)
        rate = np.array([name.endswith(".rate") for name in system.names])
        self.scale = np.where(rate, LENGTH * frequency, LENGTH)
        # Scalar product along a branch: displacements of all wheelsets by 1 mm, or the speed by its scale, are 1.
        weight = np.zeros(system.size)
        weight[system.lateral] = weight[system.lateral_rate] = 1.0 / len(system.lateral)
        self.weight = np.concatenate([weight, [1.0, 1.0]])
        self.steps = None

    def join(self, z, period, speed):
        """x of a state, period and speed."""
        return np.concatenate([z / self.scale, [np.log(period), speed / self.speed_scale]])

    def split(self, x):
        """State, period and speed of x."""
        return x[:-2] * self.scale, float(np.exp(x[-2])), float(x[-1] * self.speed_scale)

    def set_steps(self, period):
        """Steps of about dt in the periods to come."""
        self.steps = max(16, round(period / self.system.dt))

    def end(self, x, every=None):
        """State after a period, scaled, and lateral displacements on the way."""
        z, period, speed = self.split(x)
        if not (speed > 0.0 and np.isfinite(period)):
            raise FlowError(f"the branch leads to a speed of {speed:.4g} m/s")
        self.system.set_speed(speed)
        z, lateral = self.system.flow(z, period, self.steps, every)
        return z / self.scale, lateral

    def phase(self, x):
        """Direction of the motion at x, scaled to length 1."""
        z, _, speed = self.split(x)
        self.system.set_speed(speed)
        f = self.system.slope(z) / self.scale
        return f / np.linalg.norm(f)

    def derivatives(self, x, end):
        """d(end)/dx (size, size + 2) by differences."""
        columns = []
        for k in range(len(x)):
            moved = x.copy()
            moved[k] += _DIFFERENCE
            columns.append((self.end(moved)[0] - end) / _DIFFERENCE)
        return np.array(columns).T

    def matrix(self, monodromy, phase, row):
        """Jacobian of the equations."""
        size = self.system.size
        jacobian = np.zeros((size + 2, size + 2))
        jacobian[:size] = monodromy
        jacobian[:size, :size] -= np.eye(size)
        jacobian[size, :size] = phase
        jacobian[size + 1] = row
        return jacobian

    def solve(self, x, phase, row, monodromy=None, fresh=True):
        """The orbit on the plane row'(x - x given) = 0: Newton's iteration with Broyden's updates of the matrix.

        Parameters
        ----------
        monodromy : ndarray (size, size + 2), optional
            d(end)/dx near by.
        fresh : bool
            Compute the matrix anew where the iteration fails with that one.

        Returns
        -------
        x : ndarray (size + 2,), or None where the iteration does not get there
        """
        found = None if monodromy is None else self._iterate(x, phase, row, monodromy)
        return self._iterate(x, phase, row, self.derivatives(x, self.end(x)[0])) if found is None and fresh else found

    def _iterate(self, start, phase, row, monodromy):
        x, jacobian, best = start, self.matrix(monodromy, phase, row), np.inf
        size_of_motion = min(1.0, float(np.sqrt(self.weight[:-2] @ start[:-2]**2)))
        wrong = self._wrong(x, start, phase, row)
        for _ in range(_ITERATIONS):
            size = np.abs(wrong).max()
            best = min(size, best)
            if size <= _CLOSED * size_of_motion:
                return x
            if not size <= _DIVERGED * best:
                return None
            x, move, wrong = self._moved(x, np.linalg.solve(jacobian, -wrong), start, phase, row)
            jacobian += np.outer(wrong, move) / (move @ move)
        return x if np.abs(wrong).max() <= _STALLED * size_of_motion else None

    def _moved(self, x, move, start, phase, row):
        """The iteration's step, shortened where it would leave the contact table."""
        for _ in range(_SHORTENED):
            try:
                return x + move, move, self._wrong(x + move, start, phase, row)
            except FlowError:
                move = 0.25 * move
        return x + move, move, self._wrong(x + move, start, phase, row)

    def _wrong(self, x, start, phase, row):
        return np.concatenate([self.end(x)[0] - x[:-2], [phase @ (x - start)[:-2], row @ (x - start)]])

    def orbit(self, x):
        """`Orbit` at a solution, and d(end)/dx."""
        end, lateral = self.end(x, max(1, self.steps // SAMPLES))
        monodromy = self.derivatives(x, end)
        multipliers = np.linalg.eigvals(monodromy[:, :-2])
        z, period, speed = self.split(x)
        high, low = lateral.max(axis=0), lateral.min(axis=0)
        order = np.argsort(-np.abs(multipliers))
        return Orbit(speed, period, z, self.steps, 0.5 * (high - low), 0.5 * (high + low), multipliers[order]), monodromy

    def tangent(self, monodromy, phase):
        """Null vector of the equations of an orbit, of length 1 in the weights."""
        equations = self.matrix(monodromy, phase, np.zeros(len(phase) + 2))[:-1]
        tangent = np.linalg.svd(equations)[2][-1]
        return tangent / self.length(tangent)

    def length(self, direction):
        """Of a direction of x along a branch."""
        return float(np.sqrt(self.weight @ direction**2))
