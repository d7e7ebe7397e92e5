# SPDX-License-Identifier: BSD-3-Clause
"""Criteria of a run as outputs of a study: one number each, the worst of all places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from railsym import criteria
from railsym.sweep.analysis import Output


@dataclass(frozen=True)
class Criterion:
    """A criterion of `railsym.criteria` as outputs.

    Attributes
    ----------
    outputs : dict of str to Output
    values : callable
        Run and place to values, in the order of the outputs.
    """

    outputs: dict
    values: Callable

    def judge(self, run, place):
        """Outputs of a run; nan where it stopped too early.

        Raises
        ------
        CriterionError
            A run that was completed and cannot be judged: the case is to say so.
        """
        try:
            values = self.values(run, place)
        except criteria.CriterionError:
            if run.status == "completed":
                raise
            values = [np.nan] * len(self.outputs)
        return dict(zip(self.outputs, map(float, values), strict=True))


def _instability(run, place):
    found = criteria.instability(run)
    return max(box.sustained for box in found.axleboxes), max(box.peak for box in found.axleboxes), found.unstable


def _derailment(run, place):
    found = criteria.derailment(run)
    return [abs(found.worst(kind).value) for kind in ("Y/Q", "sum Y", "Q", "unloading")]


def _body(run, place):
    found = criteria.body_acceleration(run, channels=(f"{place}.ay", f"{place}.az"))
    return [abs(found[f"{what} {place}.{axis}"].value) for axis in ("ay", "az") for what in ("peak", "r.m.s.")]


def _comfort(run, place):
    found = criteria.comfort(run, place=place)
    return found.partial, found.percentile["y"], found.percentile["z"]


def _hunting(run, place):
    found = criteria.hunting_frequency(run, channels="wheelset*.y")
    return found.frequency_hz, found.amplitude


CRITERIA = {
    "instability": Criterion({"instability.sustained": Output("m/s^2", "level that six consecutive cycles reach above an axlebox, worst place"),
                              "instability.peak": Output("m/s^2", "largest filtered acceleration above an axlebox"),
                              "instability.unstable": Output("-", "1 where six cycles exceed the limit")}, _instability),
    "derailment": Criterion({"derailment.YQ": Output("-", "largest Y/Q, 2 m mean, 99.85 %"),
                             "derailment.sum_Y": Output("N", "largest sum of Y of a wheelset, 2 m mean, 99.85 %"),
                             "derailment.Q": Output("N", "largest Q, 20 Hz, 99.85 %"),
                             "derailment.unloading": Output("-", "largest unloading of a wheel, 99.85 %")}, _derailment),
    "body_acceleration": Criterion({"body.lateral_peak": Output("m/s^2", "lateral acceleration of the body, 0.4 to 10 Hz, percentiles"),
                                    "body.lateral_rms": Output("m/s^2", "its r.m.s."),
                                    "body.vertical_peak": Output("m/s^2", "vertical acceleration of the body, 0.4 to 10 Hz, percentiles"),
                                    "body.vertical_rms": Output("m/s^2", "its r.m.s.")}, _body),
    "comfort": Criterion({"comfort.N_MV": Output("-", "mean comfort after EN 12299"), "comfort.CCy": Output("m/s^2", "95 % of the continuous lateral comfort"),
                          "comfort.CCz": Output("m/s^2", "95 % of the continuous vertical comfort")}, _comfort),
    "hunting": Criterion({"hunting.frequency_hz": Output("Hz", "leading frequency of the wheelsets' lateral motions"),
                          "hunting.amplitude": Output("m", "its amplitude")}, _hunting),
}
