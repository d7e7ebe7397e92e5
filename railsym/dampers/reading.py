# SPDX-License-Identifier: BSD-3-Clause
"""Bench records from CSV files, MATLAB files and arrays."""

from __future__ import annotations

import csv
import difflib
import re
from pathlib import Path

import numpy as np

from railsym.dampers.record import Record, RecordError
from railsym.units import UnitError, to_si

CHANNELS = {"time": "s", "displacement": "m", "force": "N", "velocity": "m/s"}
_NAMES = {
    "time": ("time", "t", "zeit", "tempo"),
    "displacement": ("displacement", "disp", "elongation", "stroke", "position", "x"),
    "force": ("force", "f", "load"),
    "velocity": ("velocity", "speed", "v", "rate"),
}
_HEADING = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])]|[,;/]\s*|)\s*")


def read_records(paths, *, units=None, columns=None, force_sign=1):
    """Read bench records, one test a file.

    Parameters
    ----------
    paths : path, mapping of arrays, Record, or a sequence of these
        A CSV file has one heading line that names channels with units, such as ``time [s], displacement [mm], force [kN]``,
        separated by commas, semicolons or tabs (with semicolons and tabs a decimal comma is read); lines that begin with # are
        left out. A ``.mat`` file (up to version 7) holds one array a channel. A mapping has the channels' names as keys. A
        directory stands for its CSV and MAT files.
    units : dict, optional
        Channel -> unit, such as ``{"displacement": "mm"}``; for arrays and MAT files SI without it. A CSV heading without a
        unit needs it.
    columns : dict, optional
        Channel -> heading or variable name, where it is not a usual one, or number of the column (from 0).
    force_sign : {1, -1}
        -1 for a bench that records compression as positive.

    Returns
    -------
    tuple of Record

    Raises
    ------
    RecordError
        A file, channel or unit that cannot be used; the message names the test.

    Examples
    --------
    >>> import railsym as rs
    >>> tests = rs.dampers.read_records(rs.dampers.shipped_records())
    >>> len(tests)
    12
    """
    units, columns = _checked(units, "units"), _checked(columns, "columns")
    if force_sign not in (1, -1):
        raise RecordError(f"force_sign {force_sign!r} is neither 1 nor -1")
    return tuple(_read(one, units, columns, force_sign) for one in _expanded(paths))


def shipped_records():
    """Paths of the synthetic records that come along, by frequency and amplitude.

    Returns
    -------
    tuple of Path
    """
    folder = Path(__file__).resolve().parent.parent / "data" / "dampers"
    return tuple(sorted(folder.glob("*.csv"), key=lambda path: [float(number) for number in re.findall(r"[\d.]*\d", path.stem)]))


def _checked(given, what):
    given = dict(given or {})
    for key in given:
        if key not in CHANNELS:
            near = difflib.get_close_matches(str(key), CHANNELS, n=1)
            raise RecordError(f"{what}: {key!r} is no channel{f' (nearest: {near[0]!r})' if near else ''}; there are {', '.join(CHANNELS)}")
    return given


def _expanded(paths):
    """The single sources; directories replaced by their files."""
    if isinstance(paths, (str, Path, dict, Record)):
        paths = (paths,)
    found = []
    for one in paths:
        if isinstance(one, (str, Path)) and Path(one).is_dir():
            files = sorted(path for path in Path(one).iterdir() if path.suffix.lower() in (".csv", ".txt", ".mat"))
            if not files:
                raise RecordError(f"directory {one} holds no CSV or MAT file")
            found += files
        else:
            found.append(one)
    if not found:
        raise RecordError("there is no record to read")
    return found


def _read(source, units, columns, force_sign):
    if isinstance(source, Record):
        return source
    if isinstance(source, dict):
        return _record(source, units, columns, force_sign, str(source.get("name", "")))
    path = Path(source)
    if path.suffix.lower() == ".mat":
        return _record(_read_mat(path), units, columns, force_sign, path.stem)
    headings, values = _read_csv(path)
    return _record(dict(zip(headings, values)), units, columns, force_sign, path.stem, declared=True)


def _record(table, units, columns, force_sign, name, declared=False):
    """Record of named arrays; ``declared``: each unit must be written in the heading or in ``units``."""
    label, found = f"test {name!r}", {}
    for channel, si in CHANNELS.items():
        key = _heading(table, channel, columns, label)
        if key is None:
            continue
        unit = units.get(channel, _HEADING.fullmatch(str(key))[2])
        if unit is None and declared:
            raise RecordError(f"{label}: column {key!r} says no unit; write {channel} [{si}] in the heading, or give units={{{channel!r}: ...}}")
        try:
            found[channel] = to_si(np.asarray(table[key], dtype=float).ravel(), unit or si, si)
        except UnitError as error:
            raise RecordError(f"{label}: {channel}: {error}") from None
        except (TypeError, ValueError):
            raise RecordError(f"{label}: {channel} is not an array of numbers") from None
    found["force"] = force_sign * found["force"]
    nominal = {key: table[key] for key in ("nominal_frequency", "nominal_amplitude") if key in table}
    return Record(name=name, **found, **{key: float(np.squeeze(value)) for key, value in nominal.items()})


def _heading(table, channel, columns, label):
    """Key of a channel in the table; None for a velocity that is not there."""
    keys = [key for key in table if key not in ("name", "nominal_frequency", "nominal_amplitude")]
    wanted = columns.get(channel)
    if isinstance(wanted, int):
        if not -len(keys) <= wanted < len(keys):
            raise RecordError(f"{label}: there is no column {wanted} for {channel}; there are {len(keys)}, from 0")
        return keys[wanted]
    names = _NAMES[channel] if wanted is None else (wanted, wanted.lower())
    fitting = [key for key in keys if str(key) in names or _HEADING.fullmatch(str(key))[1].lower() in names]
    if len(fitting) == 1:
        return fitting[0]
    if not fitting and wanted is None and channel == "velocity":
        return None
    trouble = "several columns" if fitting else "no column"
    raise RecordError(f"{label}: {trouble} for {channel}; there are {', '.join(map(str, keys))}; say which by columns={{{channel!r}: name or number}}")


def _read_csv(path):
    """Headings and columns."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise RecordError(f"there is no file {path}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"{path}: cannot be read as text ({error})") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise RecordError(f"{path}: holds no samples; a heading line and lines of numbers are needed")
    separator = next((mark for mark in ("\t", ";") if mark in lines[0]), ",")
    headings = [cell.strip() for cell in next(csv.reader([lines[0]], delimiter=separator))]
    body = "\n".join(lines[1:])
    if separator != ",":
        body = body.replace(",", ".")
    try:
        values = np.loadtxt(body.splitlines(), delimiter=separator, ndmin=2)
    except ValueError as error:
        raise RecordError(f"{path}: the samples are not a table of numbers ({str(error).split(';')[0]}); an empty cell is a gap: leave its line out") from None
    if values.shape[1] != len(headings):
        raise RecordError(f"{path}: {len(headings)} headings, but {values.shape[1]} columns of numbers")
    return headings, values.T


def _read_mat(path):
    """Name -> array of the variables of a MATLAB file."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        return {key: np.squeeze(value) for key, value in loadmat(path).items() if not key.startswith("__")}
    except FileNotFoundError:
        raise RecordError(f"there is no file {path}") from None
    except (OSError, ValueError, NotImplementedError, MatReadError) as error:
        raise RecordError(f"{path}: cannot be read as a MATLAB file up to version 7 ({error})") from None
