# SPDX-License-Identifier: BSD-3-Clause
"""Coefficients of the table from solutions.

The table holds T(z(s)) of (csrc/creep/exact_table.c)

    q = -(r0/3) (s1, s2 + s3 C23/k) + |s|^2 (Tx, Ty)    (h0, h1) = q (3 - 3 |q| + |q|^2) for |q| < 1, else q/|q|
    h2 = r0 (1 - |s|) (s2 C23/C22 - s3 C33/k) + |s|^2 size Tm

fitted by least squares in q, weighted by dh/dq. Where a contact slips fully any |q| of 1 or more is right: such points
ask for the direction, and for the length only where the fit falls short of 1.
"""

from __future__ import annotations

import numpy as np

from derive.exact_contact.coordinates import RADIUS, constants, stretched

_SATURATED = 1.0 - 1e-4  # |F|/(mu N) from which a solution counts as full slip
_LEAST_WEIGHT = 0.05     # of the length of q
_BEYOND = 1.08           # least length asked for in full slip, with the weight _SLIP_WEIGHT: so that 1 is reached between the points
_SLIP_WEIGHT = 0.3
_ROUNDS = 6


def saturated(q):
    """Force (n, 2) of q."""
    size = np.linalg.norm(q, axis=1, keepdims=True)
    return q * np.where(size < 1, 3 - 3 * size + size * size, 1 / np.maximum(size, 1.0))


def basis(s, ratio, poisson):
    """Linear part of q and of h2 at s: (n, 2), (n,)."""
    c, spin = constants(ratio, poisson)
    rho = np.linalg.norm(s, axis=1)
    q = -RADIUS / 3 * np.stack([s[:, 0], s[:, 1] + s[:, 2] * c[2] / spin], axis=1)
    return q, RADIUS * (1 - rho) * (s[:, 1] * c[2] / c[1] - s[:, 2] * c[3] / spin)


def moment_size(ratio):
    """Arm of spin moments over sqrt(a b)."""
    return np.sqrt((ratio + 1 / ratio) / 2)


def evaluate(ball, full, s, ratio, poisson):
    """h (n, 3) of the table at points s of the half ball."""
    T = ball.values(full, stretched(s))
    q, moment = basis(s, ratio, poisson)
    square = np.sum(s * s, axis=1)
    force = saturated(q + square[:, None] * T[:, :2])
    return np.column_stack([force, moment + square * moment_size(ratio) * T[:, 2]])


def fitted(ball, s, forces, ratio, poisson, smoothing=1e-2):
    """All coefficients (*ball.shape, 3) at one a/b from forces (n, 3) at s (n, 3)."""
    q0, moment = basis(s, ratio, poisson)
    square, at = np.sum(s * s, axis=1), stretched(s)
    rough = smoothing * ball.roughness()
    free = np.empty((ball.size, 3))
    free[:, 2] = _least_squares(ball.design(at, 2).multiply(square[:, None]), (forces[:, 2] - moment) / moment_size(ratio), rough)
    free[:, :2] = _fitted_forces([ball.design(at, k).multiply(square[:, None]) for k in (0, 1)], q0, forces[:, :2], rough)
    n = ball.pieces + 1
    return ball.expand(free.reshape(n, ball.shape[1], n, 3))


def _fitted_forces(designs, q0, forces, rough):
    from scipy.sparse import block_diag, hstack, vstack

    size = np.linalg.norm(forces, axis=1)
    along = forces / np.maximum(size, 1e-30)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    slips = size > _SATURATED
    wanted = 1 - np.cbrt(1 - np.minimum(size, _SATURATED))
    wanted = np.where(slips, _BEYOND, wanted)
    w_along = np.where(slips, _SLIP_WEIGHT, np.maximum(3 * (1 - np.minimum(wanted, 1.0)) ** 2, _LEAST_WEIGHT))
    w_across = np.where(wanted < 1, 3 - 3 * wanted + wanted**2, 1.0)
    rows = [hstack([d.multiply((w * n[:, k])[:, None]) for k, d in enumerate(designs)])
            for n, w in ((along, w_along), (across, w_across))]
    matrix, both = vstack(rows).tocsr(), block_diag([rough, rough]).tocsr()
    solve, count = _factored(matrix, both), designs[0].shape[1]
    for _ in range(_ROUNDS):
        target = wanted[:, None] * along - q0
        right = np.concatenate([w_along * np.sum(along * target, 1), w_across * np.sum(across * target, 1)])
        free = solve(matrix.T @ right)
        q = q0 + np.stack([designs[0] @ free[:count], designs[1] @ free[count:]], axis=1)
        wanted = np.where(slips, np.maximum(_BEYOND, np.sum(q * along, axis=1)), wanted)
    return np.stack([free[:count], free[count:]], axis=1)


def _least_squares(matrix, right, rough):
    matrix = matrix.tocsr()
    return _factored(matrix, rough)(matrix.T @ right)


def _factored(matrix, rough):
    """Solver of the normal equations by conjugate gradients, warm from its last solution."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import cg

    normal = (matrix.T @ matrix + rough.T @ rough).tocsr()
    scale = diags(1.0 / normal.diagonal())
    last = [None]

    def solve(right):
        found, failed = cg(normal, right, x0=last[0], rtol=1e-6, maxiter=20000, M=scale)
        if failed:
            raise RuntimeError(f"least squares of the table: not solved after {failed} iterations")
        last[0] = found
        return found

    return solve
