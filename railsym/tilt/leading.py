# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle whose controller reads the sensors of a vehicle further ahead in the train."""

from __future__ import annotations

import numpy as np

from railsym.tilt.errors import TiltError
from railsym.tilt.signals import recorded


class LeadingSignals:
    """A law for `TiltUnit`: gyroscope and accelerometers come from the record of a leading vehicle, the rest from the vehicle itself.

    Parameters
    ----------
    controller : Controller
        With ``source="leading"``; its parameter ``ahead`` counts from the middle of the vehicle that follows to the leading sensors.
    record : railsym.Run
        Of the leading vehicle's tilt unit, over the same track at the same constant speed from the same place.
    distance : float
        m, of the leading vehicle's middle ahead of that of the vehicle that follows.
    speed : float
        m/s

    Attributes
    ----------
    consumed : list of float
        The signals that the last step used: what the tilt unit records.

    Notes
    -----
    The leading vehicle meets a place distance/speed earlier, rounded to whole samples; ``distance`` is that of the rounded one.
    """

    def __init__(self, controller, record, distance, speed):
        if controller.parameters.source != "leading":
            raise TiltError(f"controller with source {controller.parameters.source!r}: the signals of a leading vehicle need source='leading'")
        if not distance > 0.0 or not speed > 0.0:
            raise TiltError(f"leading vehicle: distance {distance!r} m, speed {speed!r} m/s: both above 0 are needed")
        self.controller, self.parameters = controller, controller.parameters
        self.shift = round(distance / speed * self.parameters.rate)
        self.distance = self.shift * speed / self.parameters.rate
        self._ahead = recorded(record, record.time)[:, :4].tolist()
        self.reset()

    def reset(self):
        """Back to the first sample."""
        self.controller.reset()
        self._next, self.consumed = self.shift, None

    @property
    def outputs(self):
        """Of the last sample."""
        return self.controller.outputs

    def step(self, time, signals):
        """Tilt command (rad); behind the end of the record its signals are missing."""
        ahead = self._ahead[self._next] if self._next < len(self._ahead) else [np.nan] * 4
        self._next += 1
        self.consumed = [*ahead, *signals[4:]]
        return self.controller.step(time, self.consumed)
