# SPDX-License-Identifier: BSD-3-Clause
"""What an optimisation found."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.optimise.history import Case
from railsym.optimise.problem import Problem
from railsym.plots.units import labelled, shown

_ROWS = 12      # of a front that are printed


@dataclass(frozen=True, eq=False)
class Optimum:
    """The best case of an optimisation with one objective.

    Attributes
    ----------
    problem : Problem
    number : int
        Of the case.
    values : dict of str to float
        SI.
    outputs : dict of str to float
    objective : float
        In its unit.
    violation : float
        Largest relative violation of a constraint; 0 where all are kept.
    start : Case or None
        Where a local method began.
    at_bounds : tuple of str
        Variables that ended at a bound.
    converged : bool
        By the method's own judgement.
    evaluations, computed, failed : int
        Cases asked for, computed in this run (others came from the history), failed.
    method, message : str
    cases : tuple of Case
        All of them, in order.
    """

    problem: Problem = field(repr=False)
    number: int
    values: dict[str, float]
    outputs: dict[str, float]
    objective: float
    violation: float
    start: Case | None = field(repr=False)
    at_bounds: tuple[str, ...]
    converged: bool
    evaluations: int
    computed: int
    failed: int
    method: str
    message: str
    cases: tuple[Case, ...] = field(repr=False)

    def __str__(self):
        objective = self.problem.objectives[0]
        factor, unit = shown(objective.unit)
        lines = [f"{objective.sense} {objective.name}: {factor * self.objective:.5g} {unit} (case {self.number}; {self.method}: {self.message})"]
        if self.start is not None and not self.start.failed:
            lines[0] += f"; {factor * objective.value(self.start.outputs):.5g} at the start"
        for variable in self.problem.variables:
            mark = "  at its bound" if variable.name in self.at_bounds else ""
            scale, text = shown(variable.unit)
            lines.append(f"  {variable.name:44} {scale * self.values[variable.name]:10.5g} {text:8} in {scale * variable.low:.5g} to "
                         f"{scale * variable.high:.5g}{mark}")
        lines += [f"  {c}: {self.outputs[c.output]:.6g}{'' if max(c.violations(self.outputs)) <= 1e-6 else '  BROKEN'}" for c in self.problem.constraints]
        if self.outputs.get("beyond_range"):
            lines.append("  stable over the whole range of speeds: the critical speed is at least its upper end")
        return "\n".join([*lines, f"  {self.evaluations} cases, {self.computed} of them computed now, {self.failed} failed"])

    def plot(self, **options):
        """Draw how the objective went; options and axes as `railsym.plots.plot_optimisation`."""
        from railsym.plots import plot_optimisation
        return plot_optimisation(self, **options)


@dataclass(frozen=True, eq=False)
class ParetoFront:
    """Cases that none other beats in all objectives at once.

    Attributes
    ----------
    problem : Problem
    start : Case
        The design that the variables start from: the vehicle as it is, in a study. Not given to the method, but a case like others.
    values : ndarray, shape (n, k)
        SI, sorted by the first objective, its best first.
    objectives : ndarray, shape (n, m)
        In their units.
    outputs : tuple of dict
    numbers : tuple of int
        Numbers of the cases.
    cases : tuple of Case
        All that were asked for, in order.
    generations, evaluations, computed, failed : int
    hypervolume : ndarray, shape (generations,)
        Of the front after each generation, in the unit box of all objectives seen: how it converged.
    message : str
    """

    problem: Problem = field(repr=False)
    start: Case = field(repr=False)
    values: np.ndarray
    objectives: np.ndarray
    outputs: tuple[dict, ...]
    numbers: tuple[int, ...]
    cases: tuple[Case, ...] = field(repr=False)
    generations: int
    evaluations: int
    computed: int
    failed: int
    hypervolume: np.ndarray
    message: str

    def __len__(self):
        return len(self.numbers)

    def __str__(self):
        units = [o.unit for o in self.problem.objectives] + [v.unit for v in self.problem.variables]
        head = [labelled(name, unit) for name, unit in zip([o.name for o in self.problem.objectives] + list(self.problem.names), units)]
        rows = np.hstack([self.objectives, self.values]) * [shown(unit)[0] for unit in units]
        width = [max(12, len(name)) for name in head]
        lines = [self.message, "  ".join(name.rjust(w) for name, w in zip(head, width))]
        shown_rows = np.unique(np.linspace(0, len(rows) - 1, min(_ROWS, len(rows))).astype(int))
        lines += ["  ".join(f"{value:{w}.5g}" for value, w in zip(row, width)) for row in rows[shown_rows]]
        return "\n".join(lines + ([f"{_ROWS} of {len(rows)}, evenly over the first objective"] if len(rows) > _ROWS else []))

    def plot(self, **options):
        """Draw it; options and axes as `railsym.plots.plot_pareto`."""
        from railsym.plots import plot_pareto
        return plot_pareto(self, **options)
