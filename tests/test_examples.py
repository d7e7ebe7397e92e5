# SPDX-License-Identifier: BSD-3-Clause
"""The gallery's scripts run, draw, and print what their pages say."""

import re

import pytest

from examples.pages import HERE, NAMES, TARGET, index, page, ran, source

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def numbers(text):
    return [float(one) for one in NUMBER.findall(text)]


@pytest.mark.parametrize("name", NAMES)
def test_an_example_runs_and_its_page_is_up_to_date(name, tmp_path):
    """Numbers within 2 % and a unit of the last digit shown, as processors round differently and a vehicle on rough track amplifies it."""
    picture = tmp_path / "picture.png"
    printed = ran(name, picture)
    assert picture.read_bytes()[:4] == b"\x89PNG" and picture.stat().st_size > 10_000
    written = (TARGET / f"{name}.md").read_text(encoding="utf-8")
    fresh = page(name, printed)
    assert NUMBER.sub("#", written) == NUMBER.sub("#", fresh), "run python -m examples and commit"
    assert written.split("```python")[1] == fresh.split("```python")[1]
    for was, now in zip(numbers(written), numbers(fresh), strict=True):
        assert now == pytest.approx(was, rel=0.02, abs=0.11 if was < 10 else 1.0)


def test_all_examples_are_in_the_gallery():
    assert sorted(NAMES) == sorted(path.stem for path in HERE.glob("*.py") if path.stem not in ("__init__", "__main__", "pages"))
    assert (TARGET / "index.md").read_text(encoding="utf-8") == index()
    assert all(len(source(name)[2].splitlines()) < 45 for name in NAMES), "short scripts"


def test_an_example_that_fails_says_why(tmp_path, monkeypatch):
    monkeypatch.setattr("examples.pages.HERE", tmp_path)
    (tmp_path / "broken.py").write_text("raise ValueError('no such profile')\n", encoding="utf-8")
    with pytest.raises(RuntimeError, match="broken.*\n(.*\n)*.*no such profile"):
        ran("broken", tmp_path / "picture.png")
