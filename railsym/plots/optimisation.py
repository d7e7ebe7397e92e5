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
    """Front of two objectives; a third gives the colour, and with more there is a panel for each after the first.

    Parameters
    ----------
    result : railsym.optimise.ParetoFront
    axes : matplotlib Axes or array of them, optional
        One; with four objectives or more one for each after the first.

    Returns
    -------
    matplotlib Axes, or ndarray of Axes
        Cases off the front pale, the start as a star.
    """
    count = len(result.problem.objectives)
    pairs = [(0, 1)] if count <= 3 else [(0, k) for k in range(1, count)]
    panels = new_axes(axes, 1, len(pairs), size=(1.0 + 5.4 * len(pairs), 4.4))[0]
    for panel, pair in zip(panels, pairs):
        _front(panel, result, pair, 2 if count == 3 else None)
    return panels if len(panels) > 1 else panels[0]


def _front(panel, result, pair, third):
    """One panel: two objectives, and a third as colour."""
    problem = result.problem
    scale = np.array([shown(o.unit)[0] for o in problem.objectives])
    names = [labelled(f"{o.name} ({o.sense})", o.unit) for o in problem.objectives]
    good = [c for c in result.cases if not c.failed and problem.violation(c.outputs) <= 0.0]
    cloud = scale * np.array([[o.value(c.outputs) for o in problem.objectives] for c in good])
    front = scale * result.objectives
    panel.plot(*cloud[:, pair].T, ".", color=PALE, markersize=5, linestyle="none", label=f"{len(good)} cases")
    if third is None:
        if len(problem.objectives) == 2:
            panel.plot(*front[:, pair].T, color=BLUE, linewidth=0.9)
        panel.plot(*front[:, pair].T, "o", color=BLUE, markersize=4.5, linestyle="none", label=f"front, {len(front)} cases")
    else:
        points = panel.scatter(*front[:, pair].T, c=front[:, third], cmap="viridis", s=26, zorder=3, label=f"front, {len(front)} cases")
        panel.figure.colorbar(points, ax=panel, label=names[third])
    if not result.start.failed:
        start = scale * [o.value(result.start.outputs) for o in problem.objectives]
        panel.plot(*start[list(pair)], "*", color=VERMILION, markeredgecolor=BLACK, markersize=13, linestyle="none", zorder=4, label="start")
    for row in dict.fromkeys((0, len(front) - 1)):
        panel.annotate(f"case {result.numbers[row]}", front[row, list(pair)], (5, 5), textcoords="offset points", fontsize=7.5, color=BLACK)
    tidy(panel, names[pair[0]], names[pair[1]])
    panel.margins(0.1)
    panel.legend(fontsize=8, frameon=False)
