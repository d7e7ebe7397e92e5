# SPDX-License-Identifier: BSD-3-Clause
"""An identified damper as the lines of a vehicle file, and put into a vehicle."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from railsym.dampers.record import RecordError

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_ORIGIN = "identified from bench tests"


def damper_toml(model, path=None, name="anti_yaw_damper", origin=_ORIGIN):
    """Write a damper model as vehicle-file TOML.

    Parameters
    ----------
    model : DamperModel
    path : path, optional
        File to write.
    name : str
        Name of the group of elements; its curves are ``name_damping`` and ``name_series_stiffness``.
    origin : str
        Where the numbers come from, as the vehicle file keeps it.

    Returns
    -------
    str
        ``[origins]`` entry, ``[curves....]`` and the head of ``[elements.name]``; what is missing is ``at``, the places of the
        elements. `put_into` needs no text.

    Raises
    ------
    RecordError
        A name that is none, or a file that cannot be written.
    """
    if not _NAME.fullmatch(name):
        raise RecordError(f"name {name!r}: letters, digits and _ are allowed, beginning with a letter")
    key, entries = f"{name}_bench", element_entries(model, name)
    lines = ["# Tables of a vehicle file (docs/vehicle_file.md). Add the line of [origins] to the one that the file has,",
             "# and to the element its places: at = [ { name = ..., first = ..., second = ..., ... } ]", "[origins]",
             f"{key} = {_quoted(origin)}"]
    for curve, (x, y, y_unit) in curve_entries(model, name).items():
        lines += ["", f"[curves.{curve}]", f'x = [{_numbers(x)}, "m/s"]', f'y = [{_numbers(y)}, "{y_unit}"]', f'origin = "{key}"']
    lines += ["", f"[elements.{name}]", f'type = "{"maxwell" if model.kind == "maxwell" else "damper"}"']
    for parameter, (value, unit) in entries.items():
        lines.append(f'{parameter} = "{value}"' if unit is None else f'{parameter} = [{value!r}, "{unit}"]')
    lines.append(f'origin = "{key}"')
    text = "\n".join(lines) + "\n"
    if path is not None:
        try:
            Path(path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise RecordError(f"{path}: {error.strerror}") from None
    return text


def element_entries(model, name):
    """Parameter -> (value, unit) of the element, (name of the curve, None) for a curve."""
    maxwell, entries = model.kind == "maxwell", {}
    if model.damping_curve is not None:
        entries["damping_curve" if maxwell else "curve"] = f"{name}_damping", None
    else:
        entries["damping"] = float(model.damping), "N*s/m"
    if maxwell and model.series_stiffness_curve is not None:
        entries["series_stiffness_curve"] = f"{name}_series_stiffness", None
    elif maxwell:
        entries["series_stiffness"] = float(model.series_stiffness), "N/m"
    return entries


def curve_entries(model, name):
    """Name -> (x, y, unit of y) of the curves; x in m/s."""
    curves = {}
    if model.damping_curve is not None:
        curves[f"{name}_damping"] = (*_columns(model.damping_curve), "N")
    if model.kind == "maxwell" and model.series_stiffness_curve is not None:
        curves[f"{name}_series_stiffness"] = (*_columns(model.series_stiffness_curve), "N/m")
    return curves


def put_into(vehicle_file, model, path, group="anti_yaw_damper", origin=_ORIGIN):
    """Write a copy of a vehicle file in which one group of dampers has the identified model.

    Parameters
    ----------
    vehicle_file : str or path
        A vehicle that comes along, or a TOML file.
    model : DamperModel
    path : path
        Of the new file.
    group : str
        The group of elements whose type and numbers are replaced; its places stay.
    origin : str

    Returns
    -------
    Path
        For `railsym.load_vehicle`.

    Raises
    ------
    RecordError
        If the file has no such group, or it is no damper.
    """
    text = vehicle_text(vehicle_file)
    head = re.search(rf"(?m)^\[elements\.{re.escape(group)}\][^\n]*\n(.*?)(?=^\[|\Z)", text, re.S)
    if head is None:
        known = ", ".join(re.findall(r"(?m)^\[elements\.(\w+)\]", text))
        raise RecordError(f"vehicle {vehicle_file}: there is no group of elements {group!r}; there are {known}")
    kind = re.search(r'(?m)^type\s*=\s*"(\w+)"', head[1])
    if kind is None or kind[1] not in ("maxwell", "damper"):
        raise RecordError(f"vehicle {vehicle_file}: group {group!r} is a {kind[1] if kind else '?'}, not a damper")
    key = f"{group}_bench"
    # the model's own numbers name their origin: the group's covers its places, which stay
    lines = [f'type = "{"maxwell" if model.kind == "maxwell" else "damper"}"']
    for parameter, (value, unit) in element_entries(model, group).items():
        lines.append(f'{parameter} = "{value}"' if unit is None else f'{parameter} = [{value!r}, "{unit}", "{key}"]')
    old = re.compile(r"(?m)^(type|damping|curve|damping_curve|series_stiffness|series_stiffness_curve)\s*=[^\n]*\n")
    body = "\n".join(lines) + "\n" + old.sub("", head[1])
    curves = "".join(f'[curves.{curve}]\nx = [{_numbers(x)}, "m/s"]\ny = [{_numbers(y)}, "{unit}"]\norigin = "{key}"\n\n'
                     for curve, (x, y, unit) in curve_entries(model, group).items())
    text = text[:head.start(1)] + body + curves + text[head.end(1):]
    text = re.sub(r"(?m)^\[origins\][^\n]*\n", lambda match: match[0] + f"{key} = {_quoted(origin)}\n", text, count=1)
    text = _without_viscous(text, group) if model.kind != "maxwell" else text
    Path(path).write_text(text, encoding="utf-8")
    return Path(path)


def vehicle_text(name_or_path):
    """Text of a vehicle file, by name for those that come along."""
    path = Path(name_or_path)
    shipped = Path(__file__).resolve().parent.parent / "data" / "vehicles" / f"{name_or_path}.toml"
    try:
        return (path if path.suffix == ".toml" else shipped).read_text(encoding="utf-8")
    except OSError as error:
        raise RecordError(f"vehicle file {name_or_path}: {error.strerror}") from None


def _without_viscous(text, group):
    """A viscous damper needs no configuration that makes it viscous: it leaves those lists."""
    def shorter(match):
        names = [one for one in re.findall(r'"([^"]+)"', match[1]) if one != group]
        return "viscous = [" + ", ".join(f'"{one}"' for one in names) + "]" if names else ""
    return re.sub(r"(?m)^viscous\s*=\s*\[([^\]]*)\]", shorter, text)


def _columns(curve):
    if hasattr(curve, "x"):
        return np.asarray(curve.x, dtype=float), np.asarray(curve.y, dtype=float)
    x, y = curve
    return np.asarray(x, dtype=float), np.asarray(y, dtype=float)


def _numbers(values):
    return "[" + ", ".join(repr(float(value)) for value in values) + "]"


def _quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", " ") + '"'
