# SPDX-License-Identifier: BSD-3-Clause
"""Cases of an optimisation computed once: from the history where they are there, by an executor where they are not."""

from __future__ import annotations

import hashlib
import pickle
from concurrent.futures import BrokenExecutor, CancelledError, ThreadPoolExecutor, as_completed

import numpy as np

from railsym.optimise.errors import OptimisationError
from railsym.optimise.history import Case, History

_RENEWALS = 2      # pools opened anew for one batch, when a worker is lost
_problems = {}     # what a worker knows, by key


class Evaluations:
    """Evaluates cases of a problem, each once.

    Parameters
    ----------
    problem : Problem
    history : History
    executor : optional
        As `railsym.sweep.run` takes: an open `concurrent.futures.Executor`, a Dask client, or a pool of `railsym.sweep`. One after another in this
        process when not given.
    follow : callable, optional
        Called with each case that was computed.
    """

    def __init__(self, problem, history: History, executor=None, follow=None):
        self.problem, self.history, self.follow = problem, history, follow
        self.executor = executor.get_executor() if hasattr(executor, "get_executor") else executor
        self.computed, self._asked, self._ranks = 0, {}, {}
        self._carried = None

    @property
    def order(self):
        """Cases in the order in which this run asked for them."""
        return list(self._asked.values())

    def many(self, points, gradient=False):
        """Cases at several values (SI), in their order."""
        keys = [tuple(map(float, point)) for point in points]
        for key in keys:
            self._ranks.setdefault(key, len(self._ranks) + 1)
        missing = [key for key in dict.fromkeys(keys) if self.history.find(key, gradient) is None]
        numbers = {key: self.history.number(key, self._ranks[key]) for key in missing}
        for key, found in self._run(missing, gradient):
            case = Case(numbers[key], key, *found)
            self.history.add(case)
            self.computed += 1
            if self.follow is not None:
                self.follow(case)
        cases = [self.history.find(key, gradient) for key in keys]
        self._asked.update(zip(keys, cases))
        return cases

    def one(self, point, gradient=False):
        """The case at these values."""
        return self.many([point], gradient)[0]

    def _run(self, keys, gradient):
        """Values and results, as they come."""
        if self.executor is None or not keys:
            for key in keys:
                yield key, evaluated(self.problem, key, gradient)
            return
        left = list(keys)
        for _ in range(1 + (_RENEWALS if hasattr(self.executor, "renew") else 0)):
            try:
                for key, found in self._spread(left, gradient):
                    left.remove(key)
                    yield key, found
                return
            except (BrokenExecutor, CancelledError) as error:
                lost = error
                if hasattr(self.executor, "renew"):
                    self.executor.renew()
        raise OptimisationError(f"a worker was lost ({lost}) while {len(left)} cases were under way: out of memory, or killed; what was computed is "
                                "in the history, resume to go on") from lost

    def _spread(self, keys, gradient):
        if isinstance(getattr(self.executor, "executor", self.executor), ThreadPoolExecutor):
            futures = {self.executor.submit(evaluated, self.problem, key, gradient): key for key in keys}
        else:
            name, _ = self._payload()
            futures = {self.executor.submit(evaluated_there, name, None, key, gradient): key for key in keys}
        try:
            strangers = []
            for future in as_completed(futures):
                found = future.result()
                if found is None:
                    strangers.append(futures[future])
                else:
                    yield futures[future], found
            # workers that do not know the problem yet get it with the case
            futures = {self.executor.submit(evaluated_there, *self._payload(), key, gradient): key for key in strangers}
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            for future in futures:
                future.cancel()

    def _payload(self):
        """Key and pickled problem."""
        if self._carried is None:
            try:
                content = pickle.dumps(self.problem)
            except (pickle.PicklingError, AttributeError, TypeError) as error:
                raise OptimisationError(f"evaluate cannot be sent to workers ({error}); define it in a module, or use threads") from None
            self._carried = hashlib.sha256(content).hexdigest(), content
        return self._carried


def evaluated(problem, values, gradient):
    """Outputs, error and gradients of a case: whatever goes wrong becomes the case's error, and the optimisation goes on without it."""
    from railsym.sweep.worker import error_text, one_thread

    try:
        with one_thread():
            if gradient:
                outputs, slopes = problem.evaluate.with_gradient(np.array(values))
                return problem.checked(outputs), "", {name: tuple(map(float, slope)) for name, slope in slopes.items()}
            return problem.checked(problem.evaluate(np.array(values))), "", None
    except Exception as error:
        return None, error_text(error), None


def evaluated_there(key, content, values, gradient):
    """Entry of a worker; None where it does not know the problem and was not given it."""
    if key not in _problems:
        if content is None:
            return None
        _problems.clear()
        _problems[key] = pickle.loads(content)
    return evaluated(_problems[key], values, gradient)
