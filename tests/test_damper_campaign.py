# SPDX-License-Identifier: BSD-3-Clause
"""Random campaigns of the second generator: closed-form curves, start transients, lag of either sign, coloured noise, jitter, drift."""

import numpy as np
import pytest

from railsym.dampers import RecordError, clean_all, identify, read_records
from tests.oracles.bench_campaign import Bench, ClosedDamper, _noise, campaign, random_campaign
from tests.oracles.damper_accuracy import MODEL, cleaned, force_error, stiffness_error


def checked(seed, kind, noise, method="least_squares"):
    made = random_campaign(seed, kind, noise)
    fit = identify(cleaned(made), MODEL.get(kind, "maxwell_nonlinear"), method)
    assert "wrong model" not in fit.message
    return made, fit


@pytest.mark.parametrize("method", ["energy", "least_squares"])
@pytest.mark.parametrize("noise", [0.0, 0.02])
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.slow)])
def test_constants(seed, noise, method):
    made, fit = checked(seed, "linear", noise, method)
    limit = 0.05 if noise else 0.01
    assert (fit.damping, fit.series_stiffness) == pytest.approx((made.damper.c, made.damper.k), rel=limit)
    assert fit.lag == pytest.approx(made.bench.lag, abs=3e-4)


QUICK = [("viscous curve", 1, 0.0), ("curve", 1, 0.02), ("nonlinear", 2, 0.0), ("nonlinear", 2, 0.02)]
LONG = [(kind, seed, noise) for kind, seed in (("viscous curve", 1), ("curve", 3), ("nonlinear", 5), ("nonlinear", 13), ("nonlinear", 15), ("nonlinear", 33),
                                               ("asymmetric", 0), ("asymmetric", 33)) for noise in (0.0, 0.02)]


@pytest.mark.parametrize(("kind", "seed", "noise"), [*QUICK, *(pytest.param(*one, marks=pytest.mark.slow) for one in LONG)])
def test_curves(kind, seed, noise):
    """Seeds 13, 15 and 33 have the corner of a blow-off valve, which a prior of small changes of slope rounds off; of the asymmetric
    seed 33 least squares alone make three bends, 5 % of the peak too high."""
    made, fit = checked(seed, kind, noise)
    assert force_error(fit, made) < 0.03
    if made.damper.k is not None:
        assert stiffness_error(fit, made) < 0.03


@pytest.mark.slow
def test_a_curve_that_the_tests_do_not_tell_is_said():
    """Seed 29: friction, noise correlated over 20 samples; the end of the curve is 5 % off, its interval 7 % wide."""
    made = random_campaign(29, "nonlinear", 0.02)
    fit = identify(cleaned(made), "maxwell_nonlinear")
    assert force_error(fit, made) > 0.03
    assert "damping_curve is known to no better than" in fit.message


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 20])
def test_an_asymmetric_curve_by_the_energy_method(seed):
    """The mean forces come with the curve, and the lag in turns with them; with those of the record it is 1 to 5 ms off."""
    made = random_campaign(seed, "asymmetric", 0.02)
    fit = identify(cleaned(made), "maxwell_nonlinear", "energy")
    assert force_error(fit, made) < 0.08
    assert fit.lag == pytest.approx(made.bench.lag, abs=5e-4)
    assert "take least squares" in fit.message


@pytest.mark.parametrize(("kind", "model"), [("linear", "viscous"), pytest.param("curve", "viscous", marks=pytest.mark.slow),
                                             pytest.param("nonlinear", "maxwell", marks=pytest.mark.slow)])
def test_a_wrong_model_is_named(kind, model):
    made = random_campaign(5, kind, 0.0)
    assert "wrong model" in identify(cleaned(made), model).message


def without(record, at, number):
    return {key: np.delete(value, slice(at, at + number)) if isinstance(value, np.ndarray) else value for key, value in record.items()}


@pytest.mark.parametrize(("change", "words"), [
    (lambda r: {**r, "force": 1e3 * r["force"]}, "1000"),
    (lambda r: {**r, "displacement": 1e-3 * r["displacement"]}, "1000"),
    (lambda r: {**r, "force": np.minimum(r["force"], np.median(r["force"]) + 0.35 * np.ptp(r["force"]))}, "clipped"),
    (lambda r: {**r, "force": r["displacement"], "displacement": r["force"]}, "swapped"),
    (lambda r: without(r, r["time"].size // 2, r["time"].size // 20), "gap"),
    (lambda r: {**r, "force": -r["force"]}, "other sign"),
    (lambda r: without(r, 0, int(0.8 * r["time"].size)), "cycles"),
])
def test_a_bad_record_among_good_ones_is_named(change, words):
    made = random_campaign(4, "linear", 0.02, velocity=False)
    records = [*made.records[:5], change(made.records[5]), *made.records[6:]]
    with pytest.raises(RecordError) as raised:
        clean_all(read_records(records, units=made.units))
    assert words in str(raised.value) and repr(made.records[5]["name"]) in str(raised.value)


def test_clipping_under_noise_warns():
    made = random_campaign(4, "linear", 0.0, velocity=False)
    record = made.records[5]
    middle, half = np.median(record["force"]), 0.5 * np.ptp(record["force"])
    force = np.clip(record["force"], middle - 0.6 * half, middle + 0.6 * half) + 1e-3 * half * np.random.default_rng(1).standard_normal(record["force"].size)
    with pytest.warns(UserWarning, match="clipped, or a blow-off valve"):
        clean_all(read_records([*made.records[:5], {**record, "force": force}, *made.records[6:]], units=made.units))


def draws(tests, c, k, number, colour):
    """Intervals of ``number`` draws of 2 % noise in both channels over one noise-free campaign; hits of c, k and the lag."""
    base, hits = campaign(ClosedDamper(c, k), tests, Bench(lag=0.003, steady=True)), np.zeros(3)
    for seed in range(number):
        bench, random = Bench(noise=0.02, colour=colour), np.random.default_rng(seed)
        records = [{**one, **{key: one[key] + _noise(random, one[key], bench, one["time"]) for key in ("displacement", "force")}} for one in base.records]
        fit = identify(clean_all(read_records(records)), "maxwell", damping="constant")
        for i, (name, value) in enumerate((("damping", c), ("series_stiffness", k), ("lag", 0.003))):
            low, high = fit.confidence[name]
            hits[i] += low <= value <= high
    return hits / number


WIDE = [(f, a) for f in (0.5, 1.0, 2.0, 3.0) for a in (0.5e-3, 2e-3)]
LOW = [(f, a) for f in (0.25, 0.5, 1.0) for a in (0.5e-3, 1e-3, 2e-3)]


@pytest.mark.slow
@pytest.mark.parametrize(("tests", "c", "k", "colour", "least"), [(WIDE, 4e5, 5e6, 0.0, 0.895), (WIDE, 4e5, 5e6, 0.95, 0.87),
                                                                  (LOW, 1e5, 1e7, 0.0, 0.895), (LOW, 1e5, 1e7, 0.95, 0.82)])
def test_intervals_cover_the_truth(tests, c, k, colour, least):
    """95 % intervals, 200 draws: a binomial deviation of 1.5 to 2.4 %. Of strongly coloured noise they are somewhat too narrow."""
    hits = draws(tests, c, k, 200, colour)
    assert (hits > least).all() and (hits < 0.995).all(), hits


def test_what_the_tests_do_not_tell_is_said():
    """Below 1 Hz a damper of 1e5 N s/m and 1e7 N/m is all but viscous: the interval is wide, and the message says so."""
    base = campaign(ClosedDamper(1e5, 1e7), LOW, Bench(lag=0.003, steady=True, noise=0.02))
    fit = identify(clean_all(read_records(base.records)), "maxwell", damping="constant")
    low, high = fit.confidence["series_stiffness"]
    assert low < 1e7 < high and high / low > 1.1
    assert "hardly told apart" in fit.message
