# SPDX-License-Identifier: BSD-3-Clause
"""What a step of 1 ms leaves wrong on irregular track, against one of 0.05 ms."""

import numpy as np

import railsym as rs
from benchmarks.measure import Figure
from benchmarks.transient_peers import SPEED, setting

REFERENCE, DURATION = 5e-5, 6.0  # s
RATE = 1000.0  # Hz, samples at the ends of steps of 1 ms
CHANNELS = {"wheelset1.y": "m", "bogie1.above_wheelset1_left.ay": "m/s2", "car.ay": "m/s2", "wheelset1.left.Y": "N", "wheelset1.left.Q": "N"}
SLOW = 20.0  # Hz, what EN 14363 filters Y and Q with


def _course(dt, **options):
    table, track = setting()
    run = rs.simulate(rs.load_vehicle("pendolino"), speed=SPEED, duration=DURATION, track=track, contact=table, law="fastsim", dt=dt,
                      channels=list(CHANNELS), rate=RATE, **options)
    return np.array([run[name] for name in CHANNELS])


def _rms(values):
    return np.sqrt(np.mean(values**2, axis=1))


def _slow(values):
    """Values below `SLOW` (Hz)."""
    from scipy.signal import butter, sosfiltfilt

    return sosfiltfilt(butter(4, SLOW, fs=RATE, output="sos"), values)


def accuracy_figures():
    """R.m.s. over 6 s: the signal less its mean, and the error at 1, 0.5 and 0.25 ms; what the iteration adds of it at 1 ms."""
    exact = _course(REFERENCE, tolerance=1e-4)
    found = {dt: _course(dt) for dt in (1e-3, 5e-4, 2.5e-4)}
    tight = _course(1e-3, tolerance=1e-6)
    signal = _rms(exact - exact.mean(axis=1, keepdims=True))
    errors, iteration = {dt: _rms(values - exact) for dt, values in found.items()}, _rms(found[1e-3] - tight)
    for k, (name, unit) in enumerate(CHANNELS.items()):
        finer = ", ".join(f"{errors[dt][k]:.2g} at {1e3 * dt:g} ms" for dt in (5e-4, 2.5e-4))
        yield Figure(f"error at 1 ms: {name}", errors[1e-3][k], unit, None, f"r.m.s.; signal {signal[k]:.3g}; {finer}; iteration {iteration[k]:.2g}")
    slow = _rms(_slow((found[1e-3] - exact)[3:]))
    for name, error in zip(list(CHANNELS)[3:], slow, strict=True):
        yield Figure(f"error at 1 ms below {SLOW:g} Hz: {name}", error, "N", None, "r.m.s.")
