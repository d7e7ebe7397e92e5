# SPDX-License-Identifier: BSD-3-Clause
"""Channels of a run over time, and their spectra."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import GREY, line_styles, new_axes, tidy

_MOST_NAMED = 8


def plot_run(run, channels="*", *, axes=None, over="time"):
    """One panel a unit; the legend names the channels.

    Parameters
    ----------
    run : railsym.Run
    channels : str or sequence of str
        Names or patterns.
    axes : array of matplotlib Axes, optional
        One a unit.
    over : str
        ``"time"`` or a channel, such as ``"s"``.

    Returns
    -------
    ndarray of matplotlib Axes, shape (units,)
    """
    names = run.channels.require(*((channels,) if isinstance(channels, str) else channels))
    names = [name for name in names if name != over]
    units = list(dict.fromkeys(run.unit(name) for name in names))
    panels = new_axes(axes, len(units), size=(7.2, 1.2 + 2.0 * len(units)), sharex=True)[:, 0]
    for panel, unit in zip(panels, units):
        _draw(panel, run, [name for name in names if run.unit(name) == unit], over)
        tidy(panel, ylabel=unit)
    panels[-1].set_xlabel(f"{over}, {run.unit(over)}")
    title = " ".join(part for part in (run.info.vehicle, run.info.configuration) if part)
    panels[0].set_title(f"{title}: {run.info.ending}" if title else str(run.info.ending), loc="left", fontsize=10, pad=9)
    return panels


def _draw(panel, run, names, over):
    common = _common(names)
    for name, style in line_styles(names).items():
        panel.plot(run[over], run[name], label=name[len(common):], **(style | {"marker": None, "linewidth": 1.1}))
    panel.margins(x=0.01)
    if len(names) == 1:
        panel.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=7.5, frameon=False)
        return
    shown, labels = panel.get_legend_handles_labels()
    if len(names) > _MOST_NAMED:
        shown, labels = shown[:_MOST_NAMED], [*labels[:_MOST_NAMED - 1], f"{labels[_MOST_NAMED - 1]} and {len(names) - _MOST_NAMED} more"]
    panel.legend(shown, labels, title=common.rstrip(".") or None, loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=7.5, title_fontsize=7.5,
                 frameon=False, alignment="left")


def _common(names):
    """What all names begin with, up to a dot."""
    if len(names) < 2:
        return ""
    count = 0
    for letters in zip(*names):
        if len(set(letters)) > 1:
            break
        count += 1
    return names[0][:names[0][:count].rfind(".") + 1]


def plot_spectrum(spectrum, *, axes=None):
    """Amplitude over frequency up to four times the dominant one (or the whole band), with the dominant frequency marked.

    Parameters
    ----------
    spectrum : railsym.results.Spectrum
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    panel = new_axes(axes, size=(6.4, 3.4))[0, 0]
    found = np.isfinite(spectrum.dominant_hz)
    high = min(spectrum.frequency[-1], max(spectrum.band[1] if spectrum.band[1] < spectrum.frequency[-1] else 0.0,
                                           4 * spectrum.dominant_hz if found else spectrum.band[1]))
    panel.axvspan(*np.minimum(spectrum.band, high), color="#f2f2f2", zorder=0)
    panel.plot(spectrum.frequency, spectrum.amplitude, color="#0072B2", linewidth=1.2)
    panel.set_xlim(0.0, high)
    panel.set_ylim(0.0, None)
    if found:
        panel.plot(spectrum.dominant_hz, spectrum.dominant_amplitude, "o", color="#D55E00", markersize=5)
        panel.annotate(f"{spectrum.dominant_hz:.2f} Hz, {spectrum.dominant_amplitude:.3g} {spectrum.unit}",
                       (spectrum.dominant_hz, spectrum.dominant_amplitude), (7, -2), textcoords="offset points", fontsize=8.5, va="top")
        panel.axvline(spectrum.dominant_hz, color=GREY, linewidth=0.6, linestyle=":")
    tidy(panel, "frequency, Hz", f"amplitude, {spectrum.unit}", spectrum.channel)
    return panel
