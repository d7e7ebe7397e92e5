# SPDX-License-Identifier: BSD-3-Clause
"""The independent model of the shipped vehicle files against textbook formulas with numbers typed from the sources."""

import numpy as np
import pytest
from oracles import hand_modes
from oracles.hand_modes import SpringPlane
from oracles.linear_vehicle import independent_model, static_state
from oracles.stand_ins import usual_wheels
from test_oracle_hand_modes import oracle_frequencies
from test_oracle_linear_vehicle import mirror_matrix

import railsym.vehicle

# car mass, roll inertia, height of the car's centre over the springs, secondary springs (all four together)
CARS = {
    "manchester_vehicle1": (32000.0, 56800.0, 1.8 - 0.8275, SpringPlane(
        0.0, 4 * 160e3, 4 * 430e3, half_spacing=1.0, half_base=9.5, roll=2 * 0.94e6 + 4 * 10.5e3)),
    "pendolino": (39000.0, 65000.0, 1.475 - 0.9, SpringPlane(
        0.0, 4 * 2.3e5, 4 * 4.2e5, half_spacing=1.0, half_base=9.5, roll=2 * 1.0e6 + 4 * 1.0e4)),
}
# The Pendolino's springs are assumed and may be refitted: the test sets the values it knows the answer for.
SET = {
    "manchester_vehicle1": {},
    "pendolino": {"secondary_spring.stiffness": [2.3e5, 2.3e5, 4.2e5], "anti_roll_bar.stiffness": 1.0e6,
                  "secondary_spring.rotational_stiffness": [1.0e4, 1.0e4, 0.0]},
}


@pytest.fixture(scope="module", params=sorted(CARS))
def case(request):
    vehicle = railsym.vehicle.load_vehicle(request.param).replace(SET[request.param])
    return CARS[request.param], vehicle, independent_model(vehicle, None, 0.0)


def test_car_body_modes_over_held_bogies(case):
    (mass, inertia, height, springs), _, model = case
    # Exact to first order on both sides; 1e-9 is round-off.
    assert oracle_frequencies(model, ["car.z"])[0] == pytest.approx(hand_modes.bounce(mass, springs), rel=1e-9)
    sway = hand_modes.sway(mass, inertia, springs, height)
    assert oracle_frequencies(model, ["car.y", "car.roll"]) == pytest.approx(sway, rel=1e-9)


def test_wheel_loads_of_the_coach():
    _, loads = static_state(railsym.vehicle.load_vehicle("manchester_vehicle1"))
    assert loads == pytest.approx(np.full(8, hand_modes.wheel_load(32000.0, 2615.0, 1813.0)), rel=1e-9)


def test_wheel_loads_of_the_pendolino():
    """Two axleboxes and two pairs of trusses hang on each wheelset's share; the inner wheelsets are 300 kg heavier."""
    vehicle = railsym.vehicle.load_vehicle("pendolino")
    _, loads = static_state(vehicle)
    hanging = 2 * 90.0 + 2 * (11.0 + 20.0)
    outer, inner = (hand_modes.wheel_load(39000.0, 3100.0, own + hanging) for own in (1250.0, 1550.0))
    expected = {1: outer, 2: inner, 3: inner, 4: outer}
    numbers = [int(body.name[-1]) for body in vehicle.bodies if body.kind == "wheelset"]
    assert loads == pytest.approx(np.repeat([expected[n] for n in numbers], 2), rel=1e-9)


def test_mirror_symmetry_of_the_files(case):
    _, vehicle, _ = case
    model = independent_model(vehicle, usual_wheels(vehicle), 60.0)
    mirror = mirror_matrix(vehicle, model)
    for matrix in (model.mass, model.damping, model.stiffness):
        assert np.allclose(mirror.T @ matrix @ mirror, matrix, rtol=0, atol=1e-12 * np.abs(matrix).max())
