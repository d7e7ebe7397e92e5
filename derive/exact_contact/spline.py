# SPDX-License-Identifier: BSD-3-Clause
"""Quadratic B-splines on the half ball s1 >= 0, s3 >= 0, with the mirror images of creep forces built in.

N pieces a unit along each axis; the piece k of an axis with the place t in it takes the coefficients k, k + 1, k + 2
with the weights (1 - t)^2/2, 1/2 + t (1 - t), t^2/2. The coefficient before the plane s1 = 0 or s3 = 0 is the image of
the one behind it:

    s1 -> -s1           (Tx, Ty, Tm) -> (-Tx,  Ty,  Tm)
    (s2, s3) -> -both   (Tx, Ty, Tm) -> ( Tx, -Ty, -Tm)
"""

from __future__ import annotations

import numpy as np

_IMAGE_1 = np.array([-1.0, 1.0, 1.0])
_IMAGE_3 = np.array([1.0, -1.0, -1.0])


class HalfBall:
    """Index and design matrices for N pieces a unit."""

    def __init__(self, pieces):
        self.pieces = pieces
        self.shape = (pieces + 2, 2 * pieces + 2, pieces + 2)

    def expand(self, free):
        """All coefficients (*shape, 3) from the free ones (pieces + 1, 2 pieces + 2, pieces + 1, 3)."""
        full = np.empty((*self.shape, 3))
        full[1:, :, 1:] = free
        full[1:, :, 0] = free[:, ::-1, 0] * _IMAGE_3
        full[0] = full[1] * _IMAGE_1
        return full

    def design(self, s, component):
        """Sparse matrix (n, free coefficients) of one component's values at s (n, 3)."""
        from scipy.sparse import csr_matrix

        start, weights = self._local(s)
        n = len(s)
        columns, values = np.empty((n, 27), dtype=int), np.empty((n, 27))
        for k, (i, j, m) in enumerate(np.ndindex(3, 3, 3)):
            columns[:, k], sign = self._free(start + [i, j, m], component)
            values[:, k] = sign * weights[0][:, i] * weights[1][:, j] * weights[2][:, m]
        rows = np.repeat(np.arange(n), 27)
        return csr_matrix((values.ravel(), (rows, columns.ravel())), shape=(n, self.size))

    def values(self, full, s):
        """Interpolated values (n, 3) at s (n, 3) from all coefficients (*shape, 3)."""
        start, weights = self._local(s)
        found = np.zeros((len(s), 3))
        for i, j, m in np.ndindex(3, 3, 3):
            weight = weights[0][:, i] * weights[1][:, j] * weights[2][:, m]
            found += weight[:, None] * full[start[:, 0] + i, start[:, 1] + j, start[:, 2] + m]
        return found

    @property
    def size(self):
        """Number of free coefficients of a component."""
        return (self.pieces + 1) ** 2 * (2 * self.pieces + 2)

    def _free(self, index, component):
        """Number among the free coefficients, and sign, of coefficients (n, 3)."""
        i, j, m = index.T.copy()
        sign = np.where(i == 0, _IMAGE_1[component], 1.0) * np.where(m == 0, _IMAGE_3[component], 1.0)
        j = np.where(m == 0, self.shape[1] - 1 - j, j)
        i, m = np.maximum(i, 1) - 1, np.maximum(m, 1) - 1
        return (i * self.shape[1] + j) * (self.pieces + 1) + m, sign

    def _local(self, s):
        at = s * self.pieces + [0, self.pieces, 0]
        start = np.minimum(at.astype(int), np.array([1, 2, 1]) * self.pieces - 1)
        t = at - start
        return start, [np.stack([(1 - x) ** 2 / 2, 0.5 + x * (1 - x), x * x / 2], axis=1) for x in t.T]

    def roughness(self):
        """Third differences along each axis, of the free coefficients."""
        from scipy.sparse import diags, eye, kron, vstack

        def third(count):
            return diags([-1.0, 3.0, -3.0, 1.0], [0, 1, 2, 3], shape=(count - 3, count))

        n = (self.pieces + 1, self.shape[1], self.pieces + 1)
        one = [eye(k) for k in n]
        return vstack([kron(kron(third(n[0]), one[1]), one[2]), kron(kron(one[0], third(n[1])), one[2]),
                       kron(kron(one[0], one[1]), third(n[2]))]).tocsr()
