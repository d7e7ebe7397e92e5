# SPDX-License-Identifier: BSD-3-Clause
"""The table of exact rolling theory as the C library reads it."""

from functools import cache
from importlib.resources import as_file, files

import numpy as np

from railsym._core import ffi


@cache
def creep_table():
    """The shipped table, read once.

    Returns
    -------
    cdata rs_creep_table *
        Its coefficients stay alive with it.

    Notes
    -----
    The file holds 16-bit integers, shape (a/b, s1, s2, s3, 3), and the unit of each of Tx, Ty, Tm (head of
    csrc/creep/exact_table.c), all dimensionless; ``python -m derive.exact_contact`` writes it.
    """
    with as_file(files("railsym") / "data" / "contact" / "exact_table.npz") as path, np.load(path) as kept:
        coefficients, (least, largest) = kept["coefficients"] * kept["scale"], kept["ratio_range"]
    ratios, first, _, pieces, _ = coefficients.shape
    whole = np.append(np.moveaxis(coefficients, 0, 2).ravel(), 0.0)
    table = ffi.new("rs_creep_table *", {"pieces": pieces - 2, "ratio_pieces": ratios - 2, "least": least, "largest": largest,
                                         "coefficients": ffi.from_buffer("double[]", whole)})
    _KEPT.append(whole)
    return table


_KEPT = []  # cffi does not keep what a struct points to
