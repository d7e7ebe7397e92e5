# SPDX-License-Identifier: BSD-3-Clause
"""Runs as MATLAB files (version 5, at most 2 GB a variable)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from railsym.results.channel import TIME, Channel
from railsym.results.errors import ResultFileError
from railsym.results.files import replacing
from railsym.results.metadata import RunInfo
from railsym.results.run import Run

_LONGEST = 63  # characters of a MATLAB name
_TABLES = ("channel_names", "variable_names", "units", "descriptions", "places")
_TAKEN = {TIME, "railsym_run", *_TABLES}


def valid_names(names):
    """MATLAB names for channel names, in their order, all different: ``bogie1.y`` becomes ``bogie1_y``.

    Parameters
    ----------
    names : sequence of str

    Returns
    -------
    list of str
    """
    used, result = set(_TAKEN), []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        base = (plain if plain[0].isalpha() else "x" + plain)[:_LONGEST]
        new, count = base, 1
        while new in used:
            count += 1
            new = f"{base[:_LONGEST - len(str(count)) - 1]}_{count}"
        used.add(new)
        result.append(new)
    return result


def save_mat(run, path):
    """`Run.to_mat`."""
    from scipy.io import savemat

    channels = list(run.channels.values())
    variables = valid_names(run.channels)
    tables = ([c.name for c in channels], variables, [c.unit for c in channels], [c.description for c in channels], [c.place for c in channels])
    content = {TIME: run.time, "railsym_run": run.info.to_json()}
    content |= {key: np.array(texts, dtype=object) for key, texts in zip(_TABLES, tables)}
    content |= {variable: run[channel.name] for variable, channel in zip(variables, channels)}
    with replacing(path) as part, open(part, "wb") as file:
        savemat(file, content, oned_as="column", long_field_names=True)


def load_mat(path):
    """`Run.from_mat`.

    Raises
    ------
    ResultFileError
    """
    from scipy.io import loadmat

    path = Path(path)
    try:
        content = loadmat(path, chars_as_strings=True)
    except (OSError, ValueError, NotImplementedError, TypeError) as error:
        raise ResultFileError(f"{path} cannot be read as a MATLAB file: {error}") from error
    missing = [key for key in _TAKEN if key not in content]
    if missing:
        raise ResultFileError(f"{path} is no file of Run.to_mat: it has no variable {missing[0]}")
    names, variables, units, descriptions, places = ([_text(cell) for cell in content[key].ravel()] for key in _TABLES)
    channels = [Channel(*texts) for texts in zip(names, units, descriptions, places)]
    values = {name: content[variable].ravel() for name, variable in zip(names, variables)}
    return Run(content[TIME].ravel(), values, channels, RunInfo.from_json(_text(content["railsym_run"])))


def _text(cell):
    """A text out of the arrays in which SciPy returns it; an empty one has no element."""
    cell = np.asarray(cell)
    while cell.dtype == object and cell.size == 1:
        cell = np.asarray(cell.item())
    return str(cell.item()) if cell.size else ""
