# SPDX-License-Identifier: BSD-3-Clause
"""Linear equations of a vehicle rolling on straight level track.

The kernels' pencil about the preloaded design position, wheelsets spinning at -V/r0, gives
stiffness (with the preload's geometric part), damping and mass. On straight track
C(V) = C0 + V C1 + C2/V holds exactly: C0 is the elements', V C1 the gyroscopic moments of
the wheelsets, C2/V the creep forces, because creepages are velocities over V. So the three
are taken one by one, and only the wheel-rail part is computed anew for another contact.
"""

from dataclasses import replace
from functools import cached_property, lru_cache

import numpy as np

from railsym import _core
from railsym.contact import LinearContact
from railsym.equilibrium import static_preload
from railsym.errors import ModelError
from railsym.linear_model import Linearisation, LinearModel
from railsym.model import Model, input_table, set_wheels

# vehicles that stay assembled: a rolling vehicle holds its vehicle, so weak keys would keep all of them, a megabyte each
_KEPT = 16


class RollingVehicle:
    """A preloaded model on straight level track, ready to take contact parameters.

    Attributes
    ----------
    model : Model
    preload : Preload
    """

    def __init__(self, vehicle):
        self.model = Model(vehicle)
        if not self.model.wheels:
            raise ModelError(f"vehicle {vehicle.name!r} has no wheelset, so nothing rolls; add a body of kind 'wheelset'")
        self.preload = static_preload(self.model)
        self._contact = None
        bodies, sides = zip(*self.model.wheels, strict=True)
        self._wheels = {
            "load": self.preload.wheel_loads,
            "wheel_radius": np.array([b.wheel_radius for b in bodies]),
            "contact_half_spacing": np.array([b.contact_half_spacing for b in bodies]),
            "side": np.array(sides),
        }

    def contacts(self, contact, wheel_loads=None):
        """WheelContacts of a resolved LinearContact, at the static wheel loads unless others are given (N)."""
        loads = {} if wheel_loads is None else {"load": wheel_loads}
        return contact.wheels(**(self._wheels | loads))

    @cached_property
    def _structure(self):
        """LinearModel of bodies and elements; gyroscopic moments at 1 m/s are C1."""
        model, topo = self.model, self.model.topology
        rest = model.pencil((0.0, 1.0, 0.0))
        turning = model.pencil((0.0, 1.0, 0.0), u=model.rolling(1.0))
        return LinearModel(
            coordinates=topo.coordinates,
            mass=model.pencil((0.0, 0.0, 1.0)),
            stiffness=model.pencil((1.0, 0.0, 0.0), u=model.rolling(1.0)),
            damping_constant=rest,
            damping_speed=turning - rest,
            damping_inverse_speed=np.zeros_like(rest),
            first_order=topo.first_order,
            cyclic=topo.cyclic,
            vehicle=model.vehicle,
        )

    def wheel_rail(self, contact, wheel_loads=None):
        """K and C2 of the wheel-rail contact: creep forces at 1 m/s are C2; arguments as `contacts`."""
        contacts = self.contacts(contact, wheel_loads)
        if self._contact is None:
            self._contact = _core.Assembly(self.model.topology.is_angle)
            columns, index = self.model.wheel_rows(contacts)
            self._contact.add("wheel_rail", input_table("wheel_rail", columns, len(index)), index)
        set_wheels(self._contact, contacts)
        rest = np.zeros(self.model.size)
        rolling = self.model.rolling(1.0)
        return [self._contact.pencil(rest, rolling, rest, seed) for seed in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))]

    def linear_model(self, contact):
        """Matrices for a contact; what is not given comes from the vehicle file."""
        contact = contact.resolved(self.model.vehicle.contact)
        stiffness, with_inverse = self.wheel_rail(contact)
        structure = self._structure
        stiffness += structure.stiffness
        return replace(structure, stiffness=stiffness, damping_inverse_speed=with_inverse, contact=contact, base=structure)


@lru_cache(maxsize=_KEPT)
def rolling_vehicle(vehicle):
    """The RollingVehicle of a vehicle, built once for the vehicles used last."""
    return RollingVehicle(vehicle)


def linear_model(vehicle, contact=None):
    """Linear equations of a vehicle on straight level track, for any speed.

    Parameters
    ----------
    vehicle : Vehicle
    contact : LinearContact, optional
        What it leaves open comes from the vehicle file.

    Returns
    -------
    LinearModel

    Raises
    ------
    ModelError
        A vehicle without static equilibrium or without wheelsets.
    ContactError
        Contact parameters outside the theory.
    """
    return rolling_vehicle(vehicle).linear_model(contact or LinearContact())


def linearise(vehicle, speed, contact=None):
    """State matrix of a vehicle rolling at constant speed on straight level track.

    Parameters
    ----------
    vehicle : Vehicle
    speed : float
        m/s, above 0.
    contact : LinearContact, optional

    Returns
    -------
    Linearisation
        ``.A`` (ns, ns), ``.states``, ``.speed`` and ``.modes()``.

    Raises
    ------
    ModelError, ContactError
        As `linear_model`; also a speed that is not above 0.
    """
    return Linearisation.of(linear_model(vehicle, contact), speed)
