# SPDX-License-Identifier: BSD-3-Clause
"""Write the cffi binding: ``python build_ffi.py output.c interface.h ...``."""

import pathlib
import sys

import cffi


def main(output, *interfaces):
    """Emit the API-mode binding of the declarations in ``interfaces``."""
    builder = cffi.FFI()
    for interface in interfaces:
        builder.cdef(pathlib.Path(interface).read_text(encoding="ascii"))
    builder.set_source("railsym._railsym", '#include "railsym.h"')
    builder.emit_c_code(str(output))


if __name__ == "__main__":
    main(*sys.argv[1:])
