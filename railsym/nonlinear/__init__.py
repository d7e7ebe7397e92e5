# SPDX-License-Identifier: BSD-3-Clause
"""Non-linear stability: limit cycles against speed, ``railsym.bifurcation``."""

from railsym.nonlinear.bifurcation import Bifurcation, bifurcation
from railsym.nonlinear.continuation import Branch
from railsym.nonlinear.hopf import Hopf
from railsym.nonlinear.orbit import Orbit
from railsym.nonlinear.ramp import Ramp

__all__ = ["Bifurcation", "Branch", "Hopf", "Orbit", "Ramp", "bifurcation"]
