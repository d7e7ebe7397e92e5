# SPDX-License-Identifier: BSD-3-Clause
"""The store of a complete study: netCDF, classic format with 64-bit offsets, one record a case.

Written once from the journal, under another name that is then changed: it is there whole or not at all. It holds no times and no names of
machines, and its cases are in the order of the plan, so one study gives the same bytes however it was computed. SciPy writes the header;
records are streamed behind it as `railsym.results` does.
"""

from __future__ import annotations

import io
import json
import os

import numpy as np

from railsym.results.errors import ResultFileError
from railsym.results.files import replacing
from railsym.sweep.errors import StoreError
from railsym.sweep.worker import MISSING, STATUS

CASE, FORMAT, FORMAT_NAME, STUDY = "case", "railsym_format", "study 1", "railsym_study"
CASE_OF_ERROR, ERROR = "error_case", "error_text"
_RECORDS = 4                 # byte at which the number of records stands
_BLOCK = 8192


class Columns:
    """Outputs of all cases in memory.

    Attributes
    ----------
    status : ndarray of int8 (n,)
    values : ndarray (n, p)
        nan where there is none.
    texts : ndarray of object (n, t)
    errors : dict of int to str
    """

    def __init__(self, study):
        outputs = study.outputs.values()
        self.status = np.full(study.size, MISSING, np.int8)
        self.values = np.full((study.size, sum(not o.text for o in outputs)), np.nan)
        self.texts = np.full((study.size, sum(o.text for o in outputs)), "", dtype=object)
        self.errors = {}
        self._same = {}

    def put(self, chunk):
        """Take a chunk; of a case that was computed twice the last one."""
        self.status[chunk.cases], self.values[chunk.cases] = chunk.status, chunk.values
        for case, texts in zip(chunk.cases.tolist(), chunk.texts):
            self.texts[case] = [self._same.setdefault(text, text) for text in texts]   # one object a text: a label comes back a million times
            self.errors.pop(case, None)
        self.errors.update(chunk.errors)


def write_store(path, study, header, columns):
    """Write a complete store.

    Raises
    ------
    StoreError
        Disk full and the like; the journal is intact, and a file that had the name before.
    """
    widths = [_width(columns.texts[:, k]) for k in range(columns.texts.shape[1])]
    head, record = _header(study, header, widths, dict(sorted(columns.errors.items())))
    try:
        with replacing(path) as part, open(part, "xb") as file:
            file.write(head[:_RECORDS] + study.size.to_bytes(4, "big") + head[_RECORDS + 4:])
            for start in range(0, study.size, _BLOCK):
                file.write(_records(study, columns, record, start, min(start + _BLOCK, study.size)))
            file.flush()
            os.fsync(file.fileno())
    except ResultFileError as error:
        raise StoreError(f"{error}. All results are in the journal beside it; make room and run the study again to write the store") from error


def _width(texts):
    """Bytes of the longest text, in fours as netCDF pads."""
    longest = max((len(text.encode()) for text in set(texts.tolist())), default=0)
    return max(4, -(-longest // 4) * 4)


def _records(study, columns, record, start, stop):
    block = np.zeros(stop - start, record)
    numbers, texts = iter(range(columns.values.shape[1])), iter(range(columns.texts.shape[1]))
    for name, values in zip(study.names, study.rows(start, stop).T):
        block[name] = values
    block["status"] = columns.status[start:stop]
    for name, out in study.outputs.items():
        if out.text:
            block[name] = [text.encode() for text in columns.texts[start:stop, next(texts)]]
        else:
            block[name] = columns.values[start:stop, next(numbers)]
    return block.tobytes()


def _header(study, header, widths, errors):
    """Header and record type of a store without records; what is not by case stands in the header's file."""
    from scipy.io import netcdf_file

    target, record = io.BytesIO(), []
    file = netcdf_file(target, "w", version=2)
    setattr(file, FORMAT, FORMAT_NAME.encode())
    file.railsym_version = header["railsym_version"].encode()
    setattr(file, STUDY, json.dumps(header, sort_keys=True).encode())
    file.createDimension(CASE, None)
    _errors(file, errors)
    for name, unit, label in zip(study.names, study.units, (study.space.labels(k) for k in range(len(study.names)))):
        details = {"units": unit or "-", "role": "factor"}
        if label:
            details |= {"flag_values": np.arange(len(label), dtype=">f8"), "flag_meanings": " ".join(label)}
        _variable(file, record, name, ">f8", details)
    _variable(file, record, "status", ">i4", {"flag_values": np.arange(len(STATUS), dtype=">i4"), "flag_meanings": " ".join(STATUS)})
    widths = iter(widths)
    for name, out in study.outputs.items():
        details = {"units": out.unit, "long_name": out.description, "role": "output"}
        _variable(file, record, name, f"S{next(widths)}" if out.text else ">f8", details)
    file.flush()
    record = np.dtype(record)
    whole = bytearray(target.getvalue()[:-record.itemsize])
    whole[_RECORDS:_RECORDS + 4] = bytes(4)
    return bytes(whole), record


def _errors(file, errors):
    """Errors apart from the records: few cases have one."""
    if not errors:
        return
    texts = np.array([text.encode() for text in errors.values()])
    file.createDimension("failed_case", len(errors))
    file.createDimension("error_length", texts.dtype.itemsize)
    file.createVariable(CASE_OF_ERROR, "i4", ("failed_case",))[:] = list(errors)
    file.createVariable(ERROR, "c", ("failed_case", "error_length"))[:] = texts.view("S1").reshape(len(errors), -1)


def _variable(file, record, name, kind, details):
    """A record variable; SciPy takes the size of a record from the first one."""
    if kind[0] == "S":
        file.createDimension(f"{name}_length", int(kind[1:]))
        variable = file.createVariable(name, "c", (CASE, f"{name}_length"))
        variable[0] = np.zeros(int(kind[1:]), "S1")
    else:
        variable = file.createVariable(name, kind[1:], (CASE,))
        variable[0] = 0
    for key, value in details.items():
        if len(value):
            setattr(variable, key, value.encode() if isinstance(value, str) else value)
    record.append((name, kind))


def read_header(path):
    """Header of a store: what `check_same` compares.

    Raises
    ------
    StoreError
        Not a store of a study.
    """
    with _opened(path) as file:
        return json.loads(getattr(file, STUDY).decode())


def read_store(path, study):
    """`Columns` of a store, and its factors (n, k)."""
    with _opened(path) as file:
        columns, numbers, texts = Columns(study), iter(range(study.size)), iter(range(study.size))
        columns.status[:] = _copy(file, "status")
        for name, out in study.outputs.items():
            data = _copy(file, name)
            if out.text:
                raw = data.view(f"S{data.shape[1]}")[:, 0]
                unique, place = np.unique(raw, return_inverse=True)
                columns.texts[:, next(texts)] = np.array([text.decode() for text in unique], dtype=object)[place]
            else:
                columns.values[:, next(numbers)] = data
        if CASE_OF_ERROR in file.variables:
            rows = _copy(file, ERROR)
            errors = rows.view(f"S{rows.shape[1]}")[:, 0]
            columns.errors = {int(case): text.decode() for case, text in zip(_copy(file, CASE_OF_ERROR), errors)}
        return columns


def read_factors(path, names):
    """Factors in a store, (n, k), SI."""
    with _opened(path) as file:
        return np.column_stack([_copy(file, name).astype(float) for name in names])


def _copy(file, name):
    """A variable out of the file's memory map, which can then be closed."""
    return np.array(file.variables[name].data, order="C")


def _opened(path):
    from scipy.io import netcdf_file

    try:
        file = netcdf_file(path, "r", mmap=os.path.getsize(path) > 0)
    except (OSError, TypeError, ValueError, IndexError, AssertionError) as error:
        raise StoreError(f"{path} cannot be read as a store of a study: {error}") from error
    if getattr(file, FORMAT, b"").decode() != FORMAT_NAME:
        given = getattr(file, FORMAT, b"").decode() or "none"
        file.close()
        raise StoreError(f"{path} is netCDF, but not a store of a study (its {FORMAT}: {given}; this railsym reads {FORMAT_NAME!r})")
    return file
