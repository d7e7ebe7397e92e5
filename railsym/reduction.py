# SPDX-License-Identifier: BSD-3-Clause
"""A small model with the slow motions of a large one, and an estimate of what it leaves out.

Galerkin projection on the undamped modes of the elastic structure below a frequency limit, taken with the Maxwell springs
released, and on the static shapes of the faster modes under what the elastic structure left out: Maxwell springs, dampers and
creep forces (residual attachment modes; Craig 2000, Coupling of substructures for dynamic analyses). Internal (Maxwell)
coordinates and spin angles are kept as they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from railsym.linear_model import LinearModel, check_speed, state_parts

KEEP_ALL = 24          # second-order coordinates: a model this small is not worth reducing
# rad/s and m/s at which dampers and creep forces are weighed: hunting in the middle of its range
_FREQUENCY, _SPEED = 2 * np.pi * 6.0, 20.0
# static shapes are kept that change the square of a frequency like that by more than this share
_ATTACHED = 0.1
_LIGHT = 0.04          # share of the mass of a slow mode that the lag of a Maxwell element may make up for it to need no coordinate
_DEPENDENT = 1e-8      # share of a unit vector outside the span of the others below which it is dropped


@dataclass(frozen=True, eq=False)
class Reduction:
    """A projected model.

    Attributes
    ----------
    model : LinearModel
        The reduced matrices, in coordinates z with q = basis z.
    basis : ndarray, shape (n, m)
        Real basis vectors.
    full : LinearModel
        The model that was reduced.
    dropped : ndarray, shape (n, k)
        What was left out: mass-normalised modes, and internal coordinates that follow without delay.
    dropped_pencil : ndarray, shape (3, k)
        Their K, C and M: omega^2, 0 and 1 of modes; stiffness, damping and 0 of internal coordinates.
    lag : ndarray, shape (m, m)
        In the mass matrix of `model`: what the internal coordinates that follow lag behind, to first order.
    """

    model: LinearModel
    basis: np.ndarray
    full: LinearModel
    dropped: np.ndarray
    dropped_pencil: np.ndarray
    lag: np.ndarray

    @property
    def next_frequency(self) -> float:
        """Hz, of the slowest mode left out."""
        modes = self.dropped_pencil[2] > 0.0
        return float(np.sqrt(self.dropped_pencil[0, modes].min(initial=np.inf)) / (2 * np.pi))

    def expand(self, shape: np.ndarray) -> np.ndarray:
        """Reduced coordinates (m, ...) as coordinates of the full model (n, ...)."""
        return real_times(self.basis, shape) if shape.ndim == 2 else self.basis @ shape

    def correction(self, eigenvalue, speed, right, left):
        """First-order effect of the dropped modes on eigenvalues of the reduced model.

        Parameters
        ----------
        eigenvalue : ndarray, shape (k,)
            1/s.
        speed : float
            m/s.
        right, left : ndarray, shape (m, k)
            Vectors with T x = 0 and y^H T = 0 in the reduced model.

        Returns
        -------
        change : ndarray, shape (k,)
            Estimate of (eigenvalue of the full model) - eigenvalue, 1/s.
        missing : ndarray, shape (n, k)
            What the dropped modes add to the full shapes.
        """
        x, y = self.expand(right), self.expand(left)
        full, reduced, conjugate = self.full, self.model, eigenvalue.conj()
        matrices = full.mass, full.damping(speed), full.stiffness
        residual = sum(real_times(matrix, x * factor) for matrix, factor in zip(matrices, (eigenvalue**2, eigenvalue, 1.0)))
        left_residual = sum(real_times(matrix.T, y * factor) for matrix, factor in zip(matrices, (conjugate**2, conjugate, 1.0)))
        own_stiffness, own_damping, own_mass = self.dropped_pencil[:, :, None]
        amplitude = -real_times(self.dropped.T, residual) / (own_stiffness + eigenvalue * own_damping + eigenvalue**2 * own_mass)
        slope = ((reduced.mass @ (right * (2 * eigenvalue)) + reduced.damping(speed) @ right) * left.conj()).sum(axis=0)
        lag = eigenvalue**2 * ((self.lag @ right) * left.conj()).sum(axis=0)
        change = (lag - (real_times(self.dropped.T, left_residual).conj() * amplitude).sum(axis=0)) / slope
        return change, real_times(self.dropped, amplitude)


def real_times(matrix, values):
    """Real matrix times complex values, without a complex copy of the matrix."""
    values = np.ascontiguousarray(values, dtype=complex)
    return (matrix @ values.view(float)).view(complex)


def reduce_model(model: LinearModel, frequency_limit: float, extra: np.ndarray | None = None) -> Reduction:
    """Project a model on its elastic modes up to a frequency.

    Parameters
    ----------
    model : LinearModel
        The model, or one half of a symmetric one.
    frequency_limit : float
        Hz; modes of the elastic structure up to here are kept.
    extra : ndarray, shape (n, k), optional
        Real shapes to hold besides.

    Returns
    -------
    Reduction
        With ``basis`` the identity when the model has at most `KEEP_ALL` coordinates with inertia.
    """
    moving = np.flatnonzero(~model.first_order & ~model.cyclic)
    if len(moving) <= KEEP_ALL:
        nothing = np.zeros((model.size, 0))
        return Reduction(model, np.eye(model.size), model, nothing, np.zeros((3, 0)), np.zeros((model.size, model.size)))
    square, modes, others = _elastic_modes(model, moving)
    slow = square < (2 * np.pi * frequency_limit) ** 2
    wanted = [modes[:, slow], _attachments(modes[:, slow], modes[:, ~slow], square[~slow], others)]
    translation = model.uniform_translation
    if translation is not None and translation.any():
        wanted.insert(0, translation[moving, None])
    if extra is not None:
        wanted.append(extra[moving])
    mass = model.mass[moving[:, None], moving]
    shapes = _orthonormal(np.hstack(wanted), mass)
    followers = _followers(model, moving, modes[:, slow]) if extra is None else _Followers.none(len(moving))
    return _reduction(model, moving, shapes, (modes[:, ~slow], square[~slow]), followers, shapes.T @ (mass @ modes[:, slow]))


def _reduction(model, moving, shapes, fast, followers, slow):
    """Reduction on shapes (moving, s), the fast modes and the followers left out; slow modes in terms of the shapes (s, k)."""
    alone = model.first_order | model.cyclic
    alone[followers.index] = False
    kept_alone, count, modes = np.flatnonzero(alone), shapes.shape[1], fast[0].shape[1]
    basis = np.zeros((model.size, count + len(kept_alone)))
    basis[moving, :count] = shapes
    basis[followers.index, :count] = followers.motion @ shapes
    basis[kept_alone, count + np.arange(len(kept_alone))] = 1.0
    dropped = np.zeros((model.size, modes + len(followers.index)))
    dropped[moving, :modes], dropped[followers.index, :modes] = fast[0], followers.motion @ fast[0]
    dropped[followers.index, modes + np.arange(len(followers.index))] = 1.0
    pencil = np.zeros((3, dropped.shape[1]))
    pencil[0, :modes], pencil[2, :modes] = fast[1], 1.0
    pencil[0, modes:], pencil[1, modes:] = followers.stiffness, followers.damping
    lag = np.zeros((basis.shape[1], basis.shape[1]))
    if len(followers.index):
        lag[:count, :count] = slow @ followers.lag @ slow.T
    return Reduction(_projected(model, basis, kept_alone, lag), basis, model, dropped, pencil, lag)


@dataclass(frozen=True, eq=False)
class _Followers:
    """Internal coordinates that follow the motion of the others: s = motion x, behind by the time damping/stiffness."""

    index: np.ndarray
    motion: np.ndarray        # (f, moving)
    stiffness: np.ndarray
    damping: np.ndarray
    lag: np.ndarray           # (k, k) over the slow modes, - (motion modes)^T damping^2/stiffness (motion modes)

    @classmethod
    def none(cls, moving):
        return cls(np.zeros(0, int), np.zeros((0, moving)), np.zeros(0), np.zeros(0), None)


def _followers(model: LinearModel, moving, slow) -> _Followers:
    """Internal coordinates of stiff Maxwell elements, coupled to no other one.

    The force of such an element is damping x rate less damping^2/stiffness x acceleration and so on: it acts on slow modes like a
    damper and a small negative mass.
    """
    internal = np.flatnonzero(model.first_order)
    blocks = [matrix[internal[:, None], internal] for matrix in (model.stiffness, model.damping_constant)]
    stiffness, damping = (block.diagonal() for block in blocks)
    alone = np.all([np.count_nonzero(block, axis=1) == 1 for block in blocks], axis=0) & (stiffness > 0.0)
    motion = -model.stiffness[internal[:, None], moving] / np.where(alone, stiffness, 1.0)[:, None]
    elongation = motion @ slow
    inertia = damping**2 / np.where(alone, stiffness, 1.0)
    follows = np.flatnonzero(alone & (inertia * (elongation**2).max(axis=1, initial=0.0) < _LIGHT))
    lag = -elongation[follows].T @ (inertia[follows, None] * elongation[follows])
    return _Followers(internal[follows], motion[follows], stiffness[follows], damping[follows], lag)


def _attachments(slow, fast, square, others):
    """Static shapes of the fast modes under the forces that slow motions cause outside the elastic structure.

    Without them the square of a slow frequency is wrong by |H|^2, H = omega_fast^-1 fast^T X slow, with X the stiffness of the
    other forces at a frequency of interest: so the directions are kept in which |H|^2 is large.
    """
    weight = fast / np.sqrt(square)
    coupling = weight.T @ np.hstack([other @ slow for other in others])
    size, directions = np.linalg.eigh(coupling @ coupling.T)
    return weight @ directions[:, size > _ATTACHED * _FREQUENCY**2]


def _elastic_modes(model: LinearModel, moving):
    """Elastic structure with Maxwell springs released and wheels not rolling, and the stiffness of all other forces.

    Returns
    -------
    square : ndarray, shape (k,)
        omega^2 of the modes, (rad/s)^2.
    modes : ndarray, shape (k, k)
        Mass-normalised.
    others : list of ndarray, shape (k, k)
        Maxwell springs, creep stiffness, dampers and creep damping at a frequency and a speed of interest.
    """
    place, internal = np.ix_(moving, moving), np.flatnonzero(model.first_order)
    stiffness = model.stiffness[place]
    others = [_FREQUENCY * model.damping_constant[place], _FREQUENCY / _SPEED * model.damping_inverse_speed[place]]
    if len(internal):
        released = np.linalg.solve(model.stiffness[np.ix_(internal, internal)], model.stiffness[np.ix_(internal, moving)])
        others.append(model.stiffness[np.ix_(moving, internal)] @ released)
        stiffness = stiffness - others[-1]
    # creep forces make K unsymmetric; what two opposite entries agree on is the elastic part
    mirrored = stiffness.T
    elastic = np.where(stiffness * mirrored > 0, np.sign(stiffness) * np.minimum(np.abs(stiffness), np.abs(mirrored)), 0.0)
    others.append(stiffness - elastic)
    return *_mass_normalised_modes(elastic, model.mass[place]), others


def _mass_normalised_modes(stiffness, mass):
    """omega^2 and modes of symmetric matrices; dividing by a diagonal mass spares half the time."""
    from scipy.linalg import eigh

    diagonal = mass.diagonal()
    if np.count_nonzero(mass) > np.count_nonzero(diagonal) or not (diagonal > 0).all():
        return eigh(stiffness, mass, check_finite=False)
    scale = 1.0 / np.sqrt(diagonal)
    square, modes = np.linalg.eigh(stiffness * scale * scale[:, None])
    return square, scale[:, None] * modes


def _orthonormal(shapes, mass):
    """Basis of the span of shapes, orthonormal in the mass metric, nearly dependent shapes left out."""
    shapes = shapes / np.sqrt((shapes * (mass @ shapes)).sum(axis=0))
    square, directions = np.linalg.eigh(shapes.T @ mass @ shapes)
    keep = square > _DEPENDENT
    return shapes @ (directions[:, keep] / np.sqrt(square[keep]))


def _coordinates(vector, basis, mass, kept_alone):
    """Coordinates of a vector in the span of a basis whose first columns are orthonormal in the mass metric, the others unit vectors."""
    shapes, found = basis[:, :basis.shape[1] - len(kept_alone)], np.zeros(basis.shape[1])
    found[shapes.shape[1]:] = vector[kept_alone]
    for _ in range(2):           # the second time takes what rounding left of orthogonality
        found[:shapes.shape[1]] += shapes.T @ (mass @ (vector - basis @ found))
    return found


class _Projected(LinearModel):
    """A small model with full matrices: its state matrix is made of a few products instead of entry by entry."""

    def state_matrix(self, speed):
        check_speed(speed)
        constant, with_speed, with_inverse_speed = self._powers
        return constant + (speed * with_speed + with_inverse_speed / speed)

    def state_matrix_slope(self, speed):
        check_speed(speed)
        _, with_speed, with_inverse_speed = self._powers
        return with_speed - with_inverse_speed / speed**2

    @cached_property
    def _powers(self):
        """A0, A1 and A2 of A(V) = A0 + V A1 + A2 / V."""
        parts = state_parts(self)
        moves, count = len(parts.position), len(parts.second)
        rows = np.concatenate([parts.second, parts.first])[:, None]
        powers = np.zeros((3, moves + len(rows), moves + len(rows)))
        powers[0, np.arange(moves), moves + np.searchsorted(parts.second, parts.position)] = 1.0
        forces = np.hstack([self.stiffness[rows, parts.position], self.damping_constant[rows, parts.second],
                            self.stiffness[rows, parts.first]])
        powers[0, moves:] = -self._inertia_inverse @ forces
        for power, damping in zip(powers[1:], (self.damping_speed, self.damping_inverse_speed)):
            power[moves:, moves:moves + count] = -self._inertia_inverse @ damping[rows, parts.second]
        return powers


def _projected(model: LinearModel, basis, kept_alone, lag) -> LinearModel:
    count = basis.shape[1]
    first_order, cyclic = np.zeros(count, bool), np.zeros(count, bool)
    first_order[count - len(kept_alone):] = model.first_order[kept_alone]
    cyclic[count - len(kept_alone):] = model.cyclic[kept_alone]
    translation = model.uniform_translation
    if translation is not None:
        translation = _coordinates(translation, basis, model.mass, kept_alone) if translation.any() else np.zeros(count)
    names = tuple(f"basis{i}" for i in range(count - len(kept_alone))) + tuple(model.coordinates[i] for i in kept_alone)
    matrices = (model.mass, model.stiffness, model.damping_constant, model.damping_speed, model.damping_inverse_speed)
    mass, *others = (basis.T @ (matrix @ basis) for matrix in matrices)
    return _Projected(names, mass + lag, *others, first_order, cyclic, translation=translation)
