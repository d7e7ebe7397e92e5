# SPDX-License-Identifier: BSD-3-Clause
"""The committed kernels are what the derivation gives, byte for byte, in any process."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import sympy

ROOT = Path(__file__).resolve().parent.parent


def check(root, hash_seed):
    """``python -m derive --check`` in a process of its own, under way."""
    environment = os.environ | {"PYTHONHASHSEED": str(hash_seed), "PYTHONDONTWRITEBYTECODE": "1", "PYTHONSAFEPATH": ""}
    return subprocess.Popen([sys.executable, "-m", "derive", "--check"], cwd=root, env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def copy_with_one_changed_byte(target):
    """The derivation and its output, with one digit of one kernel changed, one file too many and one missing."""
    for part in ("derive", "csrc/generated"):
        shutil.copytree(ROOT / part, target / part, ignore=shutil.ignore_patterns("__pycache__"))
    generated = target / "csrc" / "generated"
    text = (generated / "line.h").read_text(encoding="ascii")
    place = text.rindex(" + ")
    (generated / "line.h").write_text(text[:place] + " - " + text[place + 3:], encoding="ascii")
    (generated / "left_over.h").write_text("\n", encoding="ascii")
    (generated / "wheelset.h").unlink()
    return target


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Both checks at once: the committed files, and a damaged copy under another hash seed."""
    damaged = copy_with_one_changed_byte(tmp_path_factory.mktemp("tree"))
    started = check(ROOT, 1), check(damaged, 20260)
    return [(process.communicate(timeout=300)[0], process.returncode) for process in started]


def test_sympy_is_the_pinned_one():
    """Another minor version orders and prints otherwise; the files are those of the pinned one."""
    with open(ROOT / "pyproject.toml", "rb") as file:
        extras = tomllib.load(file)["project"]["optional-dependencies"]
    pins = {re.fullmatch(r"sympy==(\d+\.\d+)\.\*", p).group(1) for group in extras.values() for p in group if p.startswith("sympy")}
    assert len(pins) == 1
    assert sympy.__version__.startswith(pins.pop() + ".")


def test_committed_kernels_are_reproduced(runs):
    output, status = runs[0]
    assert status == 0, output
    assert "reproduced byte for byte" in output


def test_a_changed_byte_is_noticed_and_nothing_else(runs):
    """Under another hash seed every other file is the same, so only the damaged ones are named."""
    output, status = runs[1]
    assert status == 1, output
    named = re.findall(r"csrc/generated/(\S+) differs from a fresh derivation", output)
    assert named == ["left_over.h", "line.h", "wheelset.h"]


def test_the_derivation_is_not_imported_at_run_time():
    """A user of the package needs neither SymPy nor derive."""
    code = ("import sys, railsym.linear, railsym.vehicle; railsym.linear.linearise(railsym.vehicle.load_vehicle('bogie'), 50.0);"
            "print([m for m in ('derive', 'sympy') if m in sys.modules])")
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT.parent)
    assert run.stdout.strip() == "[]"
