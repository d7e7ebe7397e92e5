# SPDX-License-Identifier: BSD-3-Clause
"""A curving study over radius: forces, ratios with their limits, angle of attack, wear number."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import GREY, KMH, line_styles, new_axes, tidy

_SHADES = ("-", "--", ":", "-.")


def plot_curving(found, *, axes=None):
    """Y and Q of the outer wheels, Y/Q, sum of Y, angle of attack and wear number over radius.

    Parameters
    ----------
    found : railsym.curving.Curving
    axes : array of six matplotlib Axes, optional

    Returns
    -------
    ndarray of matplotlib Axes, shape (3, 2)
    """
    panels = new_axes(axes, 3, 2, size=(10.0, 9.4))
    order = np.argsort(found.radius)
    outer, wheels, sets = found.outer, list(found.wheels), list(found.wheelsets)
    out = [wheels[k] for k in outer]
    _lines(panels[0, 0], found, order, 1e-3 * found.Y[:, :, outer], out, "Y, kN", "guiding force of the outer wheels, + outwards")
    _lines(panels[0, 1], found, order, 1e-3 * found.Q[:, :, outer], out, "Q, kN", "vertical force of the outer wheels")
    _lines(panels[1, 0], found, order, found.YQ[:, :, outer], out, "Y/Q", "Y/Q of the outer wheels")
    _lines(panels[1, 1], found, order, 1e-3 * found.sum_Y, sets, "sum of Y, kN", "sum of Y of the wheelsets, + to the right")
    _lines(panels[2, 0], found, order, 1e3 * found.angle_of_attack, sets, "angle of attack, mrad", "angle of attack of the wheelsets, + nose to the right")
    _lines(panels[2, 1], found, order, found.t_gamma[:, :, outer], out, "T-gamma, N", "wear number of the outer wheels")
    if found.largest is not None:
        _dots(panels[1, 0], found, order, found.largest["YQ"][:, :, outer], out)
        _dots(panels[1, 1], found, order, 1e-3 * found.largest["sum_Y"], sets)
    _limits(panels, found, order)
    _legends(panels, found, out, sets)
    if axes is None:
        panels[0, 0].figure.suptitle(_heading(found), fontsize=10, x=0.01, ha="left")
    return panels


def _lines(axes, found, order, values, names, label, title):
    styles = line_styles(names)
    for i, name in enumerate(names):
        for j in range(len(values)):
            axes.plot(found.radius[order], values[j, order, i], **(styles[name] | {"linestyle": _SHADES[j % len(_SHADES)], "markersize": 3.5}))
    for failure in found.failures:
        if failure.analysis == "quasi-static":
            axes.axvline(failure.radius, color=GREY, linewidth=0.6, linestyle=":")
    tidy(axes, "radius, m", label, title)


def _dots(axes, found, order, values, names):
    """What runs with irregularities reach, without lines."""
    styles = line_styles(names)
    for i, name in enumerate(names):
        for j in range(len(values)):
            axes.plot(found.radius[order], values[j, order, i], linestyle="none", marker=styles[name]["marker"], color=styles[name]["color"],
                      markersize=5.5, markerfacecolor="none")


def _limits(panels, found, order):
    from railsym.criteria.derailment import quasi_static_Y_limit
    from railsym.criteria.limits import limits, sum_Y_limit

    shift = 1e-3 * min(sum_Y_limit(load).value for load in found.static_load.reshape(-1, 2).mean(axis=1))
    guiding = [1e-3 * quasi_static_Y_limit(radius).value for radius in found.radius[order]]
    for axes, values, mark in ((panels[0, 0], guiding, quasi_static_Y_limit(500.0).trust),
                               (panels[1, 0], [limits("YQ").value] * len(order), limits("YQ").trust),
                               (panels[1, 1], [shift] * len(order), sum_Y_limit(6e4).trust)):
        reached = max(abs(v) for v in axes.get_ylim())
        if max(values) > 3.0 * reached:
            axes.text(0.99, 0.97, f"limit ({mark}): {min(values):.3g} and more, above the picture", transform=axes.transAxes, ha="right", va="top",
                      fontsize=7.5, color=GREY)
            continue
        for sign in (1.0, -1.0) if axes is panels[1, 1] else (1.0,):
            axes.plot(found.radius[order], sign * np.array(values), color=GREY, linewidth=1.1, linestyle=(0, (6, 3)))
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.07 * (high - low))
        axes.text(found.radius.max(), values[-1], f"limit ({mark})", ha="right", va="bottom", fontsize=7.5, color=GREY)


def _legends(panels, found, wheels, sets):
    from matplotlib.lines import Line2D

    for axes, names in ((panels[2, 1], wheels), (panels[2, 0], sets)):      # where curves leave room
        styles = line_styles(names)
        axes.legend(handles=[Line2D([], [], **(styles[name] | {"linestyle": "-"})) for name in names], labels=list(names), fontsize=7.5, frameon=False)
    handles, labels = [], []
    if len(found.speed) > 1:
        for j in range(len(found.speed)):
            handles.append(Line2D([], [], color=GREY, linestyle=_SHADES[j % len(_SHADES)]))
            labels.append(row_text(found, j))
    if found.largest is not None:
        handles.append(Line2D([], [], color=GREY, marker="o", markerfacecolor="none", linestyle="none"))
        labels.append("run with irregularities, 99.85 %")
    if handles:
        panels[1, 0].legend(handles=handles, labels=labels, fontsize=7.5, frameon=False, loc="center right")


def row_text(found, row):
    """What a row stands for, in words."""
    if found.cases.by == "speed":
        return f"{KMH * found.speed[row, 0]:.4g} km/h"
    return f"cant deficiency {1e3 * found.cant_deficiency[row, 0]:.4g} mm"


def _heading(found):
    name = f"{found.vehicle}, {found.configuration}" if found.configuration else found.vehicle
    low, high = 1e3 * found.cant.min(), 1e3 * found.cant.max()
    cant = f"cant {low:.4g} mm" if low == high else f"cant {low:.4g} to {high:.4g} mm"
    rows = f", {row_text(found, 0)}" if len(found.speed) == 1 else ""
    return f"{name}: curves to the {found.direction}, {cant}{rows}; {found.contact}, {found.law}"
