# SPDX-License-Identifier: BSD-3-Clause
"""Describing functions against quadrature of their definition, limits, order and errors."""

import numpy as np
import pytest
from scipy.integrate import quad

from railsym.describing_function import LAWS, creep_force_ratio, creep_gain
from railsym.errors import ContactError

SATURATING = [law for law in LAWS if law != "kalker"]


def gain_by_quadrature(amplitude, law):
    """First harmonic of g(U sin t) over U, the definition, by adaptive quadrature on each smooth piece."""
    kink = np.arcsin(min(1.0, 3.0 / amplitude))
    pieces = (0.0, kink, np.pi / 2)
    total = sum(quad(lambda t: float(creep_force_ratio(amplitude * np.sin(t), law)) * np.sin(t), low, high,
                     epsabs=0.0, epsrel=1e-13, limit=200)[0] for low, high in zip(pieces, pieces[1:]) if high > low)
    return 4.0 / (np.pi * amplitude) * total


@pytest.mark.parametrize("law", SATURATING)
@pytest.mark.parametrize("amplitude", (0.01, 0.5, 1.0, 2.9, 3.0, 3.1, 5.0, 29.9, 30.1, 200.0))
def test_closed_form_is_the_first_harmonic(amplitude, law):
    # Quadrature asks for 1e-13; at the kink its last piece is short, so 1e-11.
    assert creep_gain(amplitude, law) == pytest.approx(gain_by_quadrature(amplitude, law), rel=1e-11)


@pytest.mark.parametrize("law", SATURATING)
def test_it_is_the_best_linear_fit_in_the_mean_square(law):
    t = np.linspace(0.0, 2 * np.pi, 4001)[:-1]
    linear = 4.0 * np.sin(t)
    force = np.sign(linear) * creep_force_ratio(np.abs(linear), law)
    # Least squares of force = G linear; 4000 points of a periodic function with a kink of curvature: 1e-9.
    assert creep_gain(4.0, law) == pytest.approx(linear @ force / (linear @ linear), rel=1e-8)


@pytest.mark.parametrize("law", SATURATING)
def test_limits(law):
    assert creep_gain(0.0, law) == 1.0
    assert 0.0 < 1.0 - creep_gain(1e-3, law) < 3e-4  # first order 8/(27 pi) 3 = 0.283 U (SHE), second order (Polach)
    for amplitude in (1e4, 1e8, 1e12):
        # Dry friction; the next terms are of relative order 1/U.
        assert creep_gain(amplitude, law) == pytest.approx(4 / (np.pi * amplitude), rel=2 / amplitude + 1e-14)


@pytest.mark.parametrize("law", SATURATING)
def test_monotonic_and_above_the_secant_of_the_peak(law):
    amplitude = np.concatenate([np.linspace(0.0, 6.0, 6001), np.geomspace(6.001, 1e6, 4000)])
    gain = creep_gain(amplitude, law)
    assert np.all(np.diff(gain) < 0)
    # g(u)/u falls with u, so the mean over a cycle lies between the secant at the peak and 1.
    peak = creep_force_ratio(amplitude[1:], law) / amplitude[1:]
    assert np.all((peak < gain[1:]) & (gain[1:] < 1.0))


def test_smooth_through_full_sliding_and_through_the_series():
    for amplitude in (3.0, 30.0):
        left, here, right = (creep_gain(amplitude * (1 + s), "shen_hedrick_elkins") for s in (-1e-5, 0.0, 1e-5))
        assert left > here > right
        # Value and slope are continuous: second difference h^2 G'' ~ 1e-10 G.
        assert abs(left - 2 * here + right) < 1e-9 * here


def test_force_law_is_continuous_and_saturates():
    assert creep_force_ratio(3.0) == pytest.approx(1.0, abs=1e-15)
    assert creep_force_ratio(1e9) == 1.0
    assert creep_force_ratio(1e9, "polach") == pytest.approx(1.0, abs=1e-8)
    for law in LAWS:
        assert creep_force_ratio(1e-8, law) == pytest.approx(1e-8, rel=1e-7)


def test_kalker_has_no_saturation():
    assert np.all(creep_gain([0.0, 1.0, 1e6], "kalker") == 1.0)
    assert np.all(creep_force_ratio([0.0, 1.0, 1e6], "kalker") == [0.0, 1.0, 1e6])


def test_arrays_agree_with_single_values():
    amplitude = np.array([[0.1, 2.0, 3.0], [3.5, 40.0, 1e5]])
    for law in LAWS:
        gain = creep_gain(amplitude, law)
        assert gain.shape == (2, 3)
        assert np.all(gain == [[creep_gain(u, law) for u in row] for row in amplitude])


def test_errors():
    with pytest.raises(ContactError, match="'polack' does not exist.*did you mean 'polach'"):
        creep_gain(1.0, "polack")
    for bad in (-0.1, float("nan"), [1.0, -1.0]):
        with pytest.raises(ContactError, match="must not be negative or NaN"):
            creep_gain(bad)
