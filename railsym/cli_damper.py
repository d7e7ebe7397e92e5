# SPDX-License-Identifier: BSD-3-Clause
"""``railsym damper``: damper models from bench records as a table, a picture, vehicle-file lines, JSON."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

from railsym.cli_output import check_plot_path, deliver, save_plot, table
from railsym.cli_values import CommandError

MODELS = ("viscous", "maxwell", "maxwell_nonlinear")
_CHANNELS = ("time", "displacement", "force", "velocity")


def add_damper(commands):
    """Add the parser of the command."""
    command = commands.add_parser(
        "damper", help="identify a damper model from bench records",
        description="Fit viscous and Maxwell models to sinusoidal bench tests, compare them test by test, and write the chosen one as "
                    "lines of a vehicle file.")
    command.add_argument("records", nargs="*", metavar="RECORDS",
                         help="CSV or MAT files, one test each, or directories of them (default: the synthetic records that come along)")
    command.add_argument("--model", choices=MODELS, default="maxwell", help="model that is written (default maxwell); all are compared")
    command.add_argument("--method", choices=("energy", "least_squares"), default="least_squares", help="energy: the quick one (default least_squares)")
    command.add_argument("--units", nargs="+", type=_pair, default=[], metavar="CHANNEL=UNIT", help="where headings say none: displacement=mm force=kN")
    command.add_argument("--columns", nargs="+", type=_pair, default=[], metavar="CHANNEL=HEADING", help="where headings are unusual: force=F_load")
    command.add_argument("--compression-positive", action="store_true", help="the bench records compression as a positive force")
    command.add_argument("--write", metavar="FILE", help="write the model as TOML of a vehicle file")
    command.add_argument("--name", default="anti_yaw_damper", metavar="NAME", help="group of elements in that file (default anti_yaw_damper)")
    command.add_argument("--vehicle", metavar="VEHICLE", help="also show the critical speed of this vehicle with each model in the group --name")
    command.add_argument("--plot", metavar="FILE", help="draw force and stiffness over speed, and two loops: png, pdf, svg, ...")
    command.add_argument("--map", metavar="FILE", help="draw dynamic stiffness and phase of the chosen model over frequency and amplitude")
    command.add_argument("--json", nargs="?", const="-", metavar="FILE", help="as JSON, to FILE or standard output")
    return command


def _pair(text):
    channel, equals, value = text.partition("=")
    if not equals or not value or channel not in _CHANNELS:
        raise argparse.ArgumentTypeError(f"{text!r}: write channel=..., with a channel of {', '.join(_CHANNELS)}")
    return channel, value


def run(options):
    """Compute and show what the options of ``railsym damper`` ask for."""
    from railsym.dampers.fit import identify
    from railsym.dampers.toml_output import damper_toml
    from railsym.dampers.verdict import verdict

    check_plot_path(options.plot)
    check_plot_path(options.map)
    if options.write and not Path(options.write).resolve().parent.is_dir():
        raise CommandError(f"--write {options.write}: there is no directory {Path(options.write).resolve().parent}")
    records = _records(options)
    fits = {name: identify(records, model=name, method=options.method) for name in MODELS}
    found = verdict(fits, records)
    speeds = _critical_speeds(options, fits, found) if options.vehicle else None
    told = records, fits, found, options.model, speeds
    deliver(options, lambda: report(*told), lambda: as_data(*told), lambda: _drawn(fits, records))
    if options.map:
        from railsym.plots.damper_map import plot_damper_map

        save_plot(lambda: plot_damper_map(fits[options.model].model, records=records), options.map)
    if options.write:
        damper_toml(fits[options.model].model, options.write, options.name)


def _drawn(fits, records):
    from railsym.plots.dampers import plot_damper

    return plot_damper(fits, records)


def _records(options):
    """Cleaned tests; warnings as one line each on stderr."""
    from railsym.dampers.cleaning import clean_all
    from railsym.dampers.reading import read_records, shipped_records

    columns = {channel: int(name) if name.isdigit() else name for channel, name in options.columns}
    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always")
        records = clean_all(read_records(options.records or shipped_records(), units=dict(options.units), columns=columns,
                                         force_sign=-1 if options.compression_positive else 1))
    for one in raised:
        print(f"railsym: warning: {one.message}", file=sys.stderr)
    return records


def _critical_speeds(options, fits, found):
    from railsym.dampers.vehicle_table import critical_speeds

    return critical_speeds(options.vehicle, {name: fit.model for name, fit in fits.items()}, options.name)


def report(records, fits, found, chosen, speeds=None):
    """The tables as text."""
    first = records[0]
    lag = f"{1e3 * first.lag:.1f} ms, standard deviation {1e3 * first.lag_deviation:.1f} ms" if np.isfinite(first.lag_deviation) else "not told by these tests"
    lines = [f"{len(records)} tests; lag of the force channel, first estimate: {lag}", "",
             "loop error, % of the r.m.s. force (energy error, %)", _error_table(records, found), "", str(found), "",
             *(_parameters(name, fit) for name, fit in fits.items()), "", f"{chosen}: {fits[chosen].message}"]
    curve = fits[chosen].model.damping_curve
    if curve is not None:
        x, y = (curve.x, curve.y) if hasattr(curve, "x") else curve
        lines += ["", table(["speed, mm/s", "force, kN"], [[f"{1e3 * v:.2f}", f"{1e-3 * f:.3f}"] for v, f in zip(x, y)], left=())]
    if speeds is not None:
        lines += ["", *speeds.lines()]
    return "\n".join(lines)


def _error_table(records, found):
    rows = []
    for k, one in enumerate(records):
        errors = [f"{100 * found.loop_error[m, k]:.1f} ({100 * found.energy_error[m, k]:+.1f})" for m in range(len(found.models))]
        rows.append([one.name, f"{one.frequency:.3g}", f"{1e3 * one.amplitude:.3g}", str(one.cycles), *errors, found.enough[k]])
    total = [f"{1e3 * found.computing_time[m].sum():.1f} ms" for m in range(len(found.models))]
    return table(["test", "Hz", "mm", "cycles", *found.models, "enough"], [*rows, ["computing time", "", "", "", *total, ""]], left=(0, 4 + len(found.models)))


def _parameters(name, fit):
    """One line: the numbers of a fit with their 95 % intervals."""
    model, parts = fit.model, []
    if model.damping_curve is None:
        parts.append(f"damping {model.damping:.4g} N*s/m{_interval(fit, 'damping')}")
    else:
        parts.append("damping by its curve")
    if model.kind == "maxwell" and model.series_stiffness_curve is None:
        parts.append(f"series stiffness {model.series_stiffness:.4g} N/m{_interval(fit, 'series_stiffness')}")
    elif model.kind == "maxwell":
        x, y = (model.series_stiffness_curve.x, model.series_stiffness_curve.y) if hasattr(model.series_stiffness_curve, "x") else model.series_stiffness_curve
        parts.append(f"series stiffness {y[0]:.4g} N/m at rest, {y[-1]:.4g} N/m at {1e3 * x[-1]:.3g} mm/s")
    return f"{name}: {', '.join(parts)} ({fit.method}, {fit.seconds:.2f} s)"


def _interval(fit, name):
    given = (fit.confidence or {}).get(name)
    return f" ({given[0]:.4g} to {given[1]:.4g})" if given is not None and np.size(given) == 2 else ""


def as_data(records, fits, found, chosen, speeds=None):
    """Everything as plain data for JSON, SI units."""
    tests = [{"name": one.name, "frequency": one.frequency, "amplitude": one.amplitude, "cycles": one.cycles, "noise": one.noise,
              "force_offset": one.force_offset, "messages": list(one.messages), "enough": found.enough[k],
              "errors": {name: {"loop": float(found.loop_error[m, k]), "energy": float(found.energy_error[m, k]), "peak": float(found.peak_error[m, k])}
                         for m, name in enumerate(found.models)}} for k, one in enumerate(records)]
    return {"units": {"frequency": "Hz", "amplitude": "m", "noise": "N", "force_offset": "N", "lag": "s", "damping": "N*s/m", "series_stiffness": "N/m"},
            "lag": records[0].lag if np.isfinite(records[0].lag_deviation) else None, "chosen": chosen, "verdict": found.text, "tests": tests,
            "models": {name: _model_data(fit) for name, fit in fits.items()}, "critical_speed": None if speeds is None else speeds.as_data()}


def _model_data(fit):
    def numbers(value):
        if value is None or np.isscalar(value):
            return None if value is None else float(value)
        return [np.asarray(part, dtype=float).tolist() for part in ((value.x, value.y) if hasattr(value, "x") else value)]

    names = ("damping", "damping_curve", "series_stiffness", "series_stiffness_curve")
    return {"kind": fit.model.kind, "message": fit.message, "seconds": fit.seconds, **{name: numbers(getattr(fit.model, name)) for name in names}}
