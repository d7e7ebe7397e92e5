# SPDX-License-Identifier: BSD-3-Clause
"""Running a study: what is missing is computed, and written as it comes."""

from __future__ import annotations

from contextlib import ExitStack, closing
from pathlib import Path

import numpy as np

from railsym.sweep.dispatch import dispatched
from railsym.sweep.executors import door
from railsym.sweep.journal import Journal, check_same, journal_of
from railsym.sweep.results import Results
from railsym.sweep.store_file import Columns, read_header, read_store, write_store
from railsym.sweep.worker import FAILED, MISSING


def run(study, path, *, workers=1, executor=None, progress=False, retry_failed=False):
    """Compute every case of a study that its store does not hold yet.

    Parameters
    ----------
    study : Study
    path : str or path
        Of the store (netCDF). Until it is complete, results are in ``PATH.journal``; a study that was killed goes on from there.
    workers : int
        Processes; 1 computes in this one.
    executor : optional
        In place of `workers`: any `concurrent.futures.Executor`, a Dask client or its scheduler's address, "mpi"
        (docs/studies_sweep.md).
    progress : bool
        A bar on the error stream.
    retry_failed : bool
        Compute cases again that failed before.

    Returns
    -------
    Results

    Raises
    ------
    StoreError
        Another study's store, a store in use, a full disk. What is in the store or its journal stays.
    WorkersLostError
        Workers that die before they finish a case, or an executor that gives up.
    """
    path = Path(path)
    header = header_of(study)
    before = _complete(path, study, header)
    if before is not None and not retry_failed and not journal_of(path).exists():
        return Results(study, before, path)
    with ExitStack() as stack:
        place = door(workers, executor)
        if place is not None:
            stack.enter_context(closing(place))
        journal = stack.enter_context(closing(Journal(path, header)))
        columns = _complete(path, study, header) or Columns(study)     # another run may have ended just now
        for chunk in journal.chunks():
            columns.put(chunk)
        todo = columns.status == MISSING
        if retry_failed:
            todo |= columns.status == FAILED
        _compute(study, place, np.flatnonzero(todo), columns, journal, progress)
        write_store(path, study, header, columns)
        journal.remove()
    return Results(study, columns, path)


def header_of(study):
    """What a store says of its study."""
    import railsym

    return {"hash": study.hash, "railsym_version": railsym.__version__, "document": study.document()}


def _complete(path, study, header):
    """Columns of the store where it is there, or None."""
    if not path.exists():
        return None
    check_same(path, read_header(path), header)
    return read_store(path, study)


def _compute(study, place, todo, columns, journal, progress):
    for chunk in followed_chunks(dispatched(study, place, todo), study.size, study.size - len(todo), progress):
        journal.append(chunk)
        columns.put(chunk)


def followed_chunks(chunks, total, done, show):
    """Chunks, with a progress bar over cases on the error stream when asked for."""
    if not show:
        yield from chunks
        return
    from tqdm import tqdm

    with tqdm(total=total, initial=done, desc="study", unit="case") as bar:
        failures = 0
        for chunk in chunks:
            yield chunk
            failures += len(chunk.errors)
            if failures:
                bar.set_postfix_str(f"{failures} failed", refresh=False)
            bar.update(len(chunk.cases))
