# SPDX-License-Identifier: BSD-3-Clause
"""``railsym tilt``: curves passively and with active tilt, as in section 4 of the paper."""

from __future__ import annotations

import sys

import numpy as np

from railsym.cli_output import check_plot_path, deliver, say
from railsym.cli_pair import add_contact, profile_pair
from railsym.cli_values import CommandError, quantity

_SEED = 1


def add_tilt(commands, typed, add_vehicle, add_output):
    """Add the command to the parser."""
    command = commands.add_parser(
        "tilt", help="a tilting vehicle in curves: passive, active, and quicker",
        description="Runs of a tilting vehicle through curves: body held upright, tilted by accelerometers and gyroscope on the leading bogie, and with "
                    "better detection, the sensors of a leading vehicle, a track database: accelerations, lag, actuators, wheel forces.")
    add_vehicle(command)
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    command.add_argument("--track", metavar="TRACK", default="s_curve_500", help="name of a track that comes along or a TOML file (default s_curve_500)")
    command.add_argument("--irregularity", metavar="NAME", help="spectrum, or a CSV file of measured irregularities (default: none)")
    command.add_argument("--seed", type=int, metavar="NUMBER", help=f"of irregularity and sensor noise (default {_SEED})")
    command.add_argument("--speed", type=typed(quantity, "m/s", "speed"), metavar="SPEED", help="such as 105km/h (the default)")
    command.add_argument("--share", type=float, metavar="PART", help="of the cant deficiency that tilt compensates (default 0.6)")
    command.add_argument("--limit", type=float, metavar="DEGREES", help="of tilt (default 8)")
    command.add_argument("--rate", type=typed(quantity, "Hz", "control rate"), metavar="RATE", help="of the controller (default 100Hz)")
    command.add_argument("--latency", type=typed(quantity, "s", "latency"), metavar="TIME", help="from a sample to its command (default 20ms)")
    command.add_argument("--coach", type=typed(quantity, "m", "coach length"), metavar="LENGTH", help="the leading vehicle is so far ahead (default 25.9m)")
    command.add_argument("--database-offset", type=typed(quantity, "m", "database offset"), metavar="LENGTH",
                         help="error of the place in the track database (default 5m)")
    command.add_argument("--no-improvements", action="store_true", help="passive and active only")
    command.add_argument("--faults", action="store_true", help="also sensors and actuators that fail, and what it ends in (a minute)")
    command.add_argument("--sensitivity", action="store_true", help="also the active case with other biases, losses and delays (half a minute)")
    command.add_argument("--law", metavar="NAME", default="fastsim", help="creep law (default fastsim)")
    command.add_argument("--step", type=typed(quantity, "s", "step"), metavar="TIME", default=1e-3, help="of the integration (default 1ms)")
    add_contact(command, typed)
    command.add_argument("--animate", metavar="FILE", help="a moving picture of the tilting body from behind: .gif, .mp4")
    command.add_argument("--animate-frames", type=int, metavar="COUNT", default=120, help="pictures (default 120)")
    add_output(command)
    command.set_defaults(conicity=None)
    return command


def run(options):
    """Run the study and show what it found."""
    from railsym.cli_modes import _configured
    from railsym.studies.tilt import COACH, OFFSET, SPEED, tilt_study
    from railsym.studies.tilt_report import as_data
    from railsym.vehicle import load_vehicle

    check_plot_path(options.plot)
    _check_animation(options.animate)
    vehicle = _configured(load_vehicle(options.vehicle), options.configuration)
    pair, _ = profile_pair(options, vehicle)
    parameters, sensors = _control(options)
    speed = SPEED if options.speed is None else options.speed
    if not speed > 0.0:
        raise CommandError(f"--speed {speed:g} m/s: a speed above 0 is needed")
    study = tilt_study(vehicle, _track(options), speed=speed, pair=pair, parameters=parameters, sensors=sensors, improvements=not options.no_improvements,
                       faults=options.faults, sensitivity=options.sensitivity, coach=COACH if options.coach is None else options.coach,
                       offset=OFFSET if options.database_offset is None else options.database_offset, law=options.law, friction=options.friction,
                       dt=options.step, channels=_drawn(options, vehicle), progress=sys.stderr.isatty())
    deliver(options, lambda: str(study), lambda: as_data(study), study.plot)
    if options.animate:
        from railsym.plots.tilt_animation import animate_tilt

        say(animate_tilt(study, options.animate, frames=options.animate_frames, progress=sys.stderr.isatty()).message)


def _control(options):
    """Parameters and sensors."""
    from railsym.tilt import SensorSet, TiltParameters

    sensors = SensorSet(seed=_SEED if options.seed is None else options.seed)
    given = {"share": options.share, "limit": None if options.limit is None else np.radians(options.limit), "rate": options.rate, "latency": options.latency}
    given = {name: value for name, value in given.items() if value is not None}
    return TiltParameters(sensor_delay=sensors.yaw_rate.delay).with_(**given), sensors


def _track(options):
    from railsym.track import load_track

    track = load_track(options.track)
    if not options.irregularity:
        return track
    measured = str(options.irregularity).lower().endswith((".csv", ".txt"))
    return track.with_irregularity(options.irregularity, seed=None if measured else _SEED if options.seed is None else options.seed)


def _check_animation(path):
    if path:
        from railsym.plots.animation import check_path

        check_path(path)


def _drawn(options, vehicle):
    """Channels of an animation."""
    if not options.animate:
        return ()
    from railsym.plots.tilt_animation import tilt_channels

    return tilt_channels(vehicle)
