# SPDX-License-Identifier: BSD-3-Clause
"""Static preload: every row is balanced at the design position, and wheel loads follow from moments."""

import numpy as np
import pytest

from railsym.equilibrium import static_preload
from railsym.errors import ModelError
from railsym.linear import RollingVehicle
from railsym.model import Model
from railsym.vehicle import SHIPPED, load_vehicle, vehicles

# Sums of weights up to 500 kN from a linear system of condition 1e6 or less.
FORCE = 1e-9 * 500e3
FOUR_AXLES = ("cooperrider", "manchester_vehicle1", "pendolino")


def preloaded(vehicle):
    model = Model(vehicle)
    return model, static_preload(model)


def weight(body):
    return body.mass + sum(box.mass for box in body.axleboxes)


def with_wheel_loads(model, loads):
    """Residual at rest with vertical reactions N at the sides: z takes N, roll side b0 N."""
    r = model.residual()
    for (body, side), load in zip(model.wheels, loads, strict=True):
        start = model.topology.start[body.name]
        r[start + 2] += load
        r[start + 4] += side * body.contact_half_spacing * load
    return r


@pytest.mark.parametrize("name", vehicles())
def test_every_coordinate_is_in_balance(name):
    model, preload = preloaded(load_vehicle(name))
    np.testing.assert_allclose(with_wheel_loads(model, preload.wheel_loads), 0.0, atol=FORCE)


def test_balance_check_can_fail():
    """Without the preload, and with the sides of the wheels exchanged, rows are left over."""
    vehicle = load_vehicle("cooperrider").replace({"car.position.1": 0.05})
    model, preload = preloaded(vehicle)
    assert np.abs(with_wheel_loads(Model(vehicle), preload.wheel_loads)).max() > 1e4
    exchanged = preload.wheel_loads.reshape(-1, 2)[:, ::-1].ravel()
    assert np.abs(with_wheel_loads(model, exchanged)).max() > 100.0


@pytest.mark.parametrize("name", vehicles())
def test_symmetric_vehicles_load_both_sides_alike_and_carry_their_weight(name):
    vehicle = load_vehicle(name)
    loads = preloaded(vehicle)[1].wheel_loads
    np.testing.assert_allclose(loads[::2], loads[1::2], rtol=1e-10)  # roundoff of the solution
    assert loads.sum() == pytest.approx(vehicle.gravity * sum(map(weight, vehicle.bodies)), rel=1e-12)


@pytest.mark.parametrize("name", FOUR_AXLES)
@pytest.mark.parametrize("offset", [(1.5, 0.0), (0.0, 0.08), (-0.7, -0.05)])
def test_wheel_loads_by_moment_balance(name, offset):
    """Car body off centre: weight, and its moments about the vehicle's centre line and centre."""
    vehicle = load_vehicle(name)
    place = vehicle.body("car").position + [*offset, 0.0]
    vehicle = vehicle.replace({"car.position": place})
    model, preload = preloaded(vehicle)
    weights = vehicle.gravity * np.array([weight(b) for b in vehicle.bodies])
    centres = np.array([b.position for b in vehicle.bodies])
    boxes = [(box.mass * vehicle.gravity, b.position + box.centre_offset + [0.0, box.lateral_position, 0.0])
             for b in vehicle.bodies for box in b.axleboxes]
    own = vehicle.gravity * np.array([b.mass for b in vehicle.bodies])
    moments = own @ centres + sum((w * p for w, p in boxes), np.zeros(3))
    loads = preload.wheel_loads
    along = np.array([body.position[0] for body, _ in model.wheels])
    across = np.array([side * body.contact_half_spacing for body, side in model.wheels])
    assert loads.sum() == pytest.approx(weights.sum(), rel=1e-12)
    # Moments of 500 kN over metres, to the solution's roundoff.
    assert loads @ along == pytest.approx(moments[0], abs=1e-3)
    assert loads @ across == pytest.approx(moments[1], abs=1e-3)


def test_load_moves_to_the_heavier_side_and_end():
    vehicle = load_vehicle("cooperrider")
    forward = preloaded(vehicle.replace({"car.position.0": 1.0}))[1].wheel_loads
    right = preloaded(vehicle.replace({"car.position.1": 0.05}))[1].wheel_loads
    assert forward[:4].min() > forward[4:].max()
    assert (right[1::2] > right[::2]).all()


def test_forces_grow_with_gravity_and_dampers_carry_none():
    vehicle = load_vehicle("pendolino")
    model, preload = preloaded(vehicle)
    doubled = preloaded(vehicle.replace({"vehicle.gravity": 2 * vehicle.gravity}))[1]
    np.testing.assert_allclose(doubled.bushing_forces, 2 * preload.bushing_forces, rtol=0, atol=FORCE)
    np.testing.assert_allclose(doubled.wheel_loads, 2 * preload.wheel_loads, rtol=1e-12)
    still = [e.type in ("maxwell", "damper", "bump_stop") for e in model.laws]
    assert any(still) and not preload.law_forces[still].any()


def test_springs_share_a_weight_by_stiffness():
    """A body on springs of different stiffness straight under it: forces go with the stiffness."""
    vehicle = load_vehicle("manchester_vehicle1")
    model, preload = preloaded(vehicle)
    vertical = {e.name: f[2] for e, f in zip(model.bushings, preload.bushing_forces, strict=True)}
    for name, value in vertical.items():
        if name.startswith("secondary_spring"):  # the car hangs on the bogie: first = bogie, so it presses down
            assert value == pytest.approx(vehicle.body("car").mass * vehicle.gravity / 4, rel=1e-9)


def changed_file(tmp_path, name, text):
    path = tmp_path / f"{name}.toml"
    path.write_text((SHIPPED / f"{name}.toml").read_text(encoding="utf-8") + text, encoding="utf-8")
    return load_vehicle(path)


def test_a_body_that_nothing_holds_is_named(tmp_path):
    loose = """
[bodies.ballast]
kind = "rigid_body"
mass = [500, "kg"]
inertia = [[10, 10, 10], "kg*m^2"]
origin = "assumed"
at = { ballast = [[0, 0, -1], "m"] }
"""
    vehicle = changed_file(tmp_path, "bogie", loose)
    with pytest.raises(ModelError, match=r"'bogie' has no static equilibrium: nothing holds ballast\.\w+") as caught:
        static_preload(Model(vehicle))
    assert "give those bodies an element with stiffness there" in str(caught.value)


def test_a_body_that_is_not_held_vertically_is_named():
    vehicle = load_vehicle("cooperrider").replace({"secondary_vertical_spring.stiffness": 0.0})
    with pytest.raises(ModelError, match=r"nothing holds .*car\.z"):
        static_preload(Model(vehicle))


def test_a_wheel_that_lifts_is_an_error():
    vehicle = load_vehicle("cooperrider").replace({"car.position.1": 1.5})
    with pytest.raises(ModelError, match=r"wheelset1: static wheel loads -\d.* kN left, \d.* kN right; both must be positive"):
        static_preload(Model(vehicle))


def test_a_vehicle_without_wheelsets_does_not_roll(tmp_path):
    text = (SHIPPED / "wheelset.toml").read_text(encoding="utf-8")
    text = text.replace('kind = "wheelset"', 'kind = "rigid_body"')
    text = "\n".join(line for line in text.splitlines() if not line.startswith(("wheel_radius", "contact_half_spacing")))
    path = tmp_path / "block.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match="no wheelset, so nothing rolls"):
        RollingVehicle(load_vehicle(path))
