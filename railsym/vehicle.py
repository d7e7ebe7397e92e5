# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle: bodies, elements and contact data from a vehicle file, with named configurations and parameters.

A `Vehicle` never changes: `Vehicle.configured` and `Vehicle.replace` give a new one.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from railsym.configurations import Configuration, apply_structure
from railsym.parameters import Parameters, changed
from railsym.vehicle_checks import Problem, unknown, vehicle_error
from railsym.vehicle_file import read_vehicle_file
from railsym.vehicle_layout import Layout, attachment_names, build_bodies, build_curve, build_elements, renumber_elements
from railsym.vehicle_parts import Axlebox, Body, Curve, Element, End, FrozenDict, Quantity

__all__ = ["Axlebox", "Body", "Configuration", "Curve", "Element", "End", "Quantity", "Vehicle", "load_vehicle", "vehicles"]

SHIPPED = Path(__file__).parent / "data" / "vehicles"

# Largest distance of a wheel from the rail at the design position that a file may have (m): far below any wear or rounding.
_WHEEL_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Vehicle:
    """A vehicle as data.

    Attributes
    ----------
    name, description : str
    bodies : tuple of Body
        In the order of the file.
    elements : tuple of Element
        In the order of the file.
    contact : dict of str to float
        Defaults of the wheel-rail contact, SI.
    gravity : float
        m/s^2
    configurations : dict of str to Configuration
    configuration : str or None
        The one applied.
    curves : dict of str to Curve
    parameters : Parameters
        Mapping of dotted name to `Quantity`: every number of the vehicle.
    """

    name: str
    description: str
    bodies: tuple[Body, ...]
    elements: tuple[Element, ...]
    contact: FrozenDict
    gravity: float
    configurations: FrozenDict
    configuration: str | None
    curves: FrozenDict
    parameters: Parameters
    _layout: Layout = field(repr=False)
    _values: dict = field(repr=False)
    _body_groups: dict = field(repr=False)
    _element_groups: dict = field(repr=False)

    def __repr__(self):
        applied = f", configuration {self.configuration!r}" if self.configuration else ""
        return f"<Vehicle {self.name!r}: {len(self.bodies)} bodies, {len(self.elements)} elements{applied}>"

    @property
    def attachments(self):
        """Names that an element can be attached to: bodies, axleboxes, and ``"track"``."""
        return attachment_names(self._layout.bodies)

    def body(self, name):
        """The body of this name.

        Raises
        ------
        VehicleFileError
            If there is none.
        """
        return self._named(name, self.bodies, "body", "bodies")

    def element(self, name):
        """The element of this name (``"group.instance"``).

        Raises
        ------
        VehicleFileError
            If there is none.
        """
        return self._named(name, self.elements, "element", "elements")

    def _named(self, name, things, singular, plural):
        for thing in things:
            if thing.name == name:
                return thing
        raise vehicle_error(
            self._shown_name(), f"{singular} {name!r}", None, "is " + unknown(name, (t.name for t in things), plural)
        )

    def _shown_name(self):
        return f"vehicle {self.name!r}" + (f" in configuration {self.configuration!r}" if self.configuration else "")

    def configured(self, name):
        """The vehicle in one of its configurations.

        Parameters
        ----------
        name : str
            Key of `configurations`.

        Returns
        -------
        Vehicle
            Changes made with `replace` before stay, unless the configuration sets the same parameter.

        Raises
        ------
        VehicleFileError
            If there is no such configuration, or one is applied already.
        """
        if name not in self.configurations:
            raise vehicle_error(
                self._shown_name(), f"configuration {name!r}", None,
                "is " + unknown(name, self.configurations, "configurations"),
            )
        if self.configuration is not None:
            raise vehicle_error(
                self._shown_name(), f"configuration {name!r}", None,
                "cannot be applied on top of another one; allowed: call configured() on the vehicle as loaded",
            )
        try:
            return self._apply(self.configurations[name])
        except Problem as problem:
            raise vehicle_error(self._shown_name(), problem.key, problem.value, problem.text) from None

    def _apply(self, configuration):
        layout, values = apply_structure(configuration, self._layout, self._values)
        try:
            layout, values, _ = changed(layout, values, configuration.set)
            return _assemble(layout, values, configuration.name)
        except Problem as problem:
            prefix = f"configurations.{configuration.name}.set."
            raise Problem(prefix + problem.key, problem.value, problem.text) from None

    def replace(self, changes):
        """The vehicle with other parameters.

        Parameters
        ----------
        changes : mapping of str to number, array, Quantity or str
            By dotted name. Numbers are SI; a `Quantity` is converted from its unit; a str is the name of a curve of the file.
            A curve drops the number that it replaces (``"anti_yaw_damper.damping_curve"`` drops ``"anti_yaw_damper.damping"``)
            and the other way round. Positions of elements do not move with those of bodies.

        Returns
        -------
        Vehicle

        Raises
        ------
        VehicleFileError
            If there is no such parameter, or the value is not permitted.
        """
        if not isinstance(changes, Mapping):
            raise vehicle_error(self._shown_name(), "replace", changes, "a mapping of dotted names to values is needed")
        try:
            layout, values, touched = changed(self._layout, self._values, changes)
            return self._rebuild(layout, values, touched, changes)
        except Problem as problem:
            raise vehicle_error(self._shown_name(), problem.key, problem.value, problem.text) from None

    def _rebuild(self, layout, values, touched, changes):
        """Assemble anew, taking over every part that `touched` leaves alone."""
        bodies, elements, curves = self._body_groups, self._element_groups, self.curves
        changed_bodies = {
            name: build_bodies(group, values)
            for name, group in layout.bodies.items()
            if name in touched or not touched.isdisjoint(group.instances)
        }
        if "curves" in touched:
            curves = FrozenDict({name: build_curve(name, values) for name in layout.curves})
            touched = touched | {name for name, group in layout.elements.items() if group.curves}
        moved = {name.partition(".")[0] for name in changes if "position" in name or "orientation" in name}
        changed_elements = {
            name: build_elements(group, values, curves) if name in moved
            else renumber_elements(group, values, curves, elements[name])
            for name, group in layout.elements.items() if name in touched
        }
        bodies = bodies | changed_bodies if changed_bodies else bodies
        elements = elements | changed_elements if changed_elements else elements
        contact = _contact(values) if "contact" in touched else self.contact
        return _vehicle(layout, values, self.configuration, bodies, elements, curves, contact)


def _assemble(layout, values, configuration):
    """Vehicle with every part built from its numbers."""
    bodies = {name: build_bodies(group, values) for name, group in layout.bodies.items()}
    curves = FrozenDict({name: build_curve(name, values) for name in layout.curves})
    elements = {name: build_elements(group, values, curves) for name, group in layout.elements.items()}
    return _vehicle(layout, values, configuration, bodies, elements, curves, _contact(values))


def _contact(values):
    return FrozenDict({name[8:]: q.value for name, q in values.items() if name.startswith("contact.")})


def _vehicle(layout, values, configuration, bodies, elements, curves, contact):
    return Vehicle(
        name=layout.name,
        description=layout.description,
        bodies=tuple(body for group in bodies.values() for body in group),
        elements=tuple(element for group in elements.values() for element in group),
        contact=contact,
        gravity=values["vehicle.gravity"].value,
        configurations=layout.configurations,
        configuration=configuration,
        curves=curves,
        parameters=Parameters(values),
        _layout=layout,
        _values=values,
        _body_groups=bodies,
        _element_groups=elements,
    )


def vehicles():
    """Names of the vehicles that come with railsym.

    Returns
    -------
    tuple of str
    """
    return tuple(sorted(path.stem for path in SHIPPED.glob("*.toml")))


def load_vehicle(name_or_path):
    """Load a shipped vehicle by name or any vehicle file by path.

    Parameters
    ----------
    name_or_path : str or pathlib.Path
        One of `vehicles`, or the path of a TOML file (docs/vehicle_file.md describes the format).

    Returns
    -------
    Vehicle
        As the file describes it, no configuration applied.

    Raises
    ------
    VehicleFileError
        If there is no such vehicle, or the file cannot be used: one error that names the file, the key, the value, what is
        allowed, and the nearest match.
    """
    if isinstance(name_or_path, str) and name_or_path in vehicles():
        path = SHIPPED / f"{name_or_path}.toml"
    else:
        path = Path(name_or_path)
        if not path.is_file():
            text = "no such file, and the name is " + unknown(str(name_or_path), vehicles(), "vehicles that come with railsym")
            raise vehicle_error(str(name_or_path), "vehicle", None, text)
    layout, values = read_vehicle_file(path)
    try:
        vehicle = _assemble(layout, values, None)
        _check_wheels(vehicle)
        for configuration in layout.configurations.values():
            vehicle._apply(configuration)
    except Problem as problem:
        raise vehicle_error(layout.file, _file_key(layout, problem.key), problem.value, problem.text) from None
    return vehicle


def _check_wheels(vehicle):
    """The wheels of every wheelset stand on the rails."""
    for body in vehicle.bodies:
        if body.kind == "wheelset" and abs(body.position[2] + body.wheel_radius) > _WHEEL_TOLERANCE:
            raise Problem(
                f"bodies.{body.group}.at.{body.name}", body.position,
                f"the wheels do not touch the rails: z must be minus the wheel radius, {-body.wheel_radius} m",
            )


def _file_key(layout, key):
    """Where a parameter stands in the file."""
    head = key.partition(".")[0]
    section = "bodies." if head in layout.bodies else "elements." if head in layout.elements else ""
    return section + key
