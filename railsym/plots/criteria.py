# SPDX-License-Identifier: BSD-3-Clause
"""Criteria over time or distance, with their limits."""

from __future__ import annotations

import numpy as np

from railsym.plots.runs import solid_styles
from railsym.plots.style import BLUE, GREY, VERMILION, new_axes, tidy

_MOST = 8


def plot_instability(result, *, axes=None):
    """Band-passed accelerations above the axleboxes: one panel each, at most eight, the worst ones.

    Parameters
    ----------
    result : railsym.criteria.instability.Instability
    axes : array of matplotlib Axes, optional

    Returns
    -------
    ndarray of matplotlib Axes
    """
    shown = sorted(result.axleboxes, key=lambda box: -box.sustained)[:_MOST]
    shown = [box for box in result.axleboxes if box in shown]
    columns = 2 if len(shown) > 1 else 1
    rows = -(-len(shown) // columns)
    panels = new_axes(axes, rows, columns, size=(3.9 * columns + 0.6, 1.55 * rows + 0.7), sharex=True, sharey=True)
    bound = result.limit.value
    top = 1.15 * max(bound, *(box.peak for box in shown))
    for panel, box in zip(panels.ravel(), shown):
        panel.plot(result.run_time, result.filtered[box.channel], color=VERMILION if box.unstable else BLUE, linewidth=0.8)
        for side in (-bound, bound):
            panel.axhline(side, color=GREY, linewidth=0.9, linestyle="--")
        if box.unstable:
            panel.axvspan(box.time, box.detected, color=VERMILION, alpha=0.15, linewidth=0)
        panel.set_ylim(-top, top)
        panel.margins(x=0.0)
        tidy(panel)
        verdict = f"unstable from {box.time:.2f} s" if box.unstable else "stable"
        panel.set_title(f"{box.channel.removesuffix('.ay')}: {verdict}", loc="left", fontsize=8.5, pad=4)
    for panel in panels.ravel()[len(shown):]:
        panel.set_visible(False)
    for panel in panels[-1]:
        panel.set_xlabel("time, s")
    for panel in panels[:, 0]:
        panel.set_ylabel("m/s²", fontsize=9)
    if axes is None:
        rule = f"{result.required} cycles over {bound:g} m/s², {result.band[0]:g} to {result.band[1]:g} Hz"
        panels[0, 0].figure.suptitle(f"lateral acceleration of the frame, {rule}", fontsize=10, x=0.01, ha="left")
    return panels.ravel()[:len(shown)]


def plot_sliding(result, quantity, *, axes=None):
    """Sliding means over distance with the limit, solid when there is a verdict on it and dotted when it is only recalled.

    Parameters
    ----------
    result : railsym.criteria.derailment.Derailment
    quantity : str
        ``"Y/Q"`` or ``"sum Y"``.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    names = [name for name in result.signals if name.rpartition(" ")[0] == quantity]
    worst = result.worst(quantity)
    if not names:
        raise ValueError(f"{quantity!r} is no sliding mean; there are Y/Q and sum Y")
    scale, unit = (1e-3, "kN") if worst.unit == "N" else (1.0, "")
    panel = new_axes(axes, size=(7.2, 3.2))[0, 0]
    for name, style in solid_styles(names).items():
        values = result.signals[name] * scale
        panel.plot(result.distance[name], np.where(np.isfinite(values), values, np.nan), label=name.rpartition(" ")[2], **style)
    limits = sorted({round(result[name].limit.value * scale, 9) for name in names})
    for bound in limits:
        for side in (-bound, bound):
            panel.axhline(side, color=GREY, linewidth=1.0, linestyle="--" if worst.limit.trusted else ":")
    text = f"limit {limits[0]:.3g}{' ' * bool(unit)}{unit} ({worst.limit.trust}{'' if worst.limit.trusted else ', recalled'})"
    panel.annotate(text, (1.0, limits[0]), (0, 2), xycoords=("axes fraction", "data"), textcoords="offset points", ha="right", fontsize=8,
                   color="#555555")
    panel.margins(x=0.01)
    tidy(panel, "distance, m", f"{quantity}{', ' + unit if unit else ''}, 2 m mean")
    panel.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=7.5, frameon=False)
    return panel
