# SPDX-License-Identifier: BSD-3-Clause
"""The result of a simulation: named channels over time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym.results.channel import TIME, Channel, Channels
from railsym.results.errors import ResultError, UnknownChannelError
from railsym.results.metadata import RunInfo

# relative to the mean step: times written with 6 significant digits by other programs pass, a landed step does not
_UNIFORM = 1e-3


class Run:
    """Channels over time, with units and metadata. Arrays are read-only and not copied.

    Parameters
    ----------
    time : array_like (n,)
        s, strictly increasing; it need not be uniform.
    values : dict of str to array_like (n,), or ndarray (n, k)
        By channel name, or one column a channel in the order of ``channels``.
    channels : iterable of Channel
        Name, unit, description and place of each.
    info : RunInfo, optional
        Vehicle, track, how it ended and so on.

    Attributes
    ----------
    time : ndarray (n,)
        s.
    channels : Channels
        By name; ``run.channels.match("*.Y")`` for the names that fit a pattern.
    info : RunInfo

    Raises
    ------
    ResultError
        Times that do not increase or are not finite, channels of another length, values that are no real numbers.
    """

    def __init__(self, time, values, channels, info=None):
        self.channels = channels if isinstance(channels, Channels) else Channels(channels)
        self.info = RunInfo() if info is None else info
        self.time = _frozen(time, "time")
        _check_time(self.time)
        if not isinstance(values, dict):
            values = _columns(values, self.channels, self.time.size)
        _check_names(values, self.channels)
        self._values = {name: _frozen(values[name], f"channel {name}") for name in self.channels}
        for name, array in self._values.items():
            if array.shape != self.time.shape:
                raise ResultError(f"channel {name} has shape {array.shape}, time has {self.time.shape}")

    @classmethod
    def from_arrays(cls, time, values, units, **info):
        """A run from arrays, such as measured ones.

        Parameters
        ----------
        time : array_like (n,)
            s.
        values : dict of str to array_like (n,)
        units : dict of str to str
            By channel name.
        **info
            Fields of `RunInfo`.
        """
        missing = [name for name in values if name not in units]
        if missing:
            raise ResultError(f"no unit is given for {', '.join(missing)}: units={{'{missing[0]}': 'm/s^2'}}, or '-' for a pure number")
        return cls(time, dict(values), [Channel(name, units[name]) for name in values], RunInfo(**info))

    def __getitem__(self, name):
        if name == TIME:
            return self.time
        return self._values[self.channels[name].name]

    def __contains__(self, name):
        return name in self._values

    def __len__(self):
        return self.time.size

    def __repr__(self):
        span = f", {self.time[0]:.6g} to {self.time[-1]:.6g} s" if len(self) else ""
        return f"<Run of {self.info.vehicle or 'a vehicle'}: {len(self.channels)} channels, {len(self)} samples{span}; {self.info.ending}>"

    def unit(self, name):
        """Unit of a channel."""
        return "s" if name == TIME else self.channels[name].unit

    @property
    def status(self):
        """Why it ended: completed, derailed, not_converged or interrupted."""
        return self.info.status

    @property
    def message(self):
        """What was found, for people."""
        return self.info.message

    @property
    def step(self):
        """Sampling interval, s.

        Raises
        ------
        ResultError
            Less than two samples, or a sampling that is not uniform.
        """
        return uniform_step(self.time)

    def select(self, *patterns):
        """The run with the channels that fit the patterns only.

        Parameters
        ----------
        *patterns : str
            Such as ``"*.Y"``; each must fit a channel.

        Raises
        ------
        UnknownChannelError
        """
        names = self.channels.require(*patterns)
        return Run(self.time, {n: self._values[n] for n in names}, [self.channels[n] for n in names], self.info)

    def between(self, start, end):
        """The samples with start <= t <= end (s).

        Raises
        ------
        ResultError
            No sample lies there.
        """
        if not len(self) or not start <= end or end < self.time[0] or start > self.time[-1]:
            span = f"{self.time[0]:.6g} to {self.time[-1]:.6g} s" if len(self) else "nothing"
            raise ResultError(f"no sample lies between {start:g} and {end:g} s; the run covers {span}")
        first, last = (int(k) for k in np.searchsorted(self.time, (start, np.nextafter(end, np.inf))))
        if first == last:
            raise ResultError(f"no sample lies between {start:g} and {end:g} s: the samples around are at {self.time[first - 1]:.6g} "
                              f"and {self.time[first]:.6g} s")
        return self._rows(first, last)

    def _rows(self, first, last):
        """The samples first..last (not including the last)."""
        return Run(self.time[first:last], {n: v[first:last] for n, v in self._values.items()}, self.channels, self.info)

    def blocks(self, size=4096):
        """All samples, piece by piece.

        Parameters
        ----------
        size : int
            Samples in a piece, at most.

        Yields
        ------
        time : ndarray (m,)
            s
        values : ndarray (m, k)
            A column a channel, in their order.
        """
        for first in range(0, len(self), size):
            rows = slice(first, first + size)
            time = self.time[rows]
            yield time, np.column_stack([v[rows] for v in self._values.values()]) if self._values else np.empty((time.size, 0))

    def resampled(self, rate):
        """The run at a uniform rate (Hz), by monotone cubic interpolation (PCHIP).

        Parameters
        ----------
        rate : float
            Hz, at least the present mean rate: lowering it would fold what is above half of the new rate.

        Raises
        ------
        ResultError
        """
        from scipy.interpolate import PchipInterpolator

        if len(self) < 2:
            raise ResultError(f"{len(self)} samples cannot be interpolated; at least 2 are needed")
        duration = self.time[-1] - self.time[0]
        mean = (len(self) - 1) / duration
        if not 0.999 * mean <= rate < np.inf:
            raise ResultError(f"rate {rate:g} Hz is below the run's mean rate of {mean:.6g} Hz, which would fold higher frequencies; give at least "
                              "that, or filter and decimate (scipy.signal.decimate)")
        time = self.time[0] + np.arange(int(np.floor(duration * rate * (1 + 1e-12))) + 1) / rate
        new = {name: PchipInterpolator(self.time, values)(np.minimum(time, self.time[-1])) for name, values in self._values.items()}
        return Run(time, new, self.channels, self.info)

    def with_channels(self, values, channels):
        """The run with further channels (``values`` by name)."""
        channels = tuple(channels)
        return Run(self.time, self._values | dict(values), [*self.channels.values(), *channels], self.info)

    def with_info(self, **changes):
        """The run with other metadata."""
        return Run(self.time, self._values, self.channels, replace(self.info, **changes))

    def spectrum(self, channel, band=None, window="hann", start=None, end=None):
        """Amplitude spectrum of a channel; see `railsym.results.spectrum.amplitude_spectrum`."""
        from railsym.results.spectrum import spectrum_of

        part = self if start is None and end is None else self.between(-np.inf if start is None else start, np.inf if end is None else end)
        return spectrum_of(part, channel, band, window)

    def plot(self, channels="*", *, axes=None, over="time"):
        """Draw channels over time, one panel a unit.

        Parameters
        ----------
        channels : str or sequence of str
            Names or patterns.
        axes : array of matplotlib Axes, optional
            One a unit.
        over : str
            ``"time"`` or the name of a channel, such as ``"s"``.

        Returns
        -------
        ndarray of matplotlib Axes
        """
        from railsym.plots.runs import plot_run

        return plot_run(self, channels, axes=axes, over=over)

    def to_xarray(self):
        """An ``xarray.Dataset`` over ``time``, with units and metadata as attributes (package xarray)."""
        from railsym.results.netcdf import to_xarray

        return to_xarray(self)

    def to_netcdf(self, path):
        """Save as netCDF (classic format), bit for bit. A file of that name is replaced when the new one is complete."""
        from railsym.results.netcdf import save

        save(self, path)

    @classmethod
    def from_netcdf(cls, path, channels="*", *, lazy=False):
        """Read a file of `to_netcdf` or of a `ChannelWriter`.

        Parameters
        ----------
        path : path
        channels : str or sequence of str
            Only those that fit these patterns.
        lazy : bool
            Leave the samples in the file (`railsym.results.FileRun`): each channel is read when it is asked for.

        Returns
        -------
        Run

        Raises
        ------
        ResultFileError
            No such file, or not one of railsym.
        UnknownChannelError
            A pattern fits no channel.
        """
        from railsym.results.netcdf import load

        return load(path, channels, lazy)

    def to_csv(self, path):
        """Save as CSV with units in the heading line and metadata in lines that begin with ``#``; values read back exactly."""
        from railsym.results.text import save_csv

        save_csv(self, path)

    @classmethod
    def from_csv(cls, path):
        """Read a file of `to_csv`, or any CSV with one heading line such as ``time [s],bogie1.y [m]``."""
        from railsym.results.text import load_csv

        return load_csv(path)

    def to_mat(self, path):
        """Save for MATLAB: variables by valid names, with the true names in ``channel_names`` beside ``variable_names``."""
        from railsym.results.matlab import save_mat

        save_mat(self, path)

    @classmethod
    def from_mat(cls, path):
        """Read a file of `to_mat`."""
        from railsym.results.matlab import load_mat

        return load_mat(path)


def uniform_step(time):
    """Sampling interval (s) of uniformly sampled times (n,).

    Raises
    ------
    ResultError
        Less than two samples, or steps that differ by more than 0.1 % of their mean.
    """
    if time.size < 2:
        raise ResultError(f"{time.size} samples have no sampling interval; at least 2 are needed")
    step = (time[-1] - time[0]) / (time.size - 1)
    off = np.abs(np.diff(time) - step)
    worst = int(np.argmax(off))
    if off[worst] > _UNIFORM * step + 4 * np.spacing(max(abs(time[0]), abs(time[-1]))):
        raise ResultError(f"time is not uniform: a step of {time[worst + 1] - time[worst]:.6g} s at t = {time[worst]:.6g} s, "
                          f"{step:.6g} s in the mean; use run.resampled({np.ceil(1 / np.diff(time).min()):g}) (Hz)")
    return step


def _frozen(values, what):
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise ResultError(f"{what}: real numbers are needed, not {array.dtype}")
    array = array.astype(np.float64, copy=False).view()
    array.flags.writeable = False
    return array


def _check_time(time):
    if time.ndim != 1:
        raise ResultError(f"time has shape {time.shape}; (n,) is needed")
    if not np.isfinite(time).all():
        raise ResultError(f"time is not finite at sample {int(np.argmin(np.isfinite(time)))}")
    if (np.diff(time) <= 0.0).any():
        at = int(np.argmax(np.diff(time) <= 0.0))
        raise ResultError(f"time does not increase: {time[at]:.9g} s is followed by {time[at + 1]:.9g} s (sample {at + 1})")


def _check_names(values, channels):
    for name in channels:
        if name not in values:
            raise ResultError(f"channel {name} has no values")
    for name in values:
        if name not in channels:
            raise UnknownChannelError(f"values are given for {name!r}, which is not among the {len(channels)} channels")


def _columns(values, channels, samples):
    block = np.asarray(values)
    if block.shape != (samples, len(channels)):
        raise ResultError(f"values have shape {block.shape}; ({samples}, {len(channels)}) is needed: a row a time, a column a channel")
    return {name: block[:, k] for k, name in enumerate(channels)}
