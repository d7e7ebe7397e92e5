# SPDX-License-Identifier: BSD-3-Clause
"""``railsym study``: a study file with its uncertainty and optimisations, and the report of it."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from railsym.cli_output import check_plot_path, finite, save_plot, say, write_json
from railsym.cli_values import CommandError


def add_study(commands, typed, add_output):
    """Add the command to the parser."""
    command = commands.add_parser(
        "study", help="many runs of a vehicle: sweeps, uncertainty, optimisation, a report",
        description="Runs a study file: a vehicle, an analysis, factors and a plan, and what is made of the results. Results go to disk as they come; a "
                    "study that was stopped goes on with --resume.")
    command.add_argument("file", nargs="?", metavar="FILE", help="study file (TOML); --example writes one")
    command.add_argument("--example", action="store_true", help="write the demonstration study to FILE, or print it")
    command.add_argument("--workers", type=int, default=1, metavar="N", help="processes (default 1)")
    command.add_argument("--executor", metavar="WHERE", help="in place of --workers: mpi, or the address of a Dask scheduler such as tcp://host:8786")
    command.add_argument("--store", metavar="FILE", help="where results go (default: name of the study file with .nc, in this directory)")
    command.add_argument("--resume", action="store_true", help="go on with results that are there")
    command.add_argument("--report", metavar="FILE", help="write the report, one HTML page that holds all it shows")
    command.add_argument("--figures", metavar="DIRECTORY", help="save every picture of the report as PNG")
    add_output(command)
    return command


def run(options):
    """Run the study and show what it gave."""
    if options.example:
        return _example(options.file)
    if options.file is None:
        raise CommandError("study: FILE is missing: a study file, or --example FILE to write one")
    check_plot_path(options.plot)
    _check_targets(options)
    from railsym.campaign import load

    campaign = load(options.file)
    store = Path(options.store or Path(options.file).with_suffix(".nc").name)
    quiet = options.json == "-"
    try:
        found = campaign.run(store, workers=options.workers, executor=options.executor, resume=options.resume, progress=sys.stderr.isatty(),
                             say=lambda text: print(text, file=sys.stderr, flush=True))
    except KeyboardInterrupt:
        raise CommandError(f"interrupted; {_kept(campaign, store)}") from None
    if not quiet:
        say(str(found))
    _no_windows()
    if options.report:
        found.report(options.report)
    if options.figures:
        _save_figures(found, Path(options.figures))
    if options.plot:
        save_plot(found.plot, options.plot)
    if options.json:
        write_json(finite(found.as_data()), options.json)
    return None


def _example(path):
    from railsym.campaign import example

    if path is None:
        return say(example().rstrip())
    if Path(path).exists():
        raise CommandError(f"--example {path}: the file exists; name another one")
    try:
        Path(path).write_text(example(), encoding="utf-8")
    except OSError as error:
        raise CommandError(f"--example {path}: {error.strerror}") from None
    return say(f"wrote {path}; run it with: railsym study {path} --workers {os.cpu_count() or 1} --report {Path(path).with_suffix('.html')}")


def _check_targets(options):
    """What cannot be written is said before anything is computed."""
    for name, path in (("--store", options.store), ("--report", options.report)):
        if path is not None and not Path(path).resolve().parent.is_dir():
            raise CommandError(f"{name} {path}: there is no directory {Path(path).resolve().parent}")
        if path is not None and Path(path).is_dir():
            raise CommandError(f"{name} {path}: this is a directory; a file name is needed")
    if options.report and Path(options.report).suffix.lower() not in (".html", ".htm"):
        raise CommandError(f"--report {options.report}: the name must end in .html")
    if options.workers < 1:
        raise CommandError(f"--workers {options.workers}: at least one process is needed")
    if options.figures and Path(options.figures).is_file():
        raise CommandError(f"--figures {options.figures}: this is a file; a directory is needed")


def _kept(campaign, store):
    """What is on disk after an interrupt."""
    from railsym.errors import RailsymError
    from railsym.sweep import load

    parts = []
    for name, path in campaign.files(store).items():
        try:
            if path.suffix == ".nc":
                results = load(path)
                parts.append(f"{name} {int((results.status != 'missing').sum())} of {len(results)} cases")
            elif path.exists():
                parts.append(f"{name} {max(0, path.read_bytes().count(10) - 1)} cases")
        except RailsymError:
            continue
    kept = "kept are " + ", ".join(parts) if parts else "nothing was computed yet"
    return f"{kept}; --resume goes on from there"


def _no_windows():
    import matplotlib

    matplotlib.use("Agg")


def _save_figures(found, folder):
    from railsym.plots.style import save

    try:
        folder.mkdir(parents=True, exist_ok=True)
        for figure in found.figures():
            save(figure.draw(), folder / f"{figure.name}.png")
    except OSError as error:
        raise CommandError(f"--figures {folder}: {error.strerror}") from None
