# SPDX-License-Identifier: BSD-3-Clause
"""Options of ``railsym bifurcation``."""

from __future__ import annotations

from railsym.cli_profiles import slope
from railsym.cli_values import quantity


def add_bifurcation(commands, typed, add_output):
    """Add the parser of the command; returns it."""
    command = commands.add_parser(
        "bifurcation", help="limit cycles against speed: non-linear critical speed",
        description="Limit cycles of a vehicle on straight track against speed, by ramps of the speed and by continuation of the periodic motion; "
                    "linear and non-linear critical speed.")
    command.add_argument("vehicle", metavar="VEHICLE", help="name of a vehicle that comes along (railsym vehicles), or a TOML file")
    command.add_argument("--speed-range", nargs="+", required=True, metavar="RANGE", help="speeds to look at, such as 150:350km/h")
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    command.add_argument("--wheel", default="S1002", metavar="PROFILE", help="wheel profile, a name or a file (default S1002)")
    command.add_argument("--rail", default="UIC60", metavar="PROFILE", help="rail profile, a name or a file (default UIC60)")
    command.add_argument("--inclination", type=typed(slope), default=1 / 40, metavar="1:N", help="of the rails (default 1:40; 0 for none)")
    command.add_argument("--contact-table", metavar="FILE", help="contact table (npz or csv) in place of profiles")
    command.add_argument("--law", default="fastsim", help="creep law (default fastsim)")
    command.add_argument("--friction", type=float, metavar="NUMBER", help="friction coefficient (default: the vehicle file's, else 0.3)")
    command.add_argument("--disturbance", type=typed(quantity, "m", "disturbance"), default=3e-3, metavar="LENGTH",
                         help="sideways displacement that the descending ramp begins with (default 3mm)")
    command.add_argument("--points", type=int, default=150, metavar="NUMBER", help="points of a branch, at most (default 150)")
    command.add_argument("--ramp-steps", type=int, default=21, metavar="NUMBER", help="speeds of a ramp (default 21)")
    command.add_argument("--dt", type=float, default=1e-3, metavar="SECONDS", help="step (default 0.001)")
    command.add_argument("--no-ramps", action="store_true", help="continuation alone")
    command.add_argument("--no-continuation", action="store_true", help="ramps alone")
    add_output(command)
    return command
