# SPDX-License-Identifier: BSD-3-Clause
"""Designs evaluated by the analyses of a study: critical speed, runs with comfort and Y/Q, whatever `railsym.sweep` has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from railsym.optimise.errors import OptimisationError
from railsym.optimise.speeds import SpeedDesign


def design_of(study, names: Sequence[str], analyses: Mapping | None = None):
    """The ``evaluate`` of a `Problem` from a study.

    Parameters
    ----------
    study : railsym.sweep.Study
        Gives the vehicle, its configuration and what is set.
    names : sequence of str
        Parameters of the vehicle or inputs of the analyses, in the order of the values.
    analyses : mapping of str to Analysis, optional
        Their outputs are ``NAME.output``. Without it the study's own, whose outputs have no prefix.

    Returns
    -------
    SpeedDesign or AnalysisDesign
        With gradients where all analyses are critical speeds.

    Raises
    ------
    OptimisationError
        A name that neither the vehicle nor the analyses know.
    """
    from railsym.sweep.critical_speed import CriticalSpeed
    from railsym.uncertainty.speed_model import SpeedModel

    given = {f"{name}.": analysis for name, analysis in analyses.items()} if analyses else {"": study.analysis}
    _check(study, names, given)
    if all(isinstance(analysis, CriticalSpeed) for analysis in given.values()):
        return SpeedDesign.of({prefix: SpeedModel.of(study, names, analysis) for prefix, analysis in given.items()})
    return AnalysisDesign(study.base(), study.settings, names, given)


def _check(study, names, given):
    from railsym.sweep.errors import SweepError
    from railsym.sweep.space import target

    inputs = {name: one for analysis in given.values() for name, one in analysis.inputs(study.base()).items()}
    for name in names:
        try:
            target(name, study.base(), inputs)
        except SweepError as error:
            raise OptimisationError(str(error)) from None


class AnalysisDesign:
    """Outputs of several analyses of one vehicle.

    Parameters
    ----------
    vehicle : Vehicle
    settings : mapping of str to float
        Inputs of the analyses that every design has.
    names : sequence of str
    analyses : mapping of str to Analysis
        By prefix of their outputs.

    Notes
    -----
    A vehicle that stays stable over the whole range of speeds has its upper end as ``speed``, and ``beyond_range`` = 1.
    """

    def __init__(self, vehicle, settings, names, analyses):
        self.vehicle, self.settings, self.names, self.analyses = vehicle, dict(settings), tuple(names), dict(analyses)
        self._inputs = {prefix: frozenset(analysis.inputs(vehicle)) for prefix, analysis in self.analyses.items()}
        self._solvers = {}

    def __getstate__(self):
        return self.__dict__ | {"_solvers": {}}      # a worker makes its own

    def __call__(self, x):
        """Outputs at x (SI).

        Raises
        ------
        OptimisationError
            Unstable at the lowest speed already.
        RailsymError
            What an analysis raises.
        """
        from railsym.sweep.worker import Case

        values = dict(zip(self.names, map(float, x), strict=True))
        inputs = frozenset().union(*self._inputs.values())
        changes = {name: value for name, value in values.items() if name not in inputs}
        outputs, beyond = {}, 0.0
        for prefix, analysis in self.analyses.items():
            if prefix not in self._solvers:
                self._solvers[prefix] = analysis.solver(self.vehicle)
            settings = {name: value for name, value in (self.settings | values).items() if name in self._inputs[prefix]}
            found = self._solvers[prefix](Case(self.vehicle, changes, settings))
            found, past = _within(found, analysis)
            beyond = max(beyond, past)
            outputs |= {prefix + name: value if isinstance(value, str) else float(value) for name, value in found.items()}
        return outputs | {"beyond_range": beyond}


def _within(found, analysis):
    """Results of a critical speed beyond its range as they count for a design; others as they are."""
    from railsym.sweep.critical_speed import STABLE, UNSTABLE, CriticalSpeed

    if not isinstance(analysis, CriticalSpeed):
        return found, 0.0
    if found["verdict"] == UNSTABLE:
        raise OptimisationError(f"unstable at {analysis.speed_range[0]:g} m/s already")
    if found["verdict"] == STABLE:
        return found | {"speed": analysis.speed_range[1]}, 1.0
    return found, 0.0
