# SPDX-License-Identifier: BSD-3-Clause
"""railsym: railway vehicle dynamics from Kane-derived equations.

    vehicle = railsym.load_vehicle("pendolino").configured("AS_K")
    found = railsym.critical_speed(vehicle, conicity=[0.1, 0.2, 0.3])

Names are imported when they are first used, so that importing railsym costs next to nothing.
"""

import sys
from importlib import import_module
from types import ModuleType

_MODULE_OF = {
    "ChannelWriter": "results",
    "ConicalContact": "conical_contact",
    "ContactPair": "contact_pair",
    "ContactTable": "contact_table",
    "LinearContact": "contact",
    "LinearModel": "linear_model",
    "Material": "creep",
    "Profile": "profiles",
    "Quantity": "vehicle_parts",
    "RailsymError": "errors",
    "Run": "results",
    "Simulation": "simulation",
    "Track": "track",
    "Vehicle": "vehicle",
    "WheelRail": "wheel_rail",
    "bifurcation": "nonlinear",
    "creep_forces": "creep",
    "creep_laws": "creep",
    "critical_speed": "critical_speed",
    "equivalent_conicity": "conicity",
    "linear_model": "linear",
    "linearise": "linear",
    "load_contact_table": "contact_table",
    "load_profile": "profiles",
    "load_track": "track",
    "load_vehicle": "vehicle",
    "parameter_map": "stability_map",
    "profiles": "profiles",
    "quasi_static": "simulation",
    "sensitivity": "sensitivity",
    "simulate": "simulation",
    "stability_map": "stability_map",
    "track_modes": "tracking",
    "vehicles": "vehicle",
}
_SUBMODULES = ("criteria", "dampers", "nonlinear", "plots", "results", "simulation", "track")

__all__ = [*_MODULE_OF, *_SUBMODULES, "__version__"]


def __getattr__(name):
    if name == "__version__":
        from importlib.metadata import version

        value = version("railsym")
    elif name in _MODULE_OF:
        value = getattr(import_module(f"railsym.{_MODULE_OF[name]}"), name)
    elif name in _SUBMODULES:
        return import_module(f"railsym.{name}")
    else:
        raise AttributeError(f"module 'railsym' has no attribute {name!r}; it offers {', '.join(__all__)}")
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """A public function keeps its place when the module of the same name (`railsym.critical_speed`) is imported."""

    def __setattr__(self, name, value):
        if not (name in _MODULE_OF and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
