# SPDX-License-Identifier: BSD-3-Clause
"""What a controller reports: outputs of a sample, states, faults."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag

import numpy as np

OUTPUTS = {"command": "rad", "demand": "rad", "cant_deficiency": "m/s^2", "in_curve": "-", "curvature": "1/m", "start_time": "s", "start_place": "m",
           "expected": "rad", "error": "rad", "trim": "rad", "state": "-", "faults": "-"}


class State(IntEnum):
    """Of the controller; it only rises. SAFE and FAILED bring the body upright at the return rate."""

    NORMAL = 0
    DEGRADED = 1
    SAFE = 2
    FAILED = 3


class Fault(IntFlag):
    """Latched until the controller is made anew."""

    ACCELEROMETER_A = 1
    ACCELEROMETER_B = 2
    GYROSCOPE = 4
    TILT_SENSOR = 8
    ODOMETER = 16
    ACTUATOR = 32
    DATABASE = 64


_WORDS = {Fault.ACCELEROMETER_A: "lateral accelerometer a disagrees or is silent", Fault.ACCELEROMETER_B: "lateral accelerometer b disagrees or is silent",
          Fault.GYROSCOPE: "gyroscope disagrees or is silent", Fault.TILT_SENSOR: "tilt sensor is silent; the demand goes on without feedback",
          Fault.ODOMETER: "speed or place is missing", Fault.ACTUATOR: "tilt does not follow its command",
          Fault.DATABASE: "track database disagrees with the sensors; own sensors take over"}
_THEN = {State.NORMAL: "goes on", State.DEGRADED: "goes on with the sensors left", State.SAFE: "returns upright, tilting is off",
         State.FAILED: "demand returns to upright, tilting is off"}


@dataclass(frozen=True)
class FaultReport:
    """A fault that was found.

    Attributes
    ----------
    time, place : float
        s; m, the last known one.
    fault : Fault
    state : State
        Of the controller from then on.
    tilt : float
        rad, the last measured one.
    """

    time: float
    place: float
    fault: Fault
    state: State
    tilt: float

    def __str__(self):
        return (f"t = {self.time:.2f} s, s = {self.place:.1f} m: {_WORDS[self.fault]}; {self.state.name.lower()}, {_THEN[self.state]} "
                f"(tilt {np.degrees(self.tilt):.2f} deg)")


def reports(times, signals, outputs):
    """Fault reports of a record: a sample at which a fault appears.

    Parameters
    ----------
    times : ndarray (n,)
        s
    signals, outputs : ndarray (n, 7), (n, 12)
        As `Controller.replay` takes and gives them.

    Returns
    -------
    list of FaultReport
    """
    names = list(OUTPUTS)
    masks, states = (np.asarray(outputs)[:, names.index(name)].astype(int) for name in ("faults", "state"))
    new = masks & ~np.concatenate([[0], masks[:-1]])
    signals = np.asarray(signals)
    tilt = signals[:, 4]
    found = []
    for k in np.flatnonzero(new):
        known = tilt[:k + 1][np.isfinite(tilt[:k + 1])]
        last = float(known[-1]) if known.size else 0.0
        places = signals[:k + 1, 6][np.isfinite(signals[:k + 1, 6])]
        place = float(places[-1]) if places.size else np.nan
        found += [FaultReport(float(times[k]), place, fault, State(states[k]), last) for fault in Fault if new[k] & fault]
    return found
