# SPDX-License-Identifier: BSD-3-Clause
"""A kernel at a given state: its residual and pencil, written out.

The straight-line code is evaluated line by line with some inputs replaced, so that nothing is derived a second time.
"""

from __future__ import annotations

import sympy as sm

from derive.tape import LawCall

SEEDS = {name: sm.Symbol(name, real=True) for name in ("cq", "cu", "ca")}


def at_state(kernel, given, default):
    """Residual and pencil of a kernel where inputs have given values.

    Parameters
    ----------
    kernel : derive.tangent.Kernel
    given : dict of str to sympy expression or number
        By the names of inputs.
    default : callable
        Value of each other `Input`, such as `at_rest`.

    Returns
    -------
    residual : Matrix (rows, 1)
    pencil : Matrix (rows, columns)
        In the seeds cq, cu, ca.
    """
    values = {entry.symbol: sm.sympify(given.get(str(entry.symbol), default(entry))) for entry in kernel.tape.inputs}
    _evaluate(kernel.tape.lines, values)
    _evaluate(kernel.partials, values)
    for lines in kernel.columns:
        _evaluate(lines, values)
    residual = sm.Matrix([sm.expand(row.xreplace(values)) for row in kernel.rows])
    pencil = sm.zeros(len(kernel.rows), len(kernel.seeds))
    for place, entry in kernel.entries.items():
        pencil[place] = sm.expand(sm.sympify(entry).xreplace(values))
    return residual, pencil


def _evaluate(lines, values):
    for line in lines:
        if isinstance(line, LawCall):
            values.update({symbol: symbol for symbol in line.symbols()})
        else:
            symbol, expression = line
            values[symbol] = sm.expand(sm.sympify(expression).xreplace(values))


def at_rest(entry):
    """An input in the design position on straight, level track: parameters stay, coordinates and their rates are 0."""
    if entry.meaning.startswith("cos of"):
        return 1
    if entry.unit in _COORDINATES or entry.meaning.startswith("sin of") or entry.meaning.startswith(_MOVING):
        return 0
    return _identity(entry)


_COORDINATES = ("m/s or rad/s", "m/s^2 or rad/s^2")
_MOVING = ("displacement", "angular velocity", "rate of", "speed of the track frame along", "gravity")


def _identity(entry):
    """1 and 0 for a rotation matrix, else the symbol."""
    name = str(entry.symbol)
    if entry.unit == "-" and name[-2:].isdigit() and name[:-2] in ("C", "A1_", "A2_"):
        return int(name[-2] == name[-1])
    return entry.symbol


def matrices(pencil):
    """Stiffness, damping and mass of a pencil K cq + C cu + M ca."""
    return tuple(pencil.applyfunc(lambda entry, seed=seed: sm.expand(entry).coeff(seed)) for seed in SEEDS.values())
