# SPDX-License-Identifier: BSD-3-Clause
"""Studies as TOML: docs/studies_sweep.md describes the format."""

from __future__ import annotations

import json
import os
import tomllib
from dataclasses import fields
from pathlib import Path

import numpy as np

from railsym.sweep import plans as plan_kinds
from railsym.sweep.analysis import _plain, files_of, from_table, to_table
from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.factor_table import factor_from_table, factor_to_table, set_from_table, set_to_table
from railsym.vehicle import vehicles

_INLINE = 2000            # numbers of a table that are written into the file; more go into a file beside it
_SECTIONS = ("study", "analysis", "factors", "plan", "set")
ON_TOP = ("title", "description", "uncertainty", "optimise")      # what `railsym.campaign` makes of the results
_STUDY = ("vehicle", "configuration", "seed", "keep")


def document(study):
    """A study as plain data: JSON and TOML can hold it. A long table of cases is left out."""
    head = {"vehicle": study.vehicle, "seed": study.seed}
    if study.configuration is not None:
        head["configuration"] = study.configuration
    if study.keep is not None:
        head["keep"] = list(study.keep)
    found = {"study": head, "analysis": to_table(study.analysis), "plan": plan_to_table(study.plan),
             "factors": {name: factor_to_table(factor) for name, factor in study.factors.items()}}
    return found | ({"set": {name: set_to_table(study, name) for name in study.set}} if study.set else {})


def plan_to_table(plan):
    """A plan as plain data."""
    if plan.kind == "table":
        rows = {"rows": plan.values.tolist()} if plan.values.size <= _INLINE else {"cases": len(plan.values)}
        return {"kind": "table"} | rows | ({} if plan.scale == "units" else {"scale": plan.scale})
    return {"kind": plan.kind} | {one.name: _plain(getattr(plan, one.name)) for one in fields(plan)}


def from_document(content, folder=None, rows=None):
    """A study from plain data.

    Parameters
    ----------
    content : dict
    folder : Path, optional
        That paths are relative to.
    rows : callable, optional
        Gives the cases (n, k), SI, of a long table, from the names of the factors.
    """
    from railsym.sweep.study import Study

    _known("", content, _SECTIONS, ("study", "analysis", "factors", "plan"))
    head = _known("[study] ", content["study"], _STUDY, ("vehicle",))
    if not isinstance(content["factors"], dict):
        raise SweepError("[factors] must be a table: name = { uniform = [[4, 6], \"MN/m\"] }")
    factors = {name: factor_from_table(name, table) for name, table in content["factors"].items()}
    plan = plan_from_table(content["plan"], folder, rows and (lambda: rows(list(factors))))
    vehicle = head["vehicle"]
    if folder is not None and vehicle not in vehicles() and (folder / vehicle).is_file():
        vehicle = str(folder / vehicle)
    return Study(vehicle, from_table(content["analysis"], folder), factors, plan, configuration=head.get("configuration"),
                 set=set_from_table(content.get("set", {})), keep=head.get("keep"), seed=head.get("seed", 0))


def plan_from_table(table, folder=None, rows=None):
    """A plan from its table."""
    if not isinstance(table, dict) or table.get("kind") not in plan_kinds.KINDS:
        kind = table.get("kind") if isinstance(table, dict) else table
        raise SweepError(f"[plan] kind {kind!r} is {unknown(kind, plan_kinds.KINDS, 'plans')}")
    made = plan_kinds.KINDS[table["kind"]]
    given = {name: value for name, value in table.items() if name != "kind"}
    if made is plan_kinds.Table:
        return _table_plan(given, folder, rows)
    _known("[plan] ", given, [one.name for one in fields(made)])
    try:
        return made(**given)
    except TypeError as error:
        raise SweepError(f"[plan] {error}") from None


def _table_plan(given, folder, rows):
    _known("[plan] ", given, ("rows", "file", "cases", "scale"))
    if "rows" in given:
        return plan_kinds.Table(given["rows"], given.get("scale", "units"))
    if "file" in given:
        path = (folder or Path()) / given["file"]
        try:
            values = np.load(path) if path.suffix == ".npy" else np.loadtxt(path, delimiter=",", ndmin=2)
        except (OSError, ValueError) as error:
            raise SweepError(f"[plan] file {path}: {error}") from None
        return plan_kinds.Table(values, given.get("scale", "units"))
    if rows is None:
        raise SweepError("[plan] kind 'table' needs rows = [[...], ...] or file = \"cases.csv\" (or .npy)")
    return plan_kinds.Table(rows(), scale="si")


def _known(where, table, allowed, required=()):
    """The table itself, if it holds nothing else and all that is required."""
    if not isinstance(table, dict):
        raise SweepError(f"{where.strip() or 'the study'} must be a table with {', '.join(allowed)}")
    for name in table:
        if name not in allowed:
            raise SweepError(f"{where}{name} is {unknown(name, allowed, 'keys')}")
    for name in required:
        if name not in table:
            raise SweepError(f"{where}{name} is missing (needed: {', '.join(required)})")
    return table


def load(path):
    """`Study.load`."""
    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SweepError(f"study file {path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SweepError(f"study file {path}: {error}") from None
    try:
        return from_document({name: table for name, table in content.items() if name not in ON_TOP}, path.parent)
    except SweepError as error:
        raise SweepError(f"study file {path}: {error}") from None


def save(study, path):
    """`Study.save`."""
    path, content = Path(path), document(study)
    if study.vehicle not in vehicles():
        content["study"]["vehicle"] = os.path.relpath(study.vehicle, path.parent)
    for name, file in files_of(study.analysis).items():
        content["analysis"][name] = os.path.relpath(file, path.parent)
    try:
        if "cases" in content["plan"] and study.plan.kind == "table":
            beside = path.with_name(path.stem + "_cases.npy")
            np.save(beside, study.plan.values)
            content["plan"]["file"] = beside.name
            del content["plan"]["cases"]
        path.write_text(toml(content), encoding="utf-8")
    except OSError as error:
        raise SweepError(f"study file {path} was not written: {error.strerror}") from None


def toml(content):
    """Tables of plain values as TOML text, a table within a table inline."""
    lines = []
    for section, table in content.items():
        lines += ["", f"[{section}]"] + [f"{_key(name)} = {_value(value)}" for name, value in table.items()]
    return "\n".join(lines[1:]) + "\n"


def _key(name):
    return name if name.replace("_", "").replace("-", "").isalnum() and name.isascii() else json.dumps(name)


def _value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(name)} = {_value(one)}" for name, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
