# SPDX-License-Identifier: BSD-3-Clause
"""Straight-line code: a list of small definitions from inputs to outputs.

A kernel is derived in layers (rotation, arm, separation, force ...), each a short
expression of earlier symbols. Keeping the layers, instead of substituting them into
each other, is what keeps the tangents short.
"""

from dataclasses import dataclass, field

import sympy as sm


@dataclass(frozen=True)
class Input:
    """One input of a kernel: its slot is its place in the kernel's list."""

    symbol: sm.Symbol
    unit: str
    meaning: str


@dataclass(frozen=True)
class LawCall:
    """The scalar force law of an element, a C function (``csrc/laws.h``).

    ``force`` and ``state`` are its values f(e, v, s, w) and g(e, v, s, w);
    ``slopes`` maps (output, argument) to the symbol of the partial derivative.
    """

    arguments: tuple
    outputs: tuple
    slopes: dict

    def symbols(self):
        return (*self.outputs, *self.slopes.values())


@dataclass
class Tape:
    """Inputs, definitions in order, and the symbols a pencil is seeded with."""

    name: str
    summary: str
    inputs: list = field(default_factory=list)
    lines: list = field(default_factory=list)  # (Symbol, Expr) or LawCall

    def input(self, name, unit, meaning):
        """Declare one input and return its symbol."""
        symbol = sm.Symbol(name, real=True)
        self._refuse_second(symbol)
        self.inputs.append(Input(symbol, unit, meaning))
        return symbol

    def vector(self, name, size, unit, meaning):
        """Declare ``size`` inputs ``name0 ...`` and return them as a column."""
        return sm.Matrix([self.input(f"{name}{k}", unit, meaning) for k in range(size)])

    def matrix(self, name, unit, meaning):
        """Declare nine inputs, row by row, and return them as a 3 x 3 matrix."""
        entries = [self.input(f"{name}{i}{j}", unit, meaning) for i in range(3) for j in range(3)]
        return sm.Matrix(3, 3, entries)

    def let(self, name, value):
        """Define ``name`` (a scalar, or a matrix entry by entry); atoms pass through."""
        if isinstance(value, sm.MatrixBase):
            flat = [self.let(f"{name}{k}", entry) for k, entry in enumerate(value)]
            return sm.Matrix(*value.shape, flat)
        value = sm.sympify(value)
        if value.is_Atom:
            return value
        symbol = sm.Symbol(name, real=True)
        self._refuse_second(symbol)
        self.lines.append((symbol, value))
        return symbol

    def _refuse_second(self, symbol):
        """A name is defined once: two layers of one name would silently mix."""
        known = {entry.symbol for entry in self.inputs}
        known |= {line[0] for line in self.lines if not isinstance(line, LawCall)}
        if symbol in known:
            raise ValueError(f"kernel {self.name}: {symbol} is defined twice")

    def common(self, prefix, values):
        """Define the shared subexpressions of ``values``; return the short remainders."""
        symbols = (sm.Symbol(f"{prefix}{k}", real=True) for k in range(10**6))
        shared, short = sm.cse(list(values), symbols=symbols, order="none", list=True)
        self.lines.extend(shared)
        return short

    def law(self, elongation, rate, state, state_rate):
        """Call the force law; return the symbols of force f and state residual g."""
        arguments = (elongation, rate, state, state_rate)
        outputs = tuple(sm.Symbol(name, real=True) for name in ("f", "g"))
        slopes = {
            (out, argument): sm.Symbol(f"{out}_{tag}", real=True)
            for out in outputs
            for tag, argument in zip("evsw", arguments, strict=True)
        }
        self.lines.append(LawCall(arguments, outputs, slopes))
        return outputs


def cross(a, b):
    """Vector product of two columns, unexpanded."""
    return sm.Matrix([
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ])
