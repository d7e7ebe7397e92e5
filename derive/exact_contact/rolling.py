# SPDX-License-Identifier: BSD-3-Clause
"""Steady rolling with Coulomb's bound on given cells.

Find tractions p with |p| <= g on each cell and slip s = w + K p such that s = 0 or p = -g s/|s|. With P the projection
onto the discs |p| <= g, the solution is the fixed point of the Douglas-Rachford iteration

    p = P(z)    q = (I + gamma K)^-1 (2 p - z - gamma w)    z := z + q - p

(P.-L. Lions, B. Mercier, SIAM J. Numer. Anal. 16 (1979) 964-979). K is of order zero, a Hilbert transform along x, so
the number of iterations does not grow with the number of cells, and many contacts go through at once.
"""

from __future__ import annotations

import numpy as np

from derive.exact_contact.patch import patch

_GAMMA = 0.7
_AT_ONCE = 256
_CHECK_EACH = 4


class Rolling:
    """Solver for one `Patch`."""

    def __init__(self, cells):
        self.cells = cells
        n = len(cells.x)
        # single precision: 1e-6 of mu N against errors of discretisation of 1e-3
        self._resolvent = np.linalg.inv(np.eye(2 * n) + _GAMMA * cells.slip).astype(np.float32)
        self._rigid = (self._resolvent @ (_GAMMA * cells.rigid)).astype(np.float32)
        self._sums = cells.sums.astype(np.float32)
        self._bound = cells.bound.astype(np.float32)[:, None]

    def forces(self, creepages, tolerance=1e-4, most=2000):
        """Fx, Fy, Mz of steady rolling.

        Parameters
        ----------
        creepages : ndarray, shape (n, 3)
            e1, e2, e3.
        tolerance : float
            Last change of a traction, over the largest bound.
        most : int
            Iterations after which it gives up.

        Returns
        -------
        ndarray, shape (n, 3)

        Raises
        ------
        RuntimeError
            Where it does not converge.
        """
        parts = [self._some(creepages[k:k + _AT_ONCE], tolerance, most) for k in range(0, len(creepages), _AT_ONCE)]
        return np.concatenate(parts)

    def tractions(self, creepages, tolerance=1e-4, most=2000):
        """px, py interleaved, shape (2 cells, n); parameters and errors of `forces`."""
        rigid = self._rigid @ np.asarray(creepages, dtype=np.float32).T
        z, found = np.zeros_like(rigid), np.empty_like(rigid)
        left = np.arange(rigid.shape[1])
        active_rigid, active_z = rigid, z
        for iteration in range(most):
            p = self._projected(active_z)
            step = self._resolvent @ (2 * p - active_z) - active_rigid - p
            active_z = active_z + step
            if iteration % _CHECK_EACH == _CHECK_EACH - 1:
                # rounding of single precision where creepages are large
                going = np.abs(step).max(axis=0) > tolerance * self._bound.max() + 1e-6 * np.abs(active_z).max(axis=0)
                found[:, left[~going]] = p[:, ~going]
                left, active_z, active_rigid = left[going], active_z[:, going], active_rigid[:, going]
                if not left.size:
                    return found
        raise RuntimeError(f"rolling contact: {left.size} cases not solved to {tolerance:g} after {most} iterations, "
                           f"the first at e = {np.asarray(creepages)[left[0]]}")

    def _some(self, creepages, tolerance, most):
        return (self._sums @ self.tractions(creepages, tolerance, most)).T.astype(float)

    def _projected(self, z):
        both = z.reshape(len(self._bound), 2, -1)
        size = np.sqrt(both[:, 0] ** 2 + both[:, 1] ** 2)
        factor = np.minimum(1.0, self._bound / np.maximum(size, np.float32(1e-30)))
        return (both * factor[:, None]).reshape(z.shape)


def coarse_grid(ratio, cells):
    """Strips, cells of the coarser of two grids, the finer of which has about `cells` cells."""
    along = max(1.2, 1.5 * ratio**1.2)  # cells a strip over strips: see patch
    strips = max(4, round((cells / 4 / along) ** 0.5))
    return strips, round(strips * along)


class Extrapolated:
    """Forces on two grids, one of half the cell size, extrapolated to none: the error is of first order.

    Parameters
    ----------
    ratio : float
        a/b.
    cells : int
        About the number of cells of the finer grid.
    poisson : float
    """

    def __init__(self, ratio, cells=600, poisson=0.28):
        strips, along = coarse_grid(ratio, cells)
        self._grids = [Rolling(patch(ratio, n * strips, n * along, poisson)) for n in (1, 2)]

    def forces(self, creepages, tolerance=1e-4):
        """Fx, Fy, Mz (n, 3) of creepages e1, e2, e3 (n, 3)."""
        coarse, fine = (grid.forces(creepages, tolerance) for grid in self._grids)
        return 2 * fine - coarse


def full_slip(ratio, creepages, strips=200, cells=200):
    """Fx, Fy, Mz (n, 3) where creepage is so large that all slips: -int g w/|w|, midpoints in cosine grids."""
    angle, turn = (np.arange(strips) + 0.5) * np.pi / strips, (np.arange(cells) + 0.5) * np.pi / cells
    Y, t = np.cos(angle), np.cos(turn)
    a, b = np.sqrt(ratio), 1.0 / np.sqrt(ratio)
    x, y = (a * np.outer(t, np.sin(angle))).ravel(), np.tile(b * Y, cells)
    weight = np.outer(np.sin(turn) ** 2, np.sin(angle) ** 3).ravel()
    weight /= weight.sum()
    found = np.empty((len(creepages), 3))
    for k, (xi, eta, phi) in enumerate(creepages):
        sx, sy = xi - y * phi, eta + x * phi
        size = np.hypot(sx, sy) + 1e-300
        px, py = -weight * sx / size, -weight * sy / size
        found[k] = px.sum(), py.sum(), (x * py - y * px).sum()
    return found
