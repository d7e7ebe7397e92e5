# SPDX-License-Identifier: BSD-3-Clause
"""Studies killed at any moment go on where they were, and their workers end with them."""

import os
import signal

import numpy as np
import pytest
from sweep_analysis import Logged, numbers
from sweep_processes import TESTS, alive, children, started, wait_for

import railsym as rs
from railsym import sweep
from railsym.sweep.journal import journal_of

pytestmark = pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="looks for processes in Linux's /proc")


def done_in(store):
    """Cases that a store or its journal holds."""
    try:
        return set(np.flatnonzero(sweep.load(store).status != "missing").tolist())
    except sweep.StoreError:
        return set()


def killed_and_resumed(folder, study, kills, random, least, workers=2):
    """Run a study that logs its first factor in processes of its own, killed by SIGKILL at random moments and resumed.

    Returns
    -------
    list of set of int
        Cases in the store or its journal after every kill.
    int
        Cases computed in all.
    """
    log, store = folder / "log", folder / "r.nc"
    study.save(folder / "study.toml")
    number = {value: case for case, value in enumerate(study.rows()[:, 0].tolist())}
    before, count = [set()], 0
    while True:
        log.unlink(missing_ok=True)
        with started(TESTS / "sweep_script.py", folder / "study.toml", store, workers) as process:
            if len(before) > kills:
                assert process.wait() == 0
            else:
                begun = random.integers(*least)
                wait_for(lambda: process.poll() is not None or len(numbers(log)) >= begun, 300.0)
                workers_there = children(process.pid)
                process.send_signal(signal.SIGKILL)
                process.wait()
                wait_for(lambda: not any(map(alive, workers_there)), 60.0)      # workers end by themselves
        computed = [number[value] for value in numbers(log)]
        assert not before[-1] & set(computed), "cases in the journal were computed again"
        assert len(computed) == len(set(computed))
        count += len(computed)
        if len(before) > kills:
            return before, count
        before.append(done_in(store))


def check(tmp_path, cases, kills, seconds, least):
    study = rs.Study("wheelset", Logged(log=str(tmp_path / "log"), seconds=seconds, fail=(7.0,)), {"x": [float(k) for k in range(cases)]}, sweep.FullGrid())
    study.run(tmp_path / "whole.nc", workers=2)
    before, computed = killed_and_resumed(tmp_path, study, kills, np.random.default_rng(1), least)
    assert (tmp_path / "r.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes() and not journal_of(tmp_path / "r.nc").exists()
    assert all(one <= other for one, other in zip(before, before[1:])) and len(before[-1]) > 0
    # twice: only what was under way when the study was killed, 2 chunks of 0.1 s for each of 2 workers, and one being written
    assert computed - cases <= kills * 5 * (int(0.1 / seconds) + 1)
    return before


def test_killed_and_resumed(tmp_path):
    check(tmp_path, 200, 2, 0.004, (20, 60))


@pytest.mark.slow
def test_killed_twenty_times_and_resumed(tmp_path):
    before = check(tmp_path, 4000, 20, 0.004, (1, 200))
    assert len(before) == 21 and len(before[-1]) < 4000
