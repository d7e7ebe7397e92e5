# SPDX-License-Identifier: BSD-3-Clause
"""Equilibria in curves: cost of one, against SciPy's solver of equations on the same residual."""

from __future__ import annotations

from time import process_time

import numpy as np

from benchmarks.measure import Figure

RADII = np.array([1500.0, 1250.0, 1000.0, 800.0, 600.0, 500.0, 400.0, 350.0, 300.0, 250.0])


def curving_figures():
    """The Pendolino in ten curves, S1002 on UIC 60, FASTSIM; CPU time, least of several runs."""
    import railsym as rs
    from railsym.wheel_rail import WheelRail

    vehicle = rs.load_vehicle("pendolino")
    wheels = WheelRail(vehicle, rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table(deepest=6e-4))

    def study():
        start = process_time()
        found = rs.curving(vehicle, radius=RADII, cant=0.15, cant_deficiency=0.1, contact=wheels)
        assert not found.failures
        return process_time() - start

    yield Figure("curving: ten radii, model made anew", min(study() for _ in range(5)), "s", 1.0, "Pendolino, contact table ready")
    solved, iterations, peer, reached = _against_scipy(vehicle, wheels)
    yield Figure("curving: one equilibrium", 1e3 * solved, "ms", 20.0, f"{iterations:.1f} linear systems a curve")
    yield Figure("the same by scipy.optimize.root (hybr)", 1e3 * peer, "ms", None, f"same residual and guesses; reaches {reached} of {len(RADII)}")


def _against_scipy(vehicle, wheels):
    """CPU time of a curve (s), linear systems; SciPy's time and how many curves it solves, from our solution of the curve before."""
    from scipy.optimize import root

    from railsym.curving.cases import cases
    from railsym.curving.steady import _first, line
    from railsym.errors import CoreError
    from railsym.simulation import Simulation
    from railsym.simulation.quasi_static import Balance

    asked = cases(RADII, 0.15, None, 0.1, vehicle.gravity)
    places, track, profile = line(vehicle, asked.radius, asked.cant, asked.speed[0], "right")
    simulation = Simulation(vehicle, speed=profile, track=track, contact=wheels, channels="s", start=_first(vehicle))
    simulation.parts.integrator._travel.set_steady()
    balance, times = Balance(simulation.parts), simulation.parts.speed.when(places)
    count, inner = [0], balance._move
    balance._move = lambda *given: (count.__setitem__(0, count[0] + 1), inner(*given))[1]
    q, u = simulation.parts.start()
    x, now, ours, theirs, reached = np.where(balance.spin, u, q), 0.0, 0.0, 0.0, 0
    for time in times:
        guess = balance.rolled(x, now, float(time))
        theirs, reached = (a + b for a, b in zip((theirs, reached), _scipy(root, balance, float(time), guess, CoreError), strict=True))
        start = process_time()
        x, now = balance.solve(float(time), guess), float(time)
        ours += process_time() - start
    return ours / len(times), count[0] / len(times), theirs / len(times), reached


def _scipy(root, balance, time, guess, outside):
    start = process_time()
    try:
        found = root(lambda y: balance.residual(time, y * balance.size) / balance.allowed, guess / balance.size, method="hybr")
        good = bool((np.abs(balance.residual(time, found.x * balance.size)) <= balance.allowed).all())
    except outside:      # a wheel beyond its table
        good = False
    return process_time() - start, int(good)
