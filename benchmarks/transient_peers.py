# SPDX-License-Identifier: BSD-3-Clause
"""The integrator with contact table and irregular track beside peers, in the same run: hand-written Numba (explicit_peer.py), and
SciPy's Radau and LSODA on our own residual."""

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from time import process_time

import numpy as np
from scipy.integrate import solve_ivp

import railsym as rs
from benchmarks.measure import ROOT, Figure, printed_by
from railsym.simulation import Simulation

SPEED = 60.0
LARGEST, SMALLEST = 1e-3, 1e-3 / 128  # s, steps tried with the explicit method


def setting():
    """Contact table and track of all figures here."""
    table = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table()
    return table, rs.Track.straight(1500.0).with_irregularity("erri_b176_low", seed=1)


def stiffer(vehicle, factor):
    """The vehicle with bushings ``factor`` times as stiff and as damped."""
    def scaled(element):
        if element.type != "bushing":
            return element
        names = ("stiffness", "rotational_stiffness", "damping", "rotational_damping")
        changed = {name: factor * element.parameters[name] for name in names if name in element.parameters}
        return replace(element, parameters=type(element.parameters)({**element.parameters, **changed}))

    return replace(vehicle, elements=tuple(scaled(element) for element in vehicle.elements))


def ours(vehicle, table, track, law):
    """A function that takes 500 steps more."""
    simulation = Simulation(vehicle, speed=SPEED, track=track, contact=table, law=law, channels="s", rate=10.0)
    simulation.run(0.5)
    nothing = np.empty((1, len(simulation.recorder.raw)))
    return lambda: simulation.parts.integrator.run(500, 10**9, nothing)


def explicit(vehicle, table, track, condensed):
    """The peer's function with the largest halved step with which it stays bounded (None where it never does), and that step."""
    from benchmarks.explicit_peer import peer, run

    own, rolling = peer(vehicle, table, SPEED, condensed)
    h = LARGEST
    while h >= SMALLEST:
        go, record = run(own, rolling, track, -own.offsets.max(), 0.5, h)
        go()
        if np.isfinite(record).all() and np.abs(record).max() < 0.05:
            return go, h
        h /= 2.0
    return None, h


def least_of_each(functions, rounds=12):
    """Least CPU time of each, taken in turns so that all meet the same machine."""
    best = np.full(len(functions), np.inf)
    for _ in range(rounds):
        for k, function in enumerate(functions):
            start = process_time()
            function()
            best[k] = min(best[k], process_time() - start)
    return best


def against_numba():
    """CPU time of a simulated second: ours at 1 ms, the hand-written explicit method at the largest step that is stable."""
    if not find_spec("numba"):
        yield Figure("Numba RK4", np.nan, "ms", None, "not measured: pip install numba")
        return
    table, track = setting()
    nominal = rs.load_vehicle("pendolino")
    for name, vehicle in (("nominal", nominal), ("ten times stiffer bushings", stiffer(nominal, 10.0))):
        coach, full = (explicit(vehicle, table, track, condensed) for condensed in (True, False))
        functions = [ours(vehicle, table, track, "polach"), ours(vehicle, table, track, "fastsim"), coach[0]]
        best = least_of_each(functions + ([full[0]] if full[0] else []))
        cost = 2e3 * best  # ms a second: half a second was run
        yield Figure(f"a simulated second, {name}: ours, Polach", cost[0], "ms", 10.0, f"{cost[0]:.2f} us a step of 1 ms, 31 bodies")
        yield Figure(f"a simulated second, {name}: ours, FASTSIM", cost[1], "ms", 10.0, f"{cost[1]:.2f} us a step of 1 ms, 31 bodies")
        yield Figure("the same: Numba RK4 of a coach, Polach", cost[2], "ms", None,
                     f"{cost[2] * 1e3 * coach[1]:.2f} us a step of {1e3 * coach[1]:.3g} ms, 15 bodies, linear suspension")
        if full[0] is None:
            yield Figure("the same: Numba RK4 of all 31 bodies", np.inf, "ms", None, f"unstable at {1e3 * SMALLEST:.3g} ms")
        else:
            yield Figure("the same: Numba RK4 of all 31 bodies", cost[3], "ms", None,
                         f"{cost[3] * 1e3 * full[1]:.2f} us a step of {1e3 * full[1]:.3g} ms, linear suspension")


def first_order(simulation):
    """x' = f(t, x), x = (q, u of bodies), with the residual of the whole vehicle with wheels and track."""
    parts = simulation.parts
    n, second = parts.model.size, np.arange(parts.second)
    internal = np.arange(parts.second, n)
    damping = np.diag(parts.model.pencil((0.0, 1.0, 0.0)))[internal]
    mass = np.linalg.inv(parts.model.pencil((0.0, 0.0, 1.0))[: parts.second, : parts.second])

    def slope(t, x):
        u, a = np.zeros(n), np.zeros(n)
        u[second] = x[n:]
        for _ in range(2):
            r = parts.integrator.residual(t, x[:n], u, a)
            a[second] -= mass @ r[second]
        u[internal] = -r[internal] / damping
        return np.concatenate([u, a[second]])

    return slope, n


def against_scipy_on_table():
    """Radau and LSODA with contact table and irregular track, at the error of a 1 ms step."""
    table, track = setting()
    vehicle, duration = rs.load_vehicle("pendolino"), 0.1

    def own(step, tolerance):
        simulation = Simulation(vehicle, speed=SPEED, track=track, contact=table, law="polach", channels="s", rate=10.0, dt=step, tolerance=tolerance)
        q, u, _ = simulation.parts.integrator.state()
        nothing, start = np.empty((1, len(simulation.recorder.raw))), process_time()
        simulation.parts.integrator.run(round(duration / step), 10**9, nothing)
        return process_time() - start, simulation.parts.integrator.state()[0], simulation, np.concatenate([q, u[: simulation.parts.second]])

    exact, simulation, begin = own(2e-5, 1e-5)[1:]
    used = ~simulation.parts.model.topology.cyclic
    time, q = min((own(1e-3, 1e-2)[:2] for _ in range(5)), key=lambda found: found[0])
    error = np.abs(q[used] - exact[used]).max()
    slope, n = first_order(simulation)
    for method in ("Radau", "LSODA"):
        for rtol in 10.0 ** np.arange(-2.0, -8.0, -1.0):
            start = process_time()
            found = solve_ivp(slope, (0.0, duration), begin, method=method, rtol=rtol, atol=1e-3 * rtol)
            spent, reached = process_time() - start, np.abs(found.y[:n, -1][used] - exact[used]).max()
            if reached <= error:
                break
        yield Figure(f"times faster than SciPy's {method}, contact table", spent / time, "", 30.0,
                     f"{duration} s; error {1e6 * error:.2g} um, {method} {1e6 * reached:.2g} um with rtol {rtol:.0e}, {found.nfev} slopes, "
                     f"{spent:.3g} s", at_least=True)


def memory():
    """Peak memory of a run of 60 s with 100 channels at 200 Hz, as the process itself knows it: its parent's is not in it."""
    if not Path("/proc/self/status").exists():
        yield Figure("memory of 60 s with 100 channels", np.nan, "MB", 200.0, "not measured: no /proc")
        return
    code = """
import railsym as rs
vehicle = rs.load_vehicle("pendolino")
track = rs.Track.straight(4000.0).with_irregularity("erri_b176_low", seed=1)
table = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table()
simulation = rs.Simulation(vehicle, speed=60.0, track=track, contact=table, law="fastsim")
names = list(simulation.available)[:100]
run = rs.simulate(vehicle, speed=60.0, duration=60.0, track=track, contact=table, law="fastsim", channels=names, rate=200.0)
assert run.status == "completed" and len(run.time) == 12001
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""
    yield Figure("memory of 60 s with 100 channels", printed_by(code, Path(ROOT).parent) / 1024.0, "MB", 200.0, "peak, Python and libraries included")


def peer_figures():
    """All of them."""
    yield from against_numba()
    yield from against_scipy_on_table()
    yield from memory()
