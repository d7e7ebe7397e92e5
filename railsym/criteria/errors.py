# SPDX-License-Identifier: BSD-3-Clause
"""The exception of the criteria."""

from railsym.errors import RailsymError


class CriterionError(RailsymError, ValueError):
    """A signal that a criterion cannot judge: too short, sampled too slowly, not finite, in another unit, or missing."""
