# SPDX-License-Identifier: BSD-3-Clause
"""The pencil in blocks against NumPy's dense solution, on every shipped vehicle; the residual against the dense assembly."""

import numpy as np
import pytest
from oracles.stepping import blocks, integrator, rolling_model

from railsym._core_integrator import Integrator
from railsym.errors import ModelError
from railsym.vehicle import load_vehicle, vehicles

SPEED, STEP = 60.0, 1e-3


def disturbed(model, seed=1):
    """A state with deformations of a millimetre, rates of a centimetre a second and random accelerations."""
    rng = np.random.default_rng(seed)
    n = model.size
    return 1e-3 * rng.normal(size=n), model.rolling(SPEED) + 1e-2 * rng.normal(size=n), rng.normal(size=n), rng.normal(size=n)


@pytest.mark.parametrize("name", vehicles())
@pytest.mark.parametrize("step", [1e-2, 1e-3, 1e-5])
def test_solution_in_blocks_is_the_dense_one(name, step):
    model = rolling_model(load_vehicle(name), SPEED)
    q, u, a, b = disturbed(model)
    seed = (1.0, 2.0 / step, (2.0 / step) ** 2)
    found = integrator(model, step).solve(q, u, a, seed, b)
    dense = np.linalg.solve(model.pencil(seed, q, u, a), b)
    # condition numbers up to 2e6 in SI units; both solutions are that much better scaled by rows than the bound says
    np.testing.assert_allclose(found, dense, rtol=1e-12, atol=1e-12 * np.abs(dense).max())


@pytest.mark.parametrize("name", vehicles())
def test_residual_is_the_dense_one(name):
    model = rolling_model(load_vehicle(name), SPEED)
    q, u, a, _ = disturbed(model)
    dense = model.residual(q, u, a)
    np.testing.assert_allclose(integrator(model, STEP).residual(0.0, q, u, a), dense, rtol=0, atol=1e-14 * np.abs(dense).max())


def test_angles_beyond_the_series():
    """Sine and cosine come from a series up to 0.8 rad and from the C library beyond."""
    model = rolling_model(load_vehicle("bogie"), SPEED)
    q, u, a, _ = disturbed(model)
    frame = model.topology.start["bogie1"] if "bogie1" in model.topology.start else 0
    for angle in (0.0, 1e-9, 0.4, 0.799, 0.801, 2.0, -0.5):
        q[frame + 3] = angle
        body = model.pencil((0.0, 0.0, 1.0), q, u, a)  # the mass matrix of a body: its yaw-roll-pitch map holds sines
        mirrored = q.copy()
        mirrored[frame + 3] = angle + 2.0 * np.pi if abs(angle) < 0.8 else angle - 2.0 * np.pi
        np.testing.assert_allclose(model.pencil((0.0, 0.0, 1.0), mirrored, u, a), body, atol=4e-15 * np.abs(body).max())
        r, other = model.residual(q, u, a), model.residual(mirrored, u, a)
        np.testing.assert_allclose(other, r, atol=1e-11 * np.abs(r).max())  # 2 pi rounded, times forces of 10 MN


def test_fill_is_that_of_minimum_degree():
    """Links are eliminated before what they join: no more than a tenth of the dense factors of the large vehicle."""
    model = rolling_model(load_vehicle("pendolino"), SPEED)
    operations, doubles = integrator(model, STEP).fill()
    assert operations <= 135 and doubles <= 0.25 * (len(blocks(model)) ** 2)


def test_blocks_must_fit():
    model = rolling_model(load_vehicle("bogie"), SPEED)
    block = blocks(model)
    for wrong in (np.zeros_like(block), block[:-1], np.append(block, block[-1])):
        with pytest.raises(ModelError, match="at most eight coordinates"):
            Integrator(model.assembly, wrong, STEP, 0.9, 1e-6)
    for step, rho, tolerance in ((0.0, 0.9, 1e-6), (STEP, 1.1, 1e-6), (STEP, 0.9, 0.0), (np.nan, 0.9, 1e-6)):
        with pytest.raises(ModelError, match="step"):
            Integrator(model.assembly, block, step, rho, tolerance)
