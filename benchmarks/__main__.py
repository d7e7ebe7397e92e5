# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks [GROUP ...] [--json FILE]``: a table of figures, and the same as JSON."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")          # before NumPy: all figures are those of one core

import argparse
import json
import platform
import sys
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path

# the checkout's railsym/ has no compiled library: find the installed one first
ROOT = Path(__file__).resolve().parent.parent
sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != ROOT] + [str(ROOT)]

from benchmarks.figures import GROUPS


def main(arguments=None):
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("group", nargs="*", help=f"of {', '.join(GROUPS)} (default: all)")
    parser.add_argument("--json", metavar="FILE", help="write the figures as JSON")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.group if name not in GROUPS]
    if unknown:
        parser.error(f"no group {unknown[0]!r}; there are {', '.join(GROUPS)}")
    if find_spec("railsym._railsym") is None:
        parser.error("railsym is not installed in this Python: pip install . first")
    figures = []
    for name in options.group or GROUPS:
        for figure in GROUPS[name]():
            figures.append(figure)
            print(row(figure), flush=True)
    if options.json:
        content = {"python": platform.python_version(), "processor": platform.machine(), "figures": [asdict(f) for f in figures]}
        Path(options.json).write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    return 0


def row(figure):
    """One line of the table."""
    limit = "" if figure.limit is None else f"{'at least' if figure.at_least else 'under'} {figure.limit:g}"
    return f"{figure.name:<50} {figure.value:>10.4g} {figure.unit:<3} {limit:<14} {figure.note}".rstrip()


if __name__ == "__main__":
    sys.exit(main())
