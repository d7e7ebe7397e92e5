# SPDX-License-Identifier: BSD-3-Clause
"""A test of a damper on the bench: as recorded, and as cleaned."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from railsym.errors import RailsymError

_FEWEST_SAMPLES = 32


class RecordError(RailsymError, ValueError):
    """A bench record that cannot be used; the message names the test and the reason."""


class RecordWarning(UserWarning):
    """A bench record that can be used, but has a defect; the message names the test and the reason."""


@dataclass(frozen=True, eq=False)
class Record:
    """One bench test: imposed sinusoidal elongation of a damper and the force in it.

    Parameters
    ----------
    time : array_like (n,)
        s, strictly increasing; it need not be uniform.
    displacement : array_like (n,)
        Elongation of the damper, m: positive when its two ends are further apart.
    force : array_like (n,)
        N, positive in tension (it pulls the two ends together), as in the vehicle.
    velocity : array_like (n,), optional
        Rate of elongation, m/s. Only compared with the displacement.
    name : str
        Used in messages.
    nominal_frequency, nominal_amplitude : float, optional
        Hz and m, as the bench was set: compared with what is found.

    Raises
    ------
    RecordError
        Channels of different length, NaN, time not increasing, fewer than 32 samples.
    """

    time: np.ndarray
    displacement: np.ndarray
    force: np.ndarray
    velocity: np.ndarray | None = None
    name: str = ""
    nominal_frequency: float | None = None
    nominal_amplitude: float | None = None

    def __post_init__(self):
        count = np.size(self.time)
        for channel in ("time", "displacement", "force", "velocity"):
            given = getattr(self, channel)
            if given is None and channel == "velocity":
                continue
            object.__setattr__(self, channel, self._checked(channel, given, count))
        if count < _FEWEST_SAMPLES:
            raise RecordError(f"{self.label}: has {count} samples; at least {_FEWEST_SAMPLES} are needed")
        step = np.diff(self.time)
        if (step <= 0.0).any():
            at = int(np.argmax(step <= 0.0))
            raise RecordError(f"{self.label}: time does not increase: {self.time[at]:.6g} s is followed by {self.time[at + 1]:.6g} s "
                              f"(sample {at + 1}); sort the samples and leave repeated ones out")
        for what in ("nominal_frequency", "nominal_amplitude"):
            value = getattr(self, what)
            if value is not None and not (np.isfinite(value) and value > 0.0):
                raise RecordError(f"{self.label}: {what} {value!r} is not above 0")

    @property
    def label(self) -> str:
        """``test 'name'``, for messages."""
        return f"test {self.name!r}" if self.name else "test without a name"

    def _checked(self, channel, given, count):
        try:
            values = np.array(given, dtype=float).ravel()
        except (TypeError, ValueError):
            raise RecordError(f"{self.label}: {channel} is not an array of numbers") from None
        if values.size != count:
            raise RecordError(f"{self.label}: {channel} has {values.size} samples, time has {count}")
        bad = ~np.isfinite(values)
        if bad.any():
            raise RecordError(f"{self.label}: {channel} is not a finite number in {int(bad.sum())} of {count} samples, the first is "
                              f"sample {int(np.argmax(bad))}; leave these samples out or repeat the test")
        values.flags.writeable = False
        return values


@dataclass(frozen=True, eq=False)
class CleanRecord:
    """The steady cycles of a test, on a uniform grid that begins where the displacement passes 0 upwards.

    Attributes
    ----------
    time, displacement, velocity, force : ndarray (cycles * samples_per_cycle,)
        s from 0, m, m/s, N. Displacement and velocity are the periodic motion (its significant harmonics) without sensor
        noise; the force is as measured, without offset and drift, its noise and its lag still in it.
    frequency, amplitude : float
        Hz; m of the first harmonic of the displacement.
    cycles, samples_per_cycle : int
    force_offset : float
        N, taken off the force.
    noise : float
        N, root mean square of what differs from cycle to cycle in the force.
    lag : float
        s, by which the force channel is behind the displacement channel: a first estimate over all tests that were cleaned
        together, 0 where there is none. The force is not shifted by it.
    lag_deviation : float
        s, standard deviation of that estimate; inf where there is none.
    name : str
    messages : tuple of str
        What was found and done.
    deviation : ndarray (orders,) or None
        N, standard deviation of the mean harmonics of the force from order 1, by what differs from cycle to cycle in the force and,
        for order 1, in the displacement. Noise need not be white.
    record : Record
        What was cleaned.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    frequency: float
    amplitude: float
    cycles: int
    samples_per_cycle: int
    force_offset: float
    noise: float
    lag: float = 0.0
    lag_deviation: float = np.inf
    name: str = ""
    messages: tuple[str, ...] = ()
    deviation: np.ndarray | None = field(default=None, repr=False)
    record: Record | None = field(default=None, repr=False)

    @property
    def label(self) -> str:
        """``test 'name'``, for messages."""
        return f"test {self.name!r}" if self.name else f"test at {self.frequency:.3g} Hz, {1e3 * self.amplitude:.3g} mm"

    @property
    def mean_cycle(self):
        """Time, displacement, velocity and force of one cycle, the mean over the cycles: four arrays (samples_per_cycle,)."""
        n = self.samples_per_cycle
        return self.time[:n], self.displacement[:n], self.velocity[:n], self.force.reshape(self.cycles, n).mean(axis=0)

    def harmonic(self, order: int = 1) -> complex:
        """Complex amplitude of a harmonic of the force, N: force(t) = Re(sum of harmonic(k) exp(2 pi i k frequency t))."""
        return complex(np.mean(self.force * np.exp(-2j * np.pi * order * self.frequency * self.time)) * (2.0 if order else 1.0))

    @cached_property
    def dynamic_stiffness(self) -> complex:
        """First harmonic of force over that of displacement, N/m: the imaginary part is what dissipates."""
        _, motion, _, force = self.mean_cycle
        wave = np.exp(-2j * np.pi * np.arange(self.samples_per_cycle) / self.samples_per_cycle)
        return complex((force @ wave) / (motion @ wave))

    @property
    def dissipated_energy(self) -> float:
        """Work of the bench on the damper in a cycle, J."""
        return float(np.mean(self.force * self.velocity)) / self.frequency
