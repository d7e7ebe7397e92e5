# SPDX-License-Identifier: BSD-3-Clause
"""Schaffer's function of two objectives, f1 = x^2 and f2 = (x - 2)^2: its front is 0 <= x <= 2, where sqrt(f1) + sqrt(f2) = 2 (Schaffer 1985)."""

from railsym.optimise import Objective, Problem, Variable


class Schaffer:
    """As ``evaluate``; may be stopped after some calls, and may have a hole without results."""

    def __init__(self, stop_after=None, hole=None):
        self.left, self.hole, self.calls = stop_after, hole, 0

    def __call__(self, x):
        if self.left is not None and self.calls >= self.left:
            raise KeyboardInterrupt
        self.calls += 1
        if self.hole and self.hole[0] < x[0] < self.hole[1]:
            raise ValueError("no result in the hole")
        return {"f1": float(x[0]**2), "f2": float((x[0] - 2.0)**2)}


def schaffer(evaluate, **options):
    return Problem([Variable("x", -10.0, 10.0)], evaluate, [Objective("f1", "minimise"), Objective("f2", "minimise")], **options)
