# SPDX-License-Identifier: BSD-3-Clause
"""The bifurcation diagram: amplitude of limit cycles over speed."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREEN, GREY, KMH, ORANGE, VERMILION, new_axes, tidy


def plot_bifurcation(found, axes=None):
    """Draw amplitudes of the wheelset that moves most over speed.

    Stable orbits are full lines, unstable ones dashed; folds are diamonds, Hopf points circles; ramps are triangles in the direction of
    the ramp, hollow where the motion did not settle.

    Parameters
    ----------
    found : railsym.nonlinear.Bifurcation
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(7.2, 4.4))[0, 0]
    _rest(axes, found)
    named = set()
    for branch in found.branches:
        _branch(axes, branch, named)
    for one, marker, colour, name in ((found.descending, "<", ORANGE, "descending ramp"), (found.ascending, ">", GREEN, "ascending ramp")):
        if one is not None:
            _ramp(axes, one, marker, colour, name)
    for point in found.hopf:
        axes.plot(KMH * point.speed, 0.0, "o", color=BLACK, markersize=6, zorder=5, label=_once(named, "Hopf point"))
    axes.set_xlim(KMH * found.speeds[0], KMH * found.speeds[1])
    axes.set_ylim(bottom=0.0)
    tidy(axes, "speed, km/h", "amplitude of the largest lateral displacement, mm", f"{found.vehicle}, {found.law}: limit cycles")
    axes.legend(frameon=False, fontsize=8, loc="best")
    return axes


def _rest(axes, found):
    """The line of steady rolling, by its stability."""
    edges = [found.speeds[0], *(h.speed for h in found.hopf), found.speeds[1]]
    stable = found.stable_below
    for low, high in zip(edges, edges[1:]):
        axes.plot([KMH * low, KMH * high], [0.0, 0.0], color=BLACK, linewidth=2.0, linestyle="-" if stable else (0, (3, 2)), clip_on=False)
        stable = not stable


def _branch(axes, branch, named):
    speed, amplitude, stable = KMH * branch.speed, 1e3 * branch.amplitude, branch.stable
    changes = np.flatnonzero(stable[1:] != stable[:-1]) + 1
    for part in np.split(np.arange(len(speed)), changes):
        part = np.append(part, part[-1] + 1) if part[-1] + 1 < len(speed) else part
        kept = bool(stable[part[0]])
        axes.plot(speed[part], amplitude[part], color=BLUE if kept else VERMILION, linewidth=1.6, linestyle="-" if kept else (0, (4, 2)),
                  label=_once(named, "stable limit cycle" if kept else "unstable limit cycle"))
    for fold in branch.folds:
        axes.plot(KMH * fold.speed, 1e3 * fold.amplitude.max(), "D", color=BLACK, markersize=4.5, zorder=5, label=_once(named, "fold"))


def _ramp(axes, one, marker, colour, name):
    moving = one.largest > 0.0
    for kept, face in ((one.settled & moving, colour), (~one.settled & moving, "none"), (~moving, colour)):
        axes.plot(KMH * one.speed[kept], 1e3 * one.largest[kept], marker, color=colour, markerfacecolor=face, markersize=5, linestyle="none",
                  clip_on=False, label=name if face == colour and kept is not None and (kept == (one.settled & moving)).all() else None)
    if len(one.failures):
        axes.plot([KMH * speed for speed, _ in one.failures], np.zeros(len(one.failures)), "x", color=GREY, markersize=5, clip_on=False)


def _once(named, text):
    """A label for the legend the first time, None after it."""
    if text in named:
        return None
    named.add(text)
    return text
