# SPDX-License-Identifier: BSD-3-Clause
"""Assessment of a run: stability, derailment, wheel-rail forces, body accelerations, comfort.

    found = railsym.criteria.instability(run)          # or (time, acceleration)
    print(found)
    railsym.criteria.derailment(run, wheel_load=66e3)

Functions take a `railsym.Run`, or arrays of time and signal. Limits are data (``railsym/data/criteria``) with edition and trust
mark; no verdict is given on a value that is only recalled. Names are imported when they are first used.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Assessed": "limits",
    "Butterworth": "filters",
    "CriterionError": "errors",
    "Limit": "limits",
    "TrackSection": "sections",
    "acceleration_rms": "body",
    "body_acceleration": "body",
    "comfort": "comfort",
    "curve_transition_comfort": "curve_comfort",
    "derailment": "derailment",
    "discrete_event_comfort": "discrete_comfort",
    "frame_markers": "markers",
    "hunting_frequency": "hunting",
    "instability": "instability",
    "instability_rms": "instability_rms",
    "limits": "limits",
    "percentile_analysis": "percentiles",
    "sliding_mean": "sliding",
    "sliding_rms": "sliding",
    "sperling": "sperling",
    "track_sections": "sections",
    "weighting": "weighting",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
