# SPDX-License-Identifier: BSD-3-Clause
"""Files that appear when they are complete."""

from __future__ import annotations

import glob
import os
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from railsym.results.errors import ResultFileError

PART = ".part"


def parts_of(path):
    """Unfinished files that were to take this name: what runs that were killed left."""
    path = Path(path)
    return sorted(path.parent.glob(glob.escape(path.name) + PART + "*"))


def free_part(path):
    """A free name to write to before the file takes its own: beside it, so that renaming cannot fail for want of space."""
    path, taken = Path(path), set(parts_of(path))
    names = (path.with_name(path.name + PART + (str(k) if k > 1 else "")) for k in count(1))
    return next(name for name in names if name not in taken)


def check_target(path):
    """Refuse a path that cannot be written, before anything is computed or written.

    Raises
    ------
    ResultFileError
    """
    path = Path(path)
    if path.is_dir():
        raise ResultFileError(f"{path} is a directory; give the name of a file")
    if not path.parent.is_dir():
        raise ResultFileError(f"{path} cannot be written: there is no directory {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise ResultFileError(f"{path} cannot be written: no permission to write in {path.parent}")


@contextmanager
def replacing(path):
    """A name to write to, which takes the place of ``path`` when the block ends without an error.

    Yields
    ------
    pathlib.Path

    Raises
    ------
    ResultFileError
        Disk full, no permission and the like; a file that was there is untouched and the unfinished one removed.
    """
    path = Path(path)
    check_target(path)
    part = free_part(path)
    try:
        yield part
        os.replace(part, path)
    except BaseException as error:
        with suppress(OSError):
            part.unlink()
        if isinstance(error, ResultFileError) or not isinstance(error, OSError):
            raise
        raise ResultFileError(f"{path} was not written: {reason(error)}; {kept(path)}") from error


def reason(error):
    """What the operating system says."""
    return getattr(error, "strerror", None) or str(error) or type(error).__name__


def kept(path):
    """That an existing file is untouched."""
    return f"the file of that name is as it was ({path.stat().st_size} bytes)" if path.exists() else "no file of that name was there"
