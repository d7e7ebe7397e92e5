# SPDX-License-Identifier: BSD-3-Clause
"""Which parameters matter: bars of the sensitivities of a critical speed, and maps over parameters."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, KMH, VERMILION, criterion_text, new_axes, tidy

_DECADES = 20.0      # range of a parameter that is shown on a logarithmic axis


def plot_sensitivities(result, *, count=15, axes=None):
    """Bars: change of the critical speed for 1 % more of each of the most influential parameters.

    Parameters
    ----------
    result : railsym.sensitivity.Sensitivities
    count : int
        How many parameters.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
        The strongest on top. Coordinates of places change by 1 cm in place of 1 %.
    """
    count = min(count, len(result))
    axes = new_axes(axes, size=(8.4, 1.4 + 0.3 * count))[0, 0]
    value = result.speed_elasticity[:count]
    place = np.arange(count)
    axes.barh(place, value, height=0.7, color=[BLUE if v > 0 else VERMILION for v in value])
    axes.plot(result.frequency_elasticity[:count], place, "D", color=BLACK, markersize=4, linestyle="none",
              label="change of frequency, %")
    axes.set_yticks(place, [_shown_parameter(result, k) for k in range(count)], fontsize=8)
    axes.axvline(0.0, color="black", linewidth=0.8)
    at = result.crossing
    tidy(axes, "change of critical speed, % for 1 % (places: 1 cm)", "",
         f"{KMH * at.speed:.0f} km/h, {at.frequency_hz:.2f} Hz, {criterion_text(at.criterion)}")
    axes.set_ylim(count - 0.4, -0.6)
    axes.grid(False, axis="y")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), fontsize=8, frameon=False)
    return axes


def _shown_parameter(result, k):
    """Name and value, 1 cm for places."""
    value, unit = result.values[k], result.units[k]
    return f"{result.names[k]}  ({value:.4g}{'' if unit == '-' else ' ' + unit})"


def plot_parameter_map(result, *, axes=None):
    """Critical speed over one parameter (a line) or two (filled contours).

    Parameters
    ----------
    result : railsym.stability_map.ParameterMap
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(6.6, 4.4))[0, 0]
    names = [name if unit == "-" else f"{name}, {unit}" for name, unit in zip(result.parameters, result.units)]
    speed = KMH * result.speed
    for values, scale in zip(result.values, (axes.set_xscale, axes.set_yscale)):
        if values.min() > 0 and values.max() / values.min() > _DECADES:
            scale("log")
    title = criterion_text(result.damping_ratio)
    if len(names) == 1:
        axes.plot(result.values[0], speed.filled(np.nan), color=BLUE, marker="o", markersize=4)
        tidy(axes, names[0], "critical speed, km/h", title)
        return axes
    filled = axes.contourf(result.values[0], result.values[1], speed.T, levels=12, cmap="viridis")
    lines = axes.contour(result.values[0], result.values[1], speed.T, levels=filled.levels, colors="white", linewidths=0.6)
    axes.clabel(lines, fmt="%.0f", fontsize=8)
    axes.figure.colorbar(filled, ax=axes, label="critical speed, km/h")
    axes.set_facecolor("#eeeeee")
    tidy(axes, *names, title)
    axes.grid(False)
    return axes
