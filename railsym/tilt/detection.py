# SPDX-License-Identifier: BSD-3-Clause
"""Curves found with hysteresis, and where they began.

A transition's curvature rises as a ramp: from the times t_off and t_on at which its filtered value passes the two thresholds,

    t_start = t_off - (t_on - t_off) curve_off / (curve_on - curve_off) - delay,

the delay being that of a ramp in filter and sensor. csrc/tilt/tilt_detection.c is the same in C.
"""

from __future__ import annotations


class CurveDetector:
    """State: ``in_curve``, ``curvature`` (1/m), ``start_time`` (s) and ``start_place`` (m) of the last curve that began; nan before.

    The place is that of the sensors on the track.
    """

    def __init__(self, constants):
        self.k = constants
        self.in_curve, self.curvature = 0, 0.0
        self.start_time = self.start_place = float("nan")
        self.passed_off, self.before, self.quiet = float("nan"), 0.0, 0

    def by_gyroscope(self, time, yaw_rate, roll_rate, speed, place):
        """A sample of the filtered gyroscope."""
        k = self.k
        self.curvature = yaw_rate / (speed if speed > k.slowest else k.slowest)
        size, roll = abs(self.curvature), abs(roll_rate)
        self._begun(time, size, speed, place)
        self.before = size
        self._switch(size > k.curve_on or roll > k.roll_on, size < k.curve_off and roll < k.roll_off)

    def by_accelerometer(self, acceleration):
        """A sample without gyroscope."""
        self.curvature, size = 0.0, abs(acceleration)
        self._switch(size > self.k.lateral_on, size < self.k.lateral_off)

    def _switch(self, above, below):
        if above:
            self.in_curve, self.quiet = 1, 0
        elif not below:
            self.quiet = 0
        elif self.in_curve:
            self.quiet += 1
            if self.quiet >= self.k.leave:
                self.in_curve = 0

    def _begun(self, time, size, speed, place):
        k, before = self.k, self.before
        if before < k.curve_off <= size:
            self.passed_off = time - k.period * (size - k.curve_off) / (size - before)
        if before < k.curve_on <= size:
            passed_on = time - k.period * (size - k.curve_on) / (size - before)
            start = self.passed_off - (passed_on - self.passed_off) * k.extrapolation - k.start_delay
            self.start_time = start
            self.start_place = place + k.ahead - speed * (time - start)
