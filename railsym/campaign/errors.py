# SPDX-License-Identifier: BSD-3-Clause
"""Errors of study files and their reports."""

from railsym.errors import RailsymError


class CampaignError(RailsymError, ValueError):
    """A study file, a store or a report that cannot be used as asked."""
