# SPDX-License-Identifier: BSD-3-Clause
"""Named configurations of a vehicle: elements removed, Maxwell dampers made viscous, parameters set."""

from dataclasses import dataclass, field, replace

from railsym.vehicle_checks import Problem, unknown
from railsym.vehicle_parts import FrozenDict


@dataclass(frozen=True, eq=False, slots=True)
class Configuration:
    """A small set of changes to a vehicle.

    Attributes
    ----------
    name, description : str
    remove : tuple of str
        Element groups ("group") and single elements ("group.instance") left out.
    viscous : tuple of str
        Groups of Maxwell elements that become dampers with the same damping.
    set : dict of str to Quantity or str
        New values by dotted parameter name; a str names a curve.
    """

    name: str
    description: str
    remove: tuple = ()
    viscous: tuple = ()
    set: FrozenDict = field(default_factory=FrozenDict)


def apply_structure(configuration, layout, values):
    """Layout and parameters with the removals and the viscous dampers of a configuration (not its `set`).

    Parameters
    ----------
    configuration : Configuration
    layout : Layout
    values : dict of str to Quantity

    Returns
    -------
    Layout, dict

    Raises
    ------
    Problem
        If a group or an element does not exist, or a group to be viscous holds no Maxwell elements.
    """
    groups, values = dict(layout.elements), dict(values)
    for name in configuration.viscous:
        _make_viscous(f"configurations.{configuration.name}.viscous", name, groups, values)
    for name in configuration.remove:
        _remove(f"configurations.{configuration.name}.remove", name, groups, values)
    return replace(layout, elements=groups), values


def _remove(key, name, groups, values):
    """Take one group or one element out of `groups` and its numbers out of `values`."""
    group_name, _, instance_name = name.partition(".")
    group = groups.get(group_name)
    if group is None or (instance_name and instance_name not in (i.name for i in group.instances)):
        names = [*groups, *(f"{g.name}.{i.name}" for g in groups.values() for i in g.instances)]
        raise Problem(key, name, unknown(name, names, "elements"))
    kept = tuple(i for i in group.instances if instance_name and i.name != instance_name)
    if kept:
        groups[group_name] = replace(group, instances=kept)
        prefix = f"{group_name}.{instance_name}."
    else:
        del groups[group_name]
        prefix = f"{group_name}."
    for dotted in [dotted for dotted in values if dotted.startswith(prefix)]:
        del values[dotted]


def _make_viscous(key, name, groups, values):
    """Turn one group of Maxwell elements into dampers: the series stiffness goes, the damping stays."""
    group = groups.get(name)
    maxwell = [g.name for g in groups.values() if g.type == "maxwell"]
    if group is None:
        raise Problem(key, name, unknown(name, maxwell, "groups of Maxwell elements"))
    if group.type != "maxwell":
        raise Problem(
            key, name, f"holds elements of type {group.type!r}; allowed are groups of type 'maxwell': {', '.join(maxwell)}"
        )
    curves = {"curve": group.curves["damping_curve"]} if "damping_curve" in group.curves else {}
    groups[name] = replace(group, type="damper", curves=curves)
    values.pop(f"{name}.series_stiffness", None)
