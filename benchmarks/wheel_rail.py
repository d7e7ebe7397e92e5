# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces in motion: cost of one call for the eight wheels of a vehicle, over a contact table."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from benchmarks.measure import Figure

_CALLS, _RUNS = 20, 300  # calls a timing, so that the clock does not matter; timings, the least of which counts
_WHEELSETS, _SPEED, _RADIUS, _SPACING, _SLOPE, _RAIL_RADIUS = 4, 60.0, 0.46, 0.75, 0.1, 0.3


def wheel_rail_figures():
    """One core, called in C; rows alone, and rows with the pencil's blocks. The least time: a call shares the core with nothing."""
    from railsym.wheel_rail import WheelRail, WheelsetPlace

    table = table_of_a_cone()
    places = [WheelsetPlace(f"wheelset {k + 1}", 6 * k, (0.0, 0.0, -_RADIUS)) for k in range(_WHEELSETS)]
    figures = []
    for law, limits in (("polach", (None, None)), ("fastsim", (6.0, 20.0))):
        forces = WheelRail(places, table, law=law, wheel_loads=6e4)
        for blocks, limit in zip((False, True), limits):
            figures.append(Figure(f"wheel-rail forces: {law}{', with the pencil' if blocks else ''}", 1e6 * seconds(forces, blocks), "us", limit,
                                  f"{2 * _WHEELSETS} wheels, table" + (", 20 x 20" if law == "fastsim" else "")))
    return figures


def seconds(forces, blocks):
    """Time of one call of rs_wheel_rail_rows at a hunting vehicle's state."""
    from railsym._core import ffi, lib

    rng = np.random.default_rng(2)
    q, u = rng.normal(size=(2, _WHEELSETS, 6)) * [[[1e-3, 1e-3, 1e-6, 1e-3, 1e-6, 1.0]], [[0.02, 0.02, 1e-3, 0.02, 1e-3, 0.05]]]
    q[:, 4] -= _SLOPE * q[:, 1] / (_SPACING - _RADIUS * _SLOPE)
    u[:, 5] -= _SPEED / _RADIUS
    arrays = [np.ascontiguousarray(part).ravel() for part in (q, u, np.zeros((_WHEELSETS, 3)), np.zeros((_WHEELSETS, 8)), [1.0, 1e3],
                                                              np.empty((_WHEELSETS, 6)), np.empty((_WHEELSETS, 36)))]
    q, u, w, rail, seed, rows, block = (ffi.from_buffer("double[]", part) for part in arrays)
    block = block if blocks else ffi.NULL
    call, pointer = lib.rs_wheel_rail_rows, forces.pointer
    if call(pointer, q, u, _SPEED, w, rail, seed, rows, block) != lib.RS_OK:
        raise RuntimeError("the wheels of the benchmark left their table")

    least = np.inf
    for _ in range(_RUNS):
        start = perf_counter()
        for _ in range(_CALLS):
            call(pointer, q, u, _SPEED, w, rail, seed, rows, block)
        least = min(least, perf_counter() - start)
    return least / _CALLS


def table_of_a_cone(wave=0.0):
    """Contact table of a cone on a rail with a round head; ``wave`` (1/m): amplitude of a curvature of the cone, 60 mm long."""
    from railsym._core_contact import Surfaces, Table
    from railsym.contact_table import ContactTable, WheelTable
    from railsym.hertz import contact_modulus

    angle, step = np.arctan(_SLOPE), 2e-4
    centre = _SPACING + _RAIL_RADIUS * np.sin(angle)
    arc = np.arange(-0.03, 0.03, step) / _RAIL_RADIUS - angle
    rail = (step, centre + _RAIL_RADIUS * np.sin(arc), _RAIL_RADIUS * (np.cos(angle) - np.cos(arc)), np.cos(arc), np.sin(arc))
    across = _SPACING + np.arange(-0.05, 0.05, 5e-4)
    away = across - _SPACING
    k = 2.0 * np.pi / 0.06
    wheel = (across[0], 5e-4, _RADIUS - _SLOPE * away + wave / k**2 * np.sin(k * away), -_SLOPE + wave / k * np.cos(k * away))
    nodes = (-6e-3, 1e-3, 13, -4e-3, 1e-3, 9, 8, 1, 3e-4, _RADIUS, _SPACING)  # railsym._core_contact.SHAPE
    made = Table.built(Surfaces(rail, wheel, _RADIUS, _SPACING), nodes, (np.inf, -np.inf), (1,), contact_modulus(2.1e11, 0.28))
    return ContactTable(WheelTable("left", made), WheelTable("right", made), 2.0 * _SPACING, _RADIUS, _RADIUS)
