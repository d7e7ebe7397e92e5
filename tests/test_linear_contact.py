# SPDX-License-Identifier: BSD-3-Clause
"""LinearContact: geometry of the definitions, magnitudes, friction's effect, errors, speed."""

from dataclasses import fields, replace
from math import inf, nan

import numpy as np
import pytest
import sympy as sm

from railsym.contact import LinearContact, WheelContacts, creepage_amplitude
from railsym.errors import ContactError
from railsym.kalker import kalker_coefficients

VEHICLE = {"friction": 0.3, "kalker_weight": 1.0, "wheel_transverse_radius": inf, "rail_transverse_radius": 0.3,
           "young_modulus": 2.1e11, "poisson_ratio": 0.28}
LOAD, R0, B0 = 66e3, 0.46, 0.75


def pair(vehicle=VEHICLE, **parameters) -> WheelContacts:
    """Left and right wheel of one wheelset."""
    return LinearContact(**parameters).resolved(vehicle).wheels([LOAD, LOAD], R0, B0, [-1, 1])


# --- geometry ---------------------------------------------------------------------------------------------------

def rigid_motion():
    """Symbols y, phi, z of the penetration in the module's docstring, solved for rigid contact to first order."""
    y, phi, z, r0, b0, delta0, eps = sm.symbols("y phi z r0 b0 delta0 eps", real=True)
    shift = y - r0 * phi
    gaps = [z + side * (b0 * phi + delta0 * shift) + eps * shift**2 / 2 for side in (-1, 1)]
    slopes = [delta0 + side * eps * shift for side in (-1, 1)]
    # The difference of both gaps is linear in y and phi: exact.
    roll = sm.solve(sm.Eq(gaps[1] - gaps[0], 0), phi)[0]
    return (y, phi, z, r0, b0, delta0, eps), gaps, slopes, roll


def test_slope_and_gradient_obey_their_definitions_along_rigid_contact():
    (y, phi, _, r0, b0, delta0, eps), _, slopes, roll = rigid_motion()
    sigma, angle = sm.symbols("sigma E", real=True)
    values = {delta0: b0 * sigma / (b0 + r0 * sigma), eps: angle / (b0 + r0 * sigma)}
    assert sm.simplify(roll.subs(values) + sigma * y / b0) == 0  # phi = -sigma y/b0
    for side, slope in zip((-1, 1), slopes):
        along = slope.subs(phi, roll).subs(values)
        assert sm.simplify(sm.diff(along, y) * b0 - side * angle) == 0  # d(delta)/d(y/b0) = side E


def test_slope_is_the_derivative_of_the_penetration():
    (y, _, _, _, _, _, _), gaps, slopes, _ = rigid_motion()
    for side, gap, slope in zip((-1, 1), gaps, slopes):
        assert sm.simplify(sm.diff(gap, y) - side * slope) == 0


def test_numbers_follow_the_definitions():
    wheels = pair(conicity=0.15, roll_parameter=0.05, contact_angle_parameter=8.0)
    assert wheels.slope == pytest.approx(B0 * 0.05 / (B0 + R0 * 0.05), rel=1e-15)
    assert wheels.slope_gradient == pytest.approx(8.0 / (B0 + R0 * 0.05), rel=1e-15)
    assert np.all(wheels.conicity == 0.15)


@pytest.mark.parametrize("conicity", (0.05, 0.2, 0.4))
def test_cone_on_rail_edges_rolls_and_tilts_as_assumed(conicity):
    """Finite geometry: two straight generators through the fixed points (+-b0, r0) below the axle."""
    from scipy.optimize import fsolve

    def gaps(unknown, y):
        z, phi = unknown
        out = []
        for side in (-1, 1):
            across, down = side * B0 - y, R0 - z
            lateral = across * np.cos(phi) + down * np.sin(phi)
            vertical = -across * np.sin(phi) + down * np.cos(phi)
            out.append(vertical - (R0 - side * conicity * (lateral - side * B0)))
        return out

    y = 1e-4
    phi = [fsolve(gaps, (0.0, 0.0), args=(s * y,), xtol=1e-14)[1] for s in (-1, 1)]
    roll_gradient = (phi[1] - phi[0]) / (2 * y)
    wheels = pair(conicity=conicity)
    sigma = conicity * B0 / (B0 - R0 * conicity)
    # Central difference over 0.1 mm in 0.75 m: 1e-8; fsolve leaves 1e-14/1e-4 = 1e-10.
    assert roll_gradient == pytest.approx(-sigma / B0, rel=1e-6)
    assert wheels.slope == pytest.approx(conicity, rel=1e-14)
    # A generator turns with the axle: delta = delta0 - side phi, against eps yc, yc = y (1 + r0 sigma/b0).
    assert wheels.slope_gradient * (1 + R0 * sigma / B0) == pytest.approx(-roll_gradient, rel=1e-6)


# --- magnitudes -------------------------------------------------------------------------------------------------

def test_kalker_limit_coefficients_from_their_definitions():
    wheels = pair(conicity=0.2, amplitude=0.0)
    shear = 2.1e11 / (2 * 1.28)
    c = kalker_coefficients(wheels.a / wheels.b, 0.28)
    area = wheels.a * wheels.b
    assert np.all(wheels.gain == 1.0)
    for found, expected in ((wheels.f11, shear * area * c.c11), (wheels.f22, shear * area * c.c22),
                            (wheels.f23, shear * area**1.5 * c.c23), (wheels.f33, shear * area**2 * c.c33)):
        assert found == pytest.approx(expected, rel=1e-12)
    # A 66 kN wheel on a UIC 60 rail: an ellipse of about 12 by 9 mm, creep coefficients of about 1e7 N.
    assert wheels.a == pytest.approx(6.26e-3, rel=0.01) and wheels.b == pytest.approx(4.71e-3, rel=0.01)
    assert wheels.f11 == pytest.approx(1.1e7, rel=0.02)


def test_creep_coefficients_scale_with_load_and_weight():
    contact = LinearContact(0.2, amplitude=0.0).resolved(VEHICLE)
    light, heavy = (contact.wheels([n], R0, B0, [1]) for n in (LOAD, 8 * LOAD))
    for name, ratio in (("a", 2), ("b", 2), ("f11", 4), ("f22", 4), ("f23", 8), ("f33", 16), ("normal_stiffness", 2)):
        assert getattr(heavy, name) == pytest.approx(ratio * getattr(light, name), rel=1e-12), name
    half = replace(contact, kalker_weight=0.5).wheels([LOAD], R0, B0, [1])
    for name in ("f11", "f22", "f23", "f33"):
        assert getattr(half, name) == pytest.approx(0.5 * getattr(light, name), rel=1e-14)


def test_wheels_of_different_size_keep_their_own_values():
    contact = LinearContact(0.2, amplitude=3e-3).resolved(VEHICLE)
    loads, radii, spacings = [66e3, 40e3, 90e3], [0.46, 0.42, 0.5], [0.75, 0.55, 0.8]
    together = contact.wheels(loads, radii, spacings, [1, -1, 1])
    for i in range(3):
        alone = contact.wheels([loads[i]], [radii[i]], [spacings[i]], [(1, -1, 1)[i]])
        for field in fields(WheelContacts):
            assert getattr(together, field.name)[i] == pytest.approx(getattr(alone, field.name)[0], rel=1e-13)


# --- friction ---------------------------------------------------------------------------------------------------

def test_friction_matters_at_a_finite_amplitude():
    low, high = (pair(conicity=0.2, friction=mu, amplitude=4e-3) for mu in (0.3, 0.6))
    assert np.all(high.gain - low.gain > 0.1) and np.all(high.gain < 1.0)
    for name in ("f11", "f22", "f23", "f33"):
        assert getattr(low, name) / low.gain == pytest.approx(getattr(high, name) / high.gain, rel=1e-13)


def test_gain_falls_with_amplitude_and_conicity_and_rises_with_friction():
    def gain(conicity=0.2, friction=0.3, amplitude=4e-3):
        return pair(conicity=conicity, friction=friction, amplitude=amplitude).gain[0]

    assert gain(amplitude=1e-9) == pytest.approx(1.0, abs=1e-6)
    assert np.all(np.diff([gain(amplitude=a) for a in (0, 1e-3, 4e-3, 8e-3, 5e-2)]) < 0)
    assert np.all(np.diff([gain(conicity=c) for c in (0.0, 0.1, 0.2, 0.4)]) < 0)
    assert np.all(np.diff([gain(friction=m) for m in (0.1, 0.3, 0.6, 5.0)]) > 0)
    assert gain(conicity=-0.2) == gain(conicity=0.2)


def test_gain_is_that_of_the_documented_creepage():
    from railsym.describing_function import creep_gain

    linear = pair(conicity=0.2, amplitude=0.0)
    for law in ("shen_hedrick_elkins", "polach"):
        wheels = pair(conicity=0.2, amplitude=4e-3, law=law)
        saturation = linear.f11 * 0.2 * 4e-3 / R0 / (0.3 * LOAD)
        assert wheels.gain == pytest.approx(creep_gain(saturation, law), rel=1e-13)
    assert np.all(pair(conicity=0.2, amplitude=4e-3, law="kalker").gain == 1.0)


@pytest.mark.parametrize("q", (0.5, 1.0, 1.8, 5.0, 100.0))
def test_creepage_of_a_rigid_bogie_in_kinematic_hunting(q):
    """Where lam A/r0 comes from: wheelsets of a rigid bogie of half wheelbase q b0, equal creep coefficients."""
    lam = 0.2
    # Forces balance: sum of eta = 0, sum of (b0 xi_right side + lever eta) = 0.
    wave = 1j * np.sqrt(lam / (R0 * B0 * (1 + q**2)))  # d/dx
    y, yaw = 1.0, wave
    levers = np.array([q * B0, -q * B0])
    lateral = y + levers * yaw
    xi = B0 * wave * yaw + lam * lateral / R0
    eta = wave * lateral - yaw
    assert abs(eta.sum()) < 1e-12 and abs((B0 * xi + levers * eta).sum()) < 1e-12  # it is the free motion
    resultant = np.sqrt((np.abs(xi) ** 2 + np.abs(eta) ** 2).sum() / (np.abs(lateral) ** 2).sum())
    share, steep = q**2 / (1 + q**2), lam * B0 / R0
    formula = np.sqrt(share * (1 + steep) / (1 + share * steep))
    limit = creepage_amplitude(lam, 1.0, R0)
    assert resultant / limit == pytest.approx(formula, rel=1e-12)
    assert resultant < limit
    if q == 100.0:
        assert resultant == pytest.approx(limit, rel=1e-3)  # 1/(2 q^2)


# --- parameters and errors --------------------------------------------------------------------------------------

def test_resolved_keeps_what_was_given_and_takes_the_rest_from_the_vehicle():
    vehicle = VEHICLE | {"amplitude": 4e-3}
    contact = LinearContact(conicity=0.1, friction=0.6).resolved(vehicle)
    assert (contact.conicity, contact.friction, contact.amplitude) == (0.1, 0.6, 4e-3)
    assert contact.rail_transverse_radius == 0.3 and contact.wheel_transverse_radius == inf
    assert contact.roll_parameter is None and contact.contact_angle_parameter is None  # the cone's
    assert LinearContact().resolved(VEHICLE).amplitude == 0.0
    assert contact.resolved({}) == contact


def test_conicity_may_be_zero_or_negative():
    cylinder, worn = pair(conicity=0.0, amplitude=3e-3), pair(conicity=-0.02, amplitude=3e-3)
    assert np.all(cylinder.slope == 0.0) and np.all(cylinder.gain == 1.0)
    assert worn.slope == pytest.approx(-0.02, rel=1e-14) and np.all(worn.slope_gradient < 0.0)


@pytest.mark.parametrize("parameters, words", [
    ({"conicity": nan}, "conicity is nan"), ({"conicity": None}, "conicity must be a number"),
    ({"conicity": "steep"}, "conicity must be a number, got 'steep'"),
    ({"friction": 0.0}, "friction is 0.0 -; it must be positive"), ({"friction": -0.3}, "friction is -0.3"),
    ({"kalker_weight": -1.0}, "kalker_weight is -1.0"), ({"amplitude": -1e-3}, "amplitude is -0.001 m"),
    ({"poisson_ratio": 0.7}, "poisson_ratio is 0.7"), ({"young_modulus": 0.0}, "young_modulus is 0.0"),
    ({"rail_transverse_radius": 0.0}, "rail_transverse_radius is 0.0 m"),
    ({"roll_parameter": inf}, "roll_parameter is inf"),
    ({"law": "johnsen"}, "creep law 'johnsen' does not exist"),
])
def test_bad_parameters(parameters, words):
    with pytest.raises(ContactError, match=words):
        LinearContact(**parameters)


def test_missing_parameters_are_named():
    with pytest.raises(ContactError, match=r"has no friction \[-\].*LinearContact.*\[contact\]"):
        LinearContact().resolved({name: value for name, value in VEHICLE.items() if name != "friction"})
    with pytest.raises(ContactError, match="call resolved"):
        LinearContact().wheels([LOAD], R0, B0, [1])


@pytest.mark.parametrize("arguments, words", [
    (([LOAD, -1.0], R0, B0, [-1, 1]), "wheel 1: load is -1.0 N"),
    (([LOAD, nan], R0, B0, [-1, 1]), "wheel 1: load is nan N"),
    (([LOAD, LOAD], [R0, 0.0], B0, [-1, 1]), "wheel 1: wheel_radius is 0.0 m"),
    (([LOAD, LOAD], R0, B0, [-1, 0]), "wheel 1: side is 0.0"),
    (([LOAD, LOAD], R0, B0, [-1, 1, 1]), r"shapes \(2,\), \(\), \(\), \(3,\)"),
])
def test_bad_wheels(arguments, words):
    with pytest.raises(ContactError, match=words):
        LinearContact().resolved(VEHICLE).wheels(*arguments)


def test_impossible_geometry():
    with pytest.raises(ContactError, match="not make a convex contact"):
        pair(wheel_transverse_radius=-0.25)
    with pytest.raises(ContactError, match="not make a convex contact"):
        pair(rail_transverse_radius=inf)
    with pytest.raises(ContactError, match="apex of the cone"):
        pair(conicity=1.7)
    with pytest.raises(ContactError, match="must exceed -b0/r0"):
        pair(roll_parameter=-2.0)


def test_cached_patch_does_not_leak_between_calls():
    contact = LinearContact(0.2, amplitude=3e-3).resolved(VEHICLE)
    first = contact.wheels([LOAD], R0, B0, [1])
    first.f11[:], first.normal_stiffness[:] = 0.0, 0.0
    assert contact.wheels([LOAD], R0, B0, [1]).f11[0] > 1e6
    load = np.array([LOAD])
    contact.wheels(load, R0, B0, [1]).load[:] = 0.0
    assert load[0] == LOAD
