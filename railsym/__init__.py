# SPDX-License-Identifier: BSD-3-Clause
"""railsym: railway vehicle dynamics from Kane-derived equations.

    vehicle = railsym.load_vehicle("pendolino").configured("AS_K")
    found = railsym.critical_speed(vehicle, conicity=[0.1, 0.2, 0.3])

Names are imported when they are first used, so that importing railsym costs next to nothing.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "ChannelWriter": "results",
    "ConicalContact": "conical_contact",
    "ContactPair": "contact_pair",
    "ContactTable": "contact_table",
    "CriticalSpeedSolver": "critical_cases",
    "LinearContact": "contact",
    "LinearModel": "linear_model",
    "Material": "creep",
    "Profile": "profiles",
    "Quantity": "vehicle_parts",
    "RailsymError": "errors",
    "Run": "results",
    "Simulation": "simulation",
    "SpeedOverDistance": "simulation",
    "Track": "track",
    "Study": "sweep",
    "SwitchStudy": "studies",
    "TiltLinkage": "tilt_linkage",
    "Vehicle": "vehicle",
    "WheelRail": "wheel_rail",
    "animate": "plots.animation",
    "bifurcation": "nonlinear",
    "creep_forces": "creep",
    "creep_laws": "creep",
    "critical_speed": "critical_speed",
    "critical_speeds": "critical_cases",
    "curving": "curving",
    "equivalent_conicity": "conicity",
    "linear_model": "linear",
    "linearise": "linear",
    "load_contact_table": "contact_table",
    "load_profile": "profiles",
    "load_speed": "simulation",
    "load_track": "track",
    "load_vehicle": "vehicle",
    "parameter_map": "stability_map",
    "profiles": "profiles",
    "quasi_static": "simulation",
    "sensitivity": "sensitivity",
    "simulate": "simulation",
    "stability_map": "stability_map",
    "steady_state": "simulation",
    "switch_study": "studies",
    "tilt_study": "studies",
    "track_modes": "tracking",
    "vehicles": "vehicle",
}
_SUBMODULES = ("criteria", "dampers", "nonlinear", "optimise", "plots", "results", "simulation", "studies", "sweep", "tilt", "track", "uncertainty")

_get, __dir__, _names = lazy(__name__, _MODULE_OF, _SUBMODULES)
__all__ = [*_names, "__version__"]


def __getattr__(name):
    if name == "__version__":
        from importlib.metadata import version

        globals()[name] = version("railsym")
        return globals()[name]
    return _get(name)
