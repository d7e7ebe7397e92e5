# SPDX-License-Identifier: BSD-3-Clause
"""The virtual bench against the closed form of the linear Maxwell model, SciPy, and its order of convergence."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

from railsym.dampers.bench import sweep, virtual_bench
from railsym.dampers.models import DamperModel
from railsym.errors import CoreError, ModelError

C, K = 5e5, 5e6
LINEAR = DamperModel("maxwell", damping=C, series_stiffness=K)
DAMPING = ([-0.1, -0.02, 0.0, 0.01, 0.1], [-9000.0, -6000.0, 0.0, 4000.0, 12000.0])
STIFFNESS = ([0.0, 0.03, 0.1], [3e6, 5e6, 8e6])


def closed_form(frequency):
    """K* = i omega c k/(k + i omega c)."""
    s = 2j * np.pi * np.asarray(frequency)
    return s * C * K / (K + s * C)


def test_linear_maxwell_dynamic_stiffness_and_phase():
    f = [0.5, 1.0, 4.0]
    found = sweep(LINEAR, f, [1e-3, 3e-3], samples_per_cycle=512)
    # TR-BDF2 at 512 steps a cycle: 0.04 (2 pi/512)^2 = 6e-6.
    np.testing.assert_allclose(found.dynamic_stiffness, np.repeat(closed_form(f)[:, None], 2, axis=1), rtol=1e-5)
    np.testing.assert_allclose(found.phase[:, 0], np.angle(closed_form(f)), atol=1e-5)
    np.testing.assert_allclose(LINEAR.dynamic_stiffness(f), closed_form(f), rtol=1e-13)


def test_loop_area_is_the_dissipated_energy():
    found = sweep(LINEAR, 2.0, 1e-3, samples_per_cycle=512)
    area = np.mean(found.force * found.velocity) / 2.0
    assert area == pytest.approx(np.pi * 1e-6 * closed_form(2.0).imag, rel=1e-5)
    assert found.dissipated_energy[0, 0] == pytest.approx(area, rel=1e-12)


def test_second_order():
    errors = [abs(sweep(LINEAR, 1.0, 1e-3, samples_per_cycle=n).dynamic_stiffness[0, 0] - closed_form(1.0)) for n in (64, 128, 256)]
    ratios = np.divide(errors[:-1], errors[1:])
    np.testing.assert_allclose(ratios, 4.0, rtol=0.03)


def test_curves_against_radau():
    """Asymmetric damping, stiffness over speed: SciPy on the same equation, D inverted by a dense table."""
    model = DamperModel("maxwell", damping_curve=DAMPING, series_stiffness_curve=STIFFNESS)
    a, omega = 2e-3, 2.0 * np.pi * 3.0
    damping, stiffness = PchipInterpolator(*DAMPING), PchipInterpolator(*STIFFNESS)
    w = np.linspace(-0.1, 0.1, 40001)
    force_of = damping(w)

    def spring(t, s):
        return stiffness(np.abs(a * omega * np.cos(omega * t))) * (a * np.sin(omega * t) - s)

    t = np.linspace(0.0, 0.7, 3001)
    exact = solve_ivp(lambda t, s: np.interp(spring(t, s), force_of, w), (0.0, t[-1]), [0.0], "Radau", t, rtol=1e-9, atol=1e-12)
    wanted = spring(t, exact.y[0])
    force, s = virtual_bench(model, t, a * np.sin(omega * t), a * omega * np.cos(omega * t))
    # 1400 steps a cycle, and slopes of k that jump where v changes sign.
    np.testing.assert_allclose(force, wanted, atol=1e-4 * np.abs(wanted).max())
    np.testing.assert_allclose(s, exact.y[0], atol=1e-4 * a)


def test_blow_off_valve_with_a_flat_end():
    """A force that no longer grows with speed: every stage still has its root."""
    model = DamperModel("maxwell", damping_curve=([0.0, 0.01, 0.1], [0.0, 8000.0, 8000.0]), series_stiffness=5e6)
    force = sweep(model, 3.0, 5e-3).force[0, 0]
    assert np.abs(force).max() == pytest.approx(8000.0, rel=1e-6)


def test_viscous_model_is_its_curve():
    curve = ([0.0, 0.05, 0.1], [0.0, 4000.0, 5000.0])
    v = np.linspace(-0.1, 0.1, 11)
    force, _ = virtual_bench(DamperModel("viscous", damping_curve=curve), np.arange(11.0), np.zeros(11), v)
    x, y = map(np.array, curve)
    np.testing.assert_allclose(force, PchipInterpolator(np.r_[-x[:0:-1], x], np.r_[-y[:0:-1], y])(v), atol=1e-9)


def test_refusals():
    t = np.arange(5.0)
    with pytest.raises(ModelError, match="not finite at sample 2"):
        virtual_bench(LINEAR, t, [0, 0, np.nan, 0, 0], t)
    with pytest.raises(ModelError, match="does not increase"):
        virtual_bench(LINEAR, t[::-1], t)
    with pytest.raises(CoreError, match="t = 1 s"):
        virtual_bench(LINEAR, t, [0, 1e308, 1e308, 0, 0], t * 1e307)
