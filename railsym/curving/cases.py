# SPDX-License-Identifier: BSD-3-Clause
"""What is asked of a curving study: radii, cants, and speeds or cant deficiencies, checked.

In the track plane a vehicle feels a_nc = (V^2/R) cos(c) - g sin(c), with sin(c) = cant/1.5 m; the cant deficiency is 1.5 m a_nc/g.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import SimulationError
from railsym.track.sections import MAX_CANT, MIN_RADIUS, RAIL_SPACING

LARGEST_DEFICIENCY = 0.6       # m, more is a mistake of unit
SLOWEST, FASTEST = 0.5, 170.0  # m/s


@dataclass(frozen=True, eq=False)
class Cases:
    """Curves and speeds of a study: rows are speeds or cant deficiencies, columns radii.

    Attributes
    ----------
    radius, cant : ndarray (n,)
        m, of each curve; cant of the outer rail.
    speed, cant_deficiency : ndarray (m, n)
        m/s, m.
    by : {"speed", "cant_deficiency"}
        Which of the two was given.
    gravity : float
        m/s^2
    """

    radius: np.ndarray
    cant: np.ndarray
    speed: np.ndarray
    cant_deficiency: np.ndarray
    by: str
    gravity: float

    @property
    def lateral_acceleration(self):
        """a_nc in the track plane, m/s^2, to the outside of the curve, shape (m, n)."""
        return self.cant_deficiency / RAIL_SPACING * self.gravity


def cases(radius, cant, speed, cant_deficiency, gravity):
    """The cases of a study.

    Parameters
    ----------
    radius : float or array_like (n,)
        m
    cant : float or array_like (n,)
        m, one for all curves or one a radius.
    speed, cant_deficiency : float or array_like (m,), optional
        m/s or m: one of the two.
    gravity : float
        m/s^2

    Returns
    -------
    Cases

    Raises
    ------
    SimulationError
        Neither or both, or values that no railway has; the unit is named.
    """
    radius = _column("radius", radius, "m", MIN_RADIUS, 1e6)
    cant = _column("cant", cant, "m", -MAX_CANT, MAX_CANT)
    if len(cant) not in (1, len(radius)):
        raise SimulationError(f"cant: one for all curves, or one for each of the {len(radius)} radii, not {len(cant)}")
    if len(set(radius.tolist())) < len(radius):
        raise SimulationError("radius: each radius once")
    cant = np.broadcast_to(cant, radius.shape)
    if (speed is None) == (cant_deficiency is None):
        raise SimulationError("give either speed (m/s) or cant_deficiency (m)")
    sine = cant / RAIL_SPACING
    cosine = np.sqrt(1.0 - sine ** 2)
    if speed is not None:
        speeds = np.broadcast_to(_column("speed", speed, "m/s", SLOWEST, FASTEST)[:, None], (np.size(speed), len(radius)))
        felt = speeds ** 2 / radius * cosine - gravity * sine
        return Cases(radius, cant, speeds, RAIL_SPACING * felt / gravity, "speed", gravity)
    lacking = _column("cant_deficiency", cant_deficiency, "m", -LARGEST_DEFICIENCY, LARGEST_DEFICIENCY)
    squares = radius * gravity * (lacking[:, None] / RAIL_SPACING + sine) / cosine
    slow = squares < SLOWEST ** 2
    if slow.any():
        j, k = np.argwhere(slow)[0]
        raise SimulationError(f"cant {1e3 * cant[k]:g} mm with a cant deficiency of {1e3 * lacking[j]:g} mm asks for V^2 = {squares[j, k]:.3g} m^2/s^2 "
                              f"in a curve of {radius[k]:g} m: the deficiency must be above {-1e3 * cant[k]:g} mm (standing still)")
    fast = squares > FASTEST ** 2
    if fast.any():
        j, k = np.argwhere(fast)[0]
        raise SimulationError(f"a cant deficiency of {1e3 * lacking[j]:g} mm in a curve of {radius[k]:g} m with {1e3 * cant[k]:g} mm of cant is "
                              f"{3.6 * np.sqrt(squares[j, k]):.0f} km/h; more than {3.6 * FASTEST:.0f} km/h is not computed")
    return Cases(radius, cant, np.sqrt(squares), np.broadcast_to(lacking[:, None], squares.shape), "cant_deficiency", gravity)


def _column(name, values, unit, low, high):
    try:
        array = np.array(values, dtype=float, ndmin=1)
    except (TypeError, ValueError):
        raise SimulationError(f"{name} = {values!r}: numbers in {unit} are needed") from None
    if array.ndim != 1 or not array.size:
        raise SimulationError(f"{name}: a number or a list of numbers in {unit} is needed, got shape {array.shape}")
    wrong = ~(np.isfinite(array) & (array >= low) & (array <= high))
    if wrong.any():
        raise SimulationError(f"{name} = {array[wrong][0]:g} {unit} is outside {low:g} to {high:g} {unit}; are the units right?"
                              + (" For a curve to the left say direction=\"left\"" if name == "radius" and array[wrong][0] < 0.0 else ""))
    return array
