# SPDX-License-Identifier: BSD-3-Clause
"""What a controller in Python sees of a vehicle in motion, and what it may set."""

from __future__ import annotations

import numpy as np

from railsym import _core
from railsym.errors import SimulationError
from railsym.vehicle_checks import unknown


class Controls:
    """What a controller sees and may set.

    Attributes
    ----------
    time : float
        s
    """

    def __init__(self, simulation):
        self._run, self._parts = simulation, simulation.parts
        self._state = self._looked = None
        self._bodies = self._parts.model.body_instances()
        self._actuators = _actuators(self._parts.model)

    @property
    def simulation(self):
        """The `Simulation` that is controlled."""
        return self._run

    @property
    def time(self):
        """s"""
        return self._run.time

    def _value(self, row, name):
        return float(self._all()[row][self._parts.number(name, "controller")])

    def _all(self):
        """q, u, a at the present time."""
        if self._state is None or self._state[0] != self.time:
            self._state = self.time, self._parts.integrator.state()
        return self._state[1]

    def position(self, name):
        """A coordinate, such as ``"car.roll"``, m or rad."""
        return self._value(0, name)

    def rate(self, name):
        """Its rate."""
        return self._value(1, name)

    def acceleration(self, name):
        """Its second derivative in the track frame."""
        return self._value(2, name)

    def command(self, element, value):
        """Set the command of an actuator, N or m, until it is set again.

        Raises
        ------
        SimulationError
            An element that does not exist or takes no command.
        """
        table, number = self._actuator(element, "command")
        if not np.isfinite(value):
            raise SimulationError(f"command of {element!r} is {value}; a finite number (N or m) is needed")
        table.set_command(number, float(value))

    def fault(self, element, kind):
        """Let an actuator fail from now on; what, when, and its length (m) and force (N) then stand in the run's ``info.extra["faults"]``.

        Parameters
        ----------
        element : str
        kind : str
            ``"stuck"``: it keeps the length (mode "length") or thrust that it followed last, and yields above its force limit;
            ``"free"``: it gives no force; ``"damped"``: its bypass damping alone; ``"none"``: it works again.

        Raises
        ------
        SimulationError
            Another kind, an element that is no actuator, or one without a lag that is to be stuck at what it follows.
        """
        table, number = self.check_fault(element, kind)
        self._run.faults.append({"time": self.time, "element": element, "fault": kind, "length": self.length(element),
                                 "force": self.actuator_force(element)})
        table.set_fault(number, kind)
        self._state = self._looked = None
        if self._parts.integrator.restart():
            raise SimulationError(f"fault of {element!r} at t = {self.time:.6g} s: the run cannot go on from there")

    def check_fault(self, element, kind):
        """Table of laws and number in it of an actuator that can fail so; raises as `fault`."""
        table, number = self._actuator(element, "fault")
        if kind not in _core.FAULTS:
            raise SimulationError(f"fault of {element!r}: {kind!r} is {unknown(kind, _core.FAULTS, 'faults')}")
        if kind == "stuck" and not table.lags(number):
            raise SimulationError(f"fault of {element!r}: an actuator without a lag follows its command at once and has nothing to be stuck at; "
                                  "give it a lag (s) in the vehicle file, or command what it is to hold")
        return table, number

    def length(self, element):
        """By how much an actuator is longer than at the design position, m."""
        return self._seen(element, "length")

    def length_rate(self, element):
        """Rate of an actuator's length, m/s."""
        return self._seen(element, "rate")

    def actuator_force(self, element):
        """Force of an actuator, N; positive pulls its ends together."""
        return self._seen(element, "force")

    def _seen(self, element, what):
        table, number = self._actuator(element, what)
        if self._looked != self.time:
            self._parts.integrator.look()
            self._looked = self.time
        return float(table.seen(number)[_core.SEEN[what]])

    def _actuator(self, element, what):
        """Table of laws and number in it of an actuator."""
        if element not in self._actuators:
            raise SimulationError(f"{what} of {element!r}: actuators of this vehicle are {', '.join(self._actuators) or 'none'}")
        return self._actuators[element]

    def imu(self, body, position=None):
        """What an inertial measurement unit on a body feels.

        Parameters
        ----------
        body : str
        position : array_like, shape (3,), optional
            m, vehicle coordinates at the design position; the body's centre of mass without it.

        Returns
        -------
        force : ndarray, shape (3,)
            m/s^2, specific force, axes of the body: acceleration less gravity, so that at rest it is (0, 0, -g).
        turning : ndarray, shape (3,)
            rad/s, angular velocity against the inertial frame, axes of the body.

        Raises
        ------
        SimulationError
            A body that does not exist.
        """
        if body not in self._bodies:
            raise SimulationError(f"imu on {body!r}: {unknown(body, self._bodies, 'bodies')}")
        kernel, instance, centre = self._bodies[body]
        point = centre if position is None else np.asarray(position, dtype=float)
        if point.shape != (3,) or not point @ point < np.inf:
            raise SimulationError(f"imu on {body!r}: position {position} must be three finite numbers (m), in vehicle coordinates")
        felt = np.empty(6)
        if self._parts.integrator.inertial(kernel, instance, point - centre, felt):
            raise SimulationError(f"imu on {body!r}: at t = {self.time:.6g} s the body is beyond the end of the track")
        return felt[:3], felt[3:]

    def force(self, coordinate, value):
        """Set the generalised force (N or N m) applied to a coordinate, until it is set again."""
        self._parts.integrator.force[self._parts.number(coordinate, "controller")] = float(value)


def _actuators(model):
    """Name of each actuator -> its table of laws and its number there."""
    lines = sum(element.axis is None for element in model.laws)
    places = ((element, "line" if k < lines else "axis", k if k < lines else k - lines) for k, element in enumerate(model.laws))
    return {element.name: (model._law_tables[table], number) for element, table, number in places if element.type == "actuator"}
