# SPDX-License-Identifier: BSD-3-Clause
"""Linear wheel-rail terms of the oracle against the finite motion they were expanded from."""

from types import SimpleNamespace

import numpy as np
import pytest
from oracles import stand_ins
from oracles.finite_motion import finite_rotation
from oracles.linear_vehicle import independent_model
from oracles.wheel_rail import ContactTerms, wheel_matrices

SPEED = 20.0
# The expansion puts cos(delta0) = 1, so it is exact for a small slope only.
SLOPE = 1e-4


def one_wheel(side, **changes):
    numbers = dict(load=6e4, side=side, wheel_radius=0.46, contact_half_spacing=0.75, conicity=0.3, slope=SLOPE,
                   slope_gradient=0.23, normal_stiffness=1e9, f11=1.1e7, f22=9e6, f23=2.5e4, f33=120.0)
    return SimpleNamespace(**(numbers | changes))


def velocity_rows(wheel, q, track_axes, flat=False):
    """Rows over the rates (x' y' z' yaw' roll' spin rate) of v.x, v.t, w.n, v.n at finite q; `flat`: t is level."""
    yaw, roll = q[3], q[4]
    shift = q[1] - wheel.wheel_radius * roll
    slope = wheel.slope + wheel.side * wheel.slope_gradient * shift
    arm = finite_rotation(yaw, roll, 0) @ np.array([0, wheel.side * wheel.contact_half_spacing,
                                                    wheel.wheel_radius + wheel.side * wheel.conicity * shift])
    omega = np.zeros((3, 6), dtype=complex)
    omega[:, 3], omega[:, 4] = [0, 0, 1], finite_rotation(yaw, 0, 0)[:, 0]
    omega[:, 5] = finite_rotation(yaw, roll, 0)[:, 1]
    velocity = np.eye(3, 6) + np.cross(omega, arm, axis=0)
    along = np.eye(3) if track_axes else finite_rotation(yaw, 0, 0)
    tangent = np.array([0, 1, 0]) if flat else np.array([0, np.cos(slope), -wheel.side * np.sin(slope)])
    normal = np.array([0, wheel.side * np.sin(slope), np.cos(slope)])
    return along[:, 0] @ velocity, along @ tangent @ velocity, along @ normal @ omega, normal @ velocity


def generalised_force(wheel, q, rates, track_axes, flat=False):
    """Force on the wheel at finite q by virtual power, velocities from the rolling wheelset."""
    total = rates + SPEED * np.array([1, 0, 0, 0, 0, -1 / wheel.wheel_radius])
    x_row, t_row, spin_row, n_row = velocity_rows(wheel, q, track_axes, flat)
    xi, eta, spin = (row @ total / SPEED for row in (x_row, t_row, spin_row))
    shift = q[1] - wheel.wheel_radius * q[4]
    penetration = q[2] + wheel.side * wheel.contact_half_spacing * q[4] + wheel.side * wheel.slope * shift
    penetration = penetration + wheel.slope_gradient * shift**2 / 2
    normal = wheel.load + wheel.normal_stiffness * penetration
    lateral, moment = -(wheel.f22 * eta + wheel.f23 * spin), wheel.f23 * eta - wheel.f33 * spin
    return -wheel.f11 * xi * x_row + lateral * t_row + moment * spin_row - normal * n_row


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("axes", ["track", "wheelset"])
@pytest.mark.parametrize("tilt", ["normal", "first_order"])
def test_expansion_matches_finite_virtual_power(side, axes, tilt):
    wheel = one_wheel(side)
    terms = ContactTerms(load_point="wheelset", tilt=tilt, spin_preload=axes)
    stiffness, damping = wheel_matrices(wheel, SPEED, terms)
    zero, options = np.zeros(6), (axes == "track", tilt == "normal")

    def slope_of(function):
        return np.array([function(1e-30j * e).imag / 1e-30 for e in np.eye(6)]).T

    exact_stiffness = -slope_of(lambda d: generalised_force(wheel, d, zero, *options))
    exact_damping = -slope_of(lambda d: generalised_force(wheel, zero, d, *options))
    # cos(delta0) = 1 leaves delta0^2/2 = 5e-9 of the largest coefficient of each matrix.
    assert np.allclose(stiffness, exact_stiffness, rtol=0, atol=1e-8 * np.abs(stiffness).max())
    assert np.allclose(damping, exact_damping, rtol=0, atol=1e-8 * np.abs(damping).max())


@pytest.mark.parametrize("axes", ["track", "wheelset"])
@pytest.mark.parametrize("tilt", ["normal", "first_order"])
def test_constant_spin_force_is_seen_by_the_check_above(axes, tilt):
    """With a large f23 the constant force is not lost in the tolerance."""
    wheel = one_wheel(1, f23=1e9, normal_stiffness=0.0, f11=0.0, f22=0.0, load=0.0)
    stiffness, _ = wheel_matrices(wheel, SPEED, ContactTerms("wheelset", tilt, axes))
    without, _ = wheel_matrices(wheel, SPEED, ContactTerms("wheelset", tilt, "none"))
    exact = -np.array([generalised_force(wheel, 1e-30j * e, np.zeros(6), axes == "track", tilt == "normal").imag
                       for e in np.eye(6)]).T / 1e-30
    constant = 1e9 * SLOPE / 0.46
    assert np.abs(exact - without).max() > 0.1 * constant
    # delta0^2 of f23/r0 = 2e9 N is 20; the constant force is 2e5 N.
    assert np.allclose(stiffness, exact, rtol=0, atol=40.0)


@pytest.mark.parametrize("side", [-1, 1])
def test_load_alone(side):
    """Without creep and contact stiffness the load's own terms stand out, on yaw -N0 b0 delta0 = -450 N m/rad."""
    wheel = one_wheel(side, slope=0.01, normal_stiffness=0.0, f11=0.0, f22=0.0, f23=0.0, f33=0.0)
    stiffness, _ = wheel_matrices(wheel, SPEED, ContactTerms("wheelset", "none", "none"))
    exact = -np.array([generalised_force(wheel, 1e-30j * e, np.zeros(6), True).imag / 1e-30 for e in np.eye(6)]).T
    # sin(delta0), cos(delta0) to first order: N0 delta0^2/2 = 3 N.
    assert np.allclose(stiffness, exact, rtol=0, atol=6.0)
    assert stiffness[3, 3] == pytest.approx(-450.0)


@pytest.mark.parametrize("side", [-1, 1])
def test_exact_tilt_at_a_steep_contact(side):
    """With cos and sin of the slope the creep rows hold at any slope; without spin there is no constant force."""
    wheel = one_wheel(side, slope=0.4, load=0.0, normal_stiffness=0.0, f23=0.0, f33=0.0)
    stiffness, damping = wheel_matrices(wheel, SPEED, ContactTerms("wheelset", "exact", "none"))
    zero = np.zeros(6)
    for found, force in ((stiffness, lambda d: generalised_force(wheel, d, zero, True)),
                         (damping, lambda d: generalised_force(wheel, zero, d, True))):
        exact = -np.array([force(1e-30j * e).imag / 1e-30 for e in np.eye(6)]).T
        assert np.allclose(found, exact, rtol=0, atol=1e-12 * np.abs(found).max())


def rigid_rail_motion(slope, b0=0.75, r0=0.46):
    """Lateral shift 1 m of a wheelset held by both rails, p = 0 to first order, and its roll parameter sigma."""
    sigma = slope * b0 / (b0 - r0 * slope)
    return np.array([0.0, 1.0, 0.0, 0.0, -sigma / b0, 0.0]), sigma


def test_lateral_force_at_the_rails_is_the_load_on_the_slope():
    """Held by both rails: side force -N0 sum(s delta) = -2 N0 eps yc, with yc = y (1 + r0 sigma/b0)."""
    load, eps, slope, b0, r0 = 6e4, 0.4, 0.15, 0.75, 0.46
    vehicle, wheels = stand_ins.single_wheelset(load=load, slope=slope, slope_gradient=eps, f11=0.0, f22=0.0)
    motion, sigma = rigid_rail_motion(slope)
    for point in ("rail", "potential"):
        stiffness = independent_model(vehicle, wheels, 1.0, terms=ContactTerms(load_point=point)).stiffness
        # Round-off of kH = 1e9 N/m against 5e4.
        assert (stiffness @ motion)[1] == pytest.approx(2 * load * eps * (1 + r0 * sigma / b0), rel=1e-9)


def test_load_stays_on_the_rail():
    """A wheelset pushed aside by y feels the roll moment 2 N0 y of loads that stay where they are."""
    load = 6e4
    vehicle, wheels = stand_ins.single_wheelset(load=load, slope=0.0, slope_gradient=0.0, f11=0.0, f22=0.0)
    stiffness = independent_model(vehicle, wheels, 1.0).stiffness
    assert stiffness[4, 1] == pytest.approx(-2 * load)


def test_gravitational_stiffness_of_a_cone():
    """Exact motion of a cone on two edges: its apex runs on a circle through both, radius b0/sin(2 delta0).

    The centre stands h = r0 + b0 tan(delta0) over the apex; the stiffness is the weight 2 N0 times the curvature of the
    path of the centre.  Half of it comes from the contact keeping its place on the rail.
    """
    load, slope, b0, r0 = 6e4, 0.05, 0.75, 0.46
    angle = np.arctan(slope)
    vehicle, wheels = stand_ins.single_wheelset(load=load, slope=slope, slope_gradient=slope / b0, f11=0.0, f22=0.0)
    stiffness = independent_model(vehicle, wheels, 1.0).stiffness
    motion, _ = rigid_rail_motion(slope)
    radius = b0 / np.sin(2 * angle)

    def centre(roll):
        """Lateral position and height of the wheelset's centre when it has rolled (inscribed angle: 2 roll)."""
        apex = radius * np.array([-np.sin(2 * roll), -np.cos(2 * roll)])
        return apex + (r0 + b0 * slope) * np.array([np.sin(roll), np.cos(roll)])

    step = 1e-3
    (y1, up1), (_, up0) = centre(step), centre(0.0)
    rise = 2 * (up1 - up0) / y1**2
    # The model puts sin, cos of the slope to first order: relative error of order slope^2 = 0.0025.
    assert motion @ stiffness @ motion == pytest.approx(2 * load * rise, rel=5e-3)
