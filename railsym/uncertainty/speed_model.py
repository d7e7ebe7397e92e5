# SPDX-License-Identifier: BSD-3-Clause
"""The critical speed of a vehicle as a function of chosen parameters, with its analytic gradient."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from railsym.errors import ModelError
from railsym.uncertainty.errors import UncertaintyError

CONICITY = "conicity"


class SpeedModel:
    """Critical speed and gradient: ``value, gradient = model(x)``.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    names : sequence of str
        Dotted names of single numbers; "conicity" (or "contact.conicity") is the contact's.
    options
        conicity, criterion, damping_ratio, speed_range, contact, frequency_band of `railsym.critical_speed`; one conicity.

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

    def __init__(self, vehicle, names, **options):
        from railsym.critical_cases import CriticalSpeedSolver

        self.solver = CriticalSpeedSolver(vehicle, **options)
        self.names = tuple(names)
        self._given = {f.name for f in fields(self.contact) if getattr(self.contact, f.name) is not None}
        self.units = tuple(self._unit(name) for name in self.names)

    @classmethod
    def of(cls, study, names=None, analysis=None):
        """That of a study of critical speeds.

        Parameters
        ----------
        study : railsym.sweep.Study
        names : sequence of str, optional
            The study's factors when not given.
        analysis : railsym.sweep.CriticalSpeed, optional
            In place of the study's.

        Raises
        ------
        UncertaintyError
            A study of something else, or with a factor that is no number.
        """
        from railsym.sweep.critical_speed import CriticalSpeed
        from railsym.sweep.linear_contact import contact_of

        analysis = analysis or study.analysis
        if not isinstance(analysis, CriticalSpeed):
            raise UncertaintyError(f"gradients are there for critical speeds; the analysis is {analysis.kind!r}")
        texts = [name for k, name in enumerate(study.names) if study.space.labels(k)]
        if names is None and texts:
            raise UncertaintyError(f"factor {texts[0]!r} is a list of texts: there is no gradient by it")
        return cls(study.base(), study.names if names is None else names, contact=contact_of(analysis.conicity, study.settings),
                   criterion=analysis.criterion, damping_ratio=analysis.damping_ratio, speed_range=analysis.speed_range,
                   frequency_band=analysis.frequency_band)

    @property
    def vehicle(self):
        """Before the changes."""
        return self.solver.vehicle

    @property
    def contact(self):
        """Before the changes."""
        return self.solver.contact

    @property
    def speed_range(self):
        """m/s."""
        return self.solver.speed_range

    def _field(self, name):
        """Field of the contact that a parameter is; None where the vehicle has it."""
        head, _, key = name.rpartition(".")
        return key if (head == "contact" and key in self._given) or name == CONICITY else None

    def _unit(self, name):
        if self._field(name) == CONICITY:
            return "-"
        if name not in self.vehicle.parameters:
            self.vehicle.replace({name: 0.0})      # raises, and names the nearest parameters
        return self.vehicle.parameters[name].unit

    def present(self) -> np.ndarray:
        """The parameters as the vehicle and the contact have them, shape (k,)."""
        return np.array([getattr(self.contact, self._field(name)) if self._field(name) else float(self.vehicle.parameters[name].value)
                         for name in self.names])

    def _split(self, x):
        """Changes of the vehicle and of the contact at x."""
        values = dict(zip(self.names, map(float, x), strict=True))
        contact = {self._field(name): value for name, value in values.items() if self._field(name)}
        return {name: value for name, value in values.items() if not self._field(name)}, contact

    def _solver(self, contact):
        """The solver, and the conicity of a case; other numbers of the contact need a solver of their own."""
        conicity = contact.get(CONICITY)
        others = {name: value for name, value in contact.items() if name != CONICITY}
        if not others:
            return self.solver, conicity
        from copy import copy

        solver = copy(self.solver)
        solver.contact = replace(solver.contact, **others)
        return solver, conicity

    def stability(self, x):
        """`railsym.stability.Stability` at x."""
        changes, contact = self._split(x)
        solver, conicity = self._solver(contact)
        return solver.solve(changes, conicity)

    def _model(self, x):
        changes, contact = self._split(x)
        solver, conicity = self._solver(contact)
        return solver.model(changes, conicity)

    def _found(self, x):
        found = self.stability(x)
        if found.speed is None:
            raise ModelError(f"no critical speed at {dict(zip(self.names, map(float, x)))}: {found.message}")
        return found

    def value(self, x) -> float:
        """Critical speed alone, m/s.

        Raises
        ------
        ModelError
            No critical speed within the range.
        """
        return self._found(x).speed

    def __call__(self, x):
        """Critical speed (m/s) and its gradient, shape (k,), per SI unit.

        Raises
        ------
        ModelError
            No critical speed within the range.
        UncertaintyError
            A parameter that cannot change by itself, such as one of two inertias that must stay equal.
        """
        found = self._found(x)
        return found.speed, self.slopes(found, x)[0]

    def slopes(self, found, x):
        """Gradients (k,) of the speed (m/s) and of the frequency (Hz) where `stability` found one.

        Raises
        ------
        UncertaintyError
        """
        from railsym.sensitivity import Parameter, sensitivities

        x = np.array(x, float)
        point = next(c for c in found.crossings if c.speed == found.speed)
        given = sensitivities(point, [Parameter(name, x[k], self.units[k], self._along(x, k)) for k, name in enumerate(self.names)])
        if given.skipped:
            name, reason = next(iter(given.skipped.items()))
            raise UncertaintyError(f"no derivative by {name!r}: {reason}")
        place = [given.names.index(name) for name in self.names]
        return given.speed_derivative[place], given.frequency_derivative[place]

    def _along(self, x, k):
        """Value of parameter k to the linear model, the others as at x."""
        def change(value):
            point = x.copy()
            point[k] = value
            return self._model(point)
        return change
