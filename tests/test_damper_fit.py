# SPDX-License-Identifier: BSD-3-Clause
"""Identification recovers known dampers; linear ones in closed form, so that nothing is shared with the bench."""

import numpy as np
import pytest

from railsym.dampers.fit import identify
from railsym.dampers.record import CleanRecord
from railsym.errors import ModelError

TESTS = [(f, a) for f in (0.5, 1.0, 2.0, 3.0, 4.0) for a in (1e-3, 2e-3)]


def linear_records(c, k, noise=0.0, lag=0.0, tests=TESTS, seed=3):
    """Steady cycles of K* = i omega c k/(k + i omega c), with white noise on the force and its lag."""
    random, found = np.random.default_rng(seed), []
    for f, a in tests:
        n, cycles, omega = int(round(1000 / f)), 10, 2.0 * np.pi * f
        t = np.arange(n * cycles) / (n * f)
        stiffness = 1j * omega * c / (1.0 + 1j * omega * c / k) * np.exp(-1j * omega * lag)
        force = a * np.imag(stiffness * np.exp(1j * omega * t))
        size = noise * np.std(force)
        force = force + size * random.standard_normal(t.size)
        found.append(CleanRecord(t, a * np.sin(omega * t), a * omega * np.cos(omega * t), force, f, a, cycles, n, 0.0, size, name=f"{f} Hz"))
    return found


@pytest.mark.parametrize("c", [1e5, 3e5, 1e6])
@pytest.mark.parametrize("k", [2e6, 1e7])
def test_linear_maxwell_without_noise(c, k):
    records = linear_records(c, k)
    fast, sharp = identify(records, method="energy"), identify(records)
    assert (fast.damping, fast.series_stiffness) == pytest.approx((c, k), rel=1e-3)
    # The bench's steps (512 a cycle) leave 1e-5 in the force, which a small omega c/k magnifies.
    assert (sharp.damping, sharp.series_stiffness) == pytest.approx((c, k), rel=1e-3)
    assert abs(sharp.lag) < 2e-5


@pytest.mark.parametrize(("c", "k"), [(1e5, 2e6), (1e5, 1e7), (1e6, 2e6), (1e6, 1e7)])
def test_linear_maxwell_with_noise_and_lag(c, k):
    fit = identify(linear_records(c, k, 0.02, 3e-3))
    assert (fit.damping, fit.series_stiffness) == pytest.approx((c, k), rel=0.05)
    assert fit.lag == pytest.approx(3e-3, abs=2e-4)
    low, high = fit.confidence["series_stiffness"]
    assert low < fit.series_stiffness < high
    assert high / low < 1.2


def test_wrong_model_is_named():
    fit = identify(linear_records(5e5, 5e6), model="viscous")
    assert "wrong model: maxwell" in fit.message


def test_one_frequency_does_not_tell_the_lag():
    fit = identify(linear_records(3e5, 5e6, tests=[(1.0, 1e-3), (1.0, 2e-3)]))
    assert "lag cannot be told" in fit.message
    assert (fit.damping, fit.series_stiffness) == pytest.approx((3e5, 5e6), rel=1e-3)


def test_a_stiffness_too_high_to_matter_is_said():
    fit = identify(linear_records(1e5, 1e10), method="energy", lag=0.0)
    assert "viscous model is enough" in fit.message


def test_refusals():
    with pytest.raises(ModelError, match="viscous, maxwell, maxwell_nonlinear"):
        identify(linear_records(1e5, 1e7), model="kelvin")
    with pytest.raises(ModelError, match="at least one test"):
        identify([])
