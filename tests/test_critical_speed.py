# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds against closed forms, dense eigenvalues and bisection."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.synthetic_models import Train, Wheelset, coasting, dense_eigenvalues, reentrant

from railsym.contact import LinearContact
from railsym.critical_speed import critical_speed, damping_ratio_of
from railsym.errors import ConvergenceError, ModelError
from railsym.linear import linear_model
from railsym.polish import polish_crossing, polish_eigenvalue
from railsym.reduction import reduce_model
from railsym.speed_scan import scan_speeds
from railsym.stability import is_dissipative, stability
from railsym.stability_map import parameter_map, stability_map
from railsym.symmetry import split
from railsym.vehicle import load_vehicle
from railsym.verification import verify_stability

RANGE = (5.0, 250.0)
TRAINS = {
    "nominal": Train(),
    "no yaw dampers": Train(yaw_dampers=(False,) * 4),
    "one absent": Train(yaw_dampers=(True, True, True, False)),
    "viscous": Train(viscous=True),
    "low conicity": Train(conicity=0.05),
}


def excess(value, ratio):
    return value.real + ratio * np.abs(value)


def dense_crossing(model, near, ratio, omega):
    """Bisection on the dense eigenvalue nearest omega, independent of every step of the search."""
    from scipy.optimize import brentq

    def distance(speed):
        value = dense_eigenvalues(model, speed)
        ray = omega * (-ratio + 1j * np.sqrt(1 - ratio**2))
        return excess(value[np.abs(value - ray).argmin()], ratio)

    return brentq(distance, 0.999 * near, 1.001 * near, rtol=1e-13)


# --- closed forms -----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("conicity", [0.02, 0.1, 0.3])
def test_wheelset_on_springs(conicity):
    """Two degrees of freedom: Hurwitz gives the speed in closed form."""
    wheelset = Wheelset(conicity=conicity)
    found, = stability(wheelset.model(), speed_range=(1.0, 400.0))
    # both sides are a dozen operations on numbers without cancellation
    assert found.speed == pytest.approx(wheelset.critical_speed(), rel=1e-12)
    assert found.label == "wheelset hunting"


def test_unstable_stable_and_unstable_again():
    model, expected = reentrant()
    found, = stability(model)
    assert [(c.speed, 2 * np.pi * c.frequency_hz, c.direction) for c in found.crossings] == [
        (pytest.approx(v, rel=1e-10), pytest.approx(omega, rel=1e-10), direction) for v, omega, direction in expected]
    assert found.speed == found.crossings[0].speed
    assert found.message.count("unstable at") == 2 and "stable at 55 m/s" in found.message


def test_narrow_instability_is_not_stepped_over():
    """Unstable from 60 to 61 m/s only, less than a tenth of a step of the scan."""
    model, _ = reentrant()
    low, high = 60.0, 61.0
    slope = 0.05
    one = replace(model, mass=np.diag([1.0, 1.0]), stiffness=np.diag([81.0, 900.0]),
                  damping_constant=np.diag([-slope * (low + high), 4.0]), damping_speed=np.diag([slope, 0.0]),
                  damping_inverse_speed=np.diag([slope * low * high, 0.0]))
    found, = stability(one)
    assert [(c.speed, c.direction) for c in found.crossings] == [(pytest.approx(60.0, rel=1e-10), 1), (pytest.approx(61.0, rel=1e-10), -1)]


def test_modes_that_turn_unstable_later_are_listed_on_request():
    train = Train().model()
    few, = stability(train)
    many, = stability(train, all_modes=True)
    assert [c.direction for c in few.crossings] == [1]
    assert len(many.crossings) == 4 and many.speed == pytest.approx(few.speed, rel=1e-12)
    assert np.all(np.diff([c.speed for c in many.crossings]) > 0)


@pytest.mark.parametrize("step", [0.5, 0.9, 2.0])
def test_like_modes_of_two_bogies_are_told_apart(step, monkeypatch):
    """The bogies' modes lie 0.3 to 1 % apart and mix: however coarse the scan, each crossing is found once."""
    train = Train(conicity=0.25)
    expected = [c.speed for c in stability(train.model(), all_modes=True)[0].crossings]
    monkeypatch.setattr("railsym.stability.FIRST_STEP", step)
    found, = stability(train.model(), all_modes=True)
    assert [c.speed for c in found.crossings] == pytest.approx(expected, rel=1e-9) and len(expected) == 4
    alone, = stability(train.model())
    assert alone.speed == pytest.approx(min(expected), rel=1e-9)


def test_newton_can_be_kept_from_a_crossing_that_is_taken():
    scan = scan_speeds(split(Train().model())[0].model, (0.0,), (40.0, 60.0), 25.0)
    leading, trailing = scan.crossings
    points = [scan.polish(leading), scan.polish(trailing)]
    assert 1e-3 < abs(points[1].speed / points[0].speed - 1) < 1e-2
    other = scan.polish(leading, [points[0]])
    assert other is not None and other.speed == pytest.approx(points[1].speed, rel=1e-9)
    assert scan.polish(leading, points) is None and "was not found" in scan.warnings[-1]


# --- dense eigenvalues ------------------------------------------------------------------------------------------

@pytest.mark.parametrize("name", TRAINS)
def test_crossings_are_those_of_the_dense_eigenvalues(name):
    model = TRAINS[name].model()
    for result in stability(model, (0.0, 0.05)):
        assert result.speed is not None
        for crossing in result.crossings:
            dense = dense_crossing(model, crossing.speed, result.damping_ratio, abs(crossing.eigenvalue))
            # the order asked for is 1e-6; bisection on QZ eigenvalues of this pencil is good to about 1e-8
            assert crossing.speed == pytest.approx(dense, rel=1e-7)
            assert crossing.residual < 1e-11


@pytest.mark.parametrize("name", ["nominal", "one absent", "low conicity"])
def test_no_other_instability_between(name):
    model = TRAINS[name].model()
    found, = stability(model)
    checked = verify_stability(model, found, RANGE)
    assert "verified with dense eigenvalues" in checked.message
    for speed in np.geomspace(*RANGE, 14):
        growing = dense_eigenvalues(model, speed)
        # 26 Hz modes of the trusses have no damping at all; the pair of zeros comes as +-1e-7
        growing = growing[(growing.real > 1e-6 * np.abs(growing)) & (np.abs(growing) > 1e-2)]
        unstable = sum(c.direction for c in found.crossings if c.speed < speed) > 0
        assert bool(len(growing)) == unstable, speed


@pytest.mark.parametrize("fault", ["moved", "lost", "added"])
def test_verification_finds_wrong_results(fault):
    model = TRAINS["nominal"].model()
    found, = stability(model)
    crossing = found.crossings[0]
    crossings = {"moved": (replace(crossing, speed=1.001 * crossing.speed),), "lost": (),
                 "added": (crossing, replace(crossing, direction=-1))}[fault]
    with pytest.raises(ConvergenceError):
        verify_stability(model, replace(found, crossings=crossings), RANGE)


def test_symmetry_does_not_change_the_answer():
    """The whole train without its mirror image takes the way of unsymmetric vehicles."""
    model = TRAINS["nominal"].model()
    whole = replace(model, vehicle=None)
    assert [len(split(m)) for m in (model, whole)] == [2, 1]
    for half, full in zip(stability(model, (0.0, 0.05, 0.1)), stability(whole, (0.0, 0.05, 0.1))):
        assert half.speed == pytest.approx(full.speed, rel=1e-9)
        assert half.frequency_hz == pytest.approx(full.frequency_hz, rel=1e-9)


def test_several_criteria_in_one_scan_equal_single_ones():
    model = TRAINS["nominal"].model()
    together = stability(model, (0.0, 0.05, 0.1))
    alone = [stability(model, (ratio,))[0] for ratio in (0.0, 0.05, 0.1)]
    assert [r.speed for r in together] == pytest.approx([r.speed for r in alone], rel=1e-10)
    assert together[0].speed > together[1].speed > together[2].speed
    for result, ratio in zip(together, (0.0, 0.05, 0.1)):
        value = result.crossings[0].eigenvalue
        assert -value.real / abs(value) == pytest.approx(ratio, abs=1e-14)


# --- reduction and Newton's method --------------------------------------------------------------------------------

def test_reduced_model_and_its_correction():
    model = split(TRAINS["nominal"].model())[0].model
    reduction = reduce_model(model, 25.0)
    assert reduction.model.size < 0.4 * model.size
    scan = scan_speeds(model, (0.0,), (20.0, 60.0), 25.0)
    node = scan.node(47.0)
    k = np.flatnonzero((node.eigenvalue.imag < 100.0) & (excess(node.eigenvalue, 0.2) > 0))
    dense = dense_eigenvalues(model, 47.0)
    change, _ = scan.reduction.correction(node.eigenvalue[k], 47.0, node.right(k), node.left(k))
    error = np.array([np.abs(dense - v).min() for v in node.eigenvalue[k]])
    corrected = np.array([np.abs(dense - v).min() for v in node.eigenvalue[k] + change])
    assert (error < 2e-3 * np.abs(node.eigenvalue[k])).all()
    assert corrected.max() < 0.5 * error.max()


@pytest.mark.parametrize("train", [Train(yaw_series=1e7, conicity=0.05), Train(viscous=True), Train()])
def test_static_shapes_make_up_for_modes_left_out(train, monkeypatch):
    """Stiff dampers hold the bogie in shapes that no elastic mode below 25 Hz has: static shapes must be added."""
    model = split(train.model())[0].model
    dense = dense_eigenvalues(model, 60.0)
    watched = dense[(dense.imag > 2.0) & (dense.imag < 65.0) & (excess(dense, 0.2) > 0)]

    def error():
        value = np.linalg.eigvals(reduce_model(model, 12.0).model.state_matrix(60.0))
        return max(np.abs(value - one).min() / abs(one) for one in watched)

    with_shapes = error()
    monkeypatch.setattr("railsym.reduction._ATTACHED", np.inf)
    # 1 % is what Newton's method and the guard of the scan are made for
    assert with_shapes < 0.015 and with_shapes < 0.5 * error()


def test_a_poor_basis_is_noticed_and_enriched(monkeypatch):
    monkeypatch.setattr("railsym.reduction._ATTACHED", np.inf)
    model = split(TRAINS["viscous"].model())[0].model
    poor, good = (scan_speeds(model, (0.0,), RANGE, limit, first_step=0.5) for limit in (6.0, 60.0))
    assert poor.reduction.model.size > reduce_model(model, 6.0).model.size, "nothing was added to the basis"
    speeds = []
    for scan in (poor, good):
        points = []
        for crossing in scan.crossings:
            points.append(scan.polish(crossing, points))      # four modes of like frequency: each its own
        speeds.append(sorted(point.speed for point in points))
    assert len(speeds[0]) == 4 and speeds[0] == pytest.approx(speeds[1], rel=1e-9)


def test_a_scan_that_leaves_something_open_is_repeated_with_a_larger_basis(monkeypatch):
    model, limits = TRAINS["viscous"].model(), []
    expected, = stability(model)

    def open_at_first(part, ratios, speed_range, limit, *more):
        limits.append(limit)
        scan = scan_speeds(part, ratios, speed_range, limit, *more)
        if len(limits) == 1:
            scan.crossings.clear()
            scan.warnings.append("lost")
        return scan

    monkeypatch.setattr("railsym.stability.scan_speeds", open_at_first)
    found, = stability(model)
    assert limits == [25.0, 50.0]
    assert found.speed == pytest.approx(expected.speed, rel=1e-9) and "lost" not in found.message


def test_newton_reaches_rounding_from_a_poor_start():
    model = Wheelset().model()
    speed = Wheelset().critical_speed()
    exact = stability(model)[0].crossings[0]
    rng = np.random.default_rng(0)
    right, left = exact.right + 0.1 * rng.normal(size=(2, 2)) @ [1, 1j] * np.abs(exact.right).max(), exact.left
    point = polish_crossing(model, 1.15 * speed, 0.9 * exact.eigenvalue, right, left)
    assert point.speed == pytest.approx(speed, rel=1e-13) and point.residual < 1e-14
    step = 1e-4
    along = [polish_eigenvalue(model, speed + s, point.eigenvalue, point.right, point.left).eigenvalue for s in (-step, step)]
    # central difference: rounding 1e-15 * 30 / 1e-4
    assert point.slope == pytest.approx((along[1] - along[0]) / (2 * step), rel=1e-7)


def test_newton_fails_aloud():
    model = coasting()
    with pytest.raises(ConvergenceError, match="did not converge"):
        polish_crossing(model, 20.0, 40j, np.ones(5), np.ones(5))


def test_dissipative_models_are_recognised():
    model = coasting()
    assert is_dissipative(model)
    assert not is_dissipative(replace(model, damping_constant=-model.damping_constant))
    assert not is_dissipative(replace(model, damping_inverse_speed=-model.damping_inverse_speed))
    assert not is_dissipative(replace(model, stiffness=-model.stiffness))
    assert not is_dissipative(Wheelset().model())
    assert is_dissipative(split(TRAINS["nominal"].model())[1].model)


# --- what is said when there is no critical speed -------------------------------------------------------------------

def test_none_in_range():
    found, = stability(coasting())
    assert found.speed is None and found.crossings == () and "no mode becomes unstable between 5 and 250 m/s" in found.message
    found, = stability(Wheelset().model(), speed_range=(5.0, 30.0))
    assert found.speed is None


def test_unstable_already_at_the_lowest_speed():
    found, = stability(Wheelset().model(), speed_range=(60.0, 200.0))
    assert found.speed is None and found.unstable_at_start
    assert "wheelset hunting" in found.message and "already unstable at the lowest speed, 60 m/s" in found.message


def test_static_instability_is_named():
    model = Wheelset(lateral_stiffness=-3e7, yaw_stiffness=-3e7, conicity=0.01).model()
    found, = stability(model)
    assert found.speed is None and found.unstable_at_start and "does not oscillate" in found.message


def test_lightly_damped_from_the_start_is_no_crossing_but_a_note():
    """The 12.7 Hz yaw of the bogies lies below 10 % up to 20 m/s; hunting falls below at 39 m/s."""
    found, = stability(TRAINS["nominal"].model(), (0.1,))
    assert found.speed == pytest.approx(39.12, abs=0.05) and found.label.startswith("bogie hunting")
    assert "bogie yaw, both bogies, 12.7 Hz: below 10 % damping up to 19" in found.message


def test_hunting_below_the_damping_ratio_from_the_start_has_no_critical_speed():
    found, = stability(Wheelset().model(), (0.1,), speed_range=(30.0, 100.0))
    assert found.speed is None and "already below 10 % damping at the lowest speed" in found.message


def test_frequency_band_of_the_damping_ratio():
    model = TRAINS["nominal"].model()
    within, = stability(model, (0.05,))
    above, = stability(model, (0.05,), frequency_band=(7.0, 20.0))
    assert within.frequency_hz < 7.0 < above.frequency_hz and above.speed > within.speed


@pytest.mark.parametrize(("options", "says"), [
    ({"speed_range": (0.0, 10.0)}, "speed_range"), ({"speed_range": (20.0, 10.0)}, "speed_range"),
    ({"damping_ratios": (1.5,)}, "5 % is 0.05"), ({"frequency_band": (3.0, 1.0)}, "frequency_band")])
def test_arguments_are_checked(options, says):
    with pytest.raises(ModelError, match=says):
        stability(Wheelset().model(), **options)


# --- vehicles ---------------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def bogie():
    return load_vehicle("bogie")


def test_critical_speed_of_a_vehicle_file(bogie):
    found = critical_speed(bogie, conicity=[0.1, 0.2, 0.3], verify=True)
    assert found.criterion == "real_part" and found.units["speed"] == "m/s"
    assert not found.speed.mask.any() and (np.diff(found.speed) < 0).all()
    for conicity, speed, frequency in zip(found.conicity, found.speed, found.frequency_hz):
        value = dense_eigenvalues(linear_model(bogie, LinearContact(conicity=conicity)), speed)
        assert np.abs(value - 2j * np.pi * frequency).min() < 1e-6 * 2 * np.pi * frequency


def test_masked_never_nan(bogie):
    found = critical_speed(bogie, conicity=[0.2, 0.3], speed_range=(5.0, 10.0))
    assert found.speed.mask.all() and found.frequency_hz.mask.all()
    assert not np.isnan(found.speed.data).any()
    assert all("no mode becomes unstable between 5 and 10 m/s" in text for text in found.message)


def test_shapes_follow_the_conicity(bogie):
    contact = LinearContact(conicity=0.25)
    scalar = critical_speed(bogie, contact=contact)
    assert scalar.speed.shape == () and scalar.conicity == 0.25
    grid = critical_speed(bogie, conicity=[[0.25], [0.2]], contact=contact)
    assert grid.speed.shape == grid.label.shape == (2, 1)
    assert float(grid.speed[0, 0]) == pytest.approx(float(scalar.speed), rel=1e-12)


def test_criterion_by_name_or_by_damping_ratio(bogie):
    assert damping_ratio_of(None) == damping_ratio_of("real_part") == 0.0
    assert damping_ratio_of("damping_ratio") == damping_ratio_of(None, 0.05) == damping_ratio_of(0.05) == 0.05
    with pytest.raises(ModelError, match="takes no damping_ratio"):
        damping_ratio_of("real_part", 0.05)
    with pytest.raises(ModelError, match="'real_part' and 'damping_ratio'"):
        damping_ratio_of("real part")
    by_ratio = critical_speed(bogie, 0.2, damping_ratio=0.05)
    assert by_ratio.criterion == "damping_ratio" and by_ratio.speed < critical_speed(bogie, 0.2).speed


def test_stability_map_equals_single_runs(bogie):
    names = ("with_anti_yaw_dampers", "without_anti_yaw_dampers")
    found = stability_map(bogie, names, conicity=[0.15, 0.3], criteria=("real_part", 0.05))
    assert found.speed.shape == found.frequency_hz.shape == found.change.shape == (2, 2, 2)
    for row, name in zip(found.speed, names):
        for speeds, ratio in zip(row, (None, 0.05)):
            single = critical_speed(bogie.configured(name), [0.15, 0.3], damping_ratio=ratio)
            assert np.ma.allclose(speeds, single.speed, rtol=1e-9) and (speeds.mask == single.speed.mask).all()
    assert np.ma.allclose(found.change[0], 0.0)
    assert np.ma.allclose(found.change[1], 100 * (found.speed[1] / found.speed[0] - 1))
    assert found.of(names[1], 0.05).speed[0] == found.speed[1, 1, 0] and len(found.message) == 8
    with pytest.raises(ModelError, match="without_anti_yaw_dampers"):
        found.of("nominal")


def test_parameter_map_over_two_parameters(bogie):
    name = next(name for name in bogie.parameters.components() if name.endswith(".mass"))
    mass = bogie.parameters[name].value
    found = parameter_map(bogie, {name: [mass, 1.2 * mass], "conicity": [0.1, 0.2, 0.3]})
    assert found.speed.shape == (2, 3) and found.units == ("kg", "-")
    assert float(found.speed[1, 2]) == pytest.approx(float(critical_speed(bogie.replace({name: 1.2 * mass}), 0.3).speed), rel=1e-9)
    with pytest.raises(ModelError, match="one or two"):
        parameter_map(bogie, {})


def test_a_map_takes_a_damping_ratio_alone():
    found = stability_map(load_vehicle("bogie"), conicity=[0.3], criteria=("real_part", 0.05))
    assert found.of(found.configurations[0], damping_ratio=0.05).criterion == found.of(found.configurations[0], 0.05).criterion
    assert found.of(found.configurations[0]).criterion != found.of(found.configurations[0], 0.05).criterion
