# SPDX-License-Identifier: BSD-3-Clause
"""Signals of an ideal vehicle on a track, for controllers on recorded signals."""

import numpy as np

from railsym.tilt import Controller, OUTPUTS, Signals

OUT = {name: k for k, name in enumerate(OUTPUTS)}


def on_track(track, speed, rate=100.0, ahead=9.5, noise=0.0, seed=1):
    """Times (n,) and signals (n, 7): gyroscope and accelerometers ride the track frame, the tilt stays zero."""
    times = np.arange(round((track.length - 40.0) / speed * rate)) / rate
    place = speed * times
    at = place + ahead
    curvature, cant = track.curvature(at), np.arcsin(track.alignment.cant(at))
    scatter = noise * np.random.default_rng(seed).standard_normal((4, len(times)))
    deficiency = speed ** 2 * curvature - 9.81 * np.sin(cant)
    rows = [np.gradient(cant, times) + 0.01 * scatter[0], speed * curvature + 0.01 * scatter[1], deficiency + scatter[2], deficiency + scatter[3],
            0.0 * times, speed + 0.0 * times, place]
    return times, np.column_stack(rows)


def followed(parameters, times, signals, database=None, plant=None):
    """Outputs (n, 12) of a controller whose tilt follows by ``plant`` (command -> tilt), the reference model where there is none."""
    control, found, tilt = Controller(parameters, database), [], 0.0
    for time, row in zip(times, signals):
        row = [*row[:4], tilt, *row[5:]]
        control.step(time, Signals(*row))
        found.append(control.outputs)
        tilt = control.servo.expected if plant is None else plant(control.outputs[0])
    return np.array(found)
