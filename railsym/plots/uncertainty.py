# SPDX-License-Identifier: BSD-3-Clause
"""Tolerances and what they do: tornado charts, Sobol indices, histograms with a probability."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREY, ORANGE, PALE, SKY, VERMILION, new_axes, tidy
from railsym.plots.units import short, shown


def plot_tornado(result, *, count=15, axes=None):
    """Bars: what each tolerance alone does to the result, to first order, and dots where it was computed anew.

    Parameters
    ----------
    result : railsym.uncertainty.Tornado
    count : int
        How many parameters.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
        The widest on top.
    """
    count = min(count, len(result.names))
    axes = new_axes(axes, size=(8.4, 1.9 + 0.34 * max(count, 3)))[0, 0]
    factor, unit = shown(result.unit)
    place = np.arange(count)
    for change, colour, level in ((result.change_low, SKY, result.levels[0]), (result.change_high, BLUE, result.levels[1])):
        axes.barh(place, factor * change[:count], height=0.7, color=colour, label=f"parameter at its {100 * level:g} % quantile")
    for computed, colour in ((result.computed_low, SKY), (result.computed_high, BLUE)):
        if computed is not None:
            axes.plot(factor * computed[:count], place, "D", markersize=5, markerfacecolor=colour, markeredgecolor=BLACK, linestyle="none")
    if result.computed_low is not None:
        axes.plot([], [], "D", markersize=5, markerfacecolor="white", markeredgecolor=BLACK, linestyle="none", label="computed anew")
    axes.set_yticks(place, [f"{name}\n{_range(result, k)}" for k, name in enumerate(result.names[:count])], fontsize=7.5)
    axes.axvline(0.0, color="black", linewidth=0.8)
    tidy(axes, f"change of {result.output}, {unit}", "", f"{result.output} {factor * result.nominal:.4g} {unit}, "
         f"standard deviation {factor * result.deviation:.3g} {unit} (first order)")
    axes.set_ylim(count - 0.4, -0.6)
    axes.grid(False, axis="y")
    axes.legend(loc="upper center", bbox_to_anchor=(0.4, -0.5 / (0.34 * max(count, 3) + 0.9)), ncols=3, fontsize=8, frameon=False)
    return axes


def _range(result, k):
    factor, unit = shown(result.units[k])
    return f"{short(factor * result.low[k])} to {short(factor * result.high[k])} {unit}".rstrip()


def plot_sobol(result, *, count=15, axes=None):
    """Bars: first-order and total index of each parameter, with their intervals.

    Parameters
    ----------
    result : railsym.uncertainty.Sobol
    count : int
        How many parameters.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
        The largest total index on top.
    """
    order = np.argsort(-result.total)[:count]
    axes = new_axes(axes, size=(8.0, 1.4 + 0.38 * max(len(order), 3)))[0, 0]
    place = np.arange(len(order))
    for values, half, shift, colour, text in ((result.first, result.first_half, -0.19, BLUE, "first order: alone"),
                                              (result.total, result.total_half, 0.19, ORANGE, "total: with all others")):
        axes.barh(place + shift, values[order], height=0.36, color=colour, label=text)
        axes.errorbar(values[order], place + shift, xerr=half[order], fmt="none", ecolor=BLACK, elinewidth=1.0, capsize=2.5)
    axes.set_yticks(place, [result.names[k] for k in order], fontsize=8)
    axes.axvline(0.0, color="black", linewidth=0.8)
    tidy(axes, f"share of the variance (bars: {100 * result.confidence:g} % intervals)", "",
         f"{result.base} base points, {result.cases} cases; first-order indices add to {result.first.sum():.2f}")
    axes.set_ylim(len(order) - 0.4, -0.6)
    axes.grid(False, axis="y")
    axes.legend(loc="lower right", fontsize=8, frameon=False)
    return axes


def plot_probability(values, *, probability=None, form=None, output="result", unit="", bins=30, axes=None):
    """Histogram of a result, with the share below a limit.

    Parameters
    ----------
    values : array_like, shape (n,)
        nan (or masked) where there is none.
    probability : railsym.uncertainty.Probability, optional
        Marks its limit and writes its value.
    form : railsym.uncertainty.Form, optional
        Writes the first-order estimate beside it.
    output, unit : str
    bins : int
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(6.8, 4.0))[0, 0]
    factor, unit = shown(unit)
    values = factor * np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    values = values[~np.isnan(values)]
    edges = np.histogram_bin_edges(values, min(bins, max(5, int(np.sqrt(len(values))))))
    limit = None if probability is None else factor * probability.limit
    if limit is not None:      # a bin ends at the limit, so that colours tell the truth
        edges = np.unique(np.append(edges, limit)) if edges[0] < limit < edges[-1] else edges
    count, _ = np.histogram(values, edges)
    colours = [VERMILION if limit is not None and right <= limit + 1e-9 * abs(limit) else SKY for right in edges[1:]]
    axes.bar(edges[:-1], count / np.diff(edges) / len(values), width=np.diff(edges), align="edge", color=colours, edgecolor="white", linewidth=0.4)
    title = f"{len(values)} cases, mean {np.mean(values):.4g}, standard deviation {np.std(values, ddof=1):.3g} {unit}" if len(values) > 1 else "one case"
    tidy(axes, f"{output}, {unit}" if unit else output, f"density, 1/({unit})" if unit else "density", title)
    axes.grid(False, axis="x")
    if limit is not None:
        axes.axvline(limit, color=BLACK, linewidth=1.2)
        left = limit > np.median(values)      # the side where the bars are low
        axes.text(0.015 if left else 0.985, 0.97, _probability_text(probability, form, limit, unit), transform=axes.transAxes, va="top",
                  ha="left" if left else "right", multialignment="left", fontsize=8,
                  bbox={"facecolor": "white", "edgecolor": PALE, "alpha": 0.9, "boxstyle": "round,pad=0.35"})
    return axes


def _probability_text(probability, form, limit, unit):
    low, high = probability.exact
    lines = [f"below {limit:.4g} {unit}: {probability.below} of {probability.cases}", f"P = {probability.value:.3g}  "
             f"[{low:.2g}, {high:.2g}], {100 * probability.confidence:g} %"]
    if probability.unknown:
        lines.append(f"{probability.unknown} cases failed")
    if form is not None:
        lines.append(f"first order (FORM): {form.probability:.3g}")
    return "\n".join(lines)


def plot_convergence(values, limit, *, confidence=0.95, unit="", axes=None):
    """How the probability settled as cases came in, with its exact interval.

    Parameters
    ----------
    values : array_like, shape (n,)
    limit : float
        In the unit of the values.
    confidence : float
    unit : str
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    from railsym.uncertainty import probability_below

    axes = new_axes(axes, size=(6.4, 3.2))[0, 0]
    factor, unit = shown(unit)
    values = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    counts = np.unique(np.geomspace(min(10, len(values)), len(values), 40).astype(int))
    counts = [n for n in counts if not np.isnan(values[:n]).all()]
    found = [probability_below(values[:n], limit, confidence=confidence) for n in counts]
    axes.fill_between(counts, [f.exact[0] for f in found], [f.exact[1] for f in found], color=PALE, label=f"{100 * confidence:g} % interval")
    axes.plot(counts, [f.value for f in found], color=BLUE, label="share")
    axes.set_xscale("log")
    axes.axhline(found[-1].value, color=GREY, linewidth=0.8, linestyle="--")
    tidy(axes, "cases", f"probability below {factor * limit:.4g} {unit}")
    axes.legend(fontsize=8, frameon=False)
    return axes
