# SPDX-License-Identifier: BSD-3-Clause
"""Transient simulation of a vehicle: ``railsym.simulate``."""

from railsym.simulation.speed import SpeedProfile
from railsym.simulation.transient import Controls, Simulation, simulate

__all__ = ["Controls", "Simulation", "SpeedProfile", "simulate"]
