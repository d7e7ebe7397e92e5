# SPDX-License-Identifier: BSD-3-Clause
"""Writing a run to a netCDF file while it goes on, block by block, in constant memory."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from railsym.results import files, layout
from railsym.results.channel import Channels
from railsym.results.errors import ResultError, ResultFileError
from railsym.results.metadata import Ending, RunInfo

_BLOCK = 4096
_MOST = 2 ** 32 - 2    # records that the header can count


class ChannelWriter:
    """Writes channels to ``PATH.part`` as they come; `finish` (or the end of a ``with`` block) gives the file its name.

        with ChannelWriter("run.nc", channels, info) as writer:
            for time, values in blocks:
                writer.write(time, values)
            writer.finish(Ending("completed"))

    What was written stays readable when the program is killed or the disk is full: `Run.from_netcdf` reads ``run.nc.part`` and calls it
    interrupted. A file that had the name before stays as it was until then, and what a killed run left is not overwritten
    (``.part2`` is next).

    Parameters
    ----------
    path : str or Path
    channels : iterable of Channel
    info : RunInfo, optional
    block : int
        Samples kept in memory and written at once.

    Raises
    ------
    ResultFileError
        A path that cannot be written, a full disk.
    """

    def __init__(self, path, channels, info=None, *, block=_BLOCK):
        self.path, self.info = Path(path), RunInfo() if info is None else info
        self.channels = channels if isinstance(channels, Channels) else Channels(channels)
        if int(block) < 1:
            raise ResultError(f"block = {block}: at least 1 sample is written at once")
        files.check_target(self.path)
        self.part = files.free_part(self.path)
        self.samples = self._held = 0
        self._last = -np.inf
        self._buffer = np.empty((int(block), len(self.channels) + 1))
        self._file = None
        self._guarded(self._create)

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
        if self._file is None:
            raise ResultError(f"{self.path} is closed; nothing can be added")
        time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
        if time.ndim == 0:
            time, values = time[None], values[None]
        if time.ndim != 1 or values.shape != (time.size, len(self.channels)):
            raise ResultError(f"times of shape {time.shape} and values of shape {values.shape}: ({time.size}, {len(self.channels)}) is needed, "
                              "a column a channel")
        before = np.concatenate(([self._last], time[:-1]))
        good = np.isfinite(time) & (time > before)
        if not good.all():
            at = int(np.argmin(good))
            raise ResultError(f"time does not increase: {before[at]:.9g} s is followed by {time[at]:.9g} s")
        self._append(time, values)

    def flush(self):
        """Write what is held in memory, so that it can be read from the file."""
        if self._file is not None:
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
        if self._file is None:
            return
        self.flush()
        self.info = self.info.ended(ending or Ending("completed", time=self._last if self.samples else None), message)
        self._guarded(self._close)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            self.finish()
        elif self._file is not None:
            detail = "by the user" if issubclass(kind, KeyboardInterrupt) else f"{kind.__name__}: {error}"
            self.finish(Ending("interrupted", time=self._last if self.samples or self._held else None, detail=detail))

    def _create(self):
        head, self._room = layout.header(self.channels, replace(self.info, ending=Ending("running")))
        self._file = open(self.part, "xb", buffering=0)
        self._start = len(head)
        _write_all(self._file, head)

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
        if self.samples + self._held > _MOST:
            raise OSError(f"the netCDF classic format counts at most {_MOST} samples")
        width = layout.record_type(self.channels).itemsize
        self._file.seek(self._start + self.samples * width)
        _write_all(self._file, self._buffer[:self._held].astype(">f8").tobytes())
        # counted only when they are all there
        self._file.seek(layout.RECORDS)
        _write_all(self._file, (self.samples + self._held).to_bytes(4, "big"))
        self.samples += self._held
        self._held = 0

    def _close(self):
        try:
            head, _ = layout.header(self.channels, self.info, self._room)
        except ValueError:
            self._move(*layout.header(self.channels, self.info))
        else:
            self._file.seek(0)
            _write_all(self._file, head[:layout.RECORDS] + self.samples.to_bytes(4, "big") + head[layout.RECORDS + 4:])
        os.fsync(self._file.fileno())
        self._file.close()
        self._file = None
        os.replace(self.part, self.path)

    def _move(self, head, room):
        """Copy the records behind a longer header, for metadata that grew beyond the room left for them."""
        new = files.free_part(self.path)
        with open(self.part, "rb") as old, open(new, "xb", buffering=0) as target:
            _write_all(target, head[:layout.RECORDS] + self.samples.to_bytes(4, "big") + head[layout.RECORDS + 4:])
            old.seek(self._start)
            while block := old.read(2 ** 20):
                _write_all(target, block)
        self._file.close()
        os.replace(new, self.part)
        self._file, self._start, self._room = open(self.part, "r+b", buffering=0), len(head), room

    def _guarded(self, work):
        try:
            work()
        except OSError as error:
            file, self._file = self._file, None
            with suppress(OSError, AttributeError):
                file.close()
            raise ResultFileError(f"{self.path}: writing stopped after {self.samples} samples: {files.reason(error)}; "
                                  f"what was written before can be read from {self.part}; {files.kept(self.path)}") from error


def _write_all(file, data):
    """Write all bytes: one call may write a part only, when the disk is nearly full."""
    view = memoryview(data)
    while view:
        view = view[file.write(view):]
