# SPDX-License-Identifier: BSD-3-Clause
"""Contact tables in files: our own as NumPy archives, external ones as CSV."""

from __future__ import annotations

import difflib
import zipfile
from pathlib import Path

import numpy as np

from railsym import _core_contact as core
from railsym.contact_table import ContactTable, WheelTable
from railsym.errors import ContactError
from railsym.results.errors import ResultFileError
from railsym.results.files import replacing

_FORMAT = 2         # 2: fields as coefficients of splines
_NUMBERS = ("tape_circle_spacing", "wheel_radius", "wheel_radius_left")
COLUMNS = ("lateral_shift_m", "normal_load_N", "contact_angle_rad", "a_m", "b_m", "lateral_distance_m", "rolling_radius_m", "c11", "c22", "c23",
           "penetration_m")
_NEEDED = tuple(name for name in COLUMNS if name not in ("c11", "c22", "c23"))


def save(table, path):
    """Write a contact table as NumPy archive (.npz); a file that is there stays as it is if that fails.

    Parameters
    ----------
    table : ContactTable
    path : str or Path

    Raises
    ------
    ContactError
        Where it cannot be written.
    """
    path = Path(path)
    content = {"format": _FORMAT, "description": table.description, "one": table.left.core is table.right.core, **{n: getattr(table, n) for n in _NUMBERS}}
    for side in ("right",) if content["one"] else ("right", "left"):
        own = getattr(table, side).core
        content |= {f"{side}_shape": own.shape, f"{side}_axes": own.axes}
        for zone in range(len(own.axes)):
            content[f"{side}_closure{zone}"], content[f"{side}_field{zone}"] = own.arrays(zone)
    try:
        with replacing(path) as part, part.open("wb") as file:
            np.savez_compressed(file, **content)
    except (ResultFileError, OSError) as error:
        raise ContactError(f"contact table cannot be written to {path}: {error}") from None


def load(path, *, side_spacing=1.5, wheel_radius=None):
    """Read a contact table.

    Parameters
    ----------
    path : str or Path
        An archive written by `save`, or a CSV file of another program with the columns `COLUMNS` (header optional in this order; with a
        header any order; c11, c22, c23 are not needed: creep coefficients follow from the semi-axes).
    side_spacing : float
        Of a CSV file: distance of the tape circles, m.
    wheel_radius : float, optional
        Of a CSV file: nominal radius r0, m; the rolling radius at shift 0 if not given.

    Returns
    -------
    ContactTable

    Raises
    ------
    ContactError
        If there is no such file, or it makes no table.

    Notes
    -----
    A CSV table is of the right wheel of a symmetric pair, over lateral shifts at one or several static loads, with the wheelset rolling so
    that both wheels touch; its contact angle is that to the axle. Its drop follows from the contact angles (the drop of a wheel that slides
    along its rail falls by the tangent of the angle to the track); its load over penetration is K p^(3/2) between the loads given, and as at the nearest one beyond. It knows no
    roll of its own: a wheelset that rolls keeps the contact's place on the rail.
    """
    path = Path(path)
    if not path.is_file():
        raise ContactError(f"there is no contact table {str(path)!r}")
    if zipfile.is_zipfile(path):
        return _archive(path)
    from railsym.contact_table_external import table_of_rows

    return table_of_rows(read_rows(path), side_spacing, wheel_radius, path.name)


def _archive(path):
    try:
        with np.load(path) as data:
            if int(data["format"]) != _FORMAT:
                raise ContactError(f"{path.name}: contact table of format {int(data['format'])}; this railsym reads {_FORMAT}: build it again")
            sides = {side: _side(data, side) for side in (("right",) if data["one"] else ("right", "left"))}
            numbers = {name: float(data[name]) for name in _NUMBERS}
            return ContactTable(WheelTable("left", sides.get("left", sides["right"])), WheelTable("right", sides["right"]),
                                **numbers, description=str(data["description"]))
    except (KeyError, ValueError, zipfile.BadZipFile, EOFError) as error:
        if isinstance(error, ContactError):
            raise
        raise ContactError(f"{path.name} is not a contact table of railsym, or damaged: {error}") from None


def _side(data, side):
    zones = len(data[f"{side}_axes"])
    return core.Table.of_arrays(data[f"{side}_shape"], data[f"{side}_axes"], [data[f"{side}_closure{z}"] for z in range(zones)],
                                [data[f"{side}_field{z}"] for z in range(zones)])


def read_rows(path):
    """Columns of a CSV contact table, dict of str to ndarray (n,), by shift, then load.

    Raises
    ------
    ContactError
        With line and reason.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ContactError(f"{path.name}: {error}") from None
    numbered = [(k, line.replace(";", ",").replace("\t", ",").strip()) for k, line in enumerate(lines, 1)]
    numbered = [(k, line) for k, line in numbered if line and not line.startswith("#")]
    if not numbered:
        raise ContactError(f"{path.name}: the file is empty")
    names = _header(path.name, numbered[0][1])
    rows = [_row(path.name, k, line, len(names)) for k, line in numbered[1 if any(c.isalpha() and c not in "eE" for c in numbered[0][1]) else 0:]]
    columns = dict(zip(names, np.array(rows, dtype=float).T)) if rows else {}
    if len(rows) < 8:
        raise ContactError(f"{path.name}: {len(rows)} rows; a contact table needs at least 8 shifts")
    order = np.lexsort((columns["normal_load_N"], columns["lateral_shift_m"]))
    return {name: values[order] for name, values in columns.items()}


def _header(file, line):
    cells = [cell.strip().strip('"') for cell in line.split(",")] if "," in line else line.split()
    if not any(c.isalpha() and c not in "eE" for c in line):
        if len(cells) < len(COLUMNS):
            raise ContactError(f"{file}: line 1 has {len(cells)} numbers and no header; without a header the columns must be {', '.join(COLUMNS)}")
        return COLUMNS + tuple(f"more{k}" for k in range(len(cells) - len(COLUMNS)))
    missing = [name for name in _NEEDED if name not in cells]
    if missing:
        near = difflib.get_close_matches(missing[0], cells, 1)
        raise ContactError(f"{file}: no column {missing[0]!r}" + (f" (nearest: {near[0]!r})" if near else "") + f"; needed are {', '.join(_NEEDED)}")
    return tuple(cells)


def _row(file, number, line, width):
    cells = line.split(",") if "," in line else line.split()
    if len(cells) != width:
        raise ContactError(f"{file}, line {number}: {len(cells)} numbers, and there are {width} columns")
    try:
        values = [float(cell) for cell in cells]
    except ValueError:
        raise ContactError(f"{file}, line {number}: not all of it are numbers: {line!r}") from None
    if not np.isfinite(values).all():
        raise ContactError(f"{file}, line {number}: a number is not finite")
    return values
