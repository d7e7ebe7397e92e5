# SPDX-License-Identifier: BSD-3-Clause
"""Kernels one by one, and the 31-body vehicle: against the same straight-line code in NumPy and in Numba."""

from __future__ import annotations

import numpy as np

from benchmarks.measure import Figure, median_time

_COUNT = 64           # instances, in eight batches of eight
_CALLS = 10           # calls that a measured time covers
_NAMES = ("rigid_body", "wheelset_with_axleboxes", "bushing", "wheel_rail")


def kernel_figures():
    """Residual and pencil of each kernel without a force law, and of the Pendolino."""
    from derive.__main__ import kernels

    by_name = {kernel.tape.name: kernel for kernel in kernels()}
    figures = []
    for name in _NAMES:
        figures += _one(name, by_name[name])
    return figures + _vehicle()


def _vehicle():
    import railsym as rs
    from railsym.model import Model

    model = Model(rs.load_vehicle("pendolino").configured("AS_K"))
    q, u, a = np.zeros(model.size), model.rolling(60.0), np.zeros(model.size)
    residual = 1e6 * median_time(lambda: model.residual(q, u, a), 201)
    differences = median_time(lambda: [model.residual(q + step, u, a) for step in 1e-6 * np.eye(model.size)], 5) * 1e6
    return [Figure("residual of 31 bodies, without wheels", residual, "us", None, f"{model.size} coordinates, call from Python included"),
            Figure("its stiffness by differences of residuals", differences, "us", None, "one-sided, a call a coordinate")]


def _one(name, derived):
    """A kernel's residual and pencil (us an instance), and its code in NumPy and Numba."""
    from railsym import _core

    kernel, rows = _core.kernels()[name], _instances(name)
    assembly = _core.Assembly(kernel.slots[:, 3] >= 0)
    # all instances move with one set of coordinates, so that scattering costs little and the pencil stays small
    assembly.add(name, rows, np.tile(np.arange(kernel.coordinates), (_COUNT, 1)))
    random = np.random.default_rng(2)
    q, u, a = random.uniform(0.1, 0.4, (3, kernel.coordinates))
    ours = assembly.residual(q, u, a)
    columns = _columns(kernel, rows, q, u, a)
    residual, pencil = (1e6 / _COUNT * median_time(function, 201) for function in (lambda: assembly.residual(q, u, a), lambda: assembly.pencil(q, u, a, (1.0, 0.5, 0.2))))
    words = f"an instance, of {_COUNT}; {len(derived.tape.lines) + len(derived.rows)} lines"
    figures = [Figure(f"{name}: residual", residual, "us", None, words), Figure(f"{name}: residual and pencil", pencil, "us", None, words)]
    for peer, function in _peers(derived, columns).items():
        if not np.allclose(function(), ours, rtol=1e-9, atol=1e-9 * np.abs(ours).max()):
            raise RuntimeError(f"{name} in {peer} computes something else")
        theirs = 1e6 / _COUNT * median_time(lambda: [function() for _ in range(_CALLS)], 21) / _CALLS
        figures.append(Figure(f"{name}: residual in {peer} over ours", theirs / residual, "-", None, f"{theirs:.3g} us an instance, the same SymPy code; ours gathers and scatters coordinates too"))
    return figures


def _instances(name):
    """Parameters of the instances, as far from 0 as real ones."""
    from railsym import _core

    return np.random.default_rng(1).uniform(0.5, 1.5, (_COUNT, len(_core.kernels()[name].inputs)))


def _columns(kernel, rows, q, u, a):
    """All inputs (inputs, instances), coordinates in their slots."""
    columns = rows.T.copy()
    for k, slots in enumerate(kernel.slots):
        for slot, value in zip(slots, (q[k], u[k], a[k], np.sin(q[k]), np.cos(q[k]))):
            if slot >= 0:
                columns[slot] = value
    return columns


def _peers(derived, columns):
    """Name of a peer -> function that gives the sum of the residuals of all instances, (rows,)."""
    names = [str(entry.symbol) for entry in derived.tape.inputs]
    body = [f"    {symbol} = {_python(expression)}" for symbol, expression in derived.tape.lines]
    ended = ", ".join(_python(row) for row in derived.rows)
    text = "\n".join(["def kernel(inputs):", *(f"    {name} = inputs[{k}]" for k, name in enumerate(names)), *body, f"    return {ended}"])
    space = {"sqrt": np.sqrt}
    exec(compile(text, "kernel", "exec"), space)
    found = {"NumPy": lambda: np.array([np.sum(row) for row in space["kernel"](columns)])}
    try:
        import numba
    except ImportError:
        return found
    one, count, rows = numba.njit(space["kernel"]), columns.shape[1], len(derived.rows)
    by_instance = np.ascontiguousarray(columns.T)

    @numba.njit
    def total(table):
        found = np.zeros(rows)
        for k in range(count):
            values = one(table[k])
            for j in range(rows):
                found[j] += values[j]
        return found

    return found | {"Numba": lambda: total(by_instance)}


def _python(expression):
    from sympy.printing.pycode import pycode

    return pycode(expression, fully_qualified_modules=False)
