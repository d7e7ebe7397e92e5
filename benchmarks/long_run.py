# SPDX-License-Identifier: BSD-3-Clause
"""A line of 20 km with random irregularities as one job: peak memory against its length, streamed to file and kept in memory."""

from __future__ import annotations

import tempfile
from pathlib import Path

from benchmarks.measure import Figure, cost_of_code

SPEED = 60.0       # m/s
SHORT, LONG = 2e3, 20e3
_SETUP = """
import railsym as rs
track = rs.Track.straight({length} + 50.0).with_irregularity("erri_b176_low", seed=1)
vehicle, table = rs.load_vehicle("pendolino"), rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table(deepest=6e-4)
"""
_RUN = _SETUP + """
run = rs.simulate(vehicle, speed={speed}, duration=({length} - 50.0) / {speed}, track=track, contact=table, rate={rate}, save={path!r}, keep={keep!r})
assert run.status == "completed", run.message
"""
_JUDGED = """
found = rs.criteria.derailment(run, sections=250.0)
assert len(found.statistics["Q wheelset1.left"].values) > {length} / 250.0 - 3
"""


def long_run_figures():
    """Processes of their own; the Pendolino on its contact table, FASTSIM, 1 ms, 46 channels at 200 Hz and at 1 kHz."""
    with tempfile.TemporaryDirectory() as folder:
        yield from _growth(folder)


def _growth(folder):
    def cost(code, length, keep="file", rate=200.0):
        return cost_of_code(code.format(length=length, speed=SPEED, rate=rate, path=str(Path(folder) / "run.nc"), keep=keep))

    made = [cost(_SETUP, length)[1] for length in (SHORT, LONG)]
    yield Figure("making 20 km of irregularity, over 2 km", made[1] - made[0], "MB", None, f"peak of the process {made[1]:.0f} MB, contact table included")
    short, (time, long) = cost(_RUN, SHORT)[1], cost(_RUN, LONG)
    yield Figure("a run of 20 km streamed, over one of 2 km", long - short, "MB", 10.0,
                 f"peaks {short:.0f} and {long:.0f} MB, 46 channels at 200 Hz; {time:.0f} s of CPU for {LONG / SPEED:.0f} s")
    short, long = cost(_RUN, SHORT, rate=1000.0)[1], cost(_RUN, LONG, rate=1000.0)[1]
    yield Figure("the same at 1 kHz", long - short, "MB", 10.0, f"peaks {short:.0f} and {long:.0f} MB, 125 MB of file")
    judged = cost(_RUN + _JUDGED, LONG)[1]
    yield Figure("the same with Y/Q, sum of Y, Q in sections of 250 m", judged, "MB", None, "whole process, 20 km at 200 Hz, a wheelset at a time")
    kept = cost(_RUN, LONG, keep="memory", rate=1000.0)[1]
    yield Figure("20 km at 1 kHz kept in memory", kept, "MB", None, "for comparison")
