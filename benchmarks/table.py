# SPDX-License-Identifier: BSD-3-Clause
"""Figures as lines of a table."""

from __future__ import annotations

import textwrap

_NAME, _WIDTH = 56, 150


def head():
    """Head of the table of figures."""
    return f"{'figure':<{_NAME}} {'value':>10} {'unit':<8} {'asked for':<16} met  how"


def row(figure):
    """One line of the table."""
    limit = "" if figure.limit is None else f"{'at least' if figure.at_least else 'at most'} {figure.limit:g}"
    met = "" if figure.limit is None else "yes" if is_met(figure) else "NO"
    first = f"{figure.name:<{_NAME}} {figure.value:>10.4g} {figure.unit:<8} {limit:<16} {met:<4} "
    return textwrap.fill(first + figure.note, _WIDTH, subsequent_indent=" " * len(first), drop_whitespace=True, break_long_words=False).rstrip()


def is_met(figure):
    """Whether a figure keeps its limit; one without a limit does."""
    if figure.limit is None:
        return True
    return figure.value >= figure.limit if figure.at_least else figure.value <= figure.limit


def summary(figures, failed):
    """Last lines: how many figures keep their limits, which do not, and which groups could not be measured."""
    limited = [figure for figure in figures if figure.limit is not None]
    missed = [figure.name for figure in limited if not is_met(figure)]
    said = [f"{len(figures)} figures; {len(limited) - len(missed)} of {len(limited)} limits kept"]
    said += [f"not kept: {name}" for name in missed] + [f"not measured: {name}: {error}" for name, error in failed.items()]
    return said
