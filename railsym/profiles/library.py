# SPDX-License-Identifier: BSD-3-Clause
"""Profiles by name or file."""

from __future__ import annotations

import difflib
import tomllib
from functools import lru_cache
from pathlib import Path

from railsym.profiles.checks import ProfileError
from railsym.profiles.formulas import profile_from_zones
from railsym.profiles.profile import Profile

SHIPPED = Path(__file__).resolve().parent.parent / "data" / "profiles"
_KEYS = {"name", "kind", "description", "unit", "origin", "mirrored", "inclined", "zones"}


def profiles():
    """Names of the profiles that come along.

    Returns
    -------
    tuple of str
    """
    return tuple(sorted(path.stem for path in SHIPPED.glob("*.toml")))


def load_profile(name_or_path, kind=None, *, smoothing=0.0, mirror=False, upward=None, unit=None, shift=0.0):
    """A profile that comes along, or one from a file.

    Parameters
    ----------
    name_or_path : str or Path or Profile
        A name of `profiles`, or a file: zones as ``.toml``, points as ``.csv``, ``.prw``/``.prr`` (SIMPACK) or
        ``.whl``/``.ban`` (MiniProf). A `Profile` comes back as it is.
    kind : {"wheel", "rail"}, optional
        What is wanted; needed for a CSV file that does not say it.
    smoothing : float
        Root-mean-square distance, m, that the curve may keep from measured points; 0 lays it through them.
    mirror : bool
        Exchange left and right: for a profile measured on the left side of the track.
    upward : bool, optional
        The file's z points up. By default as the format says (see docs/profiles.md).
    unit : str, optional
        Length unit of the file, if the file does not say it; mm otherwise.
    shift : float
        m, added to y: -0.070 for a wheel measured from its flange back.

    Returns
    -------
    Profile

    Raises
    ------
    ProfileError
        If there is no such profile, the file cannot be used, or it is of the other kind.
    """
    if isinstance(name_or_path, Profile):
        found = name_or_path
    elif str(name_or_path) in profiles():
        if smoothing or mirror or shift or upward is not None or unit is not None:
            raise ProfileError(f"profile {str(name_or_path)!r} is a formula: smoothing, mirror, upward, unit and shift are for measured files")
        found = _shipped(str(name_or_path))
    else:
        found = _from_file(Path(name_or_path), kind, smoothing, mirror, upward, unit, shift)
    if kind is not None and found.kind != kind:
        raise ProfileError(f"profile {found.name!r} is a {found.kind}, and a {kind} is needed")
    return found


@lru_cache(maxsize=None)
def _shipped(name):
    return _from_zones_file(SHIPPED / f"{name}.toml")


def _from_file(path, kind, smoothing, mirror, upward, unit, shift):
    if not path.is_file():
        near = difflib.get_close_matches(str(path), profiles(), n=1, cutoff=0.4)
        hint = f" (nearest: {near[0]})" if near else ""
        raise ProfileError(f"there is no profile and no file {str(path)!r}{hint}; profiles that come along: {', '.join(profiles())}")
    if path.suffix.lower() == ".toml":
        return _from_zones_file(path)
    from railsym.profiles.reading import read_points

    points = read_points(path, kind, mirror=mirror, upward=upward, unit=unit, shift=shift)
    return Profile.from_points(path.stem, points.kind, points.y, points.z, smoothing=smoothing, origin=str(path.name),
                               description=points.description, inclined=points.inclined)


def _from_zones_file(path):
    """Read a file of zones (lengths in mm)."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ProfileError(f"{path.name}: {error}") from None
    unknown, missing = sorted(set(data) - _KEYS), sorted({"name", "kind", "unit", "origin", "zones"} - set(data))
    if unknown or missing:
        raise ProfileError(f"{path.name}: " + (f"unknown key {unknown[0]!r}" if unknown else f"{missing[0]!r} is missing")
                           + f"; keys are {', '.join(sorted(_KEYS))}")
    if data["unit"] != "mm":
        raise ProfileError(f"{path.name}: unit is {data['unit']!r}; zones must be in mm")
    try:
        return profile_from_zones(data["name"], data["kind"], data["zones"], mirrored=data.get("mirrored", False),
                                  inclined=data.get("inclined", False), description=data.get("description", ""), origin=data["origin"])
    except ProfileError as error:
        raise ProfileError(f"{path.name}: {error}") from None
