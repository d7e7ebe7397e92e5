# SPDX-License-Identifier: BSD-3-Clause
"""Results of a campaign as text and as plain data."""

from __future__ import annotations

import numpy as np

from railsym.campaign.results import summary
from railsym.cli_output import table
from railsym.plots.units import short, shown


def as_text(found):
    """Tables for reading."""
    results, output = found.results, found.output
    numbers, unit = summary(results, output)
    blocks = [f"{found.campaign.title}\n{results.message}"]
    blocks.append(table([f"{output}, {unit}" if unit else output, "value"],
                        [[name, _number(value)] for name, value in numbers.items() if value or name in ("cases", "failed")]))
    if results.errors:
        case, error = next(iter(results.errors.items()))
        blocks.append(f"{len(results.errors)} cases failed; case {case}: {error}")
    if found.uncertainty is not None:
        blocks += _uncertainty(found.uncertainty, unit, shown(results.unit(output))[0])
    for one in found.optimised:
        blocks.append(f"optimise.{one.optimisation.name}\n{one.found}")
        if one.probability is not None:
            again, _ = summary(one.recheck, output)
            spread = "" if "mean" not in again else (f": {output} {_number(again['mean'])} {unit} in the mean, standard deviation "
                                                     f"{_number(again['standard deviation'])} {unit}")
            blocks.append(f"the study at this optimum{spread}\n{_shown_probability(one.probability, unit, shown(results.unit(output))[0])}")
    return "\n\n".join(blocks)


def _uncertainty(found, unit, factor):
    blocks = []
    if found.probability is not None:
        blocks.append(_shown_probability(found.probability, unit, factor))
    if found.form is not None:
        order = np.argsort(-found.form.importance)[:5]
        blocks.append(f"first order (FORM): P = {found.form.probability:.3g}, beta = {found.form.beta:.3f}; most important: "
                      + ", ".join(f"{found.form.names[k]} ({100 * found.form.importance[k]:.0f} %)" for k in order))
    if found.tornado is not None:
        t = found.tornado
        scale = [shown(u) for u in t.units]
        rows = [[t.names[k], short(scale[k][0] * t.low[k]), short(scale[k][0] * t.high[k]), scale[k][1] or "-",
                 f"{factor * t.change_low[k]:+.3g}", f"{factor * t.change_high[k]:+.3g}", f"{100 * t.share[k]:.1f} %"] for k in range(len(t.names))]
        blocks.append(f"tornado, from the gradient at the medians ({factor * t.nominal:.4g} {unit}, first-order standard deviation {factor * t.deviation:.3g} "
                      f"{unit})\n" + table(["factor", "low", "high", "unit", f"at low, {unit}", f"at high, {unit}", "variance"], rows, left=(0, 3)))
    if found.sobol is not None:
        s = found.sobol
        rows = [[s.names[k], f"{s.first[k]:.3f}", f"{s.first_half[k]:.3f}", f"{s.total[k]:.3f}", f"{s.total_half[k]:.3f}"] for k in np.argsort(-s.total)]
        blocks.append(f"Sobol indices, {s.base} base points, {s.cases} cases" + (f", {s.dropped} base points left out" if s.dropped else "") + "\n"
                      + table(["factor", "first", "+-", "total", "+-"], rows))
    return blocks + list(found.notes)


def _shown_probability(found, unit, factor):
    text = (f"P({factor * found.limit:.4g} {unit} is not reached) = {found.value:.3g}: {found.below} of {found.cases} cases, "
            f"{100 * found.confidence:g} % interval "
            f"{found.exact[0]:.3g} to {found.exact[1]:.3g} (Clopper-Pearson), {found.wilson[0]:.3g} to {found.wilson[1]:.3g} (Wilson)")
    lost = f"; {found.unknown} cases failed, with any outcome of theirs {found.bounds[0]:.3g} to {found.bounds[1]:.3g}"
    return text + (lost if found.unknown else "")


def _number(value):
    return f"{value:d}" if isinstance(value, int) else f"{value:.4g}"


def as_data(found):
    """Plain data, SI."""
    results = found.results
    content = {"title": found.campaign.title, "hash": results.study.hash, "message": results.message, "cases": len(results),
               "failed": len(results.errors), "output": found.output, "unit": results.unit(found.output),
               "files": {name: str(path) for name, path in found.files.items()},
               "stages": [{"name": s.name, "seconds": s.seconds, "message": s.message} for s in found.stages]}
    numbers, unit = summary(results, found.output)
    content["summary"] = numbers | {"unit": unit}
    if found.uncertainty is not None:
        content["uncertainty"] = _uncertainty_data(found.uncertainty)
    content["optimise"] = {one.optimisation.name: _optimised_data(one) for one in found.optimised}
    return content


def _probability_data(found):
    from dataclasses import asdict

    return None if found is None else {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(found).items()}


def _uncertainty_data(found):
    content = {"probability": _probability_data(found.probability), "notes": list(found.notes), "form": None, "tornado": None, "sobol": None}
    if found.form is not None:
        f = found.form
        content["form"] = {"limit": f.limit, "beta": f.beta, "probability": f.probability, "mean_value_probability": f.mean_value_probability,
                           "design_point": dict(zip(f.names, f.design_point.tolist())), "importance": dict(zip(f.names, f.importance.tolist()))}
    if found.tornado is not None:
        t = found.tornado
        content["tornado"] = {"nominal": t.nominal, "deviation": t.deviation, "names": list(t.names), "low": t.low.tolist(), "high": t.high.tolist(),
                              "change_low": t.change_low.tolist(), "change_high": t.change_high.tolist(), "computed_low": _listed(t.computed_low),
                              "computed_high": _listed(t.computed_high), "share": t.share.tolist()}
    if found.sobol is not None:
        s = found.sobol
        content["sobol"] = {"base": s.base, "dropped": s.dropped, "cases": s.cases, "names": list(s.names)} | {
            name: getattr(s, name).tolist() for name in ("first", "first_half", "total", "total_half")}
    return content


def _listed(values):
    return None if values is None else [None if np.isnan(v) else float(v) for v in values]


def _optimised_data(one):
    found = one.found
    content = {"message": found.message, "evaluations": found.evaluations, "computed": found.computed, "failed": found.failed}
    if one.optimisation.pareto:
        return content | {"objectives": [o.name for o in found.problem.objectives], "front": found.objectives.tolist(), "values": found.values.tolist(),
                          "names": list(found.problem.names), "cases": list(found.numbers)}
    return content | {"values": found.values, "outputs": found.outputs, "objective": found.objective, "converged": found.converged,
                      "at_bounds": list(found.at_bounds), "method": found.method, "probability": _probability_data(one.probability)}
