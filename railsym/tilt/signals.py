# SPDX-License-Identifier: BSD-3-Clause
"""What a tilting controller is given at every sample."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from railsym.tilt.errors import TiltError

GRAVITY = 9.81     # m/s^2


class Signals(NamedTuple):
    """One sample. A value that is missing is not a number (nan).

    Attributes
    ----------
    roll_rate, yaw_rate : float
        rad/s, gyroscope on the leading bogie frame; + to the right side down, + to the right.
    lateral_a, lateral_b : float
        m/s^2, two accelerometers there, against free fall, + to the right: in a steady curve V^2/R - g sin(cant angle).
    tilt : float
        rad, of the body against its bogies, + right side down.
    speed : float
        m/s
    place : float
        m, of the middle of the vehicle, by odometer.
    """

    roll_rate: float
    yaw_rate: float
    lateral_a: float
    lateral_b: float
    tilt: float
    speed: float
    place: float


SIGNALS = {"roll_rate": "rad/s", "yaw_rate": "rad/s", "lateral_a": "m/s^2", "lateral_b": "m/s^2", "tilt": "rad", "speed": "m/s", "place": "m"}


def recorded(signals, times):
    """Array (n, 7) from recorded signals: such an array, or a mapping or `railsym.Run` with the names of SIGNALS.

    Raises
    ------
    TiltError
        Another shape, a signal that is not there, complex or infinite values.
    """
    if hasattr(signals, "keys") or hasattr(signals, "channels"):
        missing = [name for name in SIGNALS if name not in signals]
        if missing:
            raise TiltError(f"recorded signals lack {', '.join(missing)}; needed are {', '.join(f'{n} ({u})' for n, u in SIGNALS.items())}; a value "
                            "that was not recorded may be nan")
        signals = np.column_stack([signals[name] for name in SIGNALS])
    rows = np.ascontiguousarray(signals, dtype=float)
    if rows.ndim != 2 or rows.shape != (len(times), len(SIGNALS)):
        raise TiltError(f"recorded signals have shape {rows.shape}; ({len(times)}, {len(SIGNALS)}) is needed: a row a time, columns {', '.join(SIGNALS)}")
    if np.isinf(rows).any():
        raise TiltError("recorded signals hold infinite values; a missing value is nan")
    return rows
