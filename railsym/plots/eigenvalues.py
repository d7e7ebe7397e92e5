# SPDX-License-Identifier: BSD-3-Clause
"""Eigenvalues in the complex plane, and damping and frequency of the modes followed over speed."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, GREY, KMH, PALE, VERMILION, label_line_ends, line_styles, new_axes, tidy

_RATIOS = (0.05, 0.1, 0.2, 0.3)      # rays of constant damping ratio
_TWO_PI = 2.0 * np.pi


def plot_root_locus(tracked, *, frequency_range=(0.0, 12.0), damping_ratio_limit=0.3, label_count=9, axes=None):
    """Eigenvalues of the followed modes in the complex plane, coloured by speed.

    Parameters
    ----------
    tracked : railsym.tracking.TrackedModes
    frequency_range : (float, float)
        Hz, of the vertical axis.
    damping_ratio_limit : float
        Modes that are damped more strongly at every speed are left out.
    label_count : int
        How many of the least damped modes are named.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
        Real part in 1/s, frequency (imaginary part over 2 pi) in Hz.
    """
    axes = new_axes(axes, size=(8.2, 5.4))[0, 0]
    speed, value = np.asarray(tracked.speed), np.asarray(tracked.eigenvalue)
    chosen = shown_modes(value, frequency_range, damping_ratio_limit)
    points = None
    for k in chosen:
        axes.plot(value[:, k].real, value[:, k].imag / _TWO_PI, color=PALE, linewidth=1.0, zorder=2)
        points = axes.scatter(value[:, k].real, value[:, k].imag / _TWO_PI, c=KMH * speed, cmap="viridis", s=13, zorder=3,
                              vmin=KMH * speed.min(), vmax=KMH * speed.max())
    _limits(axes, value[:, chosen], frequency_range, damping_ratio_limit)
    draw_damping_lines(axes)
    tidy(axes, "real part, 1/s", "frequency, Hz")
    if points is not None:
        axes.figure.colorbar(points, ax=axes, label="speed, km/h", pad=0.02)
    _name_modes(axes, value, tracked.label, chosen[:label_count])
    return axes


def plot_eigenvalues(modes, *, frequency_range=(0.0, 12.0), damping_ratio_limit=0.4, label_count=9, axes=None):
    """Eigenvalues at one speed in the complex plane.

    Parameters
    ----------
    modes : railsym.modes.Modes
    frequency_range, damping_ratio_limit, label_count, axes
        As in `plot_root_locus`.

    Returns
    -------
    matplotlib Axes
    """
    axes = new_axes(axes, size=(7.6, 5.0))[0, 0]
    value = modes.eigenvalue[None, :]
    chosen = shown_modes(value, frequency_range, damping_ratio_limit)
    real, frequency = value[0, chosen].real, value[0, chosen].imag / _TWO_PI
    axes.scatter(real, frequency, s=26, color=[VERMILION if x > 0 else BLUE for x in real], zorder=3)
    _limits(axes, value[:, chosen], frequency_range, damping_ratio_limit)
    draw_damping_lines(axes)
    tidy(axes, "real part, 1/s", "frequency, Hz", f"eigenvalues at {KMH * modes.speed:.4g} km/h")
    _name_modes(axes, value, modes.label, chosen[:label_count])
    return axes


def plot_damping(tracked, *, frequency_range=(0.2, 12.0), damping_ratio_limit=0.3, count=8, axes=None):
    """Damping ratio (left) and frequency (right) of the least damped modes over speed.

    Parameters
    ----------
    tracked : railsym.tracking.TrackedModes
    frequency_range : (float, float)
        Hz; modes outside at every speed are left out.
    damping_ratio_limit : float
        Upper end of the damping axis; modes above it at every speed are left out.
    count : int
        How many of the least damped modes are drawn.
    axes : two matplotlib Axes, optional

    Returns
    -------
    ndarray of matplotlib Axes, shape (2,)
    """
    panels = new_axes(axes, 1, 2, (11.0, 4.4))[0]
    value = np.asarray(tracked.eigenvalue)
    chosen = shown_modes(value, frequency_range, damping_ratio_limit)[:count]
    names = [f"{tracked.label[k]}, {k}" for k in chosen]
    speed, styles = KMH * np.asarray(tracked.speed), line_styles(names)
    for name, k in zip(names, chosen):
        style = styles[name] | {"marker": "", "label": tracked.label[k]}
        panels[0].plot(speed, 100.0 * tracked.damping_ratio[:, k], **style)
        panels[1].plot(speed, tracked.frequency_hz[:, k], **style)
    low = 100.0 * min(0.0, tracked.damping_ratio[:, chosen].min(initial=0.0))
    panels[0].set_ylim(max(1.1 * low, -30.0) - 0.5, 100.0 * damping_ratio_limit)
    panels[0].axhspan(panels[0].get_ylim()[0], 0.0, color=VERMILION, alpha=0.07, linewidth=0.0)
    panels[0].axhline(0.0, color="black", linewidth=1.2)
    panels[0].text(0.01, 0.02, "unstable", transform=panels[0].transAxes, color=VERMILION, fontsize=8)
    panels[1].set_ylim(0.0, frequency_range[1])
    tidy(panels[0], "speed, km/h", "damping ratio, %")
    tidy(panels[1], "speed, km/h", "frequency, Hz")
    if axes is None:
        handles, labels = panels[0].get_legend_handles_labels()
        panels[0].figure.legend(handles, labels, loc="outside lower center", ncols=min(3, max(1, len(labels))), frameon=False,
                                fontsize=8.5, handlelength=3.2)
    return panels


def shown_modes(value, frequency_range, damping_ratio_limit):
    """Columns of eigenvalues (k, m) within the ranges at some speed, the least damped first; one of each conjugate pair."""
    size = np.where(np.abs(value) > 0, np.abs(value), np.inf)
    ratio, frequency = -value.real / size, value.imag / _TWO_PI
    inside = (ratio < damping_ratio_limit) & (frequency > max(frequency_range[0], 1e-3)) & (frequency < frequency_range[1])
    found = np.flatnonzero(inside.any(axis=0))
    least = np.where(inside, ratio, np.inf).min(axis=0)
    return found[np.argsort(least[found], kind="stable")]


def draw_damping_lines(axes, ratios=_RATIOS):
    """The stability boundary and rays of constant damping ratio, in the axes' present limits."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    axes.axvline(0.0, color="black", linewidth=1.2, zorder=2)
    axes.axvspan(0.0, right, color=VERMILION, alpha=0.07, linewidth=0.0, zorder=0)
    axes.annotate("unstable", (right, top), (0, 4), textcoords="offset points", fontsize=8, color=VERMILION, ha="right",
                  annotation_clip=False)
    for ratio in ratios:
        slope = -_TWO_PI * ratio / np.sqrt(1.0 - ratio**2)          # real part in 1/s of 1 Hz
        axes.plot([0.0, slope * top], [0.0, top], color=GREY, linewidth=0.8, linestyle=":", zorder=1)
        at = min(top, left / slope)
        if at > bottom:
            axes.annotate(f"{100 * ratio:g} %", (slope * at, at), (1, 2), textcoords="offset points", fontsize=7.5, color=GREY,
                          annotation_clip=False)
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)


def _limits(axes, value, frequency_range, damping_ratio_limit):
    frequency = value.imag / _TWO_PI
    inside = value.real[(frequency <= frequency_range[1]) & (-value.real <= 1.3 * damping_ratio_limit * np.abs(value))]
    low, high = (inside.min(), inside.max()) if inside.size else (-1.0, 0.0)
    margin = 0.05 * max(high - low, 1.0)
    axes.set_xlim(low - margin, max(high, 0.0) + 6.0 * margin)     # room for names
    axes.set_ylim(*frequency_range)


def _name_modes(axes, value, names, chosen):
    """Name each mode beside its least damped point in view; one name for equal names at nearly one place."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    ends = []
    for k in chosen:
        path = value[:, k]
        seen = path[(path.real > left) & (path.imag > _TWO_PI * bottom) & (path.imag < _TWO_PI * top)]
        if not seen.size:
            continue
        at = seen[np.argmax(seen.real)]
        x, y = at.real, at.imag / _TWO_PI
        if not any(text == names[k] and abs(x - a) < 0.03 * (right - left) and abs(y - b) < 0.03 * (top - bottom)
                   for a, b, text, _ in ends):
            ends.append((x, y, names[k], "#303030"))
    label_line_ends(axes, ends, fontsize=8)
