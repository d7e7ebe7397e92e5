# SPDX-License-Identifier: BSD-3-Clause
"""Studies: maps over two factors, one output against each factor, parallel coordinates.

Functions take plain arrays (factors (n, k), an output (n,)), so that results of any origin can be drawn.
"""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, GREY, VERMILION, new_axes, tidy
from railsym.plots.units import labelled, round_range, shown

_COLOURS = "viridis"
_FEW = 400       # lines that can still be told apart in parallel coordinates


def plot_study_map(factors, names, values, *, units=("", ""), output="result", unit="", axes=None):
    """Contours of an output over two factors: of a full grid as they are, of other plans by triangles between the cases.

    Parameters
    ----------
    factors : array_like, shape (n, 2)
    names : sequence of str
        Of the two factors.
    values : array_like, shape (n,)
        nan where there is none: left white, with a cross.
    units : sequence of str
        Of the factors.
    output, unit : str
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(6.6, 4.4))[0, 0]
    scale = np.array([shown(u)[0] for u in units])
    points = np.asarray(factors, float).reshape(-1, 2) * scale
    factor, _ = shown(unit)
    values = factor * np.ma.filled(np.ma.asarray(values, dtype=float), np.nan)
    good = ~np.isnan(values)
    grid = _as_grid(points, values)
    if grid is not None:
        filled = axes.contourf(*grid, levels=12, cmap=_COLOURS)
        lines = axes.contour(*grid, levels=filled.levels, colors="white", linewidths=0.6)
    elif good.sum() >= 3:
        filled = axes.tricontourf(*points[good].T, values[good], levels=12, cmap=_COLOURS)
        lines = axes.tricontour(*points[good].T, values[good], levels=filled.levels, colors="white", linewidths=0.6)
        axes.plot(*points[good].T, ".", color="white", markersize=2, alpha=0.6)
    else:
        raise ValueError(f"a map needs at least 3 cases with a result; there are {int(good.sum())}")
    axes.clabel(lines, fmt="%.4g", fontsize=8)
    axes.plot(*points[~good].T, "x", color=VERMILION, markersize=5)
    axes.figure.colorbar(filled, ax=axes, label=labelled(output, unit))
    axes.set_facecolor("#eeeeee")
    tidy(axes, *(labelled(n, u) for n, u in zip(names, units)))
    axes.grid(False)
    return axes


def _as_grid(points, values):
    """x, y and values of a full grid; None where the cases are no grid."""
    x, y = (np.unique(column) for column in points.T)
    if len(x) < 2 or len(y) < 2 or len(x) * len(y) != len(points):
        return None
    table = np.full((len(y), len(x)), np.nan)
    table[np.searchsorted(y, points[:, 1]), np.searchsorted(x, points[:, 0])] = values
    return x, y, np.ma.masked_invalid(table)


def plot_scatter(factors, names, values, *, units=None, output="result", unit="", axes=None):
    """One output against each factor.

    Parameters
    ----------
    factors : array_like, shape (n, k)
    names : sequence of str
    values : array_like, shape (n,)
    units : sequence of str, optional
    output, unit : str
    axes : array of matplotlib Axes, optional
        k of them.

    Returns
    -------
    ndarray of Axes, shape (k,)
        With the rank correlation (Spearman) in each heading.
    """
    from scipy.stats import spearmanr

    factors, count = np.asarray(factors, float), len(names)
    units = units or ("",) * count
    columns = min(4, count)
    rows = -(-count // columns)
    if axes is None:
        axes = new_axes(None, rows, columns, size=(2.7 * columns, 0.5 + 2.3 * rows), sharey=True).ravel()
    values = shown(unit)[0] * np.ma.filled(np.ma.asarray(values, dtype=float), np.nan)
    good = ~np.isnan(values)
    for k, (panel, name) in enumerate(zip(axes, names)):
        panel.plot(shown(units[k])[0] * factors[good, k], values[good], ".", color=BLUE, markersize=3, alpha=0.5, linestyle="none")
        rank = spearmanr(factors[good, k], values[good]).statistic if np.ptp(factors[good, k]) and np.ptp(values[good]) else np.nan
        tidy(panel, "", labelled(output, unit) if k % columns == 0 else "")
        panel.set_xlabel(_folded(labelled(name, units[k])), fontsize=7.5)
        panel.set_title(f"rank correlation {rank:+.2f}", fontsize=8, loc="left")
        panel.tick_params(labelsize=7.5)
    for panel in axes[count:]:
        panel.set_visible(False)
    return axes[:count]


def _folded(text, width=26):
    """A dotted name over several lines."""
    lines = [""]
    for part in text.replace(".", ".\0").replace("_", "_\0").replace(" ", " \0").split("\0"):
        if lines[-1] and len(lines[-1]) + len(part) > width:
            lines.append("")
        lines[-1] += part
    return "\n".join(lines)


def plot_parallel(factors, names, values, *, units=None, output="result", unit="", highlight=None, axes=None):
    """Parallel coordinates: each case a line through its factors and its output, coloured by the output.

    Parameters
    ----------
    factors : array_like, shape (n, k)
    names : sequence of str
    values : array_like, shape (n,)
    units : sequence of str, optional
    output, unit : str
    highlight : array_like of bool, shape (n,), optional
        Cases to draw on top in full colour; the rest pale.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
        At most 400 cases are drawn, evenly over the output.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import LineCollection
    from matplotlib.colors import Normalize

    values = shown(unit)[0] * np.ma.filled(np.ma.asarray(values, dtype=float), np.nan)
    good = np.flatnonzero(~np.isnan(values))
    good = good[np.argsort(values[good], kind="stable")]
    good = good[np.unique(np.linspace(0, len(good) - 1, min(_FEW, len(good))).astype(int))] if len(good) else good
    units = units or ("",) * len(names)
    columns = np.column_stack([np.asarray(factors, float)[good] * [shown(u)[0] for u in units], values[good]])
    heads = [*(labelled(n, u) for n, u in zip(names, units)), labelled(output, unit)]
    axes = new_axes(axes, size=(max(6.4, 1.05 * len(heads) + 1.2), 4.4))[0, 0]
    low, span = columns.min(axis=0), np.ptp(columns, axis=0)
    level = np.where(span > 0, (columns - low) / np.where(span > 0, span, 1.0), 0.5)
    colour = ScalarMappable(Normalize(low[-1], low[-1] + (span[-1] or 1.0)), _COLOURS)
    strong = np.ones(len(good), bool) if highlight is None else np.asarray(highlight, bool)[good]
    lines = np.stack([np.broadcast_to(np.arange(len(heads)), level.shape), level], axis=2)
    if (~strong).any():
        axes.add_collection(LineCollection(lines[~strong], colors="#dddddd", linewidths=0.5))
    axes.add_collection(LineCollection(lines[strong], colors=colour.to_rgba(columns[strong, -1]), linewidths=0.8, alpha=0.75))
    for k in range(len(heads)):
        axes.axvline(k, color=GREY, linewidth=1.0)
        for text, y, side in zip(round_range(columns[:, k]), (-0.025, 1.025), ("top", "bottom")):
            axes.text(k, y, text, ha="center", va=side, fontsize=7.5)
    axes.set_xlim(-0.3, len(heads) - 0.7)
    axes.set_ylim(-0.09, 1.09)
    axes.set_yticks([])
    axes.set_xticks(range(len(heads)), [_folded(h, 16) for h in heads], fontsize=7)
    for side in ("top", "right", "left", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(length=0)
    return axes
