# SPDX-License-Identifier: BSD-3-Clause
"""``railsym curving``: wheel-rail forces, angle of attack and wear number of a vehicle in curves."""

from __future__ import annotations

import argparse
import re
import sys

import numpy as np

from railsym.cli_output import check_plot_path, deliver
from railsym.cli_pair import add_contact
from railsym.cli_values import CommandError, quantity

_MOST = 200
_DEFICIENCY = 0.1     # m, of a coach
_LINEAR = ("amplitude", "load")  # options of linear contact, refused


def add_curving(commands, typed, add_vehicle, add_output):
    """Add the command to the parser."""
    command = commands.add_parser(
        "curving", help="forces, angle of attack and wear number in curves, against radius, speed and cant deficiency",
        description="Equilibria of a vehicle in curves: Y, Q, Y/Q, sum of Y, angle of attack and wear number against radius, and what runs with "
                    "irregularities reach (--dynamic), with the limits of EN 14363.")
    add_vehicle(command)
    command.add_argument("--radius", required=True, type=typed(quantities, "m", "radius", "m"), metavar="RANGE",
                         help="500m, or 250,400,800m, or first:last:count such as 250:1500:10m (metres without unit)")
    command.add_argument("--cant", type=typed(quantities, "m", "cant"), default=np.zeros(1), metavar="LENGTH",
                         help="of the outer rail, one or one a radius, such as 150mm (default 0)")
    command.add_argument("--cant-deficiency", type=typed(quantities, "m", "cant deficiency"), metavar="RANGE",
                         help="such as 100mm or 0:150:4mm (default 100mm unless --speed is given); -50mm is an excess")
    command.add_argument("--speed", type=typed(quantities, "m/s", "speed"), metavar="RANGE", help="in place of --cant-deficiency: 80km/h or 60,80,100km/h")
    command.add_argument("--direction", choices=("right", "left"), default="right", help="of the curves (default right)")
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    add_contact(command, typed)
    for name in _LINEAR:
        command._option_string_actions[f"--{name}"].help = argparse.SUPPRESS
    command.add_argument("--law", metavar="NAME", help="creep law (default fastsim)")
    command.add_argument("--dynamic", action="store_true", help="also run through every curve, with irregularities")
    command.add_argument("--irregularity", metavar="NAME", help="of --dynamic: spectrum (default erri_b176_low), or a CSV file of measured irregularities")
    command.add_argument("--seed", type=int, metavar="NUMBER", help="of --irregularity from a spectrum (default 1)")
    command.add_argument("--length", type=typed(quantity, "m", "length"), default=250.0, metavar="LENGTH",
                         help="of --dynamic: full curve that is judged (default 250m)")
    command.add_argument("--step", type=typed(quantity, "s", "step"), default=1e-3, metavar="TIME", help="of the integration (default 1ms)")
    add_output(command)
    return command


def run(options):
    """Compute, and show what the options ask for."""
    from railsym.cli_modes import _configured
    from railsym.cli_simulate import profile_contact
    from railsym.curving import curving
    from railsym.vehicle import load_vehicle

    check_plot_path(options.plot)
    _check(options)
    vehicle = _configured(load_vehicle(options.vehicle), options.configuration)
    contact, more, text = profile_contact(options, vehicle)
    asked = {"speed": options.speed} if options.speed is not None else {
        "cant_deficiency": [_DEFICIENCY] if options.cant_deficiency is None else options.cant_deficiency}
    found = curving(vehicle, radius=options.radius, cant=options.cant, contact=contact, direction=options.direction, dynamic=options.dynamic,
                    irregularity=options.irregularity, seed=options.seed, length=options.length, dt=options.step,
                    progress=sys.stderr.isatty(), name=text.rpartition(", ")[0], **asked, **more)
    deliver(options, lambda: found.message, found.to_dict, found.plot)


def _check(options):
    if options.speed is not None and options.cant_deficiency is not None:
        raise CommandError("--speed and --cant-deficiency: one follows from the other; give one of the two")
    for name in _LINEAR:
        if getattr(options, name) is not None:
            raise CommandError(f"--{name} belongs to linear contact: curving takes the contact of the profiles as it is")
    if not options.dynamic:
        for name in ("irregularity", "seed"):
            if getattr(options, name) is not None:
                raise CommandError(f"--{name} goes with --dynamic: an equilibrium has no irregularities")


def quantities(text, unit, what, default=""):
    """``500m``, ``250,400m`` or ``250:1500:10m`` (ten values) in SI, ascending or not.

    Parameters
    ----------
    text : str
    unit, what : str
        As `railsym.cli_values.quantity`.
    default : str
        Unit of numbers without one; "": a unit is needed.

    Returns
    -------
    ndarray (n,)

    Raises
    ------
    CommandError
    """
    head, shared = re.fullmatch(r"(.*?[\d.])\s*([^\d.,:]*(?:/[^\d.,:]*)?)\s*", text).groups() if re.search(r"\d", text) else (text, "")
    shared = shared or default

    def value(part):
        return quantity(part if re.search(r"[A-Za-z]\s*$", part) else part + shared, unit, what)

    if ":" in head:
        parts = head.split(":")
        if len(parts) != 3 or not parts[2].strip().isdigit() or not 2 <= int(parts[2]) <= _MOST:
            raise CommandError(f"{what} {text!r}: write one value, several with commas between, or first:last:count with a count from 2 to {_MOST}")
        return np.linspace(value(parts[0]), value(parts[1]), int(parts[2]))
    return np.array([value(part) for part in head.split(",")])
