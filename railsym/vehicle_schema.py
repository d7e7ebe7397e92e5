# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle file may hold: every key with its unit, shape, permitted range and default."""

from dataclasses import dataclass

import numpy as np

# Permitted range of a value: (test that takes a float or an array, text for the message).
RULES = {
    "any": (lambda v: v == v, "numbers other than nan"),
    "finite": (lambda v: np.isfinite(v), "finite numbers"),
    "positive": (lambda v: (v > 0) & np.isfinite(v), "finite numbers above 0"),
    "not negative": (lambda v: (v >= 0) & np.isfinite(v), "finite numbers, 0 or above"),
    "radius": (lambda v: (v == v) & (v != 0), "any radius but 0, inf for straight, negative for hollow"),
    "limit": (lambda v: v > 0, "numbers above 0, inf for no limit"),
    "positive radius": (lambda v: v > 0, "a radius above 0, inf for straight"),
    "poisson": (lambda v: (v >= 0) & (v < 0.5), "numbers from 0 to below 0.5"),
}


@dataclass(frozen=True, slots=True)
class Field:
    """One number of the file.

    Attributes
    ----------
    unit : str
        SI unit; every unit of the same dimension may be written.
    rule : str
        Key of `RULES`.
    shapes : tuple of tuple of int
        Permitted shapes; () is a single number, (-1,) a list of any length.
    required : bool
    default : float or None
        Value of an optional number that the file leaves out (every component of it); None: it is then absent.
    """

    unit: str
    rule: str = "not negative"
    shapes: tuple = ((),)
    required: bool = True
    default: float | None = None


@dataclass(frozen=True, slots=True)
class CurveChoice:
    """A curve that stands in place of numbers: either `key`, or all of `numbers`."""

    key: str
    numbers: tuple
    x_unit: str
    y_unit: str
    rising: bool = True


@dataclass(frozen=True, slots=True)
class ElementType:
    """Numbers and curves of one type of element.

    Attributes
    ----------
    fields : dict of str to Field
    curves : tuple of CurveChoice
    axis : str
        ``"none"``, ``"optional"``, ``"required"``, ``"line"`` (always along the line of its points) or ``"roll"`` (about x).
    modes : tuple of str
        Permitted values of ``mode``.
    """

    fields: dict
    curves: tuple = ()
    axis: str = "none"
    modes: tuple = ()


def _optional(unit, shape=()):
    return Field(unit, shapes=(shape,), required=False, default=0.0)


def _limits(rate_unit):
    """What an actuator can do: how it follows its command, and how much it bears."""
    return {
        "lag": _optional("s"),
        "rate_limit": Field(rate_unit, "limit", required=False, default=np.inf),
        "force_limit": Field("N", "limit", required=False, default=np.inf),
        "bypass_damping": _optional("N*s/m"),
    }


POSITION = Field("m", "finite", ((3,),))
ORIENTATION = Field("rad", "finite", ((3,),), required=False)

VEHICLE_FIELDS = {"gravity": Field("m/s^2")}

CONTACT_FIELDS = {
    "friction": Field("-", "positive"),
    "kalker_weight": Field("-", "positive"),
    "amplitude": Field("m"),
    "wheel_transverse_radius": Field("m", "radius"),
    "rail_transverse_radius": Field("m", "positive radius"),
    "young_modulus": Field("Pa", "positive"),
    "poisson_ratio": Field("-", "poisson"),
    "contact_angle_parameter": Field("-", "finite", required=False),
    "roll_parameter": Field("-", "finite", required=False),
}

_MASS = Field("kg", "positive")
_INERTIA = Field("kg*m^2", "finite", ((3,), (6,)))

BODY_FIELDS = {
    "rigid_body": {"mass": _MASS, "inertia": _INERTIA},
    "wheelset": {
        "mass": _MASS,
        "inertia": _INERTIA,
        "wheel_radius": Field("m", "positive"),
        "contact_half_spacing": Field("m", "positive"),
    },
}

AXLEBOX_FIELDS = {
    "mass": _MASS,
    "inertia": _INERTIA,
    "lateral_position": Field("m", "positive"),
    "centre_offset": Field("m", "finite", ((3,),), required=False, default=0.0),
}

ELEMENT_TYPES = {
    "bushing": ElementType(
        {
            "stiffness": Field("N/m", shapes=((3,),)),
            "rotational_stiffness": _optional("N*m/rad", (3,)),
            "damping": _optional("N*s/m", (3,)),
            "rotational_damping": _optional("N*m*s/rad", (3,)),
        }
    ),
    "spring": ElementType(
        {"stiffness": Field("N/m")}, (CurveChoice("curve", ("stiffness",), "m", "N"),), axis="optional"
    ),
    "damper": ElementType(
        {"damping": Field("N*s/m")}, (CurveChoice("curve", ("damping",), "m/s", "N"),), axis="optional"
    ),
    "maxwell": ElementType(
        {"damping": Field("N*s/m"), "series_stiffness": Field("N/m", "positive")},
        (
            CurveChoice("damping_curve", ("damping",), "m/s", "N"),
            CurveChoice("series_stiffness_curve", ("series_stiffness",), "m/s", "N/m", rising=False),
        ),
        axis="optional",
    ),
    "bump_stop": ElementType(
        {"clearance": Field("m"), "stiffness": Field("N/m")},
        (CurveChoice("curve", ("clearance", "stiffness"), "m", "N"),),
        axis="required",
    ),
    "anti_roll_bar": ElementType(
        {"stiffness": Field("N*m/rad"), "damping": _optional("N*m*s/rad")}, axis="roll"
    ),
    "traction_rod": ElementType({"stiffness": Field("N/m"), "damping": _optional("N*s/m")}, axis="line"),
    # In mode "length" a spring and damper carry the actuator to its commanded length; in mode "force" both may be left out.
    "actuator": ElementType(
        {"stiffness": Field("N/m"), "damping": Field("N*s/m")} | _limits("m/s"), axis="optional", modes=("force", "length")
    ),
}

_FORCE_ACTUATOR_FIELDS = {"stiffness": _optional("N/m"), "damping": _optional("N*s/m")} | _limits("N/s")


def element_fields(type_name, mode=None):
    """Fields of an element type; `mode` matters to actuators only.

    Returns
    -------
    dict of str to Field
    """
    return _FORCE_ACTUATOR_FIELDS if mode == "force" else ELEMENT_TYPES[type_name].fields
