# SPDX-License-Identifier: BSD-3-Clause
"""Runs as CSV."""

from __future__ import annotations

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np

from railsym.results.channel import TIME, Channel, Channels
from railsym.results.errors import ResultError, ResultFileError
from railsym.results.files import replacing
from railsym.results.metadata import RunInfo
from railsym.results.run import Run

_HEAD = re.compile(r"\s*(?P<name>[^\[\]]+?)\s*\[(?P<unit>[^\]]*)\]\s*")
_INFO, _CHANNEL = "# railsym run: ", "# channel: "


def save_csv(run, path):
    """`Run.to_csv`."""
    columns = np.column_stack([run.time, *(run[name] for name in run.channels)])
    with replacing(path) as part, open(part, "w", encoding="utf-8", newline="\n") as file:
        file.write(_INFO + run.info.to_json() + "\n")
        for channel in run.channels.values():
            if channel.description or channel.place:
                file.write(_CHANNEL + json.dumps(asdict(channel)) + "\n")
        file.write(",".join([f"{TIME} [s]", *(f"{c.name} [{c.unit}]" for c in run.channels.values())]) + "\n")
        np.savetxt(file, columns, fmt="%.17g", delimiter=",")


def load_csv(path):
    """`Run.from_csv`.

    Raises
    ------
    ResultFileError
        No such file, or no table of numbers below a heading line.
    """
    path = Path(path)
    try:
        with open(path, encoding="utf-8-sig") as file:
            info, described, head = _heading(file, path)
            channels = _channels(head, described, path)
            lines = file.readlines()
            table = np.loadtxt(lines, delimiter=",", ndmin=2, dtype=float) if lines else np.empty((0, len(head)))
            if table.shape[1] != len(head):
                raise ValueError(f"{table.shape[1]} columns below {len(head)} headings")
    except OSError as error:
        raise ResultFileError(f"{path} cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        if isinstance(error, ResultError):
            raise
        raise ResultFileError(f"{path}: the table cannot be read: {error}") from error
    return Run(table[:, 0].copy(), np.ascontiguousarray(table[:, 1:]), channels, info)


def _heading(file, path):
    info, described = RunInfo(), {}
    for line in file:
        if line.startswith(_INFO):
            info = RunInfo.from_json(line[len(_INFO):])
        elif line.startswith(_CHANNEL):
            channel = Channel(**json.loads(line[len(_CHANNEL):]))
            described[channel.name] = channel
        elif line.strip() and not line.startswith("#"):
            return info, described, line.rstrip("\r\n").split(",")
    raise ResultFileError(f"{path} has no heading line, such as: time [s],bogie1.y [m]")


def _channels(head, described, path):
    cells = [_HEAD.fullmatch(cell) for cell in head]
    for cell, found in zip(head, cells):
        if not found:
            raise ResultFileError(f"{path}: heading {cell.strip()!r} is not a name with a unit, such as 'bogie1.y [m]'")
    if (cells[0]["name"], cells[0]["unit"]) != (TIME, "s"):
        raise ResultFileError(f"{path}: the first column is {head[0].strip()!r}; 'time [s]' is needed")
    found = Channels(Channel(cell["name"], cell["unit"]) for cell in cells[1:])
    return [described.get(name, channel) for name, channel in found.items()]
