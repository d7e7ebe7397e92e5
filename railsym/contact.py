# SPDX-License-Identifier: BSD-3-Clause
"""Linear wheel-rail contact: equivalent conicity, Hertz, Kalker, quasi-linear friction.

Each wheel touches its rail in one point.  With side = -1 (left), +1 (right),
yc = y - r0 phi the lateral shift of the wheel at its contact (y right, z down,
roll phi about the forward axis), lam the conicity,

    rolling radius        r     = r0 + side lam yc
    slope of the contact  delta = delta0 + side eps yc
    penetration           p     = z + side b0 phi + side delta0 yc + eps yc^2/2

(dp/dyc = side delta, so p and delta belong together).  Rigid contact, p = 0 on
both rails, ties roll to lateral shift; the roll parameter sigma and the
contact-angle parameter E are defined along that motion,

    phi = -sigma y/b0,    delta = delta0 + side E y/b0,

which gives delta0 = b0 sigma/(b0 + r0 sigma) and eps = E/(b0 + r0 sigma).
A cone has delta0 = lam and E = sigma = lam b0/(b0 - r0 lam).
docs/linear_contact.md derives this and says what is assumed.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Mapping, NamedTuple

import numpy as np

from railsym.describing_function import check_law, creep_gain
from railsym.errors import ContactError
from railsym.hertz import contact_modulus, hertz
from railsym.kalker import kalker_coefficients

_UNITS = {"conicity": "-", "friction": "-", "kalker_weight": "-", "contact_angle_parameter": "-",
          "roll_parameter": "-", "amplitude": "m", "wheel_transverse_radius": "m",
          "rail_transverse_radius": "m", "young_modulus": "N/m^2", "poisson_ratio": "-"}
_REQUIRED = ("friction", "kalker_weight", "wheel_transverse_radius", "rail_transverse_radius",
             "young_modulus", "poisson_ratio")
# What each value must obey, in words and as a test.
_LIMITS = {
    "conicity": ("finite (0: cylinder; negative: hollow-worn tread)", lambda v: True),
    "friction": ("positive", lambda v: v > 0.0),
    "kalker_weight": ("positive (1: Kalker's theory)", lambda v: v > 0.0),
    "contact_angle_parameter": ("finite", lambda v: True),
    "roll_parameter": ("finite", lambda v: True),
    "amplitude": ("not negative (0: Kalker's linear theory)", lambda v: v >= 0.0),
    "young_modulus": ("positive", lambda v: v > 0.0),
    "poisson_ratio": ("between 0 and 0.5", lambda v: 0.0 <= v <= 0.5),
}


@dataclass(frozen=True, slots=True)
class WheelContacts:
    """Linear contact of wheels; every field is an array (n,), one entry a wheel.

    Attributes
    ----------
    load : ndarray
        Normal load N0, N.
    side : ndarray
        -1 left, +1 right.
    wheel_radius, contact_half_spacing : ndarray
        r0 and b0, m.
    conicity : ndarray
        lam, change of rolling radius per lateral shift at the contact.
    slope : ndarray
        delta0, contact slope against the track plane, rad, positive as on a
        wheel whose radius grows towards the track centre.
    slope_gradient : ndarray
        eps, change of slope per lateral shift at the contact, rad/m.
    normal_stiffness : ndarray
        dN/d(penetration), N/m.
    a, b : ndarray
        Semi-axes of the contact ellipse along and across the track, m.
    gain : ndarray
        Describing-function gain of the creep law, 0..1.
    f11, f22 : ndarray
        Creep coefficients, longitudinal and lateral, N.
    f23 : ndarray
        Lateral-spin creep coefficient, N m.
    f33 : ndarray
        Spin creep coefficient, N m^2.

    Notes
    -----
    Forces on the wheel, creepages of the wheel against the rail:
    Fx = -f11 xi; Fy = -(f22 eta + f23 phi); Mz = f23 eta - f33 phi.
    """

    load: np.ndarray
    side: np.ndarray
    wheel_radius: np.ndarray
    contact_half_spacing: np.ndarray
    conicity: np.ndarray
    slope: np.ndarray
    slope_gradient: np.ndarray
    normal_stiffness: np.ndarray
    a: np.ndarray
    b: np.ndarray
    gain: np.ndarray
    f11: np.ndarray
    f22: np.ndarray
    f23: np.ndarray
    f33: np.ndarray


@dataclass(frozen=True)
class LinearContact:
    """Parameters of the linear wheel-rail contact.

    Parameters
    ----------
    conicity : float
        Equivalent conicity; 0 and negative values are allowed.
    friction : float, optional
        Coefficient of friction mu.
    kalker_weight : float, optional
        Factor on all creep coefficients (Kalker's theory: 1).
    contact_angle_parameter : float, optional
        d(slope)/d(y/b0) along rigid contact; None: the cone's, which equals
        the roll parameter.
    roll_parameter : float, optional
        -d(roll)/d(y/b0) along rigid contact; None: the cone's,
        lam b0/(b0 - r0 lam).
    amplitude : float, optional
        Lateral amplitude of the wheelset, m, at which the creep law is
        quasi-linearised; 0: infinitesimal motion, Kalker's linear theory.
    law : str
        "shen_hedrick_elkins", "polach" or "kalker" (no saturation).
    wheel_transverse_radius, rail_transverse_radius : float, optional
        Profile radii at the contact, m, positive where convex, inf where
        straight, negative where hollow.
    young_modulus : float, optional
        Of wheel and rail, N/m^2.
    poisson_ratio : float, optional
        Of wheel and rail.

    Raises
    ------
    ContactError
        For a value that is not finite or outside its range, and an unknown law.

    Notes
    -----
    An optional value left at None is taken from the vehicle file's [contact]
    by `resolved`; roll and contact-angle parameters that are not there either
    stay None, as the cone's value depends on each wheelset's r0 and b0.
    """

    conicity: float = 0.2
    friction: float | None = None
    kalker_weight: float | None = None
    contact_angle_parameter: float | None = None
    roll_parameter: float | None = None
    amplitude: float | None = None
    law: str = "shen_hedrick_elkins"
    wheel_transverse_radius: float | None = None
    rail_transverse_radius: float | None = None
    young_modulus: float | None = None
    poisson_ratio: float | None = None

    def __post_init__(self):
        check_law(self.law)
        if self.conicity is None:
            raise ContactError("conicity must be a number, got None")
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name != "law" and value is not None:
                object.__setattr__(self, field.name, _checked(field.name, value))

    def resolved(self, vehicle_contact: Mapping[str, float]) -> LinearContact:
        """Fill what was left open from the vehicle's [contact] table.

        Parameters
        ----------
        vehicle_contact : mapping
            Names of this class's parameters to values in SI units.

        Returns
        -------
        LinearContact
            Complete; amplitude 0 if neither side gives one.

        Raises
        ------
        ContactError
            If a value is given on neither side.
        """
        filled = {}
        for name in _UNITS:
            if getattr(self, name) is None and vehicle_contact.get(name) is not None:
                filled[name] = vehicle_contact[name]
        if self.amplitude is None:
            filled.setdefault("amplitude", 0.0)
        missing = [name for name in _REQUIRED if getattr(self, name) is None and name not in filled]
        if missing:
            raise ContactError(
                f"linear contact has no {', '.join(f'{name} [{_UNITS[name]}]' for name in missing)}: give it to "
                f"LinearContact or in the vehicle file's [contact] (which has: "
                f"{', '.join(sorted(vehicle_contact)) or 'nothing'})")
        return replace(self, **filled)

    def wheels(self, load, wheel_radius, contact_half_spacing, side) -> WheelContacts:
        """Linear contact of each wheel.

        Parameters
        ----------
        load : array_like (n,)
            Normal load, N; positive.
        wheel_radius, contact_half_spacing : array_like (n,) or float
            r0 and b0, m.
        side : array_like (n,)
            -1 left, +1 right.

        Returns
        -------
        WheelContacts

        Raises
        ------
        ContactError
            For a wheel without load, contact that is not convex, a roll
            parameter that no wheelset of this size can have, or parameters
            left open (call `resolved` first).
        """
        self._require_resolved()
        load, radius, half_spacing, side = _wheel_arrays(load, wheel_radius, contact_half_spacing, side)
        slope, slope_gradient = self._contact_slope(radius, half_spacing)
        unit = _unit_patch(tuple(radius.tolist()), self.wheel_transverse_radius, self.rail_transverse_radius,
                           self.young_modulus, self.poisson_ratio)
        # Hertz: semi-axes grow with N^(1/3), dN/d(approach) too.
        scale = np.cbrt(load)
        a, b = unit.a * scale, unit.b * scale
        area = a * b
        f11 = self.kalker_weight * unit.shear_modulus * area * unit.c11
        gain = self._gain(f11, load, radius)
        factor = gain * (self.kalker_weight * unit.shear_modulus) * area
        return WheelContacts(
            load=load, side=side, wheel_radius=radius, contact_half_spacing=half_spacing,
            conicity=np.full(load.shape, self.conicity), slope=slope, slope_gradient=slope_gradient,
            normal_stiffness=unit.normal_stiffness * scale, a=a, b=b, gain=gain,
            f11=gain * f11, f22=factor * unit.c22, f23=factor * np.sqrt(area) * unit.c23,
            f33=factor * area * unit.c33)

    def _require_resolved(self):
        missing = [name for name in (*_REQUIRED, "amplitude") if getattr(self, name) is None]
        if missing:
            raise ContactError(f"linear contact has no {', '.join(missing)}: call resolved(vehicle.contact) first")

    def _contact_slope(self, radius, half_spacing):
        """delta0 and eps of the penetration, from roll and contact-angle parameters."""
        if self.roll_parameter is None:
            if np.any(half_spacing <= radius * self.conicity):
                raise ContactError(f"conicity {self.conicity} puts the apex of the cone inside the gauge (needs "
                                   "conicity < b0/r0); give a smaller conicity or a roll_parameter")
            # Cone: delta0 = lam, hence sigma = lam b0/(b0 - r0 lam) and b0 + r0 sigma = b0^2/(b0 - r0 lam).
            roll = self.conicity * half_spacing / (half_spacing - radius * self.conicity)
        else:
            roll = self.roll_parameter
        reach = half_spacing + radius * roll
        if np.any(reach <= 0.0):
            raise ContactError(f"roll_parameter {self.roll_parameter} must exceed -b0/r0 of every wheelset")
        angle = roll if self.contact_angle_parameter is None else self.contact_angle_parameter
        return half_spacing * roll / reach, angle / reach

    def _gain(self, linear_f11, load, radius):
        """Gain at the longitudinal creepage of a wheelset that shifts without yawing."""
        if self.amplitude == 0.0 or self.law == "kalker":
            return np.ones_like(load)
        creepage = creepage_amplitude(self.conicity, self.amplitude, radius)
        return creep_gain(linear_f11 * creepage / (self.friction * load), self.law)


def creepage_amplitude(conicity, amplitude, wheel_radius):
    """Creepage amplitude that stands for a hunting wheelset in the quasi-linearisation.

    ``|lam| A/r0``: exact for a wheelset that shifts by A without yawing and for
    the wheelsets of a long rigid bogie in kinematic hunting, which a shorter
    bogie does not reach in that motion (docs/linear_contact.md).

    Parameters
    ----------
    conicity : float or ndarray
        lam.
    amplitude : float or ndarray
        Lateral amplitude A of the wheelset, m.
    wheel_radius : float or ndarray
        r0, m.

    Returns
    -------
    float or ndarray
        Creepage amplitude, dimensionless.
    """
    return np.abs(conicity) * amplitude / wheel_radius


class _UnitPatch(NamedTuple):
    """Contact patch at a load of 1 N, and Kalker's coefficients, which no load changes."""

    a: np.ndarray
    b: np.ndarray
    normal_stiffness: np.ndarray
    c11: np.ndarray
    c22: np.ndarray
    c23: np.ndarray
    c33: np.ndarray
    shear_modulus: float


@lru_cache(maxsize=64)
def _unit_patch(wheel_radius, wheel_transverse_radius, rail_transverse_radius, young_modulus, poisson_ratio):
    curvature_y = 1.0 / wheel_transverse_radius + 1.0 / rail_transverse_radius
    if not curvature_y > 0.0:
        raise ContactError(
            f"wheel_transverse_radius {wheel_transverse_radius} m and rail_transverse_radius "
            f"{rail_transverse_radius} m do not make a convex contact: 1/R_wheel + 1/R_rail must be positive")
    patch = hertz(1.0, 1.0 / np.array(wheel_radius), curvature_y, contact_modulus(young_modulus, poisson_ratio))
    coefficients = kalker_coefficients(patch.a / patch.b, poisson_ratio)
    unit = _UnitPatch(patch.a, patch.b, patch.normal_stiffness, *coefficients,
                      shear_modulus=young_modulus / (2.0 * (1.0 + poisson_ratio)))
    for array in unit[:-1]:
        array.setflags(write=False)  # shared by every caller through the cache
    return unit


def _checked(name, value):
    """One parameter as float, inside its range."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ContactError(f"{name} must be a number, got {value!r}") from None
    if name.endswith("_radius"):
        if np.isnan(number) or number == 0.0:
            raise ContactError(f"{name} is {number} m; it must be a radius: not 0, inf where the profile is straight")
        return number
    wanted, allowed = _LIMITS[name]
    if not np.isfinite(number) or not allowed(number):
        raise ContactError(f"{name} is {number} {_UNITS[name]}; it must be {wanted}")
    return number


def _wheel_arrays(load, wheel_radius, contact_half_spacing, side):
    """Arguments of `LinearContact.wheels` as new float arrays (n,), checked."""
    arrays = [np.asarray(v, dtype=float) for v in (load, wheel_radius, contact_half_spacing, side)]
    load = np.array(arrays[0], ndmin=1)
    try:
        radius, half_spacing, side = (np.array(np.broadcast_to(v, load.shape)) for v in arrays[1:])
    except ValueError:
        shapes = ", ".join(str(v.shape) for v in arrays)
        raise ContactError(f"load, wheel_radius, contact_half_spacing, side have shapes {shapes}; "
                           "they must fit the number of wheels (n,)") from None
    for name, unit, values in (("load", "N", load), ("wheel_radius", "m", radius),
                               ("contact_half_spacing", "m", half_spacing)):
        bad = ~((values > 0.0) & (values < np.inf))
        if bad.any():
            index = int(bad.argmax())
            raise ContactError(f"wheel {index}: {name} is {float(values[index])} {unit}; it must be positive and finite")
    bad = np.abs(side) != 1.0
    if bad.any():
        index = int(bad.argmax())
        raise ContactError(f"wheel {index}: side is {float(side[index])}; it must be -1 (left) or +1 (right)")
    return load, radius, half_spacing, side
