# SPDX-License-Identifier: BSD-3-Clause
"""Optimisation against known optima: the closed form of a wheelset on two springs, and fronts of test functions.

At a fixed hunting frequency w the critical speed of the closed form is lowest where both motions have one natural frequency,
k1 = m w^2, k2 = I w^2, and is w sqrt(b0 r0/lam) there (equation 4 of tests/oracles/wheelset_closed_form.py).
"""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from oracles.schaffer import Schaffer, schaffer
from oracles.wheelset_closed_form import Wheelset

import railsym as rs
from railsym.optimise import Constraint, Objective, OptimisationError, Problem, Robust, Variable, optimise, pareto_front
from railsym.optimise.speeds import SpeedDesign

EQUAL = Wheelset(mass=1250.0, yaw_inertia=820.0, wheel_radius=0.46, contact_half_spacing=0.75, conicity=0.2, lateral_stiffness=3e5,
                 yaw_stiffness=2.5e5, f11=10e6, f22=6e6)
FREQUENCY = 2.5      # Hz
BEST = {"lateral": 1250.0 * (2 * pi * FREQUENCY)**2, "yaw": 820.0 * (2 * pi * FREQUENCY)**2}
BEST_SPEED = 2 * pi * FREQUENCY * sqrt(0.75 * 0.46 / 0.2)
SPRINGS = [Variable("lateral", 1e5, 1e6, "N/m", start=6e5), Variable("yaw", 1e5, 6e5, "N*m/rad", start=1.5e5)]


class ClosedForm:
    """Critical speed and frequency of the closed form; gradients by complex step would need complex square roots, so central differences."""

    def __call__(self, x):
        speed, omega = replace(EQUAL, lateral_stiffness=x[0], yaw_stiffness=x[1]).critical_speed()
        return {"speed": speed, "frequency": omega / (2 * pi)}

    def with_gradient(self, x):
        rows = [(self(x * (1 + step)), self(x * (1 - step))) for step in 1e-5 * np.eye(2)]
        slope = {name: [(a[name] - b[name]) / (2e-5 * v) for (a, b), v in zip(rows, x)] for name in ("speed", "frequency")}
        return self(x), slope


class WithoutGradient:
    def __call__(self, x):
        return ClosedForm()(x)


def wheelset_problem(evaluate, **options):
    return Problem(SPRINGS, evaluate, [Objective("speed", "minimise", "m/s")], [Constraint("frequency", low=FREQUENCY, unit="Hz")], **options)


@pytest.mark.parametrize("method,near,evaluate", [("gradient", 1e-4, ClosedForm()), ("simplex", 1e-2, WithoutGradient()), ("global", 2e-2, WithoutGradient())])
def test_known_optimum_of_the_closed_form(method, near, evaluate):
    """The speed is flat at the optimum: it comes out to the square of what the springs do."""
    found = optimise(wheelset_problem(evaluate), method=method, tolerance=1e-9)
    assert found.outputs["speed"] == pytest.approx(BEST_SPEED, rel=max(near**2 * 10, 1e-6)) and found.violation <= 1e-6
    assert found.values == pytest.approx(BEST, rel=near * 5)
    assert found.converged or method == "global"
    assert found.failed == 0 and "lateral" in str(found)


def test_known_optimum_of_the_vehicle():
    """The same through file, Kane's equations and eigenvalues, with the analytic gradients of speed and frequency.

    The vehicle has spin creep and a roll on contact springs: its optimum is that of the closed form with spin, found on a fine
    grid along the frequency's line, within the 2e-3 of tests/test_wheelset_hunting.py.
    """
    vehicle = rs.load_vehicle("wheelset")
    contact = rs.LinearContact(conicity=0.2, roll_parameter=0.0, contact_angle_parameter=0.0, amplitude=0.0)
    evaluate = SpeedDesign(vehicle, ("guide.stiffness.0", "guide.stiffness.1"), contact=contact, speed_range=(1.0, 200.0))
    springs = [Variable("guide.stiffness.0", 5e4, 3e5, "N/m", start=8e4), Variable("guide.stiffness.1", 5e4, 5e5, "N/m", start=3e5)]
    found = optimise(Problem(springs, evaluate, [Objective("speed", "minimise", "m/s")], [Constraint("frequency_hz", low=FREQUENCY)]))

    from railsym.linear import rolling_vehicle

    wheels = rolling_vehicle(vehicle).contacts(contact.resolved(vehicle.contact))
    closed = Wheelset(1250.0, 820.0, 0.46, 0.75, 0.2, 0.0, 0.0, wheels.f11[0], wheels.f22[0], wheels.f23[0], wheels.f33[0])
    lateral = np.linspace(0.5, 1.5, 2001) * BEST["lateral"]
    c1, c2 = 2 * closed.f22, 2 * closed.f11 * 0.75**2 + 2 * closed.f33
    h, d = 2 * closed.f11 * 0.75 * 0.2 / 0.46, 2 * closed.f23
    yaw = ((1250.0 * c2 + 820.0 * c1) * (2 * pi * FREQUENCY)**2 - c2 * lateral + d * h) / c1      # equation (2)
    speeds = np.array([replace(closed, lateral_stiffness=a, yaw_stiffness=b).critical_speed()[0] for a, b in zip(lateral, yaw)])
    assert found.converged and found.outputs["speed"] == pytest.approx(speeds.min(), rel=2e-3)
    assert found.outputs["frequency_hz"] == pytest.approx(FREQUENCY, rel=1e-5)
    k = speeds.argmin()
    # flat: 2 % of a spring move the speed by some 1e-4
    assert 2 * found.values["guide.stiffness.1"] == pytest.approx(lateral[k], rel=0.02)
    assert 2 * found.values["guide.stiffness.0"] == pytest.approx(yaw[k], rel=0.02)
    assert found.computed < 60


def test_the_worst_of_two_outputs():
    """Highest low of x and 1 - x: both 1/2, a kink on which the bare minimum has no gradient."""
    class Both:
        def __call__(self, x):
            return {"a": x[0], "b": 1.0 - x[0]}

        def with_gradient(self, x):
            return self(x), {"a": [1.0], "b": [-1.0]}

    found = optimise(Problem([Variable("x", 0.0, 1.0, start=0.1)], Both(), [Objective(("a", "b"), "maximise")]))
    assert found.values["x"] == pytest.approx(0.5, abs=1e-6) and found.objective == pytest.approx(0.5, abs=1e-6)


def test_failing_cases_do_not_end_a_local_method():
    """No result beyond 0.6, where the slope points; the best case is found in front of it."""
    class Cliff:
        def __call__(self, x):
            if x[0] > 0.6:
                raise rs.RailsymError("nothing here")
            return {"y": x[0]}

        def with_gradient(self, x):
            return self(x), {"y": [1.0]}

    found = optimise(Problem([Variable("x", 0.0, 1.0, start=0.1)], Cliff(), [Objective("y", "maximise")]))
    assert 0.59 < found.values["x"] <= 0.6 and found.failed > 0
    found = optimise(Problem([Variable("x", 0.0, 1.0, start=0.1)], Cliff(), [Objective("y", "maximise")]), method="global")
    assert 0.59 < found.values["x"] <= 0.6 and found.failed > 0


def test_front_of_schaffers_function():
    found = pareto_front(schaffer(Schaffer()), population=20, generations=20)
    # the best of 400 cases: nearly on the front, on which sqrt(f1) + sqrt(f2) = 2, and without large holes
    assert (found.values >= -0.02).all() and (found.values <= 2.02).all() and len(found) > 40
    assert np.sqrt(found.objectives).sum(axis=1) == pytest.approx(2.0, abs=0.05)
    assert np.diff(np.sort(found.values[:, 0])).max() < 0.25 and np.ptp(found.values) > 1.9
    assert (np.diff(found.hypervolume) >= -1e-12).all() and found.evaluations == 401


def test_front_keeps_constraints_and_survives_failures():
    problem = schaffer(Schaffer(hole=(0.5, 1.0)), constraints=[Constraint("f1", high=2.25)])
    found = pareto_front(problem, population=20, generations=12)
    x = found.values[:, 0]
    assert found.failed > 0 and (x <= 1.5).all() and not ((x > 0.5) & (x < 1.0)).any() and (x < 0.5).any() and (x > 1.0).any()
    assert all("no result in the hole" in case.error for case in found.cases if case.failed)


def test_robust_statistics_of_a_linear_result():
    """y = 2 x a + b with a ratio of 5 % and b normal: mean and deviation in closed form."""
    from scipy import stats

    robust = Robust(lambda v: {"y": 2.0 * v[0] + v[1]}, ("x", "b"), ("x",), {"x": stats.norm(1.0, 0.05), "b": stats.norm(1.0, 0.3)},
                    ("y.mean", "y.std", "y.p5", "y.mean-2std"), samples=1024)
    found = robust([3.0])
    deviation = sqrt((6.0 * 0.05)**2 + 0.3**2)
    # a scrambled Sobol sequence of 1024 points
    assert found["y.mean"] == pytest.approx(7.0, abs=2e-3) and found["y.std"] == pytest.approx(deviation, rel=5e-3)
    assert found["y.p5"] == pytest.approx(7.0 - 1.645 * deviation, abs=0.02)
    assert found["y.mean-2std"] == pytest.approx(found["y.mean"] - 2 * found["y.std"], rel=1e-12)
    assert robust([3.0]) == found


def test_robust_optimum_stands_off_the_cliff():
    """y = x up to 1 and falls steeply beyond: nominally best at 1; with 5 % scatter of x the low percentile is best below."""
    from scipy import stats

    fall = lambda v: {"y": float(v[0] if v[0] < 1.0 else 1.0 - 20.0 * (v[0] - 1.0))}      # noqa: E731
    variable = [Variable("x", 0.5, 1.5, start=0.7)]
    nominal = optimise(Problem(variable, fall, [Objective("y", "maximise")]), method="global")
    robust = Robust(fall, ("x",), ("x",), {"x": stats.norm(1.0, 0.05)}, ("y.p5",), samples=256)
    found = optimise(Problem(variable, robust, [Objective("y.p5", "maximise")]), method="global")
    assert nominal.values["x"] == pytest.approx(1.0, abs=1e-3)
    # y's 5 % lie below x (1 - 1.64 x 0.05) on one side only where no scatter reaches 1: between 1/(1 + 1.64 x 0.05) and 1/(1 + 3.5 x 0.05)
    assert 1 / 1.175 < found.values["x"] < 1 / 1.08
    assert found.objective > robust([nominal.values["x"]])["y.p5"] + 0.3


def test_robust_designs_say_what_fails():
    from scipy import stats

    def half(v):
        if v[0] > 1.0:
            raise rs.RailsymError("stable")
        return {"y": v[0]}

    arguments = ("x",), ("x",), {"x": stats.norm(1.0, 0.05)}, ("y.mean",), 16
    with pytest.raises(OptimisationError, match="8 of 16 cases of the design fail"):
        Robust(half, *arguments)([1.0])
    assert Robust(half, *arguments, lost=0.6)([1.0])["failing_cases"] == 8.0
    with pytest.raises(OptimisationError, match="OUTPUT.p5"):
        Robust(half, ("x",), ("x",), {"x": stats.norm(1.0, 0.05)}, ("y.median",))
    with pytest.raises(OptimisationError, match="neither chosen nor"):
        Robust(half, ("x", "z"), ("x",), {"x": stats.norm(1.0, 0.05)}, ("y.mean",))


@pytest.mark.parametrize("make,text", [
    (lambda: Variable("x", 1.0, 1.0, "N/m"), "ascending"),
    (lambda: Variable("x", 0.0, 1.0, scale="log"), "above 0"),
    (lambda: Variable("x", 0.0, 1.0, start=2.0), "outside its bounds"),
    (lambda: Objective("y", "max"), "maximise and minimise"),
    (lambda: Constraint("y"), "low or a high"),
    (lambda: Problem([Variable("x", 0, 1), Variable("x", 0, 1)], Schaffer(), [Objective("f1", "minimise")]), "named twice"),
    (lambda: optimise(schaffer(Schaffer())), "2 objectives"),
    (lambda: pareto_front(wheelset_problem(ClosedForm())), "1 objective"),
    (lambda: pareto_front(schaffer(Schaffer()), population=5), "even population"),
    (lambda: optimise(wheelset_problem(WithoutGradient()), method="gradient"), "without gradients"),
    (lambda: optimise(wheelset_problem(ClosedForm()), method="newton"), "there are gradient, simplex, global"),
    (lambda: optimise(Problem([Variable("x", 0, 1)], Schaffer(), [Objective("f3", "minimise")])), "no output 'f3'"),
    (lambda: pareto_front(schaffer(Schaffer(hole=(-11, 11))), population=4, generations=1), "all 5 cases failed"),
])
def test_what_cannot_be_done_is_said(make, text):
    with pytest.raises(OptimisationError, match=text):
        make()


# --- workers and studies -------------------------------------------------------------------------------------------

def test_the_message_names_why_an_output_is_missing():
    problem = Problem([Variable("x", 0, 1)], Schaffer(), [Objective("comfort", "minimise")])
    with pytest.raises(OptimisationError, match="'comfort' is nan .ending derailed"):
        problem.checked({"comfort": np.nan, "ending": "derailed"})
    assert problem.checked({"comfort": 1.0, "other": np.nan, "ending": "completed"}) == {"comfort": 1.0}


def test_designs_from_a_study_are_its_cases():
    """The same vehicle by the optimiser's door, with and without gradients, and by `railsym.critical_speed`."""
    from railsym.optimise.design import AnalysisDesign, design_of
    from railsym.sweep import CriticalSpeed, LatinHypercube, Study, Uniform

    study = Study("bogie", CriticalSpeed(), {"contact.conicity": Uniform(0.1, 0.3)}, LatinHypercube(2), set={"primary.stiffness.1": 3e6})
    names, x = ("anti_yaw_damper.damping", "contact.conicity"), [5e5, 0.25]
    vehicle = rs.load_vehicle("bogie").replace({"primary.stiffness.1": 3e6, "anti_yaw_damper.damping": 5e5})
    speed = float(rs.critical_speed(vehicle, 0.25).speed)
    first = design_of(study, names)
    assert isinstance(first, SpeedDesign) and first(x)["speed"] == pytest.approx(speed, rel=1e-9)
    second = AnalysisDesign(study.base(), study.settings, names, {"a.": CriticalSpeed()})
    assert second(x)["a.speed"] == pytest.approx(speed, rel=1e-9) and second(x)["beyond_range"] == 0.0
    # a range that ends below the critical speed: at least its upper end, and said so
    short = design_of(study, names, {"low": CriticalSpeed(speed_range=(5.0, 0.5 * speed))})(x)
    assert short["low.speed"] == 0.5 * speed and short["beyond_range"] == 1.0
    with pytest.raises(OptimisationError, match="unstable at .* already"):
        design_of(study, names, {"": CriticalSpeed(speed_range=(1.2 * speed, 2.0 * speed))})(x)
    with pytest.raises(OptimisationError, match="anti_yaw_damper.damping"):
        design_of(study, ("anti_yaw_damper.dampin",))
