# SPDX-License-Identifier: BSD-3-Clause
"""Tables, JSON and pictures of the command line."""

from __future__ import annotations

import json
import math
import os
import sys
from pathlib import Path

from railsym.cli_values import CommandError


def table(header, rows, left=(0,)):
    """Text table: the columns in ``left`` (by number) aligned left, the others right.

    Parameters
    ----------
    header : sequence of str
    rows : sequence of sequence of str

    Returns
    -------
    str
    """
    widths = [max(len(row[k]) for row in [header, *rows]) for k in range(len(header))]

    def line(cells):
        padded = (c.ljust(w) if k in left else c.rjust(w) for k, (c, w) in enumerate(zip(cells, widths)))
        return "  ".join(padded).rstrip()

    return "\n".join([line(header), "-" * len(line(["-" * w for w in widths])), *map(line, rows)])


def say(text=""):
    """Print a text; a reader that has left, as ``| head`` does, does not stop the run: its files are still written."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())  # what is still buffered goes there as well
        os.close(nowhere)


def write_json(content, target):
    """Write JSON to a file, or to standard output where ``target`` is "-".

    Raises
    ------
    CommandError
        If the file cannot be written.
    """
    text = json.dumps(content, indent=2, allow_nan=False)
    if target == "-":
        say(text)
        return
    try:
        Path(target).write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise CommandError(f"--json {target}: {error.strerror}") from None


def finite(value):
    """JSON has no infinity: the text "inf" stands for it."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def check_plot_path(path):
    """Refuse a picture that could not be saved, before anything is computed.

    Raises
    ------
    CommandError
        If the directory does not exist or Matplotlib does not know the format.
    """
    if path is None:
        return
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    formats = FigureCanvasAgg.get_supported_filetypes()
    if Path(path).suffix[1:].lower() not in formats:
        raise CommandError(f"--plot {path}: the name must end in one of {', '.join('.' + name for name in sorted(formats))}")
    if not Path(path).resolve().parent.is_dir():
        raise CommandError(f"--plot {path}: there is no directory {Path(path).resolve().parent}")


def save_plot(draw, path):
    """Save the picture that ``draw()`` makes (it returns axes) without opening a window."""
    import matplotlib

    matplotlib.use("Agg")
    from railsym.plots.style import save

    try:
        save(draw(), path)
    except OSError as error:
        raise CommandError(f"--plot {path}: {error.strerror}") from None


def deliver(options, text, data, draw):
    """Print a result, write its numbers and draw it, as ``--json`` and ``--plot`` ask; numbers on standard output take the place of the text.

    Parameters
    ----------
    options : argparse.Namespace
    text, data, draw : callable
        Give the text, the plain data, and axes.
    """
    if options.json != "-":
        say(text())
    if options.json:
        write_json(data(), options.json)
    if options.plot:
        save_plot(draw, options.plot)
