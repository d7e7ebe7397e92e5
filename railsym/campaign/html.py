# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of an HTML page that holds all it shows: numbers, tables, pictures as data."""

from __future__ import annotations

import base64
import io
import math
from html import escape
from pathlib import Path

from railsym.plots.units import short

_PARTS = Path(__file__).parent.parent / "data" / "report"
_DPI = 130


def number(value, digits=4):
    """A number as text; empty where there is none."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, (int,)) and not isinstance(value, bool):
        return f"{value:d}"
    return short(value, digits)


def mark(source):
    """Link to a source."""
    return f'<span class="mark"><a href="#{source.mark}" title="{escape(source.title)}">{source.mark}</a></span>'


def cell(value, css=""):
    """A cell of a table: numbers to the right, with their full value for sorting and on hovering."""
    if isinstance(value, Raw):
        return f'<td{_css(css)}>{value.text}</td>'
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        full = "" if isinstance(value, float) and math.isnan(value) else repr(float(value)) if isinstance(value, float) else str(value)
        return f'<td class="n" data-value="{full}" title="{full}">{number(value)}</td>'
    return f"<td{_css(css)}>{escape(str(value))}</td>"


def _css(css):
    return f' class="{css}"' if css else ""


class Raw:
    """HTML that is not to be escaped."""

    def __init__(self, text):
        self.text = text


def table(head, rows, *, sort=False, tall=False, css=()):
    """A table.

    Parameters
    ----------
    head : sequence of str
    rows : sequence of sequences of str, number or Raw
    sort : bool
        Columns can be sorted by a click.
    tall : bool
        It scrolls.
    css : sequence of str
        Classes of the columns' cells.
    """
    css = [*css, *[""] * (len(head) - len(css))]
    numeric = [bool(rows) and all(isinstance(row[k], (int, float)) and not isinstance(row[k], bool) for row in rows) for k in range(len(head))]
    heads = "".join(f'<th scope="col"{_css("n" if n else "")}>{h.text if isinstance(h, Raw) else escape(h)}</th>' for h, n in zip(head, numeric))
    body = "".join("<tr>" + "".join(cell(value, c) for value, c in zip(row, css)) + "</tr>\n" for row in rows)
    top = f"<thead><tr>{heads}</tr></thead>\n" if any(head) else ""
    return (f'<div class="scroll{" tall" if tall else ""}"><table{_css("sort" if sort else "")}>\n{top}'
            f"<tbody>\n{body}</tbody></table></div>\n")


def picture(axes, alt):
    """The figure that axes belong to as an image that stands in the page; closes it."""
    import matplotlib.pyplot as plt
    import numpy as np

    figure = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()[0].figure
    content = io.BytesIO()
    # no date and no version: the same results give the same bytes
    figure.savefig(content, format="png", dpi=_DPI, metadata={"Software": None})
    wide = figure.get_size_inches()[0] > 9.0
    plt.close(figure)
    data = base64.b64encode(content.getvalue()).decode()
    width, height = _size(content.getvalue())
    return f'<img src="data:image/png;base64,{data}" alt="{escape(alt)}" width="{width}" height="{height}">', wide


def _size(png):
    """Width and height from the head of a PNG."""
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


def page(title, body):
    """The whole page, with its style and script inside."""
    style, script = ((_PARTS / f"page.{kind}").read_text(encoding="utf-8") for kind in ("css", "js"))
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'<link rel="icon" href="data:,">\n<title>{escape(title)}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}</main>\n'
            f"<script>\n{script}</script>\n</body>\n</html>\n")
