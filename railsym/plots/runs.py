# SPDX-License-Identifier: BSD-3-Clause
"""Channels of a run over time, and their spectra."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import GREY, line_styles, new_axes, tidy

_MOST_NAMED = 8


def plot_run(run, channels="*", *, axes=None, over="time"):
    """One panel a quantity (what stands behind the last dot, such as Q or ay) and unit; the legend names the channels.

    Parameters
    ----------
    run : railsym.Run
    channels : str or sequence of str
        Names or patterns.
    axes : array of matplotlib Axes, optional
        One a panel.
    over : str
        ``"time"`` or a channel, such as ``"s"``.

    Returns
    -------
    ndarray of matplotlib Axes, shape (panels,)
    """
    names = run.channels.require(*((channels,) if isinstance(channels, str) else channels))
    groups = {}
    for name in names:
        if name != over:
            groups.setdefault((name.rpartition(".")[2], run.unit(name)), []).append(name)
    panels = new_axes(axes, len(groups), size=(7.2, 1.2 + 1.9 * len(groups)), sharex=True)[:, 0]
    for panel, ((quantity, unit), group) in zip(panels, groups.items()):
        shown, factor = shown_unit(unit)
        _draw(panel, run[over], [factor * run[name] for name in group], group)
        tidy(panel, ylabel=f"{quantity}, {shown}" if shown else quantity)
    panels[-1].set_xlabel(f"{over}, {run.unit(over)}")
    title = " ".join(part for part in (run.info.vehicle, run.info.configuration) if part)
    panels[0].set_title(f"{title}: {run.info.ending}" if title else str(run.info.ending), loc="left", fontsize=10, pad=9)
    return panels


def unit_text(unit):
    """Unit as it is written on an axis; a pure number has none."""
    return "" if unit == "-" else unit.replace("^2", "²").replace("*", " ")


def shown_unit(unit):
    """Unit as it is shown over time, and the factor to it: forces in kN."""
    return ("k" + unit_text(unit), 1e-3) if unit in ("N", "N*m") else (unit_text(unit), 1.0)


def solid_styles(names):
    """As `line_styles`, but solid and without markers while the colours suffice: dashes of a dense vibration are hard to see."""
    styles = line_styles(names)
    plain = {"marker": None, "linewidth": 0.9}
    return {name: style | plain | ({"linestyle": "-"} if k < _MOST_NAMED else {}) for k, (name, style) in enumerate(styles.items())}


def _draw(panel, along, values, names):
    common = _common(names)
    for (name, style), array in zip(solid_styles(names).items(), values):
        panel.plot(along, array, label=name[len(common):], **style)
    panel.margins(x=0.01)
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
    """Amplitude over frequency up to the end of the band (or four times the dominant one), with the dominant frequency marked.

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
    whole = spectrum.band[1] > 0.99 * spectrum.frequency[-1]
    high = min(spectrum.frequency[-1], 4 * spectrum.dominant_hz) if whole and found else min(spectrum.frequency[-1], 1.1 * spectrum.band[1])
    unit = unit_text(spectrum.unit)
    panel.axvspan(*np.minimum(spectrum.band, high), color="#f2f2f2", zorder=0)
    panel.plot(spectrum.frequency, spectrum.amplitude, color="#0072B2", linewidth=1.2)
    panel.set_xlim(0.0, high)
    shown = spectrum.amplitude[spectrum.frequency <= high]
    panel.set_ylim(0.0, 1.08 * max(shown.max(), spectrum.dominant_amplitude if found else 0.0) or None)
    if found:
        panel.plot(spectrum.dominant_hz, spectrum.dominant_amplitude, "o", color="#D55E00", markersize=5)
        panel.annotate(f"{spectrum.dominant_hz:.2f} Hz, {spectrum.dominant_amplitude:.3g} {unit}",
                       (spectrum.dominant_hz, spectrum.dominant_amplitude), (7, -2), textcoords="offset points", fontsize=8.5, va="top")
        panel.axvline(spectrum.dominant_hz, color=GREY, linewidth=0.6, linestyle=":")
    tidy(panel, "frequency, Hz", f"amplitude, {unit}" if unit else "amplitude", spectrum.channel)
    return panel
