# SPDX-License-Identifier: BSD-3-Clause
"""The report of a campaign: one HTML page with figures, settings, versions, and where every number comes from."""

from __future__ import annotations

import os
from html import escape
from pathlib import Path

import numpy as np

from railsym.campaign import provenance
from railsym.campaign.errors import CampaignError
from railsym.campaign.html import Raw, mark, number, page, picture, table
from railsym.campaign.results import extremes, summary
from railsym.plots.units import shown

_MOST_ROWS = 1000      # cases listed; a page of more is slow to open
_LONG = 90             # characters of an origin that are shown at once


def write_report(found, path):
    """Write the report; an existing file is replaced when the new one is whole.

    Raises
    ------
    CampaignError
        If it cannot be written.
    """
    text = report(found)
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise CampaignError(f"report {path}: {error.strerror}") from None


def report(found):
    """The page as text.

    Parameters
    ----------
    found : CampaignResults

    Returns
    -------
    str
    """
    sources = provenance.sources(found)
    sections = [("summary", "Summary", _headline(found, sources)), ("figures", "Figures", _figures(found, sources))]
    if found.uncertainty is not None:
        sections.append(("uncertainty", "Uncertainty in numbers", _uncertainty(found, sources)))
    if found.optimised:
        sections.append(("optimisation", "Optimisation", "".join(_optimised(found, one, sources) for one in found.optimised)))
    sections += [("factors", "Factors and their origin", _factors(found, sources)), ("cases", "Cases", _cases(found, sources)),
                 ("sources", "Where the numbers come from", _sources(found, sources)), ("settings", "Settings", _settings(found))]
    links = "".join(f'<a href="#{key}">{escape(title)}</a>' for key, title, _ in sections)
    body = "".join(f'<section id="{key}"><h2>{escape(title)}</h2>\n{content}</section>\n' for key, title, content in sections)
    head = f"<h1>{escape(found.campaign.title)}</h1>\n<p>{escape(found.campaign.description)}</p>\n<nav>{links}</nav>\n"
    foot = f'<footer>Report of railsym, {provenance.now()}. <span id="pictures"></span></footer>\n'
    return page(found.campaign.title, head + body + foot)


def _card(value, unit, text, source):
    return f"<div class=\"card\"><b>{value} {escape(unit)}</b><small>{escape(text)} {mark(source)}</small></div>\n"


def _headline(found, sources):
    numbers, unit = summary(found.results, found.output)
    study, name = sources["study"], found.output
    cards = [_card(str(numbers["cases"]), "cases", f"{numbers['failed']} failed", study)]
    if "mean" in numbers:
        cards.append(_card(number(numbers["mean"]), unit, f"{name}, mean; standard deviation {number(numbers['standard deviation'], 3)} {unit}", study))
        cards.append(_card(number(numbers["5 % quantile"]), unit, f"{name}, 5 % of the cases lie below", study))
    u, factor = found.uncertainty, shown(found.results.unit(name))[0]
    if u is not None and u.probability is not None:
        p = u.probability
        cards.append(_card(number(100 * p.value, 3), "%", f"of cases below {number(factor * p.limit)} {unit} "
                           f"({100 * p.confidence:g} % interval {number(100 * p.exact[0], 3)} to {number(100 * p.exact[1], 3)} %)", study))
    for one in found.optimised:
        cards += _optimum_cards(found, one, sources, unit)
    warn = "" if not numbers["failed"] else f'<p class="warn">{numbers["failed"]} cases failed; they are listed under <a href="#cases">Cases</a>.</p>\n'
    return f'<div class="cards">{"".join(cards)}</div>\n{warn}{_statistics(found, numbers, unit, study)}'


def _statistics(found, numbers, unit, source):
    """Table of what the study gave, with the cases of the extremes."""
    cases = extremes(found.results, found.output)
    rows = [[name, value, unit if isinstance(value, float) else "", f"case {cases[name]}" if name in cases else "all cases"]
            for name, value in numbers.items()]
    return f"<h3>{escape(found.output)} of the study {mark(source)}</h3>\n" + table(["", "value", "unit", "from"], rows)


def _optimum_cards(found, one, sources, unit):
    source = sources[f"optimise.{one.optimisation.name}"]
    if one.optimisation.pareto:
        count = len(one.found)
        return [_card(str(count), "design" if count == 1 else "designs", f"on the Pareto front {one.optimisation.name}, of {one.found.evaluations} cases", source)]
    objective = one.found.problem.objectives[0]
    factor, text = shown(objective.unit)
    cards = [_card(number(factor * one.found.objective), text, f"{objective.name} at the optimum {one.optimisation.name}", source)]
    if one.probability is not None:
        limit = shown(found.results.unit(found.output))[0] * one.probability.limit
        cards.append(_card(number(100 * one.probability.value, 3), "%", f"of cases below {number(limit)} {unit} with the optimum {one.optimisation.name}",
                           sources[f"recheck.{one.optimisation.name}"]))
    return cards


def _figures(found, sources):
    parts = []
    for figure in found.figures():
        image, wide = picture(figure.draw(), f"{figure.title}. {figure.caption}")
        marks = ", ".join(mark(sources[name]) for name in figure.sources if name in sources)
        parts.append(f'<figure{" class=wide" if wide else ""} id="figure-{figure.name}">{image}<figcaption><b>{escape(figure.title)}.</b> '
                     f"{escape(figure.caption)} Source: {marks}.</figcaption></figure>\n")
    return f'<div class="figures">{"".join(parts)}</div>\n' if parts else "<p>No case has a value to draw.</p>\n"


def _uncertainty(found, sources):
    u, parts = found.uncertainty, []
    factor, unit = shown(found.results.unit(found.output))
    if u.probability is not None:
        parts.append(_probability(u.probability, factor, unit, sources["study"], "the study as it is"))
    if u.form is not None:
        f = u.form
        order = np.argsort(-f.importance)
        units = dict(zip(found.campaign.study.names, found.campaign.study.units))
        parts.append(f"<h3>First-order reliability (FORM) {mark(sources['model'])}</h3>\n<p>P = {number(f.probability, 3)}, reliability index "
                     f"{number(f.beta)}; from the gradient at the medians alone {number(f.mean_value_probability, 3)}. A local estimate: exact where the limit is a plane in the normal "
                     "space; the count of cases above has no such assumption. The most probable parameters at the limit:</p>\n"
                     + table(["factor", "at the limit", "unit", "importance"],
                             [[f.names[k], *_in_unit(units[f.names[k]], f.design_point[k]), float(f.importance[k])] for k in order]))
    if u.tornado is not None:
        parts.append(_tornado(u.tornado, factor, unit, sources["model"]))
    if u.sobol is not None:
        s = u.sobol
        rows = [[s.names[k], float(s.first[k]), float(s.first_half[k]), float(s.total[k]), float(s.total_half[k])] for k in np.argsort(-s.total)]
        parts.append(f"<h3>Sobol indices {mark(sources['sobol'])}</h3>\n<p>{escape(s.message)}. Intervals: {100 * s.confidence:g} %, by bootstrap.</p>\n"
                     + table(["factor", "first order", "±", "total", "±"], rows, sort=True))
    parts += [f'<p class="warn">{escape(note)}</p>\n' for note in u.notes]
    return "".join(parts)


def _tornado(t, factor, unit, source):
    computed = t.computed_low if t.computed_low is not None else np.full(len(t.names), np.nan), t.computed_high
    rows = [[t.names[k], *_in_unit(t.units[k], t.low[k], t.high[k]), float(factor * t.change_low[k]), float(factor * computed[0][k]),
             float(factor * t.change_high[k]), float(factor * computed[1][k]), float(100 * t.share[k])] for k in range(len(t.names))]
    return (f"<h3>Tornado {mark(source)}</h3>\n<p>{escape(t.output)} at the medians: {number(factor * t.nominal)} {unit}; first-order standard deviation "
            f"{number(factor * t.deviation, 3)} {unit}.</p>\n"
            + table(["factor", f"{100 * t.levels[0]:g} % quantile", f"{100 * t.levels[1]:g} % quantile", "unit", f"change at low, {unit}", "computed",
                     f"change at high, {unit}", "computed", "variance, %"], rows, sort=True))


def _probability(p, factor, unit, source, text):
    lost = "" if not p.unknown else (f" {p.unknown} cases failed; whatever they would have given, the interval is {number(p.bounds[0], 3)} to "
                                     f"{number(p.bounds[1], 3)}.")
    return (f"<h3>Probability of less than {number(factor * p.limit)} {unit}, {escape(text)} {mark(source)}</h3>\n<p>{p.below} of {p.cases} cases: "
            f"{number(p.value, 3)}; {100 * p.confidence:g} % interval {number(p.exact[0], 3)} to {number(p.exact[1], 3)} (Clopper and Pearson), "
            f"{number(p.wilson[0], 3)} to {number(p.wilson[1], 3)} (Wilson).{lost}</p>\n")


def _optimised(found, one, sources):
    source = sources[f"optimise.{one.optimisation.name}"]
    head = f"<h3>{escape(one.optimisation.name)} {mark(source)}</h3>\n<p>{escape(one.optimisation.text)}</p>\n<p class=soft>{escape(one.found.message)}</p>\n"
    return head + (_front(one.found) if one.optimisation.pareto else _optimum(found, one, sources))


def _optimum(found, one, sources):
    best, base = one.found, found.campaign.study.base()
    rows = []
    for v in best.problem.variables:
        own = float(base.parameters[v.name].value) if v.name in base.parameters else float("nan")
        rows.append([v.name, *_in_unit(v.unit, own, best.values[v.name], v.low, v.high), "at its bound" if v.name in best.at_bounds else ""])
    text = f"<p>The best design is case {best.number} of the history.</p>\n"
    text += table(["variable", "vehicle", "optimum", "lowest", "highest", "unit", ""], rows)
    outputs = [[name, value] for name, value in best.outputs.items()]
    text += "<p class=soft>Outputs of the optimum, SI:</p>\n" + table(["output", "value"], outputs)
    text += "".join(f"<p>Constraint {escape(str(c))}: {number(best.outputs[c.output])}</p>\n" for c in best.problem.constraints)
    if best.outputs.get("beyond_range", 0.0) > 0.0:
        text += '<p class="warn">The optimum stays stable over the whole range of speeds: its critical speed is at least the upper end.</p>\n'
    if one.probability is not None:
        factor, unit = shown(found.results.unit(found.output))
        text += _probability(one.probability, factor, unit, sources[f"recheck.{one.optimisation.name}"], "at the optimum")
    return text


def _front(front):
    head = ["case", *(_with_unit(o.name, o.unit) for o in front.problem.objectives), *(_with_unit(v.name, v.unit) for v in front.problem.variables)]
    scale = [shown(o.unit)[0] for o in front.problem.objectives], [shown(v.unit)[0] for v in front.problem.variables]
    rows = [[int(n), *map(float, y * scale[0]), *map(float, x * scale[1])] for n, y, x in zip(front.numbers, front.objectives, front.values)]
    return table(head, rows, sort=True, tall=len(rows) > 15)


def _in_unit(unit, *values):
    """Numbers in the unit they are shown in, and that unit, for cells of a table."""
    factor, text = shown(unit)
    return [*(float(factor * value) for value in values), text or "-"]


def _with_unit(name, unit):
    text = shown(unit)[1]
    return f"{name}, {text}" if text else name


def _factors(found, sources):
    from railsym.sweep.factor_table import factor_to_table

    study, rows = found.campaign.study, []
    for k, (name, factor) in enumerate(study.factors.items()):
        text, assumed = provenance.origin(study, name)
        kind = ", ".join(f"{key} {_plain(value)}" for key, value in factor_to_table(factor).items())
        own = study.space.nominal[k] if not study.space.labels(k) else float("nan")
        rows.append([name, *_in_unit(study.units[k], own), kind, Raw('<span class="assumed">assumed</span>' if assumed else "given"), _folded(text)])
    count, total = provenance.assumed_share(study.base())
    return (f"<p>Values as the vehicle file {mark(sources['vehicle'])} has them, and their distributions as the study file says. Of the {total} quantities of the "
            f"vehicle (places left out) {count} are marked as assumed there: every result rests on them.</p>\n"
            + table(["factor", "own value", "unit", "distribution", "data", "origin in the vehicle file"], rows, css=("", "", "", "mid", "", "long")))


def _folded(text):
    """A long text opens on a click."""
    if len(text) <= _LONG:
        return text
    cut = text.rfind(" ", 0, _LONG)
    return Raw(f"<details><summary>{escape(text[:cut])} ...</summary>{escape(text[cut + 1:])}</details>")


def _plain(value):
    """[[100, 8], "%"] as it is read."""
    if isinstance(value, list) and len(value) == 2 and isinstance(value[1], str):
        inner = value[0] if isinstance(value[0], list) else [value[0]]
        return f"{', '.join(f'{v:g}' if isinstance(v, (int, float)) else str(v) for v in inner)} {value[1]}"
    return f"{value:g}" if isinstance(value, (int, float)) else str(value)


def _cases(found, sources):
    results, study = found.results, found.campaign.study
    head = ["case", "status", *(_with_unit(n, u) for n, u in zip(results.names, study.units)),
            *(_with_unit(n, "" if o.text else o.unit) for n, o in study.outputs.items())]
    count = min(len(results), _MOST_ROWS)
    columns = [_column(results, name, study.units[k], count) for k, name in enumerate(results.names)]
    columns += [_column(results, name, out.unit, count) for name, out in study.outputs.items()]
    rows = [[k, str(results.status[k]), *(column[k] for column in columns)] for k in range(count)]
    note = "" if count == len(results) else f" The first {count} of {len(results)} are listed; the store holds all."
    text = f"<p>Every case {mark(sources['study'])}; a click on a heading sorts.{note}</p>\n" + table(head, rows, sort=True, tall=True)
    if results.errors:
        errors = [[case, error] for case, error in list(results.errors.items())[:_MOST_ROWS]]
        text += "<h3>Failed cases</h3>\n" + table(["case", "error"], errors, css=("", "long"), tall=len(errors) > 12)
    return text


def _column(results, name, unit, count):
    values = results[name][:count]
    if values.dtype.kind in "fc":
        return (shown(unit)[0] * values).tolist()
    return [str(v) for v in values]


def _sources(found, sources):
    text = "<p>Marks such as S1 in this page point here. Cases are numbered as in the files.</p>\n"
    for source in sources.values():
        rows = [[key, Raw(f"<code>{escape(value)}</code>" if key in ("SHA-256", "hash of the study") else escape(value))] for key, value in source.facts]
        text += f'<h3 id="{source.mark}">{source.mark}: {escape(source.title)}</h3>\n' + table(["", ""], rows, css=("", "hash"))
    return text


def _settings(found):
    stages = [[s.name, s.text, float(s.seconds), s.message] for s in found.stages]
    command = f"<p>Command: <code>{escape(provenance.command())}</code>; processes: {found.workers}</p>\n"
    text = command + "<h3>What was done</h3>\n" + table(["stage", "what", "seconds", "result"], stages, css=("", "long", "", "long"))
    text += "<h3>Versions</h3>\n" + table(["", ""], [list(v) for v in provenance.versions()])
    if found.campaign.text:
        name = found.campaign.path.name if found.campaign.path else "study"
        text += f"<details><summary>Study file {escape(name)}</summary><pre>{escape(found.campaign.text)}</pre></details>\n"
    return text
