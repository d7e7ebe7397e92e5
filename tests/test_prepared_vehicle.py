# SPDX-License-Identifier: BSD-3-Clause
"""A prepared vehicle gives the matrices that the changed vehicle gives when it is built anew."""

import numpy as np
import pytest

from railsym.contact import LinearContact
from railsym.errors import ModelError, VehicleFileError
from railsym.linear import RollingVehicle
from railsym.linear_model import MATRICES
from railsym.prepared_vehicle import PreparedVehicle
from railsym.vehicle import load_vehicle

# sums of a few hundred terms in another order
ROUNDOFF = 1e-13

CHANGES = {
    "nothing": {},
    "a damper": {"anti_yaw_damper.damping": 2e5},
    "springs of both kinds of table": {"secondary_spring.stiffness.1": 2e5, "traction_rod.stiffness": 5e6, "anti_roll_bar.stiffness": 5e5},
    "a spring that moves the static forces": {"primary_spring.stiffness.2": 8e5},
    "a damping that was zero": {"primary_spring.damping": [0.0, 500.0, 800.0]},
    "series stiffness": {"anti_yaw_damper.series_stiffness": 2e6, "secondary_lateral_damper.series_stiffness": 9e6},
    "masses": {"car.mass": 3.1e4, "wheelset_inner.mass": 1500.0, "wheelset_outer.axlebox.mass": 120.0, "bogie.inertia.0": 2100.0},
    "contact": {"contact.friction": 0.2},
    "a place": {"anti_yaw_damper.front_left.first_position": None},
    "gravity": {"vehicle.gravity": 9.7},
}


@pytest.fixture(scope="module")
def vehicle():
    return load_vehicle("pendolino").configured("AS_K")


@pytest.fixture(scope="module")
def prepared(vehicle):
    return PreparedVehicle(vehicle)


def check(vehicle, prepared, changes, contact=LinearContact(conicity=0.2)):
    found, wanted = prepared.linear_model(changes, contact), RollingVehicle(vehicle.replace(changes)).linear_model(contact)
    assert found.coordinates == wanted.coordinates and found.contact == wanted.contact
    for name in MATRICES:
        scale = np.abs(getattr(wanted, name)).max()
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), atol=ROUNDOFF * scale, rtol=0, err_msg=name)
    return found


@pytest.mark.parametrize("what", CHANGES)
def test_matrices_are_those_of_the_changed_vehicle(vehicle, prepared, what):
    changes = {name: vehicle.parameters[name].value + [0.0, 0.01, 0.0] if value is None else value
               for name, value in CHANGES[what].items()}
    found = check(vehicle, prepared, changes)
    nominal = prepared.linear_model({}, LinearContact(conicity=0.2))
    changed = any((getattr(found, name) != getattr(nominal, name)).any() for name in MATRICES)
    assert changed == (what != "nothing")


def test_what_a_case_touched_is_put_back(vehicle, prepared):
    contact = LinearContact(conicity=0.2)
    before = prepared.linear_model({}, contact)
    for changes in CHANGES.values():
        if None not in changes.values():
            prepared.linear_model(changes, contact)
    after = prepared.linear_model({}, contact)
    for name in MATRICES:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


def test_a_case_that_fails_leaves_nothing_behind(vehicle, prepared):
    contact = LinearContact(conicity=0.2)
    before = prepared.linear_model({}, contact)
    with pytest.raises(VehicleFileError):
        prepared.linear_model({"anti_yaw_damper.damping": -1.0}, contact)
    with pytest.raises(ModelError, match="no static equilibrium"):
        prepared.linear_model({"secondary_spring.stiffness": [0.0, 0.0, 0.0], "anti_yaw_damper.damping": 1e5}, contact)
    after = prepared.linear_model({}, contact)
    for name in MATRICES:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


@pytest.mark.parametrize("name", ["bogie", "manchester_vehicle1", "wheelset", "cooperrider", "pendolino_tilting"])
def test_every_number_of_the_shipped_vehicles(name):
    """One draw for all parameters of a kind: none may be forgotten."""
    vehicle = load_vehicle(name)
    prepared, random = PreparedVehicle(vehicle), np.random.default_rng(4)
    numbers = [key for key in vehicle.parameters if key.rpartition(".")[2] in
               ("stiffness", "damping", "series_stiffness", "rotational_stiffness", "rotational_damping", "mass")]
    for key in numbers:
        check(vehicle, prepared, {key: vehicle.parameters[key].value * random.uniform(0.9, 1.1)})
    check(vehicle, prepared, {key: vehicle.parameters[key].value * random.uniform(0.9, 1.1) for key in numbers})
