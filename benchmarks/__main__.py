# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks [GROUP ...] [--json FILE]``: machine, versions and a table of figures, and the same as JSON.

``python -m benchmarks --compare BEFORE.json AFTER.json`` sets two such files beside each other.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")          # before NumPy: all figures are those of one core
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import sys
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path

# the checkout's railsym/ has no compiled library: find the installed one first
ROOT = Path(__file__).resolve().parent.parent
sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != ROOT] + [str(ROOT)]

from benchmarks import compare, machine, table


def main(arguments=None):
    """Measure and print, or compare; 1 where a group could not be measured."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("group", nargs="*", help="groups of figures (default: all); an unknown one lists them")
    parser.add_argument("--json", metavar="FILE", help="write machine and figures as JSON, after each group")
    parser.add_argument("--compare", nargs=2, metavar=("BEFORE", "AFTER"), help="two such files; nothing is measured")
    parser.add_argument("--threshold", type=float, default=0.1, help="relative change that a comparison points out (default 0.1)")
    options = parser.parse_args(arguments)
    if options.compare:
        try:
            before, after = map(compare.load, options.compare)
        except compare.FileError as error:
            parser.error(str(error))
        print("\n".join(compare.compared(before, after, options.threshold)))
        return 0
    if find_spec("railsym._railsym") is None:
        parser.error("railsym is not installed in this Python: pip install . first")
    from benchmarks.figures import GROUPS

    unknown = [name for name in options.group if name not in GROUPS]
    if unknown:
        parser.error(f"no group {unknown[0]!r}; there are {', '.join(GROUPS)}")
    return measured({name: GROUPS[name] for name in options.group or GROUPS}, options.json)


def measured(groups, path=None):
    """Print the figures of groups as they come; a group that fails is named at the end, and the others stay."""
    found, failed, where = [], {}, machine.described()
    print("\n".join([*machine.lines(where), "", table.head()]), flush=True)
    for name, function in groups.items():
        try:
            figures = list(function())
        except Exception as error:  # whatever one group meets, the figures of the others are not lost
            failed[name] = f"{type(error).__name__}: {error}"
            continue
        found += figures
        for figure in figures:
            print(table.row(figure), flush=True)
        if path:
            content = {"machine": where, "figures": [asdict(figure) for figure in found], "failed": failed}
            Path(path).write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    print("\n".join(["", *table.summary(found, failed)]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
