# SPDX-License-Identifier: BSD-3-Clause
"""Studies over many runs: a vehicle, an analysis, factors and a plan; computed on one core or a cluster, nothing lost.

    study = railsym.Study("pendolino", configuration="AS_K", analysis=railsym.sweep.CriticalSpeed(conicity=0.2),
                          factors={"anti_yaw_damper.series_stiffness": railsym.sweep.Uniform(4, 6, unit="MN/m")},
                          plan=railsym.sweep.LatinHypercube(200), seed=1)
    results = study.run("results.nc", workers=4)

Names are imported when they are first used.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Analysis": "analysis",
    "Case": "worker",
    "CriticalSpeed": "critical_speed",
    "DamperLoop": "damper_loop",
    "FullGrid": "plans",
    "Grid": "factors",
    "Input": "space",
    "LatinHypercube": "plans",
    "List": "factors",
    "LogNormal": "factors",
    "Modes": "modes",
    "Normal": "factors",
    "OneAtATime": "plans",
    "Output": "analysis",
    "Results": "results",
    "Sobol": "plans",
    "StoreError": "errors",
    "Study": "study",
    "SweepError": "errors",
    "Table": "plans",
    "Tilt": "tilt",
    "Transient": "transient",
    "Triangular": "factors",
    "Uniform": "factors",
    "WorkersLostError": "errors",
    "load": "results",
    "run": "run",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
