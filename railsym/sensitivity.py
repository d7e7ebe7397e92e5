# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivity of a critical speed to every parameter of a vehicle, from the vectors of the critical mode.

On the criterion Re(lambda) + zeta |lambda| = 0, with w = 1 + zeta conj(lambda) / |lambda|,

    dV/dp = -Re(w dlambda/dp) / Re(w dlambda/dV),     dlambda/dp = -y^H (dT/dp) x / (y^H (dT/dlambda) x)

and the frequency follows the mode along: d(omega)/dp = Im(dlambda/dp + dlambda/dV dV/dp). One eigenproblem serves all parameters
(Seyranian and Mailybaev 2003, Multiparameter Stability Theory, ch. 2). dT/dp is the central difference of assembled matrices: exact
but for rounding where they are polynomials of degree two or less in p (masses, inertias, stiffnesses, dampings, positions), and
with a relative error of the order of the step squared, 1e-8, elsewhere (friction, radii, Poisson's ratio).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from railsym.critical_speed import SPEED_RANGE, contact_or_default, damping_ratio_of, linear_models
from railsym.errors import ModelError, RailsymError
from railsym.linear_model import LinearModel
from railsym.progress import followed
from railsym.stability import FREQUENCY_BAND, CriticalCrossing, stability

_RELATIVE_STEP = 1e-4      # truncation 1e-8 where T is not a polynomial; rounding of K (1e9 N/m) still below 1e-9 of it
# steps for parameters that are zero: small beside anything that matters in a vehicle
_ZERO_STEP = {"m": 1e-3, "rad": 1e-3, "kg": 1e-2, "kg*m^2": 1e-2, "N/m": 1e2, "N*m/rad": 1e2, "N*s/m": 1e1, "N*m*s/rad": 1e1}
_PLACE = re.compile(r"[._](position|lateral_position|centre_offset)\.?\d*$")
CONICITY = "conicity"


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Derivatives of a critical speed and its frequency, the strongest influence first.

    Attributes
    ----------
    names, units : tuple of str
        Dotted names of the parameters; "a + b" where two numbers can only change together.
    values : ndarray, shape (p,)
        SI.
    scale : ndarray, shape (p,)
        What a change is measured against: |p|, but 1 m for coordinates of places, whose origin means nothing.
    speed_derivative, frequency_derivative : ndarray, shape (p,)
        dV/dp in m/s and df/dp in Hz, per SI unit of the parameter.
    speed_elasticity, frequency_elasticity : ndarray, shape (p,)
        (scale/V) dV/dp and (scale/f) df/dp: per cent of change per per cent of the scale (1 cm for a place).
    skipped : dict of str to str
        Parameters left out, and why.
    crossing : CriticalCrossing
        The critical point.
    message : str
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray
    scale: np.ndarray
    speed_derivative: np.ndarray
    frequency_derivative: np.ndarray
    speed_elasticity: np.ndarray
    frequency_elasticity: np.ndarray
    skipped: dict[str, str]
    crossing: CriticalCrossing
    message: str

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str) -> int:
        """Place of a parameter in the arrays.

        Raises
        ------
        ModelError
            A parameter that is not in the table, with the reason or the nearest names.
        """
        if name in self.names:
            return self.names.index(name)
        if name in self.skipped:
            raise ModelError(f"parameter {name!r} was left out: {self.skipped[name]}")
        from difflib import get_close_matches
        near = get_close_matches(name, self.names, 3)
        raise ModelError(f"no parameter {name!r} in the table" + (f"; near: {', '.join(near)}" if near else ""))

    def table(self, count: int = 20) -> str:
        """The strongest influences as text, for reading."""
        lines = [f"{self.crossing}", f"{'parameter':44} {'value':>12} {'unit':10} {'dV/V by dp/scale':>16} {'df/f by dp/scale':>16}"]
        for k in range(min(count, len(self))):
            lines.append(f"{self.names[k]:44} {self.values[k]:12.5g} {self.units[k]:10} {self.speed_elasticity[k]:16.4f} "
                         f"{self.frequency_elasticity[k]:16.4f}")
        return "\n".join(lines)

    def plot(self, **options):
        """Draw the strongest influences; options and axes as `railsym.plots.plot_sensitivities`."""
        from railsym.plots import plot_sensitivities
        return plot_sensitivities(self, **options)


@dataclass(frozen=True)
class Parameter:
    """One number, or several that change together.

    Attributes
    ----------
    name : str
    value : float
        SI.
    unit : str
    change : callable
        Value to LinearModel.
    """

    name: str
    value: float
    unit: str
    change: Callable[[float], LinearModel]


def sensitivity(vehicle, conicity=None, criterion: str | None = None, damping_ratio: float | None = None,
                speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND, parameters=None, crossing: int | None = None,
                progress: bool = False) -> Sensitivities:
    """Sensitivity of the critical speed to the parameters of the vehicle file and the conicity.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    conicity, criterion, damping_ratio, speed_range, contact, frequency_band, progress
        As `railsym.critical_speed.critical_speed`, one conicity.
    parameters : sequence of str, optional
        Dotted names of single numbers, "conicity"; every number of the file when not given.
    crossing : int, optional
        Which of the crossings, in the order of speed; the one that gives the critical speed when not given.

    Returns
    -------
    Sensitivities

    Raises
    ------
    ModelError
        No critical speed in the range, or a crossing that does not exist.
    """
    ratio = damping_ratio_of(criterion, damping_ratio)
    contact = contact_or_default(contact)
    contact = contact if conicity is None else replace(contact, conicity=float(conicity))
    model, = linear_models(vehicle, contact, [contact.conicity])
    found, = stability(model, (ratio,), speed_range, frequency_band)
    point = _chosen(found, crossing)
    return sensitivities(point, vehicle_parameters(vehicle, contact, parameters), progress)


def _chosen(found, crossing):
    if crossing is not None:
        if not -len(found.crossings) <= crossing < len(found.crossings):
            raise ModelError(f"crossing {crossing} does not exist; there are {len(found.crossings)}: {found.message}")
        return found.crossings[crossing]
    if found.speed is None:
        raise ModelError(f"no critical speed to differentiate: {found.message}; name a crossing or another speed_range")
    return next(c for c in found.crossings if c.speed == found.speed)


def sensitivities(point: CriticalCrossing, parameters, progress: bool = False) -> Sensitivities:
    """Derivatives at a critical point.

    Parameters
    ----------
    point : CriticalCrossing
    parameters : sequence of Parameter
    progress : bool

    Returns
    -------
    Sensitivities
    """
    rows, skipped = [], {}
    for parameter in followed(parameters, len(parameters), "sensitivity", progress):
        if not np.isfinite(parameter.value):
            skipped[parameter.name] = f"its value is {parameter.value}"
            continue
        try:
            rows.append((parameter, *_derivatives(point, _eigenvalue_derivative(point, parameter))))
        except RailsymError as error:
            skipped[parameter.name] = f"it cannot change by itself ({error})"
    return _sorted(point, rows, skipped)


def _sorted(point, rows, skipped) -> Sensitivities:
    value = np.array([row[0].value for row in rows])
    speed, frequency = (np.array([row[k] for row in rows]) for k in (1, 2))
    scale = np.array([1.0 if _PLACE.search(row[0].name) else abs(row[0].value) for row in rows])
    relative = scale * speed / point.speed, scale * frequency / point.frequency_hz
    order = np.lexsort((-np.abs(speed), -np.abs(relative[0])))
    message = f"{len(rows)} parameters from one eigenproblem, {len(skipped)} left out: {point}"
    return Sensitivities(tuple(rows[k][0].name for k in order), tuple(rows[k][0].unit for k in order), value[order], scale[order],
                         speed[order], frequency[order], relative[0][order], relative[1][order], skipped, point, message)


def _derivatives(point, by_parameter):
    """dV/dp and df/dp from d(lambda)/dp."""
    weight = 1.0 + point.criterion * np.conj(point.eigenvalue) / abs(point.eigenvalue)
    speed = -(weight * by_parameter).real / (weight * point.slope).real
    return speed, (by_parameter + point.slope * speed).imag / (2 * np.pi)


def _eigenvalue_derivative(point, parameter: Parameter) -> complex:
    """d(lambda)/dp = -y^H (dT/dp) x at fixed speed; y is scaled to y^H (dT/dlambda) x = 1."""
    value = parameter.value
    step = _RELATIVE_STEP * abs(value) if value else _ZERO_STEP.get(parameter.unit, 1e-3)

    def form(steps):
        return _form(point, parameter.change(value + steps * step))

    try:
        return -(form(1) - form(-1)) / (2 * step)
    except RailsymError:
        try:
            return -_one_sided(form, 1) / step
        except RailsymError:
            return _one_sided(form, -1) / step


def _one_sided(form, side):
    """Second-order difference times the step, at the edge of what is permitted; y^H T x = 0 at the critical point itself."""
    return 2 * form(side) - 0.5 * form(2 * side)


def _form(point, model: LinearModel) -> complex:
    """y^H T x of a model at the critical point."""
    value, x, y = point.eigenvalue, point.right, point.left
    if model.size != len(x):
        raise ModelError(f"the model has {model.size} coordinates in place of {len(x)}")
    v = value * x
    force = model.mass @ (value * v) + model.damping_constant @ v + model.stiffness @ x
    force += point.speed * (model.damping_speed @ v) + (model.damping_inverse_speed @ v) / point.speed
    return y.conj() @ force


def vehicle_parameters(vehicle, contact, names=None) -> list[Parameter]:
    """The single numbers of a vehicle, and the conicity, as `Parameter`.

    Numbers that the contact sets itself are changed there; the two transverse inertias of a wheelset change together.
    """
    from railsym.linear import linear_model

    def by_vehicle(components):
        return lambda value: linear_model(vehicle.replace(dict.fromkeys(components, value)), contact)

    def by_contact(name):
        return lambda value: linear_model(vehicle, replace(contact, **{name: value}))

    found = [Parameter(CONICITY, contact.conicity, "-", by_contact(CONICITY))]
    own = {f"contact.{f.name}" for f in fields(contact) if getattr(contact, f.name) is not None}
    flat, together = vehicle.parameters.components(), _axisymmetric(vehicle)
    for name, value in flat.items():
        unit = vehicle.parameters[name].unit
        if name in own:
            field_name = name.removeprefix("contact.")
            found.append(Parameter(name, getattr(contact, field_name), unit, by_contact(field_name)))
        elif name in together:
            found.append(Parameter(f"{name} + {together[name]}", value, unit, by_vehicle((name, together[name]))))
        elif name not in together.values():
            found.append(Parameter(name, value, unit, by_vehicle((name,))))
    return found if names is None else _named(found, names)


def _axisymmetric(vehicle) -> Mapping[str, str]:
    """Components of wheelset inertias that must stay equal: Ixx -> Izz."""
    groups = {body.group for body in vehicle.bodies if body.kind == "wheelset"}
    return {f"{group}.inertia.0": f"{group}.inertia.2" for group in groups}


def _named(found, names):
    by_name = {parameter.name: parameter for parameter in found}
    for parameter in found:
        by_name.update(dict.fromkeys(parameter.name.split(" + "), parameter))
    missing = [name for name in names if name not in by_name]
    if missing:
        from difflib import get_close_matches
        near = get_close_matches(missing[0], by_name, 3)
        raise ModelError(f"no parameter {missing[0]!r} (a single number)" + (f"; near: {', '.join(near)}" if near else ""))
    return list(dict.fromkeys(by_name[name] for name in names))
