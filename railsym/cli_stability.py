# SPDX-License-Identifier: BSD-3-Clause
"""``railsym stability``: critical speeds as a table, a picture, JSON."""

from __future__ import annotations

import sys
from dataclasses import asdict

import numpy as np

from railsym.cli_output import check_plot_path, save_plot, table, write_json
from railsym.cli_values import CommandError, speed_range
from railsym.contact import LinearContact
from railsym.critical_speed import SPEED_RANGE, critical_speed
from railsym.plots.stability_curves import always_stable
from railsym.plots.style import KMH, criterion_text
from railsym.sensitivity import sensitivity
from railsym.stability_map import StabilityMap, stability_map
from railsym.vehicle import load_vehicle

CONICITY = np.linspace(0.05, 0.4, 8)
CRITERIA = (0.0, 0.05, 0.1)
_LISTED = 12          # parameters in the table of sensitivities
_NONE = "--"


def run(options):
    """Compute and show what the options of ``railsym stability`` ask for."""
    check_plot_path(options.plot)
    vehicle = load_vehicle(options.vehicle)
    contact = LinearContact(friction=options.friction, amplitude=options.amplitude)
    speeds = SPEED_RANGE if options.speed_range is None else speed_range(" ".join(options.speed_range))
    found = _solve(vehicle, options, contact, speeds)
    influences = _sensitivities(found, options, contact, speeds) if options.sensitivity else {}
    if options.json != "-":
        print(report(vehicle, found, influences))
    if options.json:
        write_json(as_data(vehicle, found, contact, influences), options.json)
    if options.plot:
        from railsym.plots import plot_stability_report

        save_plot(lambda: plot_stability_report(found), options.plot)


def chosen_configurations(vehicle, wanted):
    """Names of the configurations asked for; an empty tuple for a vehicle that has none.

    Raises
    ------
    CommandError
        If one is asked for twice, or the vehicle has none.
    """
    if wanted is None or wanted == ["all"]:
        return tuple(vehicle.configurations)
    if not vehicle.configurations:
        raise CommandError(f"vehicle {vehicle.name!r} has no configurations, but {wanted[0]!r} was asked for: leave --configuration out")
    if len(set(wanted)) < len(wanted):
        raise CommandError(f"--configuration {' '.join(wanted)}: a name stands there twice")
    return tuple(wanted)


def _solve(vehicle, options, contact, speeds):
    """A StabilityMap, of one unnamed configuration for a vehicle without any."""
    names = chosen_configurations(vehicle, options.configuration)
    conicity = CONICITY if options.conicity is None else options.conicity
    criteria = tuple(dict.fromkeys(CRITERIA if options.criterion is None else options.criterion))
    watched = sys.stderr.isatty()
    if names:
        return stability_map(vehicle, names, conicity, criteria, speeds, contact, progress=watched)
    found = [critical_speed(vehicle, conicity, damping_ratio=z, speed_range=speeds, contact=contact, progress=watched)
             if z else critical_speed(vehicle, conicity, speed_range=speeds, contact=contact, progress=watched) for z in criteria]
    return StabilityMap((vehicle.name,), criteria, conicity, (tuple(found),), 0)


def _sensitivities(found, options, contact, speeds):
    """Configuration -> Sensitivities at the middle conicity by the first criterion, or the reason why there are none."""
    middle = len(found.conicity) // 2
    result = {}
    for name, row in zip(found.configurations, found.results):
        if np.ma.getmaskarray(row[0].speed)[middle]:
            result[name] = row[0].message[middle]
            continue
        vehicle = row[0].vehicle
        result[name] = sensitivity(vehicle, found.conicity[middle], damping_ratio=found.damping_ratios[0] or None, speed_range=speeds,
                                   contact=contact, parameters=_parameters(vehicle, options.sensitivity), progress=sys.stderr.isatty())
    return result


def _parameters(vehicle, kind):
    """Names of the numbers to vary; None for all of them."""
    if kind == "places":
        return None
    return ["conicity", *(name for name, value in vehicle.parameters.components().items()
                          if "position" not in name and np.isfinite(value) and value != 0.0)]


def report(vehicle, found, influences=None):
    """The tables as text."""
    low, high = (KMH * speed for speed in found.results[0][0].speed_range)
    lines = [f"{vehicle.name}: {vehicle.description}",
             f"critical speed in km/h (frequency of the unstable mode in Hz) on straight track, searched from {low:.0f} to {high:.0f} km/h"]
    notes = {}
    for column, criterion in enumerate(found.damping_ratios):
        lines += ["", criterion_text(criterion), _speed_table(found, column, notes)]
    if notes:
        lines += ["", *(f"{mark}, conicity {', '.join(values)}: {text}" for (mark, text), values in notes.items())]
    for name, result in (influences or {}).items():
        lines += ["", f"{name}: what moves the critical speed, conicity {found.conicity[len(found.conicity) // 2]:.4g}",
                  result if isinstance(result, str) else _sensitivity_table(result)]
    return "\n".join(lines)


def _speed_table(found, column, notes):
    header = ["conicity", *(f"{c:.4g}" for c in found.conicity)]
    rows = []
    for name, results in zip(found.configurations, found.results):
        rows.append([name, *(_cell(name, results[column], k, notes) for k in range(len(found.conicity)))])
    return table(header, rows)


def _cell(name, result, k, notes):
    """Speed and frequency; a mark and a note where there is none, or more than one."""
    case, conicity = f"{name}, {criterion_text(result.damping_ratio)}", f"{result.conicity[k]:.4g}"
    if np.ma.getmaskarray(result.speed)[k]:
        low, high = (KMH * speed for speed in result.speed_range)
        why = f"none from {low:.0f} to {high:.0f} km/h" if always_stable(result.message[k]) else result.message[k]
        notes.setdefault((f"{_NONE} {case}", why), []).append(conicity)
        return _NONE
    text = f"{KMH * result.speed[k]:.0f} ({result.frequency_hz[k]:.1f})"
    if len(result.crossings[k]) == 1:
        return text
    worse, better = ("below", "above") if result.damping_ratio else ("unstable", "stable")
    steps = ", ".join(f"{worse if c.direction > 0 else better} from {KMH * c.speed:.0f}" for c in result.crossings[k])
    notes.setdefault((f" * {case}", f"{steps} km/h"), []).append(conicity)
    return text + "*"


def _sensitivity_table(result):
    rows = [[result.names[k], f"{result.values[k]:.4g} {result.units[k].replace('-', '')}".rstrip(),
             f"{result.speed_elasticity[k]:+.3f}", f"{result.frequency_elasticity[k]:+.3f}"] for k in range(min(_LISTED, len(result)))]
    return table(["parameter", "value", "% of speed for 1 % (places: 1 cm)", "% of frequency"], rows)


def as_data(vehicle, found, contact, influences):
    """Everything as plain data for JSON, SI units; null where there is no critical speed."""
    contacts = {name: asdict(contact.resolved(row[0].vehicle.contact)) for name, row in zip(found.configurations, found.results)}
    for values in contacts.values():
        values.pop("conicity")
    cases = []
    for name, row in zip(found.configurations, found.results):
        for result in row:
            cases += [_case(name, result, k) for k in range(len(found.conicity))]
    return {"vehicle": vehicle.name, "units": {"speed": "m/s", "frequency_hz": "Hz", "conicity": "-", "damping_ratio": "-"},
            "speed_range": list(found.results[0][0].speed_range), "contact": _finite(contacts), "cases": cases,
            "sensitivity": {name: _influence_data(result) for name, result in influences.items()}}


def _case(name, result, k):
    missing = bool(np.ma.getmaskarray(result.speed)[k])
    crossings = [{"speed": c.speed, "frequency_hz": c.frequency_hz, "becomes": "unstable" if c.direction > 0 else "stable",
                  "label": c.label} for c in result.crossings[k]]
    return {"configuration": name, "criterion": result.criterion, "damping_ratio": result.damping_ratio,
            "conicity": float(result.conicity[k]), "speed": None if missing else float(result.speed[k]),
            "frequency_hz": None if missing else float(result.frequency_hz[k]), "label": result.label[k],
            "message": result.message[k], "crossings": crossings}


def _influence_data(result):
    if isinstance(result, str):
        return {"message": result, "parameters": []}
    columns = zip(result.names, result.units, result.values, result.speed_derivative, result.frequency_derivative)
    return {"message": result.message, "parameters": [
        {"name": name, "unit": unit, "value": float(value), "speed_derivative": float(speed), "frequency_derivative": float(frequency)}
        for name, unit, value, speed, frequency in columns]}


def _finite(value):
    """JSON has no infinity: the text "inf" stands for it."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return str(value) if isinstance(value, float) and not np.isfinite(value) else value
