# SPDX-License-Identifier: BSD-3-Clause
"""``python -m examples [NAME ...]``: run the examples and write their pages and pictures to docs/gallery/."""

import argparse
import sys

from examples.pages import NAMES, TARGET, index, page, ran


def main(arguments=None):
    """Command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m examples", description=__doc__)
    parser.add_argument("name", nargs="*", help=f"of {', '.join(NAMES)} (default: all)")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.name if name not in NAMES]
    if unknown:
        parser.error(f"no example {unknown[0]!r}; there are {', '.join(NAMES)}")
    TARGET.mkdir(exist_ok=True)
    for name in options.name or NAMES:
        (TARGET / f"{name}.md").write_text(page(name, ran(name, TARGET / f"{name}.png")), encoding="utf-8")
        print(f"docs/gallery/{name}.md")
    (TARGET / "index.md").write_text(index(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
