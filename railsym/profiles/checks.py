# SPDX-License-Identifier: BSD-3-Clause
"""Is this list of points a profile? Every refusal names the point (and line of the file) and the reason."""

from __future__ import annotations

import numpy as np

from railsym.errors import RailsymError

_FEWEST = 20                 # points
_LONGEST_GAP = 0.005         # m between neighbouring points: a flange root (13 mm radius) would lose its shape
_LARGEST_TURN = 2.2          # rad between neighbouring chords: sharper than any edge of a profile, so the order is wrong
_WIDTH = {"wheel": (0.060, 0.200), "rail": (0.040, 0.200)}       # m, smallest and largest width of a usable profile


class ProfileError(RailsymError, ValueError):
    """A profile that does not exist, or points that make none."""


def check_points(name, kind, y, z, lines=None):
    """Points of a profile in order of y, or an error that says what is wrong.

    Parameters
    ----------
    name : str
        For the error: of the profile or its file.
    kind : {"wheel", "rail"}
    y, z : array_like, shape (m,)
        m, in the axes of `railsym.profiles.Profile`.
    lines : sequence of int, optional
        Line of the file for each point.

    Returns
    -------
    y, z : ndarray
        From the flange (gauge) side to the field side.

    Raises
    ------
    ProfileError
        For numbers that are not finite, too few points, a width that is none of a profile (metres for millimetres), repeated
        points, wrong order, gaps, left and right exchanged, upside down.
    """
    y, z = np.array(y, dtype=float), np.array(z, dtype=float)
    if kind not in _WIDTH:
        raise ProfileError(f"{name}: kind is {kind!r}; it must be wheel or rail")
    if y.ndim != 1 or y.shape != z.shape:
        raise ProfileError(f"{name}: y has shape {y.shape} and z {z.shape}; they must be one list of the same length each")
    places = [f"line {n}" for n in lines] if lines is not None else [f"point {n}" for n in range(1, len(y) + 1)]
    if len(y) and y[-1] < y[0]:
        y, z, places = y[::-1], z[::-1], places[::-1]
    _check_numbers(name, y, z, places)
    _check_width(name, kind, y, places)
    _check_order(name, y, z, places)
    _check_orientation(name, kind, y, z)
    return y, z


def _check_numbers(name, y, z, places):
    bad = ~(np.isfinite(y) & np.isfinite(z))
    if bad.any():
        k = int(bad.argmax())
        raise ProfileError(f"{name}, {places[k]}: y = {y[k]}, z = {z[k]} is not a finite number; remove the point")
    if len(y) < _FEWEST:
        raise ProfileError(f"{name}: {len(y)} points are too few for a profile; at least {_FEWEST} are needed")


def _check_width(name, kind, y, places):
    low, high = _WIDTH[kind]
    width = np.ptp(y)
    between = f"{name}, {places[0]} to {places[-1]}: the profile is {1e3 * width:.4g} mm wide"
    for factor, units in ((1e-3, "millimetres are given where metres are declared"), (1e3, "metres are given where millimetres are declared"),
                          (25.4, "inches are given where millimetres are declared")):
        if not low <= width <= high and low <= factor * width <= high:
            raise ProfileError(f"{between}; {units}, it seems: state the unit (see docs/profiles.md)")
    if not low <= width <= high:
        reason = "too short" if width < low else "too long"
        raise ProfileError(f"{between}: {reason}; a {kind} needs {1e3 * low:.0f} to {1e3 * high:.0f} mm")


def _check_order(name, y, z, places):
    dy, dz = np.diff(y), np.diff(z)
    chord = np.hypot(dy, dz)
    # 1 nm: files are written to 1e-6 mm at best
    if (chord < 1e-9).any():
        k = int((chord < 1e-9).argmax())
        raise ProfileError(f"{name}, {places[k + 1]}: repeats the point of {places[k]} (y = {1e3 * y[k]:.4f} mm, z = {1e3 * z[k]:.4f} mm)")
    direction = np.arctan2(dz, dy)
    turn = np.abs((np.diff(direction) + np.pi) % (2.0 * np.pi) - np.pi)
    if (turn > _LARGEST_TURN).any():
        k = int((turn > _LARGEST_TURN).argmax()) + 1
        raise ProfileError(f"{name}, {places[k]} to {places[k + 1]}: the points turn back (y = {1e3 * y[k]:.4f} to {1e3 * y[k + 1]:.4f} mm); "
                           "they must be sorted along the profile")
    if (chord > _LONGEST_GAP).any():
        k = int(chord.argmax())
        raise ProfileError(f"{name}, {places[k]} to {places[k + 1]}: a gap of {1e3 * chord[k]:.2f} mm (y = {1e3 * y[k]:.3f} to "
                           f"{1e3 * y[k + 1]:.3f} mm); points may be {1e3 * _LONGEST_GAP:.0f} mm apart")


def _check_orientation(name, kind, y, z):
    """The flange tip of a wheel is its lowest point and on the gauge side; the top of a rail is in its middle."""
    if kind == "rail":
        middle = np.abs(y - 0.5 * (y.min() + y.max())) < 0.25 * np.ptp(y)
        if z[middle].mean() > z[~middle].mean():
            raise ProfileError(f"{name}: the rail is upside down: z must grow downwards from its top; pass upward=True (or the other value)")
        return
    highest, lowest = int(z.argmin()), int(z.argmax())
    level = np.median(z[np.abs(y) < 0.02]) if (np.abs(y) < 0.02).any() else np.median(z)
    down, up = z[lowest] - level, level - z[highest]
    if up > max(down, 0.010):
        raise ProfileError(f"{name}: the wheel is upside down: z must grow towards the flange tip; pass upward=True (or the other value)")
    if down < 0.010:
        raise ProfileError(f"{name}: no flange: the lowest point is {1e3 * down:.1f} mm below the tread, at least 10 mm are needed "
                           "(the profile is too short, or y = 0 is not at the tape circle)")
    if y[lowest] > 0.0:
        raise ProfileError(f"{name}: left and right are exchanged: the flange is at y = {1e3 * y[lowest]:.1f} mm and belongs to negative y; "
                           "pass mirror=True")
    if y.max() < 0.010:
        raise ProfileError(f"{name}: too short: the tread ends at y = {1e3 * y.max():.1f} mm from the tape circle, at least 10 mm are needed")
