# SPDX-License-Identifier: BSD-3-Clause
"""Energy method for curves: where the elongation of a Maxwell damper goes.

F = D(w) and e = s + j(|v|) F with w = ds/dt and j = 1/k. With R the inverse of D, a cycle of each test obeys

    e = j(|v|) F + int R(F) dt

The first part is stored and comes back, the second is where the energy goes. Both are linear in j (hat functions of |v|) and in
the slopes of R between levels of force, none of which is negative: one least-squares problem with one minimum, for each lag of the
force. The lag, which only tests of different frequency tell, is where its misfit is least. Levels of force resolve the smallest
test as well as the largest, and a steep beginning (friction) or a flat end (blow-off) of D as well as its middle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from railsym.dampers.energy import LARGEST_LAG, hats, integral, shared

_LEVELS = 18         # of force, over half of the curve
_SMALLEST = 0.3      # of the peak force of the smallest test: the lowest levels
_RIDGE = 1e-12       # of the normal equations, against columns that no test tells apart
_SOFT = 0.1          # standard deviation of the relative change of slope from level to level
_PARTS = 62          # independent errors in a cycle: real and imaginary parts of 31 harmonics
_LAG_LEVELS = 18     # with 12 the lag is three times as far off
_GRID = 11           # lags of the first look


@dataclass(frozen=True, eq=False)
class Elongation:
    """Result of `split_elongation`.

    Attributes
    ----------
    compliance : ndarray (nodes,)
        j at the nodes of speed, m/N; one value for a constant.
    force, speed : ndarray (levels,)
        Points (N, m/s) of the damper's own curve; from 0 for a symmetric one.
    misfit : float
        Root mean square of what is left of the elongation, relative to that of each test.
    """

    compliance: np.ndarray
    force: np.ndarray
    speed: np.ndarray
    misfit: float


def _level_force(loops, symmetric):
    """Force (tests, points): of a symmetric damper without its mean, which is then an offset."""
    return loops.force if symmetric else loops.force + loops.mean[:, None]


def force_levels(loops, symmetric, count=_LEVELS):
    """Levels (N) that share the range of the largest test, and the logarithm of the ranges of all."""
    force = _level_force(loops, symmetric)
    peak = np.abs(force).max(axis=1)
    half = shared(_SMALLEST * peak.min() / peak.max(), count)
    if symmetric:
        return peak.max() * half
    return np.concatenate([force.min() * half[:0:-1], force.max() * half])


def finer_levels(loops, found, symmetric, count=_LEVELS + 6):
    """Levels that share the damper's speed as well: more of them where a small force makes much speed, as in a blow-off valve."""
    low = _SMALLEST * np.abs(loops.force).max(axis=1).min()
    force = _level_force(loops, symmetric)

    def half(at, speed, end):
        return end * shared(low / end, count, lambda x: np.interp(x * end, at, speed), (0.7, 1.0, 1.0))

    up = found.force >= 0.0
    above = half(found.force[up], found.speed[up], found.force[-1] if symmetric else force.max())
    if symmetric:
        return above
    down = found.force <= 0.0
    return np.concatenate([-half(-found.force[down][::-1], -found.speed[down][::-1], -force.min())[:0:-1], above])


def split_elongation(loops, speed_nodes=None, symmetric=True, levels=None, before=None):
    """Compliance and damper curve of loops without lag.

    Parameters
    ----------
    loops : Loops
    speed_nodes : ndarray, optional
        m/s, of the compliance; a constant one without.
    symmetric : bool
        Whether the damper's curve is odd.
    levels : ndarray, optional
        N; by `force_levels` without.
    before : Elongation, optional
        Of an earlier pass: its slopes and its misfit scale a weak wish for a smooth R, which decides where noise would.

    Returns
    -------
    Elongation
    """
    from scipy.optimize import nnls

    levels = force_levels(loops, symmetric) if levels is None else levels
    weight = 1.0 / np.sqrt(np.mean(loops.displacement**2, axis=1))[:, None]
    force = _level_force(loops, symmetric)
    spring = force[None] if speed_nodes is None else hats(np.abs(loops.velocity), speed_nodes) * force
    columns = np.concatenate([spring - spring.mean(axis=2, keepdims=True), integral(_rises(force, levels), loops.period)])
    table = (columns * weight).reshape(len(columns), -1)
    wanted = (loops.displacement * weight).ravel()
    size = np.sqrt(np.sum(table**2, axis=1)) + 1e-300
    table = table / size[:, None]
    wish = np.zeros((0, len(table))) if before is None else _smooth(before, levels, len(spring), len(wanted), len(loops.angular)) / size
    root = np.linalg.cholesky(table @ table.T + wish.T @ wish + _RIDGE * len(wanted) / len(table) * np.eye(len(table))).T
    found = nnls(root, np.linalg.solve(root.T, table @ wanted))[0]
    misfit = float(np.sqrt(np.mean((found @ table - wanted) ** 2)))
    slopes = (found / size)[len(spring):]
    speed = np.concatenate([[0.0], np.cumsum(slopes * np.diff(levels))])
    return Elongation((found / size)[:len(spring)], levels, speed - speed[int(np.argmin(np.abs(levels)))], misfit)


def _smooth(before, levels, first, points, tests):
    """Rows of the wish for slopes of R that change little from level to level."""
    slope = np.maximum(np.diff(np.interp(levels, before.force, before.speed)) / np.diff(levels), 1e-3 * np.ptp(before.speed) / np.ptp(before.force))
    inside = np.flatnonzero(np.abs(levels[1:-1]) > 0.0)     # an asymmetric curve may have a corner at rest
    rows = np.zeros((len(inside), first + len(slope)))
    weight = before.misfit * np.sqrt(points / (_PARTS * tests)) / _SOFT / (slope[inside] + slope[inside + 1])
    rows[np.arange(len(inside)), first + inside] = -weight
    rows[np.arange(len(inside)), first + inside + 1] = weight
    return rows


def refined_elongation(loops, speed_nodes=None, symmetric=True):
    """`split_elongation` in three passes, each with levels after the curve of the one before."""
    found = best = split_elongation(loops, speed_nodes, symmetric)
    for k in range(2 if symmetric else 4):
        if not symmetric:
            loops = replace(loops, mean=_mean_force(loops, found))
        found = split_elongation(loops, speed_nodes, symmetric, finer_levels(loops, found, symmetric), found)
        # where the mean forces do not settle, the pass that leaves least counts
        best = found if symmetric or k == 0 or found.misfit < best.misfit else best
    return best


def _mean_force(loops, found):
    """Mean force (tests,) with which the damper itself comes back after a cycle: oint R(F + mean) dt = 0, by bisection."""
    low, high = (np.full(len(loops.mean), end) for end in (found.force[0], found.force[-1]))
    for _ in range(40):
        middle = 0.5 * (low + high)
        force = loops.force + middle[:, None]
        speed = np.interp(force, found.force, found.speed)
        for end, beyond in ((0, np.minimum(force - found.force[0], 0.0)), (-1, np.maximum(force - found.force[-1], 0.0))):
            speed += beyond * (found.speed[end] - found.speed[0 if end else -1]) / (found.force[end] - found.force[0 if end else -1])
        forward = speed.mean(axis=1) > 0.0
        low, high = np.where(forward, low, middle), np.where(forward, middle, high)
    return 0.5 * (low + high)


def _rises(force, levels):
    """What of the force lies between two levels, (levels - 1, tests, points); of an odd curve on either side."""
    low, high = levels[:-1, None, None], levels[1:, None, None]
    if levels[0] == 0.0:
        return np.sign(force) * (np.clip(np.abs(force), low, high) - low)
    start = np.where(high <= 0.0, high, low)                # that end of the level which is nearer to 0
    return np.clip(force, low, high) - start


def lag_by_elongation(loops, speed_nodes=None, symmetric=True, levels=None):
    """Lag (s) of the force where the misfit of the elongation is least."""
    from scipy.optimize import minimize_scalar

    loops = loops.coarse()
    levels = force_levels(loops, symmetric, _LAG_LEVELS) if levels is None else levels

    def left(lag):
        return split_elongation(loops.shifted(lag), speed_nodes, symmetric, levels).misfit

    grid = np.linspace(-LARGEST_LAG, LARGEST_LAG, _GRID)
    k = int(np.argmin([left(lag) for lag in grid]))
    around = grid[max(k - 1, 0)], grid[min(k + 1, _GRID - 1)]
    return float(minimize_scalar(left, bounds=around, method="bounded", options={"xatol": 1e-5, "maxiter": 20}).x)
