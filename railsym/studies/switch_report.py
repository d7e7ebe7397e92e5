# SPDX-License-Identifier: BSD-3-Clause
"""A switch study as text and as plain data."""

from __future__ import annotations

import numpy as np

from railsym.cli_output import table
from railsym.plots.style import KMH

PAPER = "the paper: stable at 0.85 V0, unstable at about 0.90 V0 (simulated), at 0.87 V0 (measured); its V0 and its switch are not published"
WORDS = {True: "unstable", False: "stable", None: "no verdict"}


def report(study):
    """Everything a study found, as text."""
    first = study.runs[0]
    lines = [heading(study) + ", over a switch" + _rule(first.verdict), f"switch (assumed): {switch_text(study.switch)}", _reference(study)]
    lines += ["", _runs(study)]
    lines += [f"{ratio_text(run.ratio)} V0: {run.run.message}" for run in study.runs if run.run.status != "completed"]
    if study.threshold is not None:
        lines += ["", f"threshold: {study.threshold.message}"]
    lines += [PAPER, "", "quasi-linear: amplitude at which hunting neither grows nor decays, and the speed", _quasi_linear(study)]
    if study.sensitivity:
        lines += ["", "the threshold on other switches", _sensitivity(study)]
    return "\n".join(lines)


def _rule(verdict):
    if verdict is None:
        return ""
    return (f"; unstable: {verdict.required} consecutive cycles of the frame's lateral acceleration above an axlebox over {verdict.limit.value:g} m/s^2, "
            f"{verdict.band[0]:g} to {verdict.band[1]:g} Hz")


def _reference(study):
    """V0 in words; one that was given is set beside the linear critical speed."""
    speed = KMH * study.critical
    text = (f"linear critical speed at conicity {study.contact.conicity:.3f} ({1e3 * study.contact.amplitude:g} mm): {study.label}, "
            f"{study.frequency_hz:.2f} Hz")
    if study.reference == study.critical:
        return f"V0 = {speed:.1f} km/h, the {text}"
    return f"V0 = {KMH * study.reference:.1f} km/h, given; {speed:.1f} km/h is the {text}"


def ratio_text(ratio):
    """V/V0 with the digits that it needs: 0.85, 0.966."""
    return f"{ratio:.2f}" if abs(100.0 * ratio - round(100.0 * ratio)) < 1e-6 else f"{ratio:.3f}"


def heading(study):
    """Vehicle and pair in a few words."""
    slope = study.pair.inclination
    lies = "" if study.pair.rail.inclined else f" 1:{1.0 / slope:g}" if slope else " 1:40" if slope is None else " upright"
    return f"{study.vehicle.name} {study.vehicle.configuration or ''}".rstrip() + f", {study.pair.wheel.name} on {study.pair.rail.name}{lies}"


def switch_text(switch):
    """A switch in a line."""
    rails = "both rails" if switch.rails == "both" else f"{switch.rails} rail"
    return f"{switch.shape}, {rails}, {1e3 * switch.amplitude:.3g} mm over {switch.length:g} m"


def _number(value, form):
    return "--" if value is None or not np.isfinite(value) else format(value, form)


def _runs(study):
    rows = []
    for run, mode in zip(study.runs, study.modes):
        worst = run.worst
        levels = ("--",) * 3 if worst is None else (f"{worst.sustained:.2f}", f"{worst.peak:.2f}", f"{worst.cycles:g}")
        rows.append([ratio_text(run.ratio), f"{KMH * run.speed:.1f}", WORDS[run.unstable], *levels, _number(run.frequency_hz, ".2f"),
                     _number(mode and mode.frequency_hz, ".2f"),
                     f"{_number(1e3 * run.motion, '.2f')} -> {_number(1e3 * run.late_motion, '.2f')}", run.fate])
    head = ["V/V0", "km/h", "verdict", "6 cycles, m/s^2", "peak, m/s^2", "cycles over", "frequency, Hz", "mode, Hz", "wheelset y, mm", "the motion"]
    return table(head, rows, left=(2, 9))


def _quasi_linear(study):
    rows = []
    for k, amplitude in enumerate(study.rigid["amplitude"]):
        row = [f"{1e3 * amplitude:.1f}"]
        for found in (study.rigid, study.elastic):
            row += [_number(found["conicity"][k], ".3f"), _number(KMH * found["speed"][k], ".1f"), _number(found["speed"][k] / study.reference, ".3f"),
                    _number(found["frequency_hz"][k], ".2f")]
        rows.append(row)
    columns = ["conicity", "km/h", "V/V0", "Hz"]
    return table(["amplitude, mm", *columns, f"elastic, {study.load / 1e3:.0f} kN: conicity", *columns[1:]], rows, left=())


def _sensitivity(study):
    listed = [study.threshold] if study.threshold is not None else []
    rows = []
    for found in [*listed, *study.sensitivity]:
        if isinstance(found, tuple):
            rows.append([switch_text(found[0]), found[1]])
        else:
            rows.append([switch_text(found.switch), found.message])
    return table(["switch (assumed)", "verdict"], rows, left=(0, 1))


def as_data(study):
    """Everything as plain data for JSON, SI units; null where there is none."""
    runs = []
    for run, mode in zip(study.runs, study.modes):
        worst = run.worst
        runs.append({"ratio": run.ratio, "speed": run.speed, "verdict": WORDS[run.unstable], "status": run.run.status,
                     "message": run.run.message, "frequency_hz": _plain(run.frequency_hz), "mode_hz": mode and mode.frequency_hz,
                     "motion": _plain(run.motion), "late_motion": _plain(run.late_motion), "fate": run.fate, "channel": worst and worst.channel, "sustained": worst and worst.sustained, "peak": worst and worst.peak,
                     "cycles": worst and worst.cycles})
    return {"vehicle": study.vehicle.name, "configuration": study.vehicle.configuration, "wheel": study.pair.wheel.name, "rail": study.pair.rail.name,
            "units": {"speed": "m/s", "frequency_hz": "Hz", "sustained": "m/s^2", "peak": "m/s^2", "motion": "m", "amplitude": "m"},
            "reference": study.reference, "reference_frequency_hz": study.frequency_hz, "conicity": study.contact.conicity,
            "amplitude": study.contact.amplitude, "switch": _switch_data(study.switch), "runs": runs,
            "threshold": _threshold_data(study.threshold),
            "critical": study.critical, "wheel_load": study.load,
            "quasi_linear": {"rigid": _listed(study.rigid), "elastic": _listed(study.elastic)},
            "sensitivity": [{"switch": _switch_data(f[0]), "message": f[1]} if isinstance(f, tuple) else _threshold_data(f) for f in study.sensitivity]}


def _plain(value):
    return float(value) if np.isfinite(value) else None


def _listed(columns):
    return {name: [_plain(value) for value in values] for name, values in columns.items()}


def _switch_data(switch):
    return {"shape": switch.shape, "rails": switch.rails, "amplitude": switch.amplitude, "length": switch.length, "start": switch.start}


def _threshold_data(found):
    if found is None:
        return None
    return {"switch": _switch_data(found.switch), "ratio": _plain(found.ratio), "bracket": list(found.bracket), "message": found.message,
            "tried": [{"ratio": ratio, "unstable": unstable, "fate": fate} for ratio, unstable, fate in found.tried]}
