# SPDX-License-Identifier: BSD-3-Clause
"""The function of Ishigami and Homma (1990) as an analysis of a study, and its Sobol indices in closed form.

    y = sin x1 + a sin^2 x2 + b x3^4 sin x1,     x uniform in [-pi, pi]
    V1 = (1 + b pi^4/5)^2/2,   V2 = a^2/8,   V13 = 8 b^2 pi^8/225
"""

from dataclasses import dataclass
from math import pi, sin

import numpy as np

from railsym.sweep.analysis import Analysis, Output
from railsym.sweep.space import Input

A, B = 7.0, 0.1
V1, V2, V13 = 0.5 * (1 + B * pi**4 / 5)**2, A * A / 8, 8 * B * B * pi**8 / 225
FIRST = np.array([V1, V2, 0.0]) / (V1 + V2 + V13)
TOTAL = np.array([V1 + V13, V2, V13]) / (V1 + V2 + V13)
INTERACTION = V13 / (V1 + V2 + V13)


def ishigami(x1, x2, x3):
    """y."""
    return sin(x1) + A * sin(x2)**2 + B * x3**4 * sin(x1)


@dataclass(frozen=True)
class Ishigami(Analysis):
    """Of the inputs x1, x2, x3; the vehicle has no part in it."""

    kind = "oracles.ishigami:Ishigami"

    def inputs(self, vehicle):
        return {name: Input("-", 0.0) for name in ("x1", "x2", "x3")}

    def outputs(self, vehicle):
        return {"y": Output("-", "Ishigami's function")}

    def solver(self, vehicle):
        return lambda case: {"y": ishigami(*(case.settings[name] for name in ("x1", "x2", "x3")))}
