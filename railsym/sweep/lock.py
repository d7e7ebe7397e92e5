# SPDX-License-Identifier: BSD-3-Clause
"""A lock on an open file that ends with the process."""

from __future__ import annotations


def locked_by_other(file):
    """Take the lock of an open file; True if another open file has it."""
    try:
        import fcntl
    except ImportError:                        # Windows
        import msvcrt

        try:
            file.seek(2**31 - 2)               # beyond what is read: there a lock forbids reading
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            return False
        except OSError:
            return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
