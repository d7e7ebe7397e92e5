# SPDX-License-Identifier: BSD-3-Clause
"""Sensors: bandwidth, noise, bias, range, gaps and faults, reproducible by their seed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from railsym.tilt.errors import TiltError
from railsym.tilt.signals import SIGNALS

NAMES = tuple(SIGNALS)[:5]
KINDS = ("bias", "missing", "frozen")


@dataclass(frozen=True)
class Sensor:
    """One sensor.

    Attributes
    ----------
    noise_density : float
        Unit of the signal over the root of Hz, one-sided and white: a sample scatters by density sqrt(rate/2).
    bias : float
    bandwidth : float
        Hz, low-pass of second order (Butterworth) before the sampling.
    range : float
        Largest value either way.
    """

    noise_density: float = 0.0
    bias: float = 0.0
    bandwidth: float = 20.0
    range: float = np.inf

    def __post_init__(self):
        if not (0.0 <= self.noise_density < np.inf and np.isfinite(self.bias) and self.bandwidth > 0.0 and self.range > 0.0):
            raise TiltError(f"{self}: noise of at least 0, a finite bias, bandwidth (Hz) and range above 0 are needed")

    @property
    def delay(self):
        """s, of slow signals: sqrt(2) / (2 pi bandwidth)."""
        return np.sqrt(2.0) / (2.0 * np.pi * self.bandwidth)


@dataclass(frozen=True)
class SensorFault:
    """What goes wrong with a signal.

    Attributes
    ----------
    signal : str
        A name of SIGNALS.
    kind : str
        ``"bias"``: ``value`` is added; ``"missing"``: no samples; ``"frozen"``: the last value again and again.
    start, end : float
        s
    value : float
    """

    signal: str
    kind: str
    start: float
    end: float = np.inf
    value: float = 0.0

    def __post_init__(self):
        if self.signal not in SIGNALS or self.kind not in KINDS:
            raise TiltError(f"sensor fault {self.kind!r} of {self.signal!r}: signals are {', '.join(SIGNALS)}; kinds {', '.join(KINDS)}")
        if not self.start < self.end or not np.isfinite(self.value):
            raise TiltError(f"sensor fault of {self.signal}: from {self.start:g} to {self.end:g} s, value {self.value:g}: start before end and a finite value")


def _gyroscope():
    return Sensor(noise_density=np.radians(0.01), bias=np.radians(0.02), bandwidth=20.0, range=np.radians(50.0))


def _accelerometer(bias):
    return Sensor(noise_density=2e-3, bias=bias, bandwidth=10.0, range=50.0)


@dataclass(frozen=True)
class SensorSet:
    """Sensors on the leading bogie frame, of the tilt, and the odometer.

    All figures are assumed, those of industrial inertial sensors: gyroscope 0.01 deg/s/sqrt(Hz) and 0.02 deg/s of bias, accelerometers
    0.2 mg/sqrt(Hz) and 2 and -1 mg.

    Attributes
    ----------
    roll_rate, yaw_rate, lateral_a, lateral_b, tilt : Sensor
        Unit of the signal.
    place_offset, place_scale : float
        m, and relative: of the odometer; its speed has the relative one.
    loss : float
        Part of the samples that are missing at random.
    seed : int
        Of noise and loss.
    faults : tuple of SensorFault
    spread : float
        m, between the two accelerometers across the frame's middle.
    """

    roll_rate: Sensor = field(default_factory=_gyroscope)
    yaw_rate: Sensor = field(default_factory=_gyroscope)
    lateral_a: Sensor = field(default_factory=lambda: _accelerometer(0.02))
    lateral_b: Sensor = field(default_factory=lambda: _accelerometer(-0.01))
    tilt: Sensor = field(default_factory=lambda: Sensor(noise_density=np.radians(0.002), bandwidth=30.0, range=np.radians(12.0)))
    place_offset: float = 0.0
    place_scale: float = 0.0
    loss: float = 0.0
    seed: int = 1
    faults: tuple = ()
    spread: float = 1.0

    def __post_init__(self):
        if not 0.0 <= self.loss < 1.0 or not np.isfinite(self.place_offset) or not -0.5 < self.place_scale < 0.5:
            raise TiltError(f"loss {self.loss!r}, place_offset {self.place_offset!r} m, place_scale {self.place_scale!r}: a part below 1, a length, a "
                            "relative error below 0.5")
        if not all(isinstance(fault, SensorFault) for fault in self.faults):
            raise TiltError("faults: a tuple of SensorFault is needed")

    @classmethod
    def ideal(cls, **options):
        """Without noise and bias, with the same bandwidths."""
        full = cls(**options)
        return replace(full, **{name: replace(getattr(full, name), noise_density=0.0, bias=0.0) for name in NAMES})

    def with_faults(self, *faults):
        """The same with faults."""
        return replace(self, faults=tuple(faults))

    def scatter(self, rate):
        """Standard deviations of samples taken at a rate (Hz), in the order of SIGNALS."""
        return [getattr(self, name).noise_density * np.sqrt(0.5 * rate) for name in NAMES]

    def low_pass(self, name, step):
        """b0 b1 b2 a1 a2 at the step (s) at which the true signal is known.

        Raises
        ------
        TiltError
            A bandwidth that the step does not resolve.
        """
        from scipy.signal import butter

        bandwidth = getattr(self, name).bandwidth
        if bandwidth >= 0.45 / step:
            raise TiltError(f"sensor {name}: a bandwidth of {bandwidth:g} Hz needs steps below {0.45 / bandwidth:.3g} s; they are {step:g} s")
        b, a = butter(2, bandwidth, fs=1.0 / step)
        return [float(x) for x in (*b, a[1], a[2])]


class NoiseSource:
    """Random numbers of the samples, in pieces: the same whatever the size of the pieces."""

    def __init__(self, sensors):
        self.sensors = sensors
        self.normal, self.uniform = (np.random.default_rng([sensors.seed, k]) for k in (0, 1))

    def rows(self, count):
        """Array (count, 5); nan: that sample is lost."""
        found = self.normal.standard_normal((count, len(NAMES)))
        if self.sensors.loss:
            found[self.uniform.random((count, len(NAMES))) < self.sensors.loss] = np.nan
        return found
