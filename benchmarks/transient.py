# SPDX-License-Identifier: BSD-3-Clause
"""Cost of a step of the integrator, against SciPy on the same equations, and over the number of bodies.

Times are CPU times of one process, the least of several runs: on a machine with other work they still hold that work's cache
misses, so they are upper bounds.
"""

from dataclasses import replace
from time import process_time
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp

import railsym as rs
from benchmarks.measure import Figure
from benchmarks.transient_peers import peer_figures
from railsym._core import _doubles, lib
from railsym._core_integrator import Integrator
from railsym.contact import LinearContact
from railsym.linear import RollingVehicle
from railsym.model import Model
from railsym.simulation import Controls, Simulation

STEP, SPEED = 1e-3, 60.0


def least(function, count, repeat=20):
    """Least CPU time (s) of one of ``count`` calls, over ``repeat`` rounds."""
    best = np.inf
    for _ in range(repeat):
        start = process_time()
        for _ in range(count):
            function()
        best = min(best, process_time() - start)
    return best / count


def coupler(vehicle, k):
    """A bushing between the bodies of car k and the next one, 2 MN/m along the track."""
    place, like = np.array([-30.0 * k - 15.0, 0.0, -1.0]), next(e for e in vehicle.elements if e.type == "bushing")
    stiff = {"stiffness": np.array([2e6, 1e4, 1e4]), "damping": np.array([2e4, 1e2, 1e2])}
    ends = (replace(like.first, body=f"car{k + i}_{vehicle.bodies[0].name}", position=place) for i in (0, 1))
    return replace(like, name=f"coupler.{k}", first=next(ends), second=next(ends), axes=np.eye(3),
                   parameters=type(like.parameters)({**like.parameters, **stiff}))


def rolling_model(vehicle, cars=1, coupled=False):
    """A model of cars behind each other on linear contact, preloaded, and the number of its bodies with axleboxes."""
    one = RollingVehicle(vehicle)
    train = SimpleNamespace(name="train", gravity=vehicle.gravity, bodies=(), elements=())
    for k in range(cars):
        shift = np.array([-30.0 * k, 0.0, 0.0])
        name = lambda text, k=k: text if text == "track" else f"car{k}_{text}"  # noqa: E731
        train.bodies += tuple(replace(b, name=name(b.name), position=b.position + shift,
                                      axleboxes=tuple(replace(box, name=name(box.name)) for box in b.axleboxes)) for b in vehicle.bodies)
        train.elements += tuple(replace(e, name=name(e.name), first=replace(e.first, body=name(e.first.body), position=e.first.position + shift),
                                        second=replace(e.second, body=name(e.second.body), position=e.second.position + shift))
                                for e in vehicle.elements)
    couplers = cars - 1 if coupled else 0
    train.elements += tuple(coupler(vehicle, k) for k in range(couplers))
    model = Model(train)
    lines = sum(e.axis is None for e in one.model.laws)
    forces = one.preload.law_forces
    bushings = np.tile(one.preload.bushing_forces, (cars, 1))
    model.set_preload(np.concatenate([bushings, np.zeros((couplers, bushings.shape[1]))]), np.concatenate([np.tile(forces[:lines], cars), np.tile(forces[lines:], cars)]))
    contacts = one.contacts(LinearContact().resolved(vehicle.contact))
    model.add_wheels(type(contacts)(*(np.tile(getattr(contacts, name), cars) for name in contacts.__slots__)))
    model.set_speed(SPEED)
    return model, sum(1 + len(b.axleboxes) for b in train.bodies)


def integrator(model, step=STEP, tolerance=1e-2):
    """Integrator of a model, at its design position with the first car body 1 mm off the centre."""
    second = int((~model.topology.first_order).sum())
    starts = [model.topology.start[b.name] for b in model.vehicle.bodies]
    it = Integrator(model.assembly, np.searchsorted(starts, np.arange(second), side="right") - 1, step, 0.9, tolerance)
    q = np.zeros(model.size)
    q[model.topology.start[model.vehicle.bodies[0].name] + 1] = 1e-3
    it.set_channels([])
    assert it.start(0.0, q, model.rolling(SPEED)) == 0
    return it


def step_time(it, steps=200):
    """CPU time of a step (s)."""
    nothing = np.empty((1, 0))
    return least(lambda: it.run(steps, 10 ** 9, nothing), 1, 40) / steps


def linear_contact():
    """One step with kept factors, and its parts."""
    model, bodies = rolling_model(rs.load_vehicle("pendolino"))
    it = integrator(model)
    yield Figure(f"step, {bodies} bodies, linear contact", 1e6 * step_time(it), "us", 6.0, "kept factors, dt = 1 ms")
    q, u, a = it.state()
    state, seed, r, x = [_doubles(v) for v in (q, u, a)], _doubles(np.array([1.0, 2e3, 4e6])), np.empty(model.size), np.empty(model.size)
    residual = least(lambda: lib.rs_integrator_residual(it._pointer, 0.0, *state, _doubles(r)), 200)
    solved = least(lambda: lib.rs_integrator_solve(it._pointer, *state, seed, state[0], _doubles(x)), 100)
    dense = least(lambda: np.linalg.solve(model.pencil((1.0, 2e3, 4e6), q, u, a), q), 10)
    yield Figure("residual, 31 bodies", 1e6 * residual, "us", None, "from Python, about 0.6 us of it for the call")
    yield Figure("pencil, factors and solution, 31 bodies", 1e6 * solved, "us", None, "in blocks")
    yield Figure("the same dense (NumPy)", 1e6 * dense, "us")
    operations, doubles = it.fill()
    yield Figure("block operations of a factorisation", operations, "", None, f"{8e-3 * doubles:.0f} kB of factors")


def tilting():
    """The same with the tilting mechanism, and what a controller in Python pays for what it asks."""
    vehicle = rs.load_vehicle("pendolino_tilting")
    model, bodies = rolling_model(vehicle)
    yield Figure(f"step, {bodies} bodies with tilting jacks, linear contact", 1e6 * step_time(integrator(model)), "us", 7.0, "kept factors, dt = 1 ms")
    controls, place = Controls(Simulation(vehicle, speed=SPEED, track=rs.Track.straight(100.0))), vehicle.body("bogie1").position
    jack = "tilt_actuator.front_left"
    for what, ask, note in (("inertial unit", lambda: controls.imu("bogie1", place), "no evaluation of forces"),
                            ("length of a jack", lambda: controls.length(jack), "a further one; the first at a time evaluates all forces"),
                            ("command to a jack", lambda: controls.command(jack, 0.01), "")):
        yield Figure(f"controller in Python: {what}", 1e6 * least(ask, 1000), "us", 10.0, note)


def growth():
    """Cost over the number of bodies."""
    for cars, coupled in ((1, False), (2, False), (2, True), (4, False), (4, True)):
        model, bodies = rolling_model(rs.load_vehicle("pendolino"), cars, coupled)
        time, how = step_time(integrator(model)), "coupled" if coupled else "uncoupled"
        yield Figure(f"step, {bodies} bodies", 1e6 * time, "us", None, f"{1e6 * time / bodies:.3f} us a body, {cars} cars, {how}")


def table_contact():
    """The whole: contact table of S1002 on UIC60, irregular track, FASTSIM 20 x 20 and Polach."""
    vehicle, table = rs.load_vehicle("pendolino"), rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table()
    track = rs.Track.straight(1500.0).with_irregularity("erri_b176_low", seed=1)
    for law in ("fastsim", "polach"):
        simulation = Simulation(vehicle, speed=SPEED, track=track, contact=table, law=law, channels="s", rate=10.0)
        simulation.run(0.5)
        time = least(lambda: simulation.run(2.0), 1, 6) / 2000  # noqa: B023
        counts = simulation.result().info.extra["counts"]
        looks = (counts["residuals"] + counts["wheel_factors"]) / counts["steps"]
        yield Figure(f"step, 31 bodies, contact table, {law}", 1e6 * time, "us", 10.0, f"ERRI low at 60 m/s; {looks:.2f} residuals a step")


def against_scipy():
    """Radau with the analytic Jacobian on the same equations of the Pendolino, at the error of a 1 ms step."""
    model, _ = rolling_model(rs.load_vehicle("pendolino"))
    duration, n = 0.5, model.size
    q = np.zeros(n)
    q[1] = 5e-3

    def ours(step, tolerance):
        it = integrator(model, step, tolerance)
        it.start(0.0, q, model.rolling(SPEED))
        start = process_time()
        it.run(round(duration / step), 10 ** 9, np.empty((1, 0)))
        return process_time() - start, it.state()[0]

    used = ~model.topology.cyclic
    exact = ours(2e-5, 1e-5)[1][used]
    own = min((ours(STEP, 1e-2) for _ in range(5)), key=lambda found: found[0])
    error = np.abs(own[1][used] - exact).max()
    slope, jacobian = first_order(model)
    second = np.flatnonzero(~model.topology.first_order)
    for rtol in 10.0 ** np.arange(-2.0, -9.0, -0.5):
        start = process_time()
        found = solve_ivp(slope, (0.0, duration), np.concatenate([q, model.rolling(SPEED)[second]]), method="Radau", rtol=rtol, atol=1e-4 * rtol,
                          jac=jacobian)
        time = process_time() - start
        if np.abs(found.y[:n, -1][used] - exact).max() <= error:
            break
    yield Figure("times faster than SciPy's Radau at equal error", time / own[0], "", 30.0,
                 f"0.5 s, error {1e6 * error:.2g} um; Radau rtol {rtol:.0e}, {found.nfev} residuals, {time:.2g} s", at_least=True)


def first_order(model):
    """x' = f(x) and df/dx of the model, x = (q, u of bodies): dense, with the kernels' residual and pencil."""
    n, internal = model.size, np.flatnonzero(model.topology.first_order)
    second = np.flatnonzero(~model.topology.first_order)
    damping = np.diag(model.pencil((0.0, 1.0, 0.0)))[internal]
    mass = np.linalg.inv(model.pencil((0.0, 0.0, 1.0))[np.ix_(second, second)])  # attitudes are small: constant to 1e-4

    def slope(t, x):
        q, u = x[:n], np.zeros(n)
        u[second] = x[n:]
        a = np.zeros(n)
        for _ in range(2):
            a[second] -= mass @ model.residual(q, u, a)[second]
        rate = u.copy()
        rate[internal] = -model.residual(q, u, a)[internal] / damping
        return np.concatenate([rate, a[second]])

    def jacobian(t, x):
        q, u = x[:n], np.zeros(n)
        u[second] = x[n:]
        K, C = (model.pencil(seed, q, u) for seed in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
        out = np.zeros((len(x), len(x)))
        out[second, n + np.arange(len(second))] = 1.0
        out[internal, :n] = -K[internal] / damping[:, None]
        out[internal, n:] = -C[np.ix_(internal, second)] / damping[:, None]
        out[n:, :n], out[n:, n:] = -mass @ K[second], -mass @ C[np.ix_(second, second)]
        return out

    return slope, jacobian


def transient_figures():
    """All figures of the integrator."""
    yield from linear_contact()
    yield from tilting()
    yield from growth()
    yield from against_scipy()
    yield from table_contact()
    yield from peer_figures()
