# SPDX-License-Identifier: BSD-3-Clause
"""``railsym switch``: the crossing of a switch at parts of the linear critical speed, as in section 3.1 of the paper."""

from __future__ import annotations

import sys

from railsym.cli_output import check_plot_path, deliver, save_plot
from railsym.cli_pair import add_contact, profile_pair
from railsym.cli_values import CommandError, numbers, quantity

_SHAPES, _RAILS = ("bump", "half_sine", "blade", "smooth_step"), ("both", "left", "right")


def add_switch(commands, typed, add_vehicle, add_output):
    """Add the command to the parser."""
    command = commands.add_parser(
        "switch", help="stability of a vehicle after a switch",
        description="Runs of a vehicle over a switch at parts of V0, the linear critical speed at the conicity of the profiles: stable or not by the frame's "
                    "acceleration above the axleboxes, the frequency, and the speed at which the verdict turns.")
    add_vehicle(command)
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    command.add_argument("--ratio", type=typed(numbers, "ratio"), metavar="RANGE", help="V/V0 to run: 0.85,0.9,1 (the default) or first:last:count")
    command.add_argument("--reference", type=typed(quantity, "m/s", "reference speed"), metavar="SPEED",
                         help="V0, such as 250km/h, in place of the linear critical speed")
    command.add_argument("--switch-amplitude", type=typed(quantity, "m", "switch amplitude"), metavar="LENGTH",
                         help="lateral deviation of the rails (default 5mm)")
    command.add_argument("--switch-length", type=typed(quantity, "m", "switch length"), metavar="LENGTH", help="over which they deviate (default 10m)")
    command.add_argument("--switch-shape", choices=_SHAPES, help="of the deviation (default bump)")
    command.add_argument("--switch-rails", choices=_RAILS, help="which deviate (default both)")
    command.add_argument("--law", metavar="NAME", default="fastsim", help="creep law (default fastsim)")
    command.add_argument("--after", type=typed(quantity, "s", "time after the switch"), default=6.0, metavar="TIME",
                         help="of motion behind the switch (default 6s)")
    command.add_argument("--no-threshold", action="store_true", help="do not look for the speed at which the verdict turns")
    command.add_argument("--sensitivity", action="store_true", help="find that speed for other amplitudes, lengths and shapes of the switch too (minutes)")
    add_contact(command, typed)
    command.add_argument("--plot-amplitudes", metavar="FILE", help="draw the amplitude that is left beside the quasi-linear theory")
    add_output(command)
    command.set_defaults(conicity=None)
    return command


def run(options):
    """Run the study and show what it found."""
    from railsym.cli_modes import _configured
    from railsym.studies import switch_study, variants
    from railsym.studies.switch_report import as_data
    from railsym.vehicle import load_vehicle

    check_plot_path(options.plot)
    check_plot_path(options.plot_amplitudes)
    vehicle = _configured(load_vehicle(options.vehicle), options.configuration)
    pair, amplitude = profile_pair(options, vehicle)
    switch = _switch(options)
    more = {} if options.ratio is None else {"ratios": options.ratio}
    study = switch_study(vehicle, pair, reference=_positive(options.reference, "--reference"), amplitude=amplitude, load=options.load, switch=switch,
                         threshold=not options.no_threshold, sensitivity=variants(switch) if options.sensitivity else (), law=options.law,
                         friction=options.friction, after=options.after, progress=sys.stderr.isatty(), **more)
    deliver(options, lambda: str(study), lambda: as_data(study), study.plot)
    if options.plot_amplitudes:
        save_plot(study.plot_quasi_linear, options.plot_amplitudes)


def _switch(options):
    from dataclasses import replace

    from railsym.studies import SWITCH

    given = {name: getattr(options, f"switch_{name}") for name in ("amplitude", "length", "shape", "rails")}
    return replace(SWITCH, **{name: value for name, value in given.items() if value is not None})


def _positive(value, name):
    if value is not None and not value > 0.0:
        raise CommandError(f"{name} {value:g} m/s: a speed above 0 is needed")
    return value
