# SPDX-License-Identifier: BSD-3-Clause
"""Two files of figures beside each other."""

from __future__ import annotations

import json
from pathlib import Path

_NAME = 56


class FileError(ValueError):
    """A file that does not hold figures."""


def load(path):
    """Content of a file written by ``python -m benchmarks --json``.

    Raises
    ------
    FileError
        A file that cannot be read or holds something else.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        for figure in content["figures"]:
            figure["name"], float(figure["value"]), figure["unit"], figure["at_least"]
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        raise FileError(f"{path} is not a file of figures; python -m benchmarks --json FILE writes one") from None
    return content


def compared(before, after, threshold=0.1):
    """Lines that tell what changed.

    Parameters
    ----------
    before, after : dict
        As `load` gives them.
    threshold : float
        Relative change that is pointed out: "better", or "WORSE" (more of a cost, or less of what should be at least so much).

    Returns
    -------
    list of str
    """
    old, new = ({figure["name"]: figure for figure in content["figures"]} for content in (before, after))
    said = _machines(before, after) + [f"{'figure':<{_NAME}} {'before':>10} {'after':>10} {'unit':<8} {'ratio':>6}"]
    for name in (name for name in new if name in old):
        one, two = old[name]["value"], new[name]["value"]
        ratio = two / one if one else float("nan")
        said.append(f"{name:<{_NAME}} {one:>10.4g} {two:>10.4g} {new[name]['unit']:<8} {ratio:>6.2f}  {_word(new[name], ratio, threshold)}".rstrip())
    said += [f"{name:<{_NAME}} only before" for name in old if name not in new]
    return said + [f"{name:<{_NAME}} only after" for name in new if name not in old]


def _word(figure, ratio, threshold):
    """A figure without a limit in "-" (a count, a ratio) is neither better nor worse."""
    if not abs(ratio - 1.0) > threshold or (figure["limit"] is None and figure["unit"] == "-"):
        return ""
    return "better" if (ratio > 1.0) == figure["at_least"] else "WORSE"


def _machines(before, after):
    """What differs between the machines: times then say nothing about the code."""
    one, two = before.get("machine", {}), after.get("machine", {})
    differ = [key for key in ("processor", "cores", "python", "compiler", "packages") if one.get(key) != two.get(key)]
    said = [f"{key}: {_short(one.get(key), two.get(key))} before, {_short(two.get(key), one.get(key))} after" for key in differ]
    loads = [f"load of the machine at the start: {one.get('load', float('nan')):.1f} before, {two.get('load', float('nan')):.1f} after"]
    return said + loads + [""]


def _short(mine, other):
    """Of two dictionaries only what differs."""
    if not isinstance(mine, dict) or not isinstance(other, dict):
        return mine
    return ", ".join(f"{key} {value}" for key, value in mine.items() if other.get(key) != value) or "fewer packages"
