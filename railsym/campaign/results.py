# SPDX-License-Identifier: BSD-3-Clause
"""Results of a campaign: as text, as plain data, as pictures, as a report."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from railsym.campaign.optimisation import Optimisation
from railsym.campaign.uncertainty import UncertaintyResults, values_of
from railsym.plots.units import shown


@dataclass(frozen=True)
class Stage:
    """Something that was done: name, what it is, seconds, what came out."""

    name: str
    text: str
    seconds: float
    message: str


@dataclass(frozen=True, eq=False)
class Optimised:
    """An optimisation, what it found, and the study again at the optimum.

    Attributes
    ----------
    optimisation : Optimisation
    found : railsym.optimise.Optimum or railsym.optimise.ParetoFront
    recheck : railsym.sweep.Results or None
    probability : railsym.uncertainty.Probability or None
        Of the recheck.
    """

    optimisation: Optimisation
    found: object
    recheck: object = None
    probability: object = None


@dataclass(frozen=True, eq=False)
class CampaignResults:
    """What a campaign gave.

    Attributes
    ----------
    campaign : Campaign
    results : railsym.sweep.Results
    uncertainty : UncertaintyResults or None
    optimised : tuple of Optimised
    stages : tuple of Stage
    files : dict of str to Path
    workers : int
    """

    campaign: object
    results: object
    uncertainty: UncertaintyResults | None
    optimised: tuple[Optimised, ...]
    stages: tuple[Stage, ...]
    files: dict[str, Path] = field(repr=False)
    workers: int

    @property
    def output(self):
        """The output that all is about."""
        if self.uncertainty is not None:
            return self.uncertainty.settings.output
        return next(name for name in self.results.outputs if not self.campaign.study.outputs[name].text)

    def values(self):
        """Of that output, (n,), and which cases without a value lie above every limit."""
        return values_of(self.results, self.output)

    def __str__(self):
        from railsym.campaign.text import as_text

        return as_text(self)

    def as_data(self):
        """As plain data for JSON, SI; null where there is none."""
        from railsym.campaign.text import as_data

        return as_data(self)

    def figures(self):
        """Pictures that can be drawn: list of `railsym.campaign.figures.Figure`."""
        from railsym.campaign.figures import figures

        return figures(self)

    def plot(self):
        """Draw the leading picture; returns its axes.

        Raises
        ------
        CampaignError
            No case has a value to draw.
        """
        from railsym.campaign.errors import CampaignError

        made = self.figures()
        if not made:
            raise CampaignError(f"there is nothing to draw: {self.results.message}; look at the errors of the cases")
        return made[0].draw()

    def report(self, path):
        """Write the report: one HTML page that holds all it shows.

        Raises
        ------
        CampaignError
            If it cannot be written.
        """
        from railsym.campaign.report import write_report

        write_report(self, path)


def summary(results, output):
    """Mean, deviation and quantiles of an output: dict, in the unit that is shown; and that unit."""
    factor, unit = shown(results.unit(output))
    values, above = values_of(results, output)
    good = factor * values[~np.isnan(values)]
    found = {"cases": len(values), "with a value": len(good), "failed": len(results.errors), "stable over the whole range": int(above.sum())}
    if len(good) > 1:
        found |= {"mean": float(good.mean()), "standard deviation": float(good.std(ddof=1))}
        found |= {name: float(np.quantile(good, q)) for name, q in (("minimum", 0.0), ("5 % quantile", 0.05), ("median", 0.5), ("95 % quantile", 0.95),
                                                                   ("maximum", 1.0))}
    return found, unit


def extremes(results, output):
    """Numbers of the cases with the lowest and the highest value: dict of the names in `summary`."""
    values = results[output]
    return {} if np.isnan(values).all() else {"minimum": int(np.nanargmin(values)), "maximum": int(np.nanargmax(values))}
