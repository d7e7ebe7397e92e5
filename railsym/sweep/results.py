# SPDX-License-Identifier: BSD-3-Clause
"""Results of a study: factors and outputs by name, with units."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np

from railsym.results.errors import optional
from railsym.sweep.errors import StoreError, SweepError, unknown
from railsym.sweep.journal import journal_of, read_frames, chunk_of
from railsym.sweep.store_file import Columns, read_factors, read_header, read_store
from railsym.sweep.worker import STATUS


class Results:
    """What a study gave.

    Attributes
    ----------
    study : Study
    names, units : tuple of str (k,), dict of str to str
        Names of the factors; units of factors and outputs, SI.
    outputs : tuple of str
    factors : ndarray (n, k)
        SI; texts by their place in the list (`labels`).
    status : ndarray of str (n,)
        "done", "failed" or "missing".
    errors : dict of int to str
        Of the failed cases.
    path : Path or None
        Of the store.
    """

    def __init__(self, study, columns, path=None):
        self.study, self.path, self._columns = study, path, columns
        self.names, self.outputs = study.names, tuple(study.outputs)
        self.errors = dict(sorted(columns.errors.items()))
        self.units = dict(zip(study.names, study.units)) | {name: out.unit for name, out in study.outputs.items()}

    def __len__(self):
        return self.study.size

    def __repr__(self):
        return f"<Results of {self.study.loaded.name}: {self.message}>"

    @property
    def message(self):
        """How many cases are done, failed and missing."""
        counts = np.bincount(self._columns.status, minlength=len(STATUS))
        return f"{len(self)} cases: " + ", ".join(f"{n} {word}" for n, word in zip(counts, STATUS) if n or word == "done")

    @property
    def complete(self):
        """Every case is done or failed."""
        return bool((self._columns.status < len(STATUS) - 1).all())

    @cached_property
    def factors(self):
        rows = self.study.rows()
        rows.flags.writeable = False
        return rows

    @cached_property
    def status(self):
        return np.array(STATUS)[self._columns.status]

    def unit(self, name):
        """Unit of a factor or output."""
        self._known(name)
        return self.units[name]

    def labels(self, name):
        """Texts that the values of a factor stand for, or None."""
        return self.study.space.labels(self.names.index(name))

    def __getitem__(self, name):
        """A factor or an output, (n,): numbers (nan where a case failed or is missing), or texts."""
        self._known(name)
        if name in self.names:
            k = self.names.index(name)
            labels, column = self.study.space.labels(k), self.factors[:, k]
            return np.array(labels)[column.astype(int)] if labels else column
        out = self.study.outputs[name]
        place = [n for n, o in self.study.outputs.items() if o.text is out.text].index(name)
        return self._columns.texts[:, place].astype(str) if out.text else self._columns.values[:, place]

    def __contains__(self, name):
        return name in self.names or name in self.outputs

    def _known(self, name):
        if name not in self:
            raise SweepError(f"{name!r} is {unknown(name, [*self.names, *self.outputs], 'factors and outputs')}")

    def to_xarray(self):
        """As `xarray.Dataset` over the dimension ``case``; factors are coordinates."""
        xarray = optional("xarray", "to_xarray")
        coords = {name: ("case", self[name], {"units": self.units[name]}) for name in self.names}
        values = {name: ("case", self[name], {"units": self.units[name], "long_name": self.study.outputs[name].description}) for name in self.outputs}
        values["status"] = ("case", self.status)
        return xarray.Dataset(values, coords={"case": np.arange(len(self))} | coords, attrs={"message": self.message, "hash": self.study.hash})


def load(path, study=None):
    """Results from a store, or from the journal of a study that is not complete.

    Parameters
    ----------
    path : str or path
        Of the store.
    study : Study, optional
        The study, where it is at hand; read from the store otherwise.

    Raises
    ------
    StoreError
        No such store, or not one of a study.
    """
    from railsym.sweep.study_file import from_document

    path = Path(path)
    if path.is_file():
        header = read_header(path)
        study = study or from_document(header["document"], rows=lambda names: read_factors(path, names))
        return Results(study, read_store(path, study), path)
    journal = journal_of(path)
    frames = read_frames(journal) if journal.is_file() else iter(())
    first = next(frames, None)
    if first is None:
        raise StoreError(f"there is no store {path}, and no journal {journal.name} of a study under way")
    study = study or from_document(first[1]["document"])
    columns = Columns(study)
    for _, text, doubles in frames:
        columns.put(chunk_of(text, doubles))
    return Results(study, columns, path)
