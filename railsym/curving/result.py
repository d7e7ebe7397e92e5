# SPDX-License-Identifier: BSD-3-Clause
"""The result of a curving study."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.curving.cases import Cases
from railsym.curving.quantities import KINDS, wheel_names
from railsym.errors import SimulationError


@dataclass(frozen=True)
class Failure:
    """A curve without result.

    Attributes
    ----------
    row, column : int
        Of the speed or cant deficiency, of the radius.
    radius, speed : float
        m, m/s
    analysis : {"quasi-static", "dynamic"}
    reason : str
    """

    row: int
    column: int
    radius: float
    speed: float
    analysis: str
    reason: str

    def __str__(self):
        return f"{self.analysis}, R = {self.radius:g} m at {3.6 * self.speed:.4g} km/h: {self.reason}"


@dataclass(frozen=True, eq=False)
class Curving:
    """A vehicle in curves. Rows are speeds or cant deficiencies (m), columns radii (n); NaN where there is a failure.

    Y, Q, YQ, t_gamma, dissipation have the shape (m, n, wheels); sum_Y, angle_of_attack, y (m, n, wheelsets);
    patch_t_gamma, patch_load, patch_angle (m, n, wheels, zones of the profile): of the equilibria.

    Attributes
    ----------
    vehicle, configuration, direction, law, contact : str
    cases : Cases
        radius, cant (n,), speed, cant_deficiency (m, n).
    wheelsets : tuple of str
    values : dict of str to ndarray
        The arrays above by name; `units` says in what.
    largest : dict of str to ndarray, or None
        Of runs with irregularities: ``"YQ"`` and ``"sum_Y"`` (2 m mean, 20 Hz), ``"Q"`` (20 Hz), each with its percentiles; ``"Y"``, ``"t_gamma"``,
        ``"angle_of_attack"`` (means over the curve).
    failures : tuple of Failure
    static_load : ndarray (wheels,)
        N
    """

    vehicle: str
    configuration: str
    direction: str
    cases: Cases
    wheelsets: tuple
    values: dict = field(repr=False)
    largest: dict | None = field(repr=False)
    failures: tuple
    static_load: np.ndarray = field(repr=False)
    law: str = ""
    contact: str = ""

    def __getattr__(self, name):
        if name in KINDS:
            return self.values[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}; its arrays are {', '.join(KINDS)}")

    radius = property(lambda self: self.cases.radius, doc="m, (n,)")
    cant = property(lambda self: self.cases.cant, doc="m, (n,)")
    speed = property(lambda self: self.cases.speed, doc="m/s, (m, n)")
    cant_deficiency = property(lambda self: self.cases.cant_deficiency, doc="m, (m, n)")
    lateral_acceleration = property(lambda self: self.cases.lateral_acceleration, doc="m/s^2 in the track plane, to the outside, (m, n)")

    @property
    def wheels(self):
        """Names of the wheels, left before right."""
        return wheel_names(self.wheelsets)

    @property
    def units(self):
        """Unit by array."""
        return {name: kind.unit for name, kind in KINDS.items()}

    @property
    def outer(self):
        """Numbers of the outer wheels, one a wheelset."""
        return np.arange(len(self.wheelsets)) * 2 + (0 if self.direction == "right" else 1)

    def of(self, name, item):
        """One wheel's or wheelset's values.

        Parameters
        ----------
        name : str
            Such as ``"Y"``.
        item : str
            Such as ``"wheelset1.left"``.

        Returns
        -------
        ndarray (m, n)

        Raises
        ------
        SimulationError
            An unknown name.
        """
        from railsym.vehicle_checks import unknown

        if name not in KINDS:
            raise SimulationError(f"quantity {name!r} is {unknown(name, KINDS, 'quantities')}")
        items = self.wheelsets if KINDS[name].of == "wheelset" else self.wheels
        if item not in items:
            raise SimulationError(f"{KINDS[name].of} {item!r} is {unknown(item, items, 'names')}")
        return self.values[name][:, :, items.index(item)]

    def assessed(self):
        """The largest of each quantity over all curves against its limit.

        Returns
        -------
        tuple of (railsym.criteria.Assessed, str)
            Value and limit, and where it is.
        """
        from railsym.curving.assessment import assessed

        return assessed(self)

    def table(self, row=None):
        """A line a curve: leading outer wheel, largest Y/Q and sum of Y, angle of attack, wear number.

        Parameters
        ----------
        row : int, optional
            Of the speed or cant deficiency; all without it.
        """
        from railsym.curving.table import table

        return table(self, row)

    @property
    def message(self):
        """What was found, in lines."""
        from railsym.curving.table import message

        return message(self)

    def __str__(self):
        return self.message

    def to_dict(self):
        """Everything as plain data, SI units; None where there is no number."""
        from railsym.curving.table import as_data

        return as_data(self)

    def plot(self, *, axes=None, path=None):
        """Y, Q, Y/Q, sum of Y, angle of attack and wear number over radius; returns the axes (3, 2).

        Parameters
        ----------
        axes : array of six matplotlib Axes, optional
        path : path, optional
            Saved there and closed.
        """
        from railsym.plots.curving import plot_curving

        drawn = plot_curving(self, axes=axes)
        if path is not None:
            from railsym.plots.style import save

            save(drawn, path)
        return drawn
