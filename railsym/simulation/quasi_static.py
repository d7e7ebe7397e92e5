# SPDX-License-Identifier: BSD-3-Clause
"""Equilibrium in a curve: attitude and wheel forces where every coordinate rests against its track frame.

    r(q, u, 0) = 0,   u = 0 but for the wheelsets' spins, which turn as the creep forces make them

Unknown are all coordinates but the spin angles, and the spin rates in their place. Newton's iteration with the exact slopes that the
integrator steps with; where a step of it is too long, which it is where a wheel comes to another part of its rail, the vehicle is let go
towards its equilibrium from rest by steps of implicit Euler with all mass and damping, which grow until they are Newton's (pseudo-transient
continuation, Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508). From place to place along the track the last solution is the next
guess, so that a passage from straight to curve is a continuation in curvature. The angular acceleration of the frames in a transition is
left out. Also for a vehicle that is unstable there.
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ContactError, ConvergenceError, CoreError
from railsym.results import Run
from railsym.results.metadata import Ending
from railsym.simulation.transient import Simulation

_FORCE = 1e-7        # of the vehicle's weight: N, and N m on 1 m, that may be left over in one equation
_ITERATIONS = 300    # some 15 from curve to curve, 60 where wheels meet another part of their rail
_NEWTON = 1e4        # s, pseudo-time step from which on the iteration is Newton's
_FIRST, _LEAST = 0.1, 1e-5  # s, pseudo-time step after the first failure, and the shortest
_GROWTH, _SHRINK = 4.0, 0.25
_SIZE, _SPIN_SIZE = 1e-3, 0.1  # m or rad, rad/s: what a norm of displacements counts as one
_FARTHEST = 20.0     # of these sizes in one step
_SHARE = 1.0 / 64.0  # of the commands, first step: small against the way from which on an actuator is at its limit


class Balance:
    """Residual over the unknowns at one time.

    Attributes
    ----------
    trouble : str
        What a wheel had to say when the last iteration failed.
    """

    def __init__(self, parts):
        self.parts, self.trouble, topology = parts, "", parts.model.topology
        self.spin = topology.cyclic
        self.size = np.where(self.spin, _SPIN_SIZE, _SIZE)
        weight = parts.vehicle.gravity * sum(b.mass for b in parts.vehicle.bodies)
        self.allowed = _FORCE * weight * np.where(topology.first_order, 1e-1, 1.0)

    def state(self, x):
        """q and u of the unknowns."""
        return np.where(self.spin, 0.0, x), np.where(self.spin, x, 0.0)

    def rolled(self, x, start, end):
        """The unknowns with the wheelsets turning as the speed changes between two times (s)."""
        before, after = self.parts.speed.at(np.array([start, end]))
        return np.where(self.spin, x * (after / before), x)

    def residual(self, time, x):
        """r (n,)"""
        q, u = self.state(x)
        return self.parts.integrator.residual(time, q, u, np.zeros_like(q))

    def solve(self, time, x):
        """The unknowns where r = 0, from a guess; None where the iteration does not get there."""
        self.trouble, step = "", _NEWTON
        try:
            r = self.residual(time, x)
            for _ in range(_ITERATIONS):
                if (np.abs(r) <= self.allowed).all():
                    return x
                nearer = self._nearer(time, x, r, step)
                if nearer is not None:
                    (x, r), step = nearer, min(_GROWTH * step, _NEWTON)
                elif (step := _SHRINK * min(step, _FIRST / _SHRINK)) < _LEAST:
                    break
        except CoreError as error:
            self._note(error, time)
        self.trouble = self.trouble or "the iteration does not get there"
        return None

    def _nearer(self, time, x, r, step):
        """Unknowns and residual after a step of pseudo-time; None where the step is too long for one linearisation."""
        zero = np.zeros_like(x)
        try:
            self.residual(time, x)      # the frames of this place, for the slopes
            move = self._move(*self.state(x), zero, r, step)
            size = np.linalg.norm(move / self.size)
            if not np.abs(move / self.size).max() <= _FARTHEST:
                return None
            q, spins = self.state(x + move)
            u, a = np.where(self.spin, spins, move / step), np.where(self.spin, move / step, move / step ** 2)
            left = self._move(q, u, a, self.parts.integrator.residual(time, q, u, a), step)
            if not np.linalg.norm(left / self.size) <= 0.5 * size:
                return None
            return x + move, self.residual(time, x + move)
        except CoreError as error:
            self._note(error, time)
            return None

    def _move(self, q, u, a, r, step):
        """Change of the unknowns that undoes r in a step of implicit Euler from rest."""
        move = self.parts.integrator.solve(q, u, a, np.array([1.0, 1.0 / step, 1.0 / step ** 2]), -r)
        return np.where(self.spin, move / step, move)

    def _note(self, error, time):
        self.trouble = wheel_trouble(self.parts, error.status, time) or str(error)


def wheel_trouble(parts, status, time):
    """What keeps a wheel from having forces, in words; empty where no wheel is to blame."""
    from railsym import _core_integrator as core

    if parts.wheels is None or status != core.OUT_OF_TABLE:
        return ""
    try:
        parts.wheels._core.explain(status, float(parts.speed.at(time)))
    except ContactError as error:
        return str(error)
    return ""


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
    balance = Balance(parts)
    q, u = parts.start()
    x, now = np.where(balance.spin, u, q), 0.0
    if commands:
        x = _commanded(balance, simulation, x, commands)
    for time in times:
        x = continued(balance, x, now, time)
        now = time
        yield balance.state(x)


def _commanded(balance, simulation, x, commands):
    """Solution at the first place with all commands, from small shares of them: each step begins where the last one points, since an actuator
    that is far from its command is at its limit, where its force tells nothing of the way."""
    at, step, slope = 0.0, _SHARE, np.zeros_like(x)
    while at < 1.0:
        step = min(step, 1.0 - at)
        guess = x + step * slope
        simulation._command({name: (at + step) * value for name, value in commands.items()}, guess)
        found = balance.solve(0.0, guess)
        if found is None:
            step *= 0.5
            if step < _SHARE / 256.0:
                raise ConvergenceError(f"no equilibrium was found beyond {100.0 * at:.4g} % of the commands: {commands}; an actuator cannot reach its "
                                       "own (force limit, stop), or the vehicle cannot stand so")
            continue
        slope, x, at, step = (found - x) / step, found, at + step, 2.0 * step
    return x


def continued(balance, x, start, end, shortest=1.0 / 256.0):
    """Solution at ``end`` (s) from that at ``start``, by steps that are halved where the iteration fails.

    Parameters
    ----------
    balance : Balance
    x : ndarray (n,)
        Unknowns at the start.
    start, end : float
        s
    shortest : float
        Least part of the way that is tried.

    Returns
    -------
    ndarray (n,)

    Raises
    ------
    ConvergenceError
    """
    share, at = 1.0, 0.0
    while at < 1.0:
        share = min(share, 1.0 - at)
        found = balance.solve(start + (at + share) * (end - start), balance.rolled(x, *(start + part * (end - start) for part in (at, at + share))))
        if found is None:
            share *= 0.5
            if share < shortest or end == start:
                place = float(balance.parts.speed.place(start + at * (end - start)))
                why = f" ({balance.trouble})" if balance.trouble else ""
                raise ConvergenceError(f"no equilibrium was found beyond s = {place:.6g} m: the vehicle cannot run there steadily, or a wheel leaves "
                                       f"its contact table{why}; look at the last places (places=...) and begin on a straight")
            continue
        x, at = found, at + share
    return x
