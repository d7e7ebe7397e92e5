# SPDX-License-Identifier: BSD-3-Clause
"""Uncertainty: intervals, Sobol indices and first-order reliability against closed forms."""

from math import pi, sqrt

import numpy as np
import pytest
from oracles.ishigami import FIRST, INTERACTION, TOTAL, Ishigami, ishigami
from scipy import stats

import railsym as rs
from railsym.errors import ConvergenceError
from railsym.uncertainty import (Sobol, SpeedModel, Tolerances, UncertaintyError, form, probability_below, saltelli, sobol_indices,
                                 tornado)


def linear(*gradient, offset=0.0):
    """A model that is linear in its parameters."""
    gradient = np.array(gradient, float)
    return lambda x: (float(gradient @ x) + offset, gradient)


# --- probability ---------------------------------------------------------------------------------------------------

def test_intervals_are_those_of_clopper_pearson_and_wilson():
    found = probability_below(np.arange(40.0), 6.5, confidence=0.95)
    assert (found.below, found.cases, found.value) == (7, 40, 7 / 40)
    # Clopper and Pearson (1934) by quantiles of the beta distribution; Wilson (1927) by his formula
    assert found.exact == pytest.approx((stats.beta.ppf(0.025, 7, 34), stats.beta.ppf(0.975, 8, 33)), rel=1e-9)
    z, p, n = stats.norm.ppf(0.975), 7 / 40, 40
    middle, half = (p + z * z / (2 * n)) / (1 + z * z / n), z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    assert found.wilson == pytest.approx((middle - half, middle + half), rel=1e-9)


def test_nothing_below_still_has_an_upper_bound():
    """The rule of three: 1 - 0.025^(1/n)."""
    found = probability_below(np.full(100, 2.0), 1.0)
    assert found.value == 0.0 and found.exact == pytest.approx((0.0, 1 - 0.025**0.01), rel=1e-9)


def test_cases_without_a_value_count_as_what_is_known_of_them():
    values = [1.0, 2.0, 3.0, np.nan, np.nan]
    found = probability_below(values, 1.5, above=[False, False, False, True, False])
    assert (found.below, found.cases, found.unknown) == (1, 4, 1)
    assert found.bounds[0] < found.exact[0] and found.bounds[1] > found.exact[1]
    assert "1 failed" in str(found)
    # what has a value is not overruled
    assert probability_below([1.0, 2.0], 1.5, above=[True, True]).below == 1


def test_what_cannot_be_counted_is_refused():
    with pytest.raises(UncertaintyError, match="none of the 1 cases"):
        probability_below([np.nan], 1.0)
    with pytest.raises(UncertaintyError, match="finite limit"):
        probability_below([1.0], np.inf)
    with pytest.raises(UncertaintyError, match="2 truth values"):
        probability_below([1.0, 2.0], 1.0, above=[True])


# --- Sobol indices -------------------------------------------------------------------------------------------------

def ishigami_of(unit):
    return np.array([ishigami(*row) for row in pi * (2.0 * unit - 1.0)])


def test_indices_of_the_ishigami_function_through_the_study(tmp_path):
    """Saltelli's cases as the plan of a study, its store, SALib's estimators: against the closed form."""
    from railsym.sweep import Study, Table, Uniform

    unit = saltelli(3, 1024, second_order=True, seed=3)
    study = Study("wheelset", Ishigami(), {name: Uniform(-pi, pi) for name in ("x1", "x2", "x3")}, Table(unit, scale="unit_cube"))
    found = sobol_indices(study.names, study.run(tmp_path / "s.nc")["y"], second_order=True)
    # the estimator of first order spreads by some 0.02 with 1024 base points, that of the total by less; intervals cover it
    assert found.first == pytest.approx(FIRST, abs=0.05) and found.total == pytest.approx(TOTAL, abs=0.03)
    assert (abs(found.first - FIRST) <= found.first_half).all() and (abs(found.total - TOTAL) <= found.total_half).all()
    assert found.second[0, 2] == pytest.approx(INTERACTION, abs=0.06) and abs(found.second[0, 1]) < 0.06
    assert (found.base, found.dropped, found.cases) == (1024, 0, 1024 * 8)


def test_indices_of_the_g_function():
    """Sobol 1993: V_i = 1/(3 (1 + a_i)^2), total by products."""
    a = np.array([0.0, 1.0, 4.5, 9.0])
    unit = saltelli(4, 1024, seed=5)
    found = sobol_indices("pqrs", np.prod((abs(4 * unit - 2) + a) / (1 + a), axis=1))
    part = 1 / (3 * (1 + a)**2)
    variance = np.prod(1 + part) - 1
    assert found.first == pytest.approx(part / variance, abs=0.02)
    assert found.total == pytest.approx(part * np.prod(1 + part) / (1 + part) / variance, abs=0.02)


def test_swapped_columns_are_seen():
    """The comparison above can fail: with two parameters exchanged it does."""
    found = sobol_indices(["a", "b", "c"], ishigami_of(saltelli(3, 256)[:, [1, 0, 2]]))
    assert found.first[0] != pytest.approx(FIRST[0], abs=0.05)


def test_failing_cases_take_their_base_point_along():
    values = ishigami_of(saltelli(3, 512))
    values[7] = np.nan
    found = sobol_indices(["a", "b", "c"], values)
    assert (found.base, found.dropped) == (511, 1) and "1 base points left out" in found.message
    assert found.first == pytest.approx(FIRST, abs=0.05)
    assert isinstance(found, Sobol) and np.array_equal(found.first_half, sobol_indices(["a", "b", "c"], values).first_half)


def test_samples_that_do_not_fit_are_refused():
    with pytest.raises(UncertaintyError, match="power of two"):
        saltelli(3, 100)
    with pytest.raises(UncertaintyError, match="multiple of 5"):
        sobol_indices("abc", np.zeros(11))
    with pytest.raises(UncertaintyError, match="without variance"):
        sobol_indices("abc", np.full(40, 3.0))
    with pytest.raises(UncertaintyError, match="nothing is left"):
        sobol_indices("abc", np.full(40, np.nan))


# --- first-order reliability ---------------------------------------------------------------------------------------

def test_a_plane_in_normal_variables_is_exact():
    """beta = (mean - limit)/deviation."""
    found = form(linear(3.0, -2.0, offset=10.0), {"a": stats.norm(4.0, 0.5), "b": stats.norm(1.0, 2.0)}, limit=12.0)
    beta = (3 * 4 - 2 * 1 + 10 - 12) / sqrt(1.5**2 + 4.0**2)
    assert found.beta == pytest.approx(beta, rel=1e-7) and found.probability == pytest.approx(stats.norm.cdf(-beta), rel=1e-6)
    assert found.mean_value_probability == pytest.approx(found.probability, rel=1e-6)
    assert found.importance == pytest.approx([1.5**2 / 18.25, 16 / 18.25], rel=1e-6)
    assert linear(3.0, -2.0, offset=10.0)(found.design_point)[0] == pytest.approx(12.0, abs=1e-6)


def test_lognormal_resistance_and_load():
    """ln R - ln S is normal, and R = S the same surface: first order is exact there, and the gradient at the medians alone is not."""
    model = lambda x: (x[0] - x[1], np.array([1.0, -1.0]))      # noqa: E731
    found = form(model, {"R": stats.lognorm(0.2, scale=3.0), "S": stats.lognorm(0.4, scale=1.0)}, limit=0.0)
    exact = stats.norm.cdf(-np.log(3.0) / sqrt(0.2**2 + 0.4**2))
    assert found.probability == pytest.approx(exact, rel=1e-4)
    assert found.mean_value_probability != pytest.approx(exact, rel=0.1)


def test_a_limit_above_the_median_gives_a_negative_index():
    found = form(linear(1.0), {"a": stats.norm(0.0, 1.0)}, limit=1.0)
    assert found.beta == pytest.approx(-1.0) and found.probability == pytest.approx(stats.norm.cdf(1.0), rel=1e-6)


def test_curved_surface_converges_to_the_nearest_point():
    """g = a^2 + b - 3 - 5/2 (a curve with the nearest point off the axis): the design point by minimisation."""
    model = lambda x: (-(x[0]**2) - x[1] + 4.0, np.array([-2.0 * x[0], -1.0]))      # noqa: E731
    found = form(model, {"a": stats.norm(0.3, 1.0), "b": stats.norm(0.0, 1.0)}, limit=0.0)
    a = np.linspace(-4, 4, 800001)
    nearest = np.sqrt(((a - 0.3)**2 + (4.0 - a * a)**2).min())
    assert found.beta == pytest.approx(nearest, rel=1e-3)


def test_limits_out_of_reach_and_dead_parameters_are_named():
    with pytest.raises(ConvergenceError, match="7 standard deviations"):
        form(linear(1.0), {"a": stats.norm(0.0, 1.0)}, limit=-20.0)
    with pytest.raises(UncertaintyError, match="no tolerance moves it"):
        form(linear(0.0), {"a": stats.norm(0.0, 1.0)}, limit=-1.0)
    with pytest.raises(UncertaintyError, match="no distribution"):
        form(linear(1.0), {"a": 3.0}, limit=-1.0)


def test_deviations_of_distributions():
    given = Tolerances({"n": stats.norm(2.0, 0.3), "u": stats.uniform(1.0, 2.0), "l": stats.lognorm(0.3)})
    # 64 points of Gauss-Hermite; the uniform's x(u) = Phi(u) is no polynomial
    assert given.deviation() == pytest.approx([0.3, 2 / sqrt(12), stats.lognorm(0.3).std()], rel=1e-5)


# --- the critical speed --------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def bogie():
    vehicle = rs.load_vehicle("bogie")
    return SpeedModel(vehicle, ["conicity", "primary.stiffness.0", "primary.stiffness.1"], conicity=0.2)


def test_gradient_of_the_critical_speed(bogie):
    x = bogie.present()
    speed, gradient = bogie(x)
    assert speed == pytest.approx(float(rs.critical_speed(bogie.vehicle, 0.2).speed), rel=1e-12)
    for k in range(len(x)):
        step = np.zeros(len(x))
        step[k] = 1e-4 * x[k]
        # central difference: 1e-8 of truncation, and crossings are solved to 1e-10 of the speed
        assert gradient[k] == pytest.approx((bogie.value(x + step) - bogie.value(x - step)) / (2 * step[k]), rel=1e-4)


def test_tornado_of_small_tolerances_is_what_is_computed_anew(bogie):
    x = bogie.present()
    tolerances = {name: stats.norm(value, 0.01 * value) for name, value in zip(bogie.names, x)}
    found = tornado(bogie, tolerances, check=True)
    # 2 % of a parameter: second order is some 1e-2 of the change; changes below 1e-4 m/s are left out
    assert np.abs(found.change_low - found.computed_low).max() < 0.04 * np.abs(found.change_low).max()
    assert list(np.abs(found.change_high)) == sorted(np.abs(found.change_high), reverse=True)
    assert found.deviation == pytest.approx(np.linalg.norm(bogie(x)[1] * 0.01 * x), rel=1e-6) and found.share.sum() == pytest.approx(1.0)
    assert found.unit == "m/s" and "conicity" in str(found)


def test_form_beside_a_count(bogie):
    """2000 cases of a linear stand-in would prove nothing: the vehicle itself, 150 cases, five binomial deviations."""
    x = bogie.present()
    tolerances = {name: stats.norm(value, 0.05 * value) for name, value in zip(bogie.names, x)}
    nominal = bogie.value(x)
    found = form(bogie, tolerances, limit=0.97 * nominal)
    unit = np.random.default_rng(1).uniform(size=(150, len(x)))
    values = [bogie.value([d.ppf(u) for d, u in zip(tolerances.values(), row)]) for row in unit]
    share = probability_below(values, 0.97 * nominal, confidence=1 - 6e-7)
    assert share.exact[0] < found.probability < share.exact[1]


def test_speed_model_names_what_it_cannot_do(bogie):
    with pytest.raises(rs.RailsymError, match="no_such"):
        SpeedModel(bogie.vehicle, ["no_such.mass"])
    with pytest.raises(rs.RailsymError, match="no critical speed"):
        SpeedModel(bogie.vehicle, ["conicity"], speed_range=(1.0, 2.0)).value([0.2])
