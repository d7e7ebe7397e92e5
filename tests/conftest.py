# SPDX-License-Identifier: BSD-3-Clause
"""Paths of the test run.

The tests are about the installed package, whose compiled library is not in the source tree. So the checkout stands last on the
path: ``derive`` and ``benchmarks`` are found there, ``railsym`` where it is installed, however pytest was started.
"""

import sys
from pathlib import Path

import matplotlib

ROOT = Path(__file__).resolve().parent.parent

sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != ROOT] + [str(ROOT)]
matplotlib.use("Agg")
