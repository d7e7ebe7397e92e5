# SPDX-License-Identifier: BSD-3-Clause
"""CSV tables over arc length, with units in the heading: ``s [m], cant [mm]``."""

import csv
import re
from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.units import UnitError, same_dimension, to_si
from railsym.vehicle_checks import unknown

_HEADING = re.compile(r"\s*(.*?)\s*[\[(]\s*([^\])]+?)\s*[\])]\s*")


def read_table(path, columns, needed):
    """Columns of a CSV file, in SI.

    Parameters
    ----------
    path : path
        Separated by commas, semicolons or tabs (with the latter two a decimal comma is read); lines that begin with # are left out.
    columns : dict of str to (str or tuple of str)
        Name -> SI unit of the columns that may be there, or several that it may have: found under "NAME UNIT" in other units than the first.
    needed : sequence of str

    Returns
    -------
    dict of str to ndarray

    Raises
    ------
    TrackError
        Naming the file, and column or line.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise TrackError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        example = (needed or tuple(columns))[-1]
        raise TrackError(f"{path.name}: is empty; a heading line such as \"s [m], {example} [{_first(columns[example])}]\" and lines of numbers are needed")
    separator = next((mark for mark in ("\t", ";") if mark in lines[0][1]), ",")
    names, units = _headings(path.name, next(csv.reader([lines[0][1]], delimiter=separator)), columns)
    for name in needed:
        if name not in names:
            raise TrackError(f"{path.name}: column {name!r} is missing; there are {', '.join(names)}")
    values = _numbers(path.name, lines[1:], separator, len(names))
    found = {}
    for name, unit, column in zip(names, units, values.T, strict=True):
        units = (columns[name],) if isinstance(columns[name], str) else columns[name]
        try:
            fits = [expected for expected in units if same_dimension(unit, expected)] or units[:1]
            found[name if fits[0] == units[0] else f"{name} {fits[0]}"] = to_si(column, unit, fits[0])
        except UnitError as error:
            raise TrackError(f"{path.name}: column {name!r}: {error}") from None
    return found


def _first(units):
    return units if isinstance(units, str) else units[0]


def _headings(file, cells, columns):
    names, units = [], []
    for cell in cells:
        match = _HEADING.fullmatch(cell)
        name = (match[1] if match else cell).strip().lower()
        if name not in columns:
            raise TrackError(f"{file}: column {name!r} is {unknown(name, columns, 'columns')}")
        if match is None:
            raise TrackError(f'{file}: column {name!r} says no unit; write "{name} [{_first(columns[name])}]"')
        if name in names:
            raise TrackError(f"{file}: column {name!r} is there twice")
        names.append(name)
        units.append(match[2])
    return names, units


def _numbers(file, lines, separator, count):
    if len(lines) < 2:
        raise TrackError(f"{file}: holds {len(lines)} line{'' if len(lines) == 1 else 's'} of numbers; at least 2 are needed")
    rows = []
    for at, line in lines:
        cells = line.split(separator)
        if len(cells) != count:
            raise TrackError(f"{file}, line {at}: {len(cells)} numbers, but {count} headings")
        try:
            row = [float(cell if separator == "," else cell.replace(",", ".")) for cell in cells]
        except ValueError:
            raise TrackError(f"{file}, line {at}: {line.strip()[:60]!r} is not a row of numbers; leave out the line of a gap") from None
        if not np.isfinite(row).all():
            raise TrackError(f"{file}, line {at}: {line.strip()[:60]!r} holds a number that is not finite")
        rows.append(row)
    return np.array(rows)


def checked_columns(what, s, columns):
    """Arc length and columns as read-only arrays of one length; s increasing.

    Raises
    ------
    TrackError
    """
    arrays = {}
    for name, values in {"s": s, **columns}.items():
        try:
            array = np.array(values, dtype=float)
        except (TypeError, ValueError):
            raise TrackError(f"{what}: {name} is not an array of numbers") from None
        if array.ndim != 1 or len(array) < 2:
            raise TrackError(f"{what}: {name} has shape {array.shape}; one dimension with at least 2 numbers is needed")
        if not np.isfinite(array).all():
            raise TrackError(f"{what}: {name}[{int(np.flatnonzero(~np.isfinite(array))[0])}] is not finite")
        array.setflags(write=False)
        arrays[name] = array
    for name, array in arrays.items():
        if len(array) != len(arrays["s"]):
            raise TrackError(f"{what}: {len(arrays['s'])} values of s, but {len(array)} of {name}")
    wrong = np.flatnonzero(np.diff(arrays["s"]) <= 0.0)
    if len(wrong):
        k = int(wrong[0])
        raise TrackError(f"{what}: s must increase, but {arrays['s'][k]:.9g} m is followed by {arrays['s'][k + 1]:.9g} m")
    return arrays
