# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle rolling at constant speed on straight level track, as a dynamical system with the speed as its parameter.

The state z holds positions (without the wheelsets' spin angles, which act on nothing), rates of all second-order coordinates and
elongations of the internal (Maxwell) ones: the states of `railsym.linear_model`. The drive is "held": a place along the track is
then no free motion and has no eigenvalue zero, and creep that brakes is answered by the drive.
"""

from __future__ import annotations

import numpy as np

from railsym._core_integrator import Travel
from railsym.errors import ConvergenceError, CoreError, SimulationError
from railsym.linear_model import LinearModel
from railsym.simulation.assembled import Assembled
from railsym.simulation.failure import ending_of
from railsym.simulation.quasi_static import Balance
from railsym.simulation.speed import SpeedProfile

RHO = 0.9
TOLERANCE = 1e-7   # m/s^2: derivatives of a flow are differences of it, and errors of the iteration are noise in them


class FlowError(ConvergenceError):
    """A motion that could not be followed: a wheel left its contact table, or a step did not converge."""


class RollingSystem:
    """Flow and rolling equilibrium of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle
    contact : WheelRail, contact table, ConicalContact or ContactPair
    dt : float
        s
    rho, tolerance : float
        Of the generalised-alpha scheme; m/s^2.
    forces : dict
        Arguments of WheelRail: law, grid, friction, ...

    Attributes
    ----------
    size : int
        Number of states.
    names : tuple of str
        Of the states.
    wheelsets : tuple of str
    lateral : ndarray of int (wheelsets,)
        Places of the wheelsets' lateral displacements in the state.
    """

    def __init__(self, vehicle, contact, dt=1e-3, rho=RHO, tolerance=TOLERANCE, **forces):
        from railsym.contact import LinearContact

        if contact is None or isinstance(contact, LinearContact):
            raise SimulationError("a limit cycle needs wheel-rail forces that are not linear: give contact= a ContactPair, a contact table or a ConicalContact")
        if not 0.0 < dt < np.inf:
            raise SimulationError(f"dt = {dt!r}: a number above 0 s is needed")
        self.vehicle, self.dt = vehicle, float(dt)
        self.parts = Assembled(vehicle, contact, None, SpeedProfile.of(1.0, 0.0), dt, rho, tolerance, "held", forces)
        topology = self.parts.model.topology
        first, self.cyclic = topology.first_order, topology.cyclic
        self._position = np.flatnonzero(~first & ~self.cyclic)
        self._second, self._first = np.flatnonzero(~first), np.flatnonzero(first)
        self.size = len(self._position) + len(self._second) + len(self._first)
        coordinates = topology.coordinates
        self.names = (*(coordinates[k] for k in self._position), *(coordinates[k] + ".rate" for k in self._second),
                      *(coordinates[k] for k in self._first))
        self.wheelsets = tuple(body.name for body in vehicle.bodies if body.kind == "wheelset")
        self.lateral = np.array([self.names.index(f"{name}.y") for name in self.wheelsets])
        self.lateral_rate = np.array([self.names.index(f"{name}.y.rate") for name in self.wheelsets])
        self._spins = np.array([self.names.index(f"{name}.spin.rate") for name in self.wheelsets])
        self._balance = Balance(self.parts)
        self.parts.integrator.set_channels([("position", coordinates.index(f"{name}.y"), 0, 0) for name in self.wheelsets])
        self.speed = None
        self.integrations = self.steps = 0

    def set_speed(self, speed):
        """Roll at ``speed`` (m/s, above 0)."""
        speed = float(speed)
        if speed == self.speed:
            return
        parts = self.parts
        parts.speed = SpeedProfile.of(speed, 0.0)
        parts.model.set_speed(speed)
        travel = Travel(None, parts.frames, parts.speed.pieces, self.vehicle.gravity)
        by_start = {parts.model.topology.start[name]: frame for name, frame in parts.frame_of.items()}
        travel.add_wheelsets([by_start[place.first] for place in parts.wheels.wheelsets])
        parts.integrator.set_travel(travel)
        self.speed = speed

    def coordinates_of(self, z):
        """q and u (n,) of a state."""
        q, u = np.zeros(self.parts.model.size), np.zeros(self.parts.model.size)
        ends = np.cumsum([len(self._position), len(self._second)])
        q[self._position], u[self._second], q[self._first] = np.split(z, ends)
        return q, u

    def state_of(self, q, u):
        """The state of q and u (n,)."""
        return np.concatenate([q[self._position], u[self._second], q[self._first]])

    def faster(self, z, speed):
        """The state for another speed: wheelsets turn in proportion. Sets the speed."""
        z = z.copy()
        if self.speed is not None:
            z[self._spins] *= speed / self.speed
        self.set_speed(speed)
        return z

    def start(self, z):
        """Begin at a state."""
        status = self.parts.integrator.start(0.0, *self.coordinates_of(z))
        if status:
            raise FlowError(f"at {self.speed:.6g} m/s: {ending_of(self.parts, status)}")

    def slope(self, z):
        """dz/dt at a state."""
        self.start(z)
        _, u, a = self.parts.integrator.state()
        return np.concatenate([u[self._position], a[self._second], u[self._first]])

    def run(self, steps, every=None):
        """Go on for ``steps`` steps; returns the state and the lateral displacements (samples, wheelsets)."""
        every = steps if every is None else every
        samples = np.empty((steps // every + 1, len(self.wheelsets)))
        status, rows = self.parts.integrator.run(steps, every, samples)
        self.integrations, self.steps = self.integrations + 1, self.steps + steps
        if status:
            raise FlowError(f"at {self.speed:.6g} m/s: {ending_of(self.parts, status)}")
        q, u, _ = self.parts.integrator.state()
        return self.state_of(q, u), samples[:rows]

    def flow(self, z, duration, steps, every=None):
        """State after ``duration`` (s) in equal steps, and lateral displacements on the way."""
        self.parts.integrator.set_step(duration / steps)
        self.start(z)
        return self.run(steps, every)

    def equilibrium(self, speed, guess=None):
        """State of steady rolling at a speed (m/s), from a guess of it.

        Raises
        ------
        ConvergenceError
            Where none is found.
        """
        z = self.state_of(np.zeros(self.parts.model.size), self.parts.model.rolling(speed)) if guess is None else self.faster(guess, speed)
        self.set_speed(speed)
        q, u = self.coordinates_of(z)
        found = self._balance.solve(0.0, np.where(self.cyclic, u, q))
        if found is None:
            raise ConvergenceError(f"{self.vehicle.name}: no steady rolling was found at {speed:.6g} m/s near the design position: "
                                   "look at the contact and at vehicles whose sides differ")
        return self.state_of(*self._balance.state(found))

    def linear_model(self, z):
        """The equations linearised about a steady state: assembled pencil, wheel-rail blocks and holds.

        Returns
        -------
        LinearModel
            Its C is that of the present speed, whatever speed its methods are called with.
        """
        parts, (q, u) = self.parts, self.coordinates_of(z)
        matrices = [self._pencil(seed, q, u) for seed in np.eye(3)]
        for matrix, values in zip(matrices, parts.holds[1:]):
            matrix[parts.holds[0], parts.holds[0]] += values
        nothing = np.zeros_like(matrices[0])
        return LinearModel(parts.names, matrices[2], matrices[0], matrices[1], nothing, nothing, parts.model.topology.first_order, self.cyclic,
                           vehicle=self.vehicle)

    def _pencil(self, seed, q, u):
        parts = self.parts
        matrix = parts.model.pencil(seed, q, u)
        _, blocks = parts.wheels.rows(q, u, self.speed, seed=seed[:2])
        for place, block in zip(parts.wheels.wheelsets, blocks, strict=True):
            own = slice(place.first, place.first + 6)
            matrix[own, own] += block
        return matrix

    def state_matrix(self, z):
        """A of the linearisation about a steady state, rows as `names`."""
        return self.linear_model(z).state_matrix(self.speed)
