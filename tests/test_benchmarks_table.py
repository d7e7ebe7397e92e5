# SPDX-License-Identifier: BSD-3-Clause
"""The table of the benchmarks, their files and their comparison; no figure is measured here."""

import json
import os
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest

from benchmarks import compare, machine, table
from benchmarks.__main__ import measured
from benchmarks.measure import Figure, cost_of_code

ROOT = Path(__file__).resolve().parent.parent
COST = Figure("step", 8.0, "us", 10.0, "31 bodies")
RATE = Figure("cases", 90.0, "1/s", 100.0, "a core", at_least=True)
FREE = Figure("states", 316.0, "-")


def file_of(figures, **where):
    return {"machine": {"processor": "one", "packages": {"numpy": "2.0"}, "load": 0.1} | where, "figures": [asdict(figure) for figure in figures], "failed": {}}


@pytest.mark.parametrize(("figure", "met"), [(COST, True), (RATE, False), (FREE, True), (Figure("edge", 10.0, "us", 10.0), True)])
def test_limits(figure, met):
    assert table.is_met(figure) == met
    assert ("NO" in table.row(figure)) == (not met)


def test_a_long_note_goes_on_below_its_column():
    lines = table.row(Figure("a", 1.0, "s", None, "word " * 40)).splitlines()
    assert len(lines) > 1 and all(len(line) <= 150 for line in lines) and lines[1].startswith(" " * 90)


def test_a_group_that_fails_is_named_and_the_others_are_kept(tmp_path, capsys):
    def broken():
        raise ImportError("no module named numba")

    path = tmp_path / "figures.json"
    assert measured({"first": lambda: [COST], "second": broken, "third": lambda: [RATE, FREE]}, path) == 1
    told = capsys.readouterr().out
    assert "not measured: second: ImportError: no module named numba" in told and "not kept: cases" in told and "1 of 2 limits kept" in told
    content = compare.load(path)
    assert [figure["name"] for figure in content["figures"]] == ["step", "cases", "states"]
    assert content["machine"]["processor"] and content["machine"]["packages"]["numpy"]


@pytest.mark.parametrize(("figure", "value", "word"), [(COST, 10.0, "WORSE"), (COST, 6.0, "better"), (COST, 8.4, ""), (RATE, 60.0, "WORSE"), (RATE, 120.0, "better"),
                                                      (FREE, 500.0, "")])
def test_a_change_is_judged_by_what_the_figure_is(figure, value, word):
    after = Figure(figure.name, value, figure.unit, figure.limit, figure.note, figure.at_least)
    line = next(line for line in compare.compared(file_of([figure]), file_of([after])) if line.startswith(figure.name))
    assert line.split()[-1] == (word or f"{value / figure.value:.2f}")


def test_other_machines_and_missing_figures_are_said():
    said = "\n".join(compare.compared(file_of([COST, FREE]), file_of([COST, RATE], processor="two", packages={"numpy": "2.1"})))
    assert "processor: one before, two after" in said and "packages: numpy 2.0 before, numpy 2.1 after" in said
    assert "states" in said and "only before" in said and "only after" in said


@pytest.mark.parametrize(("text", "words"), [(None, "No such file"), ("{}", "not a file of figures"), ("[1", "not a file of figures"),
                                            (json.dumps({"figures": [{"name": "a"}]}), "not a file of figures")])
def test_a_file_that_holds_no_figures_is_refused(tmp_path, text, words):
    path = tmp_path / "figures.json"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(compare.FileError, match=words):
        compare.load(path)


def test_the_command_compares(tmp_path):
    paths = [tmp_path / "before.json", tmp_path / "after.json"]
    for path in paths:
        path.write_text(json.dumps(file_of([COST])), encoding="utf-8")
    done = subprocess.run([sys.executable, "-m", "benchmarks", "--compare", *map(str, paths)], cwd=ROOT, capture_output=True, text=True, check=False,
                          env={key: value for key, value in os.environ.items() if key != "PYTHONSAFEPATH"})
    assert done.returncode == 0 and "step" in done.stdout and "1.00" in done.stdout


def test_the_machine_is_told_without_its_name():
    import platform

    told = "\n".join(machine.lines(machine.described()))
    assert "Python" in told and "numpy" in told and (platform.node() == "" or platform.node() not in told)


def test_the_peak_of_a_process_is_its_own():
    """A process that starts with 300 MB in hand does not hand them on to one that takes 50."""
    ballast = b"x" * 300_000_000
    time, peak = cost_of_code("held = b'x' * 50_000_000\n")
    assert len(ballast) > 0 and time >= 0.0
    assert 50.0 < peak < 150.0
