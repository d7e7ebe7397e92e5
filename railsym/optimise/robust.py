# SPDX-License-Identifier: BSD-3-Clause
"""Robust designs: what a design is worth under tolerances, for optimisations to look at in place of its nominal result.

Each design is computed at the same points of the unit cube (a scrambled Sobol sequence), so that two designs differ by themselves and not by
luck. Outputs get the statistics ``.mean``, ``.std``, ``.p5`` (any percentile), ``.mean-2std`` (any multiple, either sign).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from railsym.errors import RailsymError
from railsym.optimise.errors import OptimisationError
from railsym.uncertainty.tolerances import Tolerances

_STATISTIC = re.compile(r"(?P<output>.+)[.](?:p(?P<percent>\d+(?:[.]\d+)?)|mean(?P<factor>[-+]\d*[.]?\d+)std|(?P<name>mean|std))")


@dataclass(frozen=True, eq=False)
class Robust:
    """Evaluation of designs under tolerances, to be the ``evaluate`` of a `Problem`.

    Parameters
    ----------
    evaluate : callable
        Values of `names` (k,) to a dict of outputs.
    names : tuple of str
        Everything that `evaluate` takes, in its order.
    variables : tuple of str
        Those that are chosen. The design is their middle: a tolerance of theirs is relative to it.
    tolerances : mapping of str to distribution
        By name. Of a variable: of the ratio of the value to the design's, such as ``Normal(1.0, 0.05)``. Of others: of the value itself, SI.
    statistics : tuple of str
        Such as ``("speed.p5", "speed.mean-2std")``.
    samples : int
        Cases a design, a power of two.
    seed : int
    lost : float
        Largest share of cases of a design that may fail before the design counts as failed.
    """

    evaluate: Callable
    names: tuple[str, ...]
    variables: tuple[str, ...]
    tolerances: Mapping
    statistics: tuple[str, ...]
    samples: int = 64
    seed: int = 1
    lost: float = 0.0

    def __post_init__(self):
        Tolerances(self.tolerances)
        missing = [n for n in self.names if n not in self.variables and n not in self.tolerances]
        strange = [n for n in (*self.variables, *self.tolerances) if n not in self.names]
        if missing or strange:
            raise OptimisationError(f"robust design: {missing[0]!r} is neither chosen nor has a tolerance" if missing else
                                    f"robust design: {strange[0]!r} is not among what is computed from: {', '.join(self.names)}")
        if self.samples < 2 or self.samples & (self.samples - 1):
            raise OptimisationError(f"robust design: {self.samples} samples; a power of two from 2 on is needed")
        for statistic in self.statistics:
            _statistic(statistic)

    def points(self, design) -> np.ndarray:
        """Values of `names` at every sample, shape (samples, k)."""
        chosen = dict(zip(self.variables, map(float, design)))
        return np.column_stack([np.broadcast_to(chosen[n] * self._drawn.get(n, 1.0) if n in chosen else self._drawn[n], self.samples) for n in self.names])

    @cached_property
    def _drawn(self):
        """Tolerances at the samples, by name: the same for every design."""
        from railsym.uncertainty.sobol import unit_points

        unit = unit_points(len(self.tolerances), self.samples, self.seed)
        return dict(zip(self.tolerances, Tolerances(self.tolerances).columns(unit).T))

    def __call__(self, design):
        """Statistics of a design.

        Raises
        ------
        OptimisationError
            More failing cases than `lost` permits.
        """
        wanted = dict.fromkeys(_statistic(s)[0] for s in self.statistics)
        rows, errors = [], []
        for point in self.points(design):
            try:
                outputs = self.evaluate(point)
                rows.append([outputs[name] for name in wanted])
            except RailsymError as error:
                errors.append(str(error))
        if len(errors) > self.lost * self.samples:
            raise OptimisationError(f"{len(errors)} of {self.samples} cases of the design fail under the tolerances; the first: {errors[0]}")
        columns = dict(zip(wanted, np.array(rows).T))
        return {s: _statistic(s)[1](columns[_statistic(s)[0]]) for s in self.statistics} | {"failing_cases": float(len(errors))}


def _statistic(text):
    """Output and function of a statistic's name."""
    found = _STATISTIC.fullmatch(text)
    if found is None or (found["percent"] and not 0.0 < float(found["percent"]) < 100.0):
        raise OptimisationError(f"statistic {text!r}: write OUTPUT.mean, OUTPUT.std, OUTPUT.p5 (a percentile above 0 and below 100) or OUTPUT.mean-2std")
    if found["percent"]:
        return found["output"], lambda values: float(np.percentile(values, float(found["percent"])))
    if found["factor"]:
        return found["output"], lambda values: float(np.mean(values) + float(found["factor"]) * np.std(values, ddof=1))
    return found["output"], {"mean": lambda values: float(np.mean(values)), "std": lambda values: float(np.std(values, ddof=1))}[found["name"]]


def output_of(statistic):
    """The output that a statistic is of; None where the text is no statistic."""
    found = _STATISTIC.fullmatch(statistic)
    return found["output"] if found else None
