# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of a vehicle by dotted name: looking them up and changing them."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from railsym.units import UnitError, to_si
from railsym.vehicle_checks import Problem, checked_value, numeric, unknown
from railsym.vehicle_layout import field_of
from railsym.vehicle_parts import Quantity
from railsym.vehicle_schema import ELEMENT_TYPES, Field, element_fields

REPLACED_ORIGIN = "set by Vehicle.replace"


class Parameters(Mapping):
    """Every number of a vehicle by dotted name; SI, read-only.

    Iteration gives whole quantities (``"car.inertia"``); a single component can be looked up too (``"car.inertia.0"``), and
    `components` lists every single number.
    """

    __slots__ = ("_values",)

    def __init__(self, values):
        self._values = values

    def __getitem__(self, name):
        if name in self._values:
            return self._values[name]
        base, index = split_component(name, self._values)
        if base is None:
            raise KeyError(f"parameter {name!r} is {unknown(name, self._values, 'parameters')}")
        quantity = self._values[base]
        return Quantity(float(quantity.value[index]), quantity.unit, quantity.origin)

    def __contains__(self, name):
        return name in self._values or split_component(name, self._values)[0] is not None

    def __iter__(self):
        return iter(self._values)

    def __len__(self):
        return len(self._values)

    def components(self):
        """Every single number.

        Returns
        -------
        dict of str to float
            Dotted name, with the index appended for components of arrays, to value (SI).
        """
        flat = {}
        for name, quantity in self._values.items():
            if isinstance(quantity.value, float):
                flat[name] = quantity.value
            else:
                flat.update((f"{name}.{i}", float(v)) for i, v in enumerate(quantity.value))
        return flat


def split_component(name, values):
    """Split ``"car.inertia.0"`` into the name of the array and the index.

    Returns
    -------
    tuple
        (name, index), or (None, None) when there is no such component.
    """
    base, _, index = name.rpartition(".")
    if base in values and index.isdecimal():
        value = values[base].value
        if isinstance(value, np.ndarray) and int(index) < value.size:
            return base, int(index)
    return None, None


def changed(layout, values, changes):
    """Layout and numbers after changes by dotted name.

    Parameters
    ----------
    layout : Layout
    values : dict of str to Quantity
    changes : mapping of str to number, array, Quantity or str
        Numbers are SI; a str is the name of a curve of the file. A curve drops the number it replaces, and the other way round.

    Returns
    -------
    layout : Layout
    values : dict
    touched : set of str
        First parts of the changed names.

    Raises
    ------
    Problem
    """
    values, touched = dict(values), set()
    for name, new in changes.items():
        touched.add(name.partition(".")[0])
        if isinstance(new, str):
            layout = _select_curve(layout, values, name, new)
        elif name in values:
            values[name] = _new_quantity(layout, values, name, new)
        else:
            layout = _set_absent(layout, values, name, new)
    for head in touched:
        if head in layout.elements:
            _check_complete(layout.elements[head], values)
    return layout, values, touched


def _new_quantity(layout, values, name, new):
    """Checked quantity for a parameter that is, or could be, in `values`."""
    field = Field(values[name].unit, "finite", ((-1,),)) if name.startswith("curves.") else field_of(layout, name)
    origin = REPLACED_ORIGIN
    if isinstance(new, Quantity):
        try:
            new, origin = to_si(numeric(name, new.value), new.unit, field.unit), new.origin
        except UnitError as error:
            raise Problem(name, new.value, str(error)) from None
    return Quantity(checked_value(name, new, field), field.unit, origin)


def _set_absent(layout, values, name, new):
    """Set a component of an array, or a number that the vehicle does not hold at present but may."""
    base, index = split_component(name, values)
    if base is not None:
        _set_component(values, name, base, index, new)
        values[base] = _new_quantity(layout, values, base, values[base])
        return layout
    if field_of(layout, name) is None:
        raise Problem(name, None, "parameter is " + unknown(name, values, "parameters"))
    values[name] = _new_quantity(layout, values, name, new)
    return _drop_curve(layout, *name.split(".")) if name.count(".") == 1 else layout


def _set_component(values, name, base, index, new):
    old = values[base]
    scalar = Field(old.unit, "any")
    if isinstance(new, Quantity):
        try:
            new = to_si(numeric(name, new.value), new.unit, old.unit)
        except UnitError as error:
            raise Problem(name, new.value, str(error)) from None
    array = np.array(old.value)
    array[index] = checked_value(name, new, scalar)
    values[base] = Quantity(array, old.unit, f"{old.origin}; component {index} {REPLACED_ORIGIN}")


def _drop_curve(layout, group_name, number):
    """The layout without the curve that stood in for `number`."""
    group = layout.elements.get(group_name)
    if group is None:
        return layout
    dropped = [c.key for c in ELEMENT_TYPES[group.type].curves if number in c.numbers]
    curves = {key: curve for key, curve in group.curves.items() if key not in dropped}
    return replace(layout, elements=layout.elements | {group_name: replace(group, curves=curves)})


def _select_curve(layout, values, name, curve):
    """Let an element group use a curve of the file in place of its numbers."""
    head, _, key = name.partition(".")
    group = layout.elements.get(head)
    choices = {} if group is None else {c.key: c for c in ELEMENT_TYPES[group.type].curves}
    if key not in choices:
        names = [f"{g.name}.{c.key}" for g in layout.elements.values() for c in ELEMENT_TYPES[g.type].curves]
        raise Problem(
            name, curve,
            "a text selects a curve, and this parameter takes none: " + unknown(name, names, "parameters that take a curve"),
        )
    if curve not in layout.curves:
        raise Problem(name, curve, "curve is " + unknown(curve, layout.curves, "curves of the file"))
    for number in choices[key].numbers:
        values.pop(f"{head}.{number}", None)
    return replace(layout, elements=layout.elements | {head: replace(group, curves=group.curves | {key: curve})})


def _check_complete(group, values):
    """Every number of a group is there, or a curve in its place."""
    replaced = {n for c in ELEMENT_TYPES[group.type].curves if c.key in group.curves for n in c.numbers}
    for number in element_fields(group.type, group.mode):
        if number not in replaced and f"{group.name}.{number}" not in values:
            raise Problem(
                f"{group.name}.{number}", None, f"is missing: without the curve, elements of type {group.type!r} need it too"
            )
