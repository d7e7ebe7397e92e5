# SPDX-License-Identifier: BSD-3-Clause
"""Track and wheel-rail contact of the runs of a study, from the analysis' settings and what a case changes."""

from __future__ import annotations

from dataclasses import fields, replace

from railsym.sweep.errors import SweepError
from railsym.sweep.linear_contact import contact_inputs, contact_of
from railsym.sweep.space import Input
from railsym.track import Curve, Track, load_track

_AHEAD = 5.0              # m of track beyond the end of a run
_SECTION = "track.sections."
_IRREGULARITY = "track.irregularity_"


def part_of(settings, prefix):
    """Settings of a kind, as a key: pairs of name and value."""
    return tuple(sorted((name, value) for name, value in settings.items() if name.startswith(prefix)))


def contact_inputs_of(analysis, vehicle):
    """Inputs ``contact.*``: of the linear contact, or of the pair of profiles."""
    if analysis.conicity is not None:
        return contact_inputs(vehicle, analysis.conicity)
    return {"contact.friction": Input("-", vehicle.contact.get("friction", 0.3)), "contact.gauge": Input("m", analysis.gauge),
            "contact.inclination": Input("-", analysis.inclination)}


def contact_for(analysis, vehicle, settings):
    """Contact of a run, and further arguments of `railsym.simulate`."""
    if analysis.conicity is not None:
        return contact_of(analysis.conicity, settings), {}
    from railsym.contact_pair import DEEPEST_IN_MOTION, ContactPair

    wheelsets = [body for body in vehicle.bodies if body.kind == "wheelset"]
    sizes = {(body.wheel_radius, body.contact_half_spacing) for body in wheelsets}
    if len(sizes) != 1:
        raise SweepError(f"transient: the wheelsets of {vehicle.name!r} differ in wheel radius or spacing, and a pair of profiles has one; give a conicity")
    (radius, half), = sizes
    pair = ContactPair(analysis.wheel, analysis.rail, inclination=settings.get("contact.inclination", analysis.inclination) or None,
                       gauge=settings.get("contact.gauge", analysis.gauge), wheel_radius=radius)
    pair = replace(pair, flange_back_distance=2.0 * (half - pair.tape_circle_offset))
    friction = {"friction": settings["contact.friction"]} if "contact.friction" in settings else {}
    return pair.table(deepest=DEEPEST_IN_MOTION), {"law": analysis.law} | friction


def track_inputs(analysis):
    """Inputs ``track.*``: measures of its sections, and of its irregularity."""
    found = {}
    if analysis.track is not None:
        track = load_track(analysis.track)
        sections = track.sections if isinstance(track.sections, tuple) else ()
        for k, section in enumerate(sections):
            found |= {f"{_SECTION}{k}.{one.name}": Input("m", value) for one in fields(section)
                      if isinstance(value := getattr(section, one.name), float)}
        first = next((section for section in sections if isinstance(section, Curve)), None)
        if first is not None:
            found |= {"track.radius": Input("m", first.radius), "track.cant": Input("m", first.cant)}
    if analysis.irregularity is not None:
        found |= {f"{_IRREGULARITY}scale": Input("-", analysis.irregularity_scale), f"{_IRREGULARITY}seed": Input("-", float(analysis.irregularity_seed))}
    return found


def track_for(analysis, vehicle, settings, speed):
    """Track of a run (None: straight and level without end), and how long it takes, s."""
    ahead = max(body.position[0] for body in vehicle.bodies)
    track = None if analysis.track is None else _changed(load_track(analysis.track), settings)
    duration = analysis.duration
    if track is not None:
        longest = track.length / speed - 2.0 * analysis.step     # the foremost body begins at s = 0 and stays on the track
        duration = longest if duration is None else duration
        if duration > longest:
            raise SweepError(f"transient: track {track.name!r} is {track.length:.6g} m long, and {duration:g} s at {speed:.4g} m/s take "
                             f"{speed * duration:.6g} m")
    elif analysis.irregularity is not None:
        track = Track.straight(ahead + speed * duration + _AHEAD)
    if analysis.irregularity is not None:
        seed = settings.get(f"{_IRREGULARITY}seed", analysis.irregularity_seed)
        track = track.with_irregularity(analysis.irregularity, seed=_whole(seed), scale=settings.get(f"{_IRREGULARITY}scale", analysis.irregularity_scale))
    return track, duration


def _whole(seed):
    if seed != int(seed) or seed < 0:
        raise SweepError(f"track.irregularity_seed = {seed:g}: whole numbers from 0 are needed; list them: values = [[1, 2, 3], \"-\"]")
    return int(seed)


def _changed(track, settings):
    """The track with other measures of its sections."""
    if not isinstance(track.sections, tuple):
        return track
    sections = list(track.sections)
    for name in ("radius", "cant"):
        if f"track.{name}" in settings:
            sections = [replace(s, **{name: settings[f"track.{name}"]}) if isinstance(s, Curve) else s for s in sections]
    for key, value in settings.items():
        if key.startswith(_SECTION):
            number, _, name = key[len(_SECTION):].partition(".")
            sections[int(number)] = replace(sections[int(number)], **{name: value})
    return replace(track, sections=tuple(sections)) if sections != list(track.sections) else track
