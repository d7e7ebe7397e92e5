# SPDX-License-Identifier: BSD-3-Clause
"""The assembled kernels against one KanesMethod over a whole vehicle, at large angles."""

from pathlib import Path

import numpy as np
import pytest
from oracles.kane_vehicle import KaneVehicle

from railsym.model import Model
from railsym.vehicle import load_vehicle

SPEED, SPEED_RATE = 23.0, 1.7
# Roundoff of SymPy's unsimplified sums, some ten thousand terms, relative to the largest row.
AGREEMENT = 1e-10


@pytest.fixture(scope="module")
def vehicle():
    return load_vehicle(Path(__file__).parent / "oracles" / "kane_vehicle.toml")


@pytest.fixture(scope="module")
def oracle(vehicle):
    return KaneVehicle(vehicle)


@pytest.fixture
def model(vehicle):
    model = Model(vehicle)
    model.set_speed(SPEED, SPEED_RATE)
    return model


def component_preloads(vehicle, model, rng):
    """Random preloads in the model's two arrays, and one after the other in the elements' order."""
    bushings, laws = rng.uniform(-2.0, 2.0, (len(model.bushings), 6)), rng.uniform(-2.0, 2.0, len(model.laws))
    own = {e.name: row for e, row in zip(model.bushings, bushings, strict=True)}
    own |= {e.name: [value] for e, value in zip(model.laws, laws, strict=True)}
    return bushings, laws, np.concatenate([own[e.name] for e in vehicle.elements])


def random_state(size, rng):
    """Displacements up to 0.4 m, angles up to 1 rad, rates and accelerations up to 2."""
    q, u, a = rng.uniform(-1.0, 1.0, (3, size))
    q[[0, 1, 2, 8, 9, 10, -1]] *= 0.4
    return q, 2 * u, 2 * a


def worst(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


def test_residual_at_random_states(vehicle, oracle, model):
    rng = np.random.default_rng(51)
    for _ in range(10):
        bushings, laws, preload = component_preloads(vehicle, model, rng)
        model.set_preload(bushings, laws)
        state = random_state(model.size, rng)
        expected = oracle.residual(*state, SPEED, SPEED_RATE, preload)
        assert np.abs(expected).min() > 1e-3  # no row is empty
        assert worst(model.residual(*state), expected) < AGREEMENT


def test_comparison_can_fail(vehicle, oracle, model):
    """A sign, a speed and a force that are wrong are each seen."""
    rng = np.random.default_rng(52)
    bushings, laws, preload = component_preloads(vehicle, model, rng)
    model.set_preload(bushings, laws)
    q, u, a = random_state(model.size, rng)
    found = model.residual(q, u, a)
    for wrong in (oracle.residual(q, u, -a, SPEED, SPEED_RATE, preload),
                  oracle.residual(q, u, a, SPEED, -SPEED_RATE, preload),
                  oracle.residual(q, u, a, SPEED, SPEED_RATE, -preload),
                  oracle.residual(q, -u, a, SPEED, SPEED_RATE, preload)):
        assert worst(found, wrong) > 1e-3


def test_mass_matrix_is_symmetric_and_positive(model):
    """It is that of the kinetic energy; the Maxwell state has none."""
    q = random_state(model.size, np.random.default_rng(53))[0]
    mass = model.pencil((0, 0, 1), q=q)
    np.testing.assert_allclose(mass, mass.T, rtol=0, atol=1e-13 * np.abs(mass).max())
    assert np.linalg.eigvalsh(mass[:-1, :-1]).min() > 0.0
    assert not mass[-1].any()
