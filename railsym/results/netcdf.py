# SPDX-License-Identifier: BSD-3-Clause
"""Runs in netCDF files and as xarray datasets."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

import numpy as np

from railsym.results import files, layout
from railsym.results.channel import TIME, Channel, Channels
from railsym.results.errors import ResultFileError, optional
from railsym.results.lazy import FileRun, Records
from railsym.results.metadata import Ending
from railsym.results.run import Run
from railsym.results.writer import ChannelWriter

_BLOCK = 4096
_HDF5 = b"\x89HDF"


def save(run, path):
    """Write a run; a file of that name is replaced when the new one is complete.

    Raises
    ------
    ResultFileError
        A path that cannot be written, a full disk; an existing file is untouched.
    """
    writer = ChannelWriter(path, run.channels, run.info, block=max(1, min(len(run), _BLOCK)))
    try:
        for time, values in run.blocks(_BLOCK):
            writer.write(time, values)
        writer.finish(run.info.ending)
    except BaseException as error:
        with suppress(OSError):
            os.unlink(writer.part)
        if isinstance(error, ResultFileError):
            raise ResultFileError(f"{path} was not written: {files.reason(error.__cause__)}; {files.kept(writer.path)}") from error
        raise


def load(path, patterns="*", lazy=False):
    """Read a run, or the channels of it that fit ``patterns`` (str or sequence of str); lazy: leave the samples in the file.

    Raises
    ------
    ResultFileError
        No such file, or not one of railsym.
    UnknownChannelError
        A pattern fits no channel.
    """
    from scipy.io import netcdf_file

    path = Path(path)
    _check_there(path)
    try:
        with netcdf_file(path, "r", mmap=path.stat().st_size > 0) as file:
            return _run(file, path, (patterns,) if isinstance(patterns, str) else tuple(patterns), lazy)
    except (OSError, TypeError, ValueError, IndexError, AssertionError) as error:
        if isinstance(error, ResultFileError):
            raise
        with open(path, "rb") as start:
            other = "it is netCDF-4 (HDF5), which railsym does not write; xarray reads it" if start.read(4) == _HDF5 else str(error)
        raise ResultFileError(f"{path} cannot be read as netCDF: {other}") from error


def to_xarray(run):
    """`Run.to_xarray`."""
    xarray = optional("xarray", "to_xarray")
    variables = {}
    for name, channel in run.channels.items():
        variables[name] = (TIME, np.array(run[name]), {"units": channel.unit, "long_name": channel.description, "place": channel.place})
    plain = {name: value.decode().rstrip() for name, value in layout.attributes(run.info).items()}
    return xarray.Dataset(variables, coords={TIME: (TIME, np.array(run.time), {"units": "s"})}, attrs=plain | {layout.INFO: run.info.to_json()})


def _check_there(path):
    if path.is_file():
        return
    left = files.parts_of(path)
    hint = f"; a run that was not finished left {', '.join(map(str, left))}" if left else ""
    raise ResultFileError(f"there is no file {path}{hint}")


def _run(file, path, patterns, lazy):
    given = file._attributes
    if layout.FORMAT not in given or layout.INFO not in given or TIME not in file.variables:
        raise ResultFileError(f"{path} is netCDF, but not a run of railsym: it has no attribute {layout.FORMAT}; there are "
                              f"{', '.join(given) or 'no attributes'}")
    if given[layout.FORMAT].decode() != layout.FORMAT_NAME:
        raise ResultFileError(f"{path} has the format {given[layout.FORMAT].decode()!r}, this railsym reads {layout.FORMAT_NAME!r}: "
                              "a newer one may be needed")
    channels = Channels(_channel(name, variable._attributes) for name, variable in file.variables.items() if name != TIME)
    names = tuple(channels) if patterns == ("*",) else channels.require(*patterns)
    info = layout.read_info(given[layout.INFO])
    info = _ended(info, file.variables[TIME])
    if lazy:
        # headers with the same channels and bytes of metadata are equally long
        start = len(layout.header(channels, info.ended(Ending("running")), len(given[layout.INFO]))[0])
        return FileRun(Records(path, channels, start, file.variables[TIME].shape[0]), names, info)
    time, values = _native(file.variables[TIME]), {name: _native(file.variables[name]) for name in names}
    return Run(time, values, [channels[name] for name in names], info)


def _ended(info, time):
    """Metadata with the ending of a run whose program ended before its file was finished."""
    if info.status != "running":
        return info
    detail = "the program ended before the file was finished; what it had not written yet is missing"
    return info.ended(Ending("interrupted", time=float(time[-1]) if time.shape[0] else None, detail=detail))


def _channel(name, details):
    return Channel(name, *(details.get(key, b"").decode() for key in ("units", "long_name", "place")))


def _native(variable):
    """A copy in the byte order of the machine: the file's memory map closes."""
    return np.array(variable.data, dtype=float)
