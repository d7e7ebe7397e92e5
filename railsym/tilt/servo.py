# SPDX-License-Identifier: BSD-3-Clause
"""Feed-forward of the demand and PID on what tilt lacks of the reference model's. csrc/tilt/tilt_servo.c is the same in C.

    e = y - tilt,   y'' = w^2 (demand(t - latency) - y) - 2 z w y'                      (reference model)
    u = demand + kp e + i + d,   d: derivative of e times kd, low-passed
    i' = ki e + tracking (limited u - u)                                             (anti-windup)
"""

from __future__ import annotations


def clamp(value, bound):
    """Value within -bound ... bound."""
    return -bound if value < -bound else bound if value > bound else value


class Servo:
    """State of model, PID and latency."""

    def __init__(self, constants):
        self.k = constants
        self.expected = self.rate = self.error = self.integral = self.derivative = self.trim = 0.0
        self.commands, self.demands, self.next = [0.0] * (constants.delay + 1), [0.0] * (constants.delay + 1), 0

    def compare(self, tilt):
        """Error (rad) of a measured tilt."""
        before, self.error = self.error, self.expected - tilt
        self.derivative += self.k.derivative * (self.k.kd * (self.error - before) - self.derivative)
        return self.error

    def command(self, demand, feedback):
        """The command that leaves now, for the demand of now; without feedback the demand itself."""
        k = self.k
        wanted = k.kp * self.error + self.integral + self.derivative
        limited = clamp(demand + clamp(wanted, k.trim_limit), k.limit)
        if feedback:
            self.trim = limited - demand
            self.integral += k.ki * self.error + k.tracking * (self.trim - wanted)
        else:
            self.trim = self.integral = self.derivative = 0.0
            limited = clamp(demand, k.limit)
        return self._delayed(limited, demand)

    def _delayed(self, command, demand):
        k, at = self.k, self.next
        self.commands[at], self.demands[at] = command, demand
        self.next = oldest = (at + 1) % (k.delay + 1)
        command, demand = self.commands[oldest], self.demands[oldest]
        self.rate += k.stiffness * (demand - self.expected) - k.damping * self.rate
        self.expected += k.period * self.rate
        return command
