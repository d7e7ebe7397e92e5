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
[contact]
friction = [0.3, "-", "assumed"]
kalker_weight = [1.0, "-", "assumed"]
amplitude = [3, "mm", "assumed"]
wheel_transverse_radius = [inf, "m", "assumed"]
rail_transverse_radius = [0.3, "m", "assumed"]
young_modulus = [210, "GPa", "assumed"]
poisson_ratio = [0.28, "-", "assumed"]
[bodies.body]
kind = "rigid_body"
mass = [100, "kg"]
inertia = [[20, 20, 20], "kg*m^2"]
origin = "assumed"
at = { body = [[0, 0, -1], "m"] }
[elements.rod]
type = "traction_rod"
stiffness = [STIFFNESS, "N/m"]
origin = "assumed"
at = [{ name = "rod", first = "body", second = "track", first_position = [[0, 0, -1], "m"], second_position = [[0, 0, -3], "m"] }]
"""


def pendulum(tmp_path, stiffness):
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM.replace("STIFFNESS", f"{stiffness:g}"), encoding="ascii")
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
    """T = 4 sqrt(L/g) K(sin^2(theta/2)): at 5/4 T the body passes below the pivot; the rod gives by 2 um."""
    model, theta, length = pendulum(tmp_path, 5e8), 1.0, 2.0
    period = 4.0 * np.sqrt(length / 9.81) * ellipk(np.sin(0.5 * theta) ** 2)
    q, error = np.zeros(6), []
    q[1], q[2] = length * np.sin(theta), length * (np.cos(theta) - 1.0)
    for steps in (800, 1600):
        path = motion(integrator(model, 1.25 * period / steps, rho=0.5, tolerance=1e-5), q, np.zeros(6), steps)
        error.append(abs(path[-1, 1]))
    assert error[1] < 2e-4 and np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.2)


def test_energy_over_a_thousand_swings_without_dissipation(tmp_path):
    """rho = 1 keeps the energy of an elastic pendulum within the square of the step, without drift; rho = 0.5 does not."""
    model, theta = pendulum(tmp_path, 2e4), 0.5
    q = np.array([0.0, 2.0 * np.sin(theta), 2.0 * (np.cos(theta) - 1.0), 0.0, 0.0, 0.0])
    depth, spread = 981.0 * 2.0 * (1.0 - np.cos(theta)), {}
    for rho, step in ((1.0, 0.02), (1.0, 0.01), (0.5, 0.02)):
        it = integrator(model, step, rho, tolerance=1e-7)
        it.set_channels([("position", 1, 0, 0), ("position", 2, 0, 0), ("rate", 1, 0, 0), ("rate", 2, 0, 0)])
        assert it.start(0.0, q, np.zeros(6)) == 0
        samples = np.empty((round(2840.0 / step) // 10, 4))
        assert it.run(10 * len(samples), 10, samples) == (0, len(samples))
        y, z, vy, vz = samples.T
        energy = 50.0 * (vy ** 2 + vz ** 2) - 981.0 * z + 1e4 * (np.hypot(y, 2.0 + z) - 2.0) ** 2
        quarter = len(energy) // 4
        spread[rho, step] = np.ptp(energy) / depth, abs(energy[-quarter:].mean() - energy[:quarter].mean()) / depth
    assert spread[1.0, 0.02][0] < 0.05 and spread[1.0, 0.02][0] / spread[1.0, 0.01][0] == pytest.approx(4.0, abs=0.6)
    assert spread[1.0, 0.01][1] < 1e-3 < 0.02 < spread[0.5, 0.02][1]


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9, 1.0])
def test_second_order_in_everything(rho):
    """Positions, rates, accelerations and Maxwell states of the bogie from 20 to 60 ms against a step eight times finer."""
    vehicle = load_vehicle("bogie").configured("with_anti_yaw_dampers")
    model = rolling_model(vehicle, 40.0)
    n, names = model.size, model.topology.coordinates
    q = np.zeros(n)
    q[names.index("frame.y")] = 2e-3
    kinds, found = ("position", "rate", "acceleration"), []
    for step in (1e-4, 5e-5, 5e-5 / 8):
        it = integrator(model, step, rho, tolerance=1e-6)
        it.set_channels([(kind, k, 0, 0) for kind in kinds for k in range(n)])
        assert it.start(0.0, q, model.rolling(40.0)) == 0
        samples = np.empty((60, 3 * n))
        assert it.run(round(0.06 / step), round(1e-3 / step), samples) == (0, 60)
        found.append(samples[20:].reshape(-1, 3, n))
    used = ~model.topology.cyclic
    for part, what in enumerate(kinds[:2] if rho == 1.0 else kinds):  # rho = 1 keeps what the first acceleration was off by
        here = used & ~model.topology.first_order if part == 2 else used
        coarse, fine = (np.abs(found[k] - found[2])[:, part][:, here].max() for k in (0, 1))
        assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.15), (what, coarse, fine)


def lateral_error(vehicle, speed, moved, step):
    """Largest error of y, yaw and roll over 0.3 s, and how much moves, when the bodies of these kinds are displaced by 0.1 um."""
    model, lin = rolling_model(vehicle, speed), linearise(vehicle, speed)
    names = list(model.topology.coordinates)
    q = np.zeros(model.size)
    for k, body in enumerate(vehicle.bodies):
        q[names.index(f"{body.name}.y")] = 1e-7 * (1 + k % 3) if body.kind in moved else 0.0
    steps, every = round(0.3 / step), round(1e-2 / step)
    rest = motion(integrator(model, step, tolerance=1e-7), np.zeros(model.size), model.rolling(speed), steps, every)
    path = motion(integrator(model, step, tolerance=1e-7), q, model.rolling(speed), steps, every) - rest
    exact = linear_motion(lin, q, np.arange(len(path)) * every * step)
    lateral = [k for k, name in enumerate(names) if name.endswith((".y", ".yaw", ".roll"))]
    columns = [lin.states.index(names[k]) for k in lateral]
    return np.abs(path[:, lateral] - exact[:, columns]).max(), np.abs(exact[:, columns]).max()


@pytest.mark.parametrize(("name", "configuration", "speed"), [("bogie", "with_anti_yaw_dampers", 40.0), ("pendolino", "AS_K", 70.0)])
def test_small_motions_are_those_of_the_linear_model(name, configuration, speed):
    """Against exp(A t). Displaced wheelsets roll on the contact's stiffness at 200 Hz, which h = 0.1 ms resolves to a per cent
    of those motions; the error falls with the square of the step. Other bodies' motion is right to 1e-4 at 0.2 ms."""
    vehicle = load_vehicle(name).configured(configuration)
    coarse, fine = (lateral_error(vehicle, speed, ("wheelset",), step)[0] for step in (2e-4, 1e-4))
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.15)
    error, size = lateral_error(vehicle, speed, ("rigid_body",), 2e-4)
    assert error < 1e-4 * size


def test_critical_speed_of_the_linear_model():
    """Growth and decay change sign within 0.5 % of the speed that the eigenvalues give."""
    from railsym.critical_speed import critical_speed

    vehicle = load_vehicle("bogie").configured("without_anti_yaw_dampers")
    critical = float(critical_speed(vehicle, conicity=0.2).speed)
    for factor, grows in ((0.995, False), (1.005, True)):
        model = rolling_model(vehicle, factor * critical, conicity=0.2)
        q = np.zeros(model.size)
        q[list(model.topology.coordinates).index("wheelset1.y")] = 1e-6
        path = motion(integrator(model, 1e-3, tolerance=1e-7), q, model.rolling(factor * critical), 30000, 10)
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
    q[names.index("frame.y")] = 2e-3
    it = integrator(model, 1e-4, tolerance=1e-7)
    path = motion(it, q, model.rolling(speed), 1000, 100)
    found = solve_ivp(slope, (0.0, 0.1), np.concatenate([q, model.rolling(speed)[second]]), method="Radau", rtol=1e-6, atol=1e-9,
                      t_eval=np.arange(11) * 0.01)
    used = ~model.topology.cyclic
    np.testing.assert_allclose(path[:, used], found.y[:n].T[:, used], rtol=0, atol=5e-8)  # 2.5e-5 of the 2 mm: (omega h)^2/12 at 25 Hz
