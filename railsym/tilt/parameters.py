# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the tilting controller, and what its samples need of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from railsym.tilt.errors import TiltError
from railsym.tilt.signals import GRAVITY

ESTIMATORS = ("accelerometer", "complementary")
SOURCES = ("own", "leading", "database")
_POSITIVE = ("rate", "limit", "demand_rate", "return_rate", "trim_limit", "derivative_time", "lateral_cutoff", "gyro_cutoff", "crossover",
             "curve_on", "curve_off", "roll_on", "roll_off", "lateral_on", "lateral_off", "hold", "stale", "confirm", "disagreement", "gyro_tolerance",
             "database_tolerance", "follow_tolerance", "follow_confirm", "reference_frequency", "reference_damping", "washout", "slowest")
_AT_LEAST_ZERO = ("latency", "share", "kp", "ki", "kd", "tracking", "ahead", "lead", "sensor_delay", "leave")


@dataclass(frozen=True)
class TiltParameters:
    """Of the control law in docs/tilting.md. Values are assumed unless said otherwise: the paper publishes none.

    Attributes
    ----------
    rate, latency : float
        Hz; s from a sample to its command, a whole number of samples.
    share : float
        Part of the cant deficiency that tilting takes from the passenger (the paper's train: 0.6 assumed).
    limit : float
        rad, of the tilt angle (Pendolino: 8 degrees).
    demand_rate, return_rate : float
        rad/s, of the demand in service; back to upright after a fault.
    kp, ki, kd : float
        -, 1/s, s: on the tilt angle against the reference model's.
    derivative_time, trim_limit, tracking : float
        s; rad that the PID may add to the demand; 1/s at which its integral follows what a limit leaves (anti-windup).
    reference_frequency, reference_damping : float
        Hz, -: second-order model of how tilt follows its command (fitted to pendolino_tilting up to 1.5 Hz: `railsym.tilt.fitted_plant`).
    estimator : str
        ``"accelerometer"``: low-passed lateral acceleration; ``"complementary"``: its slow part, the fast one from the gyroscope.
    lateral_cutoff, gyro_cutoff : float
        Hz, Butterworth low-pass of second order.
    crossover : float
        s, below which the complementary estimate follows the gyroscope.
    source : str
        Of the demand: ``"own"`` sensors; ``"leading"``: sensors ``ahead`` m ahead of the vehicle's middle, used when it comes there;
        ``"database"``: cant deficiency by place, through the same low-pass as the accelerometers.
    ahead, lead : float
        m, of the sensors ahead of the vehicle's middle; s, by which a demand by place is called early, for the lags that follow.
    curve_on, curve_off, roll_on, roll_off, lateral_on, lateral_off : float
        1/m, rad/s, m/s^2: a curve begins above one of the first two "on", ends when all are below "off" for ``leave`` s. The last pair
        serves without gyroscope.
    leave, sensor_delay, slowest : float
        s; s, delay of the sensors themselves, taken off the start of a curve; m/s, below which curvature is not computed.
    hold, stale, confirm : float
        s: a missing value is held, a repeated one believed (inf: always; sensors without noise repeat), a disagreement watched so long.
    disagreement, gyro_tolerance, database_tolerance : float
        m/s^2, between accelerometers; of both to the gyroscope; of the database to the estimate.
    washout : float
        s, at which integrated roll forgets on straight track.
    follow_tolerance, follow_confirm : float
        rad, s: further from the reference model so long, and the actuator has failed.

    Raises
    ------
    TiltError
        A value outside its range, with the unit.
    """

    rate: float = 100.0
    latency: float = 0.02
    share: float = 0.6
    limit: float = np.radians(8.0)
    demand_rate: float = np.radians(5.0)
    return_rate: float = np.radians(2.0)
    kp: float = 0.5
    ki: float = 2.0
    kd: float = 0.0
    derivative_time: float = 0.05
    trim_limit: float = np.radians(1.0)
    tracking: float = 2.0
    reference_frequency: float = 3.0
    reference_damping: float = 0.9
    estimator: str = "accelerometer"
    lateral_cutoff: float = 0.5
    gyro_cutoff: float = 2.0
    crossover: float = 1.0
    source: str = "own"
    ahead: float = 9.5
    lead: float = 0.0
    curve_on: float = 1.0 / 2500.0
    curve_off: float = 1.0 / 5000.0
    roll_on: float = 0.010
    roll_off: float = 0.005
    lateral_on: float = 0.25
    lateral_off: float = 0.12
    leave: float = 0.3
    sensor_delay: float = 0.0
    slowest: float = 5.0
    hold: float = 0.05
    stale: float = 0.1
    confirm: float = 0.5
    disagreement: float = 0.3
    gyro_tolerance: float = 0.5
    database_tolerance: float = 0.4
    washout: float = 10.0
    follow_tolerance: float = np.radians(1.0)
    follow_confirm: float = 0.5

    def __post_init__(self):
        for name in (*_POSITIVE, *_AT_LEAST_ZERO):
            value, low = getattr(self, name), name in _POSITIVE
            if name == "stale" and value == np.inf:
                continue
            if not isinstance(value, (int, float, np.floating)) or not np.isfinite(value) or value < 0.0 or (low and value == 0.0):
                raise TiltError(f"{name} = {value!r}: a finite number {'above 0' if low else 'of at least 0'} is needed (SI units)")
        for name, known in (("estimator", ESTIMATORS), ("source", SOURCES)):
            if getattr(self, name) not in known:
                raise TiltError(f"{name} {getattr(self, name)!r}: there are {', '.join(known)}")
        self._check_ranges()

    def _check_ranges(self):
        if self.limit >= 0.5 * np.pi or self.share > 5.0:
            raise TiltError(f"limit {np.degrees(self.limit):g} deg, share {self.share:g}: below 90 degrees, at most 5")
        for low, high in (("curve_off", "curve_on"), ("roll_off", "roll_on"), ("lateral_off", "lateral_on")):
            if getattr(self, low) >= getattr(self, high):
                raise TiltError(f"{low} {getattr(self, low):g} must lie below {high} {getattr(self, high):g}: between them is the hysteresis")
        for name in ("lateral_cutoff", "gyro_cutoff"):
            if getattr(self, name) >= 0.45 * self.rate:
                raise TiltError(f"{name} {getattr(self, name):g} Hz: below 0.45 of the rate of {self.rate:g} Hz is needed")
        if abs(self.latency * self.rate - round(self.latency * self.rate)) > 1e-6:
            raise TiltError(f"latency {self.latency:g} s: a whole number of samples of {1.0 / self.rate:g} s is needed")
        if self.source == "leading" and self.ahead > 200.0:
            raise TiltError(f"ahead {self.ahead:g} m: the controller remembers 200 m of track")
        if self.reference_frequency * 2.0 * np.pi > 0.5 * self.rate:
            raise TiltError(f"reference_frequency {self.reference_frequency:g} Hz is too high for {self.rate:g} samples a second")

    def with_(self, **changes):
        """The same with other values."""
        unknown = [name for name in changes if name not in self.__dataclass_fields__]
        if unknown:
            raise TiltError(f"{unknown[0]!r} is no parameter of the controller; there are {', '.join(self.__dataclass_fields__)}")
        return replace(self, **changes)

    @property
    def period(self):
        """s, between samples."""
        return 1.0 / self.rate

    @property
    def delay(self):
        """Latency in samples."""
        return round(self.latency * self.rate)

    @property
    def follow_delay(self):
        """s, of slow motions in the reference model: 2 z / w."""
        return self.reference_damping / (np.pi * self.reference_frequency)

    def samples(self, seconds):
        """Samples in a time, at least one."""
        return max(1, round(min(seconds * self.rate, 1e9)))

    def biquad(self, cutoff):
        """b0 b1 b2 a1 a2 of the Butterworth low-pass of second order (SciPy, bilinear)."""
        from scipy.signal import butter

        b, a = butter(2, cutoff, fs=self.rate)
        return tuple(float(x) for x in (*b, a[1], a[2]))

    def filter_delay(self, cutoff):
        """s, of a slow ramp through that low-pass: sqrt(2) / (2 pi cutoff) in continuous time."""
        b0, b1, b2, a1, a2 = self.biquad(cutoff)
        numerator, denominator = (b1 + 2.0 * b2) / (b0 + b1 + b2), (a1 + 2.0 * a2) / (1.0 + a1 + a2)
        return (numerator - denominator) * self.period

    def angle(self, cant_deficiency):
        """rad, of tilt that takes the share from an uncompensated acceleration (m/s^2)."""
        return self.share * np.arctan(cant_deficiency / GRAVITY)
