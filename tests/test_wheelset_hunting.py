# SPDX-License-Identifier: BSD-3-Clause
"""One wheelset through the whole chain, file to critical speed, against closed forms.

The closed forms know y and yaw only. Here roll and z stand on the contact springs and roll
yields by r0^2 k_y/(2 kH b0^2), below 1e-3, which is the tolerance of what depends on springs.
"""

import numpy as np
import pytest
from oracles.wheelset_closed_form import Wheelset, klingel_wavelength

import railsym as rs
from railsym.linear import rolling_vehicle

SPRINGS_OF_ROLL = 2e-3


def contact(conicity, **changes):
    """Cylinder-like load geometry (no gravitational stiffness) and Kalker's linear creep forces."""
    values = {"roll_parameter": 0.0, "contact_angle_parameter": 0.0, "amplitude": 0.0} | changes
    return rs.LinearContact(conicity=conicity, **values)


def closed_form(vehicle, used):
    """The two-coordinate wheelset with the data of a vehicle of one wheelset."""
    body, spring = vehicle.bodies[0], vehicle.parameters["guide.stiffness"].value
    wheels = rolling_vehicle(vehicle).contacts(used.resolved(vehicle.contact))
    return Wheelset(body.mass, body.inertia[2, 2], body.wheel_radius, body.contact_half_spacing, used.conicity,
                    2 * spring[1], 2 * spring[0] * 1.0**2, wheels.f11[0], wheels.f22[0], wheels.f23[0], wheels.f33[0])


@pytest.mark.parametrize("conicity", [0.05, 0.2, 0.4])
@pytest.mark.parametrize("stiffness", [(4e5, 2e5, 1e6), (4e5, 8e5, 1e6), (6e5, 2e5, 1e6)])
def test_critical_speed_of_the_closed_form(conicity, stiffness):
    vehicle = rs.load_vehicle("wheelset").replace({"guide.stiffness": stiffness})
    used = contact(conicity)
    speed, omega = closed_form(vehicle, used).critical_speed()
    found = rs.critical_speed(vehicle, contact=used, speed_range=(1.0, 500.0))
    assert float(found.speed) == pytest.approx(speed, rel=SPRINGS_OF_ROLL)
    assert 2 * np.pi * float(found.frequency_hz) == pytest.approx(omega, rel=SPRINGS_OF_ROLL)


@pytest.mark.parametrize("conicity", [0.05, 0.2])
def test_a_free_wheelset_hunts_with_klingels_wavelength(conicity):
    """Springs of 1 N/m hold nothing; at 2 m/s inertia is negligible (omega^2 m/(f11/V) below 1e-4)."""
    vehicle = rs.load_vehicle("wheelset").replace({"guide.stiffness": (1.0, 1.0, 1e6)})
    speed = 2.0
    model = rs.linear_model(vehicle, contact(conicity))
    values = np.linalg.eigvals(model.state_matrix(speed))
    wavelength = klingel_wavelength(0.46, 0.75, conicity)
    nearest = values[np.argmin(np.abs(values - 2j * np.pi * speed / wavelength))]
    # Spin creepage couples y and yaw by f23/(f22 b0), some 1e-3.
    assert 2 * np.pi * speed / nearest.imag == pytest.approx(wavelength, rel=5e-3)


def test_the_comparison_can_fail():
    vehicle = rs.load_vehicle("wheelset").replace({"guide.stiffness": (4e5, 2e5, 1e6)})
    speed, _ = closed_form(vehicle, contact(0.2)).critical_speed()
    found = rs.critical_speed(vehicle, contact=contact(0.21), speed_range=(1.0, 500.0))
    assert float(found.speed) != pytest.approx(speed, rel=5 * SPRINGS_OF_ROLL)
