# SPDX-License-Identifier: BSD-3-Clause
"""Which pictures a campaign has, and what each is drawn from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from railsym import plots
from railsym.plots.units import shown


@dataclass(frozen=True)
class Figure:
    """A picture.

    Attributes
    ----------
    name : str
        For file names.
    title, caption : str
    sources : tuple of str
        Names of the files (`CampaignResults.files`) and "model" for what is computed from the vehicle when the report is made.
    draw : callable
        Gives axes.
    """

    name: str
    title: str
    caption: str
    sources: tuple[str, ...]
    draw: Callable


def figures(found):
    """Pictures of a campaign, the leading one first.

    Parameters
    ----------
    found : CampaignResults

    Returns
    -------
    list of Figure
    """
    made = [*_distribution(found), *_uncertainty(found), *_study(found)]
    for one in found.optimised:
        made += _optimised(found, one)
    return made


def _named(found):
    results = found.results
    return {"output": found.output, "unit": results.unit(found.output)}


def _head(found):
    """Name of the output at the beginning of a sentence."""
    return found.output[:1].upper() + found.output[1:]


def _numeric(results):
    """Columns of factors that are numbers."""
    return [k for k in range(len(results.names)) if results.labels(results.names[k]) is None]


def _distribution(found):
    results, (values, _) = found.results, found.values()
    good = int((~np.isnan(values)).sum())
    plan = results.study.plan.kind
    if good < 2 or plan in ("full_grid", "one_at_a_time"):
        return []
    u = found.uncertainty
    probability, form = (None, None) if u is None else (u.probability, u.form)
    made = [Figure("histogram", f"Distribution of {found.output}", f"{good} cases with a value of {len(values)}"
                   + ("." if probability is None else "; red lies below the limit."), ("study",) + (("model",) if form else ()),
                   lambda: plots.plot_probability(values, probability=probability, form=form, **_named(found)))]
    if probability is not None:
        made.append(Figure("convergence", "How the probability settled", "Share of cases below the limit as they came in, in the order of their numbers.",
                           ("study",), lambda: plots.plot_convergence(values, probability.limit, confidence=probability.confidence,
                                                                      unit=_named(found)["unit"])))
    return made


def _uncertainty(found):
    u, made = found.uncertainty, []
    if u is None:
        return made
    if u.tornado is not None:
        made.append(Figure("tornado", "Tornado: each tolerance alone", "Bars from the analytic gradient at the medians of all factors (one eigenproblem); "
                           "diamonds are computed anew with one factor at its quantile: where they leave the bar's end, the first order does not hold.",
                           ("model",), u.tornado.plot))
    if u.sobol is not None:
        made.append(Figure("sobol", "Sobol indices: shares of the variance", "First order: the factor alone. Total: with all its interactions.", ("sobol",),
                           u.sobol.plot))
    return made


def _study(found):
    results, (values, _) = found.results, found.values()
    columns = _numeric(results)
    names, units = [results.names[k] for k in columns], [results.study.units[k] for k in columns]
    factors = results.factors[:, columns]
    if not columns or np.isnan(values).all():
        return []
    made = []
    varied = [k for k in range(len(columns)) if np.ptp(factors[:, k]) > 0.0]
    if len(columns) == len(results.names) == 2 and len(values) >= 4:
        made.append(Figure("map", f"{_head(found)} over two factors", "Grey: no value there.", ("study",),
                           lambda: plots.plot_study_map(factors, names, values, units=units, **_named(found))))
    if len(varied) > 2 or len(results.names) != 2:
        made.append(Figure("parallel", "Parallel coordinates", "A line a case (at most 400), coloured by the output on the last axis.", ("study",),
                           lambda: plots.plot_parallel(factors, names, values, units=units, **_named(found))))
        made.append(Figure("scatter", f"{_head(found)} against each factor", "With Spearman's rank correlation.", ("study",),
                           lambda: plots.plot_scatter(factors, names, values, units=units, **_named(found))))
    return made


def _optimised(found, one):
    name = one.optimisation.name
    source = (f"optimise.{name}",)
    if one.optimisation.pareto:
        result = one.found
        first = result.problem.objectives[0]
        front = Figure(f"{name}_front", f"Pareto front: {name}", "No case on the front is beaten by another in all objectives at once; the star is the start: "
                       "the vehicle's own values where they lie within the bounds.", source, result.plot)
        if len(result) < 3:
            return [front]
        return [front, Figure(f"{name}_designs", f"Designs on the front: {name}", f"Variables of the cases on the front, coloured by {first.name}.",
                              source,
                              lambda: plots.plot_parallel(result.values, result.problem.names, result.objectives[:, 0],
                                                          units=[v.unit for v in result.problem.variables], output=first.name, unit=first.unit))]
    made = [Figure(f"{name}_course", f"Course of the optimisation: {name}", "Objective of every design in the order in which it was asked for.", source,
                   one.found.plot)]
    if len(one.found.problem.variables) == 2:
        made.append(Figure(f"{name}_map", f"Designs looked at: {name}", "Objective between the designs that were computed; the best is marked.", source,
                           lambda: _design_map(one.found)))
    if one.recheck is not None:
        made.append(Figure(f"{name}_recheck", f"Before and after: {name}",
                           "The study with its tolerances about the vehicle's own design, and about the optimum.", ("study", f"recheck.{name}"), lambda: _before_after(found, one)))
    return made


def _design_map(optimum):
    objective, variables = optimum.problem.objectives[0], optimum.problem.variables
    good = [c for c in optimum.cases if not c.failed]
    axes = plots.plot_study_map([c.values for c in good], [v.name for v in variables], [objective.value(c.outputs) for c in good],
                                units=[v.unit for v in variables], output=objective.name, unit=objective.unit)
    best = [shown(v.unit)[0] * optimum.values[v.name] for v in variables]
    axes.plot(*best, "*", color="white", markeredgecolor="black", markersize=14, linestyle="none", clip_on=False, zorder=10)
    for variable, scale in zip(variables, (axes.set_xscale, axes.set_yscale)):
        scale(variable.scale)
    return axes


def _before_after(found, one):
    from railsym.campaign.uncertainty import values_of
    from railsym.plots.style import BLACK, BLUE, GREY, new_axes, tidy
    from railsym.plots.units import labelled

    axes = new_axes(None, size=(6.8, 3.8))[0, 0]
    factor, unit = shown(found.results.unit(found.output))
    limit = None if one.probability is None else factor * one.probability.limit
    before, after = (factor * v[~np.isnan(v)] for v in (found.values()[0], values_of(one.recheck, found.output)[0]))
    edges = np.histogram_bin_edges(np.concatenate([before, after]), 40)
    for values, colour, text in ((before, GREY, "as it is"), (after, BLUE, f"optimum of {one.optimisation.name}")):
        label = f"{text}: mean {values.mean():.4g}, 5 % below {np.quantile(values, 0.05):.4g} {unit}"
        axes.hist(values, edges, density=True, color=colour, alpha=0.6, label=label)
    if limit is not None:
        axes.axvline(limit, color=BLACK, linewidth=1.2, label=f"limit {limit:.4g} {unit}")
    tidy(axes, labelled(found.output, found.results.unit(found.output)), f"density, 1/({unit})" if unit else "density")
    axes.grid(False, axis="x")
    axes.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, 1.22))
    return axes
