# SPDX-License-Identifier: BSD-3-Clause
"""Critical speed of every case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.critical_cases import CriticalSpeedSolver
from railsym.critical_speed import SPEED_RANGE, damping_ratio_of
from railsym.stability import FREQUENCY_BAND
from railsym.sweep.analysis import Analysis, Output, option
from railsym.sweep.linear_contact import contact_inputs, contact_of

FOUND, STABLE, UNSTABLE = "found", "stable", "unstable_at_start"


@dataclass(frozen=True)
class CriticalSpeed(Analysis):
    """Lowest speed at which the vehicle becomes unstable, by `railsym.critical_speed`.

    Parameters
    ----------
    conicity : float, optional
        Equivalent conicity; 0.2 or a factor or setting ``contact.conicity`` without it.
    criterion : {"real_part", "damping_ratio"}, optional
    damping_ratio : float, optional
        Of the second criterion, which it selects; 0.05 without it.
    speed_range : (float, float)
        m/s.
    frequency_band : (float, float)
        Hz, of the motions that count for the damping ratio.

    Notes
    -----
    Outputs: ``speed`` (m/s) and ``frequency_hz``, nan where there is no critical speed; ``verdict``: "found", "stable" (over the whole
    range) or "unstable_at_start"; ``label``: what moves. Inputs: ``contact.*``, the arguments of `railsym.LinearContact`.
    """

    conicity: float | None = option(None)
    criterion: str | None = option(None)
    damping_ratio: float | None = option(None)
    speed_range: tuple = option(SPEED_RANGE, unit="m/s")
    frequency_band: tuple = option(FREQUENCY_BAND, unit="Hz")
    kind = "critical_speed"

    def __post_init__(self):
        damping_ratio_of(self.criterion, self.damping_ratio)
        object.__setattr__(self, "speed_range", tuple(self.speed_range))
        object.__setattr__(self, "frequency_band", tuple(self.frequency_band))

    def inputs(self, vehicle):
        return contact_inputs(vehicle, self.conicity)

    def outputs(self, vehicle):
        return {"speed": Output("m/s", "critical speed"), "frequency_hz": Output("Hz", "frequency at the critical speed"),
                "verdict": Output("", f"{FOUND}, {STABLE} in the whole range, or {UNSTABLE}", True),
                "label": Output("", "motion that becomes unstable", True)}

    def solver(self, vehicle):
        options = {"damping_ratio": damping_ratio_of(self.criterion, self.damping_ratio), "speed_range": self.speed_range,
                   "frequency_band": self.frequency_band}

        solver = CriticalSpeedSolver(vehicle, contact=contact_of(self.conicity, {}), **options)

        def solve(case):
            found = solver.solve(case.changes, contact=contact_of(self.conicity, case.settings))
            if found.speed is None:
                return {"speed": np.nan, "frequency_hz": np.nan, "verdict": UNSTABLE if found.unstable_at_start else STABLE, "label": ""}
            return {"speed": found.speed, "frequency_hz": found.frequency_hz, "verdict": FOUND, "label": found.label}

        return solve
