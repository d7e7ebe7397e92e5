# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of functions and of commands."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Figure:
    """One measured figure.

    Attributes
    ----------
    name, unit : str
    value : float
    limit : float or None
        What the project asks for at most (or, where ``at_least``, at least).
    note : str
        How it was measured.
    at_least : bool
    """

    name: str
    value: float
    unit: str
    limit: float | None = None
    note: str = ""
    at_least: bool = False


def median_time(function, repeat=21):
    """Median wall time (s) of calls, after one that warms up."""
    function()
    times = []
    for _ in range(repeat):
        start = perf_counter()
        function()
        times.append(perf_counter() - start)
    return statistics.median(times)


# Linux hands the peak of the process that starts another one on to it in ru_maxrss, so the kernel's count of the new one is read
PEAK = """
import sys
if sys.platform == "linux":
    with open("/proc/self/status", encoding="ascii") as status:
        peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024.0
else:
    import resource
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024.0**2 if sys.platform == "darwin" else 1024.0)
print(peak)
"""


def cost_of_code(code, directory=None):
    """CPU time (s) and peak memory (MB) of ``python -c code`` in a process of its own, started in a folder that holds no other railsym if not told."""
    directory = tempfile.gettempdir() if directory is None else directory
    process = subprocess.Popen([sys.executable, "-c", code + PEAK], cwd=directory, env=os.environ | {"OMP_NUM_THREADS": "1"}, stdout=subprocess.PIPE, text=True)
    printed = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise RuntimeError(f"{code!r} ended with status {status}")
    return usage.ru_utime + usage.ru_stime, float(printed.split()[-1])


def printed_by(code, directory):
    """Number that ``python -c code`` prints."""
    done = subprocess.run([sys.executable, "-c", code], cwd=directory, capture_output=True, text=True, check=True)
    return float(done.stdout)
