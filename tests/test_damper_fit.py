# SPDX-License-Identifier: BSD-3-Clause
"""Identification recovers known dampers; linear ones in closed form, so that nothing is shared with the bench."""

import numpy as np
import pytest

from railsym.dampers import energy, solve
from railsym.dampers.bench import sweep
from railsym.dampers.cleaning import clean_all
from railsym.dampers.fit import identify
from railsym.dampers.models import DamperModel, curve_value
from railsym.dampers.parametrisation import Parametrisation
from railsym.dampers.reading import read_records, shipped_records
from railsym.dampers.record import CleanRecord
from railsym.errors import ModelError
from tests.oracles.damper_records import SHIPPED

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


SPEED = np.array([0.0, 0.003, 0.006, 0.01, 0.016, 0.025, 0.04, 0.08])
STIFFNESS = ((0.0, 0.005, 0.012, 0.02, 0.03, 0.05), (7e6, 6.3e6, 5.6e6, 5.1e6, 4.8e6, 4.6e6))
CURVES = {
    "knee": (SPEED, 7e5 * 0.008 * (np.tanh(SPEED / 0.008) + 0.15 * SPEED / 0.008)),
    "progressive": (SPEED, 4e5 * SPEED * (1.0 + SPEED / 0.03)),
    "blow-off": (SPEED, np.minimum(6e5 * SPEED, 6e3 + 3e4 * (SPEED - 0.01))),
    "friction": ([0.0, 0.0005, 0.002, 0.006, 0.012, 0.02, 0.04, 0.08], [0.0, 680.0, 1400.0, 2600.0, 4400.0, 6800.0, 12800.0, 24800.0]),
    "asymmetric": ([-0.08, -0.02, -0.008, 0.0, 0.008, 0.02, 0.08], [-6600.0, -4200.0, -2700.0, 0.0, 4500.0, 7000.0, 11000.0]),
}
GRID = [(f, a) for f in (0.5, 1.0, 2.0, 3.0) for a in (0.5e-3, 1e-3, 2e-3)]


def curved_records(model, noise, lag, seed=5):
    """Steady cycles of a model by the bench at 2048 steps a cycle (eight times those of the fit), late and noisy."""
    random, found = np.random.default_rng(seed), []
    for f, a in GRID:
        n, cycles = int(round(1000 / f)), 10
        loop = sweep(model, f, a, samples_per_cycle=2048)
        t = np.arange(n * cycles) / (n * f)
        force = np.interp((f * (t - lag)) % 1.0, np.arange(2049) / 2048, np.append(loop.force, loop.force[0, 0, 0]))
        size = noise * np.std(force)
        omega = 2.0 * np.pi * f
        found.append(CleanRecord(t, a * np.sin(omega * t), a * omega * np.cos(omega * t), force - force.mean() + size * random.standard_normal(t.size),
                                 f, a, cycles, n, 0.0, size, name=f"{f} Hz {1e3 * a} mm"))
    return found


def speeds_of(model):
    """Speeds of the damper alone (m/s) from the lowest to the highest in GRID."""
    speed = [np.gradient(sweep(model, f, a, samples_per_cycle=2048).damper_elongation[0, 0], 1.0 / (2048 * f)) for f, a in GRID]
    return np.linspace(min(map(np.min, speed)), max(map(np.max, speed)), 81)


def force_of(model, speed):
    record = model.force_law_record()
    curve = record.get("damping_curve")
    return record["damping"] * speed + (0.0 if curve is None else curve_value(curve, speed))


@pytest.mark.parametrize("shape", CURVES)
@pytest.mark.parametrize(("noise", "lag"), [(0.0, 0.0), (0.02, 3e-3)])
def test_curves_within_3_percent_of_peak(shape, noise, lag):
    true = DamperModel("maxwell", damping_curve=CURVES[shape], series_stiffness_curve=STIFFNESS)
    fit = identify(curved_records(true, noise, lag), model="maxwell_nonlinear")
    speed = speeds_of(true)
    wanted = force_of(true, speed)
    assert np.abs(force_of(fit.model, speed) - wanted).max() < 0.03 * np.abs(wanted).max()
    at = np.linspace(0.0, 0.037, 20)
    stiffness = [curve_value(one.force_law_record()["stiffness_curve"], at) for one in (fit.model, true)]
    np.testing.assert_allclose(*stiffness, rtol=0.03)
    assert fit.lag == pytest.approx(lag, abs=1e-4)
    assert "wrong model" not in fit.message
    assert np.abs(fit.damping_curve[0]).max() < 1.1 * np.abs(speed).max()


def test_shipped_records():
    cleaned = clean_all(read_records(shipped_records()))
    fit = identify(cleaned, model="maxwell_nonlinear")
    speed = np.linspace(0.0, fit.damping_curve[0][-1], 50)
    # made by another integrator with 1 % noise and 2 ms lag
    assert np.abs(force_of(fit.model, speed) - SHIPPED.force(speed)).max() < 0.01 * SHIPPED.force(speed[-1])
    assert fit.lag == pytest.approx(2e-3, abs=5e-5)
    assert "wrong model" not in fit.message
    plain = identify(cleaned, model="maxwell", method="energy")
    assert "wrong model: maxwell_nonlinear leaves less" in plain.message


def test_a_constant_stiffness_is_enough():
    assert "with a constant one, is enough" in identify(linear_records(3e5, 5e6), model="maxwell_nonlinear").message


@pytest.mark.parametrize("kind", ["viscous", "maxwell"])
def test_jacobian_against_differences(kind):
    loops = energy.loops_of(linear_records(3e5, 5e6, lag=1e-3))
    nodes = np.array([0.0, 0.004, 0.01, 0.05])
    stiff = kind == "maxwell"
    made = Parametrisation(kind, nodes, np.array([0.0, 0.02, 0.05]) if stiff else None, 1e4, False)
    x = made.vector(np.array([0.0, 2000.0, 4000.0, 9000.0]), [6e6, 5e6, 4.5e6] if stiff else (), 1e-3)
    step = 1e-5
    wanted = np.array([(solve.misfit(loops, made, x + step * u, 0.0) - solve.misfit(loops, made, x - step * u, 0.0)) / (2 * step) for u in np.eye(x.size)]).T
    # 256 steps a cycle against 512: second order, and kinks at the nodes
    assert np.linalg.norm(solve.jacobian(loops, made, x, 0.0) - wanted) < 0.01 * np.linalg.norm(wanted)
