# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of randomly changed vehicles against dense eigenvalues: right to 1e-6, and none before them."""

import numpy as np
import pytest
from oracles.dense_critical_speed import DenseModes

from railsym.contact import LinearContact
from railsym.critical_cases import CriticalSpeedSolver
from railsym.linear import RollingVehicle
from railsym.symmetry import split
from railsym.vehicle import load_vehicle

AGREE = 1e-6           # relative, of the speed: what dense eigenvalues of 316 states are good for, with some room
CHANGED = 12
CONFIGURATIONS = ("AS_K", "noAS_K", "AS_noK", "AS_Mal_K")
SOLVERS = {}


def solver(configuration):
    if configuration not in SOLVERS:
        SOLVERS[configuration] = CriticalSpeedSolver(load_vehicle("pendolino").configured(configuration))
    return SOLVERS[configuration]


def draw(configuration, number):
    """Twelve suspension numbers times e^-0.5 to e^0.5, a conicity and a criterion."""
    random = np.random.default_rng([CONFIGURATIONS.index(configuration), number])
    numbers = {name: value for name, value in load_vehicle("pendolino").configured(configuration).parameters.components().items()
               if name.split(".")[1] in ("stiffness", "damping", "series_stiffness", "rotational_stiffness", "rotational_damping")
               and value > 0.0}
    chosen = random.choice(sorted(numbers), CHANGED, replace=False)
    changes = {str(name): numbers[name] * float(np.exp(random.uniform(-0.5, 0.5))) for name in chosen}
    return changes, float(random.uniform(0.08, 0.45)), float(random.choice([0.0, 0.05, 0.1]))


def check(configuration, number, speeds, whole):
    changes, conicity, damping_ratio = draw(configuration, number)
    one = solver(configuration)
    one.damping_ratio = damping_ratio
    found = one.solve(changes, conicity)
    model = RollingVehicle(one.vehicle.replace(changes)).linear_model(LinearContact(conicity=conicity))
    modes = DenseModes([model] if whole else [part.model for part in split(model)], damping_ratio)
    start = modes.below(one.speed_range[0])
    if found.unstable_at_start:
        assert found.speed is None and start > 0
        return
    end = one.speed_range[1] if found.speed is None else found.speed * (1.0 - AGREE)
    counts = [modes.below(speed) for speed in speeds(one.speed_range[0], end)]
    # a mode below the criterion from the start may recover; none may join
    assert all(after <= before for before, after in zip([start, *counts], counts)), (counts, found.message)
    if found.speed is not None:
        assert modes.crosses(found.speed, ([start, *counts])[-1], AGREE), found.message


def few(low, high):
    """Eight speeds, denser towards the upper end."""
    return low + (high - low) * (1.0 - np.linspace(0.9, 0.0, 8) ** 2)


def two_per_cent(low, high):
    return np.geomspace(low, high, 2 + int(np.log(high / low) / 0.02))


@pytest.mark.parametrize("number", range(5))
@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_random_cases(configuration, number):
    check(configuration, number, few, whole=True)


@pytest.mark.slow
@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_five_hundred_random_cases_on_a_fine_grid(configuration):
    for number in range(100, 225):
        check(configuration, number, two_per_cent, whole=False)
