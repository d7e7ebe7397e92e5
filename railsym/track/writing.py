# SPDX-License-Identifier: BSD-3-Clause
"""A track as text of a track file; reading it gives the same track to the last bit."""

import json
from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.track import schema
from railsym.track.irregularity import RandomIrregularity
from railsym.track.measured import MeasuredGeometry

_HEAD = "# A track: docs/track.md. Lengths along the track; curves to the right, cant of the outer rail; left rail higher on straights.\n"


def track_toml(track, path=None):
    """Text of the track file, written to ``path`` if given.

    Raises
    ------
    TrackError
        If the file cannot be written.
    """
    parts = [_HEAD, _table("[track]", track, schema.TRACK)]
    if isinstance(track.sections, MeasuredGeometry):
        parts.append(_table("[geometry]", track.sections, schema.GEOMETRY[1]))
    for key, types, members in (("sections", schema.SECTIONS, track.sections), ("vertical", schema.VERTICAL, track.vertical)):
        if not isinstance(members, MeasuredGeometry):
            parts += [_typed(f"[[{key}]]", member, types) for member in members]
    for member in track.irregularities:
        kind = schema.RANDOM if isinstance(member, RandomIrregularity) else schema.MEASURED
        parts.append(_table("[[irregularities]]", member, kind[1]))
    parts += [_table("[[switches]]", member, schema.SWITCH[1]) for member in track.switches]
    text = "\n".join(parts)
    if path is not None:
        try:
            Path(path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise TrackError(f"{path}: cannot be written ({error.strerror})") from None
    return text


def _typed(heading, member, types):
    name = next(name for name, (made, _) in types.items() if made is type(member))
    return _table(heading, member, types[name][1], f'type = "{name}"')


def _table(heading, member, kinds, *first):
    """The table of an object: every field that is not at its default."""
    defaults = {field.name: field.default for field in fields(member)}
    lines = [heading, *first]
    for name, kind in kinds.items():
        value = getattr(member, name)
        if value is None or (defaults[name] is not MISSING and np.ndim(value) == 0 and value == defaults[name]):
            continue
        lines.append(f"{name} = {_written(value, kind)}")
    return "\n".join(lines) + "\n"


def _written(value, kind):
    if kind == "text":
        return json.dumps(str(value), ensure_ascii=False)
    if kind == "whole":
        return str(value)
    if kind == "flag":
        return "true" if value else "false"
    unit = kind.rpartition(" ")[2]
    numbers = repr(float(value)) if np.ndim(value) == 0 else "[" + ", ".join(repr(float(one)) for one in value) + "]"
    return f'[{numbers}, "{unit}"]'
