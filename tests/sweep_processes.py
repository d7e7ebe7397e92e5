# SPDX-License-Identifier: BSD-3-Clause
"""Processes that tests of studies start, watch and kill."""

import os
import signal
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

TESTS = Path(__file__).parent
# Dask gives a task up when its second worker is lost, not its fourth: workers take seconds to be replaced
ENVIRONMENT = os.environ | {"PYTHONPATH": str(TESTS), "OMP_NUM_THREADS": "1", "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}


def wait_for(true, seconds=60.0, every=0.01):
    """Wait until a function gives something true, and return it."""
    end = time.monotonic() + seconds
    while not (found := true()):
        if time.monotonic() > end:
            raise TimeoutError(f"nothing came in {seconds:g} s")
        time.sleep(every)
    return found


def children(pid):
    """Processes started by a process, and by those."""
    found = []
    for tasks in Path(f"/proc/{pid}/task").glob("*/children"):
        with suppress(OSError):
            for child in map(int, tasks.read_text().split()):
                found += [child, *children(child)]
    return found


def alive(pid):
    """Is a process there, and no zombie?"""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@contextmanager
def started(*arguments, **options):
    """A process that is killed when the block ends."""
    process = subprocess.Popen([sys.executable, *map(str, arguments)], env=ENVIRONMENT, **options)
    try:
        yield process
    finally:
        below = children(process.pid)
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGKILL)
        process.wait()
        for pid in below:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)


@contextmanager
def dask_client(folder, workers=2):
    """A client of a scheduler with workers, each a process with a nanny that replaces it when it is lost."""
    from distributed import Client

    where = ("--scheduler-file", folder / "scheduler.json")
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    with ExitStack() as stack:
        stack.enter_context(started("-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", *where, **quiet))
        for _ in range(workers):
            stack.enter_context(started("-m", "distributed.cli.dask_worker", *where, "--nthreads", "1", "--no-dashboard", **quiet))
        wait_for((folder / "scheduler.json").exists)
        client = stack.enter_context(Client(scheduler_file=str(folder / "scheduler.json"), timeout=60))
        client.wait_for_workers(workers, timeout=60)
        yield client
