# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle written after an option that takes several values."""

from __future__ import annotations

from pathlib import Path

from railsym.cli_values import CommandError


def vehicle_first(arguments, options):
    """Arguments of a command with the vehicle in front, where an option would take it for its last value.

    ``--configuration AS_K pendolino`` reads as two configurations. A last value that names a vehicle that comes along, or a
    file, is taken for the vehicle, unless the command begins with one already.

    Parameters
    ----------
    arguments : list of str
        Of one command, its name first.
    options : mapping of str to str
        Option -> "+" if it takes one or more values, "?" if one or none.

    Returns
    -------
    list of str
    """
    if len(arguments) < 2 or not arguments[1].startswith("-"):
        return arguments
    for last, value in _last_values(arguments, options):
        if _is_vehicle(value):
            return [arguments[0], value, *arguments[1:last], *arguments[last + 1:]]
    return arguments


def missing_vehicle(error, arguments, options):
    """The error for a missing VEHICLE, with the option that may have taken it."""
    for last, value in _last_values(arguments, options):
        name = next(a for a in reversed(arguments[:last]) if a.startswith("--"))
        return CommandError(f"{arguments[0]}: VEHICLE is missing, or {value!r} was meant, which {name} took: {name} takes all that follows it up to the "
                            f"next option, and {value!r} is neither a vehicle that comes along nor a file; write railsym {arguments[0]} VEHICLE {name} ...")
    return error


def _last_values(arguments, options):
    """Place and text of values that their option could do without, option by option."""
    for at, name in enumerate(arguments):
        if name not in options:
            continue
        end = at + 1
        while end < len(arguments) and not arguments[end].startswith("-"):
            end += 1
        if end - at - 1 >= (2 if options[name] == "+" else 1):
            yield end - 1, arguments[end - 1]


def _is_vehicle(value):
    from railsym.vehicle import vehicles

    return value in vehicles() or Path(value).is_file()
