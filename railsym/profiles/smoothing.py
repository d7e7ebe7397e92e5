# SPDX-License-Identifier: BSD-3-Clause
"""A smooth curve through measured points: splines y(s), z(s) over the arc length s."""

from __future__ import annotations

import numpy as np

from railsym.profiles.checks import ProfileError

_STEP = 5e-5         # m between nodes, as of the formulas
_DEGREE = {True: 3, False: 5}      # interpolating: cubic, which rings least; smoothing: quintic, whose curvature is smooth
_ROUNDS = 3          # of replacing the chord length by the arc length of the curve found
_FINE = 8            # sub-steps for the arc length


def smooth_curve(name, kind, y, z, smoothing=0.0):
    """Nodes of a curve that keeps a stated root-mean-square distance from its points.

    Parameters
    ----------
    name : str
        For errors.
    kind : {"wheel", "rail"}
    y, z : ndarray, shape (m,)
        Points in order, m.
    smoothing : float
        Root-mean-square distance, m; 0 for a curve through the points.

    Returns
    -------
    dict
        ``y, z, angle, curvature, arc_length, deviation`` of `railsym.profiles.Profile`; ``deviation`` is the largest distance of a point.

    Raises
    ------
    ProfileError
        For a smoothing that is negative, not finite or above 1 mm, or that folds the curve.

    Notes
    -----
    The parameter is the length of the curve itself, strictly increasing; it starts as the chord length of the points. Each of
    y(s), z(s) is the smoothest spline (FITPACK: least jumps of its highest derivative) with sum of squares at most m smoothing^2
    for both together.
    """
    if not (np.isfinite(smoothing) and 0.0 <= smoothing <= 1e-3):
        raise ProfileError(f"profile {name!r}: smoothing is {smoothing} m; it must be from 0 to 0.001 m (measured profiles: 0.00001 to 0.00003)")
    from scipy.interpolate import splev, splprep

    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    for _ in range(_ROUNDS):
        # in mm, for FITPACK's tolerance is relative to the sum of squares
        spline, _ = splprep([1e3 * y, 1e3 * z], u=s, s=len(y) * (1e3 * smoothing) ** 2, k=_DEGREE[smoothing == 0.0])
        fine = np.linspace(0.0, s[-1], _FINE * max(len(y), int(s[-1] / _STEP)))
        dy, dz = 1e-3 * np.array(splev(fine, spline, der=1))
        length = np.concatenate([[0.0], np.cumsum(0.5 * (np.hypot(dy, dz)[1:] + np.hypot(dy, dz)[:-1]) * np.diff(fine))])
        parameter, s = s, np.interp(s, fine, length)
    fit = 1e-3 * np.array(splev(parameter, spline))
    at = np.interp(np.linspace(0.0, length[-1], int(np.ceil(length[-1] / _STEP)) + 1), length, fine)
    nodes = _nodes(name, kind, spline, at)
    return {**nodes, "deviation": float(np.hypot(fit[0] - y, fit[1] - z).max())}


def _nodes(name, kind, spline, at):
    """Nodes at the parameters ``at`` of a spline in mm."""
    from scipy.interpolate import splev

    (y, z), (dy, dz), (ddy, ddz) = (1e-3 * np.array(splev(at, spline, der=order)) for order in range(3))
    speed = np.hypot(dy, dz)
    if not (speed > 0.2).all():       # the parameter is a length, so the speed of a sound curve is about 1
        raise ProfileError(f"profile {name!r}: the curve stops near y = {1e3 * y[int(speed.argmin())]:.3f} mm; the points are too uneven there, "
                           "or the smoothing is too large")
    sign = -1.0 if kind == "wheel" else 1.0       # the wheel's body is above its curve, the rail's below
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    return {"y": y, "z": z, "angle": np.unwrap(np.arctan2(dz, dy)), "curvature": sign * (dy * ddz - dz * ddy) / speed**3, "arc_length": arc}
