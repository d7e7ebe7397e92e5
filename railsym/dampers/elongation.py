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

from railsym.dampers.energy import LARGEST_LAG, hats, shared

_LEVELS = 18         # of force, over half of the curve
_SMALLEST = 0.3      # of the peak force of the smallest test: the lowest levels
_ORDERS = 63         # harmonics of the elongation
_RIDGE = 3e-11       # of the normal equations, against columns that no test tells apart
_SOFT = 0.1          # standard deviation of the relative change of slope from level to level
_PARTS = 62          # independent errors in a cycle: real and imaginary parts of 31 harmonics
_LAG_LEVELS = 18     # with 12 the lag is three times as far off
_ROUGH_LEVELS = 10   # for that first look
_PASSES = 8          # of an asymmetric damper, whose mean forces settle on the way
_STRIDE = 0.1        # of the peak force: the largest change of a mean force in a pass
_SETTLED = 0.01      # of the peak force: a change of a mean force in the last pass that no longer counts
_TURNS = 6           # of lag and mean forces
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
    shift : ndarray (tests,) or None
        N, by which the mean force of each test should change (asymmetric dampers, from the second pass).
    """

    compliance: np.ndarray
    force: np.ndarray
    speed: np.ndarray
    misfit: float
    shift: np.ndarray | None = None


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


def split_elongation(loops, speed_nodes=None, symmetric=True, levels=None, before=None, basis=None):
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
    basis : ndarray (nodes, tests, points), optional
        Hat functions of ``speed_nodes``, if they are at hand.

    Returns
    -------
    Elongation
    """
    from scipy.optimize import nnls

    levels = force_levels(loops, symmetric) if levels is None else levels
    force = _level_force(loops, symmetric)
    if basis is None and speed_nodes is not None:
        basis = hats(np.abs(loops.velocity), speed_nodes)
    spring = force[None] if basis is None else basis * force
    rises = _rises(force, levels)
    table, wanted = _table(loops, spring, rises)
    free = before is not None and not symmetric
    if free:
        table, wanted, most = _with_means(loops, table, wanted, rises, force, before)
    size = np.sqrt(np.einsum("ij,ij->i", table, table)) + 1e-300
    table /= size[:, None]
    normal = table @ table.T
    normal.flat[::len(table) + 1] += _RIDGE
    if before is not None:
        wish = _smooth(before, levels, len(spring), len(table)) / size
        normal += wish.T @ wish
    root = np.linalg.cholesky(normal).T
    found = nnls(root, np.linalg.solve(root.T, table @ wanted))[0]
    left = found @ table - wanted
    slopes = (found / size)[len(spring):len(spring) + len(levels) - 1]
    speed = np.concatenate([[0.0], np.cumsum(slopes * np.diff(levels))])
    shift = (found / size)[-len(most):] - most if free else None
    return Elongation((found / size)[:len(spring)], levels, speed - speed[int(np.argmin(np.abs(levels)))],
                      float(np.sqrt(left @ left / len(loops.angular))), shift)


def _with_means(loops, table, wanted, rises, force, before):
    """The problem with a change of each test's mean force as further unknowns, and with the rows that bring the damper back.

    R(F + m) changes with m as R', which an earlier pass tells; its mean over a cycle is 0, or the damper would creep. Unknown is the
    change above the lowest one allowed, ``most`` (tests,) below the present mean.
    """
    tests, points = force.shape
    piece = np.clip(np.searchsorted(before.force, force) - 1, 0, len(before.force) - 2)
    fluidity = (np.diff(before.speed) / np.diff(before.force))[piece]
    changes = np.zeros((tests, tests, points))
    changes[np.arange(tests), np.arange(tests)] = fluidity
    moved, _ = _table(loops, np.zeros((0, tests, points)), changes)
    creep = 1.0 / (loops.angular * np.sqrt(np.mean(loops.displacement**2, axis=1)))
    rows = np.zeros((len(table) + tests, tests))
    rows[len(table) - len(rises):len(table)] = rises.mean(axis=2) * creep
    rows[len(table):] = np.diag(fluidity.mean(axis=1) * creep)
    most = _STRIDE * np.abs(loops.force).max(axis=1)
    table = np.hstack([np.vstack([table, moved]), rows])
    return table, np.concatenate([wanted, np.zeros(tests)]) + most @ table[-tests:], most


def _table(loops, spring, rises):
    """Harmonics of the elongations that unknowns of 1 make, (unknowns, 2 tests orders), and of the displacement, relative to its r.m.s. value.

    Real and imaginary parts, so that sums of squares are sums of mean squares over the tests.
    """
    count = loops.force.shape[1]
    orders = 1 + np.arange(min(count // 2 - 1, _ORDERS))
    spectra = np.fft.rfft(np.concatenate([spring, rises, loops.displacement[None]]), axis=2)[:, :, orders]
    spectra[len(spring):-1] /= 1j * orders * loops.angular[:, None]
    spectra *= (np.sqrt(2.0) / count / np.sqrt(np.mean(loops.displacement**2, axis=1)))[:, None]
    flat = spectra.reshape(len(spectra), -1).view(float)
    return flat[:-1], flat[-1]


def _smooth(before, levels, first, columns):
    """Rows of the wish for slopes of R that change little from level to level."""
    slope = np.maximum(np.diff(np.interp(levels, before.force, before.speed)) / np.diff(levels), 1e-3 * np.ptp(before.speed) / np.ptp(before.force))
    inside = np.flatnonzero(np.abs(levels[1:-1]) > 0.0)     # an asymmetric curve may have a corner at rest
    rows = np.zeros((len(inside), columns))
    weight = before.misfit / np.sqrt(_PARTS) / _SOFT / (slope[inside] + slope[inside + 1])
    rows[np.arange(len(inside)), first + inside] = -weight
    rows[np.arange(len(inside)), first + inside + 1] = weight
    return rows


def refined_elongation(loops, speed_nodes=None, symmetric=True):
    """`split_elongation` in three passes, each with levels after the curve of the one before."""
    found = best = split_elongation(loops, speed_nodes, symmetric)
    if not symmetric:
        loops = replace(loops, mean=_mean_force(loops, found))
    for k in range(2 if symmetric else _PASSES):
        found = split_elongation(loops, speed_nodes, symmetric, finer_levels(loops, found, symmetric), found)
        # where the mean forces do not settle, the pass that leaves least counts
        best = found if symmetric or k == 0 or found.misfit < best.misfit else best
        if not symmetric:
            loops = replace(loops, mean=loops.mean + found.shift)
    settled = symmetric or (np.abs(found.shift) < _SETTLED * np.abs(loops.force).max(axis=1)).all()
    return found if settled else best


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
    """Lag (s) of the force where the misfit of the elongation is least; of an asymmetric damper with its mean forces, in turns."""
    lag = _searched_lag(loops, speed_nodes, symmetric, levels)
    for _ in range(0 if symmetric else _TURNS):
        found = refined_elongation(loops.coarse().shifted(lag), speed_nodes, False)
        loops = replace(loops, mean=_mean_force(loops.coarse().shifted(lag), found))
        before, lag = lag, _searched_lag(loops, speed_nodes, False, levels)
        if abs(lag - before) < 2e-5:
            break
    return lag


def _searched_lag(loops, speed_nodes, symmetric, levels):
    from scipy.optimize import minimize_scalar

    def left(loops, levels, basis, lag):
        return split_elongation(loops.shifted(lag), speed_nodes, symmetric, levels, None, basis).misfit

    def prepared(points, count):
        some = loops.coarse(max(1, loops.force.shape[1] // points))
        basis = None if speed_nodes is None else hats(np.abs(some.velocity), speed_nodes)
        return some, force_levels(loops, symmetric, count) if levels is None else levels, basis

    grid = np.linspace(-LARGEST_LAG, LARGEST_LAG, _GRID)
    rough, fine = prepared(32, _ROUGH_LEVELS), prepared(64, _LAG_LEVELS)
    k = int(np.argmin([left(*rough, lag) for lag in grid]))
    around = grid[max(k - 1, 0)], grid[min(k + 1, _GRID - 1)]
    return float(minimize_scalar(lambda lag: left(*fine, lag), bounds=around, method="bounded", options={"xatol": 2e-5, "maxiter": 20}).x)
