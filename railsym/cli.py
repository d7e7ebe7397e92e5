# SPDX-License-Identifier: BSD-3-Clause
"""The command ``railsym``: options, and errors as one message on stderr with exit status 2."""

from __future__ import annotations

import argparse
import difflib
import os
import re
import sys

from railsym.cli_arguments import missing_vehicle, vehicle_first
from railsym.cli_bifurcation_parser import add_bifurcation
from railsym.cli_curving import add_curving
from railsym.cli_damper import add_damper
from railsym.cli_pair import add_contact
from railsym.cli_profiles import add_parser as add_profiles
from railsym.cli_simulate import add_simulate
from railsym.cli_study import add_study
from railsym.cli_switch import add_switch
from railsym.cli_tilt import add_tilt
from railsym.cli_values import CommandError, criterion, numbers
from railsym.errors import RailsymError

_COMMANDS = ("stability", "modes", "damper", "vehicles", "profiles", "simulate", "switch", "bifurcation", "curving", "study", "tilt")


class _Parser(argparse.ArgumentParser):
    """A parser that raises instead of printing its usage and leaving."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        # -20km/h is a value, to be refused by whoever knows why
        self._negative_number_matcher = re.compile(r"-\.?\d\S*")

    def error(self, message):
        raise CommandError(f"{message}; see {self.prog} --help")


def main(arguments=None):
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Those of the process if not given.

    Returns
    -------
    int
        Exit status: 0, or 2 after an error.
    """
    _one_thread()
    try:
        options = _parsed(sys.argv[1:] if arguments is None else list(arguments))
        options.run(options)
    except BrokenPipeError:
        # the reader of the output has left, as `| head` does: nothing to say, nowhere to say it
        sys.stdout = None
    except ModuleNotFoundError as error:
        if error.name != "railsym._railsym":
            raise
        return _failed("this railsym is a source directory without the compiled library; install it (pip install .), "
                       "and use the command railsym or another working directory")
    except RailsymError as error:
        return _failed(error)
    except KeyboardInterrupt:
        return _failed("interrupted")
    return 0


def _one_thread():
    """Matrices of some hundred rows are solved twice as fast on one thread; what the user has set stands.

    Read when NumPy is loaded, which the commands do after this.
    """
    if not {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"} & os.environ.keys():
        os.environ["OPENBLAS_NUM_THREADS"] = "1"


def _failed(message):
    print(f"railsym: {message}", file=sys.stderr)
    return 2


def _parsed(arguments):
    """Options of the arguments; a misspelt command or option is named with its nearest match."""
    if arguments and not arguments[0].startswith("-") and arguments[0] not in _COMMANDS:
        raise CommandError(f"there is no command {arguments[0]!r}{_near(arguments[0], _COMMANDS)}; there are {', '.join(_COMMANDS)}")
    parser, commands = _parser()
    valued = ("stability", "modes", "simulate", "switch", "bifurcation", "tilt")
    taking = _taking_values(commands.choices[arguments[0]]) if arguments and arguments[0] in valued else {}
    try:
        options, unknown = parser.parse_known_args(vehicle_first(arguments, taking))
    except CommandError as error:
        raise (missing_vehicle(error, arguments, taking) if "required: VEHICLE" in str(error) else error) from None
    if unknown:
        known = re.findall(r"--[a-z-]+", commands.choices[arguments[0]].format_usage())
        raise CommandError(f"{arguments[0]}: {unknown[0]!r} is no option{_near(unknown[0], known)}; there are {', '.join(known)}")
    return options


def _taking_values(command):
    """Options of a command's parser that may take the word after their value, or after their name: "+" and "?"."""
    return {name: action.nargs for name, action in command._option_string_actions.items() if action.nargs in ("+", "?")}


def _near(name, names):
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    return f" (nearest: {near[0]})" if near else ""


def _parser():
    """The parser, and its action that holds the parsers of the commands."""
    parser = _Parser(prog="railsym", allow_abbrev=False, description="Railway vehicle dynamics: stability of vehicles described by data.")
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and leave")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)
    _add_stability(commands)
    _add_modes(commands)
    add_damper(commands).set_defaults(run=_run("cli_damper", "run"))
    listing = commands.add_parser("vehicles", help="list the vehicles that come along, their bodies and configurations")
    listing.add_argument("--json", nargs="?", const="-", metavar="FILE", help="as JSON, to FILE or standard output")
    listing.set_defaults(run=_run("cli_modes", "list_vehicles"))
    add_profiles(commands, _typed, _add_output)
    add_simulate(commands, _typed, _add_vehicle, _add_output).set_defaults(run=_run("cli_simulate", "run"))
    add_switch(commands, _typed, _add_vehicle, _add_output).set_defaults(run=_run("cli_switch", "run"))
    add_bifurcation(commands, _typed, _add_output).set_defaults(run=_run("cli_bifurcation", "run"))
    add_study(commands, _typed, _add_output).set_defaults(run=_run("cli_study", "run"))
    add_curving(commands, _typed, _add_vehicle, _add_output).set_defaults(run=_run("cli_curving", "run"))
    add_tilt(commands, _typed, _add_vehicle, _add_output).set_defaults(run=_run("cli_tilt", "run"))
    return parser, commands


class _Version(argparse.Action):
    def __call__(self, parser, *_):
        from importlib.metadata import version

        print(f"railsym {version('railsym')}")
        parser.exit()


def _run(module, function):
    """Import the module of a command only when the command runs."""
    def run(options):
        from importlib import import_module

        getattr(import_module(f"railsym.{module}"), function)(options)
    return run


def _add_stability(commands):
    command = commands.add_parser(
        "stability", help="critical speed against equivalent conicity",
        description="Critical speed of a vehicle on straight track, and the frequency of the mode that becomes unstable, "
                    "against equivalent conicity, by configuration and criterion.")
    _add_vehicle(command)
    command.add_argument("--configuration", nargs="+", metavar="NAME", help="configurations of the vehicle file, or all (default: all)")
    command.add_argument("--conicity", type=_typed(numbers, "conicity"), metavar="RANGE",
                         help="0.2, or 0.1,0.2,0.4, or first:last:count (default 0.05:0.4:8)")
    command.add_argument("--criterion", nargs="+", type=_typed(criterion), metavar="CRITERION",
                         help="real_part, damping_ratio=0.05 (default: real_part damping_ratio=0.05 damping_ratio=0.1)")
    command.add_argument("--speed-range", nargs="+", metavar="RANGE", help="speeds to search, such as 20:700km/h (default 18:900km/h)")
    add_contact(command, _typed)
    command.add_argument("--sensitivity", nargs="?", const="data", choices=("data", "places"),
                         help="which parameters matter: masses, stiffnesses, dampings, contact (data, the default) and the "
                              "coordinates of all places too (places); at the middle conicity, by the first criterion")
    _add_output(command)
    command.set_defaults(run=_run("cli_stability", "run"))


def _add_modes(commands):
    command = commands.add_parser(
        "modes", help="modes at a speed, or followed over a range of speeds",
        description="Frequency, damping ratio and kind of motion of the modes of a vehicle on straight track.")
    _add_vehicle(command)
    command.add_argument("--speed", nargs="+", required=True, metavar="SPEED",
                         help="200km/h or 55m/s; or lowest:highest:count, such as 50:300:26km/h, to follow the modes")
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    command.add_argument("--conicity", type=_typed(numbers, "conicity"), metavar="NUMBER", help="equivalent conicity (default 0.2)")
    add_contact(command, _typed)
    command.add_argument("--frequency", type=float, default=20.0, metavar="HZ", help="highest frequency listed (default 20)")
    command.add_argument("--mode", type=int, metavar="NUMBER", help="mode whose shape is drawn (default: the least damped)")
    _add_output(command)
    command.set_defaults(run=_run("cli_modes", "run"))


def _add_vehicle(command):
    command.add_argument("vehicle", metavar="VEHICLE", help="name of a vehicle that comes along (railsym vehicles), or a TOML file")


def _add_output(command):
    command.add_argument("--plot", metavar="FILE", help="draw the result: png, pdf, svg, ...")
    command.add_argument("--json", nargs="?", const="-", metavar="FILE", help="as JSON, to FILE or standard output")


def _typed(function, *more):
    """A converter for argparse, which would hide the text of a `CommandError`: it is a ValueError."""
    def convert(text):
        try:
            return function(text, *more)
        except CommandError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
    return convert
