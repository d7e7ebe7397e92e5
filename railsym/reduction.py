# SPDX-License-Identifier: BSD-3-Clause
"""A small model with the slow motions of a large one, and an estimate of what it leaves out.

Galerkin projection on the undamped modes of the elastic structure below a frequency limit, taken with the Maxwell springs
released, and on the static shapes of the faster modes under what the elastic structure left out: Maxwell springs, dampers and
creep forces (residual attachment modes; Craig 2000, Coupling of substructures for dynamic analyses). Internal (Maxwell)
coordinates and spin angles are kept as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.linear_model import LinearModel

KEEP_ALL = 24          # second-order coordinates: a model this small is not worth reducing
# rad/s and m/s at which dampers and creep forces are weighed: hunting in the middle of its range
_FREQUENCY, _SPEED = 2 * np.pi * 6.0, 20.0
# static shapes are kept that change the square of a frequency like that by more than this share
_ATTACHED = 0.1
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
    dropped, dropped_stiffness : ndarray, shapes (n, k) and (k,)
        Mass-normalised modes left out and their omega^2, (rad/s)^2.
    """

    model: LinearModel
    basis: np.ndarray
    full: LinearModel
    dropped: np.ndarray
    dropped_stiffness: np.ndarray

    def expand(self, shape: np.ndarray) -> np.ndarray:
        """Reduced coordinates (m, ...) as coordinates of the full model (n, ...)."""
        return _times(self.basis, shape) if shape.ndim == 2 else self.basis @ shape

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
        x, y, conjugate = self.expand(right), self.expand(left), eigenvalue.conj()
        full, reduced, modes = self.full, self.model, self.dropped
        mass, damping, stiffness = full.mass, full.damping(speed), full.stiffness
        residual = _times(mass, x * eigenvalue**2) + _times(damping, x * eigenvalue) + _times(stiffness, x)
        left_residual = _times(mass.T, y * conjugate**2) + _times(damping.T, y * conjugate) + _times(stiffness.T, y)
        amplitude = -_times(modes.T, residual) / (self.dropped_stiffness[:, None] + eigenvalue**2)
        slope = ((reduced.mass @ (right * (2 * eigenvalue)) + reduced.damping(speed) @ right) * left.conj()).sum(axis=0)
        change = -(_times(modes.T, left_residual).conj() * amplitude).sum(axis=0) / slope
        return change, _times(modes, amplitude)


def _times(matrix, values):
    """Real matrix times complex values, without a complex copy of the matrix."""
    parts = matrix @ np.hstack([values.real, values.imag])
    return parts[:, :values.shape[1]] + 1j * parts[:, values.shape[1]:]


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
    kept_alone = np.flatnonzero(model.first_order | model.cyclic)
    if len(moving) <= KEEP_ALL:
        nothing = np.zeros((model.size, 0))
        return Reduction(model, np.eye(model.size), model, nothing, np.zeros(0))
    square, modes, others = _elastic_modes(model, moving)
    slow = square < (2 * np.pi * frequency_limit) ** 2
    wanted = [modes[:, slow], _attachments(modes[:, slow], modes[:, ~slow], square[~slow], others)]
    translation = model.uniform_translation
    if translation is not None and translation.any():
        wanted.insert(0, translation[moving, None])
    if extra is not None:
        wanted.append(extra[moving])
    shapes = _orthonormal(np.hstack(wanted), model.mass[np.ix_(moving, moving)])
    basis = np.zeros((model.size, shapes.shape[1] + len(kept_alone)))
    basis[moving, :shapes.shape[1]] = shapes
    basis[kept_alone, shapes.shape[1] + np.arange(len(kept_alone))] = 1.0
    dropped = np.zeros((model.size, np.count_nonzero(~slow)))
    dropped[moving] = modes[:, ~slow]
    return Reduction(_projected(model, basis, kept_alone), basis, model, dropped, square[~slow])


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


def _projected(model: LinearModel, basis, kept_alone) -> LinearModel:
    count = basis.shape[1]
    first_order, cyclic = np.zeros(count, bool), np.zeros(count, bool)
    first_order[count - len(kept_alone):] = model.first_order[kept_alone]
    cyclic[count - len(kept_alone):] = model.cyclic[kept_alone]
    translation = model.uniform_translation
    if translation is not None:
        translation = np.linalg.lstsq(basis, translation, rcond=None)[0] if translation.any() else np.zeros(count)
    names = tuple(f"basis{i}" for i in range(count - len(kept_alone))) + tuple(model.coordinates[i] for i in kept_alone)
    matrices = (model.mass, model.stiffness, model.damping_constant, model.damping_speed, model.damping_inverse_speed)
    return LinearModel(names, *(basis.T @ (matrix @ basis) for matrix in matrices), first_order, cyclic, translation=translation)
