# SPDX-License-Identifier: BSD-3-Clause
"""Optimisation of suspension parameters, with one objective (SciPy) or several (pymoo), and robust designs.

    problem = rs.optimise.Problem([Variable("anti_yaw_damper.damping", 1e5, 1e6, "N*s/m", scale="log")], evaluate,
                                  [Objective("speed", "maximise", "m/s")])
    print(rs.optimise.optimise(problem, history="damper.jsonl"))

Every case goes to a history file as it ends; an optimisation that is started again goes on from it.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Case": "history",
    "Constraint": "problem",
    "History": "history",
    "Objective": "problem",
    "OptimisationError": "errors",
    "Optimum": "result",
    "ParetoFront": "result",
    "Problem": "problem",
    "Robust": "robust",
    "SpeedDesign": "speeds",
    "Variable": "problem",
    "design_of": "design",
    "optimise": "local",
    "pareto_front": "pareto",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
