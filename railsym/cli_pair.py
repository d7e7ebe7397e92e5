# SPDX-License-Identifier: BSD-3-Clause
"""The contact of ``railsym stability`` and ``railsym modes``: a conicity, or a pair of wheel and rail profiles at amplitudes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from railsym.cli_output import table
from railsym.cli_profiles import lengths, pair_of, slope, title
from railsym.cli_values import CommandError, quantity
from railsym.contact import LinearContact

_AMPLITUDE = 3e-3            # m, at which equivalent conicity is quoted (EN 14363, EN 15302)
_SPACING_TOLERANCE = 1e-3    # m, between the tape circles of the pair and the contact spacing of the vehicle file
_ONLY_PAIR = ("inclination", "gauge", "flange_back_distance", "smoothing", "load")


@dataclass(frozen=True, eq=False)
class PairContacts:
    """Linear contacts of a pair of profiles, one an amplitude.

    Attributes
    ----------
    pair : railsym.ContactPair
    contacts : tuple of LinearContact
    """

    pair: Any
    contacts: tuple[LinearContact, ...]

    @property
    def title(self):
        """The pair and its measures in a line."""
        return title(self.pair)

    @property
    def amplitude(self):
        """m, shape (n,)."""
        return np.array([contact.amplitude for contact in self.contacts])

    @property
    def columns(self):
        """Amplitude and conicity of each contact as text."""
        return tuple(f"{1e3 * c.amplitude:.4g} mm: {c.conicity:#.3g}" for c in self.contacts)

    def table(self):
        """The parameters of the contacts as text."""
        rows = [[f"{1e3 * c.amplitude:.4g} mm", f"{c.conicity:.4g}", f"{c.contact_angle_parameter:.4g}", f"{c.roll_parameter:.4g}",
                 f"{1e3 * c.wheel_transverse_radius:.4g} mm", f"{1e3 * c.rail_transverse_radius:.4g} mm"] for c in self.contacts]
        return table(["amplitude", "conicity", "contact-angle parameter", "roll parameter", "wheel radius across", "rail radius across"], rows)

    def as_data(self):
        """Everything as plain data, SI units."""
        pair = self.pair
        names = ("amplitude", "conicity", "contact_angle_parameter", "roll_parameter", "wheel_transverse_radius", "rail_transverse_radius")
        values = {name: [getattr(contact, name) for contact in self.contacts] for name in names}
        return {"wheel": pair.wheel.name, "rail": pair.rail.name, "title": self.title, "gauge": pair.track_gauge,
                "flange_back_distance": pair.flange_back_distance, "wheel_radius": pair.wheel_radius, **values}


# fields of LinearContact that come from the pair and not from the vehicle file
FROM_PAIR = ("conicity", "amplitude", "contact_angle_parameter", "roll_parameter", "wheel_transverse_radius", "rail_transverse_radius")


def add_contact(command, typed):
    """Add the options of the contact to a command."""
    command.add_argument("--friction", type=float, metavar="NUMBER", help="friction coefficient (default: that of the configuration)")
    command.add_argument("--amplitude", type=typed(lengths), metavar="LENGTH",
                         help="lateral amplitude of the quasi-linear creep forces, such as 3mm (default: that of the vehicle file); with profiles "
                              "also that of the conicity (default 3mm), and stability takes several: 2,3,4mm or first:last:count, 2:6:5mm")
    command.add_argument("--wheel", metavar="PROFILE", help="wheel profile, such as S1002 (railsym profiles), or a file: with --rail, in place of --conicity")
    command.add_argument("--rail", metavar="PROFILE", help="rail profile, such as UIC60, or a file")
    command.add_argument("--inclination", type=typed(slope), metavar="1:N", help="of the rails, with --rail (default 1:40; 0 for none)")
    for name, text in {"gauge": "track gauge, with --rail (default 1435mm)", "flange-back-distance": "of the wheelsets, with --wheel (default 1360mm)",
                       "smoothing": "root-mean-square distance that the curve may keep from measured profiles (default 0mm)"}.items():
        command.add_argument(f"--{name}", type=typed(quantity, "m", name.replace("-", " ")), metavar="LENGTH", help=text)
    command.add_argument("--load", type=typed(quantity, "N", "load"), metavar="FORCE",
                         help="vertical load of a wheel, such as 60kN, with --wheel and --rail: elastic contact (default: rigid)")


def plain_contact(options):
    """The contact of a conicity that is given by itself.

    Raises
    ------
    CommandError
        For several amplitudes.
    """
    if options.amplitude is not None and len(options.amplitude) > 1:
        raise CommandError("--amplitude: several amplitudes need profiles, whose conicity depends on them: give --wheel and --rail, or one amplitude")
    return LinearContact(friction=options.friction, amplitude=None if options.amplitude is None else float(options.amplitude[0]))


def pair_contacts(options, vehicles):
    """The contacts of the profiles asked for, or None where there are none.

    Parameters
    ----------
    options : argparse.Namespace
    vehicles : sequence of Vehicle
        All that will run on the pair; the wheel radius is theirs.

    Returns
    -------
    PairContacts or None

    Raises
    ------
    CommandError
        For options that do not go together, and wheelsets that one pair does not fit.
    ProfileError, ContactError
        For a profile that does not exist, and an amplitude at which the pair has no contact parameters.
    """
    if options.wheel is None and options.rail is None:
        alone = [name for name in _ONLY_PAIR if getattr(options, name) is not None]
        if alone:
            raise CommandError(f"--{alone[0].replace('_', '-')} goes with profiles: give --wheel and --rail too, such as --wheel S1002 --rail UIC60")
        return None
    if options.wheel is None or options.rail is None:
        given, other, example = ("wheel", "rail", "UIC60") if options.rail is None else ("rail", "wheel", "S1002")
        raise CommandError(f"--{given} {getattr(options, given)}: a {other} is needed too, such as --{other} {example}")
    if options.conicity is not None:
        raise CommandError(f"--conicity: the pair {options.wheel} on {options.rail} gives the conicity; leave out --conicity, or --wheel and --rail")
    pair = pair_of(options, wheel_radius=_wheel_radius(vehicles))
    _check_spacing(pair, vehicles)
    more = {} if options.friction is None else {"friction": options.friction}
    amplitudes = [_AMPLITUDE] if options.amplitude is None else options.amplitude
    return PairContacts(pair, tuple(pair.linear_contact(float(a), options.load, **more) for a in amplitudes))


def _wheelsets(vehicles):
    return [body for vehicle in vehicles for body in vehicle.bodies if body.kind == "wheelset"]


def _wheel_radius(vehicles):
    radii = sorted({body.wheel_radius for body in _wheelsets(vehicles)})
    if len(radii) != 1:
        raise CommandError(f"the wheelsets of {vehicles[0].name!r} have the wheel radii {', '.join(f'{1e3 * r:g}' for r in radii)} mm, and a pair of profiles "
                           "has one: make them equal, or give --conicity")
    return radii[0]


def _check_spacing(pair, vehicles):
    for body in _wheelsets(vehicles):
        wanted = 2.0 * body.contact_half_spacing
        if abs(wanted - pair.tape_circle_spacing) > _SPACING_TOLERANCE:
            fitting = wanted - 2.0 * pair.tape_circle_offset
            raise CommandError(f"the contacts of {body.name} are {1e3 * wanted:g} mm apart in the vehicle file, the tape circles of the pair "
                               f"{1e3 * pair.tape_circle_spacing:g} mm: give --flange-back-distance {1e3 * fitting:g}mm, and the --gauge that goes with it")


def profile_pair(options, vehicle):
    """The pair of profiles, S1002 on UIC60 if not given, and its amplitude (m)."""
    if options.wheel is None and options.rail is None:
        options.wheel, options.rail = "S1002", "UIC60"
    found = pair_contacts(options, [vehicle])
    if len(found.contacts) != 1:
        raise CommandError("--amplitude: V0 is the critical speed at one amplitude")
    return found.pair, found.contacts[0].amplitude
