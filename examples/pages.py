# SPDX-License-Identifier: BSD-3-Clause
"""An example as a page: what it is about, what it prints, its picture, its code."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGET = HERE.parent / "docs" / "gallery"
NAMES = ("wheelset_hunting", "equivalent_conicity", "creep_curves", "critical_speed", "what_matters", "damper_from_bench", "rough_track",
         "limit_cycle", "curves", "optimised_pendolino")


def ran(name, picture):
    """Run an example in a process of its own, with the picture at a path; what it printed.

    Raises
    ------
    RuntimeError
        The example failed; its error is in the message.
    """
    environment = os.environ | {"MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, str(HERE / f"{name}.py"), str(picture)], capture_output=True, text=True, check=False, env=environment, cwd=picture.parent)
    if done.returncode:
        raise RuntimeError(f"example {name}:\n{done.stderr}")
    return done.stdout


def source(name):
    """Title, text and code (without licence and docstring) of an example."""
    text = (HERE / f"{name}.py").read_text(encoding="utf-8")
    title, _, words = ast.get_docstring(ast.parse(text)).partition("\n\n")
    return title, words.strip(), text.split('"""', 2)[2].strip()


def page(name, printed):
    """Markdown of an example's page."""
    title, words, code = source(name)
    lines = printed.rstrip().splitlines()
    return "\n".join([f"# {title}", "", words, "", f"![{title}]({name}.png)", "", "```", *(line.rstrip() for line in lines), "```", "",
                      f"`python examples/{name}.py` draws it and prints these lines:", "", "```python", code, "```", "", "[all examples](index.md)", ""])


def index():
    """Markdown of the page that lists all of them."""
    lines = ["# Gallery", "", "Ten short scripts in `examples/`, from a wheelset's hunting to the optimised Pendolino. The tests run them; `python -m examples` writes these pages.", ""]
    for name in NAMES:
        title, words, _ = source(name)
        lines += [f"## [{title}]({name}.md)", "", words, "", f"[![{title}]({name}.png)]({name}.md)", ""]
    return "\n".join(lines)
