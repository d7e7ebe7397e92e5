# SPDX-License-Identifier: BSD-3-Clause
"""Inputs ``contact.*`` of analyses that roll on the linear contact."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

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


def solver_by_contact(make, conicity):
    """Function from settings to a solver and a conicity.

    One solver serves all conicities; another one is made where anything else of the contact changes.

    Parameters
    ----------
    make : callable
        LinearContact to solver.
    conicity : float or None
        Of the analysis.
    """
    made = lru_cache(maxsize=1)(make)

    def of(settings):
        contact = contact_of(conicity, settings)
        return made(replace(contact, conicity=LinearContact.conicity)), contact.conicity

    return of
