# SPDX-License-Identifier: BSD-3-Clause
"""Track: cost of a frame, of rails and of a pose; making a line of 20 km."""

from __future__ import annotations

import numpy as np

from benchmarks.measure import Figure, median_time

_PLACES = 4096


def track_figures():
    """One core, called from Python for 4096 places in order of s, as a run asks for them."""
    from railsym.track import Gradient, MeasuredGeometry, Track, VerticalCurve

    vertical = [Gradient(200, 0.005), VerticalCurve(length=80), Gradient(460, -0.01)]
    track = Track.s_curve(500, 200, transition=60, cant=0.1, kind="cosine", vertical=vertical).with_irregularity("erri_b176_low", seed=1)
    s = np.linspace(0.0, track.length - 20.0, _PLACES)
    speed, offset = np.full(_PLACES, 40.0), np.zeros((_PLACES, 3))
    line = np.arange(0.0, 20001.0, 1.0)
    curvature = 1e-3 * np.sin(line / 200.0) ** 3

    def cost(call):
        return 1e6 * median_time(call, 101) / _PLACES

    return [
        Figure("track: a frame", cost(lambda: track.core.frames(s)), "us", 0.1, "S-curve, cosine transitions, vertical curve"),
        Figure("track: rails", cost(lambda: track.core.rails(s)), "us", 0.1, "one irregularity"),
        Figure("track: two frames and their pose", cost(lambda: track.core.poses(s, s + 20.0, speed, offset, offset)), "us"),
        Figure("track: 20 km of measured geometry, made", median_time(lambda: Track(MeasuredGeometry(line, curvature, 50.0 * curvature)), 3), "s", None, "a point a metre"),
        Figure("track: 20 km of random irregularity, made", median_time(lambda: Track.straight(20000.0).with_irregularity("erri_b176_low", seed=1), 3), "s", None,
               "wavelengths from 3 m, four signals"),
    ]
