# SPDX-License-Identifier: BSD-3-Clause
"""Critical speed and frequency of the unstable mode against conicity, configuration by configuration."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import KMH, criterion_text, line_styles, new_axes, tidy

_WIDTH = 3.5                      # inches, of a panel
_OTHER_MODE = 1.42                # ratio of neighbouring frequencies, just above the root of 2
_CONICITY, _FREQUENCY = "equivalent conicity", "frequency of unstable mode, Hz"
_MOST_NAMED = 7                   # amplitudes with their conicity at the ticks: more would overlap


def plot_critical_speed(result, *, label=None, axes=None):
    """Critical speed against conicity of one vehicle by one criterion.

    Parameters
    ----------
    result : railsym.critical_speed.CriticalSpeeds
    label : str, optional
        Name of the line; the vehicle's configuration if not given.
    axes : matplotlib Axes, optional

    Returns
    -------
    matplotlib Axes
    """
    panels = new_axes(axes, size=(5.6, 4.0))
    name = label or getattr(result.vehicle, "configuration", None) or getattr(result.vehicle, "name", "vehicle")
    _draw_speeds(panels[0, 0], {name: result})
    _from_zero(panels)
    if axes is None:
        _legend(panels, [result])
    return panels[0, 0]


def plot_stability_map(result, *, axes=None):
    """Critical speed against conicity: a panel a criterion, a line a configuration.

    Parameters
    ----------
    result : railsym.stability_map.StabilityMap
    axes : array of matplotlib Axes, optional
        One a criterion.

    Returns
    -------
    ndarray of matplotlib Axes, shape (criteria,)
    """
    panels = _row(axes, 1, result, sharey=True)
    for column, panel in enumerate(panels[0]):
        _draw_speeds(panel, by_configuration(result, column))
    _from_zero(panels)
    return _finished(axes, panels, result)[0]


def plot_frequency(result, *, axes=None):
    """Frequency of the unstable mode against conicity (upper row) and against critical speed (lower row).

    Parameters
    ----------
    result : railsym.stability_map.StabilityMap
    axes : array of matplotlib Axes, optional
        Two a criterion, row by row.

    Returns
    -------
    ndarray of matplotlib Axes, shape (2, criteria)
    """
    panels = _row(axes, 2, result, sharey=True)
    for column in range(panels.shape[1]):
        cases = by_configuration(result, column)
        _draw_frequency(panels[0, column], cases)
        _draw_frequency_over_speed(panels[1, column], cases)
    _from_zero(panels)
    _share_speed(panels[1])
    return _finished(axes, panels, result, marked=False)


def plot_change(result, *, axes=None):
    """Change of the critical speed against the first configuration, per cent: a panel a criterion, a line a configuration.

    Parameters
    ----------
    result : railsym.stability_map.StabilityMap
    axes : array of matplotlib Axes, optional
        One a criterion.

    Returns
    -------
    ndarray of matplotlib Axes, shape (criteria,)
    """
    panels = _row(axes, 1, result, sharey=True)
    for column, panel in enumerate(panels[0]):
        _draw_change(panel, result, column)
    return _finished(axes, panels, result, marked=False)[0]


def plot_stability_report(result):
    """One page: critical speed, frequency against conicity and speed, and change by configuration; a column a criterion.

    Parameters
    ----------
    result : railsym.stability_map.StabilityMap

    Returns
    -------
    ndarray of matplotlib Axes, shape (rows, criteria)
        Four rows, three without the change where there is one configuration only.
    """
    rows = 4 if len(result.configurations) > 1 else 3
    panels = _row(None, rows, result, sharey="row", height=3.0 if result.results[0][0].pair else 2.7)
    panels[0, 0].figure.suptitle(result.results[0][0].pair, fontsize=10)
    for column in range(panels.shape[1]):
        cases = by_configuration(result, column)
        _draw_speeds(panels[0, column], cases)
        _draw_frequency(panels[1, column], cases)
        _draw_frequency_over_speed(panels[2, column], cases)
        if rows == 4:
            _draw_change(panels[3, column], result, column)
    _from_zero(panels[:3])
    _share_speed(panels[2])
    for panel in panels[1:].ravel():
        panel.set_title("", loc="left")
    return _finished(None, panels, result)


def by_configuration(result, column):
    """Configuration -> CriticalSpeeds of one criterion (by its place) of a StabilityMap."""
    return {name: row[column] for name, row in zip(result.configurations, result.results)}


def _row(axes, rows, result, height=3.3, **options):
    columns = len(result.damping_ratios)
    extra = 0.9 if len(result.configurations) > 4 else 0.6
    return new_axes(axes, rows, columns, (max(_WIDTH * columns, 5.6), height * rows + extra), **options)


def _draw_speeds(axes, cases):
    styles = line_styles(tuple(cases))
    for name, result in cases.items():
        at = _across(result)
        axes.plot(*_one_mode(at, KMH * result.speed, result), label=name, **styles[name])
        _mark_missing(axes, at, result, styles[name])
        _mark_ranges(axes, at, result, styles[name])
    tidy(axes, "", "critical speed, km/h", criterion_text(_ratio(cases)))
    _name_across(axes, result)


def _across(result):
    """What the horizontal axis shows: conicities, or amplitudes (mm) of a pair of profiles."""
    return np.atleast_1d(result.conicity) if result.amplitude is None else 1e3 * np.atleast_1d(result.amplitude)


def _name_across(axes, result):
    """Name of the horizontal axis; each amplitude of a pair with its conicity where there is room."""
    if result.amplitude is None:
        axes.set_xlabel(_CONICITY)
        return
    amplitude, named = _across(result), len(result.amplitude) <= _MOST_NAMED
    axes.set_xlabel("amplitude, mm; below: conicity" if named else "lateral amplitude, mm")
    if named:
        axes.set_xticks(amplitude, [f"{a:.3g}\n{c:#.3g}" for a, c in zip(amplitude, result.conicity)])


def _draw_frequency(axes, cases):
    styles = line_styles(tuple(cases))
    for name, result in cases.items():
        axes.plot(*_one_mode(_across(result), result.frequency_hz, result), label=name, **styles[name])
    tidy(axes, "", _FREQUENCY, criterion_text(_ratio(cases)))
    _name_across(axes, result)


def _draw_frequency_over_speed(axes, cases):
    styles = line_styles(tuple(cases))
    for name, result in cases.items():
        axes.plot(*_one_mode(KMH * result.speed, result.frequency_hz, result), label=name, **styles[name])
    tidy(axes, "critical speed, km/h", _FREQUENCY, criterion_text(_ratio(cases)))


def _one_mode(x, y, result):
    """x and y with a gap where another mode takes over; for plotting.

    Hunting's frequency grows with the root of conicity (Klingel): a jump beyond that of a doubled conicity is another mode.
    """
    x, y, frequency = (np.ma.atleast_1d(np.ma.asarray(v, dtype=float)).filled(np.nan) for v in (x, y, result.frequency_hz))
    ratio = np.maximum(frequency[1:] / frequency[:-1], frequency[:-1] / frequency[1:])
    gaps = np.flatnonzero(ratio > _OTHER_MODE) + 1
    return np.insert(x, gaps, np.nan), np.insert(y, gaps, np.nan)


def _draw_change(axes, result, column):
    styles = line_styles(result.configurations)
    for (name, case), change in zip(by_configuration(result, column).items(), result.change[:, column]):
        axes.plot(*_one_mode(_across(case), change, case), label=name, **styles[name])
    axes.axhline(0.0, color="black", linewidth=0.8, zorder=1)
    tidy(axes, "", f"change against {result.configurations[0]}, %", criterion_text(result.damping_ratios[column]))
    _name_across(axes, case)


def _from_zero(panels):
    """Vertical axes from 0, once everything is drawn: shared limits would stop growing."""
    for panel in panels.ravel():
        panel.set_ylim(bottom=0.0)


def _share_speed(panels):
    """One range of speeds, from 0, for panels side by side."""
    high = max(panel.get_xlim()[1] for panel in panels)
    for panel in panels:
        panel.set_xlim(0.0, high)


def _ratio(cases):
    return next(iter(cases.values())).damping_ratio


def always_stable(message):
    """Does the message of a case without critical speed say that nothing becomes unstable?"""
    return message.startswith("no mode becomes")


def _mark_missing(axes, conicity, result, style):
    """A mark at the upper edge where no speed in the range is critical, at the lower edge where all are."""
    missing = np.ma.getmaskarray(np.ma.atleast_1d(result.speed))
    for at, message in zip(conicity[missing], np.array(result.message, dtype=object)[missing]):
        stable = always_stable(message)
        axes.plot(at, 1.0 if stable else 0.0, marker="^" if stable else "v", color=style["color"], markersize=7, clip_on=False,
                  markerfacecolor="white", transform=axes.get_xaxis_transform(), linestyle="none", zorder=5)


def _mark_ranges(axes, conicity, result, style):
    """A bar over each range of speeds beyond the criterion that ends again, an open mark where the next one begins."""
    for at, crossings in zip(conicity, result.crossings):
        start = None
        for number, crossing in enumerate(crossings):
            if crossing.direction > 0 and start is None:
                start = crossing.speed
                if number:
                    axes.plot(at, KMH * start, color=style["color"], marker=style["marker"], markersize=5, markerfacecolor="white",
                              linestyle="none", zorder=4)
            elif crossing.direction < 0:
                low = KMH * (result.speed_range[0] if start is None else start)
                axes.plot([at, at], [low, KMH * crossing.speed], color=style["color"], linewidth=5.0, alpha=0.3,
                          solid_capstyle="butt", zorder=1)
                start = None


def _notes(results):
    """What the marks in the drawing mean, where there are any."""
    missing = [m for r in results for m, masked in zip(r.message, np.ma.getmaskarray(np.ma.atleast_1d(r.speed))) if masked]
    low, high = (KMH * speed for speed in results[0].speed_range)
    notes = []
    if any(always_stable(m) for m in missing):
        notes.append(f"△ at the upper edge: no critical speed up to {high:.0f} km/h")
    if not all(always_stable(m) for m in missing):
        notes.append(f"▽ at the lower edge: beyond the criterion already at {low:.0f} km/h")
    if any(c.direction < 0 for r in results for crossings in r.crossings for c in crossings):
        notes.append("broad bar: beyond the criterion up to its end, and again from the open mark")
    return "     ".join(notes)


def _finished(axes, panels, result, marked=True):
    if axes is None:
        for panel in panels[:, 1:].ravel():
            panel.set_ylabel("")
        _legend(panels, [r for row in result.results for r in row] if marked else [])
    return panels


def _legend(panels, results):
    """One legend for all panels, with what the marks in ``results`` mean."""
    first = panels.ravel()[0]
    handles, labels = first.get_legend_handles_labels()
    notes = _notes(results) if results else ""
    first.figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 4), frameon=False, fontsize=9,
                        handlelength=3.2, title=notes or None, title_fontsize=8)
