# SPDX-License-Identifier: BSD-3-Clause
"""Transient simulation of a vehicle: ``railsym.simulate``; equilibria along a track: ``railsym.quasi_static``."""

from railsym.simulation.quasi_static import quasi_static, steady_state
from railsym.simulation.speed import SpeedProfile
from railsym.simulation.speed_over_distance import SpeedOverDistance, load_speed
from railsym.simulation.transient import Controls, Simulation, simulate

__all__ = ["Controls", "Simulation", "SpeedOverDistance", "SpeedProfile", "load_speed", "quasi_static", "simulate", "steady_state"]
