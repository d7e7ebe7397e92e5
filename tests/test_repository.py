# SPDX-License-Identifier: BSD-3-Clause
"""House rules that a reader relies on: licence line, size of files, seeded random numbers."""

import ast
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
ROOMS = ("railsym", "derive", "csrc", "tests", "benchmarks", "docs", ".ci")
COMMENT = {".py": "#", ".toml": "#", "": "#", ".c": "/*", ".h": "/*"}
LONGEST = 400


def source_files():
    """Files that git knows, or in an unpacked archive all files, of the rooms."""
    try:
        listed = subprocess.run(["git", "ls-files", "--", *ROOMS], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        files = [ROOT / name for name in listed.splitlines()]
    except (OSError, subprocess.CalledProcessError):
        files = [path for room in ROOMS for path in (ROOT / room).rglob("*")]
    return sorted(p for p in files if p.is_file() and p.suffix in COMMENT and "__pycache__" not in p.parts)


FILES = source_files()
PYTHON = [path for path in FILES if path.suffix == ".py"]


def shown(path):
    return str(path.relative_to(ROOT))


def test_there_are_files_to_check():
    assert len(FILES) > 50


@pytest.mark.parametrize("path", FILES, ids=shown)
def test_one_licence_line_at_the_head(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    head = lines[1] if lines[0].startswith("#!") else lines[0]
    assert head.startswith(f"{COMMENT[path.suffix]} SPDX-License-Identifier: BSD-3-Clause")
    assert sum("SPDX-License-" + "Identifier:" in line for line in lines[:20]) == 1


def long_files():
    """Source files that may not be long: not the generated C, not the vehicle data."""
    return [p for p in FILES if "generated" not in p.parts and "data" not in p.parts]


@pytest.mark.parametrize("path", long_files(), ids=shown)
def test_no_long_file(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= LONGEST


@pytest.mark.parametrize("path", PYTHON, ids=shown)
def test_random_numbers_are_seeded(path):
    """No global generator, and a seed in every default_rng: a failing test must fail again."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            called = ast.unparse(node.func)
            if called.endswith("random.default_rng"):
                assert node.args or node.keywords, f"line {node.lineno}: default_rng without a seed"
            else:
                assert not re.fullmatch(r"(np|numpy)[.]random[.][a-z_]+", called), f"line {node.lineno}: {called} draws from a global generator"


@pytest.mark.parametrize("path", [p for p in PYTHON if p.parent.name in ("railsym", "plots")], ids=shown)
def test_drawing_and_symbolics_are_imported_late(path):
    """Importing railsym takes no matplotlib and needs no SymPy."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [getattr(node, "module", None) or ""]
        heavy = [name for name in names if isinstance(node, (ast.Import, ast.ImportFrom)) and name.split(".")[0] in ("matplotlib", "sympy", "scipy", "tqdm")]
        assert not heavy, f"line {node.lineno}: import {heavy[0]} inside the function that needs it"
