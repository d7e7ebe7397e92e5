# SPDX-License-Identifier: BSD-3-Clause
"""Where cases are computed: a process pool of our own, or an executor that is given.

Whatever has the interface of `concurrent.futures.Executor` will do: a process pool, Dask's ``client.get_executor()``, ``mpi4py.futures``.
"""

from __future__ import annotations

import os
import threading
import time
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import suppress

import numpy as np

from railsym.sweep.errors import SweepError

_ASKED = 2.0             # s between two questions how many workers there are
PATIENCE = 30.0          # s until a scheduler must have answered


class OwnPool:
    """A process pool that is opened anew when a worker is lost.

    Workers are not forked from this process (its threads, locks and open files are none of theirs) and end when it ends, killed or not.
    """

    renewable = True
    seconds = 0.1            # of work that a chunk aims at: what a killed study computes twice

    def __init__(self, workers):
        self.workers, self._pool = workers, None

    def submit(self, function, *arguments):
        if self._pool is None:
            self._pool = self._open(self.workers)
        return self._pool.submit(function, *arguments)

    @staticmethod
    def _open(workers):
        import multiprocessing

        context = multiprocessing.get_context("forkserver" if hasattr(os, "fork") else "spawn")
        if hasattr(os, "fork"):
            context.set_forkserver_preload(["railsym.sweep.preload"])
        return ProcessPoolExecutor(workers, mp_context=context, initializer=end_with_parent)

    def renew(self):
        """Leave a broken pool; the next `submit` opens another one."""
        self.close()

    def close(self):
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
            self._pool = None

    def capacity(self):
        """Chunks that can be computed at the same time."""
        return self.workers


def end_with_parent():
    """Initializer of a worker: a process whose parent was killed would wait for work for ever."""
    import multiprocessing
    from multiprocessing.connection import wait

    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch():
        wait([parent.sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


class Given:
    """An executor that the user opened and will close."""

    renewable = False
    seconds = 0.5            # a chunk may travel far

    def __init__(self, executor):
        self.executor = executor
        self._capacity, self._asked = 1, -np.inf

    def submit(self, function, *arguments):
        return self.executor.submit(function, *arguments)

    def capacity(self):
        """Chunks that can be computed at the same time, as far as the executor tells; asked again after some seconds."""
        if time.monotonic() - self._asked > _ASKED:
            self._capacity, self._asked = self._workers(), time.monotonic()
        return self._capacity

    def _workers(self):
        client = getattr(self.executor, "_client", None)
        if client is not None:
            with suppress(Exception):
                return max(1, sum(client.nthreads().values()))
        for name in ("_max_workers", "num_workers"):
            number = getattr(self.executor, name, None)
            if isinstance(number, int) and number > 0:
                return number
        return os.cpu_count() or 1

    def renew(self):
        """Whoever opened it replaces lost workers."""

    def close(self):
        pass


class Addressed(Given):
    """Dask's scheduler by its address."""

    def __init__(self, address):
        try:
            from distributed import Client
        except ImportError:
            raise SweepError(f"executor {address!r} is the address of a Dask scheduler; install it with: pip install 'railsym[cluster]'") from None
        try:
            self.client = Client(address, timeout=PATIENCE)
        except OSError as error:
            raise SweepError(f"no Dask scheduler answers at {address!r}: {error}") from None
        super().__init__(self.client.get_executor())

    def close(self):
        self.executor.shutdown(wait=False)
        self.client.close()


class Mpi(Given):
    """The MPI pool of ``mpiexec -n N python -m mpi4py.futures script.py``."""

    def __init__(self):
        try:
            from mpi4py.futures import MPIPoolExecutor
        except ImportError:
            raise SweepError("executor 'mpi' needs mpi4py: pip install 'railsym[mpi]', and an MPI") from None
        super().__init__(MPIPoolExecutor())

    def close(self):
        self.executor.shutdown()


def door(workers, executor):
    """Where to compute; None in this process.

    Parameters
    ----------
    workers : int
        Of a process pool; 1 computes in this process.
    executor : Executor, str, dask Client or None
        "mpi", the address of a Dask scheduler ("tcp://host:8786"), or an executor that is open.

    Raises
    ------
    SweepError
    """
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise SweepError(f"workers = {workers!r}: a whole number, at least 1, is needed")
    if executor is None:
        return None if workers == 1 else OwnPool(workers)
    if isinstance(executor, str):
        return _named(executor)
    if hasattr(executor, "get_executor"):
        return Given(executor.get_executor())
    if isinstance(executor, Executor) or hasattr(executor, "submit"):
        return Given(executor)
    raise SweepError(f"executor {executor!r}: a concurrent.futures.Executor, a Dask client, its scheduler's address or 'mpi' is needed")


def _named(name):
    if name == "mpi":
        return Mpi()
    if "://" in name:
        return Addressed(name)
    raise SweepError(f"executor {name!r}: 'mpi' or the address of a Dask scheduler such as 'tcp://host:8786' is needed")
