# SPDX-License-Identifier: BSD-3-Clause
"""Strict reading of a track file (TOML). The format is described in docs/track.md."""

import tomllib
from pathlib import Path

from railsym.errors import TrackError
from railsym.track import schema
from railsym.track.irregularity import read_irregularity
from railsym.track.geometry_file import read_geometry
from railsym.track.toml_values import Reader
from railsym.track.track import Track
from railsym.vehicle_checks import unknown

_FOLDER = Path(__file__).resolve().parent.parent / "data" / "tracks"
_TOP = ("track", "sections", "vertical", "geometry", "irregularities", "switches")


def tracks():
    """Names of the tracks that come along.

    Returns
    -------
    tuple of str
    """
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load_track(name_or_path):
    """A track by name, or from a TOML file.

    Parameters
    ----------
    name_or_path : str or path
        One of `tracks`; or a file that ends in .toml (files that it names are looked up beside it), or a CSV file of measured
        geometry (`Track.from_file`).

    Returns
    -------
    railsym.track.track.Track

    Raises
    ------
    TrackError
        Naming file, key, value, what is allowed and the nearest match.
    """
    path = Path(name_or_path)
    if path.suffix.lower() == ".csv":
        return Track.from_file(path)
    if path.suffix != ".toml":
        if str(name_or_path) not in tracks():
            raise TrackError(f"track {str(name_or_path)!r} is {unknown(name_or_path, tracks(), 'names')}; a file ends in .toml, measured geometry in .csv")
        path = _FOLDER / f"{name_or_path}.toml"
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise TrackError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    return _TrackReader(path.name, path.parent).track(document)


class _TrackReader(Reader):

    def __init__(self, file, folder):
        super().__init__(file)
        self.folder = folder

    def track(self, document):
        top = self.table("", document, _TOP)
        if ("sections" in top) == ("geometry" in top):
            raise self.problem("sections", None, "give either [[sections]] or [geometry]")
        options = self.values("track", top.get("track", {}), schema.TRACK)
        sections = self.geometry(top["geometry"]) if "geometry" in top else self.list("sections", top, lambda *given: self.typed(*given, schema.SECTIONS))
        return self.made("track", Track, {
            "sections": sections, "vertical": self.list("vertical", top, lambda *given: self.typed(*given, schema.VERTICAL)),
            "irregularities": self.list("irregularities", top, self.irregularity),
            "switches": self.list("switches", top, lambda key, table: self.one(key, table, schema.SWITCH, ("start", "length", "amplitude"))), **options})

    def list(self, key, top, read):
        """A list of tables."""
        tables = top.get(key, [])
        if not isinstance(tables, list):
            raise self.problem(key, tables, f"a list of tables is needed: [[{key}]]")
        return [read(f"{key}[{k}]", table) for k, table in enumerate(tables, 1)]

    def typed(self, key, table, types):
        """One of several classes, by its type."""
        if not isinstance(table, dict) or "type" not in table:
            raise self.problem(f"{key}.type", None, f"is missing; allowed: {', '.join(types)}")
        name = self.text(f"{key}.type", table["type"], types)
        return self.one(key, {part: value for part, value in table.items() if part != "type"}, types[name], schema.NEEDED[name])

    def one(self, key, table, kind, needed=()):
        """An object of a class from its table."""
        made, fields = kind
        return self.made(key, made, self.values(key, table, fields, needed))

    def made(self, key, make, values):
        """make(**values), its error with file and key."""
        try:
            return make(**values)
        except TrackError as error:
            raise TrackError(f"{self.file}: {key}: {error}") from None

    def values(self, key, table, fields, needed=()):
        """Name -> value in SI."""
        self.table(key, table, fields, needed)
        return {name: self.value(f"{key}.{name}", entry, fields[name]) for name, entry in table.items()}

    def value(self, key, entry, kind):
        """One value of a kind of `railsym.track.schema`."""
        if kind == "text":
            return self.text(key, entry)
        if kind in ("whole", "flag"):
            wanted = bool if kind == "flag" else int
            if type(entry) is not wanted:
                raise self.problem(key, entry, "true or false is needed" if kind == "flag" else "a whole number is needed")
            return entry
        word, _, unit = kind.rpartition(" ")
        value = self.quantity(key, entry, unit, {"": None, "pair": 2, "column": -1}[word])
        return tuple(value.tolist()) if word == "pair" else value

    def geometry(self, table):
        """Measured geometry."""
        if isinstance(table, dict) and "file" in table:
            values = self.values("geometry", table, schema.GEOMETRY_FILE)
            return self.made("geometry", read_geometry, {"path": self.folder / values.pop("file"), **values})
        return self.one("geometry", table, schema.GEOMETRY, ("s", "curvature"))

    def irregularity(self, key, table):
        """Random, measured in a file, or measured in the table."""
        if isinstance(table, dict) and "file" in table:
            values = self.values(key, table, schema.IRREGULARITY_FILE)
            return self.made(key, read_irregularity, {"path": self.folder / values.pop("file"), **values})
        if isinstance(table, dict) and "s" in table:
            return self.one(key, table, schema.MEASURED, ("s",))
        values = self.values(key, table, schema.RANDOM[1], ("spectrum", "seed"))
        if (self.folder / values["spectrum"]).is_file():
            values["spectrum"] = str(self.folder / values["spectrum"])
        return self.made(key, schema.RANDOM[0], values)
