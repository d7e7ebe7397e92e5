# SPDX-License-Identifier: BSD-3-Clause
"""Runs in netCDF-4 files and as xarray datasets."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

import numpy as np

from railsym.results import files
from railsym.results.channel import TIME, Channel, Channels
from railsym.results.errors import ResultFileError, optional
from railsym.results.metadata import Ending, RunInfo
from railsym.results.run import Run
from railsym.results.writer import FORMAT, FORMAT_NAME, INFO, ChannelWriter

_BLOCK = 16384


def save(run, path):
    """Write a run; a file of that name is replaced when the new one is complete.

    Raises
    ------
    ResultFileError
        A path that cannot be written, a full disk; an existing file is untouched.
    """
    writer = ChannelWriter(path, run.channels, run.info, block=max(1, min(len(run), _BLOCK)))
    try:
        for start in range(0, len(run), _BLOCK):
            rows = slice(start, start + _BLOCK)
            time = run.time[rows]
            writer.write(time, np.column_stack([run[name][rows] for name in run.channels]) if run.channels else np.empty((time.size, 0)))
        writer.finish(run.info.ending)
    except BaseException as error:
        with suppress(OSError):
            os.unlink(writer.part)
        if isinstance(error, ResultFileError):
            raise ResultFileError(f"{path} was not written: {files.reason(error.__cause__)}; {files.kept(writer.path)}") from error
        raise


def load(path, patterns="*"):
    """Read a run, or the channels of it that fit ``patterns`` (str or sequence of str).

    Raises
    ------
    ResultFileError
        No such file, or not one of railsym.
    UnknownChannelError
        A pattern fits no channel.
    """
    path = Path(path)
    _check_there(path)
    netcdf = optional("netCDF4", "a netCDF file")
    try:
        with netcdf.Dataset(path) as dataset:
            return _run(dataset, path, (patterns,) if isinstance(patterns, str) else tuple(patterns))
    except (OSError, RuntimeError) as error:
        if isinstance(error, ResultFileError):
            raise
        raise ResultFileError(f"{path} cannot be read as netCDF: {getattr(error, 'strerror', None) or error}") from error


def to_xarray(run):
    """`Run.to_xarray`."""
    xarray = optional("xarray", "to_xarray")
    variables = {}
    for name, channel in run.channels.items():
        variables[name] = (TIME, np.array(run[name]), {"units": channel.unit, "long_name": channel.description, "place": channel.place})
    info = run.info
    attributes = {INFO: info.to_json(), FORMAT: FORMAT_NAME, "ending": str(info.ending)}
    attributes |= {key: getattr(info, key) for key in ("vehicle", "configuration", "track", "creep_law", "railsym_version", "message")}
    return xarray.Dataset(variables, coords={TIME: (TIME, np.array(run.time), {"units": "s"})}, attrs=attributes)


def _check_there(path):
    if path.is_file():
        return
    left = files.parts_of(path)
    hint = f"; a run that was not finished left {', '.join(map(str, left))}" if left else ""
    raise ResultFileError(f"there is no file {path}{hint}")


def _run(dataset, path, patterns):
    dataset.set_auto_maskandscale(False)
    attributes = dataset.ncattrs()
    if FORMAT not in attributes or INFO not in attributes or TIME not in dataset.variables:
        raise ResultFileError(f"{path} is netCDF, but not a run of railsym: it has no attribute {FORMAT}; there are {', '.join(attributes) or 'no attributes'}")
    if dataset.getncattr(FORMAT) != FORMAT_NAME:
        raise ResultFileError(f"{path} has the format {dataset.getncattr(FORMAT)!r}, this railsym reads {FORMAT_NAME!r}: a newer railsym may be needed")
    channels = Channels(Channel(name, v.units, v.long_name, v.place) for name, v in dataset.variables.items() if name != TIME)
    names = tuple(channels) if patterns == ("*",) else channels.require(*patterns)
    info = RunInfo.from_json(dataset.getncattr(INFO))
    time = np.asarray(dataset.variables[TIME][:])
    values = {name: np.asarray(dataset.variables[name][:]) for name in names}
    if info.status == "running":
        time, values, info = _unfinished(time, values, info)
    return Run(time, values, [channels[name] for name in names], info)


def _unfinished(time, values, info):
    """What a writer that was never finished left: the samples that all channels have."""
    count = int(np.argmin(np.append((np.diff(time, prepend=-np.inf) > 0) & np.isfinite(time), False)))
    last = float(time[count - 1]) if count else None
    ending = Ending("interrupted", time=last, detail="the program ended before the file was finished; its last block may be missing")
    return time[:count], {name: array[:count] for name, array in values.items()}, info.ended(ending)
