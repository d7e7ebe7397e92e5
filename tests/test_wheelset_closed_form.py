# SPDX-License-Identifier: BSD-3-Clause
"""The closed-form critical speed of a wheelset against eigenvalues of its state matrix."""

from dataclasses import replace
from math import inf, pi, sqrt

import numpy as np
import pytest
from oracles.wheelset_closed_form import Wheelset, klingel_wavelength

EQUAL = Wheelset(mass=1250.0, yaw_inertia=820.0, wheel_radius=0.46, contact_half_spacing=0.75, conicity=0.2,
                 lateral_stiffness=3e5, yaw_stiffness=2.5e5, f11=9e6, f22=9e6)
CASES = {
    "equal": EQUAL,
    "unequal": replace(EQUAL, f11=10e6, f22=6e6),
    "unequal, other way": replace(EQUAL, f11=5e6, f22=9e6, conicity=0.05),
    "spin": replace(EQUAL, f11=8.9e6, f22=8.1e6, f23=2.0e4, f33=57.0),
    "spin and gravity": replace(EQUAL, f11=8.9e6, f22=8.1e6, f23=2.0e4, f33=57.0,
                                gravity_lateral_stiffness=2 * 66e3 * 0.23 / 0.75,
                                gravity_yaw_stiffness=-2 * 66e3 * 0.75 * 0.2),
    "one natural frequency": replace(EQUAL, yaw_stiffness=3e5 * 820.0 / 1250.0, f11=10e6, f22=6e6),
}


def largest_real_part(wheelset, speed):
    return np.linalg.eigvals(wheelset.state_matrix(speed)).real.max()


@pytest.mark.parametrize("wheelset", CASES.values(), ids=CASES.keys())
def test_an_eigenvalue_pair_is_on_the_imaginary_axis_at_the_critical_speed(wheelset):
    speed, frequency = wheelset.critical_speed()
    values = np.linalg.eigvals(wheelset.state_matrix(speed))
    root = values[np.argmin(abs(values - 1j * frequency))]
    # Eigenvalues of a 4x4 matrix of norm 1e4 carry about 1e-12 of that; w is about 15 rad/s.
    assert abs(root - 1j * frequency) < 1e-8 * frequency
    assert largest_real_part(wheelset, 0.99 * speed) < 0.0 < largest_real_part(wheelset, 1.01 * speed)
    assert 5.0 < speed < 200.0  # the cases are real wheelsets, not corners


@pytest.mark.parametrize("wheelset", CASES.values(), ids=CASES.keys())
def test_it_is_stable_at_every_lower_and_unstable_at_every_higher_speed(wheelset):
    critical, _ = wheelset.critical_speed()
    for factor in (0.05, 0.2, 0.5, 0.9):
        assert largest_real_part(wheelset, factor * critical) < 0.0
    for factor in (1.1, 2.0, 5.0, 20.0):
        assert largest_real_part(wheelset, factor * critical) > 0.0


def test_one_natural_frequency_gives_klingel_hunting_whatever_the_creep_coefficients():
    wheelset = CASES["one natural frequency"]
    natural = sqrt(wheelset.lateral_stiffness / wheelset.mass)
    speed, frequency = wheelset.critical_speed()
    assert frequency == pytest.approx(natural, rel=1e-12)
    assert speed == pytest.approx(natural * sqrt(0.75 * 0.46 / 0.2), rel=1e-12)
    assert 2 * pi * speed / frequency == pytest.approx(klingel_wavelength(0.46, 0.75, 0.2), rel=1e-12)


def test_slow_free_wheelset_has_klingels_wavelength():
    free = replace(EQUAL, lateral_stiffness=0.0, yaw_stiffness=0.0, f11=10e6, f22=6e6)
    speed = 0.01  # inertia forces are then m w^2 y, 1e-9 of the creep forces
    values = np.linalg.eigvals(free.state_matrix(speed))
    hunting = values[np.argmax(values.imag)]
    assert 2 * pi * speed / hunting.imag == pytest.approx(klingel_wavelength(0.46, 0.75, 0.2), rel=1e-6)


def test_without_conicity_or_with_much_asymmetry_it_never_hunts():
    for wheelset in (replace(EQUAL, conicity=0.0), replace(EQUAL, yaw_stiffness=5e8)):
        assert wheelset.critical_speed()[0] == inf
        assert all(largest_real_part(wheelset, v) < 0.0 for v in (1.0, 30.0, 100.0, 1000.0))


def test_negative_yaw_stiffness_is_unstable_at_every_speed():
    wheelset = replace(EQUAL, lateral_stiffness=0.0, gravity_yaw_stiffness=-3e5)
    assert wheelset.critical_speed() == (0.0, 0.0)
    assert all(largest_real_part(wheelset, v) > 0.0 for v in (0.1, 1.0, 30.0, 100.0))
