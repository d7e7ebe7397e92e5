# SPDX-License-Identifier: BSD-3-Clause
"""Measured geometry: curvature, cant and gradient over arc length."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.track.alignment import Alignment, check_cant, check_limits
from railsym.track.piecewise import PiecewisePolynomial, joined
from railsym.track.sections import MAX_GRADIENT, MIN_RADIUS, RAIL_SPACING
from railsym.track.tables import checked_columns, read_table

COLUMNS = {"s": "m", "curvature": "1/m", "cant": "m", "gradient": "-"}


@dataclass(frozen=True, eq=False)
class MeasuredGeometry:
    """Geometry given at points; between them it is a cubic spline (C2), nothing is filtered.

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
    """

    s: np.ndarray
    curvature: np.ndarray
    cant: np.ndarray | None = None
    gradient: np.ndarray | None = None
    name: str = "measured geometry"

    def __post_init__(self):
        given = {key: getattr(self, key) for key in ("curvature", "cant", "gradient") if getattr(self, key) is not None}
        arrays = checked_columns(self.name, self.s, given)
        if len(arrays["s"]) < 4:
            raise TrackError(f"{self.name}: {len(arrays['s'])} points; at least 4 are needed for a cubic spline")
        for key, array in arrays.items():
            object.__setattr__(self, key, array)

    def alignment(self, lead):
        """Alignment from -lead on, which before s = 0 goes on as it begins."""
        s = self.s - self.s[0]
        zero = np.zeros_like(s)
        cant = zero if self.cant is None else self.cant / RAIL_SPACING
        gradient = zero if self.gradient is None else self.gradient
        parts = [_spline(s, values, lead) for values in (self.curvature, cant, gradient / np.hypot(1.0, gradient))]
        check_limits(parts[0], 1.0, 1.0 / MIN_RADIUS, "curvature", "1/m")
        check_cant(parts[1])
        check_limits(parts[2], 1.0, MAX_GRADIENT, "gradient", "m/m")
        return Alignment(*parts, float(s[-1]))


def _spline(s, values, lead):
    from scipy.interpolate import CubicSpline

    if not (values - values[0]).any():
        return PiecewisePolynomial.of([-lead, s[-1]], [[values[0]]])
    rows = CubicSpline(s, values, bc_type="not-a-knot").c[::-1].T * np.diff(s)[:, None] ** np.arange(4)
    return joined([PiecewisePolynomial.of([-lead, 0.0], [[values[0]]]), PiecewisePolynomial.of(s, rows)])


def read_geometry(path):
    """Measured geometry from a CSV file.

    Parameters
    ----------
    path : path
        Heading with units, such as ``s [m], curvature [1/km], cant [mm], gradient [mm/m]``; s and curvature are needed.

    Returns
    -------
    MeasuredGeometry

    Raises
    ------
    TrackError
        A file, column, unit or number that cannot be used.
    """
    return MeasuredGeometry(**read_table(path, COLUMNS, ("s", "curvature")), name=Path(path).stem)
