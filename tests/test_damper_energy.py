# SPDX-License-Identifier: BSD-3-Clause
"""The energy method against the closed form of the linear Maxwell damper that starts from rest."""

import numpy as np
import pytest

from railsym.dampers import energy
from railsym.dampers.cleaning import clean_all
from railsym.dampers.elongation import lag_by_elongation, refined_elongation, split_elongation
from railsym.dampers.fit import identify
from railsym.dampers.reading import read_records
from railsym.dampers.record import Record
from tests.oracles.bench_campaign import ClosedDamper, campaign, random_bench
from tests.test_damper_fit import linear_records

TESTS = [(f, a) for f in (0.5, 1.0, 2.0, 3.0) for a in (0.5e-3, 1e-3, 2e-3)]


def records(c, k, rate=1000.0, cycles=10, noise=0.0, lag=0.0, seed=0, transient=False):
    """F + (c/k) dF/dt = c v: steady part Im(K* e), and exp(-k t/c) of a start without force; noise on both channels."""
    random, found = np.random.default_rng(seed), []
    for f, a in TESTS:
        omega, phase = 2.0 * np.pi * f, random.uniform(0.0, 2.0 * np.pi)
        t = np.arange(int(cycles * rate / f)) / rate
        stiffness = 1j * omega * c / (1.0 + 1j * omega * c / k)
        force = a * np.imag(stiffness * np.exp(1j * (omega * (t - lag) + phase)))
        if transient:
            force -= a * np.imag(stiffness * np.exp(1j * phase)) * np.exp(-k / c * np.maximum(t - lag, 0.0))
        e = a * np.sin(omega * t + phase)
        e, force = (part + noise * np.std(part) * random.standard_normal(t.size) for part in (e, force))
        found.append(Record(t, e, force, name=f"{f:g} Hz {1e3 * a:g} mm"))
    return found


@pytest.mark.parametrize("lag", [-4e-3, 0.0, 3e-3])
def test_constants_are_exact_without_noise(lag):
    loops = energy.loops_of(linear_records(1e6, 2e6, lag=lag))
    # the search for the lag ends at 1e-7 s; omega lag c/k = 25 rad/s 1e-7 s 12 = 3e-5 at most
    assert energy.constants(loops) == pytest.approx((2e6, 1e6, lag), rel=1e-4, abs=2e-7)


@pytest.mark.parametrize("lag", [0.0, 2e-3])
def test_a_lag_that_is_given_is_kept(lag):
    loops = energy.loops_of(linear_records(3e5, 5e6, lag=2e-3))
    stiffness, damping, kept = energy.constants(loops, lag)
    assert kept == lag
    assert (stiffness == pytest.approx(5e6, rel=1e-6)) == (lag == 2e-3)


def test_shifted_loops_are_those_without_the_lag():
    late, prompt = (energy.loops_of(linear_records(3e5, 5e6, lag=lag)) for lag in (2e-3, 0.0))
    scale = prompt.scale[:, None]
    np.testing.assert_allclose(late.shifted(2e-3).force / scale, prompt.force / scale, atol=1e-9)
    assert np.abs((late.force - prompt.force) / scale).max() > 1e-3


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("c", "k"), [(1e6, 2e6), (1e5, 2e6), (1e5, 1e7), (1e6, 1e7)])
def test_noise_and_lag(c, k, seed):
    fit = identify(clean_all(records(c, k, noise=0.02, lag=3e-3, seed=seed)), method="energy")
    assert fit.damping_curve is None
    assert (fit.damping, fit.series_stiffness) == pytest.approx((c, k), rel=0.05)
    assert "wrong model" not in fit.message


def test_dissipated_energy_of_a_known_speed():
    loops = energy.loops_of(linear_records(3e5, 5e6))
    speed = loops.force / 3e5
    assert energy.dissipated(loops, speed) == pytest.approx(3e5, rel=1e-9)
    # noise of the speed of 10 % must not bias: int w^2 dt would be 1 % too large
    noisy = speed + 0.1 * np.std(speed, axis=1, keepdims=True) * np.random.default_rng(1).standard_normal(speed.shape)
    assert energy.dissipated(loops, noisy) == pytest.approx(3e5, rel=0.005)


@pytest.mark.parametrize("levels", [None, np.array([0.0, 1e5])])
def test_stored_energy_is_that_of_the_spring(levels):
    loops = energy.loops_of(linear_records(3e5, 5e6))
    found = split_elongation(loops, levels=levels)
    # the corners of R at levels of force cost 1e-4
    assert found.compliance[0] == pytest.approx(1 / 5e6, rel=3e-4)
    assert np.interp(3000.0, found.force, found.speed) == pytest.approx(0.01, rel=1e-3)
    assert found.misfit < 1e-4


def test_curve_and_lag_by_the_elongation():
    """A record of the second generator: friction and blow-off, constant stiffness, no noise."""
    random = np.random.default_rng(3)
    tests = [(f, a) for f in (0.5, 1.5, 4.0) for a in (0.5e-3, 1e-3, 3e-3)]
    damper = ClosedDamper(5e5, 6e6, "friction and blow-off", bend=0.02, dry=1500.0, stick=1e-3)
    made = campaign(damper, tests, random_bench(random, tests, 0.0, 3, lag=-2e-3, rate=2000.0, jitter=0.0))
    loops = energy.loops_of(clean_all(read_records(made.records, units=made.units)))
    lag = lag_by_elongation(loops)
    assert lag == pytest.approx(-2e-3, abs=1e-4)
    found = refined_elongation(loops.shifted(lag))
    assert found.compliance[0] == pytest.approx(1.0 / 6e6, rel=0.01)
    speed = np.linspace(0.0, made.fastest[1], 101)
    wanted = damper.force(speed)
    # 24 levels of force: a corner between two of them costs some 3 % of the peak
    assert np.abs(np.interp(speed, found.speed, found.force) - wanted).max() < 0.05 * wanted.max()


def random_cases(count=24, seed=11):
    """c, k, sampling, cycles, noise, lag of each case."""
    random = np.random.default_rng(seed)
    for i in range(count):
        c, k = 10.0 ** random.uniform(5.0, 6.0), 10.0 ** random.uniform(np.log10(2e6), 7.0)
        yield c, k, 10.0 ** random.uniform(np.log10(500.0), np.log10(5000.0)), int(random.integers(5, 21)), 0.02 * (i % 2), 3e-3 * (i // 2 % 2), i


@pytest.mark.slow
@pytest.mark.parametrize("method", ["energy", "least_squares"])
@pytest.mark.parametrize("transient", [False, True])
def test_random_cases(method, transient, capsys):
    worst = {0.0: 0.0, 0.02: 0.0}
    for c, k, rate, cycles, noise, lag, seed in random_cases():
        fit = identify(clean_all(records(c, k, rate, cycles, noise, lag, seed, transient)), method=method)
        errors = fit.damping / c - 1.0, fit.series_stiffness / k - 1.0
        worst[noise] = max(worst[noise], *map(abs, errors))
        with capsys.disabled():
            print(f"\n{method} c {c:.3g} k {k:.3g} {rate:.0f} Hz {cycles} cycles noise {noise} lag {lag}: {100 * errors[0]:+.3f} {100 * errors[1]:+.3f} %, "
                  f"lag {1e3 * fit.lag:+.3f} ms", end="")
    assert worst[0.0] < 0.01 and worst[0.02] < 0.05
