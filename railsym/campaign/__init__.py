# SPDX-License-Identifier: BSD-3-Clause
"""A study file with what is made of its results: uncertainty, optimisation, pictures, one report.

    found = rs.campaign.load("damper.toml").run("damper.nc", workers=4)
    found.report("damper.html")

The command is ``railsym study``. Names are imported when they are first used.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Campaign": "campaign",
    "CampaignError": "errors",
    "CampaignResults": "results",
    "Optimisation": "optimisation",
    "Uncertainty": "uncertainty",
    "example": "campaign_file",
    "load": "campaign_file",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
