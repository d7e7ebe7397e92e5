# SPDX-License-Identifier: BSD-3-Clause
"""The assembled kernels against a linear model written separately on paper in plain NumPy.

The oracle shares no code with the kernels: it only reads the vehicle and the wheel contacts.
Both keep the same small-angle terms, so they agree to roundoff: entries of 1e9 N/m are sums
of a few terms and the static preload comes from a system of condition 1e5, hence 1e-10 of the
largest entry in the row or column.
"""

import numpy as np
import pytest
from oracles.linear_vehicle import independent_model

from railsym.contact import LinearContact
from railsym.linear import RollingVehicle
from railsym.vehicle import load_vehicle, vehicles

TOLERANCE = 1e-10
CASES = [(name, None) for name in vehicles()]
CASES += [("pendolino", c) for c in ("noASS_K", "noAS_K", "AS_Mal_K", "AS_noK", "noAS_noK", "noASS_mu06")]


def both(name, configuration, speed, conicity=0.2):
    vehicle = load_vehicle(name)
    vehicle = vehicle.configured(configuration) if configuration else vehicle
    rolling = RollingVehicle(vehicle)
    contact = LinearContact(conicity=conicity).resolved(vehicle.contact)
    return rolling, rolling.linear_model(contact), independent_model(vehicle, rolling.contacts(contact), speed)


def worst(ours, theirs):
    """Largest difference against the size of the entry's row and column."""
    size = np.abs(ours)
    # An entry may be the small difference of terms as large as the larger of the two.
    scale = np.maximum(size.max(axis=1)[:, None], size.max(axis=0)[None, :]) + 1e-9 * size.max()
    return (np.abs(ours - theirs) / scale).max()


@pytest.mark.parametrize(("name", "configuration"), CASES)
def test_matrices_agree(name, configuration):
    rolling, ours, theirs = both(name, configuration, 55.0)
    assert tuple(theirs.names) == ours.coordinates
    assert worst(ours.mass, theirs.mass) < TOLERANCE
    assert worst(ours.damping(55.0), theirs.damping) < TOLERANCE
    assert worst(ours.stiffness, theirs.stiffness) < TOLERANCE


@pytest.mark.parametrize("name", vehicles())
def test_wheel_loads_agree(name):
    rolling, _, theirs = both(name, None, 30.0)
    # Loads of some 60 kN are sums of weights up to 400 kN at roundoff.
    assert np.ravel(theirs.wheel_loads) == pytest.approx(rolling.preload.wheel_loads, rel=1e-11)


@pytest.mark.parametrize("name", ["bogie", "pendolino"])
@pytest.mark.parametrize("speed", [20.0, 70.0, 140.0])
def test_eigenvalues_agree(name, speed):
    _, ours, theirs = both(name, None, speed)
    a, b = np.linalg.eigvals(ours.state_matrix(speed)), theirs.eigenvalues()
    slow = lambda values: values[(np.abs(values) > 1.0) & (np.abs(values) < 200.0)]
    a, b = slow(a), slow(b)
    assert len(a) == len(b)
    # Nearest neighbours: conditioning of the eigenvalues (norm of A some 1e7) times 1e-16.
    assert max(np.abs(b - value).min() / abs(value) for value in a) < 1e-6


def test_the_comparison_can_fail():
    rolling, ours, theirs = both("pendolino", None, 55.0)
    k = ours.coordinates.index("wheelset1.yaw")
    wrong = ours.damping(55.0).copy()
    wrong[k, k + 1] *= -1.0  # gyroscopic moment of the spinning wheelset
    assert worst(wrong, theirs.damping) > 1e-3
