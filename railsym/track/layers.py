# SPDX-License-Identifier: BSD-3-Clause
"""Rail deviations on a uniform grid, as cubic B-splines, and the four signals of track geometry.

Signals and rails (y to the right, z down):

    alignment   a  both rails to the right           left y = a - g/2    right y = a + g/2
    vertical    v  both rails down                   left z = v - c/2    right z = v + c/2
    cant        c  the left rail higher by c
    gauge       g  the rails further apart by g
"""

import numpy as np

from railsym._core_track import RailLayer
from railsym.errors import TrackError

SIGNALS = ("alignment", "vertical", "cant", "gauge")
RAILS = ("left_y", "left_z", "right_y", "right_z")
REST = 8      # nodes at rest at an end: what a spline carries beyond a node falls to 0.27 from one to the next
_SIGNAL_TO_RAIL = np.array([[1.0, 0.0, 0.0, -0.5], [0.0, 1.0, -0.5, 0.0], [1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.5, 0.0]])


def rails_of(signals):
    """Rails (n, 4) of signals (n, 4), both in the order of their names, m."""
    return signals @ _SIGNAL_TO_RAIL.T


def signals_of(rails):
    """Signals (n, 4) of rails (n, 4), m."""
    return rails @ np.linalg.inv(_SIGNAL_TO_RAIL).T


def spline_layer(start, step, rails, after=(0.0,) * 4, interpolate=True):
    """Layer through (or, for shapes with corners, near) values at nodes.

    Parameters
    ----------
    start, step : float
        m
    rails : ndarray, shape (n, 4)
        m, at the nodes; n >= 2.
    after : array_like, shape (4,)
        m, behind the last node.
    interpolate : bool
        False takes the values as coefficients: corners are rounded over two steps and nothing overshoots; where the value is
        smooth the spline is off by step^2/6 of its second derivative.

    Returns
    -------
    RailLayer
    """
    coefficients = np.empty((len(rails) + 2, 4))
    for k in range(4):      # one after the other: lines are long
        coefficients[1:-1, k] = _interpolating(rails[:, k]) if interpolate else rails[:, k]
    # natural ends: no curvature before the first and behind the last node
    coefficients[0], coefficients[-1] = 2.0 * coefficients[1] - coefficients[2], 2.0 * coefficients[-2] - coefficients[-3]
    return RailLayer(float(start), float(step), coefficients, np.array(after, dtype=float))


def _interpolating(values):
    """Coefficients (n,) with (c[k-1] + 4 c[k] + c[k+1])/6 = values[k] and natural ends, where c = values."""
    from scipy.linalg import solve_banded

    count = len(values)
    if count < 3:
        return values
    bands = np.ones((3, count - 2))
    bands[1] = 4.0
    right = 6.0 * values[1:-1]
    right[0] -= values[0]
    right[-1] -= values[-1]
    return np.concatenate([values[:1], solve_banded((1, 1), bands, right), values[-1:]])


def smooth_step(x):
    """0 for x <= 0, 1 for x >= 1, between them 10 x^3 - 15 x^4 + 6 x^5: two continuous derivatives."""
    x = np.clip(x, 0.0, 1.0)
    return x**3 * (10.0 + x * (6.0 * x - 15.0))


def window(s, start, end, fade_in, fade_out):
    """Factor that fades in behind ``start`` and out before ``end`` over the given lengths (m; 0: at once)."""
    rise = smooth_step((s - start) / fade_in) if fade_in else 1.0
    fall = smooth_step((end - s) / fade_out) if fade_out else 1.0
    return rise * fall


def placed(what, start, length, track_length):
    """Start and end (m) on a track of something; without a length it goes to the track's end.

    Raises
    ------
    TrackError
        If it does not lie on the track.
    """
    end = track_length if length is None else start + length
    if start < 0.0 or not end > start or end > track_length * (1.0 + 1e-12):
        raise TrackError(f"{what} from s = {start:.6g} m to {end:.6g} m does not lie on the track, which runs from 0 to {track_length:.6g} m")
    return float(start), float(min(end, track_length))
