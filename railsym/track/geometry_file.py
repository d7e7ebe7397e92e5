# SPDX-License-Identifier: BSD-3-Clause
"""Measured geometry from a CSV file: curvature, radius or versine, cant as a height or an angle, gradient; signs and units declared."""

from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.track.measured import MeasuredGeometry
from railsym.track.sections import RAIL_SPACING, choice, number
from railsym.track.tables import read_table

COLUMNS = {"s": "m", "curvature": "1/m", "radius": "m", "versine": "m", "cant": ("m", "rad"), "gradient": ("-", "rad")}
CURVES = ("curvature", "radius", "versine")
OPTIONS = ("smoothing", "interpolation", "chord", "curve_positive", "cant_positive", "largest_gap")
_GAP = 10.0                 # of the median distance of points
# 1/m, m, m: cant beyond the second, farther than the third from a curve of the first, has no outer rail
_STRAIGHT, _LEVEL, _NEAR = 5e-5, 0.02, 150.0
_SIGN = 'give cant a sign, and cant_positive = "left" or "right"'


def read_geometry(path, *, smoothing=None, interpolation="cubic", chord=None, curve_positive="right", cant_positive="left", largest_gap=None):
    """Measured geometry from a CSV file.

    Parameters
    ----------
    path : path
        Heading with units, such as ``s [m], curvature [1/km], cant [mm], gradient [mm/m]``. Needed are s and one of curvature, radius
        (0 is straight) and versine (with ``chord``); cant may be an angle (``cant [rad]``, ``cant [deg]``), gradient likewise.
    smoothing : float, optional
        m: wavelengths below are filtered out, see `MeasuredGeometry.smoothed`.
    interpolation : {"cubic", "linear"}
        As `MeasuredGeometry`; linear for main points of a plan, between which there may be gaps.
    chord : float, optional
        m, of the versines: curvature is 8 f/(c^2 + 4 f^2), which is the mean over the chord with a triangle's weight.
    curve_positive : {"right", "left"}
        Which curves have positive curvature, radius and versine in the file.
    cant_positive : {"left", "right", "outer"}
        Which rail is higher where cant is positive; outer: of the curve, as where cant has no sign.
    largest_gap : float, optional
        m between two points; ten times their median distance without it. With linear interpolation only if given.

    Returns
    -------
    MeasuredGeometry

    Raises
    ------
    TrackError
        A file, column, unit or number that cannot be used, a gap.
    """
    name = Path(path).name
    choice(curve_positive, ("right", "left"), f"{name}: curve_positive")
    choice(cant_positive, ("left", "right", "outer"), f"{name}: cant_positive")
    given = read_table(path, COLUMNS, ("s",))
    _check_gaps(name, given["s"], largest_gap, interpolation)
    curvature = (1.0 if curve_positive == "right" else -1.0) * _curvature(name, given, chord)
    cant, gradient = given.get("cant"), given.get("gradient")
    if "cant rad" in given:
        cant = RAIL_SPACING * np.sin(given["cant rad"])
    if "gradient rad" in given:
        gradient = np.tan(given["gradient rad"])
    if cant is not None:
        cant = cant * _cant_sign(name, given["s"], curvature, cant, cant_positive)
    found = MeasuredGeometry(given["s"], curvature, cant, gradient, Path(path).stem, interpolation)
    return found if smoothing is None else found.smoothed(smoothing)


def _curvature(name, given, chord):
    kinds = [kind for kind in CURVES if kind in given]
    if len(kinds) != 1:
        raise TrackError(f"{name}: one column of {', '.join(CURVES)} is needed, there {'is none' if not kinds else 'are ' + ' and '.join(kinds)}")
    if (chord is not None) != (kinds[0] == "versine"):
        raise TrackError(f"{name}: versines need the length of their chord: chord=20.0 (m)" if chord is None else
                         f"{name}: chord = {chord} m belongs to versines, the file has {kinds[0]}")
    values = given[kinds[0]]
    if kinds[0] == "curvature":
        return values
    if kinds[0] == "radius":
        return np.divide(1.0, values, out=np.zeros_like(values), where=values != 0.0)
    chord = number(chord, f"{name}: chord", "m", 1.0, 100.0)
    wrong = np.abs(values) > 0.25 * chord
    if wrong.any():
        raise TrackError(f"{name}: versine = {values[wrong][0]:g} m at s = {given['s'][wrong][0]:.6g} m on a chord of {chord:g} m; are the units right?")
    return 8.0 * values / (chord ** 2 + 4.0 * values ** 2)


def _cant_sign(name, s, curvature, cant, positive):
    if positive != "outer":
        return 1.0 if positive == "left" else -1.0
    curved = np.flatnonzero(np.abs(curvature) >= _STRAIGHT)
    if not len(curved):
        if np.abs(cant).max() > _LEVEL:
            raise TrackError(f"{name}: cant of {1e3 * np.abs(cant).max():.4g} mm on a line without curves, which has no outer rail: {_SIGN}")
        return np.zeros_like(curvature)
    middle = 0.5 * (s[curved][1:] + s[curved][:-1])
    nearest = curved[np.searchsorted(middle, s)]
    lost = (np.abs(s - s[nearest]) > _NEAR) & (np.abs(cant) > _LEVEL)
    if lost.any():
        k = int(np.argmax(lost))
        raise TrackError(f"{name}: cant {1e3 * cant[k]:.4g} mm at s = {s[k]:.6g} m, {abs(s[k] - s[nearest[k]]):.4g} m from the nearest curve, where the "
                         f"line has no outer rail: {_SIGN}")
    return np.sign(np.where(np.abs(curvature) >= 0.1 * _STRAIGHT, curvature, curvature[nearest]))


def _check_gaps(name, s, largest, interpolation):
    gaps = np.diff(s)
    if len(gaps) < 2 or (gaps <= 0.0).any() or (largest is None and interpolation == "linear"):
        return      # an order that is wrong is told with the places
    allowed = _GAP * float(np.median(gaps)) if largest is None else number(largest, f"{name}: largest_gap", "m", above=0.0)
    k = int(gaps.argmax())
    if gaps[k] > allowed:
        raise TrackError(f"{name}: a gap of {gaps[k]:.6g} m between s = {s[k]:.6g} and {s[k + 1]:.6g} m, where points are {np.median(gaps):.4g} m "
                         f"apart: fill it, or allow it (largest_gap={np.ceil(gaps[k]):g}); main points of a plan need interpolation=\"linear\"")
