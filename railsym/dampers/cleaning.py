# SPDX-License-Identifier: BSD-3-Clause
"""From a bench record to its steady cycles on a uniform grid, without offset and drift."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from railsym.dampers import cycles as periodic
from railsym.dampers import record_checks as checks
from railsym.dampers.lag import estimate_lag
from railsym.dampers.record import CleanRecord, Record, RecordError, RecordWarning

_MOST_SAMPLES = 512         # per cycle kept: beyond 256 harmonics there is only noise
_FEWEST_SAMPLES = 384       # per cycle, that the means of blocks of samples leave: 1 % is lost of the 31st harmonic
_MOST_HARMONICS = 15        # of the imposed motion
_FIRST, _SECOND = np.array([5.0, 2.0, -1.0]) / 6.0, np.array([0.4, 0.3, 0.2, 0.1])     # line through 3 and 4 values, at its beginning
_ASYMMETRY = 0.004          # of the first harmonic: even harmonics above it (and above noise) belong to an asymmetric damper


def clean(record, *, check_units=True):
    """Clean one test.

    Finds the frequency by a sine fit, resamples whole cycles to a grid of phases, drops transients at the start and the end,
    takes off offset and drift, and checks for defects. Every finding is in ``messages``; defects also warn.

    Parameters
    ----------
    record : Record or CleanRecord
        A CleanRecord is returned as it is.
    check_units : bool
        Refuse what no railway damper gives, such as a unit off by 1000.

    Returns
    -------
    CleanRecord
        Its ``lag`` is 0: one test cannot tell the lag from the damper's own phase; see `clean_all`.

    Raises
    ------
    RecordError
        A record that cannot be used; the message names the test and the reason.
    """
    if isinstance(record, CleanRecord):
        return record
    if not isinstance(record, Record):
        raise RecordError(f"a Record is needed, not {type(record).__name__}: railsym.dampers.Record(time, displacement, force)")
    checks.check_clipping(record)
    cycles, frequency, start, faults, (kept, departure), inside = _whole_cycles(record)
    notes = []
    dropped = cycles.shape[1] - (kept.stop - kept.start)
    if dropped:
        notes.append(f"{record.label}: {dropped} of {cycles.shape[1]} cycles are transients and were left out")
    if departure > 0.01:
        faults.append(f"{record.label}: the cycles kept still differ by {100 * departure:.1f} %: the test is too short for its transient")
    cycles, drift = _without_trend(cycles[:, kept])
    if drift > 0.02:
        notes.append(f"{record.label}: the force drifts by {100 * drift:.1f} % of its amplitude; taken off")
    # the kept cycles go round, so that they begin where the displacement passes 0
    cycles = np.roll(cycles.reshape(len(cycles), -1), -start, axis=1).reshape(cycles.shape)
    steady = _Steady(cycles, frequency)
    faults += checks.check_flat(record, steady.mean[1]) + _checked(record, steady, check_units)
    return _assembled(record, steady, notes, faults, inside)


@dataclass(frozen=True, eq=False)
class _Steady:
    """Steady cycles (channels, cycles, samples) of a record, and what is needed of them more than once."""

    cycles: np.ndarray
    frequency: float

    @cached_property
    def mean(self):
        """Mean cycle (channels, samples)."""
        return self.cycles.sum(axis=1) / self.cycles.shape[1]

    @cached_property
    def harmonics(self):
        """Complex amplitudes (channels, cycles, orders from 0)."""
        return np.fft.rfft(self.cycles, axis=2) * (2.0 / self.cycles.shape[2])

    @cached_property
    def mean_harmonics(self):
        """Of the mean cycle (channels, orders from 0)."""
        return self.harmonics.sum(axis=1) / self.cycles.shape[1]

    def first(self, channel):
        """Complex amplitude of the first harmonic."""
        return complex(self.mean_harmonics[channel, 1])

    def scatter(self, channel):
        """Root mean square of what does not repeat, unbiased."""
        number, count = self.cycles.shape[1:]
        departure = self.cycles[channel] - self.mean[channel]
        return float(np.sqrt(np.vdot(departure, departure) / (count * (number - 1))))

    def deviations(self, channel, orders):
        """Standard deviation of the mean harmonics from order 1.

        Neighbouring orders share their variance (five of them), since a few cycles alone tell little; noise need not be white.
        """
        number, count = self.cycles.shape[1:]
        top = min(orders, (count - 1) // 2)
        departure = self.harmonics[channel, :, 1:1 + top] - self.mean_harmonics[channel, 1:1 + top]
        variance = np.sum(departure.real**2 + departure.imag**2, axis=0) / (number * (number - 1))
        shared = np.convolve(variance, np.ones(5))[2:-2] / np.convolve(np.ones(top), np.ones(5))[2:-2]
        # the two lowest by the straight line through their neighbours: the mean would be too low for noise that falls with frequency
        shared[:2] = max(variance[:3] @ _FIRST, 0.5 * shared[0]), variance[:4] @ _SECOND
        return np.sqrt(shared)


def clean_all(records, *, check_units=True):
    """Clean several tests of one damper, compare them, and estimate the lag of the force channel over all of them.

    Parameters
    ----------
    records : sequence of Record or CleanRecord
    check_units : bool
        As for `clean`.

    Returns
    -------
    tuple of CleanRecord
        With ``lag`` and ``lag_deviation``, the same in all.

    Raises
    ------
    RecordError
        No record, or one that cannot be used.
    """
    records = (records,) if isinstance(records, (Record, CleanRecord)) else tuple(records)
    if not records:
        raise RecordError("there is no test; give at least one Record")
    cleaned = [clean(record, check_units=check_units) for record in records]
    checks.compare_sizes(cleaned)
    lag, deviation = estimate_lag(cleaned)
    return tuple(replace(one, lag=lag, lag_deviation=deviation) for one in cleaned)


def _whole_cycles(record):
    """Channels as an array (m, cycles, samples_per_cycle), frequency, sample of phase 0, defects, the steady cycles, and the mean
    square of the force inside of blocks of samples (N^2)."""
    given = [record.displacement, record.force] + ([record.velocity] if record.velocity is not None else [])
    step, channels, gap = periodic.uniform(record.time, given)
    channels = channels[:, periodic.moving_part(channels[0])]
    duration = step * (channels.shape[1] - 1)
    frequency, phase = periodic.frequency_of(channels[0], step)
    faults = checks.check_gap(record, gap, frequency)
    checks.check_frequency(record, frequency, step, duration)
    block = max(1, int(1.0 / (frequency * step) / _FEWEST_SAMPLES))
    blocks, inside = periodic.block_means(channels, block)
    phase, step = phase + np.pi * frequency * step * (block - 1), block * step
    cycles, start, first = periodic.on_phases(blocks, step, frequency, phase)
    if cycles.shape[1] < periodic.FEWEST_CYCLES:
        raise RecordError(f"{record.label}: has {frequency * duration:.2f} cycles of {frequency:.3g} Hz; at least 3 whole ones are needed, better 10")
    steady = periodic.steady_cycles(cycles[:2])
    if steady[0].stop - steady[0].start < cycles.shape[1]:
        # frequency and phase again, without the transient
        begin, end = (int(first + k / (frequency * step)) for k in (steady[0].start, steady[0].stop))
        frequency, phase = periodic.frequency_of(blocks[0, begin:end], step)
        cycles, start, _ = periodic.on_phases(blocks, step, frequency, phase - 2.0 * np.pi * frequency * step * begin)
        steady = periodic.steady_cycles(cycles[:2])
    # of a sine of the force's size, the slope makes A^2/2 (omega step)^2 (1 - 1/block^2)/12 of what is inside of blocks
    slope = np.var(cycles[1]) * (2.0 * np.pi * frequency * step) ** 2 * (1.0 - 1.0 / block**2) / 12.0
    return cycles, frequency, start, faults, steady, max(inside - slope, 0.0)


def _without_trend(cycles):
    """Channels without the straight line through the means of their cycles, but with their mean; drift of the force.

    Returns
    -------
    ndarray (m, cycles, samples_per_cycle)
    drift : float
        Over the record, as a part of the force's amplitude.
    """
    m, number, count = cycles.shape
    at = np.arange(number) - 0.5 * (number - 1)
    slope = cycles.mean(axis=2) @ at / (at @ at)                                  # per cycle
    samples = (np.arange(number * count) - 0.5 * (number * count - 1)) / count
    straight = cycles - (slope[:, None] * samples).reshape(cycles.shape)
    return straight, abs(slope[1]) * number / (0.5 * np.ptp(straight[1].mean(axis=0)) or 1.0)


def _checked(record, steady, check_units):
    """Messages of the defects that show in the steady cycles."""
    displacement, force, frequency = steady.first(0), steady.first(1), steady.frequency
    if check_units:
        checks.check_size(record, frequency, abs(displacement), abs(force))
    faults = checks.check_amplitude(record, abs(displacement))
    faults += checks.check_periodic(record, steady.scatter(0) / (abs(displacement) / np.sqrt(2.0)))
    stiffness = force / displacement
    checks.check_energy(record, frequency, np.angle(stiffness), np.pi * stiffness.imag * abs(displacement) ** 2)
    if len(steady.cycles) > 2:
        faults += checks.check_velocity(record, frequency, steady.first(2) / (2j * np.pi * frequency * displacement))
    return faults


def _assembled(record, steady, notes, faults, inside):
    """The CleanRecord; warns of the faults. ``inside``: mean square of the noise that the means of blocks have lost."""
    for fault in faults:
        warnings.warn(fault, RecordWarning, stacklevel=3)
    cycles, frequency, scatter = steady.cycles, steady.frequency, steady.scatter(1)
    noise = float(np.hypot(scatter, np.sqrt(inside)))
    motion, rate = _imposed_motion(steady)
    offset, asymmetric = _force_offset(steady, rate, scatter / np.sqrt(cycles.shape[1]))
    if asymmetric:
        notes = [*notes, f"{record.label}: the force is not the same in both directions; its offset {offset:.4g} N is that at no damper speed"]
    force = _thinned(cycles[1] - offset)
    number, count = force.shape
    motion, rate = (np.tile(_thinned(one[None])[0], number) for one in (motion, rate))
    time = np.arange(number * count) / (count * frequency)
    size = float(np.linalg.norm(steady.mean_harmonics[1, 1:])) / np.sqrt(2.0)
    if noise > 1e-3 * size:
        notes = [*notes, f"{record.label}: noise of the force {100 * noise / (size or 1.0):.2g} % of its r.m.s. value"]
    return CleanRecord(time, motion, rate, force.ravel(), frequency, abs(steady.first(0)), number, count, offset, noise,
                       name=record.name, messages=(*faults, *notes), deviation=_deviation(steady), record=record)


def _deviation(steady, orders=31):
    """Standard deviation (N) of the mean harmonics of the force, as `CleanRecord` has it."""
    by_force = steady.deviations(1, orders)
    by_force[0] = np.hypot(by_force[0], abs(steady.first(1) / steady.first(0)) * steady.deviations(0, orders)[0])
    return by_force


def _imposed_motion(steady):
    """Displacement and velocity of one cycle from the harmonics that stand out of the noise; offset left out."""
    count = steady.cycles.shape[2]
    deviation = steady.deviations(0, _MOST_HARMONICS)
    mean = steady.mean_harmonics[0, 1:1 + deviation.size]
    # a complex error beyond 3.5 deviations: exp(-12)
    clear = np.abs(mean) > np.maximum(3.5 * deviation, 1e-5 * abs(mean[0]))
    clear[0] = True
    spectra = np.zeros((2, count // 2 + 1), dtype=complex)
    spectra[0, 1:1 + mean.size] = np.where(clear, mean, 0.0) * count / 2.0
    spectra[1] = spectra[0] * (2j * np.pi * steady.frequency) * np.arange(count // 2 + 1)
    return np.fft.irfft(spectra, count, axis=1)


def _force_offset(steady, rate, noise):
    """Offset of the force channel, and whether the damper is asymmetric.

    A symmetric damper under a sine has odd harmonics only, and the mean of its force is the offset. The mean of an asymmetric
    one (its even harmonics tell) is its own: there the offset is the force at no speed w of the damper itself, w = v - (dF/dt)/k.
    The compliance that closes the loop of F over w in the mean, 1/k = int(dF/dt dv) / int((dF/dt)^2), makes F a function of w.
    """
    count, frequency = steady.cycles.shape[2], steady.frequency
    spectrum = 0.5 * steady.mean_harmonics[1]
    amplitude, order = 2.0 * np.abs(spectrum), np.arange(spectrum.size)
    even = np.sqrt(np.sum(amplitude[2:8:2] ** 2))
    if even < max(_ASYMMETRY * amplitude[1], 6.0 * noise * np.sqrt(2.0 / count)):
        return float(spectrum[0].real), False
    clear = (order <= 2 * _MOST_HARMONICS) & ((amplitude > 5.0 * noise * np.sqrt(2.0 / count)) | (order == 0))
    few = np.where(clear, spectrum, 0.0) * count
    smooth, slope = np.fft.irfft(few, count), np.fft.irfft(few * 2j * np.pi * frequency * order, count)
    compliance = max(0.0, float(slope @ rate / (slope @ slope)))
    speed = rate - compliance * slope
    crossing = np.flatnonzero(speed * np.roll(speed, -1) < 0.0)
    following = (crossing + 1) % count
    part = speed[crossing] / (speed[crossing] - speed[following])
    at_rest = smooth[crossing] + part * (smooth[following] - smooth[crossing])
    rising = speed[following] > speed[crossing]
    return float(0.5 * (at_rest[rising].mean() + at_rest[~rising].mean())), True


def _thinned(cycles):
    """At most 512 samples per cycle, through a low-pass of the spectrum of the whole record."""
    number, count = cycles.shape
    if count <= _MOST_SAMPLES:
        return cycles
    spectrum = np.fft.rfft(cycles.ravel())[:number * _MOST_SAMPLES // 2 + 1]
    return np.fft.irfft(spectrum, number * _MOST_SAMPLES).reshape(number, _MOST_SAMPLES) * (_MOST_SAMPLES / count)
