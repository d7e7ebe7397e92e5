# SPDX-License-Identifier: BSD-3-Clause
"""Deformations of suspension elements, to second order in the coordinates of both markers.

Each function returns (J, H): J (m, n) and H (m, n, n) are the gradient and the Hessian at the design position of the
m deformation components, n coordinates being those of the first marker followed by those of the second.  An element
that carries f0 (m,) at the design position then adds  J^T k J + sum_m f0_m H_m  to the stiffness matrix.
"""

import numpy as np


def _stacked(first, second):
    """Gradients and Hessians of both markers over the stacked coordinates: (relative position, R1, R2)."""
    n1, n2 = len(first.indices), len(second.indices)
    n = n1 + n2
    head, tail = slice(0, n1), slice(n1, n)
    distance = np.zeros((3, n))
    distance[:, head], distance[:, tail] = -first.position_gradient, second.position_gradient
    distance2 = np.zeros((3, n, n))
    distance2[:, head, head], distance2[:, tail, tail] = -first.position_hessian, second.position_hessian
    turn1, turn1_2 = np.zeros((3, 3, n)), np.zeros((3, 3, n, n))
    turn2, turn2_2 = np.zeros((3, 3, n)), np.zeros((3, 3, n, n))
    turn1[:, :, head], turn1_2[:, :, head, head] = first.rotation_gradient, first.rotation_hessian
    turn2[:, :, tail], turn2_2[:, :, tail, tail] = second.rotation_gradient, second.rotation_hessian
    return (distance, distance2), (turn1, turn1_2), (turn2, turn2_2)


def translation(first, second, axes):
    """Position of the second marker seen in the first marker's axes: e = (R1 B)^T (r2 - r1), B = `axes` (3, 3).

    Columns of B may be fewer than three: one column n gives the element that acts along an axis of the first body.
    """
    (d1, d2), (turn, turn2), _ = _stacked(first, second)
    gap = second.position - first.position
    gradient = axes.T @ d1 + np.einsum("kla,li,k->ia", turn, axes, gap)
    mixed = np.einsum("kla,li,kb->iab", turn, axes, d1)
    hessian = np.einsum("ki,kab->iab", axes, d2) + mixed + mixed.transpose(0, 2, 1)
    hessian += np.einsum("klab,li,k->iab", turn2, axes, gap)
    return gradient, hessian


def rotation(first, second, axes):
    """Half the antisymmetric part of the relative rotation matrix B^T R1^T R2 B, as a vector about B's axes."""
    _, (turn1, turn1_2), (turn2, turn2_2) = _stacked(first, second)
    inner = turn1.transpose(1, 0, 2) + turn2
    mixed = np.einsum("kia,kjb->ijab", turn1, turn2)
    inner2 = turn1_2.transpose(1, 0, 2, 3) + turn2_2 + mixed + mixed.transpose(0, 1, 3, 2)
    relative = np.einsum("ki,kla,lj->ija", axes, inner, axes)
    relative2 = np.einsum("ki,klab,lj->ijab", axes, inner2, axes)
    return _half_antisymmetric(relative), _half_antisymmetric(relative2)


def _half_antisymmetric(matrix):
    """Vector a of the antisymmetric part: (M - M^T)/2 = cross_matrix(a), over the two leading indices."""
    return 0.5 * np.stack([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])


def elongation(first, second):
    """Change of the distance of two points: e = |r2 - r1| - L.

    With n the unit vector from first to second and d = d(r2 - r1):
    de = n.d and d2e = n.d2(r2 - r1) + (d.d - (n.d)^2)/L, the second part being the string stiffness f0/L.
    """
    (d1, d2), _, _ = _stacked(first, second)
    gap = second.position - first.position
    length = np.sqrt(gap @ gap)
    if length < 1e-3:
        raise ValueError(f"a line element needs its points apart by more than 1 mm, got {1e3 * length:.4g} mm")
    direction = gap / length
    gradient = direction @ d1
    hessian = np.einsum("k,kab->ab", direction, d2) + (d1.T @ d1 - np.outer(gradient, gradient)) / length
    return gradient[None, :], hessian[None, :, :]
