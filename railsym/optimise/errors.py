# SPDX-License-Identifier: BSD-3-Clause
"""Errors of optimisations."""

from railsym.errors import RailsymError


class OptimisationError(RailsymError, ValueError):
    """A problem, a method or a history that cannot be used, or an optimisation that has nothing to go on with."""
