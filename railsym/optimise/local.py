# SPDX-License-Identifier: BSD-3-Clause
"""Optimisation of one objective with SciPy: SLSQP with analytic gradients, COBYLA without, differential evolution over the whole box.

Where the worst of several outputs counts, the gradient method uses the smooth form of the same problem: maximise t with every output >= t.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.optimise.errors import OptimisationError
from railsym.optimise.evaluation import Evaluations
from railsym.optimise.history import History
from railsym.optimise.result import Optimum

METHODS = ("gradient", "simplex", "global")
_NAMES = {"gradient": "SLSQP with analytic gradients", "simplex": "COBYLA", "global": "differential evolution"}
_KEPT = 1e-6         # relative violation of a constraint that counts as kept: what SLSQP leaves at its own tolerance
_RETRIES = 10        # boxes, each half as far from the best case as the nearest that failed: down to 1e-3 of the range
_AT_BOUND = 1e-6     # of the range


def optimise(problem, *, method: str | None = None, history=None, resume: bool = False, executor=None, seed: int = 1, tolerance: float = 1e-6,
             most: int = 200, population: int = 10, follow=None) -> Optimum:
    """Optimise one objective under bounds and constraints.

    Parameters
    ----------
    problem : Problem
        With one objective.
    method : {"gradient", "simplex", "global"}, optional
        "gradient": SciPy's SLSQP; needs ``problem.evaluate.with_gradient``, and is the default where that is there. "simplex": SciPy's COBYLA,
        local without gradients; the default otherwise. "global": SciPy's differential evolution.
    history : path, optional
        File for every case, as it ends.
    resume : bool
        Go on with an existing history; cases in it are not computed again.
    executor : concurrent.futures.Executor, optional
        Spreads the cases of a generation ("global"); the local methods ask for one case at a time.
    seed : int
        For "global".
    tolerance : float
        Of the variables between their bounds (0..1), and relative of the objective.
    most : int
        Iterations or generations.
    population : int
        Of "global", cases a variable.
    follow : callable, optional
        Called with each case that was computed.

    Returns
    -------
    Optimum
        The best case that keeps all constraints; if none does, the one that breaks them least, and `Optimum.converged` is false.

    Raises
    ------
    OptimisationError
        A problem or method that does not fit, no case with a result, or a history that cannot be used.
    """
    if len(problem.objectives) != 1:
        raise OptimisationError(f"{len(problem.objectives)} objectives: this optimises one; use pareto_front, or make the others constraints")
    with_gradient = callable(getattr(problem.evaluate, "with_gradient", None))
    method = method or ("gradient" if with_gradient else "simplex")
    if method not in METHODS:
        raise OptimisationError(f"method {method!r} is unknown; there are {', '.join(METHODS)}")
    if method == "gradient" and not with_gradient:
        raise OptimisationError(f"method 'gradient': the outputs {', '.join(problem.needed)} come without gradients; use 'simplex' or 'global'")
    with History(problem, history, resume) as kept:
        run = _Run(problem, Evaluations(problem, kept, executor, follow), tolerance, most)
        found = run.everywhere(seed, population) if method == "global" else run.near(_slsqp if method == "gradient" else _cobyla, method)
        kept.sort()
        return found


@dataclass
class _Run:
    problem: object
    evaluations: Evaluations
    tolerance: float
    most: int
    failed: list = field(default_factory=list)

    def __post_init__(self):
        first = [case for case in self.evaluations.history.cases if not case.failed]
        # objectives of about 1: what methods' tolerances are made for
        self.scale = abs(self.problem.objectives[0].value(first[0].outputs)) or 1.0 if first else None

    def case(self, places, gradient):
        """The case at places 0..1.

        Raises
        ------
        _Failed
        """
        found = self.evaluations.one(self.problem.values(np.clip(places, 0.0, 1.0)), gradient)
        if found.failed:
            raise _Failed(places, found.error)
        if self.scale is None:
            self.scale = abs(self.problem.objectives[0].value(found.outputs)) or 1.0
        return found

    def near(self, method, name):
        """A local method from the start, within walls where cases failed: each time a case fails, or the best case comes to a wall, again from
        the best in a box that reaches half way to the nearest case that failed."""
        count = len(self.problem.variables)
        low, high, place = np.zeros(count), np.ones(count), self.problem.start()
        fails = np.full((2, count), np.nan)      # places of the nearest failing cases below and above, by variable
        start = self.evaluations.one(self.problem.values(place), name == "gradient")
        if start.failed:
            raise OptimisationError(f"the start has no result: {start.error}; give other starts")
        for _ in range(_RETRIES):
            failed = False
            try:
                converged, message = method(self, place, low, high)
            except _Failed as failure:
                failed, converged, message = True, False, f"cases fail near the best one: {failure.reason}"
                self._wall(fails, failure.places)
            place = self.problem.places(self.best().values)
            touched = [(fails[0] < place) & (place - low < _AT_BOUND), (fails[1] > place) & (high - place < _AT_BOUND)]
            if not failed and not np.any(touched):
                break
            low, high = np.fmax(0.5 * (fails[0] + place), 0.0), np.fmin(0.5 * (fails[1] + place), 1.0)
        return self.result(_NAMES[name], converged, message, start)

    def _wall(self, fails, places):
        """A wall for the variable in which a failing case lies farthest from the best one."""
        away = places - self.problem.places(self.best().values)
        k = int(np.argmax(np.abs(away)))
        fails[int(away[k] > 0.0), k] = places[k]

    def everywhere(self, seed, population):
        """Differential evolution, a generation at a time."""
        from inspect import signature

        from scipy.optimize import NonlinearConstraint, differential_evolution

        def objective(columns):
            cases = self.evaluations.many([self.problem.values(np.clip(c, 0.0, 1.0)) for c in np.atleast_2d(columns.T)])
            return np.array([np.inf if c.failed else self._signed(c.outputs) for c in cases])

        def broken(columns):
            cases = self.evaluations.many([self.problem.values(np.clip(c, 0.0, 1.0)) for c in np.atleast_2d(columns.T)])
            return np.array([[np.inf if c.failed else self.problem.violation(c.outputs) for c in cases]])

        start = self.evaluations.one(self.problem.values(self.problem.start()))
        word = "rng" if "rng" in signature(differential_evolution).parameters else "seed"
        options = {"constraints": NonlinearConstraint(broken, -np.inf, 0.0)} if self.problem.constraints else {}
        found = differential_evolution(objective, [(0.0, 1.0)] * len(self.problem.variables), init="sobol", popsize=population, maxiter=self.most,
                                       tol=max(self.tolerance, 1e-4), polish=False, vectorized=True, updating="deferred",
                                       **{word: np.random.default_rng(seed)}, **options)
        message = f"{found.nit} generations, " + ("converged" if found.success else "stopped there: more may find more")
        return self.result(_NAMES["global"], bool(found.success), message, start)

    def _signed(self, outputs):
        objective = self.problem.objectives[0]
        return objective.sign * objective.value(outputs)

    def best(self):
        """The best of the cases asked for: least violation first."""
        good = [case for case in self.evaluations.order if not case.failed]
        if not good:
            first = self.evaluations.order[0].error if self.evaluations.order else "nothing was computed"
            raise OptimisationError(f"all {len(self.evaluations.order)} cases failed; the first: {first}")
        return min(good, key=lambda c: (max(self.problem.violation(c.outputs) - _KEPT, 0.0), self._signed(c.outputs), c.number))

    def result(self, method, converged, message, start):
        best, cases = self.best(), self.evaluations.order
        places = self.problem.places(best.values)
        bounds = tuple(n for n, p in zip(self.problem.names, places) if min(p, 1.0 - p) < _AT_BOUND)
        violation = self.problem.violation(best.outputs)
        if violation > _KEPT:
            converged, message = False, f"no case keeps all constraints ({message})"
        return Optimum(self.problem, best.number, dict(zip(self.problem.names, best.values)), best.outputs,
                       self.problem.objectives[0].value(best.outputs), violation, start, bounds, converged, len(cases), self.evaluations.computed, sum(c.failed for c in cases), method, message, tuple(cases))


class _Failed(Exception):
    """A case without result, on the way of a local method."""

    def __init__(self, places, reason):
        super().__init__(reason)
        self.places, self.reason = np.array(places), reason


def _slsqp(run, place, low, high):
    """Variables places (k) and the bound t of the objective's outputs, in units of their scale."""
    from scipy.optimize import minimize

    problem, objective = run.problem, run.problem.objectives[0]
    sign, count = objective.sign, len(problem.variables)

    def rows(z):
        """Constraints >= 0 and their Jacobian in z = (places, t): sign output <= t, and the bounds on outputs."""
        case = run.case(z[:count], True)
        slope = np.array([v.slope(x) for v, x in zip(problem.variables, case.values)])
        value, jacobian = [], []
        for name in objective.outputs:
            value.append(z[count] - sign * case.outputs[name] / run.scale)
            jacobian.append([*(-sign * np.array(case.gradient[name]) * slope / run.scale), 1.0])
        for constraint in problem.constraints:
            g = np.array(case.gradient[constraint.output]) * slope
            for bound, side in ((constraint.low, 1.0), (constraint.high, -1.0)):
                if bound is not None:
                    value.append(side * (case.outputs[constraint.output] - bound) / (abs(bound) or 1.0))
                    jacobian.append([*(side * g / (abs(bound) or 1.0)), 0.0])
        return np.array(value), np.array(jacobian)

    bounds, options = [*zip(low, high)], {"maxiter": run.most, "ftol": run.tolerance}
    if len(objective.outputs) == 1:      # smooth as it is
        name, = objective.outputs

        def value(places):
            case = run.case(places, True)
            slope = np.array([v.slope(x) for v, x in zip(problem.variables, case.values)])
            return sign * case.outputs[name] / run.scale, sign * np.array(case.gradient[name]) * slope / run.scale

        def kept(places):
            return tuple(part[:, :count] if part.ndim == 2 else part for part in (r[1:] for r in rows(np.r_[places, 0.0])))

        found = minimize(value, place, jac=True, method="SLSQP", bounds=bounds, options=options,
                         constraints={"type": "ineq", "fun": lambda p: kept(p)[0], "jac": lambda p: kept(p)[1]} if problem.constraints else ())
    else:
        t = sign * objective.value(run.case(place, True).outputs) / run.scale
        unit = np.r_[np.zeros(count), 1.0]
        found = minimize(lambda z: z[count], np.r_[place, t], jac=lambda z: unit, method="SLSQP", bounds=[*bounds, (None, None)], options=options,
                         constraints={"type": "ineq", "fun": lambda z: rows(z)[0], "jac": lambda z: rows(z)[1]})
    return bool(found.success), f"{found.message}, {found.nit} iterations"


def _cobyla(run, place, low, high):
    """The objective as it is; constraints as violations."""
    from scipy.optimize import minimize

    problem = run.problem

    def kept(places):
        outputs = run.case(places, False).outputs
        return np.array([-v for c in problem.constraints for v in c.violations(outputs)])

    rooms = [{"type": "ineq", "fun": lambda p: p - low}, {"type": "ineq", "fun": lambda p: high - p}]
    rooms += [{"type": "ineq", "fun": kept}] if problem.constraints else []
    found = minimize(lambda p: run._signed(run.case(p, False).outputs) / run.scale, place, method="COBYLA", constraints=rooms,
                     options={"maxiter": run.most, "rhobeg": 0.15, "tol": max(run.tolerance, 1e-8)})
    return bool(found.success), str(found.message)
