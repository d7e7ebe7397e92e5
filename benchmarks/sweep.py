# SPDX-License-Identifier: BSD-3-Clause
"""What studies cost beyond their cases: in this process, on a process pool, on Dask; plans of a million cases."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.measure import ROOT, Figure, cost_of_code
from railsym.sweep import Analysis, CriticalSpeed, FullGrid, Grid, Input, LatinHypercube, Output, Study, Uniform
from railsym.sweep.dispatch import dispatched
from railsym.sweep.executors import OwnPool, door
from railsym.sweep.worker import run_chunk

_CASES = 400
_REPEATS = 3
_MILLION = """
import numpy as np, railsym as rs
from railsym import sweep
from railsym.sweep.dispatch import _Feed
factors = {f"truss_axlebox_bushing.stiffness.{k}": sweep.Normal(100, 5, unit="%") for k in range(3)}
factors |= {f"anti_yaw_damper.{name}": sweep.Uniform(90, 110, unit="%") for name in ("damping", "series_stiffness")}
factors |= {f"contact.{name}": sweep.Uniform(0.2, 0.4) for name in ("conicity", "friction", "kalker_weight")}
factors |= {f"car.inertia.{k}": sweep.Normal(100, 5, unit="%") for k in range(3)} | {"car.mass": sweep.Normal(100, 5, unit="%")}
study = rs.Study("pendolino", sweep.CriticalSpeed(), factors, sweep.LatinHypercube(1_000_000), configuration="AS_K")
feed = _Feed(study, np.arange(study.size))
while feed.left:
    feed.take(1024)
"""


@dataclass(frozen=True)
class Waiting(Analysis):
    """A case that takes a known time and no processor."""

    seconds: float = 0.0
    kind = "waiting"

    def inputs(self, vehicle):
        return {"x": Input("-", 0.0)}

    def outputs(self, vehicle):
        return {"y": Output("-", "x")}

    def solver(self, vehicle):
        def solve(case):
            if self.seconds:
                time.sleep(self.seconds)
            return {"y": case.settings["x"]}

        return solve


def sweep_figures():
    """Overheads, parallel efficiency, memory of a plan."""
    memory = cost_of_code(_MILLION)[1]
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        return [*_local(here), *_on_dask(here), *_efficiency(here),
                Figure("study: plan of a million cases, peak memory", memory, "MB", 500.0, "12 factors, Latin hypercube, read in chunks; resident")]


def _study(seconds, cases):
    return Study("wheelset", Waiting(seconds), {"x": Grid(0.0, 1.0, cases)}, FullGrid())


def _took(study, folder, **place):
    """Wall time of a run, the least of some."""
    times = []
    for _ in range(_REPEATS):
        (folder / "r.nc").unlink(missing_ok=True)
        start = perf_counter()
        study.run(folder / "r.nc", **place)
        times.append(perf_counter() - start)
    return min(times)


def _serial(folder, cases):
    """Time a case, ms, for cases that do nothing: the whole of a run, less that of a study a tenth as long."""
    long, short = (_took(_study(0.0, count), folder) for count in (cases, cases // 10))
    return 1e3 * (long - short) / (cases - cases // 10)


def _idle(place, lanes, cases, seconds):
    """Time a case of a worker beyond the case itself, ms, once the pool is open: what cases took is measured in the workers."""
    study, found = _study(seconds, cases), []
    for _ in range(1 + _REPEATS):
        start = perf_counter()
        spent = sum(chunk.seconds for chunk in dispatched(study, place, np.arange(cases)))
        found.append(1e3 * ((perf_counter() - start) * lanes - spent) / cases)
    return min(found[1:])


def _local(folder):
    with closing(OwnPool(2)) as pool:
        empty, waiting = _idle(pool, 2, 20_000, 0.0), _idle(pool, 2, 1000, 0.005)
    return [Figure("study: overhead a case, serial", _serial(folder, 20_000), "ms", 1.0, "cases that do nothing; plan, journal and store included"),
            Figure("study: overhead a case, 2 processes", empty, "ms", 1.0, "of a worker; cases that do nothing"),
            Figure("study: overhead a case of 5 ms, 2 processes", waiting, "ms", 1.0, "of a worker; cases that wait 5 ms"),
            Figure("ProcessPoolExecutor.map, a case a call", _peer(), "ms", None, "peer: the same cases, nothing written")]


def _peer():
    """The standard library's pool, one case a task."""
    import pickle

    import railsym
    from railsym.sweep.worker import Payload

    study = _study(0.0, 2000)
    rows, payload = study.rows(), pickle.dumps(Payload.of(study))
    with ProcessPoolExecutor(2) as pool:
        arguments = ([study.hash] * 2000, [railsym.__version__] * 2000, [payload] * 2000, [[k] for k in range(2000)], [rows[k:k + 1] for k in range(2000)])
        list(pool.map(run_chunk, *(part[:50] for part in arguments)))
        start = perf_counter()
        list(pool.map(run_chunk, *arguments))
        return 1e3 * 2 * (perf_counter() - start) / 2000


def _on_dask(folder):
    """A scheduler and two workers in processes of their own."""
    try:
        from distributed import Client
    except ImportError:
        return []
    file, environment = folder / "scheduler.json", os.environ | {"PYTHONPATH": str(ROOT)}
    with ExitStack() as stack:
        for command in (["scheduler", "--port", "0"], *[["worker", "--nthreads", "1", "--no-nanny"]] * 2):
            process = subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{command[0]}", *command[1:], "--no-dashboard", "--scheduler-file", file],
                                       env=environment, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            stack.callback(process.wait)
            stack.callback(process.kill)
        while not file.exists():
            time.sleep(0.05)
        with Client(scheduler_file=str(file), timeout=60) as client:
            client.wait_for_workers(2, timeout=60)
            overhead = _idle(door(1, client), 2, 1000, 0.005)
    return [Figure("study: overhead a case of 5 ms, Dask", overhead, "ms", 5.0, "of a worker; 2 workers, scheduler in a process of its own")]


def _efficiency(folder):
    """Critical speeds of the 31-body vehicle by one process and by two; processor time tells on a machine that does other things."""
    study = Study("pendolino", CriticalSpeed(), {"contact.conicity": Uniform(0.1, 0.4), "anti_yaw_damper.damping": Uniform(90, 110, unit="%")},
                  LatinHypercube(_CASES), configuration="AS_K")
    with ProcessPoolExecutor(2) as pool:
        wall, processor = {}, {}
        for name, place in (("first use", {"executor": pool}), ("one", {}), ("two", {"executor": pool})):
            (folder / "r.nc").unlink(missing_ok=True)
            before, start = _processor(pool), perf_counter()
            study.run(folder / "r.nc", **place)
            wall[name], processor[name] = perf_counter() - start, _processor(pool) - before
    cases = f"{_CASES} critical speeds, 31 bodies"
    return [Figure("study: critical speeds, 1 process", _CASES / processor["one"], "1/s", None, "cases a second of processor time"),
            Figure("study: parallel efficiency, 2 processes", wall["one"] / wall["two"] / 2.0, "-", 0.95, f"{cases}; wall clock, so the machine must be idle",
                   at_least=True),
            Figure("study: processor time, 1 process over 2", processor["one"] / processor["two"], "-", 0.95, cases, at_least=True)]


def _processor(pool):
    """Processor time of this process and of the workers of a pool, s."""
    ticks = [int(tick) for pid in pool._processes for tick in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]]
    return time.process_time() + sum(ticks) / os.sysconf("SC_CLK_TCK")
