# SPDX-License-Identifier: BSD-3-Clause
"""Limit cycles of one wheelset on cones: linearisation, normal form, ramps against continuation, harmonic balance."""

import numpy as np
import pytest

import railsym as rs
from railsym.conical_contact import Cone, ConicalContact
from railsym.errors import SimulationError
from railsym.nonlinear.continuation import from_hopf
from railsym.nonlinear.hopf import Stability
from railsym.nonlinear.orbit import Shooting
from railsym.nonlinear.ramp import ramp
from railsym.nonlinear.rolling import RollingSystem

LAW = "shen_hedrick_elkins"    # smooth: cubic saturation, odd in the creepages
CONTACT = ConicalContact((Cone(0.2),))
RANGE = (25.0, 40.0)


def wheelset():
    """The shipped wheelset on springs soft enough to hunt at some 34 m/s."""
    return rs.load_vehicle("wheelset").replace({"guide.stiffness": [4e5, 2e5, 1e6]})


@pytest.fixture(scope="module")
def system():
    return RollingSystem(wheelset(), CONTACT, law=LAW)


@pytest.fixture(scope="module")
def hopf(system):
    return Stability(system).crossings(np.linspace(*RANGE, 9))[0][0]


@pytest.fixture(scope="module")
def branch(system, hopf):
    return from_hopf(system, hopf, RANGE, points=14)


def orbit_at(system, branch, speed, dt):
    """The orbit at a speed with another step, from the nearest one of a branch."""
    near = min(branch.orbits, key=lambda o: abs(o.speed - speed))
    shooting = Shooting(system, 2.0 * np.pi / near.period, 2.0)
    shooting.steps = round(near.period / dt)
    x = shooting.join(near.state, near.period, speed)
    found = shooting.solve(x, shooting.phase(x), np.eye(len(x))[-1])
    return shooting.orbit(found)[0]


def test_matrices_are_differences_of_the_residual(system, hopf):
    system.set_speed(hopf.speed)
    model, (q, u) = system.linear_model(hopf.equilibrium), system.coordinates_of(hopf.equilibrium)
    residual = system.parts.integrator.residual
    for matrix, place, step in ((model.stiffness, 0, 1e-8), (model.damping_constant, 1, 1e-7), (model.mass, 2, 1e-6)):
        for k in range(len(q)):
            ends = []
            for sign in (1.0, -1.0):
                state = [q.copy(), u.copy(), np.zeros_like(q)]
                state[place][k] += sign * step
                ends.append(residual(0.0, *state))
            np.testing.assert_allclose((ends[0] - ends[1]) / (2.0 * step), matrix[:, k], rtol=1e-4, atol=2e-6 * np.abs(matrix).max())


def test_discrete_motion_loses_stability_at_the_linear_critical_speed_to_second_order(system, hopf):
    """Largest Floquet multiplier of steady rolling at the Hopf speed tends to 1 with the square of the step (rho = 0.9 damps a little)."""
    shooting = Shooting(system, hopf.frequency, 2.0)
    x = shooting.join(hopf.equilibrium, 2.0 * np.pi / hopf.frequency, hopf.speed)
    errors = []
    for steps in (120, 240, 480):
        shooting.steps = steps
        values = np.linalg.eigvals(shooting.derivatives(x, shooting.end(x)[0])[:, :-2])
        errors.append(np.abs(values[np.argmax(np.abs(values))] - 1.0))
    assert errors[0] < 2e-3 and 3.3 < errors[0] / errors[1] < 4.7


def test_amplitude_grows_with_the_root_of_the_speed_over_the_critical_one(branch, hopf):
    small = branch.amplitude < 1.2e-3
    square, above = branch.amplitude[small] ** 2, branch.speed[small] - hopf.speed
    slope, offset = np.polyfit(square, above, 1)
    assert small.sum() >= 4 and slope > 0.0
    assert abs(offset) < 1e-4                                            # m/s: the discrete motion's own critical speed
    np.testing.assert_allclose(above, offset + slope * square, atol=5e-3 * above.max())  # the next term of the normal form
    assert branch.frequency_hz[0] == pytest.approx(hopf.frequency_hz, rel=2e-4)


def test_ramps_end_on_the_branch_whatever_they_begin_with(branch):
    system = RollingSystem(wheelset(), CONTACT, law=LAW, tolerance=1e-3)
    speed = branch.speed[-2]
    for disturbance in (0.5e-3, 6e-3):
        found = ramp(system, [speed], disturbance)
        assert found.settled.all() and found.lasting.all()
        # a cycle settles to 0.2 % from window to window, and approaches with its multiplier of 0.95
        assert found.largest[0] == pytest.approx(branch.amplitude[-2], rel=1e-2)
        assert found.frequency_hz[0] == pytest.approx(branch.frequency_hz[-2], rel=1e-3)
    below = ramp(system, [branch.speed[0] - 1.0], 3e-3, longest=60.0)
    assert not below.lasting.any()


def test_orbit_converges_with_the_square_of_the_step(system, branch):
    speed = branch.speed[-2]
    found = [orbit_at(system, branch, speed, dt) for dt in (4e-3, 2e-3, 1e-3)]
    period = [one.period for one in found]
    assert 3.0 < (period[0] - period[1]) / (period[1] - period[2]) < 5.0
    assert abs(found[2].amplitude[0] / found[1].amplitude[0] - 1.0) < 5e-3


def test_harmonic_balance_finds_the_same_cycle(system, branch):
    """Fourier series put into the residual: no time integration. Spin has no position, its rate is the series."""
    orbit = orbit_at(system, branch, branch.speed[-2], 5e-4)
    system.set_speed(orbit.speed)
    series, omega = balanced(system, orbit, harmonics=7)
    lateral = system.parts.names.index("wheelset.y")
    theta = np.linspace(0.0, 2.0 * np.pi, 400)
    y = basis(theta, 7)[0] @ series[:, lateral]
    # error of a step of 0.5 ms: frequency 1e-5, amplitude some 1e-4
    assert omega * orbit.period / (2.0 * np.pi) == pytest.approx(1.0, rel=1e-4)
    assert 0.5 * np.ptp(y) == pytest.approx(orbit.amplitude[0], rel=2e-3)


def basis(theta, harmonics):
    """1, cos, sin ... at angles and their derivatives over the angle, (2, angles, 2 harmonics + 1)."""
    k = np.arange(1, harmonics + 1)
    c, s, one = np.cos(np.outer(theta, k)), np.sin(np.outer(theta, k)), np.ones((len(theta), 1))
    return np.array([np.hstack([one, c, s]), np.hstack([0.0 * one, -k * s, k * c]), np.hstack([0.0 * one, -k**2 * c, -k**2 * s])])


def balanced(system, orbit, harmonics):
    """Coefficients (2 harmonics + 1, coordinates) and omega, by Newton on the projected residual from the orbit's own Fourier series."""
    count = 4 * harmonics + 4
    theta = 2.0 * np.pi * np.arange(count) / count
    functions, spin = basis(theta, harmonics), system.cyclic
    states = [orbit.state]
    for _ in range(count - 1):
        states.append(system.flow(states[-1], orbit.period / count, max(4, orbit.steps // count))[0])
    q, u = np.transpose([system.coordinates_of(z) for z in states], (1, 0, 2))
    series = np.linalg.lstsq(functions[0], np.where(spin, u, q), rcond=None)[0]
    phase = functions[1][0]                     # y' = 0 at theta = 0 of what it was
    row, lateral, size = phase @ series, system.parts.names.index("wheelset.y"), series.size

    def wrong(x):
        coefficients, omega = x[:-1].reshape(series.shape), x[-1]
        value, first, second = (f @ coefficients for f in functions)
        r = [system.parts.integrator.residual(0.0, np.where(spin, 0.0, v), np.where(spin, v, omega * d), np.where(spin, omega * d, omega**2 * e))
             for v, d, e in zip(value, first, second)]
        projected = functions[0].T @ np.array(r) / count
        return np.append(projected.ravel(), 1e6 * ((phase @ coefficients)[lateral] - row[lateral]))

    x = np.append(series.ravel(), 2.0 * np.pi / orbit.period)
    for _ in range(4):
        r = wrong(x)
        steps = np.append(np.full(size, 1e-7), 1e-5)
        jacobian = np.array([(wrong(x + step * e) - r) / step for step, e in zip(steps, np.eye(size + 1))]).T
        x = x - np.linalg.solve(jacobian, r)
    assert np.abs(wrong(x)).max() < 1.0         # N of 12 kN
    return x[:-1].reshape(series.shape), x[-1]


def test_bifurcation_says_what_it_found():
    found = rs.bifurcation(wheelset(), contact=CONTACT, speeds=(33.0, 37.0), law=LAW, ramp_steps=3, points=16)
    assert found.criticality == "supercritical"
    assert found.linear_critical_speed == pytest.approx(34.13, abs=0.01)
    assert found.nonlinear_critical_speed >= found.linear_critical_speed - 0.01
    speeds, difference = found.disagreement()
    assert len(speeds) and difference.max() < 0.02
    assert "supercritical" in found.message
    axes = found.plot()
    assert "speed" in axes.get_xlabel() and len(axes.lines) > 3


@pytest.mark.parametrize("arguments, words", [({"speeds": (30.0, 20.0)}, "lowest and the highest"), ({"contact": rs.LinearContact()}, "not linear"),
                                              ({"dt": -1.0}, "above 0 s"), ({"lawn": "x"}, "lawn")])
def test_wrong_arguments_are_named(arguments, words):
    with pytest.raises(SimulationError, match=words):
        rs.bifurcation(wheelset(), **({"contact": CONTACT, "speeds": RANGE} | arguments))


@pytest.mark.slow
def test_bogie_ramps_and_branch_agree():
    bogie = rs.load_vehicle("bogie")
    radius = bogie.bodies[-1].wheel_radius if bogie.bodies[-1].kind == "wheelset" else next(b.wheel_radius for b in bogie.bodies if b.kind == "wheelset")
    contact = ConicalContact((Cone(0.2, radius=radius),), wheel_radius=radius)
    found = rs.bifurcation(bogie, contact=contact, speeds=(60.0, 75.0), law=LAW, ramp_steps=6, points=25)
    assert found.criticality == "supercritical"
    assert found.disagreement()[1].max() < 0.01
