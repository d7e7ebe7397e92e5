# SPDX-License-Identifier: BSD-3-Clause
"""Paths of the test run.

The tests are about the installed package, whose compiled library is not in the source tree. So the checkout stands last on the
path: ``derive``, ``benchmarks`` and ``examples`` are found there, ``railsym`` where it is installed, however pytest was started.
Processes that tests start, workers of studies among them, do not look into the folder they are started in.
"""

import os
import sys
from pathlib import Path

import matplotlib

ROOT = Path(__file__).resolve().parent.parent

sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != ROOT] + [str(ROOT)]
os.environ["PYTHONSAFEPATH"] = "1"
matplotlib.use("Agg")
