# SPDX-License-Identifier: BSD-3-Clause
"""Errors of the analyses of uncertainty."""

from railsym.errors import RailsymError


class UncertaintyError(RailsymError, ValueError):
    """Tolerances, samples or limits that cannot be used."""
