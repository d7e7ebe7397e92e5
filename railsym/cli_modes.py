# SPDX-License-Identifier: BSD-3-Clause
"""``railsym modes`` and ``railsym vehicles``."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from railsym.cli_output import check_plot_path, finite, save_plot, say, table, write_json
from railsym.cli_pair import pair_contacts, plain_contact
from railsym.cli_values import CommandError, numbers, quantity
from railsym.plots.style import KMH
from railsym.vehicle import load_vehicle, vehicles

_SLOWEST = 0.01      # Hz: slower is no oscillation that anybody would look for


def list_vehicles(options):
    """Show the vehicles that come along."""
    loaded = [load_vehicle(name) for name in vehicles()]
    if options.json:
        write_json([_vehicle_data(v) for v in loaded], options.json)
    if options.json == "-":
        return
    for vehicle in loaded:
        data = _vehicle_data(vehicle)
        say(f"{vehicle.name}: {vehicle.description}")
        say(f"    {data['bodies']} {'body' if data['bodies'] == 1 else 'bodies'}, {data['elements']} elements, {data['mass'] / 1000:.2f} t")
        for name, text in data["configurations"].items():
            say(f"    {name:<24} {text}".rstrip())


def _vehicle_data(vehicle):
    boxes = [box for body in vehicle.bodies for box in body.axleboxes]
    mass = sum(part.mass for part in [*vehicle.bodies, *boxes])
    return {"name": vehicle.name, "description": vehicle.description, "bodies": len(vehicle.bodies) + len(boxes),
            "elements": len(vehicle.elements), "mass": mass,
            "configurations": {name: c.description for name, c in vehicle.configurations.items()}}


def run(options):
    """Show the modes at a speed, or followed over speeds."""
    from railsym.linear import linear_model

    check_plot_path(options.plot)
    vehicle = _configured(load_vehicle(options.vehicle), options.configuration)
    pair = pair_contacts(options, [vehicle])
    model = linear_model(vehicle, _contact(options, pair))
    text = " ".join(options.speed)
    if pair and options.json != "-":
        say(pair.title)
        say(pair.table() + "\n")
    show = _show_range if ":" in text else _show_one
    show(vehicle, model, speeds(text), options, {"pair": finite(pair.as_data())} if pair else {})


def _contact(options, pair):
    """The one contact of the modes."""
    if pair:
        if len(pair.contacts) != 1:
            raise CommandError("--amplitude: modes are shown at one amplitude")
        return pair.contacts[0]
    conicity = np.array([0.2]) if options.conicity is None else options.conicity
    if len(conicity) != 1:
        raise CommandError("--conicity: modes are shown at one conicity")
    return replace(plain_contact(options), conicity=float(conicity[0]))


def _configured(vehicle, name):
    """The vehicle in the configuration asked for, or in its first."""
    if name is not None:
        return vehicle.configured(name)
    return vehicle.configured(next(iter(vehicle.configurations))) if vehicle.configurations else vehicle


def speeds(text):
    """``200km/h`` or ``50:300:26 km/h`` as an array in m/s.

    Raises
    ------
    CommandError
        If it is neither, or a speed is not above 0.
    """
    if ":" in text:
        head, unit = re.fullmatch(r"([\d.:eE+-]*)\s*(.*)", text.strip()).groups()
        values = numbers(head, "speed") * quantity(f"1{unit}", "m/s", "speed")
    else:
        values = np.array([quantity(text, "m/s", "speed")])
    if not (values > 0.0).all():
        raise CommandError(f"speed {text!r}: speeds above 0 are needed, because creepages are referred to the speed")
    return values


def _show_one(vehicle, model, speed, options, more):
    from railsym.modes import modes

    found = modes(model, float(speed[0]))
    listed = [(k, m) for k, m in enumerate(found) if _SLOWEST < m.frequency_hz <= options.frequency]
    if not listed and options.mode is None:
        raise CommandError(f"no mode oscillates at up to {options.frequency:g} Hz; ask for a higher --frequency")
    drawn = _drawn_mode(found, listed, options.mode)
    if options.json:
        write_json(_modes_data(vehicle, found, listed) | more, options.json)
    if options.json != "-":
        say(_heading(vehicle, model) + f", {KMH * found.speed:.4g} km/h")
        rows = [[str(k), f"{m.frequency_hz:.3f}", f"{100 * m.damping_ratio:.2f}", m.label] for k, m in listed]
        say(table(["mode", "frequency, Hz", "damping ratio, %", "motion"], rows, left=(3,)))
        growing = ", ".join(f"{m.label} ({m.frequency_hz:.2f} Hz)" for m in found.unstable)
        say(f"unstable: {growing}" if growing else "stable")
    if options.plot:
        from railsym.plots import plot_mode_shape

        save_plot(lambda: plot_mode_shape(drawn, vehicle, speed=found.speed), options.plot)


def _drawn_mode(found, listed, number):
    if number is None:
        return min((m for _, m in listed), key=lambda m: m.damping_ratio)
    if not 0 <= number < len(found):
        raise CommandError(f"--mode {number}: there are modes 0 to {len(found) - 1}")
    return found[number]


def _heading(vehicle, model):
    contact = model.contact
    configuration = f", {vehicle.configuration}" if vehicle.configuration else ""
    return (f"{vehicle.name}{configuration}: conicity {contact.conicity:.4g}, friction {contact.friction:g}, "
            f"amplitude {1000 * contact.amplitude:g} mm")


def _modes_data(vehicle, found, listed):
    return {"vehicle": vehicle.name, "configuration": vehicle.configuration, "speed": found.speed, "message": found.message,
            "units": {"speed": "m/s", "frequency_hz": "Hz", "eigenvalue": "1/s", "damping_ratio": "-"},
            "modes": [{"number": k, "frequency_hz": m.frequency_hz, "damping_ratio": m.damping_ratio, "label": m.label,
                       "parity": m.parity, "eigenvalue": [m.eigenvalue.real, m.eigenvalue.imag]} for k, m in listed]}


def _show_range(vehicle, model, speed, options, more):
    """Follow the modes: the least damped ones as a table, the root locus as a picture."""
    from railsym.plots.eigenvalues import shown_modes
    from railsym.tracking import track_modes

    tracked = track_modes(model, speed)
    chosen = shown_modes(tracked.eigenvalue, (0.0, options.frequency), 0.5)
    if options.json:
        write_json(_tracked_data(vehicle, tracked, chosen) | more, options.json)
    if options.json != "-":
        say(_heading(vehicle, model) + "; least damped modes: damping ratio in % (frequency in Hz)")
        header = ["km/h", *(tracked.label[k] for k in chosen[:4])]
        rows = [[f"{KMH * v:.0f}", *(f"{100 * tracked.damping_ratio[i, k]:.1f} ({tracked.frequency_hz[i, k]:.2f})" for k in chosen[:4])]
                for i, v in enumerate(speed)]
        say(table(header, rows, left=()))
        say(tracked.message)
    if options.plot:
        from railsym.plots import plot_root_locus

        save_plot(lambda: plot_root_locus(tracked), options.plot)


def _tracked_data(vehicle, tracked, chosen):
    return {"vehicle": vehicle.name, "configuration": vehicle.configuration, "speed": tracked.speed.tolist(), "message": tracked.message,
            "units": {"speed": "m/s", "eigenvalue": "1/s"},
            "modes": [{"label": tracked.label[k], "eigenvalue": [[v.real, v.imag] for v in tracked.eigenvalue[:, k].tolist()]}
                      for k in chosen]}
