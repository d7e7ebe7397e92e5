# SPDX-License-Identifier: BSD-3-Clause
"""Least damped modes of every case at one speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.critical_cases import CriticalSpeedSolver
from railsym.linear_model import Linearisation
from railsym.stability import FREQUENCY_BAND
from railsym.sweep.analysis import Analysis, Output, option
from railsym.sweep.errors import SweepError
from railsym.sweep.linear_contact import contact_inputs, contact_of
from railsym.sweep.space import Input


@dataclass(frozen=True)
class Modes(Analysis):
    """The least damped modes in a band of frequencies, by `railsym.linearise`.

    Parameters
    ----------
    speed : float
        m/s.
    conicity : float, optional
        As for `CriticalSpeed`.
    count : int
        Modes that are kept.
    frequency_band : (float, float)
        Hz.

    Notes
    -----
    Outputs: ``mode1.damping_ratio``, ``mode1.frequency_hz``, ``mode1.label`` of the least damped mode, and so on for `count` modes (nan
    where there are fewer); ``unstable``: number of unstable modes, in the band or not. Inputs: ``speed`` and ``contact.*``.
    """

    speed: float = option(unit="m/s")
    conicity: float | None = option(None)
    count: int = option(1)
    frequency_band: tuple = option(FREQUENCY_BAND, unit="Hz")
    kind = "modes"

    def __post_init__(self):
        object.__setattr__(self, "frequency_band", tuple(self.frequency_band))
        if isinstance(self.count, bool) or not isinstance(self.count, int) or not 1 <= self.count <= 100:
            raise SweepError(f"modes: count = {self.count!r}; a whole number from 1 to 100 is needed")
        if not self.speed > 0.0:
            raise SweepError(f"modes: speed = {self.speed!r} m/s; a number above 0 is needed")
        if len(self.frequency_band) != 2 or not 0.0 <= self.frequency_band[0] < self.frequency_band[1]:
            raise SweepError(f"modes: frequency_band = {self.frequency_band} Hz; two frequencies in ascending order are needed")

    def inputs(self, vehicle):
        return contact_inputs(vehicle, self.conicity) | {"speed": Input("m/s", self.speed)}

    def outputs(self, vehicle):
        found = {}
        for k in range(1, self.count + 1):
            found |= {f"mode{k}.damping_ratio": Output("-", f"damping ratio of the {_ORDINAL.get(k, f'{k}th')} least damped mode"),
                      f"mode{k}.frequency_hz": Output("Hz", "its frequency"), f"mode{k}.label": Output("", "its motion", True)}
        return found | {"unstable": Output("-", "number of unstable modes")}

    def solver(self, vehicle):
        solver = CriticalSpeedSolver(vehicle, contact=contact_of(self.conicity, {}))

        def solve(case):
            model = solver.model(case.changes, contact=contact_of(self.conicity, case.settings))
            modes = Linearisation.of(model, case.settings.get("speed", self.speed)).modes()
            low, high = self.frequency_band
            chosen = sorted((m for m in modes if low <= m.frequency_hz <= high and m.frequency_hz > 0.0), key=lambda m: (m.damping_ratio, m.frequency_hz))
            found = {"unstable": float(len(modes.unstable))}
            for k in range(self.count):
                mode = chosen[k] if k < len(chosen) else None
                found |= {f"mode{k + 1}.damping_ratio": mode.damping_ratio if mode else np.nan,
                          f"mode{k + 1}.frequency_hz": mode.frequency_hz if mode else np.nan, f"mode{k + 1}.label": mode.label if mode else ""}
            return found

        return solve


_ORDINAL = {1: "1st", 2: "2nd", 3: "3rd"}
