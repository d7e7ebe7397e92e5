# SPDX-License-Identifier: BSD-3-Clause
"""Writing a run to a netCDF file while it goes on, block by block, in constant memory."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from railsym.results import files
from railsym.results.channel import TIME, Channels
from railsym.results.errors import ResultError, ResultFileError, optional
from railsym.results.metadata import Ending, RunInfo

INFO, FORMAT, FORMAT_NAME = "railsym_run", "railsym_format", "run 1"
_BLOCK = 4096


class ChannelWriter:
    """Writes channels to ``PATH.part`` as they come; `finish` (or the end of a ``with`` block) gives the file its name.

        with ChannelWriter("run.nc", channels, info) as writer:
            for time, values in blocks:
                writer.write(time, values)
            writer.finish(Ending("completed"))

    After each block written the file can be read, also if the program is killed then: `Run.from_netcdf` reads ``run.nc.part``
    and calls it interrupted. A file that had the name before stays as it was until then, and what a killed run left is not
    overwritten (``.part2`` is next).

    Parameters
    ----------
    path : str or Path
    channels : iterable of Channel
    info : RunInfo, optional
    block : int
        Samples kept in memory and written at once.
    compress : bool
        Deflate, without loss.

    Raises
    ------
    ResultFileError
        A path that cannot be written, a full disk; what was written before stays in ``PATH.part``.
    MissingPackageError
        The package netCDF4 is not installed.
    """

    def __init__(self, path, channels, info=None, *, block=_BLOCK, compress=False):
        self.path, self.info = Path(path), RunInfo() if info is None else info
        self.channels = channels if isinstance(channels, Channels) else Channels(channels)
        if int(block) < 1:
            raise ResultError(f"block = {block}: at least 1 sample is written at once")
        files.check_target(self.path)
        self.part = files.free_part(self.path)
        self.samples = self._held = 0
        self._last = -np.inf
        self._buffer = np.empty((int(block), len(self.channels) + 1))
        self._dataset = self._guarded(self._create, compress)

    def write(self, time, values):
        """Append samples.

        Parameters
        ----------
        time : float or array_like (m,)
            s, after all times before.
        values : array_like (k,) or (m, k)
            One column a channel, in their order.

        Raises
        ------
        ResultError
            A wrong shape, or time that does not increase.
        ResultFileError
            The disk is full.
        """
        if self._dataset is None:
            raise ResultError(f"{self.path} is closed; nothing can be added")
        time = np.atleast_1d(np.asarray(time, dtype=float))
        values = np.asarray(values, dtype=float).reshape(time.size, -1) if np.ndim(values) < 2 else np.asarray(values, dtype=float)
        if time.ndim != 1 or values.shape != (time.size, len(self.channels)):
            raise ResultError(f"times of shape {time.shape} and values of shape {values.shape}: ({time.size}, {len(self.channels)}) is needed, "
                              "a column a channel")
        before = np.concatenate(([self._last], time[:-1]))
        if not (np.isfinite(time) & (time > before)).all():
            at = int(np.argmin(np.isfinite(time) & (time > before)))
            raise ResultError(f"time does not increase: {before[at]:.9g} s is followed by {time[at]:.9g} s")
        self._append(time, values)

    def flush(self):
        """Write what is held in memory, so that it can be read from the file."""
        if self._dataset is not None:
            self._guarded(self._write_held)

    def finish(self, ending=None, message=None):
        """Close the file with how the run ended, and give it its name.

        Parameters
        ----------
        ending : Ending, optional
            Completed if not given.
        message : str, optional

        Raises
        ------
        ResultFileError
        """
        if self._dataset is None:
            return
        self.flush()
        self.info = self.info.ended(ending or Ending("completed", time=self._last if self.samples else None), message)
        self._guarded(self._close)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            self.finish()
        elif self._dataset is not None:
            detail = "by the user" if issubclass(kind, KeyboardInterrupt) else f"{kind.__name__}: {error}"
            self.finish(Ending("interrupted", time=self._last if self.samples or self._held else None, detail=detail))

    def _create(self, compress):
        netcdf = optional("netCDF4", "a netCDF file")
        dataset = netcdf.Dataset(self.part, "w", format="NETCDF4")
        dataset.createDimension(TIME, None)
        chunk = (len(self._buffer),)
        more = {"compression": "zlib", "complevel": 1, "shuffle": True} if compress else {}
        variable = dataset.createVariable(TIME, "f8", (TIME,), chunksizes=chunk, fill_value=False, **more)
        variable.units = "s"
        for channel in self.channels.values():
            variable = dataset.createVariable(channel.name, "f8", (TIME,), chunksizes=chunk, fill_value=False, **more)
            variable.set_var_chunk_cache(size=2 * self._buffer.itemsize * chunk[0])  # the default, 16 MB and more a channel, fills up
            variable.setncatts({"units": channel.unit, "long_name": channel.description, "place": channel.place})
        dataset.set_auto_maskandscale(False)
        dataset.setncattr_string(FORMAT, FORMAT_NAME)
        _note(dataset, replace(self.info, ending=Ending("running")))
        dataset.sync()
        return dataset

    def _append(self, time, values):
        start = 0
        while start < time.size:
            count = min(time.size - start, len(self._buffer) - self._held)
            place, taken = slice(self._held, self._held + count), slice(start, start + count)
            self._buffer[place, 0], self._buffer[place, 1:] = time[taken], values[taken]
            self._held += count
            self._last = float(time[taken][-1])
            start += count
            if self._held == len(self._buffer):
                self.flush()

    def _write_held(self):
        if not self._held:
            return
        place = slice(self.samples, self.samples + self._held)
        # time last: its length is then never ahead of a channel's
        for column, name in [*enumerate(self.channels, start=1), (0, TIME)]:
            self._dataset.variables[name][place] = np.ascontiguousarray(self._buffer[:self._held, column])
        self._dataset.sync()
        self.samples += self._held
        self._held = 0

    def _close(self):
        _note(self._dataset, self.info)
        self._dataset.close()
        self._dataset = None
        os.replace(self.part, self.path)

    def _guarded(self, work, *arguments):
        try:
            return work(*arguments)
        except (OSError, RuntimeError) as error:
            if isinstance(error, ResultFileError):
                raise
            dataset, self._dataset = getattr(self, "_dataset", None), None
            with suppress(Exception):
                dataset.close()
            raise ResultFileError(f"{self.path}: writing stopped after {self.samples} samples: {files.reason(error)}; what was written before may be read "
                                  f"from {self.part}; {files.kept(self.path)}") from error


def _note(dataset, info):
    """Metadata as one line of JSON for railsym, and the main ones in plain attributes for other programs."""
    dataset.setncattr_string(INFO, info.to_json())
    for name in ("vehicle", "configuration", "track", "creep_law", "railsym_version", "message"):
        dataset.setncattr_string(name, getattr(info, name))
    dataset.setncattr_string("ending", str(info.ending))
