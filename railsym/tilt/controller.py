# SPDX-License-Identifier: BSD-3-Clause
"""The tilting controller in Python: sensors to a tilt angle, sample by sample. csrc/tilt/tilt_controller.c is the same in C."""

from __future__ import annotations

from math import atan

import numpy as np

from railsym.tilt.constants import constants
from railsym.tilt.detection import CurveDetector
from railsym.tilt.errors import TiltError
from railsym.tilt.faults import OUTPUTS, Fault, State
from railsym.tilt.filtering import LowPass
from railsym.tilt.parameters import TiltParameters
from railsym.tilt.place import PlaceBuffer, TableReader
from railsym.tilt.plausibility import Channels, Vote, mean
from railsym.tilt.servo import Servo, clamp
from railsym.tilt.signals import Signals, recorded

_GYRO, _TILT, _ACTUATOR, _DATABASE = int(Fault.GYROSCOPE), int(Fault.TILT_SENSOR), int(Fault.ACTUATOR), int(Fault.DATABASE)
_BOTH, _ODOMETER = int(Fault.ACCELEROMETER_A | Fault.ACCELEROMETER_B), int(Fault.ODOMETER)
_OWN, _LEADING, _BY_TABLE = 0, 1, 2


class Controller:
    """Estimate of the cant deficiency, detection of curves, demand, PID, faults.

    Parameters
    ----------
    parameters : TiltParameters, optional
    database : TrackDatabase, optional
        For ``source = "database"``.

    Attributes
    ----------
    outputs : list of float
        Of the last sample, in the order of OUTPUTS.

    Raises
    ------
    TiltError
        A source of the demand without its data.
    """

    def __init__(self, parameters=None, database=None):
        self.parameters, self.database = parameters or TiltParameters(), database
        if (self.parameters.source == "database") != (database is not None):
            raise TiltError(f"source {self.parameters.source!r} with{'' if database is not None else 'out'} a track database: "
                            "source='database' and a TrackDatabase belong together")
        self.reset()

    def reset(self):
        """Back to upright, straight track, nothing remembered."""
        k = self.k = constants(self.parameters)
        self.channels, self.vote, self.detector, self.servo = Channels(k), Vote(k), CurveDetector(k), Servo(k)
        self.buffer, self.table = PlaceBuffer(), None if self.database is None else TableReader(self.database, k.gravity)
        self.filters = [LowPass(coefficients) for coefficients in (k.gyro, k.gyro, k.lateral, k.lateral)]
        self.smooth = LowPass(k.lateral)
        self.faults, self.state = 0, int(State.NORMAL)
        self.complementary = self.yaw_before = self.demand = 0.0
        self.off, self.strayed = 0, 0
        self.outputs = [0.0] * len(OUTPUTS)

    def step(self, time, signals):
        """Tilt command (rad) for a sample.

        Parameters
        ----------
        time : float
            s
        signals : Signals or sequence of 7 float
        """
        self.faults |= self.channels.take(signals)
        values = self.channels.values
        roll_rate, yaw_rate, a, b = (f.step(x) for f, x in zip(self.filters, values))
        tilt, speed, place = values[4], values[5], values[6]
        by_gyro = self.vote.gyroscope(self.faults, roll_rate, yaw_rate, speed, self.detector.in_curve)
        self.faults = self.vote.judge(self.faults, a, b, by_gyro)
        deficiency = self._estimate(a, b, values[2], values[3], yaw_rate, roll_rate, speed)
        if self.faults & _GYRO:
            self.detector.by_accelerometer(deficiency)
        else:
            self.detector.by_gyroscope(time, yaw_rate, roll_rate, speed, place)
        wanted = self._source(deficiency if self.detector.in_curve else 0.0, deficiency, place, speed)
        error = self.servo.compare(tilt)
        self._watch_actuator(error)
        self._judge_state()
        command = self._command(wanted)
        servo, found = self.servo, self.detector
        self.outputs = [command, self.demand, deficiency, float(found.in_curve), found.curvature, found.start_time, found.start_place,
                        servo.expected, error, servo.trim, float(self.state), float(self.faults)]
        return command

    def _estimate(self, a, b, raw_a, raw_b, yaw_rate, roll_rate, speed):
        """Cant deficiency, m/s^2; the complementary filter x' = (raw - x)/crossover + V yaw_rate' - g roll_rate."""
        k = self.k
        turned, self.yaw_before = yaw_rate - self.yaw_before, yaw_rate
        self.complementary += k.blend * (mean(self.faults, raw_a, raw_b) - self.complementary) + (speed * turned - k.gravity * k.period * roll_rate)
        if k.complementary and not self.faults & _GYRO:
            return self.complementary
        return mean(self.faults, a, b)

    def _source(self, own, deficiency, place, speed):
        """Acceleration (m/s^2) that is to be compensated now."""
        k = self.k
        if k.source == _LEADING:
            self.buffer.push(place + k.ahead, own)
            return self.buffer.look(place + speed * k.lead)
        if k.source == _BY_TABLE and not self.faults & _DATABASE:
            off = abs(self.table.look(place + k.ahead, speed) - deficiency) > k.database_tolerance
            self.off = self.off + 1 if off else 0
            if self.off >= k.confirm:
                self.faults |= _DATABASE
            return self.smooth.step(self.table.look(place + speed * k.lead, speed))
        return own

    def _watch_actuator(self, error):
        off = abs(error) > self.k.follow_tolerance and not self.faults & _TILT
        self.strayed = self.strayed + 1 if off else 0
        if self.strayed >= self.k.follow_confirm:
            self.faults |= _ACTUATOR

    def _judge_state(self):
        blind = self.faults & _BOTH == _BOTH or self.faults & _ODOMETER
        state = State.FAILED if self.faults & _ACTUATOR else State.SAFE if blind else State.DEGRADED if self.faults else State.NORMAL
        self.state = int(state)

    def _command(self, wanted):
        k, off = self.k, self.state >= State.SAFE
        target = 0.0 if off else clamp(k.share * atan(wanted / k.gravity), k.limit)
        self.demand += clamp(target - self.demand, k.return_step if off else k.demand_step)
        return self.servo.command(self.demand, not off and not self.faults & _TILT)

    def fresh(self):
        """A controller of the same parameters that remembers nothing."""
        return type(self)(self.parameters, self.database)

    def replay(self, times, signals):
        """Outputs for recorded signals, as a fresh controller gives them: bit for bit those of the run that they were recorded in.

        Parameters
        ----------
        times : array_like (n,)
            s, a controller's period apart.
        signals : array_like (n, 7), mapping, or Run
            In the order of SIGNALS, or by these names; what is missing is nan.

        Returns
        -------
        ndarray (n, 12)
            In the order of OUTPUTS.

        Raises
        ------
        TiltError
        """
        times = checked_times(times, self.parameters)
        rows, control = recorded(signals, times), self.fresh()
        found = np.empty((len(times), len(OUTPUTS)))
        for k, (time, row) in enumerate(zip(times.tolist(), rows.tolist())):
            control.step(time, Signals(*row))
            found[k] = control.outputs
        return found


def checked_times(times, parameters):
    """Times (s) as an array; refused where they are not a period apart."""
    times = np.ascontiguousarray(times, dtype=float)
    if times.ndim != 1 or not np.isfinite(times).all() or (abs(np.diff(times) - parameters.period) > 1e-3 * parameters.period).any():
        raise TiltError(f"times of recorded signals must lie {parameters.period:g} s apart, as this controller samples ({parameters.rate:g} Hz); "
                        "resample them (Run.resampled) or give the controller their rate")
    return times
