# SPDX-License-Identifier: BSD-3-Clause
"""Inputs ``contact.*`` of analyses that roll on the linear contact."""

from __future__ import annotations

from railsym.contact import _UNITS, LinearContact
from railsym.sweep.space import Input

PREFIX = "contact."


def contact_inputs(vehicle, conicity):
    """Arguments of `LinearContact` as inputs, with what analysis and vehicle file give."""
    given = {"conicity": LinearContact().conicity if conicity is None else float(conicity)}
    return {PREFIX + name: Input(unit, given.get(name, vehicle.contact.get(name))) for name, unit in _UNITS.items()}


def contact_of(conicity, settings):
    """`LinearContact` of a case."""
    given = {} if conicity is None else {"conicity": conicity}
    return LinearContact(**given | {name[len(PREFIX):]: value for name, value in settings.items() if name.startswith(PREFIX)})
