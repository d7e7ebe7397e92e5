# SPDX-License-Identifier: BSD-3-Clause
"""What the figures were measured on: processor, memory, versions. No names of machines or people."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_OURS = ("railsym", "numpy", "scipy", "sympy", "cffi", "matplotlib")
_PEERS = ("numba", "casadi", "exudyn", "distributed", "mpi4py", "SALib", "pymoo")


def described():
    """Machine and versions, as JSON takes them.

    Returns
    -------
    dict
        processor, cores (available to this process), memory_gb, system, python, compiler, packages, commit ("" outside of a checkout),
        and the load of the machine at the start (mean number of running processes over the last minute).
    """
    return {"processor": processor(), "cores": _cores(), "memory_gb": _memory(), "system": f"{platform.system()} {platform.machine()}",
            "python": platform.python_version(), "compiler": _first_line(os.environ.get("CC", "cc"), "--version"),
            "packages": {name: found for name in (*_OURS, *_PEERS) if (found := _version(name))}, "commit": _commit(), "load": _load()}


def processor():
    """Model of the processor."""
    try:
        found = re.search(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
    except OSError:
        found = None
    if found:
        return found[1]
    return _first_line("sysctl", "-n", "machdep.cpu.brand_string") or platform.processor() or platform.machine()


def lines(machine):
    """The same for a person, a list of lines."""
    packages = ", ".join(f"{name} {number}" for name, number in machine["packages"].items())
    return [f"{machine['processor']}, {machine['cores']} cores, {machine['memory_gb']:.0f} GB, {machine['system']}, load {machine['load']:.1f}",
            f"Python {machine['python']}, {machine['compiler']}", packages]


def _cores():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


def _memory():
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e9
    return float("nan")


def _load():
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")


def _version(name):
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _commit():
    found = _first_line("git", "-C", str(Path(__file__).parent), "rev-parse", "--short", "HEAD")
    changed = _first_line("git", "-C", str(Path(__file__).parent), "status", "--porcelain", "--untracked-files=no")
    return found + ("+" if found and changed else "")


def _first_line(*command):
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=10)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.splitlines()[0].strip() if done.returncode == 0 and done.stdout else ""


if __name__ == "__main__":
    sys.stdout.write("\n".join(lines(described())) + "\n")
