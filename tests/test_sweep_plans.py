# SPDX-License-Identifier: BSD-3-Clause
"""Factors against SciPy's distributions, plans against what defines them."""

import itertools

import numpy as np
import pytest
from scipy import stats

import railsym as rs
from benchmarks.measure import cost_of_code
from railsym import sweep

U = np.linspace(0.001, 0.999, 41)
THREE = {"contact.conicity": sweep.Grid(0.1, 0.4, 4), "contact.friction": sweep.Uniform(0.2, 0.4), "wheelset.mass": sweep.Normal(1200, 50)}


def study(plan, factors=THREE, **options):
    return rs.Study("wheelset", sweep.CriticalSpeed(conicity=0.15), factors, plan, **{"seed": 3} | options)


@pytest.mark.parametrize("factor, reference", [
    (sweep.Uniform(2, 5), stats.uniform(2, 3)),
    (sweep.Triangular(1, 2, 6), stats.triang(0.2, 1, 5)),
    (sweep.Triangular(1, 1, 6), stats.triang(0.0, 1, 5)),
    (sweep.Normal(10, 2), stats.norm(10, 2)),
    (sweep.Normal(10, 2, low=9, high=15), stats.truncnorm(-0.5, 2.5, 10, 2)),
    (sweep.LogNormal(3, 0.2), stats.lognorm(0.2, scale=3)),
])
def test_quantiles_are_scipys(factor, reference):
    np.testing.assert_allclose(factor.quantile(U), reference.ppf(U), rtol=1e-12)


def test_a_truncated_lognormal_keeps_to_its_bounds():
    values = sweep.LogNormal(3, 0.2, low=2.8, high=3.5).quantile(np.linspace(0, 1 - 1e-16, 1001))
    assert values.min() >= 2.8 * (1 - 1e-12) and values.max() <= 3.5 * (1 + 1e-12)
    assert stats.lognorm(0.2, scale=3).cdf(values[500]) == pytest.approx(0.5 * sum(stats.lognorm(0.2, scale=3).cdf([2.8, 3.5])), rel=1e-10)


def test_the_ends_of_a_distribution_are_finite():
    assert np.isfinite(sweep.Normal(0, 1).quantile(np.array([0.0, 1.0 - 2.0**-53]))).all()


def test_grids_and_lists():
    np.testing.assert_allclose(sweep.Grid(1, 100, 3, spacing="log").levels(0), [1, 10, 100], rtol=1e-14)
    assert sweep.List([3.0, 1.0]).quantile(np.array([0.0, 0.49, 0.5, 1.0])).tolist() == [3.0, 3.0, 1.0, 1.0]


@pytest.mark.parametrize("make, words", [
    (lambda: sweep.Uniform(2, 2), "low must lie below high"), (lambda: sweep.Uniform(2, np.nan), "finite number"),
    (lambda: sweep.Normal(1, 0), "std must be above 0"), (lambda: sweep.Normal(1, 1, low=2), "both sides of the middle"),
    (lambda: sweep.Triangular(1, 7, 6), "low <= mode <= high"), (lambda: sweep.LogNormal(-1, 1), "above 0"),
    (lambda: sweep.Grid(0, 1, 0), "points"), (lambda: sweep.Grid(0, 1, 5, spacing="log"), "needs 0 < low"),
    (lambda: sweep.List([]), "at least one"), (lambda: sweep.List([1, "a"]), "only"), (lambda: sweep.List([1, 1]), "twice"),
    (lambda: sweep.LatinHypercube(0), "whole number from 1"), (lambda: sweep.Sobol(2.5), "whole number"), (lambda: sweep.Table([[np.nan]]), "finite"),
    (lambda: sweep.Table([[1.5]], scale="unit_cube"), "from 0 to 1"), (lambda: sweep.Table([[1.5]], scale="dB"), "scale 'dB'"),
])
def test_what_makes_no_factor_or_plan(make, words):
    with pytest.raises(sweep.SweepError, match=words):
        make()


def test_full_grid_is_every_combination():
    levels = [np.linspace(0.1, 0.4, 4), 0.2 + 0.2 * np.linspace(0.05, 0.95, 3), stats.norm(1200, 50).ppf(np.linspace(0.05, 0.95, 3))]
    np.testing.assert_allclose(study(sweep.FullGrid(levels=3)).rows(), list(itertools.product(*levels)), rtol=1e-12)


def test_one_at_a_time_moves_one_factor_from_the_vehicle_as_it_is():
    one = study(sweep.OneAtATime(levels=3), set={"contact.friction": 0.35})
    rows = one.rows()
    own = [0.15, 0.35, one.loaded.parameters["wheelset.mass"].value]
    assert rows[0].tolist() == own and len(rows) == 1 + 4 + 3 + 3
    assert (np.count_nonzero(rows[1:] != own, axis=1) <= 1).all()
    np.testing.assert_allclose(rows[5:8, 1], [0.21, 0.3, 0.39], rtol=1e-15)


def test_latin_hypercube_has_one_value_in_every_part():
    rows = study(sweep.LatinHypercube(200)).rows()
    parts = np.column_stack([(rows[:, 1] - 0.2) / 0.2, stats.norm(1200, 50).cdf(rows[:, 2])]) * 200
    for column in parts.T:
        assert sorted(np.floor(column).astype(int)) == list(range(200))
    assert np.unique(rows[:, 0], return_counts=True)[1].tolist() == [50] * 4
    assert abs(np.corrcoef(parts.T)[0, 1]) < 4 / np.sqrt(200)        # independent columns: four standard deviations


def test_another_factor_leaves_the_sample_of_the_others():
    more = study(sweep.LatinHypercube(50), THREE | {"contact.kalker_weight": sweep.Uniform(0.5, 1.0)}).rows()
    assert (more[:, :3] == study(sweep.LatinHypercube(50)).rows()).all()


def test_sobol_without_scrambling_is_the_sequence():
    rows = study(sweep.Sobol(8, scramble=False), {"contact.friction": sweep.Uniform(0, 1), "contact.kalker_weight": sweep.Uniform(0, 1)}).rows()
    assert rows.tolist() == [[0, 0], [0.5, 0.5], [0.75, 0.25], [0.25, 0.75], [0.375, 0.375], [0.875, 0.875], [0.625, 0.125], [0.125, 0.625]]


def test_scrambled_sobol_is_balanced():
    rows = study(sweep.Sobol(64), {"contact.friction": sweep.Uniform(0, 1), "contact.kalker_weight": sweep.Uniform(0, 1)}).rows()
    boxes = np.floor(8 * rows).astype(int) @ [8, 1]
    assert sorted(boxes) == list(range(64))               # a (0, 6, 2)-net: every box of 1/8 x 1/8 holds one point


@pytest.mark.parametrize("plan", [sweep.FullGrid(levels=7), sweep.OneAtATime(levels=60), sweep.LatinHypercube(150), sweep.Sobol(150)])
def test_blocks_are_pieces_of_the_whole(plan, monkeypatch):
    whole = study(plan).rows()
    monkeypatch.setattr("railsym.sweep.study._BLOCK", 64)
    assert (study(plan).rows() == whole).all()
    assert (study(plan).rows(70, 75) == whole[70:75]).all()
    assert (whole == study(plan).rows()).all() and len(whole) == study(plan).size


def test_seeds_tell_samples_apart():
    for plan in (sweep.LatinHypercube(20), sweep.Sobol(16)):
        assert not (study(plan, seed=4).rows()[:, 1] == study(plan).rows()[:, 1]).any()


def test_tables_in_units_in_si_and_in_the_unit_cube():
    factors = {"wheelset.mass": sweep.Uniform(1.0, 2.0, unit="t"), "contact.conicity": sweep.Grid(0.1, 0.4, 4)}
    assert study([[1.5, 0.33]], factors).rows().tolist() == [[1500.0, 0.33]]
    assert study(sweep.Table([[1500.0, 0.33]], scale="si"), factors).rows().tolist() == [[1500.0, 0.33]]
    np.testing.assert_allclose(study(sweep.Table([[0.5, 0.9]], scale="unit_cube"), factors).rows(), [[1500.0, 0.4]], rtol=1e-15)
    assert study([[1.5, 0.33]], factors).hash == study(sweep.Table([[1500.0, 0.33]], scale="si"), factors).hash
    with pytest.raises(sweep.SweepError, match="3 columns for 2 factors: wheelset.mass, contact.conicity"):
        study([[1, 2, 3]], factors)


_MILLION = """
import railsym as rs
from railsym import sweep
from railsym.sweep.dispatch import _Feed
import numpy as np
factors = {f"truss_axlebox_bushing.stiffness.{k}": sweep.Normal(100, 5, unit="%") for k in range(3)}
factors |= {f"anti_yaw_damper.{name}": sweep.Uniform(90, 110, unit="%") for name in ("damping", "series_stiffness")}
factors |= {f"contact.{name}": sweep.Uniform(0.2, 0.4) for name in ("conicity", "friction", "kalker_weight")}
factors |= {f"car.inertia.{k}": sweep.Normal(100, 5, unit="%") for k in range(3)} | {"car.mass": sweep.Normal(100, 5, unit="%")}
study = rs.Study("pendolino", sweep.CriticalSpeed(), factors, sweep.PLAN(1_000_000), configuration="AS_K", seed=1)
feed, total, cases = _Feed(study, np.arange(study.size)), 0.0, 0
while feed.left:
    numbers, rows = feed.take(4096)
    cases, total = cases + len(numbers), total + rows[:, -1].sum()
assert cases == 1_000_000 and abs(total / cases / study.space.nominal[-1] - 1) < 1e-4, total / cases
"""


@pytest.mark.parametrize("plan", ["LatinHypercube", pytest.param("Sobol", marks=pytest.mark.slow)])
def test_a_plan_of_a_million_cases_stays_under_500_MB(plan):
    assert cost_of_code(_MILLION.replace("PLAN", plan))[1] < 500.0
