# SPDX-License-Identifier: BSD-3-Clause
"""The critical speed of a vehicle as a function of chosen parameters, with its analytic gradient."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from railsym.errors import ModelError
from railsym.uncertainty.errors import UncertaintyError


class SpeedModel:
    """Critical speed and gradient: ``value, gradient = model(x)``.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    names : sequence of str
        Dotted names of single numbers; "conicity" and "contact.friction" are the contact's.
    conicity, criterion, damping_ratio, speed_range, contact, frequency_band
        As `railsym.critical_speed`, one conicity.

    Attributes
    ----------
    names, units : tuple of str
    output, unit : str
        "critical speed", "m/s".

    Raises
    ------
    VehicleFileError, ModelError
        Unknown parameters or criteria.

    Examples
    --------
    >>> import railsym as rs
    >>> model = SpeedModel(rs.load_vehicle("bogie"), ["conicity"])
    >>> speed, gradient = model([0.2])
    >>> bool(speed > 0.0 and gradient[0] < 0.0)
    True
    """

    output, unit = "critical speed", "m/s"

    def __init__(self, vehicle, names, conicity=None, criterion=None, damping_ratio=None, speed_range=None, contact=None, frequency_band=None):
        from railsym.critical_speed import SPEED_RANGE, contact_or_default, damping_ratio_of
        from railsym.stability import FREQUENCY_BAND

        contact = contact_or_default(contact)
        self.vehicle = vehicle
        self.contact = contact if conicity is None else replace(contact, conicity=float(conicity))
        self.names = tuple(names)
        self.ratio = damping_ratio_of(criterion, damping_ratio)
        self.speed_range = SPEED_RANGE if speed_range is None else speed_range
        self.band = FREQUENCY_BAND if frequency_band is None else frequency_band
        self._fields = {"conicity"} | {f.name for f in fields(self.contact) if getattr(self.contact, f.name) is not None}
        self.units = tuple(self._unit(name) for name in self.names)

    def _field(self, name):
        """Field of the contact that a parameter is; None where the vehicle has it."""
        if name == "conicity":
            return name
        head, _, key = name.partition(".")
        return key if head == "contact" and key in self._fields else None

    def _unit(self, name):
        if name == "conicity":
            return "-"
        if name not in self.vehicle.parameters:
            self.vehicle.replace({name: 0.0})      # raises, and names the nearest parameters
        return self.vehicle.parameters[name].unit

    def present(self) -> np.ndarray:
        """The parameters as the vehicle and the contact have them, shape (k,)."""
        return np.array([getattr(self.contact, self._field(name)) if self._field(name) else float(self.vehicle.parameters[name].value)
                         for name in self.names])

    def _changed(self, x):
        """Vehicle and contact at x."""
        values = {name: float(value) for name, value in zip(self.names, x, strict=True)}
        contact = replace(self.contact, **{self._field(name): value for name, value in values.items() if self._field(name)})
        changes = {name: value for name, value in values.items() if not self._field(name)}
        return self.vehicle.replace(changes) if changes else self.vehicle, contact

    def stability(self, x):
        """`railsym.stability.Stability` at x, with the vehicle and the contact there."""
        from railsym.linear import linear_model
        from railsym.stability import stability

        vehicle, contact = self._changed(x)
        found, = stability(linear_model(vehicle, contact), (self.ratio,), self.speed_range, self.band)
        return found, vehicle, contact

    def _found(self, x):
        found, vehicle, contact = self.stability(x)
        if found.speed is None:
            raise ModelError(f"no critical speed at {dict(zip(self.names, map(float, x)))}: {found.message}")
        return found, vehicle, contact

    def value(self, x) -> float:
        """Critical speed alone, m/s.

        Raises
        ------
        ModelError
            No critical speed within the range.
        """
        return self._found(x)[0].speed

    def __call__(self, x):
        """Critical speed (m/s) and its gradient, shape (k,), per SI unit.

        Raises
        ------
        ModelError
            No critical speed within the range.
        UncertaintyError
            A parameter that cannot change by itself, such as one of two inertias that must stay equal.
        """
        found, vehicle, contact = self._found(x)
        return found.speed, self.slopes(found, vehicle, contact, x)[0]

    def slopes(self, found, vehicle, contact, x):
        """Gradients (k,) of the speed (m/s) and of the frequency (Hz) where `stability` found one.

        Raises
        ------
        UncertaintyError
        """
        from railsym.sensitivity import sensitivities

        point = next(c for c in found.crossings if c.speed == found.speed)
        given = sensitivities(point, [self._parameter(vehicle, contact, name, float(value)) for name, value in zip(self.names, x)])
        if given.skipped:
            name, reason = next(iter(given.skipped.items()))
            raise UncertaintyError(f"no derivative by {name!r}: {reason}")
        place = [given.names.index(name) for name in self.names]
        return given.speed_derivative[place], given.frequency_derivative[place]

    def _parameter(self, vehicle, contact, name, value):
        from railsym.linear import linear_model
        from railsym.sensitivity import Parameter

        field = self._field(name)
        if field:
            return Parameter(name, value, "-", lambda new: linear_model(vehicle, replace(contact, **{field: new})))
        return Parameter(name, value, self.vehicle.parameters[name].unit, lambda new: linear_model(vehicle.replace({name: new}), contact))
