# SPDX-License-Identifier: BSD-3-Clause
"""Names, units and places of channels, and how they are found."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase

from railsym.results.errors import ResultError, UnknownChannelError

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.+-]*")
_MOST_LISTED = 12
TIME = "time"


@dataclass(frozen=True)
class Channel:
    """One quantity over time.

    Parameters
    ----------
    name : str
        Such as ``"bogie1.above_wheelset1_left.ay"``: letters, digits, ``_ . + -``, beginning with a letter.
    unit : str
        Such as ``"m/s^2"``; ``"-"`` for a pure number.
    description : str
    place : str
        Where on the vehicle, in words or coordinates; empty where it has none.

    Raises
    ------
    ResultError
        A name that files cannot hold, or no unit.
    """

    name: str
    unit: str
    description: str = ""
    place: str = ""

    def __post_init__(self):
        for field in ("name", "unit", "description", "place"):
            if not isinstance(getattr(self, field), str):
                raise ResultError(f"channel {self.name!r}: its {field} must be a text, not {getattr(self, field)!r}")
        if not _NAME.fullmatch(self.name) or self.name == TIME:
            raise ResultError(f"channel name {self.name!r}: letters, digits and _ . + - are allowed, beginning with a letter; 'time' is taken")
        if not self.unit.strip() or "\n" in self.unit or "]" in self.unit:
            raise ResultError(f"channel {self.name!r}: unit {self.unit!r}: give a unit such as 'm/s^2', or '-' for a pure number")


class Channels(Mapping):
    """Channels by name, in their order. ``channels.match("*.Y")`` gives the names that fit a pattern.

    Parameters
    ----------
    channels : iterable of Channel

    Raises
    ------
    ResultError
        Two channels of one name.
    """

    def __init__(self, channels):
        self._by_name = {}
        for channel in channels:
            if not isinstance(channel, Channel):
                raise ResultError(f"a Channel is needed, not {channel!r}: railsym.results.Channel(name, unit)")
            if channel.name in self._by_name:
                raise ResultError(f"channel {channel.name!r} is given twice")
            self._by_name[channel.name] = channel

    def __getitem__(self, name):
        if name not in self._by_name:
            raise UnknownChannelError(unknown(name, self._by_name))
        return self._by_name[name]

    def __contains__(self, name):
        return name in self._by_name

    def __iter__(self):
        return iter(self._by_name)

    def __len__(self):
        return len(self._by_name)

    def __repr__(self):
        return f"<{len(self)} channels: {listed(self._by_name)}>"

    def match(self, *patterns):
        """Names that fit at least one pattern, in the order of the channels; none is no error.

        Parameters
        ----------
        *patterns : str
            ``*`` any characters (dots too), ``?`` one character, ``[ab]`` one of these.

        Returns
        -------
        tuple of str
        """
        return tuple(name for name in self._by_name if any(fnmatchcase(name, pattern) for pattern in patterns))

    def require(self, *patterns):
        """As `match`, but each pattern must fit something.

        Raises
        ------
        UnknownChannelError
        """
        for pattern in patterns:
            if not self.match(pattern):
                raise UnknownChannelError(unknown(pattern, self._by_name))
        return self.match(*patterns)


def unknown(name, names):
    """Text for a name or pattern that fits none of ``names``."""
    plain = str(name).strip("*?.")
    near = difflib.get_close_matches(str(name), names, n=3, cutoff=0.6) or [n for n in names if plain and plain.lower() in n.lower()][:3]
    what = f"no channel fits {name!r}" if any(c in str(name) for c in "*?[") else f"there is no channel {name!r}"
    hint = f"; near: {', '.join(near)}" if near else ""
    return f"{what}{hint}; there are {len(names)}: {listed(names)}"


def listed(names):
    """The names, shortened when there are many: one a group of names that differ in their digits only."""
    names = list(names)
    if not names:
        return "none"
    if len(names) <= _MOST_LISTED:
        return ", ".join(names)
    kinds = {}
    for name in names:
        kinds.setdefault(re.sub(r"\d+", "#", name), []).append(name)
    shown = [group[0] if len(group) == 1 else f"{group[0]} ... {group[-1]}" for group in kinds.values()]
    more = f", and {len(shown) - _MOST_LISTED} more kinds (all: list(run.channels))" if len(shown) > _MOST_LISTED else ""
    return ", ".join(shown[:_MOST_LISTED]) + more
