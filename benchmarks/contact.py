# SPDX-License-Identifier: BSD-3-Clause
"""Contact table of S1002 on UIC 60: building, memory, reading with slopes; reading beside SciPy's interpolator of the same nodes."""

from __future__ import annotations

import numpy as np

from benchmarks.measure import Figure, median_time

_PLACES = 512


def contact_figures():
    """One core; places of a wheel within 4 mm and 2 mrad, under 20 to 120 kN."""
    from railsym._core_contact import room
    from railsym.contact_pair import ContactPair
    from railsym.contact_table_build import build

    pair = ContactPair("S1002", "UIC60", inclination=1 / 40)
    pair.sides  # noqa: B018 surfaces and imports are made before
    table = build(pair, 2.1e11, 0.28, 3e-4, 15e-3)
    seconds = median_time(lambda: build(pair, 2.1e11, 0.28, 3e-4, 15e-3), 5)
    core, places, into = table.right.core, _places(table), room(_PLACES)
    read = 1e6 * median_time(lambda: core.lookup_into(places, *into), 201) / _PLACES
    peer = 1e6 * median_time(_peer(core, places), 11) / _PLACES
    conicity = median_time(lambda: ContactPair.equivalent_conicity(pair, 3e-3), 3), median_time(lambda: pair.equivalent_conicity(3e-3, load=6e4), 3)
    return [Figure("contact table S1002 on UIC 60: building", seconds, "s", 0.3),
            Figure("contact table: memory", table.nbytes / 1e6, "MB", 4.0),
            Figure("contact table: reading with 28 slopes", read, "us", 0.1, "a wheel, in batches of 512, arrays kept"),
            Figure("SciPy: reading the same nodes", peer, "us", None, "RegularGridInterpolator: linear, six quantities, no slopes"),
            Figure("ratio", peer / read, "-", None, "SciPy over railsym"),
            Figure("equivalent conicity at 3 mm, rigid", conicity[0], "s"), Figure("equivalent conicity at 3 mm, elastic", conicity[1], "s")]


def _places(table):
    rng = np.random.default_rng(1)
    y, roll = rng.uniform(-4e-3, 4e-3, _PLACES), rng.uniform(-2e-3, 2e-3, _PLACES)
    drop, _ = table.right.under_load(y, rng.uniform(2e4, 1.2e5, _PLACES), roll)
    return np.column_stack([y, roll, drop, rng.uniform(-5e-3, 5e-3, _PLACES)])


def _peer(core, places):
    from scipy.interpolate import RegularGridInterpolator

    start, step, count = core.axes[0]
    _, field = core.arrays(0)
    rolls = core.value("roll_start") + core.value("roll_step") * np.arange(core.value("rolls"))
    nodes = [start + step * np.arange(count), rolls, np.arange(core.value("levels"))]
    reader = RegularGridInterpolator(nodes, field[..., :6], method="linear")
    at = np.column_stack([places[:, 0] - core.value("wheel_radius") * places[:, 1], places[:, 1], np.full(len(places), 3.5)])
    return lambda: reader(at)
