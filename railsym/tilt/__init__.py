# SPDX-License-Identifier: BSD-3-Clause
"""Tilting: sensors on the leading bogie, detection of curves, control of the tilt angle, faults.

    control = railsym.tilt.Controller(railsym.tilt.TiltParameters(share=0.6))
    unit = railsym.tilt.TiltUnit(control)
    run = railsym.simulate(vehicle, ..., controllers=[unit.controller])
    print(unit.record, unit.reports)

The same controller reads recorded signals: ``control.replay(times, signals)``. docs/tilting.md has the equations.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "CompiledController": "compiled",
    "CompiledLaw": "compiled",
    "Controller": "controller",
    "FaultReport": "faults",
    "LeadingSignals": "leading",
    "OUTPUTS": "faults",
    "SIGNALS": "signals",
    "Sensor": "sensors",
    "SensorFault": "sensors",
    "SensorSet": "sensors",
    "Signals": "signals",
    "State": "faults",
    "TiltDrive": "drive",
    "TiltError": "errors",
    "TiltLoop": "loop",
    "TiltParameters": "parameters",
    "TiltUnit": "unit",
    "TrackDatabase": "place",
    "fitted_plant": "loop",
    "reports": "faults",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
