# SPDX-License-Identifier: BSD-3-Clause
"""SymPy objects as Markdown: tables of inputs, straight-line code, matrices."""

from __future__ import annotations

import re

import sympy as sm

from derive.tape import LawCall

_GREEK = {"lam": r"\lambda", "V": "V", "side": r"\varsigma", "kH": "k_H", "Omega": r"\Omega", "slope": r"\delta_0", "grad": r"\delta_1"}
_TERM = 5     # terms of an entry of a matrix that is still printed in place


def input_table(tape):
    """Inputs as a table, entries of one vector or matrix and the like in one row."""
    groups = {}
    for entry in tape.inputs:
        groups.setdefault(_group(entry), []).append(str(entry.symbol))
    rows = ["| input | unit | meaning |", "|---|---|---|"]
    return rows + [f"| `{names[0]}`{f' to `{names[-1]}`' if len(names) > 1 else ''} | {unit.replace('*', ' ')} | {meaning} |"
                   for (_, unit, meaning), names in groups.items()]


def _group(entry):
    """Name, unit and meaning common to what stands in one row."""
    name = str(entry.symbol)
    each = re.match(r"(rate|sin|cos)(?: of)? u?_?(?:\w+?)(\d?)( of body \d)?$", entry.meaning)
    if each and "_" in name:
        body = each[3] or (f" of body {each[2]}" if each[2] else "")
        return name.split("_")[0], entry.unit, {"rate": "rates of the " + ("speeds" if name[0] == "a" else "coordinates"),
                                                "sin": "sines of the angles", "cos": "cosines of the angles"}[each[1]] + body
    return re.sub(r"_?\d+$", "", name), entry.unit, re.sub(r"^displacement [xyz]$", "displacement", entry.meaning)


def code(kernel):
    """The straight-line code of a kernel's residual, one definition a line."""
    said = []
    for line in kernel.tape.lines:
        if isinstance(line, LawCall):
            said.append(f"{', '.join(map(str, line.outputs))} = law({', '.join(map(str, line.arguments))})")
        else:
            said.append(f"{line[0]} = {line[1]}")
    return said


def symbols(names):
    """LaTeX of names of inputs."""
    found = {}
    for name in names:
        base, *rest = name.split("_", 1)
        tail = re.search(r"^([A-Za-z]+)(\d+)$", base)
        if name in _GREEK:
            found[name] = _GREEK[name]
        elif rest:
            found[name] = f"{base}_{{\\mathrm{{{rest[0].replace('_', ' ')}}}}}"
        elif tail:
            found[name] = f"{tail[1]}_{{{tail[2]}}}"
    return found


def latex(expression):
    """LaTeX of an expression or a matrix, names as `symbols`."""
    names = symbols(sorted(map(str, expression.free_symbols)))
    return sm.latex(expression, symbol_names={sm.Symbol(name, real=True): text for name, text in names.items()}, mat_delim="(")


def matrix(name, entries, coordinates):
    """A display of a square matrix whose entries are short, else a list of its entries that are not 0."""
    longest = max((len(sm.Add.make_args(entry)) for entry in entries), default=0)
    rows, columns = [[k for k in range(entries.rows) if any(entries[k, j] != 0 for j in range(entries.cols))],
                     [j for j in range(entries.cols) if any(entries[k, j] != 0 for k in range(entries.rows))]]
    if not rows:
        return [f"{name} = 0."]
    if longest <= _TERM and len(columns) <= 6:
        used = sorted({*rows, *columns})
        which = ", ".join(coordinates[k] for k in used)
        return [f"{name}, of {which}:", "", "$$", latex(entries.extract(used, used)), "$$"]
    found = [f"{name}, entries that are not 0:", ""]
    for k in rows:
        for j in columns:
            if entries[k, j] != 0 and not (j < k and sm.expand(entries[k, j] - entries[j, k]) == 0):
                twin = " (and its mirror)" if j != k and sm.expand(entries[k, j] - entries[j, k]) == 0 else ""
                found.append(f"- {coordinates[k]}, {coordinates[j]}{twin}: ${latex(sm.factor_terms(entries[k, j]))}$")
    return found
