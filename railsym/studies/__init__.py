# SPDX-License-Identifier: BSD-3-Clause
"""Studies that put the parts together, as the paper does: crossing a switch without anti-yaw dampers, an S-curve with active tilt."""

from railsym.lazy import lazy

_MODULE_OF = {
    "SWITCH": "switch",
    "SwitchRun": "switch_run",
    "SwitchStudy": "switch",
    "SwitchThreshold": "switch_threshold",
    "TiltCase": "tilt_case",
    "TiltStudy": "tilt",
    "switch_study": "switch",
    "switch_threshold": "switch_threshold",
    "switch_track": "switch_run",
    "tilt_study": "tilt",
    "variants": "switch",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
