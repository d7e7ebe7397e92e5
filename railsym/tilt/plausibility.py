# SPDX-License-Identifier: BSD-3-Clause
"""Which signals can be used: missing and repeated samples, and a vote between two accelerometers and the gyroscope.

A signal is lost when it is missing longer than ``hold``, or (gyroscope, accelerometers) repeats one value other than 0 for ``stale``.
Disagreements must last ``confirm``; what is found stays. csrc/tilt/tilt_plausibility.c is the same in C.
"""

from __future__ import annotations

from railsym.tilt.faults import Fault

A, B, GYRO, TILT = int(Fault.ACCELEROMETER_A), int(Fault.ACCELEROMETER_B), int(Fault.GYROSCOPE), int(Fault.TILT_SENSOR)
ODOMETER = int(Fault.ODOMETER)
_FAULT_OF = (GYRO, GYRO, A, B, TILT, ODOMETER, ODOMETER)
_COULD_BE_STALE = 4          # signals, from the first


class Channels:
    """Last good values of the seven signals."""

    def __init__(self, constants):
        self.k = constants
        self.values, self.missing, self.same = [0.0] * 7, [0] * 7, [0] * 7

    def take(self, raw):
        """Take a sample; returns the faults of signals that are lost."""
        faults, values = 0, self.values
        for i in range(7):
            value = raw[i]
            if value != value:
                self.missing[i] += 1
            else:
                self.missing[i] = 0
                self.same[i] = self.same[i] + 1 if value == values[i] and value != 0.0 else 0
                values[i] = value
            if self.missing[i] > self.k.hold or (i < _COULD_BE_STALE and self.same[i] >= self.k.stale):
                faults |= _FAULT_OF[i]
        return faults


class Vote:
    """Two accelerometers against each other and against the gyroscope."""

    def __init__(self, constants):
        self.k = constants
        self.roll, self.apart, self.off = 0.0, 0, 0

    def gyroscope(self, faults, roll_rate, yaw_rate, speed, in_curve):
        """Lateral acceleration by the gyroscope alone: its integrated roll rate forgets where the track is straight."""
        if not faults & GYRO:
            self.roll += self.k.period * roll_rate
            if not in_curve:
                self.roll -= self.k.washout * self.roll
        return speed * yaw_rate - self.k.gravity * self.roll

    def judge(self, faults, a, b, by_gyro):
        """Faults, with those that disagreement of low-passed accelerations (m/s^2) has confirmed."""
        both, apart = not faults & (A | B), abs(a - b) > self.k.disagreement
        self.apart = self.apart + 1 if both and apart else 0
        if self.apart >= self.k.confirm:
            if faults & GYRO:
                return faults | A | B
            faults |= A if abs(a - by_gyro) > abs(b - by_gyro) else B
            self.apart = 0
        if faults & GYRO or (faults & A and faults & B) or (both and apart):
            self.off = 0
            return faults
        off = abs(mean(faults, a, b) - by_gyro) > self.k.gyro_tolerance
        self.off = self.off + 1 if off else 0
        if self.off >= self.k.confirm:
            faults |= A | B | GYRO if faults & (A | B) else GYRO
        return faults


def mean(faults, a, b):
    """Mean of the accelerations that can be used, 0 where none can."""
    if not faults & (A | B):
        return 0.5 * (a + b)
    if not faults & A:
        return a
    return b if not faults & B else 0.0
