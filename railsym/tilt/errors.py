# SPDX-License-Identifier: BSD-3-Clause
"""Exceptions of tilting."""

from railsym.errors import SimulationError


class TiltError(SimulationError):
    """Sensors, parameters or a vehicle that a tilting control cannot be made of."""
