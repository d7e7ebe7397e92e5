# SPDX-License-Identifier: BSD-3-Clause
"""Motions at another place along the track or at another constant speed: eigenvalue 0 twice, and no instability.

A vehicle that nothing holds along the track may stand anywhere on it: uniform translation is a null vector of A. It may also
roll a little faster: that state grows into translation, the second vector of a Jordan chain. A numerical eigenvalue routine
returns such a pair as +-sqrt(roundoff). So the two are found by what they are and taken out of A exactly, by changing to
coordinates relative to one body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.linear_model import LinearModel

# rows of A z against the sum of their terms' sizes: what rounding leaves of an exact zero after some hundred operations
_ROUNDING = 1e-9
# the same after a projection, whose sums cancel from contact stiffnesses (1e9 N/m) down to the slowest modes (1 1/s2)
_PROJECTED_ROUNDING = 1e-4


@dataclass(frozen=True, eq=False)
class Deflated:
    """A without its constant-speed motions.

    Attributes
    ----------
    matrix : ndarray, shape (ns - k, ns - k)
        State matrix with every eigenvalue of A but k zeros.
    chain : ndarray, shape (ns, k)
        Uniform translation and uniform speed, as states: A chain[:, 0] = 0, A chain[:, 1] = chain[:, 0]; k = 0, 1 or 2.
    """

    matrix: np.ndarray
    chain: np.ndarray
    _steps: tuple

    def restore(self, eigenvalue, right, left):
        """Right and left eigenvectors (ns, m) of A from those (ns - k, m) of `matrix`."""
        for matrix, vector, pivot, others in reversed(self._steps):
            reference = (matrix[pivot, others] @ right) / eigenvalue
            whole = np.zeros((len(vector), right.shape[1]), dtype=complex)
            whole[others] = right
            right = whole + np.outer(vector / vector[pivot], reference)
            whole = np.zeros_like(right)
            whole[others] = left
            whole[pivot] = -(vector[others] / vector[pivot]) @ left
            left = whole
        return right, left


def deflate(model: LinearModel, speed: float, known: int | None = None) -> Deflated:
    """State matrix without uniform translation and uniform speed, where the model has them.

    Parameters
    ----------
    model : LinearModel
        A whole model, one half of it, or a projection.
    speed : float
        m/s.
    known : int, optional
        Length of the chain (0, 1 or 2) when it was found on the model that this one is a projection of: projecting leaves
        rounding errors in which a test for zero rows would see nothing. Without it the rows are tested.
    """
    matrix = model.state_matrix(speed)
    translation = model.uniform_translation
    nothing = Deflated(matrix, np.zeros((len(matrix), 0)), ())
    if translation is None or not translation.any() or known == 0:
        return nothing
    place = model.state_vector(translation, 0.0).real
    if known is None and not _is_null(matrix, place):
        return nothing
    steps, relative = _eliminate(matrix, place)
    _, _, pivot, others = steps
    faster = _uniform_speed(model, translation)
    vector = faster[others] - place[others] / place[pivot] * faster[pivot]
    if known == 1:
        return Deflated(relative, place[:, None], (steps,))
    if not _is_null(relative, vector, _ROUNDING if known is None else _PROJECTED_ROUNDING):
        vector = _null_vector(relative)
        if known is None and not _is_null(relative, vector):
            return Deflated(relative, place[:, None], (steps,))
        faster = _chained(matrix, place, pivot, others, vector)
    second, rest = _eliminate(relative, vector)
    return Deflated(rest, np.column_stack([place, faster]), (steps, second))


def _is_null(matrix, vector, rounding=_ROUNDING) -> bool:
    size = np.abs(matrix) @ np.abs(vector)
    return bool((np.abs(matrix @ vector) <= rounding * size).all())


def _eliminate(matrix, vector):
    """Change to x_i - (z_i / z_p) x_p, whose column p is zero when A z = 0, and drop x_p."""
    pivot = int(np.argmax(np.abs(vector)))
    others = np.delete(np.arange(len(vector)), pivot)
    ratio = vector[others] / vector[pivot]
    relative = matrix[np.ix_(others, others)] - np.outer(ratio, matrix[pivot, others])
    return (matrix, vector, pivot, others), relative


def _uniform_speed(model: LinearModel, translation):
    """State of all bodies 1 m/s faster, wheels turning faster so that they do not creep."""
    rate = translation.copy()
    turning = model.damping_inverse_speed[:, model.cyclic]
    rate[model.cyclic] = -np.linalg.lstsq(turning, model.damping_inverse_speed @ translation, rcond=None)[0]
    moving = ~model.first_order
    return np.concatenate([np.zeros(np.count_nonzero(moving & ~model.cyclic)), rate[moving],
                           np.zeros(np.count_nonzero(model.first_order))])


def _null_vector(matrix):
    """Candidate null vector by inverse iteration: for vehicles that another speed also shifts statically."""
    from scipy.linalg import lu_factor, lu_solve, matrix_balance

    balanced, (scale, _) = matrix_balance(matrix, permute=False, separate=True)
    nudge = 1e-15 * np.abs(balanced).max()
    factors = lu_factor(balanced + nudge * np.eye(len(matrix)), check_finite=False)
    vector = np.ones(len(matrix))
    for _ in range(3):
        vector = lu_solve(factors, vector / np.abs(vector).max(), check_finite=False)
    return scale * vector / np.abs(vector).max()


def _chained(matrix, place, pivot, others, vector):
    """z1 with A z1 = z0 from the null vector of the relative problem: scale by the rate of the reference coordinate."""
    rate = matrix[pivot, others] @ vector / place[pivot]
    faster = np.zeros(len(place))
    faster[others] = vector / rate
    return faster
