# SPDX-License-Identifier: BSD-3-Clause
"""Linear equations of a vehicle rolling on straight level track.

The kernels' pencil about the preloaded design position, wheelsets spinning at -V/r0, gives
stiffness (with the preload's geometric part), damping and mass. On straight track
C(V) = C0 + V C1 + C2/V holds exactly: gyroscopic moments grow with V, creepages are
velocities over V. Three speeds give the three matrices.
"""

from weakref import WeakKeyDictionary

import numpy as np

from railsym.contact import LinearContact
from railsym.equilibrium import static_preload
from railsym.errors import ModelError
from railsym.linear_model import Linearisation, LinearModel
from railsym.model import Model

# Speeds (m/s) that the three damping matrices are separated at: a decade apart, so that
# the 3 x 3 solution loses no more than one digit.
_SPEEDS = np.array([4.0, 20.0, 100.0])

_rolling_vehicles = WeakKeyDictionary()


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
        bodies, sides = zip(*self.model.wheels, strict=True)
        self._wheels = {
            "load": self.preload.wheel_loads,
            "wheel_radius": np.array([b.wheel_radius for b in bodies]),
            "contact_half_spacing": np.array([b.contact_half_spacing for b in bodies]),
            "side": np.array(sides),
        }

    def contacts(self, contact):
        """WheelContacts of a resolved LinearContact at the static wheel loads."""
        return contact.wheels(**self._wheels)

    def linear_model(self, contact):
        """Matrices for a contact; the model's state is the rest state before and after."""
        model, vehicle = self.model, self.model.vehicle
        contact = contact.resolved(vehicle.contact)
        model.add_wheels(self.contacts(contact))
        damping = [self._pencil((0.0, 1.0, 0.0), speed) for speed in _SPEEDS]
        constant, with_speed, with_inverse = _separate(damping)
        stiffness = self._pencil((1.0, 0.0, 0.0), _SPEEDS[1])
        topo = model.topology
        return LinearModel(
            coordinates=topo.coordinates,
            mass=self._pencil((0.0, 0.0, 1.0), _SPEEDS[1]),
            stiffness=stiffness,
            damping_constant=constant,
            damping_speed=with_speed,
            damping_inverse_speed=with_inverse,
            first_order=topo.first_order,
            cyclic=topo.cyclic,
            vehicle=vehicle,
            contact=contact,
        )

    def _pencil(self, seed, speed):
        self.model.set_speed(speed)
        return self.model.pencil(seed, u=self.model.rolling(speed))


def _separate(damping):
    """C0, C1, C2 of C(V) = C0 + V C1 + C2/V from C at the three speeds.

    Entries that do not change with speed are kept to the bit; roundoff below 1e-13 of an
    entry is no dependence on speed.
    """
    inverse = np.linalg.inv(np.column_stack([np.ones(3), _SPEEDS, 1.0 / _SPEEDS]))
    stack = np.stack(damping)
    parts = np.tensordot(inverse, stack, axes=1)
    change = np.ptp(stack, axis=0)
    fixed = change <= 1e-13 * np.abs(stack).max(axis=0)
    parts[0][fixed], parts[1][fixed], parts[2][fixed] = stack[1][fixed], 0.0, 0.0
    scale = np.abs(stack).max(axis=0)
    for part, weight in zip(parts, (1.0, _SPEEDS[-1], 1.0 / _SPEEDS[0]), strict=True):
        part[np.abs(part) * weight < 1e-13 * scale] = 0.0
    return parts


def rolling_vehicle(vehicle):
    """The RollingVehicle of a vehicle, built once as long as the vehicle lives."""
    known = _rolling_vehicles.get(vehicle)
    if known is None:
        known = _rolling_vehicles[vehicle] = RollingVehicle(vehicle)
    return known


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
