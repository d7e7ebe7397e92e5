# SPDX-License-Identifier: BSD-3-Clause
"""Assessment of a run: stability, derailment, wheel-rail forces, body accelerations, comfort.

    found = railsym.criteria.instability(run)          # or (time, acceleration)
    print(found)
    railsym.criteria.derailment(run, wheel_load=66e3)

Functions take a `railsym.Run`, or arrays of time and signal. Limits are data (``railsym/data/criteria``) with edition and trust
mark; no verdict is given on a value that is only recalled. Names are imported when they are first used.
"""

import sys
from importlib import import_module
from types import ModuleType

_MODULE_OF = {
    "Assessed": "limits",
    "Butterworth": "filters",
    "CriterionError": "errors",
    "Limit": "limits",
    "acceleration_rms": "body",
    "body_acceleration": "body",
    "comfort": "comfort",
    "curve_transition_comfort": "curve_comfort",
    "derailment": "derailment",
    "frame_markers": "markers",
    "hunting_frequency": "hunting",
    "instability": "instability",
    "instability_rms": "instability_rms",
    "limits": "limits",
    "percentile_analysis": "percentiles",
    "sliding_mean": "sliding",
    "sliding_rms": "sliding",
    "sperling": "sperling",
    "weighting": "weighting",
}

__all__ = [*_MODULE_OF]


def __getattr__(name):
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'railsym.criteria' has no attribute {name!r}; it offers {', '.join(__all__)}")
    value = getattr(import_module(f"railsym.criteria.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """A public function keeps its place when the module of the same name (`railsym.criteria.comfort`) is imported."""

    def __setattr__(self, name, value):
        if not (name in _MODULE_OF and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
