# SPDX-License-Identifier: BSD-3-Clause
"""``railsym profiles``: profiles that come along, and what a wheel on a rail does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym.cli_output import check_plot_path, save_plot, say, table, write_json
from railsym.cli_values import CommandError, number, quantity

_STEP = 5e-5          # m between shifts drawn: every fifth has a contact line
_MOST = 200
_DRAWN = 121          # amplitudes of the curve drawn


def add_parser(commands, typed, add_output):
    """Add the command to the parsers of the command line."""
    command = commands.add_parser(
        "profiles", help="wheel and rail profiles: contact, equivalent conicity",
        description="Rigid contact of a wheel profile on a rail profile and its equivalent conicity (EN 15302) against amplitude, "
                    "with contact-angle and roll parameter. Without a wheel and a rail: the profiles that come along.")
    command.add_argument("wheel", nargs="?", metavar="WHEEL", help="name of a profile, or a file (.csv, .prw, .whl, .toml)")
    command.add_argument("rail", nargs="?", metavar="RAIL", help="name of a profile, or a file (.csv, .prr, .ban, .toml)")
    command.add_argument("--inclination", type=typed(slope), metavar="1:N", help="of the rails, 1:40 or 1:20 (default 1:40; 0 for none)")
    length = {"gauge": "track gauge, 14 mm below the top of rail (default 1435mm)", "wheel-radius": "(default 460mm)",
              "wheel-radius-left": "where it differs", "flange-back-distance": "(default 1360mm)",
              "smoothing": "root-mean-square distance that the curve may keep from measured points (default 0mm)"}
    for name, text in length.items():
        command.add_argument(f"--{name}", type=typed(quantity, "m", name.replace("-", " ")), metavar="LENGTH", help=text)
    command.add_argument("--wheel-left", metavar="WHEEL", help="left wheel, where it differs")
    command.add_argument("--rail-left", metavar="RAIL", help="left rail, where it differs")
    command.add_argument("--amplitude", type=typed(lengths), metavar="RANGE", help="amplitudes: 3mm, or 2,3,4mm, or first:last:count (default 1:7:13mm)")
    command.add_argument("--load", type=typed(quantity, "N", "load"), metavar="FORCE", help="vertical load of a wheel, such as 60kN: conicity of elastic contact too")
    command.add_argument("--table", metavar="FILE", help="write the contact table of the pair (elastic, for simulations) as .npz")
    add_output(command)

    def start(options):
        run(options)

    command.set_defaults(run=start)


def slope(text):
    """``1:40``, ``1/40`` or ``0.025``.

    Raises
    ------
    CommandError
        If it is none of these.
    """
    for sign in ":/":
        top, found, bottom = text.partition(sign)
        if found:
            divisor = number(bottom, "inclination")
            if not divisor:
                raise CommandError(f"inclination {text!r}: write a slope such as 1:40")
            return number(top, "inclination") / divisor
    return number(text, "inclination")


def lengths(text):
    """``3mm``, ``2,3,4mm`` or ``1:7:13mm`` (13 values from 1 to 7 mm) as an array in m.

    Raises
    ------
    CommandError
        If it is none of these, or not ascending.
    """
    if "," in text:
        return _listed_lengths(text)
    parts = text.split(":")
    if len(parts) == 1:
        return np.array([quantity(text, "m", "amplitude")])
    count = "".join(character for character in parts[-1] if character.isdigit() or character == ".").rstrip(".")
    unit = parts[-1][len(count):].strip()
    if len(parts) != 3 or not count.isdigit() or not 2 <= int(count) <= _MOST:
        raise CommandError(f"amplitude {text!r}: write 3mm, or first:last:count such as 1:7:13mm, with a count from 2 to {_MOST}")
    low, high = (quantity(part + unit, "m", "amplitude") for part in parts[:2])
    if not low < high:
        raise CommandError(f"amplitude {text!r}: the first must be smaller than the last")
    return np.linspace(low, high, int(count))


def _listed_lengths(text):
    parts = text.split(",")
    unit = parts[-1].lstrip(" +-.0123456789")
    values = np.array([quantity(part if part.strip(" +-.0123456789") else part + unit, "m", "amplitude") for part in parts])
    if (np.diff(values) <= 0.0).any():
        raise CommandError(f"amplitude {text!r}: each must be larger than the one before")
    return values


def run(options):
    """Show the profiles that come along, or a pair."""
    if options.wheel is None:
        _list(options)
        return
    if options.rail is None:
        raise CommandError(f"profiles {options.wheel}: a rail is needed too, such as UIC60; railsym profiles lists those that come along")
    check_plot_path(options.plot)
    from railsym.conicity import harmonic_parameters

    pair = pair_of(options, wheel_radius=options.wheel_radius, wheel_radius_left=options.wheel_radius_left)
    amplitude = np.linspace(1e-3, 7e-3, 13) if options.amplitude is None else options.amplitude
    found = [pair.equivalent_conicity(amplitude, with_roll=roll) for roll in (False, True)]
    if options.load is not None:
        found.append(pair.equivalent_conicity(amplitude, load=options.load))
    parameters = [None if np.isnan(value) else harmonic_parameters(pair, a, value, centre)
                  for a, value, centre in zip(amplitude, found[0].conicity, found[0].centre)]
    if options.json:
        write_json(_data(pair, found, parameters), options.json)
    if options.json != "-":
        _show(pair, found, parameters)
    if options.plot:
        _draw(pair, found, options.plot)
    if options.table:
        pair.table().save(options.table)
        if options.json != "-":
            say(f"contact table: {options.table}")


def pair_of(options, **measures):
    """The ContactPair of the options ``wheel``, ``rail``, ``gauge``, ... and of measures (m; None for the default)."""
    from railsym.contact_pair import ContactPair
    from railsym.profiles import load_profile, profiles

    def loaded(name, kind):
        if name is None or name in profiles() or str(name).endswith(".toml"):
            return name if name is None else load_profile(name, kind)
        return load_profile(name, kind, smoothing=options.smoothing or 0.0)

    given = {**measures, "gauge": options.gauge, "flange_back_distance": options.flange_back_distance, "inclination": options.inclination}
    given = {name: value for name, value in given.items() if value is not None}
    wheel, rail = loaded(options.wheel, "wheel"), loaded(options.rail, "rail")
    if rail.inclined:
        given.setdefault("gauge", None)
    left = (loaded(getattr(options, f"{kind}_left", None), kind) for kind in ("wheel", "rail"))
    return ContactPair(wheel, rail, **dict(zip(("wheel_left", "rail_left"), left)), **given)


def _list(options):
    from railsym.profiles import load_profile, profiles

    loaded = [load_profile(name) for name in profiles()]
    if options.json:
        write_json([{"name": p.name, "kind": p.kind, "description": p.description, "origin": p.origin} for p in loaded], options.json)
    if options.json != "-":
        say(table(["profile", "kind", "what it is"], [[p.name, p.kind, p.description] for p in loaded], left=(0, 1, 2)))


def _show(pair, found, parameters):
    say(title(pair))
    rows = []
    for k, amplitude in enumerate(found[0].amplitude):
        rest = ["--"] * 2 if parameters[k] is None else [f"{parameters[k].contact_angle_parameter:.3f}", f"{parameters[k].roll_parameter:.4f}"]
        rows.append([f"{1e3 * amplitude:g} mm", *("--" if np.isnan(f.conicity[k]) else f"{f.conicity[k]:.3f}" for f in found), *rest])
    elastic = [f"elastic, {f.load / 1e3:g} kN" for f in found if f.load is not None]
    say(table(["amplitude", "conicity", "with roll", *elastic, "contact-angle parameter", "roll parameter"], rows))
    if found[0].message:
        say(found[0].message)


def title(pair):
    """A pair and its measures in a line."""
    def sides(right, left):
        return right.name if right is left else f"{left.name} (left), {right.name} (right)"

    lies = "as it lies" if pair.rail.inclined else f"inclination {_slope_text(pair.inclination)}"
    radius = f"{1e3 * pair.wheel_radius:g}" if pair.wheel_radius == pair.wheel_radius_left else f"{1e3 * pair.wheel_radius_left:g} and {1e3 * pair.wheel_radius:g}"
    return (f"{sides(pair.wheel, pair.wheel_left)} on {sides(pair.rail, pair.rail_left)}, {lies}, gauge {1e3 * pair.track_gauge:.2f} mm, "
            f"flange backs {1e3 * pair.flange_back_distance:g} mm, wheel radius {radius} mm")


def _slope_text(inclination):
    inclination = 1.0 / 40.0 if inclination is None else inclination
    return f"1:{1.0 / inclination:g}" if inclination else "0"


def _data(pair, found, parameters):
    def listed(array):
        return [None if not np.isfinite(value) else float(value) for value in array]

    return {"wheel": pair.wheel.name, "rail": pair.rail.name, "wheel_left": pair.wheel_left.name, "rail_left": pair.rail_left.name,
            "gauge": pair.track_gauge, "flange_back_distance": pair.flange_back_distance, "wheel_radius": pair.wheel_radius,
            "wheel_radius_left": pair.wheel_radius_left, "units": {"length": "m", "wavelength": "m", "load": "N"},
            "amplitude": listed(found[0].amplitude), "conicity": listed(found[0].conicity), "conicity_with_roll": listed(found[1].conicity),
            "wavelength": listed(found[0].wavelength), "message": found[0].message,
            **{name: value for f in found if f.load is not None for name, value in (("conicity_elastic", listed(f.conicity)), ("load", f.load))},
            "contact_angle_parameter": [p and p.contact_angle_parameter for p in parameters],
            "roll_parameter": [p and p.roll_parameter for p in parameters]}


def _draw(pair, found, path):
    from railsym.conicity import conicity_of_difference

    reach = _STEP * round(max(found[0].amplitude.max(), 1e-3) / _STEP)
    contact = pair.contact(np.arange(-round(reach / _STEP), round(reach / _STEP) + 1) * _STEP)

    # jumps of dr make corners in the conicity: more amplitudes, from the same dr
    amplitude = np.linspace(*found[0].amplitude[[0, -1]], _DRAWN) if len(found[0].amplitude) > 1 else found[0].amplitude
    fine = [replace(conicity_of_difference(f.y, f.rolling_radius_difference, amplitude, pair.tape_circle_spacing, pair.mean_radius,
                                           with_roll=f.with_roll), load=f.load) for f in found]

    def draw():
        from railsym.plots.profile_pair import plot_profile_pair

        return plot_profile_pair(pair, contact, fine, title=title(pair))

    save_plot(draw, path)
