# SPDX-License-Identifier: BSD-3-Clause
"""Optimisations: how the objective went, and fronts of several objectives."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREEN, GREY, PALE, VERMILION, new_axes, tidy
from railsym.plots.units import labelled, shown


def plot_optimisation(result, *, axes=None):
    """Objective of every case in order, and the best so far.

    Parameters
    ----------
    result : railsym.optimise.Optimum
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(6.4, 3.8))[0, 0]
    problem, objective = result.problem, result.problem.objectives[0]
    factor, _ = shown(objective.unit)
    good = [(k, c) for k, c in enumerate(result.cases, 1) if not c.failed]
    place = np.array([k for k, _ in good])
    value = factor * np.array([objective.value(c.outputs) for _, c in good])
    kept = np.array([problem.violation(c.outputs) <= 1e-6 for _, c in good])
    axes.plot(place[kept], value[kept], "o", color=BLUE, markersize=3.5, linestyle="none", label="cases")
    if not kept.all():
        axes.plot(place[~kept], value[~kept], "x", color=GREY, markersize=5, linestyle="none", label="a constraint is broken")
    if kept.any():
        best = (np.maximum if objective.sense == "maximise" else np.minimum).accumulate(np.where(kept, value, objective.sign * np.inf))
        axes.step(place, np.where(np.isfinite(best), best, np.nan), where="post", color=GREEN, linewidth=1.4, label="best so far")
    lost = [k for k, c in enumerate(result.cases, 1) if c.failed]
    for k in lost:
        axes.axvline(k, color=VERMILION, linewidth=0.8, alpha=0.6, label="failed" if k == lost[0] else None)
    tidy(axes, "case", labelled(objective.name, objective.unit), f"{objective.sense}: {factor * result.objective:.5g}, {result.method}")
    axes.legend(fontsize=8, frameon=False)
    return axes


def plot_pareto(result, *, axes=None):
    """Front of two objectives, or of every pair with the first where there are more; cases off the front pale.

    Parameters
    ----------
    result : railsym.optimise.ParetoFront
    axes : matplotlib Axes or array of them, optional
        One for each objective after the first.

    Returns
    -------
    matplotlib Axes, or ndarray of Axes, shape (m - 1,)
    """
    problem, count = result.problem, len(result.problem.objectives) - 1
    panels = new_axes(axes, 1, count, size=(0.6 + 5.4 * count, 4.2))[0]
    good = [c for c in result.cases if not c.failed and problem.violation(c.outputs) <= 0.0]
    cloud = np.array([[o.value(c.outputs) for o in problem.objectives] for c in good])
    first = problem.objectives[0]
    x = shown(first.unit)[0]
    for panel, k in zip(panels, range(1, count + 1)):
        other = problem.objectives[k]
        y = shown(other.unit)[0]
        panel.plot(x * cloud[:, 0], y * cloud[:, k], ".", color=PALE, markersize=5, linestyle="none", label=f"{len(good)} cases")
        drawn = np.column_stack([x * result.objectives[:, 0], y * result.objectives[:, k]])
        if count == 1:
            panel.plot(*drawn.T, color=BLUE, linewidth=0.9)
        panel.plot(*drawn.T, "o", color=BLUE, markersize=4.5, linestyle="none", label=f"front, {len(result)} cases")
        for row in dict.fromkeys((0, len(drawn) - 1)):
            panel.annotate(f"case {result.numbers[row]}", drawn[row], (5, 5), textcoords="offset points", fontsize=7.5, color=BLACK)
        tidy(panel, labelled(f"{first.name} ({first.sense})", first.unit), labelled(f"{other.name} ({other.sense})", other.unit))
        panel.margins(0.08)
        panel.legend(fontsize=8, frameon=False)
    return panels if count > 1 else panels[0]
