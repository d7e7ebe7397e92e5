# SPDX-License-Identifier: BSD-3-Clause
"""Motions with a known answer: closed forms, invariants, the linear vehicle's matrix exponential, SciPy on the same residual."""

import numpy as np
import pytest
from oracles import free_bodies
from oracles.stepping import integrator, linear_motion, motion, rolling_model
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from railsym.linear import linearise
from railsym.model import Model
from railsym.vehicle import load_vehicle

PENDULUM = """
[vehicle]
name = "pendulum"
description = "a body on a stiff rod"
gravity = [9.81, "m/s^2", "assumed"]
[origins]
assumed = "assumed"
[bodies.body]
kind = "rigid_body"
mass = [100, "kg"]
inertia = [[20, 20, 20], "kg*m^2"]
origin = "assumed"
at = { body = [[0, 0, 2], "m"] }
[elements.rod]
type = "traction_rod"
stiffness = [5e8, "N/m"]
origin = "assumed"
at = [{ name = "rod", first = "body", second = "track", first_position = [[0, 0, 2], "m"], second_position = [[0, 0, 0], "m"] }]
"""


def pendulum(tmp_path):
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM, encoding="ascii")
    model = Model(load_vehicle(path))
    model.set_speed(0.0)
    return model


@pytest.mark.parametrize("axleboxes", [None, False, True])
def test_free_body_keeps_momentum_exactly_and_energy_to_second_order(axleboxes):
    body = free_bodies.rigid_body() if axleboxes is None else free_bodies.wheelset(axleboxes)
    model = Model(free_bodies.vehicle(body))
    model.set_speed(0.0)
    rng = np.random.default_rng(41)
    q, u = rng.uniform(-0.8, 0.8, (2, model.size))
    u[5] = 1.5
    first, error = free_bodies.invariants(body, q, u), []
    for step in (4e-3, 2e-3):
        it = integrator(model, step, rho=1.0, tolerance=1e-9)
        motion(it, q, u, round(2.0 / step))
        error.append(np.abs(free_bodies.invariants(body, *it.state()[:2]) - first) / np.abs(first).max())
    assert error[1].max() < 1e-4
    turning = [0, 4, 5, 6]  # energy and angular momentum; linear momentum is below, a line is followed exactly without boxes
    assert np.log2(error[0][turning].max() / error[1][turning].max()) == pytest.approx(2.0, abs=0.1)
    if not axleboxes:
        assert error[1][1:4].max() < 1e-12


def test_pendulum_period_at_a_large_angle(tmp_path):
    """T = 4 sqrt(L/g) K(sin^2(theta/2)); the rod gives by 2 um."""
    model, theta, length = pendulum(tmp_path), 1.0, 2.0
    period = 4.0 * np.sqrt(length / 9.81) * ellipk(np.sin(0.5 * theta) ** 2)
    q, error = np.zeros(6), []
    q[1], q[2] = length * np.sin(theta), length * (np.cos(theta) - 1.0)
    for steps in (400, 800):
        it = integrator(model, period / steps, rho=0.8)
        path = motion(it, q, np.zeros(6), steps)
        error.append(np.hypot(*(path[-1, 1:3] - q[1:3])))
    assert error[1] < 1e-3 and np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.15)


def test_energy_over_a_thousand_swings_without_dissipation(tmp_path):
    """rho = 1 keeps the energy of a swing of 0.3 rad within the square of the step, without drift."""
    model, theta = pendulum(tmp_path), 0.3
    q = np.array([0.0, 2.0 * np.sin(theta), 2.0 * (np.cos(theta) - 1.0), 0.0, 0.0, 0.0])
    it = integrator(model, 0.02, rho=1.0, tolerance=1e-8)
    it.set_channels([("position", 2, 0, 0), ("rate", 1, 0, 0), ("rate", 2, 0, 0), ("position", 1, 0, 0)])
    it.start(0.0, q, np.zeros(6))
    samples = np.empty((142000 // 10, 4))
    assert it.run(142000, 10, samples) == (0, 14200)
    z, vy, vz, y = samples.T
    stretch = np.hypot(y, 2.0 + z) - 2.0
    energy = 50.0 * (vy ** 2 + vz ** 2) - 981.0 * z + 2.5e8 * stretch ** 2
    depth = 981.0 * 2.0 * (1.0 - np.cos(theta))
    assert np.ptp(energy) < 0.02 * depth                   # the stiff rod's own motion is not resolved, and not damped
    assert abs(energy[-1000:].mean() - energy[:1000].mean()) < 1e-3 * depth


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9, 1.0])
def test_second_order_in_everything(rho):
    """Positions, rates, accelerations and Maxwell states of the bogie against a step thirty times finer."""
    vehicle = load_vehicle("bogie").configured("with_anti_yaw_dampers")
    model = rolling_model(vehicle, 40.0)
    n, names = model.size, model.topology.coordinates
    q = np.zeros(n)
    q[names.index("wheelset1.y")] = 2e-3
    ends = []
    for step in (2e-3, 1e-3, 1e-3 / 32):
        it = integrator(model, step, rho, tolerance=1e-9)
        motion(it, q, model.rolling(40.0), round(0.25 / step))
        ends.append(it.state())
    used = ~model.topology.cyclic
    for part, what in enumerate(("position", "rate", "acceleration")):
        here = used & ~model.topology.first_order if part == 2 else used
        coarse, fine = (np.abs(ends[k][part] - ends[2][part])[here].max() for k in (0, 1))
        assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.35), (what, coarse, fine)


@pytest.mark.parametrize(("name", "configuration", "speed"), [("bogie", "with_anti_yaw_dampers", 40.0), ("pendolino", "AS_K", 70.0)])
def test_small_motions_are_those_of_the_linear_model(name, configuration, speed):
    """Against exp(A t): 0.1 um of lateral displacement, where the non-linear terms are below rounding of the comparison."""
    vehicle = load_vehicle(name).configured(configuration)
    model, lin = rolling_model(vehicle, speed), linearise(vehicle, speed)
    names = list(model.topology.coordinates)
    q = np.zeros(model.size)
    for k, body in enumerate(vehicle.bodies):
        q[names.index(f"{body.name}.y")] = 1e-7 * (1 + k % 3)
    step, every = 5e-5, 200
    base = motion(integrator(model, step, tolerance=1e-10), np.zeros(model.size), model.rolling(speed), 6000, every)
    path = motion(integrator(model, step, tolerance=1e-10), q, model.rolling(speed), 6000, every) - base
    exact = linear_motion(lin, q, np.arange(len(path)) * every * step)
    lateral = [k for k, name in enumerate(names) if name.endswith((".y", ".yaw", ".roll"))]
    columns = [lin.states.index(names[k]) for k in lateral]
    error = np.abs(path[:, lateral] - exact[:, columns]).max()
    assert error < 2e-4 * np.abs(exact[:, columns]).max()  # (omega h)^2/12 of motions up to 150 Hz


def test_critical_speed_of_the_linear_model():
    """Growth and decay change sign within 0.5 % of the speed that the eigenvalues give."""
    from railsym.critical_speed import critical_speed

    vehicle = load_vehicle("bogie").configured("without_anti_yaw_dampers")
    critical = float(critical_speed(vehicle, conicity=0.2).speed)
    for factor, grows in ((0.995, False), (1.005, True)):
        model = rolling_model(vehicle, factor * critical, conicity=0.2)
        q = np.zeros(model.size)
        q[list(model.topology.coordinates).index("wheelset1.y")] = 1e-6
        path = motion(integrator(model, 1e-3, tolerance=1e-9), q, model.rolling(factor * critical), 30000, 10)
        y = path[:, list(model.topology.coordinates).index("wheelset1.y")]
        late, later = (np.abs(y[part] - y[part].mean()).max() for part in (slice(1000, 1500), slice(2500, 3000)))
        assert (later > late) == grows, (factor, late, later)


def test_against_radau_on_the_same_residual():
    """SciPy's Radau at tight tolerances, with the mass matrix and damper rates solved densely."""
    vehicle = load_vehicle("bogie").configured("with_anti_yaw_dampers")
    speed = 40.0
    model = rolling_model(vehicle, speed)
    n, internal = model.size, np.flatnonzero(model.topology.first_order)
    names = list(model.topology.coordinates)
    inertia = model.pencil((0.0, 0.0, 1.0)) + model.pencil((0.0, 1.0, 0.0)) * np.outer(model.topology.first_order, model.topology.first_order)
    second = np.flatnonzero(~model.topology.first_order)

    def slope(t, x):
        q, u = x[:n], np.zeros(n)
        u[second] = x[n:]
        a = np.linalg.solve(model.pencil((0.0, 0.0, 1.0), q, u)[np.ix_(second, second)], -model.residual(q, u)[second])
        rate = u.copy()
        rate[internal] = -model.residual(q, u)[internal] / np.diag(inertia)[internal]
        return np.concatenate([rate, a])

    q = np.zeros(n)
    q[names.index("wheelset1.y")] = 2e-3
    it = integrator(model, 2.5e-4, tolerance=1e-8)
    path = motion(it, q, model.rolling(speed), 800, 80)
    found = solve_ivp(slope, (0.0, 0.2), np.concatenate([q, model.rolling(speed)[second]]), method="Radau", rtol=1e-8, atol=1e-11,
                      t_eval=np.arange(11) * 0.02)
    used = ~model.topology.cyclic
    np.testing.assert_allclose(path[:, used], found.y[:n].T[:, used], atol=4e-6)  # (omega h)^2/12 of 2 mm at 100 Hz
