# SPDX-License-Identifier: BSD-3-Clause
"""What runs in a worker: a chunk of cases.

A worker knows a study by its hash and keeps what it needs of it (vehicle, analysis, solver). A chunk comes with the hash alone; where a
worker does not know it, it says so and gets the chunk again with the study. So the vehicle travels once to every worker, by any
executor, and a worker that joins late is served like the first.
"""

from __future__ import annotations

import pickle
import traceback
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

import numpy as np

from railsym.sweep.space import CONFIGURATION

DONE, FAILED, MISSING = 0, 1, 2
STATUS = ("done", "failed", "missing")
_MOST_STUDIES = 4          # kept in a worker at a time
_MOST_TEXT = 2000          # characters of an error that are kept
_studies = {}


@dataclass
class Chunk:
    """Results of some cases.

    Attributes
    ----------
    cases : ndarray of int (m,)
    status : ndarray of int8 (m,)
        `DONE` or `FAILED`.
    values : ndarray (m, p)
        Numbers in the order of the study's outputs; nan where failed.
    texts : list of list of str
        A list a case, in the order of the outputs that are texts.
    errors : dict of int to str
        By case.
    seconds : float
        Spent on them.
    """

    cases: np.ndarray
    status: np.ndarray
    values: np.ndarray
    texts: list
    errors: dict = field(default_factory=dict)
    seconds: float = 0.0


@dataclass(frozen=True)
class Case:
    """What an analysis gets.

    Attributes
    ----------
    base : Vehicle
        Configured, with what the study sets.
    changes : dict of str to float or str
        Parameters of this case, as `Vehicle.replace` takes them.
    settings : dict of str to float
        Inputs of the analysis that study or case set, SI.
    """

    base: Any
    changes: dict
    settings: dict

    @property
    def vehicle(self):
        """The vehicle of this case."""
        return self.base.replace(self.changes) if self.changes else self.base


@dataclass
class Cases:
    """How a row of factors becomes a vehicle and settings."""

    loaded: Any
    configuration: str | None
    changes: dict
    settings: dict
    names: tuple
    labels: tuple
    inputs: frozenset
    _bases: dict = field(default_factory=dict)

    @classmethod
    def of(cls, study):
        """Those of a study."""
        changes = {name: value for name, value in study.set.items() if name not in study.inputs}
        labels = tuple(study.space.labels(k) for k in range(len(study.names)))
        return cls(study.loaded, study.configuration, changes, study.settings, study.names, labels, frozenset(study.inputs))

    def base(self, configuration):
        """The vehicle that cases depart from, made once a configuration."""
        if configuration not in self._bases:
            vehicle = self.loaded.configured(configuration) if configuration else self.loaded
            self._bases[configuration] = vehicle.replace(self.changes) if self.changes else vehicle
        return self._bases[configuration]

    def case(self, row):
        """The `Case` of a row of factors."""
        configuration, changes, settings = self.configuration, {}, dict(self.settings)
        for name, labels, value in zip(self.names, self.labels, row.tolist()):
            value = labels[int(value)] if labels else value
            if name == CONFIGURATION:
                configuration = value
            elif name in self.inputs:
                settings[name] = value
            else:
                changes[name] = value
        return Case(self.base(configuration), changes, settings)


@dataclass
class Payload:
    """All that a worker needs of a study."""

    cases: Cases
    analysis: Any
    numbers: tuple
    texts: tuple
    _solvers: dict = field(default_factory=dict)       # by the vehicle that cases depart from

    @classmethod
    def of(cls, study):
        """That of a study."""
        numbers, texts = (tuple(n for n, out in study.outputs.items() if out.text is kind) for kind in (False, True))
        return cls(Cases.of(study), study.analysis, numbers, texts)

    def solve(self, row):
        """Results of a case: numbers (list) and texts (list)."""
        case = self.cases.case(row)
        if case.base not in self._solvers:
            self._solvers[case.base] = self.analysis.solver(case.base)
        found = self._solvers[case.base](case)
        return [float(found[name]) for name in self.numbers], [str(found[name]) for name in self.texts]

    def chunk(self, cases, rows):
        """Solve cases one after another; an error is theirs, and the next case goes on."""
        start = perf_counter()
        result = Chunk(np.asarray(cases), np.full(len(cases), FAILED, np.int8), np.full((len(cases), len(self.numbers)), np.nan), [], {})
        with one_thread():
            for k, row in enumerate(rows):
                try:
                    result.values[k], texts = self.solve(row)
                    result.status[k] = DONE
                except Exception as error:
                    result.errors[int(cases[k])] = error_text(error)
                    texts = [""] * len(self.texts)
                result.texts.append(texts)
        result.seconds = perf_counter() - start
        return result


def error_text(error):
    """One line: kind and message, and for errors that railsym did not raise on purpose the line they came from."""
    from railsym.errors import RailsymError

    text = f"{type(error).__name__}: {error}"
    if not isinstance(error, RailsymError):
        frame = traceback.extract_tb(error.__traceback__)[-1]
        text += f" (in {frame.name})"
    text = " ".join(text.split())
    return text if len(text) <= _MOST_TEXT else text[:_MOST_TEXT - 3] + "..."


def one_thread():
    """Linear algebra by one thread: workers share the cores, and results do not depend on how many there are."""
    return _controller().limit(limits=1, user_api="blas")


def _controller():
    global _blas
    if _blas is None:
        from threadpoolctl import ThreadpoolController

        import scipy.linalg.lapack  # noqa: F401  SciPy brings a library of its own: load it before they are looked up

        _blas = ThreadpoolController()
    return _blas


_blas = None


def run_chunk(key, version, payload, cases, rows, attempt=None):
    """Entry of a worker.

    Parameters
    ----------
    key : str
        Hash of the study.
    version : str
        Of railsym where the study was started.
    payload : bytes or None
        The pickled `Payload`, or None where the worker should know it.
    cases : ndarray of int (m,)
    rows : ndarray (m, k)
    attempt
        Makes the call another one for executors that remember calls.

    Returns
    -------
    Chunk or None
        None: this worker does not know the study.
    """
    import railsym

    if railsym.__version__ != version:
        raise RuntimeError(f"a worker has railsym {railsym.__version__}, the study was started by {version}; install the same everywhere")
    if key not in _studies:
        if payload is None:
            return None
        while len(_studies) >= _MOST_STUDIES:
            _studies.pop(next(iter(_studies)))
        _studies[key] = pickle.loads(payload)
    return _studies[key].chunk(cases, rows)
