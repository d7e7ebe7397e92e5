# SPDX-License-Identifier: BSD-3-Clause
"""``python -m derive.theory [--check]``: write docs/theory.md, or prove that it is up to date."""

import argparse
import pathlib
import sys

from derive.__main__ import kernels
from derive.theory.page import page

TARGET = pathlib.Path(__file__).resolve().parents[2] / "docs" / "theory.md"


def main(arguments=None):
    """Command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m derive.theory", description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare with docs/theory.md, write nothing")
    options = parser.parse_args(arguments)
    text = page(kernels())
    if not options.check:
        TARGET.write_text(text, encoding="utf-8", newline="\n")
        print(f"wrote docs/{TARGET.name}, {text.count(chr(10))} lines")
        return 0
    same = TARGET.exists() and TARGET.read_bytes() == text.encode("utf-8")
    print("docs/theory.md is what the derivation gives" if same else "docs/theory.md differs from the derivation: run `python -m derive.theory` and commit")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
