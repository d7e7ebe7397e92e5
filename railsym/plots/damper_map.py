# SPDX-License-Identifier: BSD-3-Clause
"""Maps of a damper on the virtual bench: dynamic stiffness and phase over frequency and amplitude."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import new_axes, tidy

FREQUENCY, AMPLITUDE = (0.2, 10.0), (0.2e-3, 10e-3)     # Hz, m: ranges of a map
FASTEST = 0.3                                           # m/s of the ends: beyond it no bench tests a yaw damper
_POINTS = 25


def plot_damper_map(model, *, frequency=FREQUENCY, amplitude=AMPLITUDE, fastest=FASTEST, records=(), axes=None):
    """Magnitude and phase of the dynamic stiffness as two contour maps.

    Parameters
    ----------
    model : DamperModel
    frequency, amplitude : (float, float)
        Range, Hz and m; both axes are logarithmic.
    fastest : float
        m/s: faster points (2 pi frequency amplitude) are left white.
    records : sequence of CleanRecord
        Their places are marked: away from them the map is extrapolated.
    axes : sequence of two matplotlib Axes, optional

    Returns
    -------
    ndarray of matplotlib Axes (1, 2)
    """
    from matplotlib.patheffects import withStroke

    from railsym.dampers.bench import sweep

    axes = new_axes(axes, 1, 2, size=(10.4, 4.2))
    found = sweep(model, np.geomspace(*frequency, _POINTS), np.geomspace(*amplitude, _POINTS))
    outside = 2.0 * np.pi * found.frequencies[:, None] * found.amplitudes > fastest
    for place, values, title, unit in ((axes[0, 0], 1e-6 * np.abs(found.dynamic_stiffness), "Dynamic stiffness, kN/mm", "%.3g"),
                                       (axes[0, 1], np.degrees(found.phase), "Phase of the force before the displacement, degrees", "%.0f")):
        shown = np.ma.array(values, mask=outside)
        filled = place.contourf(found.frequencies, 1e3 * found.amplitudes, shown.T, levels=12, cmap="cividis")
        lines = place.contour(found.frequencies, 1e3 * found.amplitudes, shown.T, levels=filled.levels[::2], colors="white", linewidths=0.6)
        for number in place.clabel(lines, fmt=unit, fontsize=8):
            number.set_path_effects([withStroke(linewidth=1.5, foreground="0.25")])         # white on yellow cannot be read
        if records:
            place.plot([one.frequency for one in records], [1e3 * one.amplitude for one in records], "o", markerfacecolor="none",
                       markeredgecolor="black", markersize=5, label="tests")
            place.legend(fontsize=8, frameon=False, loc="upper right")
        place.set_xscale("log")
        place.set_yscale("log")
        tidy(place, "frequency, Hz", "amplitude, mm", title)
        place.set_xticks([0.2, 0.5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
        place.set_yticks([0.2, 0.5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
    return axes
