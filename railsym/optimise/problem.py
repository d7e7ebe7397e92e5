# SPDX-License-Identifier: BSD-3-Clause
"""An optimisation as data: variables with bounds, objectives and constraints on named outputs."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches

import numpy as np

from railsym.optimise.errors import OptimisationError

SENSES = ("maximise", "minimise")


@dataclass(frozen=True)
class Variable:
    """A parameter to be chosen.

    Attributes
    ----------
    name : str
    low, high : float
        Bounds, SI.
    unit : str
    start : float, optional
        Where a local method begins; the middle of the bounds when not given.
    scale : {"linear", "log"}
        How the range is covered: "log" for stiffnesses and dampings that span decades.
    """

    name: str
    low: float
    high: float
    unit: str = ""
    start: float | None = None
    scale: str = "linear"

    def __post_init__(self):
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise OptimisationError(f"variable {self.name!r}: bounds {self.low!r} to {self.high!r} {self.unit}; two finite ascending numbers are needed")
        if self.scale not in ("linear", "log") or (self.scale == "log" and self.low <= 0.0):
            raise OptimisationError(f"variable {self.name!r}: scale {self.scale!r} with a low bound of {self.low:g}; 'linear', or 'log' with bounds above 0")
        if self.start is not None and not self.low <= self.start <= self.high:
            raise OptimisationError(f"variable {self.name!r}: start {self.start:g} is outside its bounds {self.low:g} to {self.high:g} {self.unit}")

    def value(self, place):
        """SI value at a place 0..1 between the bounds."""
        if self.scale == "log":
            return float(np.clip(self.low * (self.high / self.low)**place, self.low, self.high))    # the power rounds beyond the bounds
        return float(np.clip(self.low + place * (self.high - self.low), self.low, self.high))

    def place(self, value):
        """Place 0..1 of an SI value."""
        if self.scale == "log":
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def slope(self, value):
        """d(value)/d(place)."""
        return value * math.log(self.high / self.low) if self.scale == "log" else self.high - self.low


@dataclass(frozen=True)
class Objective:
    """What is to be best.

    Attributes
    ----------
    outputs : tuple of str
        One output, or several of which the worst counts: the lowest where it is maximised, the highest where it is minimised.
    sense : {"maximise", "minimise"}
    unit : str
    """

    outputs: tuple[str, ...]
    sense: str
    unit: str = ""

    def __post_init__(self):
        if isinstance(self.outputs, str):
            object.__setattr__(self, "outputs", (self.outputs,))
        object.__setattr__(self, "outputs", tuple(self.outputs))
        if self.sense not in SENSES or not self.outputs:
            raise OptimisationError(f"objective {', '.join(self.outputs)!r}: sense {self.sense!r}; there are {' and '.join(SENSES)}")

    @property
    def sign(self):
        """-1 where the output is maximised: methods minimise."""
        return -1.0 if self.sense == "maximise" else 1.0

    @property
    def name(self):
        """For headings."""
        worst = {"maximise": "lowest of ", "minimise": "highest of "}[self.sense] if len(self.outputs) > 1 else ""
        return worst + ", ".join(self.outputs)

    def value(self, outputs):
        """Of the outputs of a case, in their unit."""
        return (min if self.sense == "maximise" else max)(outputs[name] for name in self.outputs)


@dataclass(frozen=True)
class Constraint:
    """Bounds that an output must keep.

    Attributes
    ----------
    output : str
    low, high : float, optional
        At least one of them.
    unit : str
    """

    output: str
    low: float | None = None
    high: float | None = None
    unit: str = ""

    def __post_init__(self):
        if self.low is None and self.high is None:
            raise OptimisationError(f"constraint on {self.output!r}: a low or a high bound is needed")

    def violations(self, outputs):
        """By how much each bound is broken, relative to its size (or to 1 for a bound of 0): at most 0 where it is kept."""
        value, found = outputs[self.output], []
        if self.low is not None:
            found.append((self.low - value) / (abs(self.low) or 1.0))
        if self.high is not None:
            found.append((value - self.high) / (abs(self.high) or 1.0))
        return found

    def __str__(self):
        low = "" if self.low is None else f"{self.low:g} <= "
        high = "" if self.high is None else f" <= {self.high:g}"
        return f"{low}{self.output}{high} {self.unit}".rstrip()


@dataclass(frozen=True, eq=False)
class Problem:
    """What to choose, what to compute, what is good.

    Attributes
    ----------
    variables : tuple of Variable
    evaluate : callable
        Values (k,) in SI to a dict of outputs (float; texts for messages). Raises where there is no result; importable, so that process pools can
        carry it. With a method ``with_gradient(x)`` that gives (outputs, dict of output to gradient (k,)) the methods that use gradients have them.
    objectives : tuple of Objective
    constraints : tuple of Constraint
    description : dict
        What `evaluate` computes, as plain data: two problems with the same description, variables, objectives and constraints may share a history.
    """

    variables: tuple[Variable, ...]
    evaluate: Callable
    objectives: tuple[Objective, ...]
    constraints: tuple[Constraint, ...] = ()
    description: dict = field(default_factory=dict)

    def __post_init__(self):
        for name in ("variables", "objectives", "constraints"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if not self.variables or not self.objectives:
            raise OptimisationError("an optimisation needs at least one variable and one objective")
        names = [variable.name for variable in self.variables]
        if len(set(names)) < len(names):
            raise OptimisationError(f"variables {', '.join(names)}: one is named twice")

    @property
    def names(self):
        """Of the variables."""
        return tuple(variable.name for variable in self.variables)

    @property
    def needed(self):
        """Outputs that objectives and constraints use."""
        return tuple(dict.fromkeys([name for o in self.objectives for name in o.outputs] + [c.output for c in self.constraints]))

    def values(self, places):
        """SI values at places 0..1, shape (k,)."""
        return np.array([variable.value(p) for variable, p in zip(self.variables, places)])

    def places(self, values):
        """Places 0..1 of SI values."""
        return np.array([variable.place(v) for variable, v in zip(self.variables, values)])

    def start(self):
        """Places of the starts, shape (k,)."""
        return np.array([0.5 if v.start is None else v.place(v.start) for v in self.variables])

    def checked(self, outputs):
        """The outputs of a case, where all that are needed are there and finite; texts are left out.

        Raises
        ------
        OptimisationError
            One is missing (the nearest names are given) or not finite.
        """
        for name in self.needed:
            if name not in outputs:
                near = get_close_matches(name, outputs, 3, 0.3)
                raise OptimisationError(f"there is no output {name!r}; there are {', '.join(outputs)}" + (f" (nearest: {near[0]})" if near else ""))
            if isinstance(outputs[name], str) or not math.isfinite(outputs[name]):
                texts = ", ".join(f"{key} {text}" for key, text in outputs.items() if isinstance(text, str) and text)
                raise OptimisationError(f"output {name!r} is {outputs[name]}" + (f" ({texts})" if texts else ""))
        return {name: float(value) for name, value in outputs.items() if not isinstance(value, str) and math.isfinite(value)}

    def violation(self, outputs):
        """Largest violation of a constraint; 0 where all are kept."""
        return max([0.0, *(v for constraint in self.constraints for v in constraint.violations(outputs))])

    def as_data(self):
        """As plain data."""
        objectives = [{"outputs": list(o.outputs), "sense": o.sense, "unit": o.unit} for o in self.objectives]
        return {"variables": [vars(v) for v in self.variables], "objectives": objectives,
                "constraints": [vars(c) for c in self.constraints], "description": self.description}

    def key(self):
        """Hash of what the outputs of a case depend on: variables by name and unit, and the description."""
        data = {"variables": [(v.name, v.unit) for v in self.variables], "description": self.description}
        return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:16]
