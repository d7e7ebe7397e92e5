# SPDX-License-Identifier: BSD-3-Clause
"""``[uncertainty]`` of a study file: what is made of the factors as tolerances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.campaign.errors import CampaignError
from railsym.campaign.tables import fraction, known, quantities, truth, whole
from railsym.errors import RailsymError
from railsym.vehicle_checks import unknown

_KEYS = ("output", "limit", "confidence", "sobol", "second_order", "tornado", "form")


@dataclass(frozen=True)
class Uncertainty:
    """What to do.

    Attributes
    ----------
    output : str
        Which output of the analysis.
    limit : float or None
        SI; the probability to lie below it is estimated.
    confidence : float
    sobol : int or None
        Base points of the Sobol indices.
    second_order : bool
        Sobol indices of pairs too.
    tornado, form : bool
        From analytic gradients, where the analysis is the critical speed.
    """

    output: str
    limit: float | None = None
    confidence: float = 0.95
    sobol: int | None = None
    second_order: bool = False
    tornado: bool = True
    form: bool = True


def read(table, study):
    """`Uncertainty` from its table.

    Raises
    ------
    CampaignError
    """
    where = "[uncertainty]"
    known(where, table, _KEYS)
    numbers = [name for name, out in study.outputs.items() if not out.text]
    output = table.get("output", numbers[0])
    if output not in numbers:
        raise CampaignError(f"{where} output = {output!r} is {unknown(str(output), numbers, 'outputs that are numbers')}")
    limit = table.get("limit")
    given = {"limit": None if limit is None else quantities(f"{where} limit", limit, study.outputs[output].unit)}
    if "confidence" in table:
        given["confidence"] = fraction(f"{where} confidence", table["confidence"])
    if "sobol" in table:
        given["sobol"] = whole(f"{where} sobol", table["sobol"], 2)
        if given["sobol"] & (given["sobol"] - 1):
            raise CampaignError(f"{where} sobol = {given['sobol']}: a power of two is needed, such as 64, 128, 256")
    given |= {name: truth(f"{where} {name}", table[name]) for name in ("second_order", "tornado", "form") if name in table}
    texts = [name for k, name in enumerate(study.names) if study.space.labels(k)]
    if texts:
        raise CampaignError(f"{where}: factor {texts[0]!r} lists texts; tolerances are distributions of numbers")
    return Uncertainty(output, **given)


@dataclass(frozen=True, eq=False)
class UncertaintyResults:
    """What was found; None where it was not asked for or not possible, and `notes` says why."""

    settings: Uncertainty
    probability: object = None
    tornado: object = None
    form: object = None
    sobol: object = None
    sobol_results: object = None
    notes: tuple[str, ...] = ()


def values_of(results, output):
    """Values of an output (n,), nan where there is none, and which cases without a value lie above every limit: vehicles that stay stable."""
    values = results[output]
    above = np.zeros(len(values), bool)
    if output == "speed" and "verdict" in results.outputs:
        from railsym.sweep.critical_speed import STABLE

        above = np.isnan(values) & (results["verdict"] == STABLE)
    return values, above


def probability_of(settings, results):
    """`railsym.uncertainty.Probability` that the output lies below the limit.

    Raises
    ------
    UncertaintyError
        No case with a known side.
    """
    from railsym.uncertainty import probability_below

    values, above = values_of(results, settings.output)
    # a limit beyond the range of speeds: cases that stay stable may lie on either side of it
    above = above & (settings.limit <= getattr(results.study.analysis, "speed_range", (0.0, np.inf))[1])
    return probability_below(values, settings.limit, above=above, confidence=settings.confidence)


def assess(settings, results, sobol_results):
    """Everything but the runs: from results of the plan and of Saltelli's cases.

    Parameters
    ----------
    settings : Uncertainty
    results : railsym.sweep.Results
    sobol_results : railsym.sweep.Results or None

    Returns
    -------
    UncertaintyResults
    """
    from railsym.uncertainty import SpeedModel, Tolerances, form, sobol_indices, tornado

    study, notes, found = results.study, [], {}

    def attempt(name, function):
        try:
            found[name] = function()
        except RailsymError as error:
            notes.append(f"{name}: {error}")

    if settings.limit is not None:
        attempt("probability", lambda: probability_of(settings, results))
    if sobol_results is not None:
        attempt("sobol", lambda: sobol_indices(study.names, sobol_results[settings.output], second_order=settings.second_order,
                                               confidence=settings.confidence, seed=study.seed))
    if settings.output == "speed" and (settings.tornado or (settings.form and settings.limit is not None)):
        attempt("model", lambda: SpeedModel.of(study))
    model, tolerances = found.pop("model", None), Tolerances.of(study)
    if model is not None and settings.tornado:
        attempt("tornado", lambda: tornado(model, tolerances, check=True))
    if model is not None and settings.form and settings.limit is not None:
        attempt("form", lambda: form(model, tolerances, settings.limit))
    return UncertaintyResults(settings, **found, sobol_results=sobol_results, notes=tuple(notes))


def sobol_study(study, settings):
    """The study with Saltelli's cases in place of its plan."""
    from railsym.campaign.variants import variant
    from railsym.sweep import Table
    from railsym.uncertainty import saltelli

    unit = saltelli(len(study.names), settings.sobol, second_order=settings.second_order, seed=study.seed)
    return variant(study, plan=Table(unit, scale="unit_cube"))
