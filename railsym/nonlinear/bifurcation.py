# SPDX-License-Identifier: BSD-3-Clause
"""Bifurcation diagram of a vehicle: limit cycles against speed, by ramps and by continuation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import ConvergenceError, SimulationError
from railsym.nonlinear.continuation import from_hopf, from_motion
from railsym.nonlinear.hopf import Stability
from railsym.nonlinear.ramp import ramp
from railsym.nonlinear.rolling import RollingSystem

RAMP_TOLERANCE = 1e-3   # m/s^2: amplitudes are read from motions, not differences of them
_KNOWN = 0.05           # of the amplitude: a simulated cycle this near to a branch is on it
_BEGINNINGS = 4         # cycles of the ramps from which branches are followed, at most
_SCAN = 25              # speeds at which eigenvalues are looked at


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """Limit cycles of a vehicle against speed.

    Attributes
    ----------
    vehicle, law : str
    speeds : pair of float
        m/s, range looked at.
    hopf : tuple of Hopf
        Speeds at which steady rolling loses or regains stability.
    stable_below : bool
        Whether steady rolling is stable at the lowest speed.
    branches : tuple of Branch
    descending, ascending : Ramp or None
    notes : tuple of str
        What was not found, and why.
    """

    vehicle: str
    law: str
    speeds: tuple
    hopf: tuple
    stable_below: bool
    branches: tuple
    descending: object
    ascending: object
    notes: tuple

    @property
    def linear_critical_speed(self):
        """m/s, lowest speed at which steady rolling becomes unstable; nan where it does not, the lowest speed where it is unstable there."""
        if not self.stable_below:
            return self.speeds[0]
        return next((h.speed for h in self.hopf if h.rising), np.nan)

    @property
    def nonlinear_critical_speed(self):
        """m/s, lowest speed of a lasting limit cycle: of the stable orbits and folds of the branches, else of the ramps; nan without any."""
        found = [orbit.speed for branch in self.branches for orbit in _stable(branch)]
        found += [speed for one in self.ramps for speed in one.speed[one.lasting]]
        return float(min(found, default=np.nan))

    @property
    def ramps(self):
        """The ramps that were made."""
        return tuple(one for one in (self.descending, self.ascending) if one is not None)

    @property
    def criticality(self):
        """``"supercritical"`` where the cycles of the first Hopf point begin towards higher speeds, ``"subcritical"``; or ``"unknown"``."""
        slope = self.opening
        return "unknown" if not np.isfinite(slope) else "supercritical" if slope > 0.0 else "subcritical"

    @property
    def opening(self):
        """c of V = Vc + c A^2 (m/s per m^2) from the first orbits off the Hopf point; nan without them."""
        first = next((b for b in self.branches if b.origin == "linear critical speed"), None)
        rising = next((h for h in self.hopf if h.rising), None)
        if first is None or rising is None:
            return np.nan
        square = first.amplitude[:3] ** 2
        return float(square @ (first.speed[:3] - rising.speed) / (square @ square))

    def amplitude_at(self, speed):
        """Amplitudes (m) of the stable orbits of all branches at a speed (m/s), by interpolation along them."""
        found = []
        for branch in self.branches:
            v, a, stable = branch.speed, branch.amplitude, branch.stable
            for k in np.flatnonzero((v[:-1] - speed) * (v[1:] - speed) <= 0.0):
                if stable[k] and stable[k + 1] and v[k] != v[k + 1]:
                    found.append(a[k] + (speed - v[k]) / (v[k + 1] - v[k]) * (a[k + 1] - a[k]))
        return np.array(found)

    def disagreement(self):
        """Speeds (k,) and relative differences (k,) of settled amplitudes of the ramps from the nearest stable orbit, where there is one."""
        rows = []
        for one in self.ramps:
            for speed, amplitude in zip(one.speed[one.settled & one.lasting], one.largest[one.settled & one.lasting]):
                near = self.amplitude_at(speed)
                if len(near):
                    rows.append((speed, np.abs(near / amplitude - 1.0).min()))
        return tuple(np.array(rows).reshape(-1, 2).T)

    @property
    def message(self):
        """What was found, in words."""
        linear, lasting = self.linear_critical_speed, self.nonlinear_critical_speed
        parts = [f"steady rolling is stable from {self.speeds[0]:.4g} to {self.speeds[1]:.4g} m/s" if np.isnan(linear)
                 else f"steady rolling is unstable from {linear:.5g} m/s" + (f" ({self.criticality} Hopf bifurcation)" if self.stable_below else ", the lowest speed")]
        parts.append("no lasting limit cycle was found" if np.isnan(lasting) else f"limit cycles last from {lasting:.5g} m/s")
        return "; ".join((*parts, *self.notes))

    def plot(self, axes=None):
        """Draw the bifurcation diagram; returns the axes."""
        from railsym.plots.bifurcation import plot_bifurcation

        return plot_bifurcation(self, axes)


def _stable(branch):
    """Stable orbits, and folds beside one."""
    orbits = [orbit for orbit in branch.orbits if orbit.stable]
    near = {id(o) for k, o in enumerate(branch.orbits) if any(p.stable for p in branch.orbits[max(0, k - 1):k + 2])}
    for fold in branch.folds:
        k = int(np.argmin([abs(o.speed - fold.speed) + 1e3 * abs(o.amplitude.max() - fold.amplitude.max()) for o in branch.orbits]))
        if id(branch.orbits[k]) in near:
            orbits.append(fold)
    return orbits


def bifurcation(vehicle, *, contact, speeds, dt=1e-3, disturbance=3e-3, ramp_steps=21, ramps=True, continuation=True, points=150,
                longest=40.0, progress=None, **forces):
    """Limit cycles of a vehicle on straight track against speed.

    Parameters
    ----------
    vehicle : Vehicle
    contact : ContactPair, contact table, ConicalContact or WheelRail
    speeds : pair of float
        m/s, lowest and highest speed.
    dt : float
        s
    disturbance : float
        m, sideways displacement of the vehicle that the descending ramp begins with; the ascending one begins with 0.1 mm.
    ramp_steps : int
        Speeds of a ramp, over the range.
    ramps, continuation : bool
        What to do; continuation takes its beginnings from Hopf points, and from the ramps where those show further cycles.
    points : int
        Of a branch, at most.
    longest : float
        s, longest hold of a speed of a ramp.
    progress : callable, optional
        Gets lines of text.
    forces : dict
        Arguments of `railsym.WheelRail`: law, grid, friction, ...

    Returns
    -------
    Bifurcation

    Raises
    ------
    SimulationError, ContactError, ConvergenceError
        A range of speeds that is none, a contact without wheel-rail forces, no steady rolling.

    Notes
    -----
    docs/nonlinear_stability.md says how it is computed and how far to trust it.
    """
    low, high = _checked_range(speeds)
    if ramp_steps < 2 or points < 2:
        raise SimulationError(f"ramp_steps = {ramp_steps}, points = {points}: at least 2 are needed")
    say = (lambda text: None) if progress is None else progress
    system = RollingSystem(vehicle, contact, dt, **forces)
    stability = Stability(system)
    hopf, growth = stability.crossings(np.linspace(low, high, _SCAN))
    for point in hopf:
        say(f"Hopf point at {point.speed:.4f} m/s, {point.frequency_hz:.3f} Hz")
    down = up = None
    if ramps:
        down, up = _ramps(RollingSystem(vehicle, contact, dt, tolerance=RAMP_TOLERANCE, **forces), np.linspace(low, high, ramp_steps), disturbance, longest, say)
    branches, notes = _branches(system, hopf, (down, up), (low, high), points, say) if continuation else ([], [])
    name = vehicle.name + (f" {vehicle.configuration}" if vehicle.configuration else "")
    return Bifurcation(name, system.parts.wheels._law, (low, high), tuple(hopf), bool(growth[0] <= 0.0), tuple(branches), down, up, tuple(notes))


def _checked_range(speeds):
    values = np.asarray(speeds, dtype=float)
    if values.shape != (2,) or not np.isfinite(values).all() or not 0.0 < values[0] < values[1]:
        raise SimulationError(f"speeds = {speeds!r}: the lowest and the highest speed (m/s, above 0) are needed")
    return float(values[0]), float(values[1])


def _ramps(system, speeds, disturbance, longest, say):
    def show(speed, amplitude):
        say(f"ramp: {speed:.3f} m/s, {1e3 * amplitude.max():.3f} mm")

    return ramp(system, speeds[::-1], disturbance, longest, show), ramp(system, speeds, 1e-4, longest, show)


def _branches(system, hopf, ramps, speeds, points, say):
    """Branches from rising Hopf points, and from cycles of the ramps that those do not reach."""
    def show(orbit):
        say(f"orbit: {orbit.speed:.4f} m/s, {1e3 * orbit.amplitude.max():.4f} mm, {1.0 / orbit.period:.3f} Hz, |multiplier| {abs(orbit.dominant):.4f}")

    options = {"progress": show, "points": points, "speed_scale": max(0.5, 0.05 * (speeds[1] - speeds[0]))}
    branches, notes = [], []
    for point in hopf:
        if point.rising:
            _attempt(branches, notes, from_hopf, system, point, speeds, **options)
    begun = 0
    for one in ramps:
        for k in _periodic(one):
            if begun < _BEGINNINGS and not _known(branches, one.speed[k], one.largest[k]):
                before, begun = len(branches), begun + 1
                for along in (-1.0, 1.0):
                    _attempt(branches, notes, from_motion, system, one.states[k], 1.0 / one.frequency_hz[k], one.speed[k], speeds, along, **options)
                    if len(branches) == before:
                        break
    return branches, notes


def _periodic(one):
    """Numbers of the speeds of a ramp (or None) with a settled cycle, those in the middle first: the ends are near folds."""
    if one is None:
        return []
    found = np.flatnonzero(one.settled & one.lasting & np.isfinite(one.frequency_hz))
    return sorted(found, key=lambda k: abs(k - np.median(found)))


def _attempt(branches, notes, follow, *arguments, **options):
    try:
        branches.append(follow(*arguments, **options))
    except ConvergenceError as error:
        if str(error) not in notes:
            notes.append(str(error))


def _known(branches, speed, amplitude):
    """Whether an orbit of a branch is near, by interpolation along it."""
    for branch in branches:
        v, a = branch.speed, branch.amplitude
        for k in np.flatnonzero((v[:-1] - speed) * (v[1:] - speed) <= 0.0):
            share = 0.5 if v[k] == v[k + 1] else (speed - v[k]) / (v[k + 1] - v[k])
            if abs(a[k] + share * (a[k + 1] - a[k]) - amplitude) < _KNOWN * amplitude:
                return True
    return False
