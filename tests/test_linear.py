# SPDX-License-Identifier: BSD-3-Clause
"""The linear model against the assembled pencil, and what its making must leave alone."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

from railsym.contact import LinearContact
from railsym.equilibrium import static_preload
from railsym.errors import ModelError
from railsym.linear import RollingVehicle, linear_model, linearise
from railsym.model import Model
from railsym.symmetry import split
from railsym.vehicle import load_vehicle, vehicles

MATRICES = ("mass", "stiffness", "damping_constant", "damping_speed", "damping_inverse_speed")
SEEDS = {"stiffness": (1, 0, 0), "damping": (0, 1, 0), "mass": (0, 0, 1)}
# Sums of a few products, relative to the largest entry of the row or column.
ROUNDOFF = 1e-13


def rolling_model(vehicle, speed):
    """A fresh preloaded model on its wheels at one speed, its contacts, and the rolling rates."""
    rolling = RollingVehicle(vehicle)
    contacts = rolling.contacts(LinearContact().resolved(vehicle.contact))
    model = Model(vehicle)
    static_preload(model)
    model.add_wheels(contacts)
    model.set_speed(speed)
    return model, contacts, model.rolling(speed)


def worst(found, expected):
    """Largest difference relative to the entry's row and column."""
    size = np.abs(expected)
    scale = np.maximum(size.max(axis=1)[:, None], size.max(axis=0)[None, :])
    return (np.abs(found - expected) / np.where(scale > 0.0, scale, 1.0)).max()


@pytest.mark.parametrize("speed", [0.7, 37.0, 140.0])
@pytest.mark.parametrize("name", vehicles())
def test_matrices_are_the_pencil_at_any_speed(name, speed):
    """C0 + V C1 + C2/V, M and K against the whole model, wheels and all, at that speed."""
    vehicle = load_vehicle(name)
    ours = linear_model(vehicle)
    model, _, rates = rolling_model(vehicle, speed)
    for kind, seed in SEEDS.items():
        found = ours.damping(speed) if kind == "damping" else getattr(ours, kind)
        assert worst(found, model.pencil(seed, u=rates)) < ROUNDOFF


def test_comparison_with_the_pencil_can_fail():
    """Each of the three parts of the damping is needed."""
    vehicle = load_vehicle("bogie")
    ours = linear_model(vehicle)
    model, _, rates = rolling_model(vehicle, 37.0)
    pencil = model.pencil(SEEDS["damping"], u=rates)
    for part in (ours.damping_constant, 37.0 * ours.damping_speed, ours.damping_inverse_speed / 37.0):
        assert worst(ours.damping(37.0) - part, pencil) > 1e-6


@pytest.mark.parametrize("name", vehicles())
def test_rolling_is_the_motion_but_for_the_spin_moment(name):
    """Residual of straight rolling at any speed.

    On a contact plane at the slope delta the wheel's rotation has the spin creepage
    -side delta / r0, whose moment Mz = side f33 delta / r0 has the part side delta Mz along
    the axle: f33 delta^2 / r0 on each wheel brakes the wheelset, whatever the speed. Left and right
    cancel in every other row. A wheelset overcomes it by a longitudinal creepage of
    f33 delta^2 / (r0^2 f11), some 1e-6, which linearising about pure rolling leaves out.
    """
    for speed in (7.3, 61.7):
        model, contacts, rates = rolling_model(load_vehicle(name), speed)
        expected = np.zeros(model.size)
        for (body, _), f33, slope in zip(model.wheels, contacts.f33, contacts.slope, strict=True):
            expected[model.topology.start[body.name] + 5] -= f33 * slope**2 / body.wheel_radius
        # Weights of 500 kN and creep coefficients of 1e7 N at roundoff.
        np.testing.assert_allclose(model.residual(u=rates), expected, rtol=0, atol=1e-7)
        creepage = np.abs(expected).max() / (2 * contacts.wheel_radius * contacts.f11).min()
        assert 0.0 < creepage < 1e-4


def mirrored_coordinates(model):
    """Where each coordinate goes when left and right are exchanged, and its sign.

    y, yaw and roll change sign, and so does what a damper across the track (axis y) is
    stretched by, when its first and second body keep their places.
    """
    names, elements = model.coordinates, {e.name: e for e in model.vehicle.elements}
    places = [names.index(n.replace("left", "?").replace("right", "left").replace("?", "right")) for n in names]
    sign = np.ones(len(names))
    for k, name in enumerate(names):
        body, last = name.rsplit(".", 1)
        if last in ("y", "yaw", "roll") or (last == "s" and elements[body].axis == 1):
            sign[k] = -1.0
    return np.array(places), sign


def asymmetry(vehicle):
    model = linear_model(vehicle)
    places, sign = mirrored_coordinates(model)
    return max(worst((sign[:, None] * sign) * m[np.ix_(places, places)], m) for m in (getattr(model, n) for n in MATRICES))


@pytest.mark.parametrize("name", vehicles())
def test_symmetric_vehicles_have_mirror_symmetric_matrices(name):
    assert asymmetry(load_vehicle(name)) < 1e-12  # roundoff of the preload


@pytest.mark.parametrize("change", [{"car.position.1": 0.01}, {"secondary_vertical_spring.front_left.second_position.1": -1.2}])
def test_symmetry_check_can_fail(change):
    assert asymmetry(load_vehicle("cooperrider").replace(change)) > 1e-6


def as_bytes(model):
    return b"".join(getattr(model, name).tobytes() for name in MATRICES)


@pytest.mark.parametrize("name", ["bogie", "pendolino"])
def test_linearising_again_gives_the_same_bytes(name):
    """Also after another contact, from another copy of the vehicle, and in the state matrix."""
    vehicle, other = load_vehicle(name), LinearContact(conicity=0.05, friction=0.6)
    first = as_bytes(linear_model(vehicle))
    different = as_bytes(linear_model(vehicle, other))
    assert different != first
    assert as_bytes(linear_model(vehicle)) == first
    assert as_bytes(linear_model(load_vehicle(name))) == first
    assert as_bytes(linear_model(vehicle, other)) == different
    assert linearise(vehicle, 55.0).A.tobytes() == linearise(vehicle, 55.0).A.tobytes()


def test_linearising_leaves_the_model_as_it_was():
    """Same residual to the bit before and after, and no state array is written to."""
    vehicle = load_vehicle("pendolino")
    rolling = RollingVehicle(vehicle)
    model = rolling.model
    rng = np.random.default_rng(61)
    state = rng.uniform(-0.1, 0.1, (3, model.size))
    kept = state.copy()
    before = model.residual(*state).tobytes()
    for conicity in (0.1, 0.3):
        rolling.linear_model(LinearContact(conicity=conicity))
    for seed in SEEDS.values():
        model.pencil(seed, *state)
    assert model.residual(*state).tobytes() == before
    assert state.tobytes() == kept.tobytes()


def test_stiffness_holds_the_geometric_part_of_the_preload():
    """A car on its springs: without weight the roll stiffness is larger by the weight's lever."""
    vehicle = load_vehicle("manchester_vehicle1")
    heavy, light = linear_model(vehicle), RollingVehicle(vehicle)
    light.model.set_preload(np.zeros((len(light.model.bushings), 6)), np.zeros(len(light.model.laws)))
    light = light.linear_model(LinearContact())
    k = heavy.coordinates.index("car.roll")
    car, spring = vehicle.body("car"), vehicle.element("secondary_spring.front_left")
    lever = spring.second.position[2] - car.position[2]  # springs lie below the centre of mass, z down
    assert lever > 0.0
    # Four forces of m g / 4 turn with the bogie's axes, which rest: m g lever acts against the springs.
    assert heavy.stiffness[k, k] - light.stiffness[k, k] == pytest.approx(-car.mass * vehicle.gravity * lever, rel=1e-6)


@pytest.mark.parametrize("speed", [0.0, -3.0, np.nan, np.inf])
def test_speeds_that_nothing_rolls_at(speed):
    with pytest.raises(ModelError, match="a finite speed above 0"):
        linearise(load_vehicle("wheelset"), speed)


def test_halves_of_a_contact_share_what_the_vehicle_decides():
    vehicle = load_vehicle("bogie")
    models = [linear_model(vehicle, LinearContact(conicity=c)) for c in (0.1, 0.3)]
    for model in models:
        alone = replace(model, base=None)
        for part, same in zip(split(model), split(alone), strict=True):
            assert part.parity == same.parity
            for name in MATRICES:
                assert np.array_equal(getattr(part.model, name), getattr(same.model, name)), name
            # the state matrix is put together from the base's: rounding only
            expected = same.model.state_matrix(50.0)
            assert np.allclose(part.model.state_matrix(50.0), expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
    assert split(models[0])[0].model.mass is split(models[1])[0].model.mass


def test_assembled_vehicles_do_not_pile_up():
    vehicle = load_vehicle("bogie")
    first = weakref.ref(linear_model(vehicle).base)
    for step in range(20):          # more than are kept
        split(linear_model(vehicle.replace({"vehicle.gravity": 9.81 + 1e-6 * (step + 1)})))
    gc.collect()
    assert first() is None
