# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle made ready to run: model, wheel-rail forces, track frames, and the integrator over them."""

from __future__ import annotations

from inspect import signature

import numpy as np

from railsym import _core
from railsym._core_integrator import Integrator, Travel
from railsym.contact import LinearContact
from railsym.equilibrium import static_preload
from railsym.errors import SimulationError
from railsym.model import Model
from railsym.vehicle_checks import unknown

_BODY_KERNELS = ("rigid_body", "wheelset", "wheelset_with_axleboxes")
DRIVE_FREQUENCY = 0.1  # Hz, assumed: far below what moves a vehicle against its track


class Assembled:
    """Everything of one run that does not change while it runs.

    Parameters
    ----------
    vehicle : Vehicle
    contact : LinearContact, WheelRail, or what WheelRail takes (contact table, ConicalContact), or None (no wheels touch)
    track : railsym.track.Track or None
        None: straight and level.
    speed : SpeedProfile
    step : float
        s
    rho, tolerance : float
        As `railsym._core_integrator.Integrator`.
    drive : str
        ``"held"``: the car body is held to its track frame along the track, softly; ``"free"``.
    forces : dict
        Further arguments of WheelRail.

    Attributes
    ----------
    model : Model
    integrator : Integrator
    wheels : WheelRail or None
    frames : ndarray (frames,)
        m, places of the track frames ahead of the vehicle's centre.
    frame_of : dict of str to int
        Track frame of each body.
    """

    def __init__(self, vehicle, contact, track, speed, step, rho, tolerance, drive, forces):
        self.vehicle, self.track, self.speed = vehicle, track, speed
        self.model = Model(vehicle)
        self.preload = static_preload(self.model)
        self.names = self.model.topology.coordinates
        self._numbers = {name: k for k, name in enumerate(self.names)}
        self.second = int(np.sum(~self.model.topology.first_order))
        thrusts = {e.name for e in vehicle.elements if e.type == "actuator" and e.parameters["mode"] == "force"}
        self.units = {self.model.topology.internal[name]: "N" if name in thrusts else "m" for name in self.model.topology.internal}
        self.wheels = self._add_contact(contact, forces)
        self.model.set_speed(float(speed.at(0.0)))
        self._number_frames()
        starts = [self.model.topology.start[body.name] for body in vehicle.bodies]
        block = np.searchsorted(starts, np.arange(self.second), side="right") - 1
        self.integrator = Integrator(self.model.assembly, block, step, rho, tolerance)
        self._hold(drive)
        if self._moves:
            self._add_travel()
        if self.wheels is not None:
            self.integrator.set_wheels(self.wheels, [place.first for place in self.wheels.wheelsets])

    def _add_contact(self, contact, forces):
        """Linear contact joins the model; any other becomes the wheel-rail forces beside it."""
        from railsym.wheel_rail import WheelRail

        if contact is None or isinstance(contact, LinearContact):
            if forces:
                raise SimulationError(f"{', '.join(forces)}: these belong to wheel-rail forces from a contact table, not to "
                                      f"{'no contact' if contact is None else 'LinearContact, which has its own parameters'}")
            if contact is not None:
                self._add_linear(contact)
            return None
        known = list(signature(WheelRail).parameters)[2:]
        for name in forces:
            if name not in known:
                raise SimulationError(f"argument {name!r} is {unknown(name, known, 'arguments of the wheel-rail forces')}")
        return contact if isinstance(contact, WheelRail) else WheelRail(self.vehicle, contact, **forces)

    def _add_linear(self, contact):
        seen = [what for what in ("irregularities", "switches") if getattr(self.track, what, ())]
        if seen:
            raise SimulationError(f"the track has {' and '.join(seen)}, which the linear contact does not see: give a contact pair or table")
        bodies, sides = zip(*self.model.wheels, strict=True) if self.model.wheels else ((), ())
        if not bodies:
            raise SimulationError(f"vehicle {self.vehicle.name!r} has no wheelset: contact=None runs it without wheels")
        wheels = contact.resolved(self.vehicle.contact).wheels(
            load=self.preload.wheel_loads, wheel_radius=np.array([b.wheel_radius for b in bodies]),
            contact_half_spacing=np.array([b.contact_half_spacing for b in bodies]), side=np.array(sides))
        self.model.add_wheels(wheels)

    def _number_frames(self):
        places = np.array([body.position[0] for body in self.vehicle.bodies])
        self.frames, numbers = np.unique(places, return_inverse=True)
        self.frame_of = {body.name: int(k) for body, k in zip(self.vehicle.bodies, numbers.ravel(), strict=True)}

    @property
    def _moves(self):
        """Whether inputs of the model change during a run, or the wheels ask for the lie of the rails."""
        return self.track is not None or not self.speed.constant or self.wheels is not None

    def _hold(self, drive):
        if drive not in ("held", "free"):
            raise SimulationError(f"drive {drive!r}: 'held' holds the car body softly to its place along the track, 'free' lets the vehicle roll")
        self.holds = [], [], []  # coordinates, stiffness N/m, damping N s/m
        if drive == "free":
            return
        body = max(self.vehicle.bodies, key=lambda b: b.mass)
        mass = sum(b.mass + sum(box.mass for box in b.axleboxes) for b in self.vehicle.bodies)
        omega = 2.0 * np.pi * DRIVE_FREQUENCY
        self.holds = [self.model.topology.start[body.name]], [mass * omega ** 2], [2.0 * mass * omega]
        self.integrator.hold(*self.holds, [mass])

    def _add_travel(self):
        core = None if self.track is None else self.track.core
        travel = Travel(None if core is None else core.pointer, self.frames, self.speed.pieces, self.vehicle.gravity, keep=core)
        if self.track is not None or not self.speed.constant:
            self._add_bodies(travel)
        if self.track is not None:
            self._add_pairs(travel)
        if self.wheels is not None:
            by_start = {self.model.topology.start[name]: frame for name, frame in self.frame_of.items()}
            travel.add_wheelsets([by_start[place.first] for place in self.wheels.wheelsets])
        self.integrator.set_travel(travel)
        if self.track is not None:
            jumps = self.track.jumps
            if len(jumps):
                raise SimulationError(f"the curvature of track {self.track.name!r} jumps at s = {jumps[0]:.6g} m: a body that passes there gets a "
                                      "velocity step; give the track a rounding (1 m by default)")

    def _add_bodies(self, travel):
        groups = {name: [] for name in _BODY_KERNELS}
        for body in self.vehicle.bodies:
            groups[body.kind + ("_with_axleboxes" if body.axleboxes else "")].append(self.frame_of[body.name])
        groups["wheel_rail"] = [self.frame_of[body.name] for body, _ in self.model.wheels]
        for name, frames in groups.items():
            if frames and name in self.model._tables:
                travel.add_bodies(self.model.assembly, _core.kernels()[name].number, frames)

    def _add_pairs(self, travel):
        for name in self.model._law_tables.keys() & self.model._tables.keys():
            pair = self.model._pairs[name]
            frames = np.searchsorted(self.frames, np.column_stack([pair.place1[:, 0], pair.place2[:, 0]]))
            apart = np.flatnonzero(frames[:, 0] != frames[:, 1])
            offsets = np.stack([pair.place1, pair.place2], axis=1)[apart]
            offsets[:, :, 0] = 0.0
            travel.add_pairs(self.model.assembly, _core.kernels()[name].number, apart, frames[apart], offsets)

    def kinks(self, end):
        """Times (s) between 0 and ``end`` at which a body passes a kink of the track or the speed bends."""
        times = [] if self.speed.constant else [self.speed.time]
        if self.track is not None:
            places = (self.track.kinks[:, None] - self.frames[None, :]).ravel()
            within = (places > self.speed.place(0.0)) & (places < self.speed.place(end))
            times.append(self.speed.when(places[within]))
        found = np.unique(np.concatenate(times)) if times else np.empty(0)
        return found[(found > 0.0) & (found < end)]

    def check_track(self, end):
        """Refuse a run that leaves the track."""
        if self.track is not None:
            self.track.check_run(float(self.speed.place(0.0)) + self.frames[0], float(self.speed.place(end)) + self.frames[-1])

    def start(self, initial=None):
        """q and u at the start: rolling at the design position, with what ``initial`` says otherwise.

        Parameters
        ----------
        initial : dict of str to float, or pair of (n,) arrays, optional
            ``{"wheelset1.y": 3e-3, "car.y.rate": 0.1}``, SI; or q and u.
        """
        q, u = np.zeros(self.model.size), self.model.rolling(float(self.speed.at(0.0)))
        if initial is None:
            return q, u
        if not isinstance(initial, dict):
            q, u = (np.array(part, dtype=float) for part in initial)
            if q.shape != (self.model.size,) or u.shape != (self.model.size,):
                raise SimulationError(f"initial state: q and u of {self.model.size} numbers are needed, got shapes {q.shape} and {u.shape}")
            return q, u
        for name, value in initial.items():
            rate = name.endswith(".rate")
            k = self.number(name.removesuffix(".rate"), "initial state")
            if rate and k >= self.second:
                raise SimulationError(f"initial state: {name}: the rate of an internal state follows from the state (Maxwell damper, actuator with a lag)")
            (u if rate else q)[k] = float(value)
        return q, u

    def static_loads(self):
        """``{"wheel_loads": {"wheelset1.left": N, ...}}``, what criteria take for Q0; empty without wheel-rail forces."""
        if self.wheels is None:
            return {}
        names = [f"{body.name}.{'left' if side < 0 else 'right'}" for body, side in self.model.wheels]
        return {"wheel_loads": dict(zip(names, (float(load) for load in self.preload.wheel_loads), strict=True))}

    def number(self, name, what):
        """Number of a coordinate, or an error with near matches."""
        if name not in self._numbers:
            raise SimulationError(f"{what}: {name!r} is {unknown(name, self.names, 'coordinates')}")
        return self._numbers[name]
