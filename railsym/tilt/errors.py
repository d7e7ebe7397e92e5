# SPDX-License-Identifier: BSD-3-Clause
"""Exceptions of tilting."""

from railsym.errors import SimulationError


class TiltError(SimulationError):
    """Sensors, parameters or a vehicle that a tilting control cannot be made of."""


class ControllerError(TiltError):
    """A controller answered with something that is no tilt angle; ``run`` and ``record`` hold what was computed until then."""

    run = None
    record = None
