# SPDX-License-Identifier: BSD-3-Clause
"""Handing out cases in chunks, and taking their results as they come.

Chunks grow until they take a fixed time, so that handing out costs little a case whatever a case costs. A few chunks wait for every
worker; the plan is read as far as they reach. There is no scheduler here: which worker takes what is the executor's business.
"""

from __future__ import annotations

import pickle
from concurrent.futures import BrokenExecutor, CancelledError
from queue import SimpleQueue

import numpy as np

from railsym.sweep.errors import WorkersLostError
from railsym.sweep.worker import FAILED, Chunk, Payload, run_chunk

_MOST = 1024               # cases in a chunk
_WAITING = 2               # chunks under way for every worker: one computed, one waiting
_BLOCK = 8192              # rows of the plan made at once
_SERIAL = 0.1              # s of work between two writes to the journal
_HOPELESS = 3              # cases in a row that end their worker, none done: then it is not the cases
LOST = "the worker that computed this case ended without a word, twice: out of memory, killed, or a crash in compiled code"


def dispatched(study, place, todo):
    """Compute cases, yielding a `Chunk` when one is finished.

    Parameters
    ----------
    study : Study
    place : OwnPool, Given or None
        Where; None: in this process.
    todo : ndarray of int
        Cases, ascending.
    """
    feed = _Feed(study, todo)
    if place is None:
        return _serial(Payload.of(study), feed)
    return _Dispatcher(study, place, feed).results()


class _Feed:
    """Rows of the cases to be computed, in pieces of any size."""

    def __init__(self, study, todo):
        self.study, self.todo, self.place = study, todo, 0
        self._start, self._rows = 0, np.empty((0, 0))

    @property
    def left(self):
        return len(self.todo) - self.place

    def take(self, count):
        """The next cases, at most `count`, and their rows: as many as lie in one block of the plan."""
        block = self.todo[self.place] // _BLOCK
        cases = self.todo[self.place:self.place + count]
        cases = cases[cases // _BLOCK == block]
        if not len(self._rows) or self._start != block * _BLOCK:
            self._start = int(block * _BLOCK)
            self._rows = self.study.rows(self._start, self._start + _BLOCK)
        self.place += len(cases)
        return cases, self._rows[cases - self._start]


class _Size:
    """How many cases make a chunk of the wanted time, from what cases took so far."""

    def __init__(self, seconds):
        self.seconds, self._each = seconds, None

    def learn(self, chunk):
        each = chunk.seconds / max(1, len(chunk.cases))
        self._each = each if self._each is None else 0.7 * self._each + 0.3 * each

    def __call__(self, left, workers):
        if self._each is None:
            return 1
        fair = -(-left // (2 * workers))             # towards the end all workers are busy to the last
        return max(1, min(_MOST, fair, int(self.seconds / max(self._each, 1e-9))))


def _serial(payload, feed):
    size = _Size(_SERIAL)
    while feed.left:
        chunk = payload.chunk(*feed.take(size(feed.left, 1)))
        size.learn(chunk)
        yield chunk


class _Dispatcher:
    """Cases over an executor."""

    def __init__(self, study, place, feed):
        import railsym

        self.key, self.version = study.hash, railsym.__version__
        self.payload = pickle.dumps(Payload.of(study), protocol=pickle.HIGHEST_PROTOCOL)
        self.numbers, self.texts = (sum(out.text is kind for out in study.outputs.values()) for kind in (False, True))
        self.place, self.feed, self.size = place, feed, _Size(place.seconds)
        self.ready = SimpleQueue()
        self.under_way = {}              # future: (cases, rows)
        self.suspects = []               # chunks whose worker was lost
        self.sent = self.done = self.lost = 0

    def results(self):
        """Chunks as they are finished."""
        try:
            while True:
                self._fill()
                if not self.under_way:
                    if not self.suspects:
                        return
                    yield from self._one_by_one()
                    continue
                chunk = self._received(self.ready.get())
                if chunk is not None:
                    yield chunk
        finally:
            for future in self.under_way:
                future.cancel()

    def _fill(self):
        """Keep enough chunks under way; none while there are suspects, which are to be alone."""
        workers = 0 if self.suspects else self.place.capacity()
        while self.feed.left and not self.suspects and len(self.under_way) < _WAITING * workers:
            self._send(*self.feed.take(self.size(self.feed.left, workers)))

    def _send(self, cases, rows, whole=None):
        """Submit a chunk: with the study while workers are still new, by its hash alone afterwards."""
        whole = self.sent < _WAITING * self.place.capacity() if whole is None else whole
        self.sent += 1
        try:
            future = self.place.submit(run_chunk, self.key, self.version, self.payload if whole else None, cases, rows, whole)
        except BrokenExecutor as error:
            self._given_up(error)
            self.suspects.append((cases, rows))
            return
        self.under_way[future] = cases, rows
        future.add_done_callback(self.ready.put)

    def _received(self, future):
        """The chunk of a finished future; None where it has to be computed again."""
        cases, rows = self.under_way.pop(future)
        try:
            chunk = future.result()
        except (BrokenExecutor, CancelledError) as error:
            self._given_up(error)
            self.suspects.append((cases, rows))
            return None
        except Exception as error:
            if not is_lost_worker(error):
                raise
            self.suspects.append((cases, rows))
            return None
        if chunk is None:
            self._send(cases, rows, True)
            return None
        self.size.learn(chunk)
        self.done += len(cases)
        return chunk

    def _given_up(self, error):
        """An executor that is not ours cannot be opened anew."""
        if not self.place.renewable:
            raise WorkersLostError(f"the executor gave up: {type(error).__name__} {error}; what was computed is kept, run the study again") from error

    def _one_by_one(self):
        """After workers were lost: every case that was under way, with nothing else under way, so that the one that ends them is known."""
        self.place.renew()
        chunks, self.suspects = self.suspects, []
        lost = []                        # not the cases' fault before any case is done
        for cases, rows in chunks:
            for k in range(len(cases)):
                lost.append(self._alone(cases[k:k + 1], rows[k:k + 1]))
                if self.done:
                    yield from lost
                    lost = []
        yield from lost
        self.sent = 0                    # the next workers are new

    def _alone(self, cases, rows):
        try:
            chunk = self.place.submit(run_chunk, self.key, self.version, self.payload, cases, rows, "alone").result()
        except (BrokenExecutor, CancelledError) as error:
            self._given_up(error)
            chunk = None
        except Exception as error:
            if not is_lost_worker(error):
                raise
            chunk = None
        if chunk is None:
            self.place.renew()
            return self._blamed(cases)
        self.done += 1
        return chunk

    def _blamed(self, cases):
        self.lost += 1
        if not self.done and self.lost >= _HOPELESS:
            raise WorkersLostError("workers end before any case is finished. Started from a script, its running part belongs under "
                                   "if __name__ == '__main__': (workers import the script); else memory is too small, or a library crashes")
        return Chunk(cases, np.array([FAILED], np.int8), np.full((1, self.numbers), np.nan), [[""] * self.texts],
                     {int(cases[0]): f"WorkersLostError: {LOST}"})


def is_lost_worker(error):
    """Dask's word for a task whose workers died."""
    return type(error).__name__ == "KilledWorker"
