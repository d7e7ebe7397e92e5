# SPDX-License-Identifier: BSD-3-Clause
"""``railsym stability``: critical speeds as a table, a picture, JSON."""

from __future__ import annotations

import sys
from dataclasses import asdict

import numpy as np

from railsym.cli_output import check_plot_path, deliver, finite, table
from railsym.cli_pair import FROM_PAIR, pair_contacts, plain_contact
from railsym.cli_values import CommandError, speed_range
from railsym.critical_speed import SPEED_RANGE, critical_speed
from railsym.plots.stability_curves import always_stable
from railsym.plots.style import KMH, criterion_text
from railsym.sensitivity import sensitivity
from railsym.stability_map import StabilityMap, join_amplitudes, stability_map
from railsym.vehicle import load_vehicle

CONICITY = np.linspace(0.05, 0.4, 8)
CRITERIA = (0.0, 0.05, 0.1)
_LISTED = 12          # parameters in the table of sensitivities
_NONE = "--"


def run(options):
    """Compute and show what the options of ``railsym stability`` ask for."""
    check_plot_path(options.plot)
    vehicle = load_vehicle(options.vehicle)
    speeds = SPEED_RANGE if options.speed_range is None else speed_range(" ".join(options.speed_range))
    names = chosen_configurations(vehicle, options.configuration)
    pair = pair_contacts(options, [vehicle.configured(name) for name in names] or [vehicle])
    if pair:
        contacts = pair.contacts
        maps = [_solve(vehicle, names, options, c, [c.conicity], speeds) for c in contacts]
        found = join_amplitudes(maps, pair.amplitude, pair.title)
    else:
        conicity = CONICITY if options.conicity is None else options.conicity
        contacts = (plain_contact(options),) * len(conicity)
        found = _solve(vehicle, names, options, contacts[0], conicity, speeds)
    influences = _sensitivities(found, options, contacts, speeds) if options.sensitivity else {}
    deliver(options, lambda: report(vehicle, found, influences, pair), lambda: as_data(vehicle, found, contacts[0], influences, pair),
            lambda: _drawn(found))


def _drawn(found):
    from railsym.plots import plot_stability_report

    return plot_stability_report(found)


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


def _solve(vehicle, names, options, contact, conicity, speeds):
    """A StabilityMap, of one unnamed configuration for a vehicle without any."""
    conicity = np.asarray(conicity, dtype=float)
    criteria = tuple(dict.fromkeys(CRITERIA if options.criterion is None else options.criterion))
    watched = sys.stderr.isatty()
    if names:
        return stability_map(vehicle, names, conicity, criteria, speeds, contact, progress=watched)
    found = [critical_speed(vehicle, conicity, damping_ratio=z, speed_range=speeds, contact=contact, progress=watched)
             if z else critical_speed(vehicle, conicity, speed_range=speeds, contact=contact, progress=watched) for z in criteria]
    return StabilityMap((vehicle.name,), criteria, conicity, (tuple(found),), 0)


def _sensitivities(found, options, contacts, speeds):
    """Configuration -> Sensitivities at the middle conicity by the first criterion, or the reason why there are none."""
    middle = len(found.conicity) // 2
    result = {}
    for name, row in zip(found.configurations, found.results):
        if np.ma.getmaskarray(row[0].speed)[middle]:
            result[name] = row[0].message[middle]
            continue
        vehicle = row[0].vehicle
        result[name] = sensitivity(vehicle, found.conicity[middle], damping_ratio=found.damping_ratios[0] or None, speed_range=speeds,
                                   contact=contacts[middle], parameters=_parameters(vehicle, options.sensitivity), progress=sys.stderr.isatty())
    return result


def _parameters(vehicle, kind):
    """Names of the numbers to vary; None for all of them."""
    if kind == "places":
        return None
    return ["conicity", *(name for name, value in vehicle.parameters.components().items()
                          if "position" not in name and np.isfinite(value) and value != 0.0)]


def report(vehicle, found, influences=None, pair=None):
    """The tables as text, headed by the `railsym.cli_pair.PairContacts` if there is one."""
    low, high = (KMH * speed for speed in found.results[0][0].speed_range)
    lines = [f"{vehicle.name}: {vehicle.description}",
             f"critical speed in km/h (frequency of the unstable mode in Hz) on straight track, searched from {low:.0f} to {high:.0f} km/h"]
    header = cases = ["conicity", *(f"{c:.4g}" for c in found.conicity)]
    if pair:
        lines += ["", pair.title, pair.table()]
        header, cases = ["amplitude: conicity", *pair.columns], ["amplitude", *(f"{1e3 * a:.4g} mm" for a in pair.amplitude)]
    notes = {}
    for column, criterion in enumerate(found.damping_ratios):
        lines += ["", criterion_text(criterion), _speed_table(found, column, header, cases, notes)]
    if notes:
        lines += ["", *(f"{mark}, {cases[0]} {', '.join(values)}: {text}" for (mark, text), values in notes.items())]
    for name, result in (influences or {}).items():
        lines += ["", f"{name}: what moves the critical speed, {cases[0]} {cases[1 + len(found.conicity) // 2]}",
                  result if isinstance(result, str) else _sensitivity_table(result)]
    return "\n".join(lines)


def _speed_table(found, column, header, cases, notes):
    rows = []
    for name, results in zip(found.configurations, found.results):
        rows.append([name, *(_cell(name, results[column], k, cases[1 + k], notes) for k in range(len(found.conicity)))])
    return table(header, rows)


def _cell(name, result, k, at, notes):
    """Speed and frequency; a mark and a note where there is none, or more than one."""
    case = f"{name}, {criterion_text(result.damping_ratio)}"
    if np.ma.getmaskarray(result.speed)[k]:
        low, high = (KMH * speed for speed in result.speed_range)
        why = f"none from {low:.0f} to {high:.0f} km/h" if always_stable(result.message[k]) else result.message[k]
        notes.setdefault((f"{_NONE} {case}", why), []).append(at)
        return _NONE
    text = f"{KMH * result.speed[k]:.0f} ({result.frequency_hz[k]:.1f})"
    if len(result.crossings[k]) == 1:
        return text
    worse, better = ("below", "above") if result.damping_ratio else ("unstable", "stable")
    steps = ", ".join(f"{worse if c.direction > 0 else better} from {KMH * c.speed:.0f}" for c in result.crossings[k])
    notes.setdefault((f" * {case}", f"{steps} km/h"), []).append(at)
    return text + "*"


def _sensitivity_table(result):
    rows = [[result.names[k], f"{result.values[k]:.4g} {result.units[k].replace('-', '')}".rstrip(),
             f"{result.speed_elasticity[k]:+.3f}", f"{result.frequency_elasticity[k]:+.3f}"] for k in range(min(_LISTED, len(result)))]
    return table(["parameter", "value", "% of speed for 1 % (places: 1 cm)", "% of frequency"], rows)


def as_data(vehicle, found, contact, influences, pair=None):
    """Everything as plain data for JSON, SI units; null where there is no critical speed."""
    contacts = {name: asdict(contact.resolved(row[0].vehicle.contact)) for name, row in zip(found.configurations, found.results)}
    for values in contacts.values():
        for key in FROM_PAIR if pair else ("conicity",):
            values.pop(key)
    cases = []
    for name, row in zip(found.configurations, found.results):
        for result in row:
            cases += [_case(name, result, k) for k in range(len(found.conicity))]
    return {"vehicle": vehicle.name, "units": {"speed": "m/s", "frequency_hz": "Hz", "conicity": "-", "damping_ratio": "-"},
            "speed_range": list(found.results[0][0].speed_range), **({"pair": finite(pair.as_data())} if pair else {}), "contact": finite(contacts), "cases": cases,
            "sensitivity": {name: _influence_data(result) for name, result in influences.items()}}


def _case(name, result, k):
    missing = bool(np.ma.getmaskarray(result.speed)[k])
    crossings = [{"speed": c.speed, "frequency_hz": c.frequency_hz, "becomes": "unstable" if c.direction > 0 else "stable",
                  "label": c.label} for c in result.crossings[k]]
    amplitude = {} if result.amplitude is None else {"amplitude": float(result.amplitude[k])}
    return {"configuration": name, **amplitude, "criterion": result.criterion, "damping_ratio": result.damping_ratio,
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
