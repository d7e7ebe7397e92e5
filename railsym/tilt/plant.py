# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in motion as the tilt unit sees it: the unit in C on the run's integrator."""

from __future__ import annotations

import numpy as np

from railsym._core import _check, _doubles, ffi, lib
from railsym.tilt.drive import POWERS, TiltDrive
from railsym.errors import ControllerError
from railsym.tilt.errors import TiltError
from railsym.tilt.sensors import KINDS, NAMES
from railsym.tilt.signals import SIGNALS

_ROW = lib.RS_TILT_ROW


class Plant:
    """``rs_tilt_unit`` of a run; hooked to its integrator, which senses every step.

    Parameters
    ----------
    simulation : railsym.simulation.Simulation
    unit : TiltUnit
    noise : NoiseSource
    rows : int
        Samples that the log of a law in C holds.
    """

    def __init__(self, simulation, unit, noise, rows):
        self.simulation, self._noise, self._rows, self._unit = simulation, noise, rows, unit
        self._signal = np.empty(len(SIGNALS))
        self._pointer = _doubles(self._signal)
        self._left = 0
        setup = self._setup(simulation, unit)
        integrator = simulation.parts.integrator
        made = lib.rs_tilt_unit_create(integrator._pointer, setup, rows)
        if made == ffi.NULL:
            raise TiltError("the tilt unit cannot be made: more than four bolsters, or no memory")
        self._core = ffi.gc(made, lib.rs_tilt_unit_free)
        integrator.set_watcher(ffi.addressof(lib, "rs_tilt_unit_watch"), self._core)
        control = ffi.addressof(lib, "rs_tilt_unit_control") if unit.compiled else None
        integrator.set_controller(control, setup.every, self._core, why=self.why)
        self._integrator = integrator

    def _setup(self, simulation, unit):
        parts, drive = simulation.parts, unit.drive or TiltDrive.of(simulation.parts.vehicle)
        setup = ffi.new("rs_tilt_setup *")
        setup.every, setup.limit, setup.gravity = steps_between(unit.rate, simulation.dt), unit.limit, parts.vehicle.gravity
        setup.start, setup.speed = float(parts.speed.place(0.0)), float(parts.speed.at(0.0))
        self._bodies(setup, parts, drive, unit.sensors)
        self._sensors(setup, unit, simulation.dt)
        self._actuators(setup, parts, drive)
        if unit.compiled:
            setup.law, setup.context = unit.law.function, unit.law.context
        return setup

    def _bodies(self, setup, parts, drive, sensors):
        vehicle, start = parts.vehicle, parts.model.topology.start
        frame = vehicle.body(leading_frame(vehicle))
        setup.bogie, setup.ahead = start[frame.name], frame.position[0]
        setup.offset = [0.0, *map(float, frame.position[1:])]
        setup.arm = [0.0, -0.5 * sensors.spread, 0.0, 0.0, 0.5 * sensors.spread, 0.0]
        roll = 4
        setup.car_roll, setup.car_ahead = start[drive.car] + roll, vehicle.body(drive.car).position[0]
        setup.bolsters = len(drive.bolsters)
        for k, name in enumerate(drive.bolsters[:lib.RS_TILT_BOLSTERS]):
            setup.bolster_roll[k], setup.bolster_ahead[k] = start[name] + roll, vehicle.body(name).position[0]

    def _sensors(self, setup, unit, step):
        sensors = unit.sensors
        for entry, name, scatter in zip(setup.sensor, NAMES, sensors.scatter(unit.rate)):
            sensor = getattr(sensors, name)
            entry.low_pass, entry.bias, entry.scatter = sensors.low_pass(name, step), sensor.bias, scatter
            entry.range = min(sensor.range, 1e300)
        setup.place_offset, setup.place_scale = sensors.place_offset, sensors.place_scale
        self._faults = ffi.new("rs_tilt_sensor_fault[]", max(len(sensors.faults), 1))
        for entry, fault in zip(self._faults, sensors.faults):
            entry.signal, entry.kind = list(SIGNALS).index(fault.signal), KINDS.index(fault.kind)
            entry.start, entry.end, entry.value = fault.start, fault.end, fault.value
        setup.faults, setup.fault = len(sensors.faults), self._faults

    def _actuators(self, setup, parts, drive):
        laws = {element.name: k for k, element in enumerate(parts.model.laws)}
        lines = sum(element.axis is None for element in parts.model.laws)
        found = []
        for name in drive.actuators:
            k = laws[name]
            table, number = ("line", k) if k < lines else ("axis", k - lines)
            found.append(ffi.addressof(parts.model._law_tables[table].array, number))
        self._laws, self._powers = ffi.new("rs_law *[]", found), np.ascontiguousarray(drive.powers, dtype=float)
        if self._powers.shape != (len(found), POWERS) or not np.isfinite(self._powers).all():
            raise TiltError(f"drive: powers have shape {self._powers.shape}; ({len(found)}, {POWERS}) finite numbers are needed")
        setup.actuators, setup.actuator, setup.length = len(found), self._laws, _doubles(self._powers)

    def refill(self, samples):
        """Random numbers for that many samples; those left over are dropped."""
        self._numbers = np.ascontiguousarray(self._noise.rows(samples))
        lib.rs_tilt_unit_noise(self._core, samples, _doubles(self._numbers))
        self._left = samples

    def read(self):
        """The signals now, list of 7."""
        if not self._left:
            self.refill(self._rows)
        self._left -= 1
        _check(lib.rs_tilt_unit_read(self._core, self._pointer), "reading the sensors")
        return self._signal.tolist()

    def command(self, angle):
        """Command the actuators to a tilt angle (rad)."""
        lib.rs_tilt_unit_command(self._core, angle)
        self._integrator.follow()

    def log(self):
        """Rows that the law in C has left, (n, 20)."""
        rows = np.empty((self._rows, _ROW))
        return rows[:lib.rs_tilt_unit_log(self._core, _doubles(rows))]

    def why(self):
        """`ControllerError` for what stopped the run."""
        command = ffi.new("double *")
        answer, time = lib.rs_tilt_unit_answer(self._core, command), self.simulation.time
        name = getattr(self._unit.law, "name", type(self._unit.law).__name__)
        if answer == lib.RS_TILT_BAD_COMMAND:
            limit = self._unit.limit
            return ControllerError(f"controller {name}: it gave {command[0]:.4g} rad at t = {time:.6g} s; it must give the tilt angle in rad, one finite "
                                   f"number within +-{limit:.4g} rad ({np.degrees(limit):.3g} degrees)")
        if answer == lib.RS_TILT_NO_NOISE:
            return ControllerError("tilt unit: the run goes on without it; give simulation.run its controllers=[unit.controller] every time")
        if answer == lib.RS_OUT_OF_TRACK:
            return ControllerError(f"tilt unit: a sensor is beyond the end of the track at t = {time:.6g} s; lengthen the track or shorten the run")
        return ControllerError(f"controller {name}: it stopped the run at t = {time:.6g} s with status {answer}")


def steps_between(rate, dt):
    """Steps (of dt, s) between samples at a rate (Hz).

    Raises
    ------
    TiltError
        No whole number.
    """
    every = 1.0 / (rate * dt)
    if every < 0.999 or abs(every - round(every)) > 1e-6 * every:
        raise TiltError(f"controller rate {rate:g} Hz: its period must be a whole number of steps of {dt:g} s")
    return round(every)


def leading_frame(vehicle):
    """Name of the frame of the foremost bogie."""
    from railsym.criteria.markers import frame_markers

    foremost = max((b for b in vehicle.bodies if b.kind == "wheelset"), key=lambda body: body.position[0]).name
    return next(body for marker, (body, _) in frame_markers(vehicle).items() if f"above_{foremost}_" in marker)
