# SPDX-License-Identifier: BSD-3-Clause
"""Equilibrium in a curve: attitude and wheel forces where every coordinate rests against its track frame.

    r(q, u, 0) = 0,   u = 0 but for the wheelsets' spins, which turn as the creep forces make them

Unknown are all coordinates but the spin angles, and the spin rates in their place. Newton's iteration, with derivatives by
differences of the same residual that the integrator steps; from place to place along the track the last solution is the next
guess, so that a passage from straight to curve is a continuation in curvature. The angular acceleration of the frames in a transition is
left out. Also for a vehicle that is unstable there.
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ConvergenceError, CoreError
from railsym.results import Run
from railsym.results.metadata import Ending
from railsym.simulation.transient import Simulation

_STEP = 1e-7       # m or rad; 100 N on the stiffest contact, 1e-8 of which is rounding
_SPIN_STEP = 1e-5  # rad/s
_FORCE = 1e-7      # of the vehicle's weight: N, and N m on 1 m, that may be left over in one equation
_ITERATIONS = 40
_SHARE = 1.0 / 64.0  # of the commands, first step: small against the way from which on an actuator is at its limit


class _Balance:
    """Residual over the unknowns at one time."""

    def __init__(self, parts):
        self.parts, topology = parts, parts.model.topology
        self.spin = topology.cyclic
        self.steps = np.where(self.spin, _SPIN_STEP, _STEP)
        weight = parts.vehicle.gravity * sum(b.mass for b in parts.vehicle.bodies)
        self.allowed = _FORCE * weight * np.where(topology.first_order, 1e-1, 1.0)

    def state(self, x):
        """q and u of the unknowns."""
        return np.where(self.spin, 0.0, x), np.where(self.spin, x, 0.0)

    def residual(self, time, x):
        """r (n,)"""
        q, u = self.state(x)
        return self.parts.integrator.residual(time, q, u, np.zeros_like(q))

    def jacobian(self, time, x, r):
        """dr/dx (n, n) by differences."""
        columns = []
        for k, step in enumerate(self.steps):
            moved = x.copy()
            moved[k] += step
            columns.append((self.residual(time, moved) - r) / step)
        return np.array(columns).T

    def solve(self, time, x):
        """The unknowns where r = 0, from a guess; None where the iteration does not get there."""
        try:
            r = self.residual(time, x)
            for _ in range(_ITERATIONS):
                if (np.abs(r) <= self.allowed).all():
                    return x
                x, r = self._nearer(time, x, r, np.linalg.solve(self.jacobian(time, x, r), -r))
        except (CoreError, np.linalg.LinAlgError):
            pass
        return None

    def _nearer(self, time, x, r, move):
        """The Newton step, shortened until the residual exists and does not grow much."""
        size = np.abs(r / self.allowed).max()
        for share in 0.5 ** np.arange(12):
            try:
                new = self.residual(time, x + share * move)
            except CoreError:
                continue
            if np.abs(new / self.allowed).max() <= 1.5 * size:
                return x + share * move, new
        raise CoreError("no step of Newton's iteration makes the residual smaller")


def quasi_static(vehicle, *, speed, track, places, contact="linear", channels=None, markers=None, commands=None, **forces):
    """Equilibria of a vehicle along a track.

    Parameters
    ----------
    vehicle, speed, contact, channels, markers, commands, forces
        As `Simulation`; the speed is constant, and irregularities of the track are as large as they are there.
    track : railsym.Track
    places : array_like (k,)
        m, arc lengths of the vehicle's centre, increasing. The first should lie where the solution is near the design position, on
        a straight or at the beginning of a transition; the steps follow the transition finely enough for each solution to
        serve as the next guess (they are halved where it does not).

    Returns
    -------
    railsym.Run
        Over time = (s - first place)/speed, with the same channels as a simulation: what it would tend to there, were each place
        an endless curve.

    Raises
    ------
    ConvergenceError
        With the place from which on no equilibrium was found: the vehicle cannot run there, or a wheel leaves its contact table.
    """
    places = np.atleast_1d(np.asarray(places, dtype=float))
    simulation = Simulation(vehicle, speed=speed, track=track, contact=contact, channels=channels, markers=markers,
                            start=float(places[0]), **forces)
    times, rows = (places - places[0]) / float(np.asarray(speed)), []
    for time, (q, u) in zip(times, _equilibria(simulation, places, float(speed), commands), strict=True):
        simulation.parts.integrator.start(time, q, u)
        rows.append(simulation.recorder.values(np.array([time]), simulation.parts.integrator.sample()[0][None])[0])
    info = simulation.info.ended(Ending("completed", time=float(times[-1]), distance=float(places[-1])), "quasi-static equilibria along the track")
    return Run(times, np.array(rows), simulation.recorder.channels, info)


def steady_state(vehicle, *, speed, track, place, contact="linear", begin=None, commands=None, **forces):
    """Coordinates and rates of the equilibrium at one place: what a run that begins in a curve starts from.

        state = rs.steady_state(vehicle, speed=25.0, track=curve, place=120.0, contact=pair)
        rs.simulate(vehicle, speed=25.0, track=curve, contact=pair, start=120.0, initial=state, ...)

    Parameters
    ----------
    vehicle, speed, track, contact, commands, forces
        As `quasi_static`.
    place : float
        m, arc length of the vehicle's centre.
    begin : float, optional
        m, where the continuation begins, on a straight or near the beginning of the transition; where the foremost body stands at s = 0 if not
        given.

    Returns
    -------
    tuple of ndarray, shape (n,)
        q and u, for ``initial`` of `simulate`.

    Raises
    ------
    ConvergenceError
        As `quasi_static`.
    """
    foremost = max((body.position[0] for body in vehicle.bodies), default=0.0)
    places = np.array([-foremost if begin is None else begin, place], dtype=float)
    simulation = Simulation(vehicle, speed=speed, track=track, contact=contact, start=float(places[0]), **forces)
    return list(_equilibria(simulation, places, float(speed), commands))[-1]


def _equilibria(simulation, places, speed, commands):
    """q and u at each place, one after the other, with actuators at their commands."""
    parts, times = simulation.parts, (places - places[0]) / speed
    parts.check_track(float(times[-1]))
    parts.integrator._travel.set_steady()
    balance = _Balance(parts)
    q, u = parts.start()
    x, now = np.where(balance.spin, u, q), 0.0
    if commands:
        x = _commanded(balance, simulation, x, commands)
    for time in times:
        x = _continued(balance, x, now, time, places[0], speed)
        now = time
        yield balance.state(x)


def _commanded(balance, simulation, x, commands):
    """Solution at the first place with all commands, from small shares of them: each step begins where the last one points, since an actuator
    that is far from its command is at its limit, where its force tells nothing of the way."""
    at, step, slope = 0.0, _SHARE, np.zeros_like(x)
    while at < 1.0:
        step = min(step, 1.0 - at)
        guess = x + step * slope
        simulation.command({name: (at + step) * value for name, value in commands.items()}, guess)
        found = balance.solve(0.0, guess)
        if found is None:
            step *= 0.5
            if step < _SHARE / 256.0:
                raise ConvergenceError(f"no equilibrium was found beyond {100.0 * at:.4g} % of the commands: {commands}; an actuator cannot reach its "
                                       "own (force limit, stop), or the vehicle cannot stand so")
            continue
        slope, x, at, step = (found - x) / step, found, at + step, 2.0 * step
    return x


def _continued(balance, x, start, end, first, speed):
    """Solution at ``end`` (s) from that at ``start``, by steps that are halved where the iteration fails."""
    share, at = 1.0, 0.0
    while at < 1.0:
        share = min(share, 1.0 - at)
        found = balance.solve(start + (at + share) * (end - start), x)
        if found is None:
            share *= 0.5
            if share < 1.0 / 256.0 or end == start:
                place = first + speed * (start + at * (end - start))
                raise ConvergenceError(f"no equilibrium was found beyond s = {place:.6g} m: the vehicle cannot run there steadily, or a wheel leaves "
                                       "its contact table; look at the last places (places=...) and begin on a straight")
            continue
        x, at = found, at + share
    return x
