# SPDX-License-Identifier: BSD-3-Clause
"""The history of an optimisation: every case as a line of JSON, written when it ends, read again when the optimisation goes on.

A method that is started again with the same seed asks for the same cases; those in the history are not computed again. A line that was cut
off by a kill is dropped. Numbers are written so that they come back bit for bit.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path

from railsym.optimise.errors import OptimisationError


@dataclass(frozen=True, eq=False)
class Case:
    """One evaluation.

    Attributes
    ----------
    number : int
        In the order in which cases were asked for, whichever ended first.
    values : tuple of float
        SI.
    outputs : dict of str to float, or None
        None where it failed.
    error : str
        Why; empty where it did not.
    gradient : dict of str to tuple of float, or None
    """

    number: int
    values: tuple[float, ...]
    outputs: dict[str, float] | None
    error: str = ""
    gradient: dict[str, tuple[float, ...]] | None = field(default=None, repr=False)

    @property
    def failed(self):
        """Whether there is no result."""
        return self.outputs is None


class History:
    """Cases by their values, in memory and, when a path is given, in a file.

    Parameters
    ----------
    problem : Problem
    path : str or Path, optional
    resume : bool
        Go on with an existing file; without it an existing file is an error.

    Raises
    ------
    OptimisationError
        A file that exists and may not be continued, belongs to another problem, is in use, or cannot be read or written.
    """

    def __init__(self, problem, path=None, resume=False):
        self.cases, self._by_values, self._numbers, self._file = [], {}, {}, None
        self._lines = []      # of the file
        self.path = None if path is None else Path(path)
        if self.path is None:
            return
        if self.path.exists() and not resume:
            raise OptimisationError(f"history {self.path} exists: go on with it (resume), or name another file")
        try:
            self._file = open(self.path, "a+b")
            self._lock()
            self._read(problem)
        except OSError as error:
            raise OptimisationError(f"history {self.path}: {error.strerror}") from None

    def _lock(self):
        from railsym.sweep.lock import locked_by_other

        if locked_by_other(self._file):
            self._file.close()
            raise OptimisationError(f"history {self.path} is in use by another optimisation; wait for it, or name another file")

    def _read(self, problem):
        self._file.seek(0)
        content = self._file.read()
        whole = content[:content.rfind(b"\n") + 1]
        self._file.truncate(len(whole))      # the last line of a killed run may be half a line
        lines = whole.splitlines()
        if not lines:
            self._write({"history_of": problem.as_data(), "key": problem.key(), "railsym": _version()})
            return
        try:
            head, *rows = map(json.loads, lines)
            found = head["key"]
            cases = [Case(row["case"], tuple(row["values"]), row.get("outputs"), row.get("error", ""), row.get("gradient")) for row in rows]
        except (ValueError, KeyError, TypeError):
            raise OptimisationError(f"history {self.path} is no history of an optimisation, or is damaged; name another file") from None
        if found != problem.key():
            raise OptimisationError(f"history {self.path} belongs to another problem (key {found}, this one {problem.key()}): other variables, vehicle or "
                                    "analysis; name another file")
        for case in cases:
            self._remember(case)
            self._numbers[case.number] = case.values
        self._lines = [line + b"\n" for line in lines]

    def number(self, values, rank):
        """Number of a case that is the `rank`-th to be asked for: that, unless another case has it, as after a change of method."""
        own = self._by_values.get(values)
        if own is not None:      # computed anew, with its gradient
            return own.number
        number = rank if rank not in self._numbers else 1 + max(self._numbers)
        self._numbers[number] = values
        return number

    def find(self, values, gradient=False):
        """The case of these values, or None."""
        case = self._by_values.get(tuple(map(float, values)))
        return None if case is None or (gradient and case.gradient is None and not case.failed) else case

    def add(self, case):
        """Keep a case; on disk when this returns."""
        self._remember(case)
        if self._file is not None:
            row = {"case": case.number, "values": list(case.values)}
            row |= {"error": case.error} if case.failed else {"outputs": case.outputs}
            self._write(row if case.gradient is None else row | {"gradient": {name: list(map(float, g)) for name, g in case.gradient.items()}})

    def _remember(self, case):
        self.cases.append(case)
        self._by_values[case.values] = case

    def _write(self, row):
        line = json.dumps(row, allow_nan=False).encode() + b"\n"
        try:
            self._file.write(line)
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise OptimisationError(f"history {self.path}: {error.strerror}; the cases before this one are kept") from None
        self._lines.append(line)

    def sort(self):
        """Put the lines of the file in the order of their numbers: the same bytes, whichever worker was first."""
        if self._file is None:
            return
        head, *rows = self._lines
        ordered = sorted(rows, key=lambda line: json.loads(line)["case"])
        if ordered == rows:
            return
        part = self.path.with_name(self.path.name + ".part")
        try:
            part.write_bytes(b"".join([head, *ordered]))
            os.replace(part, self.path)
        except OSError as error:
            part.unlink(missing_ok=True)
            raise OptimisationError(f"history {self.path} was not put in order: {error.strerror}; all cases are in it") from None

    def close(self):
        """Let go of the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _version():
    from importlib.metadata import version

    return version("railsym")
