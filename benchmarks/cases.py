# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of changed vehicles, case after case, against a loop of dense eigenvalues over the same cases.

A case is a vehicle with twelve other suspension numbers at a conicity: it is changed, its tables, preload and matrices are made,
and the lowest critical speed by real part is found. CPU time of one core, the smallest of several rounds over the same cases.
"""

from __future__ import annotations

from time import process_time

import numpy as np

from benchmarks.measure import Figure

_CASES, _ROUNDS = 20, 7
_DENSE = 4             # cases that the dense loop is measured on
_GRID = 25             # speeds of its scan, 10 m/s apart: coarse, so to its favour
_AGREE = 1e-6


def cases_figures():
    """Cases a second, and how many times a dense-eigenvalue loop."""
    return [*_figures("AS_K", 100.0, "symmetric"), *_figures("AS_Mal_K", None, "one damper absent: no symmetry")]


def _figures(configuration, limit, what):
    import railsym as rs

    vehicle = rs.load_vehicle("pendolino").configured(configuration)
    cases = _draws(vehicle)
    solver = rs.CriticalSpeedSolver(vehicle)
    found = [solver.solve(*case) for case in cases]
    seconds = min(_cpu_time(lambda: [solver.solve(*case) for case in cases]) for _ in range(_ROUNDS)) / _CASES
    dense, one = np.mean([_dense_loop(vehicle, case, result) for case, result in zip(cases[:_DENSE], found)], axis=0)
    solves = np.mean([result.scanned_speeds + result.newton_steps for result in found])
    bound = None if limit is None else 20.0
    return [Figure(f"critical speeds, {configuration}", 1.0 / seconds, "cases/s", limit, f"{_CASES} cases of 12 numbers, {what}",
                   at_least=True),
            Figure("dense eigvals to the same answer", 1e3 * dense, "ms", None, f"a case: {_GRID} speeds, then Brent's method to {_AGREE:g}"),
            Figure("ratio, same answer", dense / seconds, "-", bound, "dense over railsym", at_least=True),
            Figure("ratio, solve for solve", one * solves / seconds, "-", None, f"{solves:.1f} eigenproblems and Newton steps a case")]


def _draws(vehicle):
    """Changes and a conicity for each case: twelve of the suspension's numbers times 0.74 to 1.35."""
    kinds = ("stiffness", "damping", "series_stiffness", "rotational_stiffness", "rotational_damping")
    numbers = {name: v for name, v in vehicle.parameters.components().items() if name.split(".")[1] in kinds and v > 0.0}
    random = np.random.default_rng(7)
    return [({name: numbers[name] * np.exp(random.uniform(-0.3, 0.3)) for name in random.choice(sorted(numbers), 12, replace=False)},
             random.uniform(0.1, 0.4)) for _ in range(_CASES)]


def _cpu_time(function):
    start = process_time()
    function()
    return process_time() - start


def _dense_loop(vehicle, case, result):
    """CPU time (s) of one case by dense eigenvalues of the whole model, and of one of its eigenproblems."""
    from scipy.optimize import brentq

    import railsym as rs

    start, eigen = process_time(), []
    changes, conicity = case
    model = rs.linear_model(vehicle.replace(changes), rs.LinearContact(conicity=conicity))

    def growth(speed):
        matrix, began = model.state_matrix(speed), process_time()
        values = np.linalg.eigvals(matrix)
        eigen.append(process_time() - began)
        return values.real[np.abs(values.imag) > 1.0].max()    # without the constant-speed pair

    speeds = np.linspace(5.0, 250.0, _GRID)
    above = [growth(speed) > 0.0 for speed in speeds]
    first = above.index(True)
    speed = brentq(growth, speeds[first - 1], speeds[first], xtol=_AGREE * speeds[first])
    if abs(speed / result.speed - 1.0) > 2.0 * _AGREE:
        raise RuntimeError(f"dense critical speed {speed} m/s against {result.speed} m/s in case {case}")
    return process_time() - start, np.mean(eigen)
