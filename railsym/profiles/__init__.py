# SPDX-License-Identifier: BSD-3-Clause
"""Wheel and rail profiles: shipped ones from their formulas, measured ones from files.

Everywhere in railsym y is the lateral coordinate, positive towards the field side of the track, and z points down: y = 0 is the tape
circle of a wheel and the axis of a rail, z = 0 the tape circle and the top of the rail. These are right-hand profiles in track axes.
"""

from railsym.profiles.checks import ProfileError
from railsym.profiles.library import load_profile, profiles
from railsym.profiles.profile import Profile

__all__ = ["Profile", "ProfileError", "load_profile", "profiles"]
