# SPDX-License-Identifier: BSD-3-Clause
"""Layout of a run in a netCDF file: the classic format with 64-bit offsets, one record a sample.

    header | time c1 c2 ... ck | time c1 c2 ... ck | ...        big-endian doubles; bytes 4 to 7 of the header count the records

The classic format is chosen because it can be appended to without touching what is there: a disk that fills up or a program that is killed
leaves every record that was counted. (In HDF5, the format of netCDF-4, the index is rewritten too; a full disk made such files
unreadable when we tried.) Any netCDF library reads it. SciPy writes the header.
"""

from __future__ import annotations

import io

import numpy as np

from railsym.results.channel import TIME
from railsym.results.metadata import RunInfo

INFO, FORMAT, FORMAT_NAME = "railsym_run", "railsym_format", "run 1"
RECORDS = 4                 # byte at which the number of records stands
_ROOM, _ENDING, _MESSAGE = 4096, 256, 1024  # bytes: to spare in the JSON, and of two texts that are known at the end only
_PLAIN = ("vehicle", "configuration", "track", "creep_law", "railsym_version")


def header(channels, info, size=None):
    """Header of a file without records.

    Parameters
    ----------
    channels : Channels
    info : RunInfo
    size : int, optional
        Bytes of the JSON; with room to spare if not given.

    Returns
    -------
    bytes, int
        The header, and the bytes of its JSON. Headers with the same channels and size are equally long.

    Raises
    ------
    ValueError
        The metadata do not fit into ``size``.
    """
    from scipy.io import netcdf_file

    text = info.to_json().encode()
    size = len(text) + _ROOM if size is None else size
    if len(text) > size:
        raise ValueError(f"metadata of {len(text)} bytes do not fit into {size}")
    target = io.BytesIO()
    file = netcdf_file(target, "w", version=2)
    for name, value in attributes(info).items():
        setattr(file, name, value)
    setattr(file, INFO, text.ljust(size))
    file.createDimension(TIME, None)
    for name, details in {TIME: {"units": "s"}, **{c.name: _details(c) for c in channels.values()}}.items():
        variable = file.createVariable(name, "d", (TIME,))
        for key, value in details.items():
            setattr(variable, key, value.encode())
        variable[0] = 0.0  # SciPy takes the size of a record from the first one
    file.flush()
    whole = bytearray(target.getvalue()[:-record_type(channels).itemsize])
    whole[RECORDS:RECORDS + 4] = bytes(4)
    return bytes(whole), size


def attributes(info):
    """Metadata for other programs, bytes by name: of fixed length where they change when the run ends."""
    plain = {name: getattr(info, name).encode() for name in _PLAIN if getattr(info, name)}
    plain["ending"] = _cut(str(info.ending), _ENDING)
    plain["message"] = _cut(info.message, _MESSAGE)
    return plain | {FORMAT: FORMAT_NAME.encode()}


def record_type(channels):
    """NumPy type of a record: time and channels, (k + 1,) big-endian doubles."""
    return np.dtype((">f8", (len(channels) + 1,)))


def read_info(raw):
    """RunInfo from the attribute (bytes)."""
    return RunInfo.from_json(raw.decode())


def _details(channel):
    given = {"units": channel.unit, "long_name": channel.description, "place": channel.place}
    return {key: value for key, value in given.items() if value}  # SciPy writes an empty text as one zero byte


def _cut(text, size):
    """Text as UTF-8 of exactly ``size`` bytes, cut between characters, filled with blanks."""
    return text.encode()[:size].decode(errors="ignore").encode().ljust(size)
