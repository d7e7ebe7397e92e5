# SPDX-License-Identifier: BSD-3-Clause
"""The journal of a running study: results as they come, appended to one file.

    frame | frame | ...        frame: "RSJ1", length, CRC-32 of the content (32 bits, little-endian each), content
    content: length of the text (32 bits), JSON text, doubles (m, p)

The first frame describes the study, every further one holds a chunk of cases. Appending is the one operation that a killed program, a full
disk or a lost machine cannot make harmful: at worst the last frame is torn, its checksum tells, and its cases are computed again. netCDF
(classic or 4) and Zarr rewrite an index or many small files in place; that is why the store itself is written once, when all is there.
The file is locked while a study runs, and the lock goes with the process that holds it.
"""

from __future__ import annotations

import json
import os
import struct
import time
import zlib
from pathlib import Path

import numpy as np

from railsym.results.files import check_target, reason
from railsym.sweep.errors import StoreError
from railsym.sweep.lock import locked_by_other
from railsym.sweep.worker import Chunk

SUFFIX = ".journal"
FORMAT = "railsym study journal 1"
_MAGIC = b"RSJ1"
_HEAD = struct.Struct("<4sII")
_COUNT = struct.Struct("<I")
_SYNC = 1.0            # s between two calls of fsync: a power cut costs no more


def journal_of(path):
    """Name of the journal beside a store."""
    path = Path(path)
    return path.with_name(path.name + SUFFIX)


def read_frames(path):
    """Contents of the whole frames of a journal: ``(end, text, doubles)``, with the byte behind each; what is torn is left out."""
    data = np.memmap(path, dtype=np.uint8, mode="r") if os.path.getsize(path) else np.empty(0, np.uint8)
    view, place = memoryview(data), 0
    while (found := _frame(view, place)) is not None or (place := _next(data, place + 1)) is not None:
        if found is not None:
            place = found[0]
            yield found


def _frame(view, place):
    """The frame at a place, or None."""
    if len(view) < place + _HEAD.size:
        return None
    magic, length, check = _HEAD.unpack_from(view, place)
    start = place + _HEAD.size
    if magic != _MAGIC or length < _COUNT.size or len(view) < start + length or zlib.crc32(view[start:start + length]) != check:
        return None
    text, = _COUNT.unpack_from(view, start)
    middle = start + _COUNT.size + text
    return start + length, json.loads(bytes(view[start + _COUNT.size:middle])), np.frombuffer(view[middle:start + length], "<f8")


def _next(data, place):
    """Where the next frame may begin."""
    found = bytes(data[place:]).find(_MAGIC)
    return None if found < 0 else place + found


def chunk_of(text, doubles):
    """The `Chunk` of a frame."""
    count = len(text["cases"])
    return Chunk(np.array(text["cases"], np.int64), np.array(text["status"], np.int8), doubles.reshape(count, -1), text["texts"],
                 {int(case): error for case, error in text["errors"].items()})


class Journal:
    """The journal of a study, open for appending and locked.

    Parameters
    ----------
    path : path
        Of the store; the journal lies beside it.
    header : dict
        Describes the study; ``header["hash"]`` and ``header["railsym_version"]`` must be those of a journal that is there.

    Raises
    ------
    StoreError
        Another study's journal, another run that holds it, a path that cannot be written.
    """

    def __init__(self, path, header):
        self.store, self.path = Path(path), journal_of(path)
        check_target(self.path)
        self._file = self._open()
        self._synced = time.monotonic()
        try:
            self._begin(header)
        except BaseException:
            self._file.close()
            raise

    def _open(self):
        """Open and lock; again where the file was finished and removed in between."""
        while True:
            try:
                file = open(os.open(self.path, os.O_RDWR | os.O_CREAT, 0o666), "r+b", buffering=0)
            except OSError as error:
                raise StoreError(f"{self.path} cannot be opened: {reason(error)}") from error
            if self._taken(file):
                file.close()
                raise StoreError(f"{self.store} is being computed by another run, which holds {self.path.name}; wait until it has ended, "
                                 "end it, or give another name")
            if self.path.exists() and os.path.samestat(os.fstat(file.fileno()), self.path.stat()):
                return file
            file.close()

    def _taken(self, file):
        try:
            return locked_by_other(file)
        except OSError as error:
            file.close()
            raise StoreError(f"{self.path} cannot be locked ({reason(error)}), so two runs on it could not be told apart; use another disk") from error

    def _begin(self, header):
        frames = read_frames(self.path)
        first = next(frames, None)
        if first is None:
            self._refuse_foreign()
            self._file.truncate(0)
            self.end = 0
            self._write(header, b"")
            return
        check_same(self.path, first[1], header)
        self.end = first[0]
        for end, *_ in frames:
            self.end = end
        self._file.truncate(self.end)          # what a killed run left of its last frame

    def _refuse_foreign(self):
        """A file without a whole first frame is ours only if it begins like one."""
        start = self.path.read_bytes()[:len(_MAGIC)]
        if start != _MAGIC[:len(start)]:
            raise StoreError(f"{self.path} is not a journal of railsym; move it away or give the store another name")

    def chunks(self):
        """All chunks that it holds."""
        frames = read_frames(self.path)
        next(frames)
        for _, text, doubles in frames:
            yield chunk_of(text, doubles)

    def append(self, chunk):
        """Add a chunk.

        Raises
        ------
        StoreError
            The disk is full or like; what was there before is intact.
        """
        text = {"cases": chunk.cases.tolist(), "status": chunk.status.tolist(), "texts": chunk.texts, "errors": chunk.errors}
        self._write(text, np.ascontiguousarray(chunk.values, "<f8").tobytes())

    def _write(self, text, doubles):
        text = json.dumps(text).encode()
        content = _COUNT.pack(len(text)) + text + doubles
        frame = _HEAD.pack(_MAGIC, len(content), zlib.crc32(content)) + content
        try:
            self._file.seek(self.end)
            view = memoryview(frame)
            while view:
                view = view[self._file.write(view):]
            if time.monotonic() - self._synced > _SYNC:
                os.fsync(self._file.fileno())
                self._synced = time.monotonic()
        except OSError as error:
            self._file.truncate(self.end)
            raise StoreError(f"{self.path} cannot take more results: {reason(error)}. What it holds is intact; make room and run the study "
                             "again with the same store, and it goes on from there") from error
        self.end += len(frame)

    def remove(self):
        """Delete it: the store is complete."""
        self.path.unlink()
        self.close()

    def close(self):
        """Leave it for the next run."""
        self._file.close()


def check_same(path, found, header):
    """Refuse a store or journal of another study.

    Raises
    ------
    StoreError
    """
    if found.get("hash") != header["hash"]:
        differing = differences(found.get("document", {}), header["document"])
        raise StoreError(f"{path} holds another study{differing}; give another name for the results, or remove it")
    if found.get("railsym_version") != header["railsym_version"]:
        raise StoreError(f"{path} was begun by railsym {found.get('railsym_version')}, this is {header['railsym_version']}: results of two versions "
                         "are not mixed; go on with that version, or start anew under another name")


def differences(one, other, key=""):
    """Where two documents differ, in words."""
    if isinstance(one, dict) and isinstance(other, dict):
        for name in sorted({*one, *other}, key=str):
            if one.get(name) != other.get(name):
                return differences(one.get(name), other.get(name), f"{key}.{name}" if key else str(name))
        return " (another vehicle file)"
    return f" ({key} there: {_short(one)}, here: {_short(other)})"


def _short(value):
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."
