# SPDX-License-Identifier: BSD-3-Clause
"""Cells of a contact ellipse, and the slip that tractions on them cause.

The ellipse is cut into strips along x, each strip into equal cells over its own length 2 L(y), so that no boundary is
stepped. The traction of a cell acts on a line across it, a quarter of a cell behind its middle, and slip is asked for a
quarter of a cell before the middle. In two dimensions this is the vortex lattice of thin-aerofoil theory, which has the
same kernel 1/x and the same edges (p = 0 at the leading edge, free at the trailing one), and is exact for the force at
any number of cells (R.M. James, On the remarkable accuracy of the vortex lattice method, CMAME 1 (1972)). Across, the
outermost strips end a quarter of a width inside the ellipse (same paper).

The lines must lie closer in x than they are long in y: cells/strips of about 1.5 a/b or more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_LAG = 0.25    # of a cell, from its middle to its traction
_INSET = 0.25  # of a strip, from its edge to the tip of the ellipse


@dataclass(frozen=True)
class Patch:
    """A discretised contact ellipse, a b = 1, G = 1, mu N = 1; arrays of one entry a cell.

    Attributes
    ----------
    x, y : ndarray
        Place of the traction.
    observed : ndarray
        x at which slip is asked for (at the same y).
    middle : ndarray
        x of the cell's middle, where its friction bound acts.
    area, bound : ndarray
        Area; largest traction, of sum(bound area) = 1.
    slip : ndarray, shape (2 n, 2 n)
        Slip in x and y (interleaved) at the cells from tractions px, py: minus du/dx.
    """

    x: np.ndarray
    y: np.ndarray
    observed: np.ndarray
    middle: np.ndarray
    area: np.ndarray
    bound: np.ndarray
    slip: np.ndarray

    @property
    def rigid(self):
        """Slip of creepages 1, shape (2 n, 3): xi - y phi, eta + x phi."""
        one, zero = np.ones_like(self.x), np.zeros_like(self.x)
        return np.stack([np.stack([one, zero], 1).ravel(), np.stack([zero, one], 1).ravel(),
                         np.stack([-self.y, self.observed], 1).ravel()], axis=1)

    @property
    def sums(self):
        """Fx, Fy, Mz from tractions, shape (3, 2 n)."""
        zero = np.zeros_like(self.x)
        return np.stack([np.stack([self.area, zero], 1).ravel(), np.stack([zero, self.area], 1).ravel(),
                         np.stack([-self.y * self.area, self.middle * self.area], 1).ravel()])


def patch(ratio, strips, cells, poisson=0.28):
    """Discretise an ellipse.

    Parameters
    ----------
    ratio : float
        a/b, semi-axis along the rolling direction over the lateral one.
    strips, cells : int
        Strips across, cells along each.
    poisson : float
        Poisson's ratio of both bodies.

    Returns
    -------
    Patch
    """
    a, b = np.sqrt(ratio), 1.0 / np.sqrt(ratio)
    width = 2.0 / (strips + 2 * _INSET)
    edges = -1.0 + width * (_INSET + np.arange(strips + 1))
    Y = (edges[1:] + edges[:-1]) / 2
    ends = np.concatenate([[-1.0], edges[1:-1], [1.0]])  # the bound of the tips goes to the outermost strips
    across = np.diff(ends - ends**3 / 3)                 # int (1 - Y^2)
    t_edges = np.linspace(1.0, -1.0, cells + 1)
    along = -np.diff(t_edges * np.sqrt(1 - t_edges**2) + np.arcsin(t_edges))
    t = (t_edges[1:] + t_edges[:-1]) / 2
    length = a * np.sqrt(1.0 - Y * Y)
    middle = np.outer(t, length).ravel()
    half_x = np.tile(length / cells, cells)
    half_y = b * width / 2
    area = 4 * half_x * half_y
    share = np.outer(along, across).ravel()
    x, y = middle - 2 * _LAG * half_x, np.tile(b * Y, cells)
    observed = middle + 2 * _LAG * half_x
    slip = _slip_of_lines(observed[:, None] - x, y[:, None] - y, half_y, poisson) * np.repeat(2 * half_x, 2)
    return Patch(x, y, observed, middle, area, share / share.sum() / area, slip)


def _slip_of_lines(x, y, half, nu):
    """Minus du/dx at (x, y), (n, n), of unit line loads along y, of the half length `half`: array (2 n, 2 n).

    u = (1/pi) int [(1 - nu)/r + nu x^2/r^3, nu x y/r^3; nu x y/r^3, (1 - nu)/r + nu y^2/r^3] dy for both bodies (G = 1).
    """
    kernel = np.zeros((3, *x.shape))
    for sign, end in ((1.0, y + half), (-1.0, y - half)):
        r = np.hypot(x, end)
        third = end / r                                     # x^2 int dy/r^3
        fifth = (end * (x / r) ** 2 / r + 2 * end / r) / 3  # x^4 int dy/r^5
        kernel[0] += sign * (-(1 - nu) * third + nu * (2 * third - 3 * fifth))
        kernel[1] += sign * nu * ((x / r) ** 2 - 1) / r
        kernel[2] += sign * (-third - nu * (2 * third - 3 * fifth))
    near = np.abs(x) < 1e-9  # of another strip: odd in x, so zero there
    inverse = np.where(near, 0.0, 1.0 / np.where(near, 1.0, x))
    n = len(x)
    slip = np.empty((n, 2, n, 2))
    slip[:, 0, :, 0], slip[:, 1, :, 1] = kernel[0] * inverse, kernel[2] * inverse
    slip[:, 0, :, 1] = slip[:, 1, :, 0] = kernel[1]
    return slip.reshape(2 * n, 2 * n) * (-1.0 / np.pi)


def linear_coefficients(cells_of):
    """C11, C22, C23, C32, C33 of a `Patch`, with no limit of friction."""
    tractions = np.linalg.solve(cells_of.slip, -cells_of.rigid)
    force = cells_of.sums.copy()
    force[2, 1::2] = cells_of.x * cells_of.area  # no slip: the lattice's own place
    found = -force @ tractions
    return np.array([found[0, 0], found[1, 1], found[1, 2], -found[2, 1], found[2, 2]])
