# SPDX-License-Identifier: BSD-3-Clause
"""A tilting study as text and as plain data."""

from __future__ import annotations

import numpy as np

from railsym.cli_output import table
from railsym.plots.style import KMH
from railsym.studies.tilt_figures import G, cant_deficiency

DETECTION = "slow part from the accelerometers, fast part from the gyroscope"
LEADING = "sensors of the vehicle {:g} m ahead"
PAPER = ("the paper: active tilt lowers the passenger's lateral acceleration against passive, and is not yet efficient for fast changes of trajectory; "
         "its figures are not published")


def report(study):
    """Everything a study found, as text."""
    lines = [heading(study), f"control: {control_text(study.parameters)}", *([PAPER] if study.scene.track.name == "s_curve_500" else []), "",
             "passengers: peak and jerk of the lateral acceleration on the floor (m/s^2, m/s^3, low-passed at 2 Hz); lag of tilt behind the ideal one;",
             "what a perfect tilt would have spared (over, m/s^2); P_CT (formula recalled) of the worst transition, standing", passengers(study), "",
             "tilting and track", loads(study), "", steady(study), "", f"loop: {study.loop}"]
    lines += [f"{case.name}: {case.run.message}" for case in (*study.cases, *study.faults, *study.sensitivity) if case.run.status != "completed"]
    lines += [f"{case.name}: {said}" for case in study.cases for said in case.reports]
    if study.faults:
        lines += ["", "fault cases", fault_table(study)]
    if study.sensitivity:
        lines += ["", "the active case with one change each", sensitivity_table(study)]
    return "\n".join(lines)


def heading(study):
    """Vehicle, track and speed in a line."""
    scene, V = study.scene, study["passive"].speed
    return f"{scene.vehicle.name} {scene.vehicle.configuration or ''}".rstrip() + f" on {scene.track.name}, {KMH * V:.4g} km/h"


def control_text(p):
    """Parameters of the control in a line."""
    return (f"share {p.share:g}, tilt up to {np.degrees(p.limit):g} deg at {np.degrees(p.demand_rate):g} deg/s, {p.rate:g} Hz, latency {1e3 * p.latency:g} ms, "
            f"kp {p.kp:g}, ki {p.ki:g} 1/s, kd {p.kd:g} s, low-pass {p.lateral_cutoff:g} Hz (delay {p.filter_delay(p.lateral_cutoff):.2f} s)")


def number(value, form):
    """Formatted, or -- where there is none."""
    if value is None or not np.isfinite(value):
        return "--"
    text = format(value, form)
    return text.lstrip("-") if float(text) == 0.0 else text


def passengers(study):
    """Table of what is felt."""
    rows = []
    for case in study.cases:
        felt = [case.ride[name] for name in ("front", "middle", "rear")]
        worst = case.ride[case.worst]
        rows.append([case.name, *(f"{ride['peak']:.2f}" for ride in felt), f"{case.ride['seat']['peak']:.2f}", f"{worst['jerk']:.2f}",
                     number(case.delay, ".2f"), number(case.delay * case.speed, ".1f"), number(worst.get("over_rms") if case.state is not None else None, ".3f"),
                     number(worst.get("over_peak") if case.state is not None else None, ".2f"), number(max((r.get("P_CT", np.nan) for r in felt), default=np.nan), ".1f"),
                     case.text])
    head = ["case", "front", "middle", "rear", "seat", "jerk", "lag, s", "lag, m", "over, rms", "over, peak", "P_CT, %", ""]
    return table(head, rows, left=(0, 11))


def loads(study):
    """Table of tilt, actuators, wheels."""
    rows = []
    for case in study.cases:
        sums = case.rails["sum_Y"]
        demand = np.nan if case.record is None else np.degrees(np.abs(case.record["demand"]).max())
        car = case.run[f"{study.scene.drive.car}.roll"]
        rows.append([case.name, number(np.degrees(np.abs(case.tilt).max()), ".2f"), number(demand, ".2f"), f"{np.degrees(np.abs(car).max()):.2f}",
                     f"{1e-3 * case.actuators['force']:.1f}", f"{1e-3 * case.actuators['power']:.2f}", f"{1e-3 * case.actuators['work']:.1f}",
                     f"{case.rails['Y/Q']:.3f}", f"{100.0 * case.rails['unloading']:.0f}", *(f"{1e-3 * value:.1f}" for value in sums.values())])
    head = ["case", "tilt, deg", "demand, deg", "body roll, deg", "force, kN", "power, kW", "work, kJ", "Y/Q", "unloading, %",
            *(f"sum Y {name.removeprefix('wheelset')}, kN" for name in study.cases[0].rails["sum_Y"])]
    limit = study.cases[0].rails
    note = (f"limits: Y/Q {limit['limit Y/Q'].value:g} ({limit['limit Y/Q'].trust}), sum Y {1e-3 * limit['limit sum_Y'].value:.1f} kN ({limit['limit sum_Y'].trust}: "
            f"recalled, no verdict); Y/Q is largest on {study.cases[0].rails['where']} in the passive case")
    return table(head, rows, left=(0,)) + "\n" + note


def steady_rows(study):
    """Of each circular curve and of passive and active: closed form beside the run; list of dict, SI."""
    found = []
    for name in ("passive", "active"):
        case = study[name]
        for k, row in enumerate(case.steady):
            V = float(np.interp(row["s"], case.run["s"], case.run["V"]))
            closed = float(cant_deficiency(study.scene.track, np.array([row["s"]]), np.array([V]))[0])
            rails = -sum(value for key, value in row.items() if key.endswith(".sum_Y")) / study.scene.mass
            car = row[f"{study.scene.drive.car}.roll"]
            cant = float(np.arcsin(study.scene.track.alignment.cant(row["s"])))
            across = V ** 2 * float(study.scene.track.curvature(row["s"]))
            found.append({"case": name, "curve": k + 1, "closed form": closed, "sum Y over mass": rails, "bogie frame": row[f"{study.scene.frame}.ay"],
                          "floor, V^2/R cos - g sin": across * np.cos(cant + car) - G * np.sin(cant + car), "floor": row["middle.ay"],
                          "body roll": car})
    return found


def steady(study):
    """Table of the steady part."""
    rows = [[row["case"], f"{row['curve']}", f"{row['closed form']:.4f}", f"{row['sum Y over mass']:.4f}", f"{row['bogie frame']:.4f}", f"{row['floor, V^2/R cos - g sin']:.4f}",
             f"{row['floor']:.4f}", f"{np.degrees(row['body roll']):.3f}"] for row in steady_rows(study)]
    text = "steady at the end of each curve, m/s^2: a_nc = V^2/R - g sin(cant) by the closed form, by sum of Y over mass, on the bogie frame; on the floor by the body's roll and by the run"
    return text + "\n" + table(["case", "curve", "a_nc", "sum Y/m", "bogie frame", "floor by roll", "floor", "body roll, deg"], rows, left=(0,))


def fault_table(study):
    """Table of fault cases."""
    rows = []
    for case in study.faults:
        said = "; ".join(dict.fromkeys(f"{r.fault.name.lower()} at {r.time:.2f} s" for r in case.reports)) or "none reported"
        rows.append([case.name, case.text, said, case.end, f"{max(case.ride[p]['peak'] for p in ('front', 'middle', 'rear')):.2f}",
                     f"{np.degrees(np.abs(case.tilt).max()):.2f}", number(np.degrees(case.tilt[-1]), ".2f"), f"{case.rails['Y/Q']:.3f}", f"{100.0 * case.rails['unloading']:.0f}"])
    return table(["case", "", "reported", "ends", "floor, peak m/s^2", "tilt, deg", "tilt at the end", "Y/Q", "unloading, %"], rows, left=(0, 1, 2, 3))


def sensitivity_table(study):
    """Table of the active case with changes."""
    rows = []
    for case in (study["active"], *study.sensitivity):
        worst = max((case.ride[place] for place in ("front", "middle", "rear")), key=lambda ride: ride["peak"])
        rows.append([case.text, f"{worst['peak']:.2f}", number(case.delay, ".2f"), number(case.delay * case.speed, ".1f"), f"{worst['over_rms']:.3f}",
                     f"{worst['over_peak']:.2f}", number(worst.get("P_CT"), ".1f"), case.end])
    return table(["", "floor, peak m/s^2", "lag, s", "lag, m", "over, rms", "over, peak", "P_CT, %", "ends"], rows, left=(0, 7))


def as_data(study):
    """Everything as plain data for JSON, SI units; null where there is none."""
    return {"vehicle": study.scene.vehicle.name, "configuration": study.scene.vehicle.configuration, "track": study.scene.track.name,
            "units": {"peak": "m/s^2", "jerk": "m/s^3", "over_peak": "m/s^2", "over_rms": "m/s^2", "P_CT": "%", "delay": "s", "delay_distance": "m", "tilt": "rad",
                      "force": "N", "power": "W", "work": "J", "sum_Y": "N"},
            "cases": [_case(case) for case in study.cases], "faults": [_case(case) for case in study.faults],
            "sensitivity": [_case(case) for case in study.sensitivity],
            "steady": steady_rows(study), "loop": _loop(study.loop)}


def _case(case):
    demand = None if case.record is None else float(np.abs(case.record["demand"]).max())
    return {"name": case.name, "text": case.text, "status": case.run.status, "message": case.run.message, "state": case.end, "ride": case.ride,
            "delay": _plain(case.delay), "delay_distance": _plain(case.delay * case.speed), "tilt": float(np.abs(case.tilt).max()),
            "final_tilt": float(case.tilt[-1]), "demand": demand, **case.actuators, "Y/Q": case.rails["Y/Q"], "unloading": case.rails["unloading"],
            "sum_Y": case.rails["sum_Y"], "reports": [{"time": r.time, "place": r.place, "fault": r.fault.name, "state": r.state.name, "tilt": r.tilt, "text": str(r)}
                                                      for r in case.reports]}


def _loop(loop):
    m = loop.margins()
    return {"gain_margin": _plain(m.gain), "gain_frequency_hz": _plain(m.gain_frequency), "phase_margin": _plain(m.phase), "phase_frequency_hz": _plain(m.phase_frequency),
            "sensitivity": m.sensitivity, "bandwidth_hz": _plain(loop.bandwidth())}


def _plain(value):
    return float(value) if np.isfinite(value) else None
