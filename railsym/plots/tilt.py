# SPDX-License-Identifier: BSD-3-Clause
"""A tilting study as figures 21 to 24 of the paper: track and tilt, passengers, demand and actuators, wheel forces."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, VERMILION, new_axes, tidy

_COLOUR = {"passive": BLACK, "active": VERMILION, "detection": GREEN, "leading": BLUE, "database": PURPLE, "database, exact": SKY}


def plot_tilt_study(study, *, axes=None):
    """Six panels: layout and tilt; lateral acceleration above the leading bogie; tilt and demand in the fastest change; what tilt lacks of
    a perfect one; actuators; Y/Q of the leading wheelset.

    Parameters
    ----------
    study : railsym.studies.TiltStudy
    axes : array of matplotlib Axes, optional
        Six.

    Returns
    -------
    ndarray of matplotlib Axes, shape (3, 2)
    """
    panels = new_axes(axes, 3, 2, size=(12.0, 10.0))
    (layout, felt), (demand, over), (drive, wheels) = panels
    _layout(layout, study)
    _felt(felt, study)
    _demand(demand, study)
    _over(over, study)
    _drive(drive, study)
    _wheels(wheels, study)
    if axes is None:
        from railsym.studies.tilt_report import heading

        p = study.parameters
        layout.figure.suptitle(f"{heading(study)}; share {p.share:g}, control at {p.rate:g} Hz", fontsize=11, x=0.01, ha="left")
    return panels


def _place(case):
    return case.run["s"]


def _layout(axes, study):
    track, active = study.scene.track, study["active"]
    s = np.linspace(0.0, track.length, 2000)
    axes.plot(s, 1e3 * track.curvature(s), color=GREY, linewidth=1.6, label="curvature, 1/km")
    axes.plot(s, 10.0 * track.cant(s), color=SKY, linewidth=1.6, linestyle="--", label="cant, 100 mm")
    axes.plot(_place(active), np.degrees(active.tilt), color=VERMILION, linewidth=1.4, label="tilt, deg")
    found = active.record
    starts = np.unique(found["start_place"][np.isfinite(found["start_place"])])
    for k, place in enumerate(starts):
        axes.axvline(place, color=GREEN, linewidth=0.9, linestyle=":", label="start found" if k == 0 else None)
    tidy(axes, "s, m", "", "layout of the track, and tilt")
    axes.legend(fontsize=8, frameon=False, loc="upper right")


def _felt(axes, study):
    from railsym.studies.tilt_figures import smooth

    for name in ("passive", "active"):
        case = study[name]
        axes.plot(_place(case), case.run["front.ay"], color=PALE, linewidth=0.6)
        axes.plot(_place(case), smooth(case.run, case.run["front.ay"]), color=_COLOUR[name], linewidth=1.4, label=f"{name}: floor above the leading bogie")
    case = study["active"]
    axes.plot(_place(case), smooth(case.run, case.run["seat.ay"]), color=ORANGE, linewidth=1.1, linestyle="--", label="active: seat in the middle")
    tidy(axes, "s, m", "m/s²", "lateral acceleration of passengers, below 2 Hz")
    axes.legend(fontsize=8, frameon=False, loc="upper right")


def _span(study):
    """Place (m) of the steepest change of the ideal tilt, and what lies around it."""
    active = study["active"]
    change = np.convolve(np.abs(np.gradient(active.ideal)), np.ones(200) / 200.0, "same")
    middle = _place(active)[int(np.argmax(change))]
    return middle - 130.0, middle + 130.0


def _demand(axes, study):
    low, high = _span(study)
    for case in study.cases[1:]:
        inside = (_place(case) > low) & (_place(case) < high)
        axes.plot(_place(case)[inside], np.degrees(case.tilt[inside]), color=_COLOUR.get(case.name, GREY), linewidth=1.3, label=f"{case.name}: lag {round(case.delay, 2) + 0.0:+.2f} s")
    active = study["active"]
    inside = (_place(active) > low) & (_place(active) < high)
    axes.plot(_place(active)[inside], np.degrees(active.ideal[inside]), color=BLACK, linewidth=1.1, linestyle="--", label="ideal")
    record = active.record
    inside = (record["place"] > low) & (record["place"] < high)
    axes.plot(record["place"][inside], np.degrees(record["demand"][inside]), color=VERMILION, linewidth=0.9, linestyle=":", label="active: demand")
    tidy(axes, "s, m", "deg", "tilt where the curve changes fastest")
    axes.legend(fontsize=8, frameon=False)


def _over(axes, study):
    from railsym.studies.tilt_figures import G, smooth

    passive = study["passive"]
    for case in study.cases[1:]:
        n = min(len(case.run), len(passive.run))
        spared = smooth(passive.run, passive.run["front.ay"])[:n] - G * np.sin(case.ideal[:n])
        axes.plot(_place(case)[:n], smooth(case.run, case.run["front.ay"])[:n] - spared, color=_COLOUR.get(case.name, GREY), linewidth=1.0,
                  label=f"{case.name}: {case.ride['front']['over_rms']:.3f} m/s² r.m.s.")
    tidy(axes, "s, m", "m/s²", "above the leading bogie: what a perfect tilt would have spared")
    _legend_below(axes)


def _legend_below(axes, columns=2):
    """A legend with room under the lines."""
    axes.legend(fontsize=8, frameon=False, ncols=columns, loc="lower left")
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.3 * (high - low), high)


def _drive(axes, study):
    case = study["active"]
    for name, colour in zip(study.scene.drive.actuators, (BLUE, SKY, GREEN, ORANGE)):
        axes.plot(_place(case), 1e-3 * case.run[f"{name}.force"], color=colour, linewidth=0.9, label=f"{name.rpartition('.')[2].replace('_', ' ')}, kN")
    power = np.sum([case.run[f"{name}.power"] for name in study.scene.drive.actuators], axis=0)
    axes.plot(_place(case), 10.0 * 1e-3 * power, color=VERMILION, linewidth=1.2, label="power of all, 0.1 kW")
    tidy(axes, "s, m", "", "forces and power of the actuators, active")
    _legend_below(axes, 3)


def _wheels(axes, study):
    from railsym.criteria import derailment

    for name in ("passive", "active"):
        found = derailment(study[name].run, wheel_load=study.scene.load)
        for side, dashes in (("left", "-"), ("right", "--")):
            key = f"Y/Q wheelset1.{side}"
            axes.plot(found.distance[key], found.signals[key], color=_COLOUR[name], linewidth=1.1, linestyle=dashes, label=f"{name}, {side} wheel")
    tidy(axes, "s, m", "Y/Q", "leading wheelset, below 20 Hz, mean over 2 m (UIC 518)")
    _legend_below(axes)
