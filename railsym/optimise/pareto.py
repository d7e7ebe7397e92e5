# SPDX-License-Identifier: BSD-3-Clause
"""Several objectives at once: NSGA-II of pymoo (Deb et al., IEEE Transactions on Evolutionary Computation 6, 2002)."""

from __future__ import annotations

import numpy as np

from railsym.optimise.errors import OptimisationError
from railsym.optimise.evaluation import Evaluations
from railsym.optimise.history import History
from railsym.optimise.result import ParetoFront

_FAILED = 1e6      # violation of a case without result: it loses against every case with one


def pareto_front(problem, *, population: int = 40, generations: int = 25, history=None, resume: bool = False, executor=None, seed: int = 1,
                 follow=None) -> ParetoFront:
    """Cases that no other beats in all objectives, by NSGA-II.

    Parameters
    ----------
    problem : Problem
        With two objectives or more.
    population, generations : int
        Cases a generation (even), and generations with the first.
    history : path, optional
        File for every case, as it ends.
    resume : bool
        Go on with an existing history: the same seed asks for the same cases, and those in the history are not computed again. More generations than
        before go on from where it ended.
    executor : concurrent.futures.Executor, optional
        Spreads the cases of a generation.
    seed : int
    follow : callable, optional
        Called with each case that was computed.

    Returns
    -------
    ParetoFront
        From all cases that were asked for, the start of the variables among them, not from the last generation alone.

    Raises
    ------
    OptimisationError
        Fewer than two objectives, a population that cannot be used, no case with a result, or a history that cannot be used.
    """
    if len(problem.objectives) < 2:
        raise OptimisationError(f"{len(problem.objectives)} objective: a Pareto front needs two or more; use optimise")
    if population < 4 or population % 2 or generations < 1:
        raise OptimisationError(f"population {population}, generations {generations}: an even population from 4 on and at least one generation are needed")
    algorithm = _nsga2(problem, population, generations, seed)
    fronts = []
    with History(problem, history, resume) as kept:
        evaluations = Evaluations(problem, kept, executor, follow)
        start = evaluations.one(problem.values(problem.start()))
        while algorithm.has_next():
            asked = algorithm.ask()
            cases = evaluations.many([problem.values(place) for place in asked.get("X")])
            _tell(algorithm, asked, problem, cases)
            fronts.append(_best(problem, evaluations.order))
        kept.sort()
        return _result(problem, evaluations, fronts, start)


def _nsga2(problem, population, generations, seed):
    from railsym.uncertainty.packages import needed

    method, base = needed("pymoo.algorithms.moo.nsga2", "Pareto fronts"), needed("pymoo.core.problem", "Pareto fronts")
    # one constraint more: whether there is a result
    space = base.Problem(n_var=len(problem.variables), n_obj=len(problem.objectives), n_ieq_constr=1 + _rows(problem), xl=0.0, xu=1.0)
    algorithm = method.NSGA2(pop_size=population)
    algorithm.setup(space, termination=("n_gen", generations), seed=seed, verbose=False)
    return algorithm


def _rows(problem):
    return sum((c.low is not None) + (c.high is not None) for c in problem.constraints)


def _tell(algorithm, asked, problem, cases):
    """Give pymoo the results; a case without one is infeasible, and its objectives are then never looked at."""
    from pymoo.core.evaluator import Evaluator
    from pymoo.problems.static import StaticProblem

    count, rows = len(problem.objectives), _rows(problem)
    values = np.array([[np.inf] * count if c.failed else [o.sign * o.value(c.outputs) for o in problem.objectives] for c in cases])
    broken = np.array([[_FAILED] * (1 + rows) if c.failed else [0.0, *(v for k in problem.constraints for v in k.violations(c.outputs))] for c in cases])
    Evaluator().eval(StaticProblem(algorithm.problem, F=values, G=broken), asked)
    algorithm.tell(infills=asked)


def _best(problem, cases):
    """Cases of the front, the best by the first objective first."""
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

    good = [c for c in cases if not c.failed and problem.violation(c.outputs) <= 0.0]
    if not good:
        return []
    values = np.array([[o.sign * o.value(c.outputs) for o in problem.objectives] for c in good])
    _, first = np.unique(values, axis=0, return_index=True)      # of equal cases the first
    keep = first[NonDominatedSorting().do(values[first], only_non_dominated_front=True)]
    return [good[k] for k in sorted(keep, key=lambda k: (*values[k], good[k].number))]


def _result(problem, evaluations, fronts, start):
    cases, front = evaluations.order, fronts[-1]
    failed = [c for c in cases if c.failed]
    if len(failed) == len(cases):
        raise OptimisationError(f"all {len(cases)} cases failed; the first: {cases[0].error}")
    if not front:
        raise OptimisationError(f"none of the {len(cases)} cases keeps all constraints: {', '.join(map(str, problem.constraints))}; widen bounds or constraints")
    text = f"{len(front)} cases on the front of {len(cases)}, {len(fronts)} generations; {evaluations.computed} computed now, {len(failed)} failed"
    return ParetoFront(problem, start, np.array([c.values for c in front]), np.array([[o.value(c.outputs) for o in problem.objectives] for c in front]),
                       tuple(c.outputs for c in front), tuple(c.number for c in front), tuple(cases), len(fronts), len(cases), evaluations.computed,
                       len(failed), _hypervolumes(problem, fronts), text)


def _hypervolumes(problem, fronts):
    """Of each generation's front, in the box of all objectives on these fronts."""
    from pymoo.indicators.hv import HV

    values = [np.array([[o.sign * o.value(c.outputs) for o in problem.objectives] for c in front]) for front in fronts if front]
    low, high = np.min(np.vstack(values), axis=0), np.max(np.vstack(values), axis=0)
    span = np.where(high > low, high - low, 1.0)
    measure = HV(ref_point=np.full(len(problem.objectives), 1.1))
    return np.array([0.0] * (len(fronts) - len(values)) + [float(measure((v - low) / span)) for v in values])
