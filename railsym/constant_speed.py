# SPDX-License-Identifier: BSD-3-Clause
"""Motions at another place along the track or at another constant speed: eigenvalue 0 twice, and no instability.

A vehicle that nothing holds along the track may stand anywhere on it: uniform translation is a null vector of A. It may also
roll a little faster: that state grows into translation, the second vector of a Jordan chain. (Where the wheels' spin creepage
brakes, the second eigenvalue is not quite zero but that of the vehicle slowing down over hours.) A numerical eigenvalue routine
returns such a pair as +-sqrt(roundoff). So the two are found by what they are and taken out of A exactly, by changing to
coordinates relative to one body.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from railsym.linear_model import LinearModel

# rows of A z against the sum of their terms' sizes: what rounding leaves of an exact zero after some hundred operations
_ROUNDING = 1e-9
# uniform speed as an eigenvector: bodies' speeds alike to this, and a time constant above 100 s
_ALIKE = 1e-2
_SLOW = 1e-2

_faster_states = WeakKeyDictionary()
_lengths = WeakKeyDictionary()         # of chains of templates, by speed


@dataclass(frozen=True, eq=False)
class Deflated:
    """A without its constant-speed motions.

    Attributes
    ----------
    matrix : ndarray, shape (ns - k, ns - k)
        State matrix with every other eigenvalue of A.
    chain : ndarray, shape (ns, k)
        Uniform translation z0 and uniform speed z1 as states, k = 0, 1 or 2: A z0 = 0 and A z1 = z0 + mu z1.
    eigenvalue : ndarray, shape (k,)
        0 and mu, 1/s; mu is 0 unless creep brakes the vehicle.
    """

    matrix: np.ndarray
    chain: np.ndarray
    eigenvalue: np.ndarray
    _steps: tuple

    def restore(self, eigenvalue, right, left):
        """Right and left eigenvectors (ns, m) of A from those (ns - k, m) of `matrix`."""
        for row, vector, own, pivot, others in reversed(self._steps):
            reference = (row @ right) / (eigenvalue - own)
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
    nothing = Deflated(matrix, np.zeros((len(matrix), 0)), np.zeros(0), ())
    if translation is None or not translation.any() or known == 0:
        return nothing
    place = model.state_vector(translation, 0.0).real
    if known is None and not _is_null(matrix, place):
        return nothing
    step, relative = _eliminate(matrix, place, 0.0)
    *_, pivot, others = step
    first = Deflated(relative, place[:, None], np.zeros(1), (step,))
    if known == 1:
        return first
    guess = _uniform_speed(model, translation)
    vector, own = _nearby_eigenvector(relative, guess[others] - place[others] / place[pivot] * guess[pivot])
    faster = np.zeros(len(place))
    faster[others] = vector
    if known is None and not _is_uniform(faster, guess, own):
        return first
    second, rest = _eliminate(relative, vector, own)
    # z1 has no displacement but what it needs: its part along z0 is free, and zero in the reference coordinate
    rate = (matrix[pivot] @ faster) / place[pivot]
    return Deflated(rest, np.column_stack([place, faster / rate]), np.array([0.0, own]), (step, second))


def chain_length(model: LinearModel, speed: float) -> int:
    """Number of constant-speed motions of a model, 0, 1 or 2."""
    translation = model.uniform_translation
    if translation is None or not translation.any():
        return 0
    if model.template is None or not all(_is_null(m, translation) for m in (model.stiffness, model.damping_constant)):
        return deflate(model, speed).chain.shape[1]
    # other numbers that neither hold nor brake the whole vehicle leave the chain as long as it was
    lengths = _lengths.setdefault(model.template, {})
    if speed not in lengths:
        lengths[speed] = deflate(model.template, speed).chain.shape[1]
    return lengths[speed]


def _is_null(matrix, vector) -> bool:
    size = np.abs(matrix) @ np.abs(vector)
    return bool((np.abs(matrix @ vector) <= _ROUNDING * size).all())


def _is_uniform(state, guess, own) -> bool:
    """Do all bodies move at one speed, and keep it for long?"""
    moving = guess != 0
    alike = state[moving] / guess[moving]
    return abs(own) < _SLOW and bool((np.abs(alike / alike.mean() - 1.0) < _ALIKE).all())


def _eliminate(matrix, vector, own):
    """Change to x_i - (z_i / z_p) x_p, in which A z = own z is the coordinate axis p, and drop x_p."""
    pivot = int(np.argmax(np.abs(vector)))
    others = np.delete(np.arange(len(vector)), pivot)
    row = matrix[pivot, others]
    relative = matrix[others[:, None], others] - np.outer(vector[others] / vector[pivot], row)
    return (row, vector, own, pivot, others), relative


def _uniform_speed(model: LinearModel, translation):
    """State of all bodies 1 m/s faster, wheels turning faster so that they do not creep; the same at any speed."""
    if model not in _faster_states:
        _faster_states[model] = _faster_state(model, translation)
    return _faster_states[model]


def _faster_state(model: LinearModel, translation):
    rate = translation.copy()
    if model.cyclic.any():
        turning = model.damping_inverse_speed[:, model.cyclic]
        rate[model.cyclic] = -np.linalg.lstsq(turning, model.damping_inverse_speed @ translation, rcond=None)[0]
    moving = ~model.first_order
    return np.concatenate([np.zeros(np.count_nonzero(moving & ~model.cyclic)), rate[moving],
                           np.zeros(np.count_nonzero(model.first_order))])


def _nearby_eigenvector(matrix, guess):
    """The eigenvector of the eigenvalue nearest 0, from a guess, and that eigenvalue: inverse iteration."""
    from scipy.linalg.lapack import dgetrf, dgetrs

    if _is_null(matrix, guess):
        return guess, 0.0
    factors, pivots, status = dgetrf(matrix)
    if status > 0:
        return guess, 0.0
    largest = int(np.argmax(np.abs(guess)))
    vector = guess
    for _ in range(3):
        following, _ = dgetrs(factors, pivots, vector)
        vector, own = following * (guess[largest] / following[largest]), vector[largest] / following[largest]
    return vector, float(own)
