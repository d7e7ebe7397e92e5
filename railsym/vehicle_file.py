# SPDX-License-Identifier: BSD-3-Clause
"""Strict reading of a vehicle file (TOML) into its layout and its numbers. The format is described in docs/vehicle_file.md."""

import re
import tomllib
from pathlib import Path

from railsym import vehicle_schema as schema
from railsym.configurations import Configuration
from railsym.units import UnitError, same_dimension, to_si
from railsym.vehicle_checks import Problem, checked_value, unknown, vehicle_error
from railsym.vehicle_layout import BodyGroup, ElementGroup, Instance, Layout, attachment_names
from railsym.vehicle_parts import TRACK, FrozenDict, Quantity

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_RESERVED = ("vehicle", "origins", "contact", "bodies", "curves", "elements", "configurations", TRACK)
_AXES = {"x": 0, "y": 1, "z": 2}
DEFAULT_ORIGIN = "default of the file format"


def read_vehicle_file(path):
    """Read and check a vehicle file.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    layout : railsym.vehicle_layout.Layout
    values : dict of str to Quantity
        Every number by its dotted name, SI.

    Raises
    ------
    VehicleFileError
        Naming file, key, value, what is allowed and the nearest match.
    """
    path = Path(path)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise vehicle_error(path.name, "TOML syntax", None, str(error)) from None
    except UnicodeDecodeError as error:
        raise vehicle_error(path.name, "text", None, f"not UTF-8: {error}") from None
    try:
        return _Reader(path.name, document).read()
    except Problem as problem:
        raise vehicle_error(path.name, problem.key, problem.value, problem.text) from None


class _Reader:
    """One pass over a parsed document; `values` and `origins` fill up on the way."""

    def __init__(self, file, document):
        self.file, self.document = file, document
        self.origins, self.values = {}, {}

    def read(self):
        top = self.table("", self.document, _RESERVED[:-1], required=("vehicle", "contact", "bodies"))
        self.read_origins(top.get("origins", {}))
        name, description = self.read_vehicle(top["vehicle"])
        self.read_fields("contact", top["contact"], schema.CONTACT_FIELDS, "contact.")
        bodies = self.read_groups("bodies", top, self.read_body_group)
        curves = tuple(self.read_groups("curves", top, self.read_curve))
        self.attachments, self.curve_names = attachment_names(bodies), curves
        elements = self.read_groups("elements", top, self.read_element_group)
        _check_namespace(bodies, elements)
        configurations = self.read_groups("configurations", top, self.read_configuration)
        return Layout(self.file, name, description, bodies, elements, curves, FrozenDict(configurations)), self.values

    # --- tables, texts and numbers -------------------------------------------------------------------------------------

    def table(self, key, table, allowed, required=()):
        """The table itself, if it holds nothing but `allowed` keys and all of `required`."""
        if not isinstance(table, dict):
            raise Problem(key, table, "a table is needed")
        prefix = f"{key}." if key else ""
        for name, value in table.items():
            if name not in allowed:
                raise Problem(
                    prefix + name, None if isinstance(value, dict) else value,
                    "key is " + unknown(name, allowed, "allowed keys"),
                )
        for name in required:
            if name not in table:
                raise Problem(prefix + name, None, f"is missing (needed keys: {', '.join(required)})")
        return table

    def text(self, key, value, allowed=None):
        """A string, one of `allowed` when given."""
        if not isinstance(value, str) or not value.strip():
            raise Problem(key, value, "a text is needed" + (f" (allowed: {', '.join(allowed)})" if allowed else ""))
        if allowed is not None and value not in allowed:
            raise Problem(key, value, unknown(value, allowed))
        return value

    def origin(self, key, name):
        """Citation of an origin key."""
        if not isinstance(name, str) or name not in self.origins:
            raise Problem(key, name, "origin is " + unknown(name, self.origins, "keys of [origins]"))
        return self.origins[name]

    def table_origin(self, key, table, inherited=None):
        """Default origin of the numbers in a table: its own, else that of the table around it."""
        return self.origin(f"{key}.origin", table["origin"]) if "origin" in table else inherited

    def quantity(self, key, entry, field, origin):
        """Quantity of ``[value, "unit"]`` or ``[value, "unit", "origin-key"]``."""
        number, unit, origin = self.split(key, entry, origin, field.unit)
        value = checked_value(key, number, schema.Field(field.unit, "any", field.shapes))
        try:
            value = checked_value(key, to_si(value, unit, field.unit), field)
        except UnitError as error:
            raise Problem(key, entry, str(error)) from None
        except Problem as problem:
            raise Problem(key, entry, problem.text) from None
        return Quantity(value, field.unit, origin)

    def split(self, key, entry, origin, example):
        """Value, unit and citation of an entry."""
        if not isinstance(entry, list) or len(entry) not in (2, 3) or not all(isinstance(t, str) for t in entry[1:]):
            raise Problem(
                key, entry,
                f'a number is written [value, "unit"] or [value, "unit", "origin-key"], here with a unit such as "{example}"',
            )
        if len(entry) == 3:
            origin = self.origin(key, entry[2])
        if origin is None:
            raise Problem(key, entry, 'no origin: add a key of [origins] as third entry, or origin = "..." to its table')
        return entry[0], entry[1], origin

    def read_fields(self, key, table, fields, prefix, extra=(), origin=None):
        """Read the numbers `fields` of a table; `extra` keys are somebody else's."""
        required = tuple(name for name, field in fields.items() if field.required)
        self.table(key, table, (*fields, "origin", *extra), required)
        origin = self.table_origin(key, table, origin)
        for name, field in fields.items():
            if name in table:
                self.values[prefix + name] = self.quantity(f"{key}.{name}", table[name], field, origin)
            elif field.default is not None:
                value = [field.default] * field.shapes[0][0] if field.shapes[0] else field.default
                self.values[prefix + name] = Quantity(checked_value(key, value, field), field.unit, DEFAULT_ORIGIN)
        return origin

    def read_groups(self, section, top, read):
        """Result of `read(key, name, table)` for each table of a section, by name."""
        groups = top.get(section, {})
        if not isinstance(groups, dict):
            raise Problem(section, groups, "a table of tables is needed")
        for name in groups:
            _check_name(f"{section}.{name}", name)
        return {name: read(f"{section}.{name}", name, table) for name, table in groups.items()}

    # --- sections ------------------------------------------------------------------------------------------------------

    def read_origins(self, table):
        if not isinstance(table, dict):
            raise Problem("origins", table, "a table of texts is needed")
        for name, text in table.items():
            self.origins[name] = self.text(f"origins.{name}", text)

    def read_vehicle(self, table):
        self.read_fields("vehicle", table, schema.VEHICLE_FIELDS, "vehicle.", extra=("name", "description"))
        return tuple(self.text(f"vehicle.{key}", table.get(key)) for key in ("name", "description"))

    def read_body_group(self, key, name, table):
        self.table(key, table, table if isinstance(table, dict) else (), ("kind", "at"))
        kind = self.text(f"{key}.kind", table["kind"], schema.BODY_FIELDS)
        extra = ("kind", "at", "axlebox") if kind == "wheelset" else ("kind", "at")
        origin = self.read_fields(key, table, schema.BODY_FIELDS[kind], f"{name}.", extra)
        if "axlebox" in table:
            self.read_fields(f"{key}.axlebox", table["axlebox"], schema.AXLEBOX_FIELDS, f"{name}.axlebox.", origin=origin)
        places = table["at"]
        if not isinstance(places, dict) or not places:
            raise Problem(f"{key}.at", places, 'a table is needed: name = [[x, y, z], "m"] for each body')
        origin = self.table_origin(f"{key}.at", places, origin)
        instances = tuple(instance for instance in places if instance != "origin")
        for instance in instances:
            self.read_place(f"{key}.at.{instance}", instance, places[instance], origin)
        return BodyGroup(name, kind, instances, "axlebox" in table)

    def read_place(self, key, instance, entry, origin):
        _check_name(key, instance)
        if f"{instance}.position" in self.values:
            raise Problem(key, entry, f"there is already a body {instance!r}; allowed is any other name")
        position = self.quantity(key, entry, schema.POSITION, origin)
        if position.value[2] > 0.0:
            raise Problem(
                key, entry,
                "the body lies below the track plane: z points down, so the z of a height above the rails is negative",
            )
        self.values[f"{instance}.position"] = position

    def read_curve(self, key, name, table):
        self.table(key, table, ("x", "y", "origin"), ("x", "y"))
        origin = self.table_origin(key, table)
        for column, units in (("x", ("m", "m/s")), ("y", ("N", "N/m"))):
            unit = self.curve_unit(f"{key}.{column}", table[column], units)
            field = schema.Field(unit, "finite", ((-1,),))
            self.values[f"{key}.{column}"] = self.quantity(f"{key}.{column}", table[column], field, origin)
        return name

    def curve_unit(self, key, entry, allowed):
        """SI unit of a curve's column."""
        _, unit, _ = self.split(key, entry, "checked later", allowed[0])
        try:
            fitting = [si for si in allowed if same_dimension(unit, si)]
        except UnitError as error:
            raise Problem(key, entry, str(error)) from None
        if not fitting:
            raise Problem(
                key, entry,
                f"unit {unit!r} has the wrong dimension: allowed are {' or '.join(allowed)} and others of the same dimension",
            )
        return fitting[0]

    def read_element_group(self, key, name, table):
        self.table(key, table, table if isinstance(table, dict) else (), ("type", "at"))
        type_name = self.text(f"{key}.type", table["type"], schema.ELEMENT_TYPES)
        kind = schema.ELEMENT_TYPES[type_name]
        extra = ["type", "at", *(c.key for c in kind.curves)]
        extra += ["axis"] if kind.axis in ("optional", "required") else []
        extra += ["mode"] if kind.modes else []
        self.table(key, table, (*kind.fields, "orientation", "origin", *extra))
        axis = self.read_axis(key, table, kind)
        mode = self.text(f"{key}.mode", table.get("mode"), kind.modes) if kind.modes else None
        curves = {c.key: self.text(f"{key}.{c.key}", table[c.key], self.curve_names) for c in kind.curves if c.key in table}
        fields = self.chosen_fields(key, table, kind, mode, curves)
        origin = self.read_fields(key, table, fields | {"orientation": schema.ORIENTATION}, f"{name}.", extra)
        instances = self.read_instances(key, name, table["at"], origin)
        return ElementGroup(name, type_name, axis, mode, curves, instances)

    def read_axis(self, key, table, kind):
        if "axis" in table and kind.axis in ("optional", "required"):
            return _AXES[self.text(f"{key}.axis", table["axis"], _AXES)]
        if kind.axis == "required":
            raise Problem(f"{key}.axis", None, "is missing; allowed: x, y, z")
        return None

    def chosen_fields(self, key, table, kind, mode, curves):
        """Fields left to read as numbers; a curve and the numbers it replaces exclude each other."""
        fields = dict(schema.element_fields(table["type"], mode))
        for choice in kind.curves:
            if choice.key in curves:
                for number in choice.numbers:
                    if number in table:
                        raise Problem(
                            f"{key}.{number}", table[number],
                            f"stands beside {choice.key!r}, which replaces it: give one of the two",
                        )
                    del fields[number]
            elif not any(number in table for number in choice.numbers):
                raise Problem(
                    f"{key}.{choice.numbers[0]}", None, f"is missing: give {' and '.join(choice.numbers)}, or {choice.key}"
                )
        return fields

    def read_instances(self, key, group, entries, origin):
        if not isinstance(entries, list) or not entries:
            raise Problem(f"{key}.at", entries, "a list of tables { name, first, second, position } is needed")
        instances = []
        for number, entry in enumerate(entries):
            where = f"{key}.at[{number}]"
            instance = self.read_instance(where, group, entry, origin)
            if instance.name in (other.name for other in instances):
                raise Problem(
                    f"{where}.name", instance.name, f"there is already an element of this name in {key}; allowed is any other"
                )
            instances.append(instance)
        return tuple(instances)

    def read_instance(self, where, group, entry, origin):
        self.table(
            where, entry,
            ("name", "first", "second", "position", "first_position", "second_position", "origin"),
            ("name", "first", "second"),
        )
        name = self.text(f"{where}.name", entry["name"])
        _check_name(f"{where}.name", name)
        first, second = (self.text(f"{where}.{end}", entry[end], self.attachments) for end in ("first", "second"))
        if first == second:
            raise Problem(
                f"{where}.second", second, "the element joins a body to itself; allowed is any attachment other than its first"
            )
        one_point = "position" in entry
        if one_point == ("first_position" in entry) or one_point == ("second_position" in entry):
            raise Problem(
                f"{where}.position", entry.get("position"), "give either position, or both first_position and second_position"
            )
        origin = self.table_origin(where, entry, origin)
        for end in ("position",) if one_point else ("first_position", "second_position"):
            self.values[f"{group}.{name}.{end}"] = self.quantity(f"{where}.{end}", entry[end], schema.POSITION, origin)
        return Instance(name, first, second, one_point)

    def read_configuration(self, key, name, table):
        self.table(key, table, ("description", "remove", "viscous", "set", "origin"), ("description",))
        lists = {}
        for part in ("remove", "viscous"):
            entries = table.get(part, [])
            if not isinstance(entries, list):
                raise Problem(f"{key}.{part}", entries, "a list of names is needed")
            lists[part] = tuple(self.text(f"{key}.{part}", entry) for entry in entries)
        changes, origin = table.get("set", {}), self.table_origin(key, table)
        if not isinstance(changes, dict):
            raise Problem(f"{key}.set", changes, 'a table is needed: { "dotted.name" = [value, "unit", "origin-key"] }')
        set_ = {dotted: self.read_change(f"{key}.set.{dotted}", entry, origin) for dotted, entry in changes.items()}
        return Configuration(name, self.text(f"{key}.description", table["description"]), **lists, set=FrozenDict(set_))

    def read_change(self, key, entry, origin):
        """New value of a configuration: the name of a curve, or a quantity still in the unit of the file."""
        if isinstance(entry, str):
            return self.text(key, entry, self.curve_names)
        if isinstance(entry, dict):
            raise Problem(key, None, 'a dotted name must be quoted: "group.parameter" = [value, "unit", "origin-key"]')
        number, unit, origin = self.split(key, entry, origin, "-")
        return Quantity(checked_value(key, number, schema.Field(unit, "any", ((), (3,), (6,), (-1,)))), unit, origin)


def _check_name(key, name):
    if not _NAME.fullmatch(name):
        raise Problem(key, name, "a name holds letters, digits and _ and starts with a letter")
    if name in _RESERVED:
        raise Problem(key, name, f"the name is reserved; allowed is any name but {', '.join(_RESERVED)}")


def _check_namespace(bodies, elements):
    """Bodies, groups of bodies and groups of elements share one set of names."""
    owner = {}
    for group in bodies.values():
        for name in group.instances:
            owner[name] = f"the body bodies.{group.name}.at.{name}"
    for group in bodies.values():
        if group.name in owner and group.instances != (group.name,):
            raise Problem(
                f"bodies.{group.name}", None, f"the name is already that of {owner[group.name]}; allowed is any other"
            )
        owner[group.name] = f"bodies.{group.name}"
    for name in elements:
        if name in owner:
            raise Problem(f"elements.{name}", None, f"the name is already that of {owner[name]}; allowed is any other")
