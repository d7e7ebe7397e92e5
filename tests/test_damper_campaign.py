# SPDX-License-Identifier: BSD-3-Clause
"""Random campaigns of the second generator: closed-form curves, start transients, lag of either sign, coloured noise, jitter, drift."""

import warnings

import numpy as np
import pytest

from railsym.dampers import RecordError, clean_all, identify, read_records
from railsym.dampers.models import curve_value
from tests.oracles.bench_campaign import Bench, ClosedDamper, _noise, campaign, random_campaign

MODEL = {"viscous": "viscous", "viscous curve": "viscous", "linear": "maxwell", "curve": "maxwell"}


def cleaned(made):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return clean_all(read_records(made.records, units=made.units))


def force_error(fit, made):
    """Largest error of the damper's curve over the speeds that it had, of its peak."""
    record, speed = fit.model.force_law_record(), np.linspace(*made.fastest, 401)
    curve = record.get("damping_curve")
    force = record["damping"] * speed + (0.0 if curve is None else curve_value(curve, speed))
    wanted = made.damper.force(speed)
    return np.abs(force - wanted).max() / np.abs(wanted).max()


def stiffness_error(fit, made):
    record, speed = fit.model.force_law_record(), np.linspace(0.0, made.ends, 101)
    curve = record.get("stiffness_curve")
    found = record["stiffness"] + (0.0 if curve is None else curve_value(curve, speed))
    return np.abs(found / made.damper.stiffness(speed) - 1.0).max()


def checked(seed, kind, noise, method="least_squares"):
    made = random_campaign(seed, kind, noise)
    fit = identify(cleaned(made), MODEL.get(kind, "maxwell_nonlinear"), method)
    assert "wrong model" not in fit.message
    return made, fit


@pytest.mark.parametrize("method", ["energy", "least_squares"])
@pytest.mark.parametrize("noise", [0.0, 0.02])
@pytest.mark.parametrize("seed", range(3))
def test_constants(seed, noise, method):
    made, fit = checked(seed, "linear", noise, method)
    limit = 0.05 if noise else 0.01
    assert (fit.damping, fit.series_stiffness) == pytest.approx((made.damper.c, made.damper.k), rel=limit)
    assert fit.lag == pytest.approx(made.bench.lag, abs=3e-4)


@pytest.mark.parametrize(("kind", "seed"), [("viscous curve", 1), ("curve", 1), ("curve", 3), ("nonlinear", 2), ("nonlinear", 5), ("asymmetric", 0)])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_curves(kind, seed, noise):
    made, fit = checked(seed, kind, noise)
    assert force_error(fit, made) < 0.03
    if made.damper.k is not None:
        assert stiffness_error(fit, made) < 0.03
    assert fit.seconds < 20.0                                            # 0.1 to 0.6 s on a quiet machine


@pytest.mark.parametrize(("kind", "model"), [("linear", "viscous"), ("curve", "viscous"), ("nonlinear", "maxwell")])
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
@pytest.mark.parametrize(("tests", "c", "k"), [(WIDE, 4e5, 5e6), (LOW, 1e5, 1e7)])
def test_intervals_cover_the_truth(tests, c, k):
    """95 % intervals, 200 draws: a binomial deviation of 1.5 %."""
    hits = draws(tests, c, k, 200, 0.0)
    assert (hits > 0.895).all() and (hits < 0.995).all(), hits


def test_what_the_tests_do_not_tell_is_said():
    """Below 1 Hz a damper of 1e5 N s/m and 1e7 N/m is all but viscous: the interval is wide, and the message says so."""
    base = campaign(ClosedDamper(1e5, 1e7), LOW, Bench(lag=0.003, steady=True, noise=0.02))
    fit = identify(clean_all(read_records(base.records)), "maxwell", damping="constant")
    low, high = fit.confidence["series_stiffness"]
    assert low < 1e7 < high and high / low > 1.1
    assert "hardly told apart" in fit.message
