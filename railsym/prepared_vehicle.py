# SPDX-License-Identifier: BSD-3-Clause
"""A rolling vehicle that takes other numbers: of the tables, the preload and the matrices only what they change is computed anew."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from railsym.contact import LinearContact
from railsym.equilibrium import Statics, component_stiffness
from railsym.force_laws import law_record, slope_at_rest
from railsym.linear import RollingVehicle
from railsym.linear_model import LinearModel
from railsym.model import BUSHINGS, bushing_diagonals
from railsym.vehicle_schema import element_fields

# what may change of a body without moving an attachment or a wheel
_BODY_NUMBERS = ("mass", "inertia", "axlebox")


class PreparedVehicle:
    """Linear models of one vehicle with other parameters, one after another.

    A model depends on its own changes alone: whatever the changes before it touched is put back.

    Parameters
    ----------
    vehicle : Vehicle
    contact : LinearContact, optional
        Of the model from which those of the cases take what numbers do not change.

    Raises
    ------
    ModelError
        A vehicle without static equilibrium or without wheelsets.
    """

    def __init__(self, vehicle, contact=LinearContact()):
        self.vehicle = vehicle
        self._rolling = RollingVehicle(vehicle)
        self._model = self._rolling.model
        self._statics = Statics(self._model)
        self._stiffness = component_stiffness(self._model)
        self._nominal = self._rolling.linear_model(contact)
        self._load = self._weight()
        self._rows = _rows(self._model)
        self._dirty = set()     # groups of bodies and elements whose numbers in the tables are not those of the vehicle

    def linear_model(self, changes: Mapping[str, Any], contact: LinearContact) -> LinearModel:
        """Matrices of the vehicle with changes.

        Parameters
        ----------
        changes : mapping of str to number, array, Quantity or str
            By dotted name, as `Vehicle.replace`.
        contact : LinearContact
            What it leaves open comes from the vehicle.

        Raises
        ------
        VehicleFileError
            A parameter that does not exist or a value that is not permitted.
        ModelError, ContactError
            As `railsym.linear_model`.
        """
        vehicle = self.vehicle.replace(changes)
        if vehicle._layout is not self.vehicle._layout or not all(map(self._is_number, changes)):
            return RollingVehicle(vehicle).linear_model(contact)
        touched = {name.partition(".")[0] for name in changes} - {"contact"}
        self._fill_tables(vehicle, touched)
        return self._linear_model(vehicle, contact.resolved(vehicle.contact), not touched.isdisjoint(vehicle._body_groups))

    def _is_number(self, name):
        """Does a parameter neither move anything nor reshape a curve?"""
        head, key, *_ = *name.split("."), ""
        layout = self.vehicle._layout
        if head in layout.elements:
            return key != "lag" and key in element_fields(layout.elements[head].type, layout.elements[head].mode)  # a lag may make a state
        return key in _BODY_NUMBERS if head in layout.bodies else head == "contact"

    def _fill_tables(self, vehicle, touched):
        """Put the numbers of a vehicle into the tables of C."""
        stale, self._dirty = self._dirty | touched, self._dirty | touched
        for name in stale & vehicle._body_groups.keys():
            self._model.set_bodies(vehicle._body_groups[name])
        for name in stale & vehicle._element_groups.keys():
            self._fill_elements(vehicle._element_groups[name])
        self._dirty = touched

    def _fill_elements(self, elements):
        """Elements of one group have their numbers in common."""
        one, rows = elements[0], self._rows[elements[0].group]
        if one.type in BUSHINGS:
            stiffness, damping = bushing_diagonals([one])
            self._model.set_bushings(rows, stiffness, damping)
            self._stiffness[(6 * rows[:, None] + np.arange(6))] = stiffness
        else:
            self._model.set_laws(rows, law_record(one))
            self._stiffness[6 * len(self._model.bushings) + rows] = slope_at_rest(one)

    def _linear_model(self, vehicle, contact, bodies_touched):
        model, nominal = self._model, self._nominal
        mass, turning = nominal.mass, nominal.damping_speed
        load = self._load
        if bodies_touched:
            load = self._weight()
        preload = self._statics.preload(self._stiffness, load)
        rest = model.pencil((0.0, 1.0, 0.0))
        if bodies_touched:
            mass, turning = model.pencil((0.0, 0.0, 1.0)), model.pencil((0.0, 1.0, 0.0), u=model.rolling(1.0)) - rest
        stiffness, creep = self._rolling.wheel_rail(contact, preload.wheel_loads)
        stiffness += model.pencil((1.0, 0.0, 0.0), u=model.rolling(1.0))
        return LinearModel(nominal.coordinates, mass, stiffness, rest, turning, creep, nominal.first_order, nominal.cyclic,
                           vehicle, contact, template=self._nominal)

    def _weight(self):
        """Load of gravity on all coordinates, N and N m."""
        self._model.set_preload(np.zeros((len(self._model.bushings), 6)), np.zeros(len(self._model.laws)))
        return -self._model.residual()


def _rows(model):
    """Name of each group of elements -> its rows among the bushings or among the laws."""
    rows = {}
    for elements in (model.bushings, model.laws):
        for k, element in enumerate(elements):
            rows.setdefault(element.group, []).append(k)
    return {group: np.array(numbers) for group, numbers in rows.items()}
