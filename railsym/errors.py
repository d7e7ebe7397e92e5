# SPDX-License-Identifier: BSD-3-Clause
"""Exceptions of railsym: each says what was asked, what exists, and what to do."""


class RailsymError(Exception):
    """Base of every exception that railsym raises on purpose."""


class VehicleFileError(RailsymError, ValueError):
    """A vehicle file, a configuration or a parameter name that cannot be used."""


class ContactError(RailsymError, ValueError):
    """Contact parameters or loads outside what the contact theory covers."""


class ModelError(RailsymError, ValueError):
    """A vehicle whose equations cannot be assembled or linearised as asked."""


class TrackError(RailsymError, ValueError):
    """A track, an irregularity or a place on a track that cannot be used."""


class ConvergenceError(RailsymError, RuntimeError):
    """An iteration that did not reach its tolerance."""


class CoreError(RailsymError, RuntimeError):
    """The C library refused a call; the message carries its status, and ``status`` is its number (None where there is none)."""

    def __init__(self, message, status=None):
        super().__init__(message)
        self.status = status


class SimulationError(RailsymError, ValueError):
    """A simulation that cannot be started as asked."""


class ControllerError(SimulationError):
    """A controller answered with something that it cannot mean, or stopped the run; ``run`` holds what was computed until then."""

    run = None
