# SPDX-License-Identifier: BSD-3-Clause
"""Measured geometry: curvature, cant and gradient over arc length."""

from dataclasses import dataclass, replace

import numpy as np

from railsym.errors import TrackError
from railsym.track.alignment import Alignment, check_cant, check_limits
from railsym.track.piecewise import PiecewisePolynomial, joined
from railsym.track.sections import MAX_CANT, MAX_GRADIENT, MIN_RADIUS, RAIL_SPACING, choice, number
from railsym.track.tables import checked_columns

COLUMNS = {"s": "m", "curvature": "1/m", "cant": "m", "gradient": "-"}
INTERPOLATIONS = ("cubic", "linear")
ORDER = 4      # of the Butterworth filter in one direction, as for irregularities
# what a whole line cannot stay below unless its unit is wrong by a thousand: noise of any record is more
_LEAST = {"curvature": (5e-6, "1/m", "no curve below a radius of 200 km"), "cant": (2e-4, "m", "no cant above 0.2 mm"),
          "gradient": (1e-5, "m/m", "no gradient above 0.01 per mille")}
_MOST = {"curvature": 1.0 / MIN_RADIUS, "cant": MAX_CANT, "gradient": MAX_GRADIENT}
_NEAREST, _LONGEST = 5e-3, 5e6     # m, between two points; of a line
_MOST_TURNS = 2.0                  # within a kilometre


@dataclass(frozen=True, eq=False)
class MeasuredGeometry:
    """Geometry given at points; nothing is filtered unless `smoothed` is asked for it.

    Parameters
    ----------
    s : array_like, shape (n,)
        m, increasing, n >= 4; the track begins at the first and its arc length is counted from there.
    curvature : array_like, shape (n,)
        1/m, positive to the right.
    cant : array_like, shape (n,), optional
        m, positive when the left rail is higher; 0 without it.
    gradient : array_like, shape (n,), optional
        Rise over run, positive uphill; 0 without it.
    name : str
    interpolation : {"cubic", "linear"}
        Between the points: a cubic spline (C2), for records; or straight lines, for the main points of a plan.

    Raises
    ------
    TrackError
        Columns of unlike length, s that does not increase, values that are not finite, or that only a wrong unit explains.
    """

    s: np.ndarray
    curvature: np.ndarray
    cant: np.ndarray | None = None
    gradient: np.ndarray | None = None
    name: str = "measured geometry"
    interpolation: str = "cubic"

    def __post_init__(self):
        choice(self.interpolation, INTERPOLATIONS, f"{self.name}: interpolation")
        arrays = checked_columns(self.name, self.s, self.columns())
        least = 4 if self.interpolation == "cubic" else 2
        if len(arrays["s"]) < least:
            raise TrackError(f"{self.name}: {len(arrays['s'])} points; at least {least} are needed for {self.interpolation} interpolation")
        for key, array in arrays.items():
            object.__setattr__(self, key, array)
        _check_units(self)

    def columns(self):
        """Name -> values of what was given beside s."""
        return {key: getattr(self, key) for key in ("curvature", "cant", "gradient") if getattr(self, key) is not None}

    def alignment(self, lead):
        """Alignment from -lead on, which before s = 0 goes on as it begins."""
        s = self.s - self.s[0]
        zero = np.zeros_like(s)
        cant = zero if self.cant is None else self.cant / RAIL_SPACING
        gradient = zero if self.gradient is None else self.gradient
        between = _spline if self.interpolation == "cubic" else _lines
        parts = [between(s, values, lead) for values in (self.curvature, cant, gradient / np.hypot(1.0, gradient))]
        check_limits(parts[0], 1.0, 1.0 / MIN_RADIUS, f"{self.name}: curvature", "1/m")
        check_cant(parts[1], self.name)
        check_limits(parts[2], 1.0, MAX_GRADIENT, f"{self.name}: gradient", "m/m")
        return Alignment(*parts, float(s[-1]))

    def smoothed(self, wavelength):
        """The same without the noise of short wavelengths.

        Butterworth low-pass of 4th order, forwards and backwards: amplitude 1/2 at ``wavelength``, no shift. Points that are not
        equally spaced are first interpolated at their median distance. Ends of curves are rounded over about the wavelength.

        Parameters
        ----------
        wavelength : float
            m, above two steps and below the length of the record.

        Returns
        -------
        MeasuredGeometry

        Raises
        ------
        TrackError
        """
        from scipy.interpolate import CubicSpline
        from scipy.signal import butter, sosfiltfilt

        number(wavelength, f"{self.name}: smoothing", "m", above=0.0)
        gaps = np.diff(self.s)
        step, length = float(np.median(gaps)), float(self.s[-1] - self.s[0])
        if not 2.0 * step < wavelength < length:
            raise TrackError(f"{self.name}: smoothing over {wavelength:g} m: a wavelength between two steps ({2.0 * step:.4g} m) and the record's length "
                             f"({length:.6g} m) is needed")
        s, columns = self.s, self.columns()
        if np.ptp(gaps) > 1e-3 * step:
            s = np.linspace(s[0], s[-1], int(np.ceil(length / step * (1.0 - 1e-9))) + 1)
            step = float(s[1] - s[0])
            columns = {name: CubicSpline(self.s, values)(s) for name, values in columns.items()}
        sections = butter(ORDER, 1.0 / wavelength, fs=1.0 / step, output="sos")
        pad = min(len(s) - 1, int(np.ceil(2.0 * wavelength / step)))
        return replace(self, s=s, **{name: sosfiltfilt(sections, values, padlen=pad) for name, values in columns.items()})


def _spline(s, values, lead):
    from scipy.interpolate import CubicSpline

    if not (values - values[0]).any():
        return PiecewisePolynomial.of([-lead, s[-1]], [[values[0]]])
    rows = CubicSpline(s, values, bc_type="not-a-knot").c[::-1].T * np.diff(s)[:, None] ** np.arange(4)
    return joined([PiecewisePolynomial.of([-lead, 0.0], [[values[0]]]), PiecewisePolynomial.of(s, rows)])


def _lines(s, values, lead):
    rows = np.column_stack([values[:-1], np.diff(values)])
    return joined([PiecewisePolynomial.of([-lead, 0.0], [[values[0]]]), PiecewisePolynomial.of(s, rows)])


def _check_units(geometry):
    """Refuse what only a wrong unit explains; what is too large is refused where the alignment is made."""
    s, name = geometry.s, geometry.name
    step, length = float(np.median(np.diff(s))), float(s[-1] - s[0])
    if step < _NEAREST or length > _LONGEST:
        raise TrackError(f"{name}: its points are {step:.3g} m apart and it is {length:.6g} m long; is the unit of s right?")
    for key, values in geometry.columns().items():
        least, unit, words = _LEAST[key]
        k = int(np.abs(values).argmax())
        largest = float(np.abs(values[k]))
        if largest > _MOST[key]:
            raise TrackError(f"{name}: {key} = {values[k]:g} {unit} at s = {s[k]:.6g} m is beyond {_MOST[key]:g} {unit}; are the units right?")
        if 0.0 < largest < least:
            raise TrackError(f"{name}: {key} is nowhere more than {largest:.3g} {unit}, {words}; is its unit right? (0 everywhere for a line without it)")
    turned = np.concatenate([[0.0], np.cumsum(0.5 * (geometry.curvature[1:] + geometry.curvature[:-1]) * np.diff(s))])
    ahead = np.interp(np.minimum(s + 1000.0, s[-1]), s, turned)
    turns = np.abs(ahead - turned) / (2.0 * np.pi)
    if turns.max() > _MOST_TURNS:
        raise TrackError(f"{name}: within a kilometre from s = {s[int(turns.argmax())]:.6g} m on it turns {turns.max():.3g} times round; is the unit of "
                         "curvature right?")

