# SPDX-License-Identifier: BSD-3-Clause
"""A track: curvature, cant and gradient over arc length, plan view, irregularities."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREEN, GREY, PALE, VERMILION, save, tidy

_POINTS = 2000
_DETAIL = 20000      # of irregularity: a long track shows its envelope
_MARKS = 8           # about so many places named in the plan view


def plot_track(track, *, path=None, title=None):
    """Draw a track.

    Parameters
    ----------
    track : railsym.track.Track
    path : path, optional
        Save the picture there.
    title : str, optional
        The track's name and length without it.

    Returns
    -------
    dict of str to matplotlib Axes
        curvature, cant, gradient, plan; and lateral (alignment, gauge), vertical (vertical, cant) where there are irregularities.
    """
    import matplotlib.pyplot as plt

    rough = bool(track.irregularities or track.switches)
    rows = [["curvature", "plan"], ["cant", "plan"], ["gradient", "plan"]]
    rows += [["lateral", "lateral"], ["vertical", "vertical"]] if rough else []
    heights = [1.0, 1.0, 0.8, 1.1, 1.1][:len(rows)]
    _, axes = plt.subplot_mosaic(rows, figsize=(11.0, 2.0 + 1.35 * sum(heights)), layout="constrained", height_ratios=heights, width_ratios=[1.25, 1.0])
    s = np.unique(np.concatenate([np.linspace(0.0, track.length, _POINTS), track.kinks[(track.kinks > 0) & (track.kinks < track.length)]]))
    _draw_geometry(axes, track, s)
    _draw_plan(axes["plan"], track, s)
    if rough:
        _draw_rails(axes, track)
    figure = axes["plan"].figure
    figure.suptitle(title or f"{track.name}, {track.length:.6g} m", fontsize=11, x=0.01, ha="left")
    if path is not None:
        save(axes["plan"], path)
    return axes


def _draw_geometry(axes, track, s):
    quantities = (("curvature", 1e3 * track.curvature(s), "1/km", "curvature, + to the right"), ("cant", 1e3 * track.cant(s), "mm", "cant, + left rail higher"),
                  ("gradient", 1e3 * track.gradient(s), "per mille", "gradient, + uphill"))
    for name, values, unit, label in quantities:
        panel = axes[name]
        for kink in track.kinks[(track.kinks >= 0.0) & (len(track.kinks) <= 60)]:
            panel.axvline(kink, color=PALE, linewidth=0.7, zorder=1)
        panel.plot(s, values, color=BLACK, linewidth=1.5)
        panel.set_xlim(0.0, track.length)
        low, high = min(values.min(), 0.0), max(values.max(), 0.0)
        if low == high:
            panel.set_yticks([0.0])
        room = 0.1 * (high - low) or 1.0
        panel.set_ylim(low - room, high + room)
        tidy(panel, "s, m" if name == "gradient" else "", unit, label)
    for name in ("curvature", "cant"):
        axes[name].tick_params(labelbottom=False)


def _draw_plan(axes, track, s):
    """Seen from above, travel to the right: y grows downwards on the page, as to the right of the track."""
    place = track.frame(s).place
    axes.plot(place[:, 0], place[:, 1], color=BLUE, linewidth=1.8)
    step = track.length / _MARKS
    step = min((f * 10.0 ** np.floor(np.log10(step)) for f in (1, 2, 5, 10)), key=lambda one: abs(one - step))
    marks = np.arange(0.0, track.length + 1e-9, step)
    at = track.frame(marks)
    axes.plot(at.place[:, 0], at.place[:, 1], "o", color=BLUE, markersize=3.5)
    for mark, (x, y, _), across in zip(marks, at.place, at.attitude[:, :2, 1], strict=True):
        across = across / np.hypot(*across)
        axes.annotate(f"{mark:g}", (x, y), (-9 * across[0], 9 * across[1]), textcoords="offset points", fontsize=7, color=GREY, ha="center", va="center")
    axes.invert_yaxis()
    axes.margins(0.06, 0.12)
    axes.set_aspect("equal", adjustable="datalim")
    tidy(axes, "x, m", "y, m (to the right)", "plan view, s in m")


def _draw_rails(axes, track):
    s = np.linspace(0.0, track.length, min(_DETAIL, max(_POINTS, int(10 * track.length))))
    rails = track.rails(s)
    panels = {"lateral": (("alignment, + to the right", rails.alignment, BLUE), ("gauge, + wider", rails.gauge, VERMILION)),
              "vertical": (("vertical, + down", rails.vertical, GREEN), ("cant, + left rail higher", rails.cant, BLACK))}
    for name, signals in panels.items():
        for label, values, colour in signals:
            axes[name].plot(s, 1e3 * values, color=colour, linewidth=0.9, label=label)
        axes[name].set_xlim(0.0, track.length)
        axes[name].legend(fontsize=8, frameon=False, ncols=2, loc="upper right", bbox_to_anchor=(1.0, 1.22))
        tidy(axes[name], "s, m" if name == "vertical" else "", "mm", f"irregularity, {name}")
    axes["lateral"].tick_params(labelbottom=False)
