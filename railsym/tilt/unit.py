# SPDX-License-Identifier: BSD-3-Clause
"""The tilt unit: sensors on a vehicle in motion, a controller that reads them, actuators that it commands."""

from __future__ import annotations

import numpy as np

from railsym.errors import ControllerError
from railsym.tilt.errors import TiltError
from railsym.tilt.faults import OUTPUTS, reports
from railsym.tilt.sensors import NoiseSource, SensorSet
from railsym.tilt.signals import SIGNALS, Signals

_CHUNK = 50          # samples between two calls of Python where the law is in C
_PACK = 500          # samples


class TiltUnit:
    """Joins a controller to a run.

    Parameters
    ----------
    law : Controller, CompiledController, CompiledLaw, or any object with ``step(time, signals)``
        ``step`` gets the time (s) and `Signals` and gives the tilt angle (rad) that is commanded. An object that is not one of ours is
        called at ``rate``.
    sensors : SensorSet, optional
    rate : float, optional
        Hz; the law's own without it.
    drive : TiltDrive, optional
        Of the vehicle without it.
    limit : float
        rad, beyond which a command is nonsense.

    Attributes
    ----------
    controller : (callable, float)
        For ``railsym.simulate(..., controllers=[unit.controller])``.
    record : railsym.Run
        Signals and outputs, a sample each, so far.
    reports : list of FaultReport
        Of our controllers.

    Raises
    ------
    TiltError
        A law without ``step``, a rate that does not fit.
    """

    def __init__(self, law, sensors=None, *, rate=None, drive=None, limit=np.radians(10.0)):
        self.law, self.sensors, self.drive, self.limit = law, sensors or SensorSet(), drive, float(limit)
        self.compiled = hasattr(law, "function")
        if not self.compiled and not callable(getattr(law, "step", None)):
            raise TiltError(f"controller {type(law).__name__}: an object with a method step(time, signals) -> tilt angle (rad) is needed")
        own = getattr(getattr(law, "parameters", law), "rate", None)
        self.rate = float(own if rate is None and own is not None else 100.0 if rate is None else rate)
        if own is not None and abs(self.rate - own) > 1e-9 * self.rate:
            raise TiltError(f"rate {rate:g} Hz: the controller samples at {own:g} Hz")
        self._rows, self._packed, self._plant = [], [], None

    @property
    def controller(self):
        """Function and rate (Hz) at which `railsym.simulate` calls it."""
        return self._call, self.rate / (_CHUNK if self.compiled else 1)

    def _call(self, controls):
        if self._plant is None or self._plant.simulation is not controls.simulation:
            self._start(controls.simulation)
        plant = self._plant
        if self.compiled:
            self._flush()
            plant.refill(_CHUNK)
            return
        time = controls.time
        signals = plant.read()
        angle = self._checked(time, self.law.step(time, Signals(*signals)))
        plant.command(angle)
        signals = getattr(self.law, "consumed", None) or signals
        self._keep([[time, *signals, *(getattr(self.law, "outputs", None) or [angle] + [0.0] * (len(OUTPUTS) - 1))]])

    def _keep(self, rows):
        """Rows of the record; packed from time to time, so that a sample takes 160 bytes."""
        self._rows.extend(rows)
        if len(self._rows) >= _PACK:
            self._packed.append(np.array(self._rows))
            self._rows = []

    def _start(self, simulation):
        from railsym.tilt.plant import Plant

        if hasattr(self.law, "reset"):
            self.law.reset()
        self._rows, self._packed = [], []
        self._plant = Plant(simulation, self, NoiseSource(self.sensors), _CHUNK)

    def _checked(self, time, answer):
        name = type(self.law).__name__
        try:
            angle = np.asarray(answer, dtype=float)
        except (TypeError, ValueError):
            angle = np.full((), np.nan)
        wrong = (f"{answer!r}" if answer is None or not np.issubdtype(angle.dtype, np.floating) or angle.ndim == 0 and not np.isfinite(angle)
                 else f"an array of shape {angle.shape}" if angle.ndim else None)
        if wrong is None and abs(angle) > self.limit:
            wrong = f"{float(angle):.4g} rad ({np.degrees(float(angle)):.4g} degrees)"
        if wrong is not None:
            raise ControllerError(f"controller {name}: step(time, signals) gave {wrong} at t = {time:.6g} s; it must give the tilt angle in rad, one "
                                  f"finite number within +-{self.limit:.4g} rad ({np.degrees(self.limit):.3g} degrees)")
        return float(angle)

    def _flush(self):
        if self.compiled and self._plant is not None:
            self._keep(self._plant.log())

    def rows(self):
        """Array (n, 20) of samples so far: time, signals, outputs."""
        self._flush()
        return np.concatenate([*self._packed, np.array(self._rows).reshape(-1, 1 + len(SIGNALS) + len(OUTPUTS))])

    @property
    def record(self):
        """The samples so far as a `railsym.Run`: channels by the names of SIGNALS and OUTPUTS."""
        from railsym.results import Run
        from railsym.results.channel import Channel

        rows, units = self.rows(), SIGNALS | OUTPUTS
        return Run(rows[:, 0], rows[:, 1:], [Channel(name, unit, "tilt unit") for name, unit in units.items()])

    @property
    def reports(self):
        """Fault reports so far."""
        rows, n = self.rows(), 1 + len(SIGNALS)
        return reports(rows[:, 0], rows[:, 1:n], rows[:, n:])

    @property
    def state(self):
        """State of our controllers after the last sample."""
        from railsym.tilt.faults import State

        rows = self.rows()
        return State(int(rows[-1, -2])) if len(rows) else State.NORMAL
