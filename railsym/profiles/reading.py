# SPDX-License-Identifier: BSD-3-Clause
"""Points of measured profiles from CSV, SIMPACK (.prw, .prr) and MiniProf (.whl, .ban) files."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from railsym.profiles.checks import ProfileError, check_points
from railsym.units import UnitError, to_si

_COLUMN = re.compile(r"\s*([yzxYZX])\s*(?:[_ \[(]\s*([a-z]+)\s*[\])]?)?\s*")
_SUFFIX_KIND = {".prw": "wheel", ".prr": "rail", ".whl": "wheel", ".ban": "rail"}


@dataclass(frozen=True, eq=False)
class Points:
    """Points of a file: ``y, z`` in m in the axes of `railsym.profiles.Profile`, in order of y."""

    kind: str
    y: np.ndarray
    z: np.ndarray
    description: str = ""
    inclined: bool = False


def read_points(path, kind=None, *, mirror=False, upward=None, unit=None, shift=0.0):
    """Read and check the points of a profile file.

    Parameters
    ----------
    path : Path
    kind : {"wheel", "rail"}, optional
        Needed where neither suffix nor file tells.
    mirror : bool
        Exchange left and right.
    upward : bool, optional
        The file's z points up (default: down).
    unit : str, optional
        Length unit of the file, if it does not say.
    shift : float
        m, added to y after mirroring: -0.070 for a wheel measured from its flange back.

    Returns
    -------
    Points

    Raises
    ------
    ProfileError
        For a file that cannot be read or is no profile, with its line.
    """
    suffix = path.suffix.lower()
    readers = {".csv": _read_csv, ".txt": _read_csv, ".prw": _read_simpack, ".prr": _read_simpack, ".whl": _read_miniprof, ".ban": _read_miniprof}
    if suffix not in readers:
        raise ProfileError(f"{path.name}: files ending in {suffix!r} are not known; there are {', '.join(sorted(readers))}, .toml")
    text = _text(path)
    rows, file_unit, file_kind = readers[suffix](path.name, text.splitlines())
    if not rows:
        raise ProfileError(f"{path.name}: there is no line with two numbers in it")
    told = file_kind or _SUFFIX_KIND.get(suffix)
    if kind and told and kind != told:
        raise ProfileError(f"{path.name} is a {told}, and a {kind} is needed")
    kind = kind or told
    if kind is None:
        raise ProfileError(f"{path.name}: is it a wheel or a rail? Pass kind, or write a line '# kind: wheel' into the file")
    lines, y, z = (np.array(column) for column in zip(*rows))
    factor = _factor(path.name, file_unit, unit)
    y, z = factor * y * (-1.0 if mirror else 1.0) + shift, factor * z * (-1.0 if upward else 1.0)
    y, z = check_points(path.name, kind, y, z, lines)
    return Points(kind, y, z, description=f"{kind} from {path.name}")


def _text(path):
    """Text in UTF-8, with or without its mark, in UTF-16 with it, else in Latin-1."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ProfileError(f"{path.name}: {error.strerror}") from None
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        line = text[:text.index("\0")].count("\n") + 1
        raise ProfileError(f"{path.name}, line {line}: this is no text; save the points as text in UTF-8")
    return text


def _factor(name, file_unit, unit):
    """Metres of one unit of the file: a number, or the unit's name."""
    if isinstance(file_unit, float):
        return file_unit
    if file_unit and unit and file_unit != unit:
        raise ProfileError(f"{name}: the file says {file_unit!r}, and {unit!r} was asked for")
    try:
        return to_si(1.0, file_unit or unit or "mm", "m")
    except UnitError as error:
        raise ProfileError(f"{name}: {error}") from None


def _numbers(name, number, cells):
    """Two or more numbers of a line; 1.5D-01 is Fortran's way to write them."""
    shown = repr(" ".join(cells)[:60])
    try:
        values = [float(cell if cell[:1].isalpha() else re.sub("[dD]", "e", cell)) for cell in cells]
    except ValueError:
        raise ProfileError(f"{name}, line {number}: {shown} are not two numbers") from None
    if len(values) < 2:
        raise ProfileError(f"{name}, line {number}: {shown} is one number, two are needed")
    if not all(map(math.isfinite, values[:2])):
        raise ProfileError(f"{name}, line {number}: {shown} is not a finite number; remove the point")
    return values


def _cells(line):
    """Cells of a line of a CSV file: after semicolons or tabs, or where each word has one, a comma is a decimal comma."""
    for separator in ";\t":
        if separator in line:
            return [cell.strip().replace(",", ".") for cell in line.split(separator) if cell.strip()]
    words = line.split()
    if len(words) > 1 and all(re.fullmatch(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?", word) for word in words):
        return [word.replace(",", ".") for word in words]
    return [cell for cell in re.split(r"[,\s]+", line) if cell]


def _read_csv(name, lines):
    """Two columns y, z; a header such as ``y_mm,z_mm`` gives order and unit, ``# kind: wheel`` the kind."""
    rows, order, unit, kind = [], (0, 1), None, None
    for number, line in enumerate(lines, start=1):
        if line.lstrip().startswith("#"):
            found = re.fullmatch(r"\s*#\s*kind\s*[:=]\s*(wheel|rail)\s*", line, re.IGNORECASE)
            kind = found[1].lower() if found else kind
            continue
        cells = _cells(line.strip())
        if not cells:
            continue
        if not rows and re.match(r"[A-Za-z\"]", cells[0]) and cells[0].lower() not in ("nan", "inf"):
            order, unit = _header(name, number, re.split(r"[,;\t]", line.strip()))
            continue
        values = _numbers(name, number, cells)
        if max(order) >= len(values):
            raise ProfileError(f"{name}, line {number}: {len(values)} columns, where the header has {max(order) + 1} or more")
        rows.append((number, values[order[0]], values[order[1]]))
    return rows, unit, kind


def _header(name, number, cells):
    matches = [_COLUMN.fullmatch(cell.strip('"')) for cell in cells]
    names = [match[1].lower() if match else "" for match in matches]
    if "y" not in names or "z" not in names:
        raise ProfileError(f"{name}, line {number}: the header {','.join(cells)!r} must name the columns y and z, such as y_mm,z_mm")
    order = names.index("y"), names.index("z")
    units = {matches[k][2] for k in order}
    if len(units) != 1:
        raise ProfileError(f"{name}, line {number}: y and z have different units in {','.join(cells)!r}")
    return order, units.pop()


def _read_simpack(name, lines):
    """Points between point.begin and point.end, treated in the order the file's comments number: distance, shift, rotate, bounds, mirror."""
    rows, keys, inside, closed, header = [], {}, False, False, False
    for number, line in enumerate(lines, start=1):
        text = re.split("[!%]", line)[0].strip()
        if text.lower() in ("point.begin", "point.end"):
            inside, closed = text.lower() == "point.begin", text.lower() == "point.end"
        elif text.lower() in ("header.begin", "header.end"):
            header = text.lower() == "header.begin"
        elif inside and text:
            values = _numbers(name, number, text.split())
            rows.append((number, values[0], values[1]))
        elif "=" in text:
            key, _, value = text.partition("=")
            keys["header." * header + key.strip().lower()] = (number, value.strip().strip("'"))    # type stands in both, with two meanings
    if not closed:
        raise ProfileError(f"{name}: no block point.begin ... point.end; is it a SIMPACK profile?")

    def number_of(key, default):
        line, text = keys.get(key, (0, str(default)))
        try:
            return float(text)
        except ValueError:
            raise ProfileError(f"{name}, line {line}: {key} = {text!r} is not a number") from None

    if number_of("approx.smooth", 0.0):
        raise ProfileError(f"{name}, line {keys['approx.smooth'][0]}: approx.smooth is not 0; set it to 0 and pass smoothing, whose meaning is a distance")
    kind = {0.0: "rail", 1.0: "wheel"}.get(number_of("header.type", -1.0))
    factor = number_of("units.len.f", 1000.0)
    if not factor > 0.0:
        raise ProfileError(f"{name}, line {keys['units.len.f'][0]}: units.len.f is {factor}; it is how many of the file's units are 1 m")
    return _treated(np.array(rows, dtype=float), number_of), 1.0 / factor, kind


def _treated(rows, number_of):
    """SIMPACK's own treatment of its points."""
    if not len(rows):
        return []
    nearest, kept = number_of("point.dist.min", 0.0), [rows[0]]
    for row in rows[1:]:
        if not nearest > 0.0 or math.hypot(*(row[1:] - kept[-1][1:])) >= nearest:
            kept.append(row)
    line, y, z = np.array(kept).T
    y, z = y + number_of("shift.y", 0.0), z + number_of("shift.z", 0.0)
    angle = number_of("rotate", 0.0) / number_of("units.ang.f", 1.0)
    y, z = math.cos(angle) * y - math.sin(angle) * z, math.sin(angle) * y + math.cos(angle) * z
    keep = np.ones(len(y), dtype=bool)
    for value, axis in ((y, "y"), (z, "z")):
        low, high = number_of(f"bound.{axis}.min", 1.0), number_of(f"bound.{axis}.max", 0.0)
        if low < high:      # the other way round: no bound
            keep &= (value >= low) & (value <= high)
    y = -y if number_of("mirror.y", 0.0) else y
    z = -z if number_of("mirror.z", 0.0) else z
    return [(int(n), a, b) for n, a, b, good in zip(line, y, z, keep) if good]


def _read_miniprof(name, lines):
    """Header ``key=value``, an empty line, then columns; ColumnDef names them (X lateral, Y height)."""
    columns, rows, started, taken_out, declared = ["X", "Y"], [], False, 0, None
    for number, line in enumerate(lines, start=1):
        text = re.split('["!%]', line)[0].strip()
        if not text:
            taken_out += started and bool(line.strip())
            started = started or not line.strip()
        elif "=" in text and not started:
            key, _, value = text.partition("=")
            if key.strip().lower() == "columndef":
                columns = [c.strip().upper() for c in value.split(",")]
                if not {"X", "Y"} <= set(columns):
                    raise ProfileError(f"{name}, line {number}: ColumnDef={value.strip()!r} must hold X and Y")
            elif key.strip().lower() == "xypoints" and value.strip().isdigit():
                declared = number, int(value)
        elif started:
            cells = [cell for cell in re.split(r"[,;\s]+", text) if cell]
            words = next((k for k, cell in enumerate(cells) if cell[0].isalpha() and cell.lower() not in ("nan", "inf")), len(cells))
            values = _numbers(name, number, cells[:words] if words > 1 else cells)      # a remark may follow the numbers
            if len(values) < max(len([c for c in columns if c != "*"]), columns.index("X") + 1, columns.index("Y") + 1):
                raise ProfileError(f"{name}, line {number}: {len(values)} columns, where ColumnDef has {','.join(columns)}")
            rows.append((number, values[columns.index("X")], values[columns.index("Y")]))
    if not rows:
        raise ProfileError(f"{name}: no points; in a MiniProf file they come after a header and an empty line")
    if declared and len(rows) + taken_out < declared[1]:
        raise ProfileError(f"{name}, line {declared[0]}: XYPoints={declared[1]}, and {len(rows)} points follow; the file is cut short")
    return rows, None, None
