# SPDX-License-Identifier: BSD-3-Clause
"""Cases of an optimisation computed once: from the history where they are there, by an executor where they are not."""

from __future__ import annotations

from concurrent.futures import as_completed
from dataclasses import dataclass
from typing import Any

import numpy as np

from railsym.optimise.errors import OptimisationError
from railsym.optimise.history import Case, History


@dataclass(frozen=True)
class _Job:
    """A case for a worker: an error comes back as text, for the history."""

    problem: Any
    gradient: bool

    def __call__(self, values):
        try:
            if self.gradient:
                outputs, slopes = self.problem.evaluate.with_gradient(np.array(values))
                return self.problem.checked(outputs), {name: tuple(map(float, g)) for name, g in slopes.items()}, ""
            return self.problem.checked(self.problem.evaluate(np.array(values))), None, ""
        except Exception as error:      # whatever it is: recorded, and the optimisation goes on without the case
            return None, None, f"{type(error).__name__}: {error}"


class Evaluations:
    """Evaluates cases of a problem, each once.

    Parameters
    ----------
    problem : Problem
    history : History
    executor : concurrent.futures.Executor, optional
        One after another in this process when not given.
    follow : callable, optional
        Called with each case that was computed.
    """

    def __init__(self, problem, history: History, executor=None, follow=None):
        self.problem, self.history, self.executor, self.follow = problem, history, executor, follow
        self.computed, self._asked, self._next = 0, {}, 1 + max((case.number for case in history.cases), default=0)

    @property
    def order(self):
        """Cases in the order in which this run asked for them."""
        return list(self._asked.values())

    def many(self, points, gradient=False):
        """Cases at several values (SI), in their order."""
        keys = [tuple(map(float, point)) for point in points]
        missing = [key for key in dict.fromkeys(keys) if self.history.find(key, gradient) is None]
        job = _Job(self.problem, gradient)
        numbers = dict(zip(missing, range(self._next, self._next + len(missing))))
        self._next += len(missing)
        for key, found in self._run(job, missing):
            case = Case(numbers[key], key, found[0], found[2], found[1])
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

    def _run(self, job, keys):
        if self.executor is None:
            for key in keys:
                yield key, job(key)
            return
        futures = {self.executor.submit(job, key): key for key in keys}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        except (OSError, RuntimeError) as error:      # BrokenExecutor is a RuntimeError
            raise OptimisationError(f"a worker was lost ({error}); what was computed is in the history, resume to go on") from error
        finally:
            for future in futures:
                future.cancel()
