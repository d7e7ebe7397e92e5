# SPDX-License-Identifier: BSD-3-Clause
"""A switch study: accelerations above the axlebox over time and their spectra, as figures 17 and 18 of the paper."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, GREEN, GREY, KMH, ORANGE, PALE, VERMILION, new_axes, tidy

_HIGHEST = 12.0       # Hz, shown of the spectra


def plot_switch_study(study, *, axes=None):
    """A row a speed: acceleration above the worst axlebox with the limit, and the spectrum behind the switch with the linear mode.

    Parameters
    ----------
    study : railsym.studies.SwitchStudy
    axes : array of matplotlib Axes, optional
        Two a run: time, spectrum.

    Returns
    -------
    ndarray of matplotlib Axes, shape (runs, 2)
    """
    runs = list(zip(study.runs, study.modes))
    panels = new_axes(axes, len(runs), 2, size=(10.0, 0.9 + 2.05 * len(runs)), gridspec_kw={"width_ratios": [2.1, 1.0]})
    drawn = [(row, run, mode) for row, (run, mode) in zip(panels, runs) if run.verdict is not None]
    top = 1.1 * max((max(box.peak for box in run.verdict.axleboxes) for _, run, _ in drawn), default=8.0)
    for (time, spectrum), run, mode in drawn:
        _accelerations(time, run, top)
        _spectrum(spectrum, run, mode, study)
    _same_scale([row[1] for row, _, _ in drawn])
    panels[-1, 0].set_xlabel("time, s")
    panels[-1, 1].set_xlabel("frequency, Hz")
    if axes is None:
        from railsym.studies.switch_report import heading, switch_text

        panels[0, 0].figure.suptitle(f"{heading(study)}; switch: {switch_text(study.switch)} (assumed); V0 = {KMH * study.reference:.1f} km/h",
                                     fontsize=10, x=0.01, ha="left")
    return panels


def _accelerations(axes, run, top):
    worst = run.worst
    bound, colour = run.verdict.limit.value, VERMILION if worst.unstable else BLUE
    axes.plot(run.run.time, run.run[worst.channel], color=PALE, linewidth=0.6, label="as recorded")
    axes.plot(run.verdict.run_time, run.verdict.filtered[worst.channel], color=colour, linewidth=0.9,
              label=f"{run.verdict.band[0]:g} to {run.verdict.band[1]:g} Hz")
    for side in (-bound, bound):
        axes.axhline(side, color=GREY, linewidth=0.9, linestyle="--")
    if worst.unstable:
        axes.axvspan(worst.time, worst.detected, color=VERMILION, alpha=0.12, linewidth=0)
    axes.set_ylim(-1.25 * top, 1.25 * top)
    axes.margins(x=0.0)
    from railsym.studies.switch_report import WORDS, ratio_text

    tidy(axes, ylabel="m/s²", title=f"{ratio_text(run.ratio)} V0, {KMH * run.speed:.1f} km/h: {WORDS[run.unstable]}, {run.fate}; {worst.channel.removesuffix('.ay')}")
    axes.legend(loc="lower right", ncols=2, fontsize=7, frameon=False, borderaxespad=0.1)


def _spectrum(axes, run, mode, study):
    if not np.isfinite(run.frequency_hz):
        axes.set_visible(False)
        return
    found = run.spectrum()
    shown = found.frequency <= _HIGHEST
    axes.plot(found.frequency[shown], found.amplitude[shown], color=BLUE, linewidth=1.1)
    axes.plot(run.frequency_hz, run.amplitude, "o", color=VERMILION, markersize=4.5, label=f"{run.frequency_hz:.2f} Hz")
    if mode is not None:
        axes.axvline(mode.frequency_hz, color=GREEN, linewidth=1.1, linestyle="--",
                     label=f"mode at {1e3 * run.mean_motion:.1f} mm: {mode.frequency_hz:.2f} Hz")
    axes.axvline(study.frequency_hz, color=ORANGE, linewidth=1.1, linestyle=":", label=f"mode at V0: {study.frequency_hz:.2f} Hz")
    axes.set_xlim(0.0, _HIGHEST)
    tidy(axes, ylabel="amplitude, m/s²", title="spectrum behind the switch")
    axes.legend(loc="upper left", fontsize=7, framealpha=0.85, edgecolor="none", borderaxespad=0.1)


def _same_scale(axes):
    top = max((a.get_ylim()[1] for a in axes if a.get_visible()), default=1.0)
    for panel in axes:
        panel.set_ylim(0.0, 1.6 * top)


def plot_quasi_linear(study, *, axes=None):
    """Amplitude of hunting over speed: quasi-linear theory as lines, what the runs end with as points.

    Parameters
    ----------
    study : railsym.studies.SwitchStudy
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    panel = new_axes(axes, size=(6.4, 3.8))[0, 0]
    for found, colour, dashes, label in ((study.rigid, ORANGE, "--", "quasi-linear, rigid contact"),
                                         (study.elastic, GREEN, "-", f"quasi-linear, elastic contact ({study.load / 1e3:.0f} kN)")):
        panel.plot(found["speed"] / study.reference, 1e3 * found["amplitude"], color=colour, linestyle=dashes, linewidth=1.5, label=label)
    for marker, unstable, colour in (("o", False, BLUE), ("s", True, VERMILION)):
        chosen = [run for run in study.runs if run.unstable is unstable and np.isfinite(run.late_motion)]
        if chosen:
            panel.plot([run.ratio for run in chosen], [1e3 * run.late_motion for run in chosen], marker, color=colour, linestyle="none",
                       label=f"runs, {'un' * unstable}stable by the criterion")
    panel.axvline(1.0, color=GREY, linewidth=0.8, linestyle=":")
    panel.set_ylim(bottom=0.0)
    tidy(panel, "V/V0", "lateral amplitude of a wheelset, mm", "what is left of the motion at the end of a run")
    panel.legend(fontsize=8, frameon=False, loc="upper left")
    return panel
