# SPDX-License-Identifier: BSD-3-Clause
"""The linear equations of a vehicle rolling at constant speed on straight track.

    M q'' + C(V) q' + K q = 0,        C(V) = C0 + V C1 + C2 / V

``V C1`` holds the gyroscopic moments of the turning wheelsets, ``C2 / V`` the creep forces. Internal (Maxwell) coordinates
have zero rows and columns in M: their rows are first-order equations. The angle through which a wheelset has turned is
cyclic: its column in K is zero and it is no state.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from railsym.errors import ModelError

MATRICES = ("mass", "stiffness", "damping_constant", "damping_speed", "damping_inverse_speed")


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Matrices of the linear equations of motion and what their rows mean.

    Parameters
    ----------
    coordinates : tuple of str, length n
        Names of the coordinates, "body.dof", or "group.instance.s" for the damper elongation of a Maxwell element.
    mass, stiffness : ndarray, shape (n, n)
        M (kg, kg m, kg m2) and K (N/m, N/rad, ...).
    damping_constant, damping_speed, damping_inverse_speed : ndarray, shape (n, n)
        C0, C1 and C2 of C(V) = C0 + V C1 + C2 / V with V in m/s.
    first_order : ndarray of bool, shape (n,)
        True for internal coordinates, whose rows and columns in M are zero.
    cyclic : ndarray of bool, shape (n,)
        True for wheelset spin angles, whose columns in K are zero.
    vehicle, contact : object, optional
        The vehicle and the resolved linear contact that the matrices were made from.
    mirror : tuple (permutation, sign) of two (n,) arrays, optional
        Left-right mirroring: coordinate i of the mirrored motion is ``sign[i] * q[permutation[i]]``. Without it
        `railsym.symmetry` looks for one in the vehicle.
    translation : ndarray, shape (n,), optional
        Uniform displacement along the track; from the names of the coordinates when not given.
    base : LinearModel, optional
        The same vehicle without its contact: same mass and C0. State matrices are then built from those of the base by what
        the contact changes, which is several times faster.
    template : LinearModel, optional
        A model of the same bodies and elements in the same places with other numbers: what only those decide (which motions
        mirror into which, what the bodies are) is taken from there.

    Raises
    ------
    ModelError
        Matrices of the wrong shape or with entries that are not finite, inertia on a first-order coordinate, stiffness on a
        cyclic one.
    """

    coordinates: tuple[str, ...]
    mass: np.ndarray
    stiffness: np.ndarray
    damping_constant: np.ndarray
    damping_speed: np.ndarray
    damping_inverse_speed: np.ndarray
    first_order: np.ndarray
    cyclic: np.ndarray
    vehicle: Any = None
    contact: Any = None
    mirror: tuple[np.ndarray, np.ndarray] | None = None
    translation: np.ndarray | None = None
    base: LinearModel | None = field(default=None, repr=False)
    template: LinearModel | None = field(default=None, repr=False)

    def __post_init__(self):
        n = len(self.coordinates)
        for name in MATRICES:
            matrix = getattr(self, name)
            if matrix is getattr(self.base, name, None) or matrix is getattr(self.template, name, None):
                continue  # looked at when the base or template was made
            if matrix.shape != (n, n):
                raise ModelError(f"{name} has shape {matrix.shape}; {n} coordinates need ({n}, {n})")
            # a sum is not finite if any entry is not: one pass without a temporary
            if not np.isfinite(matrix.sum()):
                row, column = np.argwhere(~np.isfinite(matrix))[0]
                raise ModelError(f"{name}[{self.coordinates[row]}, {self.coordinates[column]}] = {matrix[row, column]} "
                                 "is not finite; check the vehicle's parameters and the wheel loads")
        if self.mass is not getattr(self.base or self.template, "mass", None) and self.mass[self.first_order].any():
            raise ModelError("first-order coordinates have no inertia, but the mass matrix has entries in their rows")
        if self.stiffness[:, self.cyclic].any():
            raise ModelError("a cyclic coordinate exerts no force, but its column of the stiffness matrix is not zero")

    @property
    def size(self) -> int:
        """Number of coordinates, n."""
        return len(self.coordinates)

    @cached_property
    def states(self) -> tuple[str, ...]:
        """Names of the states: coordinates without cyclic ones, rates ("name.rate") of the second-order ones, internal ones."""
        parts = state_parts(self)
        name = self.coordinates
        return (tuple(name[i] for i in parts.position) + tuple(name[i] + ".rate" for i in parts.second)
                + tuple(name[i] for i in parts.first))

    def damping(self, speed: float) -> np.ndarray:
        """C(V), shape (n, n), at a speed in m/s.

        Raises
        ------
        ModelError
            A speed that is not positive and finite: creepages are referred to the speed.
        """
        check_speed(speed)
        return self.damping_constant + speed * self.damping_speed + self.damping_inverse_speed / speed

    def damping_slope(self, speed: float) -> np.ndarray:
        """dC/dV, shape (n, n), at a speed in m/s."""
        check_speed(speed)
        return self.damping_speed - self.damping_inverse_speed / speed**2

    def dynamic_stiffness(self, eigenvalue: complex, speed: float) -> np.ndarray:
        """T(lambda, V) = lambda^2 M + lambda C(V) + K, complex, shape (n, n); lambda in 1/s, V in m/s."""
        return eigenvalue**2 * self.mass + eigenvalue * self.damping(speed) + self.stiffness

    def dynamic_stiffness_slope(self, eigenvalue: complex, speed: float) -> np.ndarray:
        """dT/dlambda = 2 lambda M + C(V), complex, shape (n, n)."""
        return 2 * eigenvalue * self.mass + self.damping(speed)

    @cached_property
    def entries(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows and columns (k,) in which any matrix has an entry, and those of M, C0, C1, C2 and K there, shape (5, k)."""
        matrices = self.mass, self.damping_constant, self.damping_speed, self.damping_inverse_speed, self.stiffness
        filled = matrices[0] != 0.0
        for matrix in matrices[1:]:
            filled |= matrix != 0.0
        flat = np.flatnonzero(filled)
        return *np.divmod(flat, self.size), np.array([matrix.ravel()[flat] for matrix in matrices])

    def state_matrix(self, speed: float) -> np.ndarray:
        """A of x' = A x at a speed in m/s, shape (ns, ns), rows as `states`; a fresh array on every call."""
        check_speed(speed)
        constant, index, added, with_speed, with_inverse_speed = self._state_matrix_parts
        matrix = constant.copy()
        matrix.ravel()[index] += added + speed * with_speed + with_inverse_speed / speed
        return matrix

    def state_matrix_slope(self, speed: float) -> np.ndarray:
        """dA/dV at a speed in m/s, shape (ns, ns)."""
        check_speed(speed)
        constant, index, _, with_speed, with_inverse_speed = self._state_matrix_parts
        matrix = np.zeros_like(constant)
        matrix.ravel()[index] = with_speed - with_inverse_speed / speed**2
        return matrix

    @cached_property
    def _state_matrix_parts(self):
        """A0, flat places in A, and what is added there: a constant, times V, over V."""
        constant = self._constant_state_matrix if self.base is None else self.base._constant_state_matrix
        return constant, *_changing_entries(self, len(constant))

    @cached_property
    def _constant_state_matrix(self):
        return _constant_state_matrix(self)

    @cached_property
    def _inertia(self):
        return _BlockInverse(self.mass, state_parts(self).second)

    def state_vector(self, shape: np.ndarray, eigenvalue: complex) -> np.ndarray:
        """The state of the motion q = shape exp(lambda t): coordinates, rates, internal coordinates; shape (ns,)."""
        parts = state_parts(self)
        return np.concatenate([shape[parts.position], eigenvalue * shape[parts.second], shape[parts.first]])

    def shape_vector(self, state: np.ndarray, eigenvalue: complex) -> np.ndarray:
        """Coordinates (n, ...) of eigenvectors of A (ns, ...): cyclic ones are rate / lambda, and zero for lambda = 0."""
        parts = state_parts(self)
        shape = np.zeros((self.size,) + state.shape[1:], dtype=complex)
        positions, rates, internal = np.split(state, [len(parts.position), len(parts.position) + len(parts.second)])
        shape[parts.second] = rates / np.where(eigenvalue == 0, np.inf, eigenvalue)
        shape[parts.position] = positions
        shape[parts.first] = internal
        return shape

    def left_vector(self, state: np.ndarray) -> np.ndarray:
        """y (n, ...) with y^H T(lambda, V) = 0 from left eigenvectors of A (ns, ...).

        The rate and internal rows of A are -G^-1 times the forces, G = [[M, Cvs], [0, Css]]: so G^H y is their part of it.
        """
        parts = state_parts(self)
        left = np.zeros((self.size,) + state.shape[1:], dtype=complex)
        left[np.concatenate([parts.second, parts.first])] = self._inertia_inverse.T @ state[len(parts.position):]
        return left

    @cached_property
    def _inertia_inverse(self) -> np.ndarray:
        """G^-1, G = [[M, Cvs], [0, Css]]."""
        parts = state_parts(self)
        both = np.concatenate([parts.second, parts.first])
        columns = self.mass[both[:, None], parts.second], self.damping_constant[both[:, None], parts.first]
        return np.linalg.inv(np.hstack(columns))

    @cached_property
    def uniform_translation(self) -> np.ndarray | None:
        """All bodies displaced by 1 m along the track, shape (n,); None when no coordinate is named "body.x"."""
        if self.translation is not None:
            return self.translation
        along = np.array([name.endswith(".x") and name.count(".") == 1 for name in self.coordinates], dtype=float)
        return along if along.any() else None


@dataclass(frozen=True, eq=False)
class Linearisation:
    """A vehicle linearised at one speed: x' = A x.

    Attributes
    ----------
    A : ndarray, shape (ns, ns)
        State matrix, SI units.
    states : tuple of str, length ns
        Names of the states.
    speed : float
        m/s.
    model : LinearModel
        The matrices that A was made from.
    """

    A: np.ndarray
    states: tuple[str, ...]
    speed: float
    model: LinearModel

    @classmethod
    def of(cls, model: LinearModel, speed: float) -> Linearisation:
        """Linearisation of a model at a speed in m/s."""
        return cls(model.state_matrix(speed), model.states, float(speed), model)

    def modes(self, **options):
        """Modes at this speed, a `railsym.modes.Modes`; options as `railsym.modes.modes`."""
        from railsym.modes import modes
        return modes(self.model, self.speed, **options)


@dataclass(frozen=True, eq=False)
class _StateParts:
    """Indices of the coordinates behind the three parts of the state, and the same as runs of consecutive ones."""

    position: np.ndarray
    second: np.ndarray
    first: np.ndarray
    runs: dict


def state_parts(model: LinearModel) -> _StateParts:
    return _parts_of_masks(model.first_order.tobytes(), model.cyclic.tobytes())


@lru_cache(maxsize=64)
def _parts_of_masks(first_order: bytes, cyclic: bytes) -> _StateParts:
    internal, turning = np.frombuffer(first_order, bool), np.frombuffer(cyclic, bool)
    index = {"position": np.flatnonzero(~internal & ~turning), "second": np.flatnonzero(~internal),
             "first": np.flatnonzero(internal)}
    return _StateParts(**index, runs={name: _runs(i) for name, i in index.items()})


def _runs(index):
    """Consecutive numbers as (start in the list, slice of the numbers): copying slices is many times faster than indexing."""
    breaks = np.flatnonzero(np.diff(index) != 1) + 1
    return [(int(start), slice(int(index[start]), int(index[start]) + int(stop - start)))
            for start, stop in zip(np.r_[0, breaks], np.r_[breaks, len(index)]) if stop > start]


def check_speed(speed: float) -> None:
    if not 0.0 < speed < np.inf:
        raise ModelError(f"speed {speed} m/s: a finite speed above 0 m/s is needed, because creepages are referred to it")


def _constant_state_matrix(model: LinearModel):
    """A0 of K, C0 and M.

    With v = q' of second-order coordinates and internal coordinates s:
    s' = -Css^-1 (Ksv q + Csv v + Kss s) and v' = -Mvv^-1 (Kvv q + Kvs s + Cvv(V) v + Cvs s').
    """
    parts = state_parts(model)
    v, s = parts.second, parts.first
    count, n_position = len(v), len(parts.position)
    matrix = np.zeros((n_position + count + len(s),) * 2)
    rate, internal = slice(n_position, n_position + count), slice(n_position + count, None)
    matrix[np.arange(n_position), n_position + np.searchsorted(v, parts.position)] = 1.0
    _place_rows(matrix[rate], parts, "second", model, (n_position, n_position + count))
    if len(s):
        _place_rows(matrix[internal], parts, "first", model, (n_position, n_position + count))
        _divide_internal(matrix[internal], model, parts)
        coupling = model.damping_constant[v[:, None], s]
        if coupling.any():
            matrix[rate] += coupling @ matrix[internal]
    model._inertia.apply(matrix[rate])
    np.negative(matrix[rate], out=matrix[rate])
    return matrix


def _place_rows(target, parts, rows, model, starts):
    """Copy K over positions, C0 over rates and K over internal coordinates into rows of the state matrix."""
    for matrix, columns, start in ((model.stiffness, "position", 0), (model.damping_constant, "second", starts[0]),
                                   (model.stiffness, "first", starts[1])):
        for r, source_rows in parts.runs[rows]:
            for c, source_columns in parts.runs[columns]:
                block = matrix[source_rows, source_columns]
                target[r:r + block.shape[0], start + c:start + c + block.shape[1]] = block


def _changing_entries(model, size):
    """Flat places in A, and what contact and speed add there: the contact's -M^-1 K, A1 and A2."""
    parts, n = state_parts(model), model.size
    if model.base is None:
        added, inertia = np.zeros((n, n)), model._inertia
    else:
        added, inertia = model.stiffness - model.base.stiffness, model.base._inertia
    changes = (added, model.damping_speed, model.damping_inverse_speed)
    filled = [np.flatnonzero(change.any(axis=0)) for change in changes]
    if any(model.first_order[columns].any() for columns in filled) or any(c[parts.first].any() for c in changes):
        raise ModelError("contact or speed change the equation of an internal (Maxwell) coordinate; state matrices need it constant")
    v, n_position = parts.second, len(parts.position)
    right = np.concatenate([change[v[:, None], columns] for change, columns in zip(changes, filled, strict=True)], axis=1)
    inertia.apply(right)
    place = [np.searchsorted(parts.position, filled[0])] + [n_position + np.searchsorted(v, c) for c in filled[1:]]
    columns, target = np.unique(np.concatenate(place), return_inverse=True)
    values = np.zeros((3, len(columns), len(v)))
    values[np.repeat(np.arange(3), [len(c) for c in filled]), target] = -right.T
    column, row = np.nonzero(values.any(axis=0))
    return (n_position + row) * size + columns[column], *values[:, column, row]


def _divide_internal(rows, model: LinearModel, parts: _StateParts) -> None:
    """rows := -Css^-1 rows, in place."""
    s = parts.first
    damping = model.damping_constant[s[:, None], s]
    diagonal = damping.diagonal()
    if not diagonal.all():
        name = model.coordinates[s[np.flatnonzero(diagonal == 0)[0]]]
        raise ModelError(f"internal coordinate {name} has no damping, so it has no first-order equation; "
                         "give the Maxwell element a damping above 0 N*s/m or use a spring")
    if np.count_nonzero(damping) == len(s):
        rows /= -diagonal[:, None]
    else:
        rows[:] = -np.linalg.solve(damping, rows)


class _BlockInverse:
    """Inverse of a mass matrix made of blocks on the diagonal (one a body), applied by blocks of equal size."""

    def __init__(self, mass: np.ndarray, index: np.ndarray):
        runs = _runs(index)
        mass = mass[runs[0][1], runs[0][1]] if len(runs) == 1 else mass[index[:, None], index]
        self.diagonal = mass.diagonal()
        self.blocks = []
        if np.count_nonzero(mass) == np.count_nonzero(self.diagonal):
            if not self.diagonal.all():
                raise ModelError("the mass matrix is singular: a second-order coordinate without inertia")
            return
        for rows in _blocks(mass):
            try:
                self.blocks.append((rows, np.linalg.inv(mass[rows[:, :, None], rows[:, None, :]])))
            except np.linalg.LinAlgError as error:
                raise ModelError("the mass matrix is singular: a second-order coordinate without inertia") from error

    def apply(self, right: np.ndarray) -> None:
        """right := M^-1 right, in place."""
        if not self.blocks:
            right /= self.diagonal[:, None]
        for rows, inverse in self.blocks:
            right[rows] = inverse @ right[rows]


def _blocks(mass):
    """Rows of the diagonal blocks of a matrix, (number, width) for every width."""
    filled = mass != 0
    size = np.arange(len(mass))
    reach = np.maximum(len(mass) - 1 - np.argmax(filled[:, ::-1], axis=1), len(mass) - 1 - np.argmax(filled.T[:, ::-1], axis=1))
    end = np.flatnonzero(np.maximum.accumulate(np.maximum(reach, size)) == size) + 1
    start = np.concatenate([[0], end[:-1]])
    return [start[end - start == width][:, None] + np.arange(width) for width in np.unique(end - start)]
