# SPDX-License-Identifier: BSD-3-Clause
"""Errors of studies."""

from railsym.errors import RailsymError
from railsym.vehicle_checks import unknown

__all__ = ["StoreError", "SweepError", "WorkersLostError", "unknown"]


class SweepError(RailsymError, ValueError):
    """A study that cannot be run as it is described."""


class StoreError(RailsymError, RuntimeError):
    """A store of results that cannot be used: another study's, in use, or a full disk. What it holds is intact."""


class WorkersLostError(RailsymError, RuntimeError):
    """Workers ended again and again before they finished a case, or a pool that is not ours broke."""
