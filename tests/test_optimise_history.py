# SPDX-License-Identifier: BSD-3-Clause
"""Histories of optimisations: kills, workers, and the same bytes in the end."""

import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from oracles.schaffer import Schaffer, schaffer

from railsym.optimise import OptimisationError, pareto_front


def test_interrupted_and_resumed_is_the_same(tmp_path):
    whole = pareto_front(schaffer(Schaffer()), population=8, generations=6, seed=4)
    path = tmp_path / "history.jsonl"
    first = Schaffer(stop_after=29)
    with pytest.raises(KeyboardInterrupt):
        pareto_front(schaffer(first), population=8, generations=6, seed=4, history=path)
    with open(path, "ab") as file:
        file.write(b'{"case": 30, "values": [0.1')      # killed while writing
    again = pareto_front(schaffer(Schaffer()), population=8, generations=6, seed=4, history=path, resume=True)
    assert np.array_equal(again.values, whole.values) and again.numbers == whole.numbers
    assert first.calls == 29 and again.computed == whole.computed - 29
    longer = pareto_front(schaffer(Schaffer()), population=8, generations=8, seed=4, history=path, resume=True)
    assert longer.computed == longer.evaluations - whole.evaluations


class Uneven(Schaffer):
    """The later a case is asked for, the sooner it ends, more or less."""

    def __call__(self, x):
        import time

        time.sleep(0.02 * abs(np.sin(1e3 * x[0])))
        return super().__call__(x)


def test_any_executor_gives_the_same_bytes(tmp_path):
    alone = pareto_front(schaffer(Schaffer()), population=8, generations=4, history=tmp_path / "alone")
    with ThreadPoolExecutor(3) as pool:
        together = pareto_front(schaffer(Uneven()), population=8, generations=4, executor=pool, history=tmp_path / "together")
    assert np.array_equal(alone.values, together.values) and alone.numbers == together.numbers
    assert (tmp_path / "alone").read_bytes() == (tmp_path / "together").read_bytes()


def test_cases_keep_their_numbers_when_others_ended_first(tmp_path):
    """Of a run killed in the middle of a generation the 2nd, 5th and 3rd case are there, in this order."""
    whole = pareto_front(schaffer(Schaffer()), population=8, generations=3, history=tmp_path / "whole")
    head, *lines = (tmp_path / "whole").read_bytes().splitlines(keepends=True)
    (tmp_path / "part").write_bytes(head + lines[1] + lines[4] + lines[2])
    found = pareto_front(schaffer(Schaffer()), population=8, generations=3, history=tmp_path / "part", resume=True)
    assert found.numbers == whole.numbers and found.computed == whole.computed - 3
    assert (tmp_path / "part").read_bytes() == (tmp_path / "whole").read_bytes()
    # another seed asks for other cases: they get numbers of their own
    other = pareto_front(schaffer(Schaffer()), population=8, generations=3, seed=9, history=tmp_path / "part", resume=True)
    numbers = [case.number for case in other.cases]
    assert len(set(numbers)) == len(numbers) and max(numbers) > whole.evaluations
    for line in (tmp_path / "part").read_bytes().splitlines()[1:]:
        assert numbers.count(json.loads(line)["case"]) <= 1


def test_histories_that_cannot_be_used_are_refused(tmp_path):
    path, problem = tmp_path / "history.jsonl", schaffer(Schaffer(), description={"vehicle": "a"})
    options = {"population": 4, "generations": 2}
    pareto_front(problem, history=path, **options)
    size = path.stat().st_size
    with pytest.raises(OptimisationError, match="exists"):
        pareto_front(problem, history=path, **options)
    with pytest.raises(OptimisationError, match="another problem"):
        pareto_front(schaffer(Schaffer(), description={"vehicle": "b"}), history=path, resume=True, **options)
    from railsym.optimise import History
    with History(problem, path, resume=True), pytest.raises(OptimisationError, match="in use"):
        pareto_front(problem, history=path, resume=True, **options)
    assert path.stat().st_size == size
    path.write_text("no json\n")
    with pytest.raises(OptimisationError, match="damaged"):
        pareto_front(problem, history=path, resume=True, **options)


class Mortal:
    """Schaffer's function; ends its process once, where a file does not exist yet, or always."""

    def __init__(self, marker=None):
        self.marker = marker

    def __call__(self, x):
        import os
        from pathlib import Path

        if abs(x[0]) < 4.0 and self.marker is not None and not Path(self.marker).exists():
            if self.marker != "always":
                Path(self.marker).touch()
            os._exit(1)
        return Schaffer()(x)


def test_processes_give_the_same_and_a_lost_one_is_replaced(tmp_path):
    from railsym.sweep.executors import OwnPool

    alone = pareto_front(schaffer(Schaffer()), population=8, generations=2)
    pool = OwnPool(2)
    try:
        found = pareto_front(schaffer(Mortal(str(tmp_path / "died"))), population=8, generations=2, executor=pool, history=tmp_path / "h")
        assert (tmp_path / "died").exists() and np.array_equal(found.values, alone.values) and found.failed == 0
        with pytest.raises(OptimisationError, match="worker was lost.*resume"):
            pareto_front(schaffer(Mortal("always")), population=8, generations=2, executor=pool)
        with pytest.raises(OptimisationError, match="cannot be sent"):
            pareto_front(schaffer(lambda x: {"f1": 0.0, "f2": 0.0}), population=4, generations=1, executor=pool)
    finally:
        pool.close()


KILLED = """
import sys, time
sys.path.insert(0, {tests!r})
from oracles.schaffer import Schaffer, schaffer
from railsym.optimise import pareto_front

class Slow(Schaffer):
    def __call__(self, x):
        time.sleep(0.02)
        return super().__call__(x)

found = pareto_front(schaffer(Slow()), population=8, generations=6, seed=4, history={path!r}, resume=True)
print(found.computed, flush=True)
"""


def test_killed_and_resumed_is_the_same(tmp_path):
    """SIGKILL at three places of the history: nothing that was written is computed again, and the front is that of an undisturbed run."""
    import subprocess
    import sys
    import time
    from pathlib import Path

    whole = pareto_front(schaffer(Schaffer()), population=8, generations=6, seed=4, history=tmp_path / "whole")
    path = tmp_path / "history"
    code = KILLED.format(tests=str(Path(__file__).parent), path=str(path))
    lines = 0
    for target in (7, 20, 33):
        process = subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.DEVNULL)
        while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < target):
            time.sleep(0.005)
        process.kill()
        process.wait()
        kept = path.read_bytes().count(b"\n")
        assert kept >= target > lines
        lines = kept
    found = pareto_front(schaffer(Schaffer()), population=8, generations=6, seed=4, history=path, resume=True)
    assert found.computed == whole.computed - (lines - 1)      # the first line is the head
    assert np.array_equal(found.values, whole.values) and found.numbers == whole.numbers
    assert path.read_bytes() == (tmp_path / "whole").read_bytes()


@pytest.mark.slow
def test_dask_gives_the_same():
    """Two worker processes of a real scheduler, which are given the problem once each."""
    distributed = pytest.importorskip("distributed")
    alone = pareto_front(schaffer(Mortal()), population=8, generations=3)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        found = pareto_front(schaffer(Mortal()), population=8, generations=3, executor=client)
    assert np.array_equal(found.values, alone.values) and found.failed == 0
