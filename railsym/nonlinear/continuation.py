# SPDX-License-Identifier: BSD-3-Clause
"""Branches of periodic motions: pseudo-arclength continuation through folds (Keller 1977; Seydel 2010, ch. 4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import ConvergenceError
from railsym.nonlinear.orbit import LENGTH, Orbit, Shooting
from railsym.nonlinear.rolling import FlowError

_FIRST = 0.05      # of 1 mm: amplitude of the first orbit off a Hopf point
_FIRST_AMPLITUDES = 0.05, 0.2, 0.5   # mm: the next where contact and creep law have corners nearer to the centre
_ENOUGH = 5        # orbits of a branch that has left the Hopf point
_LEAPS = 0.1, 0.3  # steps past a corner, with a new matrix
_SHORTENED = 4     # times that a step is cut to 0.4 of it
_SHORTEST, _LARGEST = 5e-3, 0.5


@dataclass(frozen=True, eq=False)
class Branch:
    """Periodic motions along one branch, in order.

    Attributes
    ----------
    orbits : tuple of Orbit
    folds : tuple of Orbit
        Where the branch turns in speed.
    origin : str
        What it was begun from.
    ending : str
        Why it was not followed further.
    wheelsets : tuple of str
    """

    orbits: tuple
    folds: tuple
    origin: str
    ending: str
    wheelsets: tuple

    def _all(self, get):
        return np.array([get(orbit) for orbit in self.orbits])

    @property
    def speed(self):
        """m/s, (k,)"""
        return self._all(lambda o: o.speed)

    @property
    def amplitude(self):
        """m, of the wheelset that moves most, (k,)"""
        return self._all(lambda o: o.amplitude.max())

    @property
    def frequency_hz(self):
        """(k,)"""
        return 1.0 / self._all(lambda o: o.period)

    @property
    def dominant(self):
        """Largest Floquet multiplier but that of the motion along the orbit, (k,) complex"""
        return self._all(lambda o: o.dominant)

    @property
    def stable(self):
        """(k,) bool"""
        return self._all(lambda o: o.stable)


def from_hopf(system, hopf, speeds, progress=None, points=200, speed_scale=2.0):
    """The branch that begins at a Hopf point.

    Parameters
    ----------
    system : RollingSystem
    hopf : Hopf
    speeds : pair of float
        m/s, where it is followed.
    progress : callable, optional
        Gets each Orbit.
    points : int
        At most.
    speed_scale : float
        m/s that count as 1 mm.
    """
    best = None
    for first in _FIRST_AMPLITUDES:
        branch = _off_hopf(system, hopf, first, speeds, progress, points, speed_scale)
        if branch is not None and (best is None or len(branch.orbits) > len(best.orbits)):
            best = branch
        if best is not None and len(best.orbits) >= min(_ENOUGH, points):
            return best
    if best is None:
        raise ConvergenceError(f"no periodic motion was found near the linear critical speed of {hopf.speed:.6g} m/s: give a finer step (dt), or "
                               "contact and creep law are not smooth near the centre")
    return best


def _off_hopf(system, hopf, first, speeds, progress, points, speed_scale):
    """The branch from its orbit of amplitude ``first``, mm; None where that is not found."""
    shooting = Shooting(system, hopf.frequency, speed_scale)
    shooting.set_steps(2.0 * np.pi / hopf.frequency)
    step = np.concatenate([hopf.shape.real / shooting.scale, [0.0, 0.0]])
    step /= shooting.length(step)
    base = shooting.join(hopf.equilibrium, 2.0 * np.pi / hopf.frequency, hopf.speed)
    phase = (1j * hopf.shape).real / shooting.scale
    try:
        found = shooting.solve(base + first * step, phase / np.linalg.norm(phase), shooting.weight * step)
        if found is None:
            return None
        track = _Track(shooting, found, found - base)
        tangent = shooting.tangent(track.monodromy, shooting.phase(found))
        track.direction = tangent * np.sign((shooting.weight * tangent) @ step)  # step has no part in speed: towards larger amplitudes
        return _follow(track, speeds, "linear critical speed", progress, points)
    except FlowError:
        return None


def from_motion(system, z, period, speed, speeds, along, progress=None, points=200, speed_scale=2.0):
    """The branch through a periodic motion that was nearly found by other means, such as a long simulation, in one direction.

    Parameters
    ----------
    z, period, speed
        State, s, m/s.
    along : float
        +1: begin towards higher speeds, -1: lower.
    """
    shooting = Shooting(system, 2.0 * np.pi / period, speed_scale)
    shooting.set_steps(period)
    x = shooting.join(z, period, speed)
    row = np.zeros(len(x))
    row[-1] = 1.0
    found = shooting.solve(x, shooting.phase(x), row)
    if found is None:
        raise ConvergenceError(f"the motion at {speed:.6g} m/s is not periodic with {period:.4g} s")
    track = _Track(shooting, found, along * row)
    tangent = shooting.tangent(track.monodromy, shooting.phase(found))
    track.direction = tangent * np.sign(tangent[-1]) * along
    return _follow(track, speeds, f"a simulated motion at {speed:.4g} m/s", progress, points)



def _follow(track, speeds, origin, progress, points):
    """Predict along the secant of the last two points, correct square to it.

    The tangent from the matrix, a derivative, is less use as a predictor: corners of contact tables and of FASTSIM turn it.
    """
    folds, ending = [], f"{points} points were computed"
    while len(track.orbits) < points:
        try:
            if not track.advance():
                ending = "the iteration does not converge with ever shorter steps"
                break
        except FlowError as error:
            ending = str(error)
            break
        if track.turned():
            folds.append(track.fold())
        orbit = track.orbits[-1]
        if progress is not None:
            progress(orbit)
        if not speeds[0] <= orbit.speed <= speeds[1]:
            ending = "the end of the speeds asked for"
            break
        if orbit.amplitude.max() < 0.2 * _FIRST * LENGTH:
            ending = "steady rolling: another Hopf point"
            break
    return Branch(tuple(track.orbits), tuple(folds), origin, ending, track.shooting.system.wheelsets)


class _Track:
    """Points of a branch so far."""

    def __init__(self, shooting, x, direction):
        self.shooting, self.step = shooting, _FIRST
        self.direction = direction / shooting.length(direction)
        orbit, self.monodromy = shooting.orbit(x)
        self.points, self.orbits = [x], [orbit]

    def advance(self):
        """Find the next point; False where even the smallest step does not lead on, FlowError where no motion can be followed there."""
        failure, tried = None, [(self.step * 0.4**k, False) for k in range(_SHORTENED)]
        again = [(step, True) for step in (tried[1][0], tried[3][0], *_LEAPS)]
        for k, (step, fresh) in enumerate((*tried, *again)):
            if k == len(tried):
                self.direction = self._tangent()
            before = self.shooting.system.integrations
            try:
                found = self.correct(self.points[-1], self.direction, step, fresh)
            except FlowError as error:
                found, failure = None, error
            if found is not None:
                self.step = step
                self._accept(found, self.shooting.system.integrations - before)
                return True
        if failure is not None:
            raise failure
        return False

    def _tangent(self):
        """Direction of the branch at the last point, from its matrix: where the branch has bent since the last secant."""
        shooting, last = self.shooting, self.points[-1]
        tangent = shooting.tangent(self.monodromy, shooting.phase(last))
        return tangent * np.sign((shooting.weight * tangent)[:-2] @ self.direction[:-2])

    def correct(self, x, direction, step, fresh=False):
        """The point of the branch near x + step direction, or None."""
        guess = x + step * direction
        found = self.shooting.solve(guess, self.shooting.phase(guess), self.shooting.weight * direction, self.monodromy, fresh)
        return found if found is not None and self.shooting.length(found - guess) < step else None

    def _accept(self, found, cost):
        secant = found - self.points[-1]
        self.direction = secant / self.shooting.length(secant)
        orbit, self.monodromy = self.shooting.orbit(found)
        self.points.append(found)
        self.orbits.append(orbit)
        if cost <= 8:
            self.step = min(_LARGEST, 1.5 * self.step)
        self.step = max(self.step, _SHORTEST)

    def turned(self):
        """Whether the speed has an extremum at the last point but one."""
        if len(self.points) < 3:
            return False
        first, middle, last = (x[-1] for x in self.points[-3:])
        return (middle - first) * (last - middle) < 0.0

    def fold(self):
        """The orbit at the extremum of the speed near the last point but one: vertex of a parabola, corrected, and once more."""
        first, middle, last = self.points[-3:]
        best = self.orbits[-2]
        for _ in range(2):
            s = np.array([-self.shooting.length(middle - first), 0.0, self.shooting.length(last - middle)])
            curve = np.polyfit(s, [x[-1] for x in (first, middle, last)], 2)
            at = -0.5 * curve[1] / curve[0]
            if not s[0] < at < s[2]:
                break
            ahead = (last - middle) if at > 0.0 else (first - middle)
            found = self.correct(middle, ahead / self.shooting.length(ahead), abs(at))
            if found is None or (found[-1] - middle[-1]) * curve[0] > 0.0:
                break
            best, _ = self.shooting.orbit(found)
            first, middle, last = (middle, found, last) if at > 0.0 else (first, found, middle)
        return best
