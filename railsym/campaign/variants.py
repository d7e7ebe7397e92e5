# SPDX-License-Identifier: BSD-3-Clause
"""A study with something changed."""

from __future__ import annotations


def variant(study, *, plan=None, set=None):
    """The same study with another plan, or with more parameters set (SI).

    Parameters
    ----------
    study : railsym.sweep.Study
    plan : Plan, optional
    set : dict of str to float, optional

    Returns
    -------
    railsym.sweep.Study
    """
    from railsym.sweep import Study

    return Study(study.vehicle, study.analysis, study.factors, study.plan if plan is None else plan, configuration=study.configuration,
                 set=study.set | (set or {}), keep=study.keep, seed=study.seed)
