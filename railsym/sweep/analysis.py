# SPDX-License-Identifier: BSD-3-Clause
"""Analyses: what is computed for a case. A study takes any object of this form; `KINDS` lists those that come along."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, field, fields
from importlib import import_module
from pathlib import Path

import numpy as np

from railsym.sweep.errors import SweepError, unknown
from railsym.units import UnitError, to_si

KINDS = {
    "critical_speed": "railsym.sweep.critical_speed:CriticalSpeed",
    "damper_loop": "railsym.sweep.damper_loop:DamperLoop",
    "modes": "railsym.sweep.modes:Modes",
    "tilt": "railsym.sweep.tilt:Tilt",
    "transient": "railsym.sweep.transient:Transient",
}


@dataclass(frozen=True)
class Output:
    """One result of a case.

    Attributes
    ----------
    unit : str
        SI; "" of a text.
    description : str
    text : bool
        The result is a text.
    """

    unit: str
    description: str
    text: bool = False


class Analysis:
    """Base of all analyses: a frozen dataclass whose fields are its settings, with a ``kind`` that names it in files.

    An analysis of one's own derives from this, lies in a module that the workers can import, and is named ``"module:Class"`` in a
    study file.
    """

    kind = ""

    def inputs(self, vehicle):
        """What a study may set besides the vehicle's parameters: dict of dotted name to `Input`."""
        return {}

    def outputs(self, vehicle):
        """Results of a case: dict of name to `Output`."""
        raise NotImplementedError

    def solver(self, vehicle):
        """Function ``solve(case)`` that gives a case's results by name (float, or str for texts); see `Case`.

        Called once a worker and configuration, with the vehicle that the cases depart from. What ``solve`` raises is recorded as the
        case's error. Results must not depend on the cases solved before.
        """
        raise NotImplementedError


def option(default=MISSING, unit=None, path=False):
    """A setting (dataclass field), with its SI unit where it has a dimension; ``path``: a name, or a file (relative to the study's)."""
    return field(default=default, metadata={"unit": unit, "path": path})


def files_of(analysis):
    """Files that an analysis reads, by setting."""
    named = {one.name: getattr(analysis, one.name) for one in fields(analysis) if one.metadata.get("path")}
    return {name: Path(value) for name, value in named.items() if value is not None and Path(value).is_file()}


def analysis_class(kind):
    """The class of a kind.

    Raises
    ------
    SweepError
    """
    place = KINDS.get(kind, kind if isinstance(kind, str) and ":" in kind else None)
    if place is None:
        raise SweepError(f"analysis {kind!r} is {unknown(kind, KINDS, 'analyses')}; one of your own is named 'module:Class'")
    module, _, name = place.partition(":")
    try:
        return getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        raise SweepError(f"analysis {kind!r} cannot be imported: {error}") from None


def to_table(analysis):
    """Settings that differ from the default, as plain data for a file."""
    kind = analysis.kind if KINDS.get(analysis.kind) == _place(analysis) else _place(analysis)
    table = {"kind": kind}
    for one in fields(analysis):
        value = getattr(analysis, one.name)
        if value != one.default:
            value = _plain(value)
            table[one.name] = [value, one.metadata["unit"]] if one.metadata.get("unit") else value
    return table


def from_table(table, folder=None):
    """An analysis from its table in a file, whose paths are relative to a folder.

    Raises
    ------
    SweepError
        An unknown kind or setting, or a setting without its unit.
    """
    if not isinstance(table, dict) or "kind" not in table:
        raise SweepError(f"[analysis] needs kind = one of {', '.join(KINDS)}")
    made = analysis_class(table["kind"])
    known = {one.name: one for one in fields(made)}
    given = {}
    for name, value in table.items():
        if name == "kind":
            continue
        if name not in known:
            raise SweepError(f"[analysis] {name} is {unknown(name, known, 'settings of ' + table['kind'])}")
        given[name] = _setting(f"[analysis] {name}", value, known[name].metadata.get("unit"))
        if known[name].metadata.get("path") and folder is not None and (Path(folder) / str(value)).is_file():
            given[name] = str(Path(folder) / value)
    try:
        return made(**given)
    except TypeError as error:
        raise SweepError(f"[analysis] {error}") from None


def _setting(key, value, unit):
    value = tuple(value) if isinstance(value, list) and unit is None else value
    if unit is None:
        return value
    if not (isinstance(value, list) and len(value) == 2 and isinstance(value[1], str)):
        raise SweepError(f'{key} = {value!r}: a number is written [value, "unit"], here with a unit such as "{unit}"')
    try:
        found = to_si(np.asarray(value[0], dtype=float), value[1], unit)
    except (UnitError, TypeError, ValueError) as error:
        raise SweepError(f"{key} = {value!r}: {error}") from None
    return float(found) if found.ndim == 0 else tuple(found.tolist())


def _place(analysis):
    return f"{type(analysis).__module__}:{type(analysis).__qualname__}"


def _plain(value):
    """Tuples and arrays as lists, NumPy's numbers as Python's."""
    if isinstance(value, (tuple, list, np.ndarray)):
        return [_plain(v) for v in value]
    return value.item() if isinstance(value, np.generic) else value
