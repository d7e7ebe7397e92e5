# SPDX-License-Identifier: BSD-3-Clause
"""Runs that stay in their netCDF file: a channel is read when it is asked for, in blocks, so that memory does not grow with the file."""

from __future__ import annotations

from collections.abc import Mapping
from threading import Lock

import numpy as np

from railsym.results import layout
from railsym.results.channel import TIME, Channels
from railsym.results.errors import ResultFileError
from railsym.results.run import Run

_BLOCK = 4096      # records read at once


class Records:
    """The records of a run's file: time and channels of each sample, big-endian doubles behind the header.

    The file stays open, so that another run that takes its name does not change what is read here.

    Parameters
    ----------
    path : path
    channels : Channels
        All of the file, in its order.
    start : int
        Bytes of the header.
    count : int
        Records.
    """

    def __init__(self, path, channels, start, count):
        self.path, self.channels, self.count = path, channels, count
        self._start, self._type, self._lock = start, layout.record_type(channels), Lock()
        self._number = {name: k for k, name in enumerate((TIME, *channels))}
        self._file = open(path, "rb", buffering=0)

    def __getstate__(self):
        """For another process, which opens the file anew."""
        return self.path, self.channels, self._start, self.count

    def __setstate__(self, state):
        path, channels, start, count = state
        self.__init__(path, channels, start, count)

    def blocks(self, first, last, size=_BLOCK):
        """Records first..last as arrays (m, k + 1), at most ``size`` at a time.

        Raises
        ------
        ResultFileError
            The file is shorter than its header says.
        """
        width = self._type.itemsize
        for at in range(first, last, size):
            wanted = min(size, last - at) * width
            with self._lock:
                self._file.seek(self._start + at * width)
                raw = self._file.read(wanted)
            if len(raw) < wanted:
                raise ResultFileError(f"{self.path} ends before sample {last - 1}: it was cut off after it was opened")
            yield np.frombuffer(raw, dtype=self._type)

    def column(self, name, first, last):
        """One channel, or the time, of the records first..last, (n,)."""
        out, at, number = np.empty(last - first), 0, self._number[name]
        for block in self.blocks(first, last):
            out[at:at + len(block)] = block[:, number]
            at += len(block)
        return out


class _Columns(Mapping):
    """Channels of some records by name; each access reads the file."""

    def __init__(self, records, names, first, last):
        self.records, self.names, self.first, self.last = records, tuple(names), first, last
        self._known = frozenset(self.names)

    def __getitem__(self, name):
        if name not in self._known:
            raise KeyError(name)
        values = self.records.column(name, self.first, self.last)
        values.flags.writeable = False
        return values

    def __contains__(self, name):
        return name in self._known

    def __iter__(self):
        return iter(self.names)

    def __len__(self):
        return len(self.names)


class FileRun(Run):
    """A `Run` whose samples stay in its file.

    ``run["car.ay"]`` reads that channel, in blocks of 4096 samples, each time it is asked for; the time is read once. What is in memory
    is 8 bytes a sample of each array that you hold. `select`, `between` and `with_info` read nothing but the time; all
    else works as for a run in memory, and `loaded` makes it one.

    Parameters
    ----------
    records : Records
    names : sequence of str
        Channels of the run.
    info : RunInfo
    first, last : int
        Records that belong to it, from the first up to, not including, the last.
    """

    def __init__(self, records, names, info, first=0, last=None):
        last = records.count if last is None else last
        self._values = _Columns(records, names, first, last)
        self.channels = Channels(records.channels[name] for name in names)
        self.info, self._time = info, None

    @property
    def time(self):
        """s, (n,), read-only."""
        if self._time is None:
            rows = self._values
            self._time = rows.records.column(TIME, rows.first, rows.last)
            self._time.flags.writeable = False
        return self._time

    def __len__(self):
        return self._values.last - self._values.first

    @property
    def path(self):
        """The file that it is read from."""
        return self._values.records.path

    def loaded(self):
        """The same run in memory."""
        return Run(self.time, dict(self._values), self.channels, self.info)

    def blocks(self, size=_BLOCK):
        """As `Run.blocks`."""
        rows = self._values
        columns = [0, *(rows.records._number[name] for name in rows.names)]
        for block in rows.records.blocks(rows.first, rows.last, size):
            part = block[:, columns].astype(float)
            yield part[:, 0], part[:, 1:]

    def select(self, *patterns):
        """As `Run.select`."""
        rows = self._values
        return FileRun(rows.records, self.channels.require(*patterns), self.info, rows.first, rows.last)

    def _rows(self, first, last):
        rows = self._values
        return FileRun(rows.records, rows.names, self.info, rows.first + first, rows.first + last)

    def with_channels(self, values, channels):
        """As `Run.with_channels`; the result is in memory."""
        return self.loaded().with_channels(values, channels)

    def with_info(self, **changes):
        """As `Run.with_info`."""
        from dataclasses import replace

        rows = self._values
        return FileRun(rows.records, rows.names, replace(self.info, **changes), rows.first, rows.last)
