# SPDX-License-Identifier: BSD-3-Clause
"""Equivalent conicity of all reference wheels over all amplitudes, of pairs that differ left and right, and where there is no motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import railsym as rs
from tests.oracles.profile_pairs import circle, cone, over_the_axis

MM = 1e-3
AMPLITUDES = np.array([0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]) * MM


def pair_of(right, **more):
    return rs.ContactPair(f"EN15302_wheel_{right}", "EN15302_rail_A", gauge=None, **more)


@pytest.mark.parametrize("wheel", "ABCHI")
@pytest.mark.parametrize("with_roll", (False, True))
def test_reference_wheels_over_all_amplitudes(wheel, with_roll):
    pair = pair_of(wheel)
    found = pair.equivalent_conicity(AMPLITUDES, with_roll=with_roll)
    assert found.message == "" and np.all(found.centre == 0.0)
    assert np.isfinite(found.conicity).all() and (found.conicity >= 0.0).all() and (found.conicity < 1.0).all()
    # I is a cylinder within 1.5 mm, B and H a cone of 1:40 within 2 mm (1:40 with roll: less than 3 % more)
    if wheel == "I":
        assert np.all(found.conicity[:5] == 0.0) and np.isinf(found.wavelength[:5]).all()
    if wheel in "BH":
        assert found.conicity[:6] == pytest.approx(0.025 * (1.025 if with_roll else 1.0), rel=5e-3)
    wavelength = found.wavelength[np.isfinite(found.wavelength)]
    assert found.conicity[found.conicity > 0] == pytest.approx((np.pi / wavelength) ** 2 * 2 * 1.5 * 0.46, rel=1e-12)


# Left wheel, its diameter as that of the standard's asymmetric cases (2 mm less than the right one's).
PAIRS = {"A, smaller left": ("A", {"wheel_radius_left": 0.459}), "A right, B left": ("A", {"wheel_left": "EN15302_wheel_B"}),
         "C right, smaller H left": ("C", {"wheel_left": "EN15302_wheel_H", "wheel_radius_left": 0.459})}


@pytest.mark.parametrize("name", PAIRS)
def test_asymmetric_pairs_run_as_klingels_equation_says(name):
    """y'' = -dr/(e r0) integrated in time from one turning point: it turns 2A away, after half a wavelength."""
    right, more = PAIRS[name]
    pair, amplitude = pair_of(right, **more), np.array([2.0, 4.0]) * MM
    found = pair.equivalent_conicity(amplitude)
    assert found.message == "" and (found.conicity > 0.0).all()
    stiffness = pair.tape_circle_spacing * pair.mean_radius

    def motion(_, state):
        return [state[1], -np.interp(state[0], found.y, found.rolling_radius_difference) / stiffness]

    def turns(_, state):
        return state[1]

    turns.direction, turns.terminal = 1.0, True
    for a, wavelength, centre in zip(amplitude, found.wavelength, found.centre, strict=True):
        run = solve_ivp(motion, (0.0, 2.0 * wavelength), [centre + a, -1e-12], events=turns, rtol=1e-8, atol=1e-12, max_step=0.1)
        assert run.y_events[0][0, 0] == pytest.approx(centre - a, abs=2e-6)
        # dr jumps within a sample of 0.01 mm
        assert 2.0 * run.t_events[0][0] == pytest.approx(wavelength, rel=2e-3)


def test_smaller_left_wheel_is_the_mirror_image_of_a_smaller_right_one():
    one, other = pair_of("A", wheel_radius=0.460, wheel_radius_left=0.459), pair_of("A", wheel_radius=0.459, wheel_radius_left=0.460)
    first, second = (pair.equivalent_conicity([1.0 * MM, 3.0 * MM]) for pair in (one, other))
    np.testing.assert_allclose(first.conicity, second.conicity, rtol=1e-6)
    np.testing.assert_allclose(first.centre, -second.centre, atol=1e-8)
    assert (first.centre < 0.0).all()      # the larger right wheel runs on its smaller, outer part


def test_negative_conicity_is_a_message():
    found = over_the_axis(cone(-0.05), circle("rail", 300.0, "up")).equivalent_conicity([1.0 * MM, 3.0 * MM])
    assert np.isnan(found.conicity).all() and np.isnan(found.wavelength).all()
    assert found.message.startswith("no periodic motion at the amplitude 1, 3 mm: from y = -3 to 3 mm the rolling radius difference does not drive")


def test_a_motion_out_of_reach_is_a_message_that_says_where_it_was_looked_for():
    found = pair_of("C", wheel_radius_left=0.455).equivalent_conicity([1.0 * MM])
    assert np.isnan(found.conicity).all() and "from y = -9 to 9 mm" in found.message
