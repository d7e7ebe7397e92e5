# SPDX-License-Identifier: BSD-3-Clause
"""A run in a few lines: largest forces and accelerations, running stability, how it ended."""

from __future__ import annotations

import numpy as np

from railsym.cli_output import table
from railsym.criteria import CriterionError, derailment, instability
from railsym.results.errors import ResultError

_KINDS = (("Y/Q", "largest Y/Q, 2 m mean, 99.85 %"), ("sum Y", "largest sum of Y, 2 m mean, 99.85 %"), ("Q", "largest Q, 20 Hz, 99.85 %"))
_ACCELERATIONS = (("car*.ay", "car body, lateral"), ("car*.az", "car body, vertical"), ("*.above_*.ay", "bogie frame above an axlebox, lateral"))
_PLACES = (("wheelset*.y", "shift of a wheelset"),)


def run_table(run):
    """Text: a line a quantity with its value, unit, where and when."""
    rows = [[what, f"{value:.3f}" if unit == "-" else f"{value:.2f}", unit.replace("-", ""), where, "" if time is None else f"{time:.2f}"]
            for what, value, unit, where, time in _shown(run)]
    parts = [table(["quantity", "value", "unit", "where", "t, s"], rows, left=(0, 2, 3))] if rows else []
    return "\n".join([*parts, *_verdicts(run), f"the run: {run.message}"])


def _shown(run):
    """(what, value, unit, where, time or None), in the units that are shown."""
    for what, value, unit, where, time in quantities(run):
        factor, shown = {"N": (1e-3, "kN"), "m": (1e3, "mm")}.get(unit, (1.0, unit))
        yield what, factor * value, shown, where, time


def quantities(run):
    """(what, value in SI, unit, where, time in s or None) of a run.

    Forces are filtered and averaged as EN 14363 has it (percentiles 99.85); accelerations are the largest sample.
    """
    try:
        found = derailment(run) if run.channels.match("*.Q") else None
    except (CriterionError, ResultError):
        found = None                     # too short or sampled too slowly
    if found is not None:
        for kind, words in _KINDS:
            worst = found.worst(kind)
            yield words, float(worst.value), worst.unit, worst.name.rpartition(" ")[2], None
    for pattern, words in (*_ACCELERATIONS, *_PLACES):
        names = run.channels.match(pattern)
        if names:
            name = max(names, key=lambda n: np.abs(run[n]).max())
            at = int(np.argmax(np.abs(run[name])))
            yield f"largest {words}", float(abs(run[name][at])), run.unit(name), name, float(run.time[at])


def _verdicts(run):
    """Running stability in a line, or why there is none."""
    found = _stability(run)
    if found is not None:
        yield f"running stability: {found[1]}"


def _stability(run):
    """Whether it is unstable (None: no verdict) and that in words; None without the channels."""
    if not run.channels.match("*.above_*.ay"):
        return None
    try:
        found = instability(run)
    except (CriterionError, ResultError) as error:
        return None, f"no verdict ({error})"
    if run.status != "completed" and not found.unstable:
        return None, f"no verdict, because the run stopped; until then {found.message}"
    return found.unstable, found.message


def as_data(run):
    """Plain data for JSON, SI units."""
    stable, info = _stability(run), run.info
    return {"vehicle": info.vehicle, "configuration": info.configuration, "track": info.track, "speed": info.speed, "step": info.time_step,
            "creep_law": info.creep_law, "status": run.status, "message": run.message, "duration": float(run.time[-1]),
            "quantities": [{"what": what, "value": value, "unit": unit, "where": where, "time": time} for what, value, unit, where, time in quantities(run)],
            "running_stability": stable and dict(zip(("unstable", "message"), stable))}
