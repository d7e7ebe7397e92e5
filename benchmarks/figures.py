# SPDX-License-Identifier: BSD-3-Clause
"""The figures that the project watches, each measured in this run on one core."""

from __future__ import annotations

import itertools
import tempfile
from time import perf_counter

import numpy as np

from benchmarks.cases import cases_figures
from benchmarks.contact import contact_figures
from benchmarks.creep import creep_figures
from benchmarks.curving import curving_figures
from benchmarks.kernels import kernel_figures
from benchmarks.long_run import long_run_figures
from benchmarks.measure import ROOT, Figure, cost_of_code, median_time, printed_by
from benchmarks.wheel_rail import wheel_rail_figures
from benchmarks.sweep import sweep_figures
from benchmarks.tilt import tilt_figures
from benchmarks.track import track_figures
from benchmarks.transient import transient_figures
from benchmarks.transient_accuracy import accuracy_figures

_DERIVE = "from derive.__main__ import generated_files; generated_files()"
_IMPORT = "import time; start = time.perf_counter(); import railsym; print(time.perf_counter() - start)"
_USE = "import time; start = time.perf_counter(); import railsym as rs; rs.linearise; rs.critical_speed; print(time.perf_counter() - start)"
_GRID = 25            # speeds of the dense scan, 10 m/s apart: coarse, so to its favour
_SAMPLE = 24          # dense eigenproblems that the extrapolation rests on


def derivation():
    """Deriving all kernels, in a process of its own."""
    cpu, memory = cost_of_code(_DERIVE, ROOT)
    return [Figure("derive: CPU time", cpu, "s", 15.0, "python -m derive, everything"),
            Figure("derive: peak memory", memory, "MB", 300.0, "resident, of that process")]


def imports():
    """``import railsym``, and with the names of stability analysis; the smaller of three processes."""
    with tempfile.TemporaryDirectory() as elsewhere:
        bare, used = (min(printed_by(code, elsewhere) for _ in range(3)) for code in (_IMPORT, _USE))
    return [Figure("import railsym", bare, "s", 0.5), Figure("import railsym, use linearise and critical_speed", used, "s", 0.5)]


def linearisation():
    """State matrix of the 31-body vehicle for a new speed, a new conicity, a new parameter."""
    import railsym as rs

    vehicle = rs.load_vehicle("pendolino").configured("AS_K")
    count, contact = itertools.count(), rs.LinearContact(conicity=0.2)
    matrix = rs.linearise(vehicle, 70.0, contact).A

    def new_contact():
        return rs.linearise(vehicle, 70.0, rs.LinearContact(conicity=0.1 + 1e-6 * next(count)))

    def new_vehicle():
        return rs.linearise(vehicle.replace({"anti_yaw_damper.damping": 1e6 + next(count)}), 70.0, contact)

    states = f"31 bodies, {len(matrix)} states"
    dense = median_time(lambda: np.linalg.eigvals(matrix), 5)
    times = [median_time(function, 41) for function in (lambda: rs.linearise(vehicle, 70.0, contact), new_contact, new_vehicle)]
    return [Figure("linearise, same contact", 1e3 * times[0], "ms", 0.5, states),
            Figure("linearise, new conicity", 1e3 * times[1], "ms", None, states),
            Figure("linearise, new parameter", 1e3 * times[2], "ms", None, states),
            Figure("numpy.linalg.eigvals of the same A", 1e3 * dense, "ms"),
            Figure("eigvals over linearise, same contact", dense / times[0], "-", None, "how little linearising adds")]


def stability_figures():
    """Figures 8 to 10 (8 configurations, 8 conicities, 3 criteria) against dense eigenvalues over the same speeds."""
    import railsym as rs

    vehicle = rs.load_vehicle("pendolino")
    rs.critical_speed(vehicle.configured("AS_K"), 0.2)             # imports and first use
    start = perf_counter()
    found = rs.stability_map(vehicle)
    seconds = perf_counter() - start
    dense = _dense_time(vehicle, found)
    cases = f"{len(found.configurations)} x {len(found.conicity)} x {len(found.damping_ratios)} cases"
    return [Figure("figures 8-10 complete", seconds, "s", 10.0, cases),
            Figure("speeds solved", found.speeds_solved, "-", None, "eigenproblems in the scans and Newton steps"),
            Figure("dense eigvals over the same speeds", dense * found.speeds_solved, "s", None,
                   f"extrapolated from {_SAMPLE} measured matrices over configurations, conicities and speeds"),
            Figure("ratio, solve for solve", dense * found.speeds_solved / seconds, "-", 20.0, "dense over railsym", at_least=True),
            *_same_answer(vehicle, found, dense, seconds)]


def _same_answer(vehicle, found, dense, seconds):
    """Dense eigenvalues until they give the same critical speeds: a grid of speeds, then Brent's method to 1e-6."""
    refined = np.mean([_dense_refinement(vehicle, found, name) for name in ("AS_K", "AS_Mal_K")])
    crossings = sum(len(c) for row in found.results for result in row for c in result.crossings)
    solves = len(found.configurations) * len(found.conicity) * _GRID + crossings * refined
    note = f"{_GRID} speeds a case and {refined:.1f} more for each of {crossings} crossings; measured on two cases"
    return [Figure("dense eigvals to the same answer", dense * solves, "s", None, note),
            Figure("ratio, same answer", dense * solves / seconds, "-")]


def _dense_refinement(vehicle, found, name):
    """Dense eigenproblems that Brent's method takes from an interval of the grid to the critical speed."""
    from scipy.optimize import brentq

    import railsym as rs

    model = rs.linear_model(vehicle.configured(name), rs.LinearContact(conicity=float(found.conicity[3])))
    wanted = float(found.of(name).speed[3])

    def growth(speed):
        values = np.linalg.eigvals(model.state_matrix(speed))
        return values.real[np.abs(values.imag) > 1.0].max()  # without the constant-speed pair

    grid = np.linspace(*found.of(name).speed_range, _GRID)
    after = np.searchsorted(grid, wanted)
    speed, result = brentq(growth, grid[after - 1], grid[after], xtol=1e-6 * wanted, full_output=True)
    if abs(speed / wanted - 1.0) > 2e-6:
        raise RuntimeError(f"{name}: dense critical speed {speed} m/s against {wanted} m/s")
    return result.function_calls - 2


def _dense_time(vehicle, found):
    """Mean time of numpy.linalg.eigvals of a state matrix, over a sample spread over the cases."""
    import railsym as rs

    cases = list(itertools.product(found.configurations, found.conicity, np.geomspace(10.0, 200.0, 5)))
    chosen = np.linspace(0, len(cases) - 1, _SAMPLE).round().astype(int)
    total = 0.0
    for name, conicity, speed in (cases[k] for k in chosen):
        matrix = rs.linearise(vehicle.configured(name), speed, rs.LinearContact(conicity=float(conicity))).A
        start = perf_counter()
        np.linalg.eigvals(matrix)
        total += perf_counter() - start
    return total / _SAMPLE


def sensitivities():
    """Sensitivity of a critical speed to every parameter of the file."""
    import railsym as rs

    vehicle = rs.load_vehicle("pendolino").configured("AS_K")
    start = perf_counter()
    found = rs.sensitivity(vehicle, 0.2)
    return [Figure("sensitivity to every parameter", perf_counter() - start, "s", None, f"{len(found)} parameters")]


def damper_figures():
    """Identification from 12 tests of 10 cycles at 1 kHz, of a linear Maxwell damper and of one with curves; the virtual bench."""
    from railsym import dampers

    curves = dampers.DamperModel("maxwell", damping_curve=([0.0, 0.004, 0.01, 0.02, 0.05], [0.0, 3400.0, 7000.0, 9500.0, 13000.0]),
                                 series_stiffness_curve=([0.0, 0.01, 0.02, 0.05], [6.2e6, 5.4e6, 4.7e6, 4.2e6]))
    linear = dampers.DamperModel("maxwell", damping=6e5, series_stiffness=5e6)
    found = []
    for word, true, model in (("constants", linear, "maxwell"), ("curves", curves, "maxwell_nonlinear")):
        tests = _bench_records(true)
        cleaned = dampers.clean_all(tests)
        found.append(Figure(f"damper, {word}: clean", 1e3 * median_time(lambda: dampers.clean_all(tests), 5), "ms", None, "12 tests, 10 cycles, 1 kHz, 2 % noise, 3 ms lag"))
        fast, sharp = (median_time(lambda: dampers.identify(cleaned, model, method), 5) for method in ("energy", "least_squares"))
        whole = median_time(lambda: dampers.identify(dampers.clean_all(tests), model, "energy"), 9)
        found.append(Figure(f"damper, {word}: energy method with cleaning", 1e3 * whole, "ms", 50.0, f"of raw records; of cleaned tests {1e3 * fast:.1f} ms"))
        found.append(Figure(f"damper, {word}: least squares", sharp, "s", 2.0, "of cleaned tests, energy method included"))
    t = np.arange(200_000) * 1e-4
    e, v = 1e-3 * np.sin(6.0 * t), 6e-3 * np.cos(6.0 * t)
    seconds = median_time(lambda: dampers.virtual_bench(curves, t, e, v), 5)
    return [*found, Figure("virtual bench", t.size / seconds, "steps/s", 1e6, "curves of damping and stiffness", at_least=True)]


def _bench_records(model):
    """Steady tests of a model, with noise in both channels and a late force."""
    from railsym import dampers

    random, found = np.random.default_rng(1), []
    for f, a in itertools.product((0.5, 1.0, 2.0, 3.0), (0.5e-3, 1e-3, 2e-3)):
        t = np.arange(int(10 / f * 1000)) / 1000.0
        loop = dampers.sweep(model, f, a, samples_per_cycle=1024).force[0, 0]
        force = np.interp(f * (t - 3e-3) % 1.0, np.arange(1025) / 1024, np.append(loop, loop[0]))
        e = a * np.sin(2.0 * np.pi * f * t)
        noisy = [part + 0.02 * np.std(part) * random.standard_normal(t.size) for part in (e, force)]
        found.append(dampers.Record(t, *noisy, name=f"{f:g} Hz {1e3 * a:g} mm"))
    return found


GROUPS = {"derive": derivation, "kernels": kernel_figures, "import": imports, "linearise": linearisation, "figures": stability_figures, "cases": cases_figures,
          "sensitivity": sensitivities, "creep": creep_figures, "dampers": damper_figures, "contact": contact_figures, "track": track_figures,
          "wheel_rail": wheel_rail_figures, "transient": transient_figures, "accuracy": accuracy_figures, "long_run": long_run_figures, "curving": curving_figures,
          "sweep": sweep_figures, "tilt": tilt_figures}
