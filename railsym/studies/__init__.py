# SPDX-License-Identifier: BSD-3-Clause
"""Studies that put the parts together, as the paper does: crossing a switch without anti-yaw dampers, an S-curve with active tilt."""

from railsym.studies.switch import SWITCH, SwitchStudy, switch_study, variants
from railsym.studies.switch_run import SwitchRun, switch_track
from railsym.studies.switch_threshold import SwitchThreshold, switch_threshold

__all__ = ["SWITCH", "SwitchRun", "SwitchStudy", "SwitchThreshold", "switch_study", "switch_threshold", "switch_track", "variants"]
