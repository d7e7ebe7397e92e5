# SPDX-License-Identifier: BSD-3-Clause
"""Equilibria in curves of many radii: one line of straights, transitions and curves, along which each solution is the guess of the next.

    straight, transition, curve of the largest radius, transition, curve of the next radius, ...

In the curves speed and curvature are constant over the whole length of the vehicle. Where Newton's iteration does not reach the next curve
at once, it goes there through the transition by shorter steps.
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ConvergenceError
from railsym.simulation.quasi_static import Balance, continued
from railsym.simulation.speed_over_distance import SpeedOverDistance
from railsym.simulation.transient import Simulation
from railsym.track import Curve, Straight, Track, Transition

_SLACK = 10.0            # m of curve before and behind the vehicle: a transition's rounding does not reach it
_SHORTEST = 60.0         # m of transition
_GENTLE = 0.2            # m/s^2, along the transitions: no equilibrium is asked for there
_LEAST_SHARE = 1.0 / 32  # of the way from one curve to the next that is tried before a curve is given up


def equilibria(vehicle, radius, cant, speed, direction, contact, channels, forces, told=None):
    """Channels at the equilibrium in each curve.

    Parameters
    ----------
    vehicle : Vehicle
    radius, cant, speed : ndarray (n,)
        m, m, m/s, of each curve; in any order, the largest radius is taken first.
    direction : {"right", "left"}
    contact : WheelRail
    channels : sequence of str
    forces : dict
        Further arguments of `Simulation`.
    told : callable, optional
        Called without arguments after each curve.

    Yields
    ------
    index : int
        Of the curve.
    values : dict of str to float, or str
        By channel; or why there is none.
    """
    order = np.argsort(-radius)
    places, track, profile = line(vehicle, radius[order], cant[order], speed[order], direction)
    simulation = Simulation(vehicle, speed=profile, track=track, contact=contact, channels=channels, start=_first(vehicle), **forces)
    parts = simulation.parts
    parts.integrator._travel.set_steady()
    balance, times = Balance(parts), parts.speed.when(places)
    q, u = parts.start()
    x, now = np.where(balance.spin, u, q), 0.0
    names = [channel.name for channel in simulation.recorder.channels]
    for index, time in zip(order, times, strict=True):
        try:
            x, now = continued(balance, x, now, float(time), _LEAST_SHARE), float(time)
        except ConvergenceError:
            yield int(index), balance.trouble or "no equilibrium was found"
        else:
            parts.integrator.start(now, *balance.state(x))
            row = simulation.recorder.values(np.array([now]), parts.integrator.sample()[0][None])[0]
            yield int(index), dict(zip(names, row.tolist(), strict=True))
        if told is not None:
            told()


def line(vehicle, radius, cant, speed, direction):
    """Places of the vehicle's centre in the curves (m), the track, and the speed over distance."""
    ends = [body.position[0] for body in vehicle.bodies]
    ahead, behind = max(ends), -min(ends)
    curve = ahead + behind + 2.0 * _SLACK
    sections, places, points = [Straight(curve)], [], [(0.0, speed[0])]
    at, before = curve, speed[0]
    for R, c, V in zip(radius, cant, speed, strict=True):
        length = max(_SHORTEST, abs(V ** 2 - before ** 2) / (2.0 * _GENTLE))
        sections += [Transition(length), Curve(R, curve, c, direction)]
        points += [(at + _SLACK, before), (at + length - _SLACK, V)]
        at, before = at + length + curve, V
        places.append(at - _SLACK - ahead)
    found = np.array(points)
    profile = SpeedOverDistance(found[:, 0], found[:, 1], max_acceleration=10.0)
    return np.array(places), Track(sections, name="curves"), profile


def _first(vehicle):
    """Where the vehicle's centre is at first, m: its last body at s = _SLACK."""
    return _SLACK - min(body.position[0] for body in vehicle.bodies)
