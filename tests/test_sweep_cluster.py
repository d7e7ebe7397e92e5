# SPDX-License-Identifier: BSD-3-Clause
"""Studies on Dask (a scheduler and workers in processes of their own, workers lost on purpose) and on an MPI pool."""

import os
import shutil
import signal
import subprocess
import sys

import pytest
from sweep_analysis import Logged, numbers
from sweep_processes import ENVIRONMENT, TESTS, dask_client

import railsym as rs
from railsym import sweep


def study(folder, cases=60, **options):
    return rs.Study("wheelset", Logged(log=str(folder / "log"), **options), {"x": [float(k) for k in range(cases)]}, sweep.FullGrid())


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    pytest.importorskip("distributed")
    with dask_client(tmp_path_factory.mktemp("dask")) as client:
        yield client


def test_dask_gives_the_same_bytes(client, tmp_path):
    study(tmp_path).run(tmp_path / "1.nc")
    study(tmp_path).run(tmp_path / "2.nc", executor=client)
    study(tmp_path).run(tmp_path / "3.nc", executor=client.get_executor())
    study(tmp_path).run(tmp_path / "4.nc", executor=client.scheduler.address)
    assert len({(tmp_path / f"{k}.nc").read_bytes() for k in (1, 2, 3, 4)}) == 1


def test_dask_gives_the_same_critical_speeds(client, tmp_path):
    speeds = rs.Study("wheelset", sweep.CriticalSpeed(), {"contact.conicity": sweep.Grid(0.2, 0.4, 20)}, sweep.FullGrid())
    speeds.run(tmp_path / "1.nc")
    speeds.run(tmp_path / "2.nc", executor=client)
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()


def test_dask_workers_lost_on_purpose(client, tmp_path):
    study(tmp_path, 100).run(tmp_path / "whole.nc")
    (tmp_path / "log").unlink()
    slow = study(tmp_path, 100, seconds=0.01)
    workers, lost = list(client.run(os.getpid).values()), []

    def lose():
        """Kill one worker after some cases, then the other."""
        if len(lost) < 2 and len(numbers(tmp_path / "log")) > 20 * (len(lost) + 1):
            lost.append(workers.pop())
            os.kill(lost[-1], signal.SIGKILL)

    results = watched(slow, tmp_path / "r.nc", client, lose)
    assert len(lost) == 2 and results.message == "100 cases: 100 done"
    assert results["y"].tolist() == sweep.load(tmp_path / "whole.nc")["y"].tolist()


def watched(study, path, client, call):
    """Run a study, calling a function whenever a chunk has come."""
    from railsym.sweep.journal import Journal

    append = Journal.append

    def appending(self, chunk):
        append(self, chunk)
        call()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Journal, "append", appending)
        return study.run(path, executor=client)


@pytest.mark.slow
def test_a_case_that_ends_every_dask_worker_is_recorded(client, tmp_path):
    results = study(tmp_path, 20, die=(5.0,)).run(tmp_path / "r.nc", executor=client)
    assert list(results.errors) == [5] and "ended without a word" in results.errors[5]
    assert results.message == "20 cases: 19 done, 1 failed"


def test_no_scheduler_at_an_address(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("railsym.sweep.executors.PATIENCE", 1.0)
    with pytest.raises(sweep.SweepError, match="no Dask scheduler answers at 'tcp://127.0.0.1:1'"):
        study(tmp_path).run(tmp_path / "r.nc", executor="tcp://127.0.0.1:1")


def test_an_mpi_pool_gives_the_same_bytes(tmp_path):
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec", path=os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", "")]))
    if mpiexec is None:
        pytest.skip("no mpiexec: an MPI is needed (pip install mpich)")
    whole = study(tmp_path)
    whole.run(tmp_path / "1.nc")
    whole.save(tmp_path / "study.toml")
    command = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", TESTS / "sweep_script.py", tmp_path / "study.toml", tmp_path / "2.nc", "mpi"]
    done = subprocess.run(list(map(str, command)), env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "60 cases: 60 done" in done.stdout and (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()
