# SPDX-License-Identifier: BSD-3-Clause
"""Force-displacement loop of a damper of every case on the virtual bench."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.dampers import DamperModel, sweep
from railsym.sweep.analysis import Analysis, Output, option
from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.space import Input
from railsym.vehicle_parts import Curve

_KINDS = {"damper": "viscous", "maxwell": "maxwell"}


@dataclass(frozen=True)
class DamperLoop(Analysis):
    """Steady loop of a group of dampers under a sine, by `railsym.dampers.sweep`.

    Parameters
    ----------
    element : str
        Group of elements of type damper or maxwell, such as "anti_yaw_damper".
    frequency, amplitude : float
        Hz and m, of the elongation.

    Notes
    -----
    Outputs: ``dynamic_stiffness`` (magnitude, N/m) and ``phase`` (rad, of the force before the elongation; pi/2 for a viscous damper) of the
    first harmonic, ``dissipated_energy`` (J a cycle), ``peak_force`` (N). Inputs: ``loop.frequency``, ``loop.amplitude``.
    """

    element: str = option()
    frequency: float = option(unit="Hz")
    amplitude: float = option(unit="m")
    kind = "damper_loop"

    def inputs(self, vehicle):
        return {"loop.frequency": Input("Hz", self.frequency), "loop.amplitude": Input("m", self.amplitude)}

    def outputs(self, vehicle):
        self.model(vehicle)
        return {"dynamic_stiffness": Output("N/m", "magnitude of the dynamic stiffness, first harmonic"),
                "phase": Output("rad", "phase of the force before the elongation, first harmonic"),
                "dissipated_energy": Output("J", "energy taken from the bench in a cycle"), "peak_force": Output("N", "largest force")}

    def solver(self, vehicle):
        def solve(case):
            settings = case.settings
            loop = sweep(self.model(case.vehicle), settings.get("loop.frequency", self.frequency), settings.get("loop.amplitude", self.amplitude))
            return {"dynamic_stiffness": abs(loop.dynamic_stiffness[0, 0]), "phase": loop.phase[0, 0], "dissipated_energy": loop.dissipated_energy[0, 0],
                    "peak_force": np.abs(loop.force).max()}

        return solve

    def model(self, vehicle):
        """The group's `railsym.dampers.DamperModel`.

        Raises
        ------
        SweepError
            No such group, or not of dampers.
        """
        dampers = {element.group: element for element in vehicle.elements if element.type in _KINDS}
        if self.element not in dampers:
            raise SweepError(f"damper loop: element {self.element!r} is {unknown(self.element, dampers, 'groups of dampers')}")
        element = dampers[self.element]
        values = {name: (value.x, value.y) if isinstance(value, Curve) else value for name, value in element.parameters.items()}
        return DamperModel(_KINDS[element.type], **values)
