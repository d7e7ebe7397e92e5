# SPDX-License-Identifier: BSD-3-Clause
"""``railsym simulate``: a vehicle in motion, as a table, files, pictures and an animation."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from railsym.cli_modes import _configured, speeds
from railsym.cli_output import check_plot_path, finite, save_plot, say, write_json
from railsym.cli_pair import add_contact, pair_contacts, plain_contact
from railsym.cli_values import CommandError, quantity
from railsym.plots.style import KMH

_DURATION = 10.0     # s
_AHEAD = 5.0         # m of track beyond the end of a run, where the track is made for it
_DRAWN = ("wheelset*.y", "*1.above_*.ay", "car*.a[yz]", "*.sum_Y")
_FORMATS = {".nc": None, ".csv": "to_csv", ".mat": "to_mat"}


def add_simulate(commands, typed, add_vehicle, add_output):
    """Add the command to the parser."""
    command = commands.add_parser(
        "simulate", help="a vehicle in motion over a track",
        description="Transient simulation of a vehicle over a track: largest wheel-rail forces and accelerations, running stability, how the run ended.")
    add_vehicle(command)
    command.add_argument("--speed", nargs="+", required=True, metavar="SPEED",
                         help="200km/h or 55m/s; or a file of speed against place or time (.csv, .toml)")
    command.add_argument("--track", metavar="TRACK", help="name of a track that comes along or a TOML file (default: straight and level)")
    command.add_argument("--duration", type=typed(quantity, "s", "duration"), metavar="TIME",
                         help="such as 10s (default: to the end of --track; 10s without it)")
    command.add_argument("--configuration", metavar="NAME", help="configuration of the vehicle file (default: its first)")
    add_contact(command, typed)
    command.add_argument("--conicity", type=float, metavar="NUMBER",
                         help="linear contact of this conicity, without wheel-rail forces, in place of profiles (default: S1002 on UIC60, 1:40)")
    command.add_argument("--law", metavar="NAME", help="creep law on profiles (default fastsim)")
    command.add_argument("--irregularity", metavar="NAME", help="spectrum, such as erri_b176_low, or a CSV file of measured irregularities")
    command.add_argument("--seed", type=int, metavar="NUMBER", help="of --irregularity from a spectrum (default 1)")
    command.add_argument("--step", type=typed(quantity, "s", "step"), default=1e-3, metavar="TIME", help="of the integration (default 1ms)")
    command.add_argument("--rate", type=typed(quantity, "Hz", "rate"), metavar="RATE", help="samples in a second (default 200Hz)")
    command.add_argument("--channels", nargs="+", metavar="NAME",
                         help="channels and patterns that are drawn, and saved beside the usual ones; list shows all")
    command.add_argument("--save", metavar="FILE", help="save the run: .nc (written as it goes, not kept in memory), .csv or .mat")
    command.add_argument("--animate", metavar="FILE", help="animation from above and behind: .gif, or .mp4 with ffmpeg")
    command.add_argument("--animate-range", metavar="RANGE", help="part that is animated, such as 2:4s (default: the last 2 s)")
    command.add_argument("--animate-factor", type=float, metavar="NUMBER", help="exaggeration of motions (default: so that they are seen)")
    command.add_argument("--animate-frames", type=int, default=96, metavar="NUMBER", help="pictures, 16 a second (default 96)")
    add_output(command)
    return command


def run(options):
    """Simulate, and show what the options ask for."""
    from railsym.cli_run_table import as_data, run_table
    from railsym.simulation import Simulation
    from railsym.vehicle import load_vehicle

    _check_files(options)
    vehicle = _configured(load_vehicle(options.vehicle), options.configuration)
    speed, shown = _speed(" ".join(options.speed))
    duration, track = duration_and_track(options, vehicle, speed)
    contact, more, text = _contact(options, vehicle)
    arguments = {"speed": speed, "track": track, "contact": contact, "dt": options.step, "rate": options.rate, **more}
    simulation = Simulation(vehicle, channels="s", **arguments)
    if options.channels == ["list"]:
        say("\n".join(f"{name}  [{recipe.channel.unit}]  {recipe.channel.description}" for name, recipe in simulation.available.items()))
        return
    found = _simulated(simulation, options, vehicle, duration, arguments)
    if options.json != "-":
        name = f"{vehicle.name}, {vehicle.configuration}" if vehicle.configuration else vehicle.name
        say(f"{name}: {shown}, track {getattr(track, 'name', 'straight')}{_irregular(options)}, {text}")
        say(run_table(found))
    if options.json:
        write_json(finite(as_data(found)), options.json)
    if options.plot:
        save_plot(lambda: found.plot(_drawn(found, options)), options.plot)
    if options.animate:
        _animate(found, vehicle, track, options)


def _speed(text):
    """Speed as `Simulation` takes it, from ``200km/h`` or the name of a file, and in words."""
    if Path(text).suffix.lower() in (".csv", ".toml"):
        from railsym.simulation import load_speed

        return load_speed(text), f"speed of {Path(text).name}"
    found = speeds(text)
    if len(found) != 1:
        raise CommandError(f"--speed {text}: a run has one speed, or a file of speed against place or time (.csv, .toml)")
    return float(found[0]), f"{KMH * found[0]:.4g} km/h"


def _simulated(simulation, options, vehicle, duration, arguments):
    """The run, saved where asked."""
    from railsym.simulation import simulate
    from railsym.simulation.channels import DEFAULT

    wanted = _recorded(simulation.available, options, vehicle, DEFAULT)
    streamed = options.save if options.save and Path(options.save).suffix.lower() == ".nc" else None
    found = simulate(vehicle, duration=duration, channels=wanted, progress=sys.stderr.isatty(), save=streamed, keep="file" if streamed else "memory",
                     **arguments)
    if options.save and not streamed:
        try:
            getattr(found, _FORMATS[Path(options.save).suffix.lower()])(options.save)
        except OSError as error:
            raise CommandError(f"--save {options.save}: {error.strerror or error}") from None
    return found


def _recorded(available, options, vehicle, usual):
    """Names of the channels to record: the usual ones, those asked for, those of an animation."""
    from railsym.plots.animation import animation_channels
    from railsym.results.channel import Channels
    from railsym.simulation.channels import chosen

    known = Channels(recipe.channel for recipe in available.values())
    names = [*known.match(*usual), *(recipe.channel.name for recipe in chosen(available, options.channels) if options.channels)]
    return list(dict.fromkeys([*names, *(animation_channels(vehicle) if options.animate else ())]))


def _drawn(found, options):
    if options.channels:
        return options.channels
    return [pattern for pattern in _DRAWN if found.channels.match(pattern)]


def duration_and_track(options, vehicle, speed):
    """Duration (s), and the Track or None; ``speed`` as `Simulation` takes it.

    Raises
    ------
    CommandError
        A run that is not above 0 s, or longer than the track.
    """
    from railsym.simulation import SpeedProfile
    from railsym.track import Track, load_track

    places = [body.position[0] for body in vehicle.bodies]
    ahead = max(places, default=0.0)
    profile = SpeedProfile.of(speed, -ahead)
    if options.duration is not None and not 0.0 < options.duration < np.inf:
        raise CommandError(f"--duration {options.duration:g} s: a time above 0 s is needed")
    track = load_track(options.track) if options.track else None
    if track is None:
        duration = _DURATION if options.duration is None else options.duration
        track = Track.straight(ahead + _way(profile, duration) + _AHEAD) if options.irregularity else None
    else:
        # the foremost body begins at s = 0, and stays within the track by a step
        longest = options.step * (np.ceil(float(profile.when(track.length - ahead)) / options.step - 1e-6) - 1.0)
        duration = longest if options.duration is None else options.duration
        if duration > longest + 1e-9:
            raise CommandError(f"track {track.name!r} is {track.length:.6g} m long, and {duration:g} s {_at(speed)} take "
                               f"{_way(profile, duration):.6g} m: a --duration of at most {np.floor(100.0 * longest) / 100.0:g}s fits, or a longer track")
    return duration, _with_irregularity(track, options)


def _way(profile, duration):
    """Distance (m) in a time (s)."""
    return float(profile.speed[0]) * duration if profile.constant else float(profile.place(duration) - profile.place(0.0))


def _at(speed):
    return f"at {KMH * speed:.4g} km/h" if np.ndim(speed) == 0 and not hasattr(speed, "speed") else "at the speeds of the file"


def _with_irregularity(track, options):
    if options.irregularity is None:
        if options.seed is not None:
            raise CommandError("--seed goes with --irregularity, such as --irregularity erri_b176_low")
        return track
    measured = Path(options.irregularity).suffix.lower() in (".csv", ".txt")
    return track.with_irregularity(options.irregularity, seed=options.seed if measured or options.seed is not None else 1)


def _irregular(options):
    if options.irregularity is None:
        return ""
    measured = Path(options.irregularity).suffix.lower() in (".csv", ".txt")
    return f" with {options.irregularity}" + ("" if measured else f" (seed {1 if options.seed is None else options.seed})")


def _contact(options, vehicle):
    """Contact, further arguments of `Simulation`, and both in words."""
    if options.conicity is not None and options.wheel is None and options.rail is None:
        if options.law is not None:
            raise CommandError("--law belongs to contact on profiles: leave out --conicity, or --law")
        contact = replace(plain_contact(options), conicity=options.conicity)
        return contact, {}, f"linear contact of conicity {options.conicity:g}"
    return profile_contact(options, vehicle)


def profile_contact(options, vehicle):
    """Contact table of the profiles, further arguments of `Simulation`, and both in words; S1002 on UIC60 where none are given."""
    from railsym.contact_pair import DEEPEST_IN_MOTION

    options.conicity = getattr(options, "conicity", None)
    if options.wheel is None and options.rail is None:
        options.wheel, options.rail = "S1002", "UIC60"

    found = pair_contacts(options, [vehicle])
    law = options.law or "fastsim"
    more = {"law": law} | ({} if options.friction is None else {"friction": options.friction})
    return found.pair.table(deepest=DEEPEST_IN_MOTION), more, f"{found.title}, {law}"


def _check_files(options):
    """Refuse files that could not be written, before anything is computed."""
    check_plot_path(options.plot)
    if options.save:
        path = Path(options.save)
        if path.suffix.lower() not in _FORMATS:
            raise CommandError(f"--save {path}: the name must end in {', '.join(_FORMATS)}")
        if not path.resolve().parent.is_dir():
            raise CommandError(f"--save {path}: there is no directory {path.resolve().parent}")
    if options.animate:
        from railsym.plots.animation import check_path

        check_path(options.animate)
    elif options.animate_range or options.animate_factor is not None:
        raise CommandError("--animate-range and --animate-factor go with --animate FILE")


def _animate(found, vehicle, track, options):
    from railsym.plots.animation import animate

    end = float(found.time[-1])
    start, end = _range(options.animate_range) if options.animate_range else (max(0.0, end - 2.0), end)
    made = animate(found, vehicle, options.animate, track=track, start=start, end=end, factor=options.animate_factor, frames=options.animate_frames,
                   progress=sys.stderr.isatty())
    if options.json != "-":
        say(made.message)


def _range(text):
    """``2:4s`` as two times (s)."""
    first, colon, last = text.partition(":")
    if not colon:
        raise CommandError(f"--animate-range {text!r}: write first:last with their unit, such as 2:4s")
    unit = last.strip().lstrip("+-.0123456789eE")
    return tuple(quantity(part if part.strip().endswith("s") else part + unit, "s", "time") for part in (first, last))
