# SPDX-License-Identifier: BSD-3-Clause
"""Creep forces: cost of a contact in batches of eight, and FASTSIM against the same algorithm in Numba."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from benchmarks.measure import Figure, median_time

_CONTACTS = 512           # the call from Python is spread over 64 batches of eight, all in the cache
_GRID = (20, 20)


def creep_figures():
    """One core; contacts from adhesion to full slip, Kalker's coefficients given."""
    from railsym import _core

    rows = sample(_CONTACTS)

    def cost(law, slopes):
        return 1e6 * median_time(lambda: _core.creep_forces(law, rows, _GRID, slopes), 41) / _CONTACTS

    figures = [Figure(f"creep forces: {law}{', with derivatives' if slopes else ''}", cost(law, slopes), "us", limit,
                      "a contact" + (", 20 x 20" if law in ("fastsim", "fastrip") else ""))
               for law, slopes, limit in (("kalker_linear", True, None), ("shen_hedrick_elkins", True, None),
                                          ("polach", True, 0.05), ("fastsim", False, 0.5), ("fastsim", True, None),
                                          ("fastrip", False, None), ("fastrip", True, None),
                                          ("exact", False, None), ("exact", True, 0.15))]
    return figures + _against_numba(rows, figures[3].value)


def sample(count, seed=1):
    """Inputs of rs_creep_forces, shape (15, count)."""
    from railsym.kalker import kalker_coefficients

    rng = np.random.default_rng(seed)
    size = 10 ** rng.uniform(-4.0, -2.0, count)
    creepages = size * rng.uniform(-1, 1, (3, count)) * [[1.0], [1.0], [150.0]]
    a, b = rng.uniform(3e-3, 8e-3, (2, count))
    ones = np.ones(count)
    return np.array([*creepages, a, b, rng.uniform(3e4, 1e5, count), 0.3 * ones, 8.2e10 * ones, ones,
                     *kalker_coefficients(a / b, 0.28), ones, ones])


def _against_numba(rows, ours):
    """The peer, where Numba is installed."""
    try:
        import numba
    except ImportError:
        return []
    from railsym import _core

    peer = numba.njit(fastsim_peer)
    found, same = peer(rows, *_GRID), _core.creep_forces("fastsim", rows, _GRID, False)[0]
    if not np.allclose(found, same, rtol=1e-9, atol=1e-9 * np.abs(same).max()):
        raise RuntimeError("the Numba peer computes something else")
    theirs = 1e6 * median_time(lambda: peer(rows, *_GRID), 21) / _CONTACTS
    return [Figure("FASTSIM in Numba, same algorithm", theirs, "us", None, f"a contact, 20 x 20, numba {numba.__version__}"),
            Figure("ratio", theirs / ours, "-", 5.0, "Numba over railsym", at_least=True)]


def fastsim_peer(rows, strips, cells):
    """FASTSIM of csrc/creep/fastsim.c, contact by contact, in scalars; forces (3, contacts)."""
    forces = np.zeros((3, rows.shape[1]))
    for n in range(rows.shape[1]):
        xi, eta, phi, a, b, load, friction, shear, weight, c11, c22, c23 = rows[:12, n]
        stiffness, limit, root = weight * shear * a * b, friction * load, sqrt(a / b)
        cx, cy = 3 * pi / 16 * stiffness * c11 * xi / limit, 3 * pi / 16 * stiffness * c22 * eta / limit
        sy = 2 * stiffness * sqrt(a * b) * c23 * phi / limit
        sx = sy / (root * root)
        dt, dY = 2.0 / cells, 2.0 / strips
        Fx = Fy = Mz = 0.0
        for j in range(strips):
            Y = -1 + (j + 0.5) * dY
            L = sqrt(1 - Y * Y)
            step_x, step_y = (cx - sx * Y) * dt / L, cy * dt / L
            px, py, sum_x, sum_y, sum_ty = 0.5 * step_x, 0.5 * step_y, 0.0, 0.0, 0.0
            for i in range(cells):
                t = 1 - (i + 0.5) * dt
                px -= step_x
                py -= step_y + sy * (dt * (t + 0.5 * dt) if i else 0.5 * dt * (1 - 0.25 * dt))
                bound, square = 1 - t * t, px * px + py * py
                if square > bound * bound:
                    shorter = bound / sqrt(square)
                    px *= shorter
                    py *= shorter
                sum_x += px
                sum_y += py
                sum_ty += t * py
            part = 2 / pi * L**3 * dt * dY
            Fx += part * sum_x
            Fy += part * sum_y
            Mz += part * (L * root * sum_ty - Y / root * sum_x)
        forces[0, n], forces[1, n], forces[2, n] = limit * Fx, limit * Fy, limit * sqrt(a * b) * Mz
    return forces
