# SPDX-License-Identifier: BSD-3-Clause
"""Linear wheel-rail kernel at large states: its normal force from a potential, its creep forces from virtual power."""

import numpy as np
import pytest
from oracles.element_pair import turn
from oracles.kernel_inputs import STEP, random_instance

from railsym import _core
from railsym.contact import LinearContact
from railsym.linear import RollingVehicle
from railsym.vehicle import load_vehicle

CREEP = ("f11", "f22", "f23", "f33")
ROUNDOFF = 1e-12  # some hundred operations on numbers of order one


def wheels():
    rng = np.random.default_rng(71)
    return [random_instance("wheel_rail", rng).having(side=side) for side in (-1.0, 1.0) for _ in range(5)]


def residual(one):
    return _core.kernel_real("wheel_rail", one.inputs(), (0, 0, 0))[0]


def without_creep(one):
    return one.having(**dict.fromkeys(CREEP, 0.0))


def potential(one, q):
    """N0 p + kH p^2 / 2 with the penetration p of docs/linear_contact.md, sines for angles."""
    side, b0, r0, delta, eps = (one.get(key) for key in ("side", "b0", "r0", "slope", "grad"))
    y, z, yaw, roll = q[1], q[2], np.sin(q[3]), np.sin(q[4])
    shift = y - r0 * roll
    p = (z + side * (b0 * roll + delta * shift) + (eps - delta / b0) * shift**2 / 2
         - y * roll + (r0 + b0 * delta) * roll**2 / 2 - b0 * delta * yaw**2 / 2)
    return one.get("N0") * p + one.get("kH") * p**2 / 2


def test_normal_force_is_the_gradient_of_its_potential():
    for one in map(without_creep, wheels()):
        expected = [potential(one, one.q + 1j * STEP * e).imag / STEP for e in np.eye(6)]
        np.testing.assert_allclose(residual(one), expected, rtol=0, atol=ROUNDOFF * np.abs(expected).max())


def slip(one, u):
    """Velocities of the wheel against the rail along and across its rolling direction, and about the contact normal."""
    side, q, yawed = one.get("side"), one.q, turn(2, one.q[3])
    rolled = yawed @ turn(0, q[4])
    shift = q[1] - one.get("r0") * np.sin(q[4])
    omega = one.get("w0", 3) + u[3] * np.eye(3)[2] + u[4] * yawed[:, 0] + u[5] * rolled[:, 1]
    centre = one.get("V") * np.eye(3)[0] + np.cross(one.get("w0", 3), one.get("offset0", 3) + q[:3]) + u[:3]
    radius = one.get("r0") + side * one.get("lam") * shift
    velocity = centre + np.cross(omega, rolled @ [0.0, side * one.get("b0"), radius])
    normal = yawed @ [0.0, side * (one.get("slope") + side * one.get("grad") * shift), 1.0]
    return np.array([yawed[:, 0] @ velocity, yawed[:, 1] @ velocity, normal @ omega])


def test_creep_forces_from_virtual_power():
    """Fx = -f11 xi, Fy = -(f22 eta + f23 spin), Mz = f23 eta - f33 spin on what they do work on."""
    for one in wheels():
        xi, eta, spin = slip(one, one.u) / one.get("V")
        f11, f22, f23, f33 = (one.get(key) for key in CREEP)
        forces = np.array([-f11 * xi, -(f22 * eta + f23 * spin), f23 * eta - f33 * spin])
        rates = np.array([slip(one, one.u + 1j * STEP * e).imag / STEP for e in np.eye(6)])
        found, expected = residual(one) - residual(without_creep(one)), -rates @ forces
        np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDOFF * np.abs(residual(one)).max())


def creepages(one):
    """xi, eta, spin read from the kernel's own forces: one coefficient at a time on coordinates x, y, yaw."""
    bare = without_creep(one)
    level = residual(bare)
    along, across, moment = (residual(bare.having(**{key: 1.0})) - level for key in ("f11", "f22", "f33"))
    return np.array([along[0], across[1], moment[3]])


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_creepages_are_kalkers_near_rolling_on_straight_track(side):
    """First order in the motion, with dspin the spin beyond -V/r0 and yc = y - r0 roll."""
    b0, r0, lam, delta, eps, speed = 0.75, 0.46, 0.2, 0.12, 3.0, 30.0
    one = random_instance("wheel_rail", np.random.default_rng(72)).having(
        side=side, b0=b0, r0=r0, lam=lam, slope=delta, grad=eps, V=speed, w=np.zeros(3), offset=np.zeros(3))
    rolling = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -speed / r0])
    rest = creepages(one.having(q=np.zeros(6), u=rolling))
    np.testing.assert_allclose(rest, [0.0, 0.0, -side * delta / r0], rtol=0, atol=1e-12)
    small = 1e-6
    rng = np.random.default_rng(73)
    q, u = small * rng.normal(size=(2, 6))
    (_, y, _, yaw, roll, _), (x_rate, y_rate, _, yaw_rate, roll_rate, spin_rate) = q, u
    shift = y - r0 * roll
    slope = delta + side * eps * shift
    expected = [(x_rate + r0 * spin_rate - side * b0 * yaw_rate) / speed - side * lam * shift / r0,
                (y_rate - r0 * roll_rate) / speed - yaw,
                yaw_rate / speed + side * slope * (spin_rate / speed - 1 / r0) - roll / r0]
    # What first order leaves out: products of two motions of 1e-6, times at most eps / r0.
    np.testing.assert_allclose(creepages(one.having(q=q, u=rolling + u)), expected, rtol=0, atol=1e-10)


def test_each_wheel_carries_the_load_of_its_own_side():
    """Car off centre: the kernel's rows at rest are N on z and N (side b0 - r0 side delta) on roll."""
    vehicle = load_vehicle("cooperrider").replace({"car.position.1": 0.05})
    rolling = RollingVehicle(vehicle)
    model, contacts = rolling.model, rolling.contacts(LinearContact().resolved(vehicle.contact))
    bare = model.residual(u=model.rolling(1.0))
    model.add_wheels(contacts)
    rows = model.residual(u=model.rolling(1.0)) - bare
    left, right = rolling.preload.wheel_loads[:2]
    body, start = model.wheels[0][0], model.topology.start["wheelset1"]
    lever = body.contact_half_spacing - body.wheel_radius * contacts.slope[0]
    assert right > 1.05 * left
    assert rows[start + 2] == pytest.approx(left + right, rel=1e-12)
    creep = contacts.f23[:2] @ np.array([-1.0, 1.0]) * contacts.slope[0]  # Fy = f23 side delta / r0, at r0 below the axle
    assert rows[start + 4] == pytest.approx(lever * (right - left) + creep, rel=1e-9)
