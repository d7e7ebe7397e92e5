# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle consists of apart from its numbers, and how its parts are built from the numbers."""

from dataclasses import dataclass

import numpy as np

from railsym import vehicle_schema as schema
from railsym.vehicle_checks import Problem, check_axisymmetric, inertia_tensor
from railsym.vehicle_parts import TRACK, Axlebox, Body, Curve, Element, End, FrozenDict

# Points closer than this have no line of action (m).
SHORTEST_LINE = 1e-3

_IDENTITY = np.eye(3)
_IDENTITY.setflags(write=False)


@dataclass(frozen=True, slots=True)
class BodyGroup:
    """Bodies with the same data at several places."""

    name: str
    kind: str
    instances: tuple[str, ...]
    has_axleboxes: bool


@dataclass(frozen=True, slots=True)
class Instance:
    """One element of a group: what it joins, and whether both ends are given as one point."""

    name: str
    first: str
    second: str
    one_point: bool

    def position_keys(self, group):
        """Dotted names of the positions of the two ends."""
        if self.one_point:
            return (f"{group}.{self.name}.position",) * 2
        return f"{group}.{self.name}.first_position", f"{group}.{self.name}.second_position"


@dataclass(frozen=True, slots=True)
class ElementGroup:
    """Elements with the same data between several pairs of attachments.

    `axis` is the index of the axis that the file names, or None; `curves` maps a curve key to the name of the curve.
    """

    name: str
    type: str
    axis: int | None
    mode: str | None
    curves: dict
    instances: tuple[Instance, ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """Everything of a vehicle but its numbers."""

    file: str
    name: str
    description: str
    bodies: dict
    elements: dict
    curves: tuple[str, ...]
    configurations: dict


def attachment_names(body_groups):
    """Names of everything an element can be attached to, "track" last."""
    names = []
    for group in body_groups.values():
        for instance in group.instances:
            names.append(instance)
            if group.has_axleboxes:
                names += [f"{instance}.axlebox_left", f"{instance}.axlebox_right"]
    return (*names, TRACK)


def rotation(angles):
    """Rotation matrix Rz(yaw) Rx(roll) Ry(pitch); its columns are the turned axes.

    Parameters
    ----------
    angles : array_like, shape (3,)
        Yaw, roll, pitch, rad.

    Returns
    -------
    ndarray, shape (3, 3)
    """
    (cz, cx, cy), (sz, sx, sy) = np.cos(angles), np.sin(angles)
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    return about_z @ about_x @ about_y


def field_of(layout, key):
    """The `Field` of a dotted parameter name that follows the format, or None.

    The name need not be a parameter at present: ``"secondary.stiffness"`` has a field also while a curve stands in for it.
    """
    head, *rest = key.split(".")
    if head == "vehicle" and len(rest) == 1:
        return schema.VEHICLE_FIELDS.get(rest[0])
    if head == "contact" and len(rest) == 1:
        return schema.CONTACT_FIELDS.get(rest[0])
    if head in layout.elements:
        return _element_field(layout.elements[head], rest)
    if rest == ["position"] and any(head in group.instances for group in layout.bodies.values()):
        return schema.POSITION
    if head in layout.bodies:
        return _body_field(layout.bodies[head], rest)
    return None


def _element_field(group, rest):
    if len(rest) == 1:
        if rest[0] == "orientation":
            return schema.ORIENTATION
        return schema.element_fields(group.type, group.mode).get(rest[0])
    keys = (key for instance in group.instances if instance.name == rest[0] for key in instance.position_keys(group.name))
    return schema.POSITION if ".".join((group.name, *rest)) in keys else None


def _body_field(group, rest):
    if len(rest) == 2 and rest[0] == "axlebox" and group.has_axleboxes:
        return schema.AXLEBOX_FIELDS.get(rest[1])
    return schema.BODY_FIELDS[group.kind].get(rest[0]) if len(rest) == 1 else None


def build_bodies(group, values):
    """The bodies of a group.

    Parameters
    ----------
    group : BodyGroup
    values : mapping of str to Quantity

    Returns
    -------
    tuple of Body

    Raises
    ------
    Problem
        If no body can have the inertia.
    """
    name = group.name
    key = f"{name}.inertia"
    inertia = inertia_tensor(key, values[key].value)
    data = {"mass": values[f"{name}.mass"].value, "inertia": inertia}
    if group.kind == "wheelset":
        check_axisymmetric(key, inertia, values[key].value)
        data["wheel_radius"] = values[f"{name}.wheel_radius"].value
        data["contact_half_spacing"] = values[f"{name}.contact_half_spacing"].value
    return tuple(
        Body(
            name=instance,
            group=name,
            kind=group.kind,
            position=values[f"{instance}.position"].value,
            axleboxes=_build_axleboxes(group, instance, values),
            **data,
        )
        for instance in group.instances
    )


def _build_axleboxes(group, instance, values):
    """Left and right axlebox; the file gives the right one, the left one is its mirror image."""
    if not group.has_axleboxes:
        return ()
    prefix = f"{group.name}.axlebox."
    mirror = np.diag([1.0, -1.0, 1.0])
    right = inertia_tensor(prefix + "inertia", values[prefix + "inertia"].value)
    offset = values[prefix + "centre_offset"].value
    half = values[prefix + "lateral_position"].value
    left, left_offset = mirror @ right @ mirror, mirror @ offset
    left.setflags(write=False)
    left_offset.setflags(write=False)
    mass = values[prefix + "mass"].value
    return (
        Axlebox(f"{instance}.axlebox_left", -1, mass, left, -half, left_offset),
        Axlebox(f"{instance}.axlebox_right", 1, mass, right, half, offset),
    )


def build_curve(name, values):
    """A curve from its columns.

    Raises
    ------
    Problem
        If x is not strictly increasing, y not monotone, or their lengths differ.
    """
    x, y = values[f"curves.{name}.x"], values[f"curves.{name}.y"]
    if x.value.size != y.value.size:
        raise Problem(
            f"curves.{name}.y", y.value, f"holds {y.value.size} numbers but x holds {x.value.size}; allowed: as many as x"
        )
    if np.any(np.diff(x.value) <= 0.0):
        raise Problem(f"curves.{name}.x", x.value, "must be strictly increasing")
    steps = np.diff(y.value)
    if np.any(steps > 0.0) and np.any(steps < 0.0):
        raise Problem(f"curves.{name}.y", y.value, "must be monotone: rising or falling throughout")
    return Curve(name, x.value, y.value, x.unit, y.unit, y.origin)


def build_elements(group, values, curves):
    """The elements of a group.

    Parameters
    ----------
    group : ElementGroup
    values : mapping of str to Quantity
    curves : mapping of str to Curve

    Returns
    -------
    tuple of Element

    Raises
    ------
    Problem
        If an element acts along the line of two points that are not apart, or a curve does not fit its place.
    """
    parameters = _element_parameters(group, values, curves)
    if group.type == "actuator":
        _check_actuator(group, parameters)
    orientation = values.get(f"{group.name}.orientation")
    axes = _IDENTITY
    if orientation is not None:
        axes = rotation(orientation.value)
        axes.setflags(write=False)
    axis = 0 if group.type == "anti_roll_bar" else group.axis
    elements = []
    for instance in group.instances:
        first_key, second_key = instance.position_keys(group.name)
        first = End(instance.first, values[first_key].value)
        second = End(instance.second, values[second_key].value)
        if axis is None and group.type != "bushing":
            _check_line(second_key, first.position, second.position)
        name = f"{group.name}.{instance.name}"
        elements.append(Element(name, group.name, group.type, first, second, axes, axis, parameters))
    return tuple(elements)


def _check_actuator(group, parameters):
    if parameters["rate_limit"] < np.inf and parameters["lag"] == 0.0:
        raise Problem(f"{group.name}.rate_limit", parameters["rate_limit"], "what an actuator follows is limited in rate only where it lags behind "
                      f"its command: give {group.name}.lag above 0 s too")
    if group.mode == "length" and parameters["lag"] > 0.0 and parameters["stiffness"] == 0.0:
        raise Problem(f"{group.name}.stiffness", 0.0, "an actuator that follows a commanded length needs a stiffness above 0 N/m")


def renumber_elements(group, values, curves, elements):
    """The elements of a group where they are, with new parameters; arguments and errors as `build_elements`."""
    parameters = _element_parameters(group, values, curves)
    return tuple(Element(e.name, e.group, e.type, e.first, e.second, e.axes, e.axis, parameters) for e in elements)


def _check_line(key, first, second):
    dx, dy, dz = second - first
    length = (dx * dx + dy * dy + dz * dz) ** 0.5
    if length <= SHORTEST_LINE:
        raise Problem(
            key, second, f"the element acts along the line of its two points, which are {length:.3g} m apart: "
            f"place them more than {SHORTEST_LINE} m apart, or give an axis where the type allows one"
        )


def _element_parameters(group, values, curves):
    """Numbers, curves and mode of a group; one dictionary that all its elements share."""
    parameters = {"mode": group.mode} if group.mode else {}
    choices = schema.ELEMENT_TYPES[group.type].curves
    replaced = set()
    for choice in choices:
        if choice.key in group.curves:
            parameters[choice.key] = _fitting_curve(f"{group.name}.{choice.key}", curves[group.curves[choice.key]], choice)
            replaced.update(choice.numbers)
    for key in schema.element_fields(group.type, group.mode):
        if key not in replaced:
            parameters[key] = values[f"{group.name}.{key}"].value
    return FrozenDict(parameters)


def _fitting_curve(key, curve, choice):
    """The curve, if it relates the right kinds of quantity and keeps the sign that its element needs."""
    if (curve.x_unit, curve.y_unit) != (choice.x_unit, choice.y_unit):
        raise Problem(
            key, curve.name,
            f"the curve gives {curve.y_unit} over {curve.x_unit}; allowed is {choice.y_unit} over {choice.x_unit}",
        )
    if not choice.rising:
        if np.any(curve.y <= 0.0):
            raise Problem(key, curve.name, "the curve holds stiffnesses of 0 or below; allowed are values above 0")
        return curve
    if curve.y[-1] < curve.y[0]:
        raise Problem(key, curve.name, "the curve falls; a force that falls with deflection or speed is not allowed")
    if curve.x[0] > 0.0 or curve.x[-1] <= 0.0 or (curve.x[0] == 0.0 and curve.y[0] != 0.0):
        raise Problem(
            key, curve.name,
            "a force curve must either start at (0, 0), and holds mirrored for negative values, or reach to both sides of 0",
        )
    return curve
