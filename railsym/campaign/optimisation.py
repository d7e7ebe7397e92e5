# SPDX-License-Identifier: BSD-3-Clause
"""``[optimise.NAME]`` of a study file: variables, objectives, constraints, and by which method."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path

import numpy as np

from railsym.campaign.errors import CampaignError
from railsym.campaign.tables import known, quantities, truth, whole
from railsym.optimise import Constraint, Objective, Problem, Robust, Variable, design_of, optimise, pareto_front
from railsym.vehicle_checks import unknown

_KEYS = ("variables", "analyses", "maximise", "minimise", "maximise_lowest", "minimise_highest", "constraints", "robust", "method", "most",
         "population", "generations", "seed", "recheck", "description")
_OPTIONS = {"method": ("gradient", "simplex", "global")}


@dataclass(frozen=True, eq=False)
class Optimisation:
    """One optimisation of a campaign.

    Attributes
    ----------
    name : str
    problem : railsym.optimise.Problem
    options : dict
        Of `railsym.optimise.optimise` or `railsym.optimise.pareto_front`.
    recheck : bool
        Run the study again at the optimum.
    robust : int or None
        Cases a design.
    text : str
        What it is for.
    """

    name: str
    problem: Problem
    options: dict = field(default_factory=dict)
    recheck: bool = False
    robust: int | None = None
    text: str = ""

    @property
    def pareto(self):
        """Whether it has several objectives."""
        return len(self.problem.objectives) > 1

    def run(self, history, resume, executor, follow):
        """`railsym.optimise.Optimum` or `railsym.optimise.ParetoFront`."""
        method = pareto_front if self.pareto else optimise
        return method(self.problem, history=history, resume=resume, executor=executor, follow=follow, **self.options)


def read(name, table, study, folder=None):
    """`Optimisation` from its table.

    Raises
    ------
    CampaignError, OptimisationError
    """
    where = f"[optimise.{name}]"
    known(where, table, _KEYS)
    analyses = _analyses(where, table.get("analyses", {}), folder)
    given = analyses or {"": study.analysis}
    outputs = {f"{prefix}.{n}" if prefix else n: out.unit for prefix, a in given.items() for n, out in a.outputs(study.base()).items() if not out.text}
    inputs = {n: one for a in given.values() for n, one in a.inputs(study.base()).items()}
    variables = [_variable(where, n, entry, study, inputs) for n, entry in _table(where, "variables", table).items()]
    objectives = _objectives(where, table, outputs)
    constraints = [_constraint(where, n, entry, outputs) for n, entry in table.get("constraints", {}).items()]
    robust = whole(f"{where} robust", table["robust"], 2) if "robust" in table else None
    problem = Problem(variables, _evaluate(where, study, variables, analyses, robust, objectives, constraints), objectives, constraints,
                      _description(study, analyses, robust))
    options = {key: whole(f"{where} {key}", table[key], 1) for key in ("most", "population", "generations") if key in table}
    options["seed"] = whole(f"{where} seed", table.get("seed", study.seed), 0)
    if "method" in table:
        if table["method"] not in _OPTIONS["method"]:
            raise CampaignError(f"{where} method = {table['method']!r} is {unknown(str(table['method']), _OPTIONS['method'], 'methods')}")
        options["method"] = table["method"]
    several = len(objectives) > 1
    wrong = [key for key in (("method", "most", "recheck") if several else ("generations",)) if key in table]
    if wrong:
        raise CampaignError(f"{where} {wrong[0]} is for optimisations with {'one objective' if several else 'several objectives'}; this has {len(objectives)}")
    return Optimisation(name, problem, options, truth(f"{where} recheck", table.get("recheck", False)), robust, str(table.get("description", "")))


def _table(where, key, table):
    if not isinstance(table.get(key), dict) or not table[key]:
        raise CampaignError(f'{where} {key} is missing: write [optimise.NAME.{key}] and a line such as "anti_yaw_damper.damping" = '
                            '{ between = [[100, 900], "kN*s/m"] }')
    return table[key]


def _analyses(where, table, folder):
    from railsym.sweep.analysis import from_table
    from railsym.sweep.errors import SweepError

    try:
        return {name: from_table(entry, folder) for name, entry in table.items()}
    except SweepError as error:
        raise CampaignError(f"{where}.analyses: {error}") from None


def _variable(where, name, entry, study, inputs):
    from railsym.sweep.errors import SweepError
    from railsym.sweep.space import target

    place = f'{where} variables "{name}"'
    try:
        unit = target(name, study.base(), inputs).unit
    except SweepError as error:
        raise CampaignError(f"{place}: {error}") from None
    known(place, entry, ("between", "start", "scale"))
    low, high = quantities(f"{place} between", entry.get("between"), unit, 2)
    start = quantities(f"{place} start", entry["start"], unit) if "start" in entry else _present(name, study, low, high)
    return Variable(name, low, high, unit, start, entry.get("scale", "linear"))


def _present(name, study, low, high):
    """The vehicle's own value, where it lies within the bounds."""
    if name not in study.base().parameters:
        return None
    value = float(study.base().parameters[name].value)
    return value if low <= value <= high else None


def _objectives(where, table, outputs):
    found = []
    for key, sense, worst in (("maximise", "maximise", False), ("minimise", "minimise", False), ("maximise_lowest", "maximise", True),
                              ("minimise_highest", "minimise", True)):
        if key in table:
            names = [table[key]] if isinstance(table[key], str) else table[key]
            if not isinstance(names, list) or not names or not all(isinstance(n, str) for n in names):
                raise CampaignError(f"{where} {key} = {table[key]!r}: the name of an output, or a list of them, is needed")
            found += [Objective(tuple(group), sense, _unit(where, key, group[0], outputs)) for group in ([names] if worst else [[n] for n in names])]
            for name in names:
                _unit(where, key, name, outputs)
    if not found:
        raise CampaignError(f"{where} has no objective: write maximise, minimise, maximise_lowest or minimise_highest = one of {', '.join(outputs)}")
    return found


def _unit(where, key, name, outputs):
    """Unit of an output, or of the output that a statistic is of."""
    from railsym.optimise.robust import output_of

    base = name if name in outputs else output_of(name)
    if base not in outputs:
        raise CampaignError(f"{where} {key}: {name!r} is {unknown(name, outputs, 'outputs')}")
    return outputs[base]


def _constraint(where, name, entry, outputs):
    place = f'{where} constraints "{name}"'
    unit = _unit(where, "constraints", name, outputs)
    known(place, entry, ("at_least", "at_most"))
    low, high = (quantities(f"{place} {key}", entry[key], unit) if key in entry else None for key in ("at_least", "at_most"))
    return Constraint(name, low, high, unit)


def _evaluate(where, study, variables, analyses, robust, objectives, constraints):
    names = [v.name for v in variables]
    needed = dict.fromkeys([n for o in objectives for n in o.outputs] + [c.output for c in constraints])
    if robust is None:
        wrong = [n for n in needed if _is_statistic(n)]
        if wrong:
            raise CampaignError(f"{where}: {wrong[0]!r} is a statistic over tolerances; write robust = 32 (cases a design)")
        return design_of(study, names, analyses)
    wrong = [n for n in needed if not _is_statistic(n)]
    if wrong:
        raise CampaignError(f"{where}: {wrong[0]!r} with robust: name a statistic, such as {wrong[0]}.p5, {wrong[0]}.mean or {wrong[0]}.mean-2std")
    full = [*names, *(n for n in study.names if n not in names)]
    return Robust(design_of(study, full, analyses), tuple(full), tuple(names), tolerances_of(study, names), tuple(needed), samples=robust, seed=study.seed)


def _is_statistic(name):
    from railsym.optimise.robust import output_of

    return output_of(name) is not None


class _Factor:
    """A factor as a distribution in SI, or of the ratio to its nominal value."""

    def __init__(self, space, k, ratio):
        self.space, self.k, self.scale = space, k, 1.0 / space.nominal[k] if ratio else 1.0

    def ppf(self, probability):
        return self.scale * np.asarray(self.space.quantile(self.k, probability))


def tolerances_of(study, variables):
    """The study's factors as tolerances of a design: those of variables relative to the vehicle's own value."""
    return {name: _Factor(study.space, k, name in variables) for k, name in enumerate(study.names)}


def _description(study, analyses, robust):
    """What the outputs of a case depend on, the content of files included."""
    from hashlib import sha256

    from railsym.sweep.analysis import to_table

    content = {"study": study.hash} if robust else {"vehicle_file": sha256(study.path.read_bytes()).hexdigest(), "configuration": study.configuration,
                                                    "set": study.set}
    files = {getattr(a, one.name) for a in [*analyses.values(), study.analysis] for one in fields(a) if one.metadata.get("path")}
    digests = {str(f): sha256(Path(f).read_bytes()).hexdigest() for f in files if f is not None and Path(f).is_file()}
    return content | {"analyses": {n: to_table(a) for n, a in analyses.items()} or to_table(study.analysis), "robust": robust, "files": digests}
