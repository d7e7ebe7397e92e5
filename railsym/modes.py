# SPDX-License-Identifier: BSD-3-Clause
"""Modes of a vehicle rolling at constant speed: eigenvalues, damping, shapes, and what moves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from railsym.constant_speed import deflate
from railsym.linear_model import LinearModel
from railsym.mode_labels import MotionLabels
from railsym.symmetry import Part, split

_NEUTRAL = 1e-9       # Re / |lambda| of a mode without damping, after rounding
_PARITY = {-1: "antisymmetric", 1: "symmetric", 0: "mixed"}


@dataclass(frozen=True, eq=False)
class Mode:
    """One mode.

    Attributes
    ----------
    eigenvalue : complex
        lambda, 1/s; of a conjugate pair the one with positive imaginary part.
    coordinates : tuple of str
        Names of the entries of the vectors.
    right : ndarray, shape (n,)
        T(lambda) x = 0, scaled so that the largest displacement (m) is 1; a motion without displacement by its largest entry.
    left : ndarray, shape (n,)
        y^H T(lambda) = 0, scaled to y^H (dT/dlambda) x = 1.
    label : str
        What moves.
    parity : str
        "symmetric", "antisymmetric" (sway, yaw, roll, hunting) or "mixed" for a vehicle without left-right symmetry.
    """

    eigenvalue: complex
    coordinates: tuple[str, ...]
    right: np.ndarray
    left: np.ndarray
    label: str
    parity: str

    @property
    def frequency_hz(self) -> float:
        """Damped frequency, Hz."""
        return abs(self.eigenvalue.imag) / (2 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """-Re(lambda) / |lambda|; negative for an unstable mode, 0 for an eigenvalue 0."""
        return -self.eigenvalue.real / abs(self.eigenvalue) if self.eigenvalue else 0.0

    @property
    def shape(self) -> Mapping[str, complex]:
        """Complex amplitude of every coordinate by its name."""
        return dict(zip(self.coordinates, self.right.tolist()))

    def __repr__(self):
        return f"<Mode {self.label!r}: {self.frequency_hz:.3f} Hz, damping ratio {100 * self.damping_ratio:.2f} %>"


@dataclass(frozen=True, eq=False)
class Modes(Sequence):
    """The modes at one speed: oscillations by frequency, then motions that do not oscillate by decay rate.

    Attributes
    ----------
    speed : float
        m/s.
    modes : tuple of Mode
        One of each conjugate pair.
    constant_speed : tuple of Mode
        Eigenvalues that are zero because the vehicle may stand anywhere on the track and may roll at another speed; no
        instability.
    message : str
        How many modes are unstable, and what was kept apart.
    model : LinearModel
        The model.
    """

    speed: float
    modes: tuple[Mode, ...]
    constant_speed: tuple[Mode, ...]
    message: str
    model: LinearModel = field(repr=False)

    def __len__(self) -> int:
        return len(self.modes)

    def __getitem__(self, index):
        return self.modes[index]

    def __iter__(self) -> Iterator[Mode]:
        return iter(self.modes)

    @property
    def eigenvalue(self) -> np.ndarray:
        """1/s, shape (m,)."""
        return np.array([mode.eigenvalue for mode in self.modes])

    @property
    def frequency_hz(self) -> np.ndarray:
        """Hz, shape (m,)."""
        return np.array([mode.frequency_hz for mode in self.modes])

    @property
    def damping_ratio(self) -> np.ndarray:
        """Shape (m,)."""
        return np.array([mode.damping_ratio for mode in self.modes])

    @property
    def label(self) -> tuple[str, ...]:
        """What moves, mode by mode."""
        return tuple(mode.label for mode in self.modes)

    @property
    def shape(self) -> np.ndarray:
        """Shapes in columns, (n, m), complex; rows as ``model.coordinates``."""
        return np.column_stack([mode.right for mode in self.modes])

    @property
    def unstable(self) -> tuple[Mode, ...]:
        """Modes that grow."""
        return tuple(mode for mode in self.modes if mode.eigenvalue.real > _NEUTRAL * abs(mode.eigenvalue))

    def plot(self, **options):
        """Draw the eigenvalues; options and axes as `railsym.plots.plot_eigenvalues`."""
        from railsym.plots import plot_eigenvalues
        return plot_eigenvalues(self, **options)


def modes(model: LinearModel, speed: float) -> Modes:
    """All modes of a model at a speed.

    Parameters
    ----------
    model : LinearModel
        The linear equations.
    speed : float
        m/s.

    Returns
    -------
    Modes
        Sequence of `Mode`.

    Raises
    ------
    ModelError
        A speed that is not positive and finite.
    """
    labels = MotionLabels(model)
    found, apart = [], []
    for part in split(model):
        moving, standing = _modes_of_part(part, speed, labels)
        found += moving
        apart += standing
    found.sort(key=lambda mode: (mode.eigenvalue.imag == 0, mode.frequency_hz, -mode.eigenvalue.real))
    result = Modes(float(speed), tuple(found), tuple(apart), "", model)
    return Modes(float(speed), tuple(found), tuple(apart), _message(result), model)


def _message(result: Modes) -> str:
    unstable = [f"{mode.label} ({mode.frequency_hz:.2f} Hz)" for mode in result.unstable]
    text = f"unstable at {result.speed:.4g} m/s: {', '.join(unstable)}" if unstable else f"stable at {result.speed:.4g} m/s"
    if result.constant_speed:
        text += f"; kept apart: {', '.join(mode.label for mode in result.constant_speed)}"
    return text


def _modes_of_part(part: Part, speed, labels):
    from scipy.linalg import eig

    model = part.model
    deflated = deflate(model, speed)
    value, left, right = eig(deflated.matrix, left=True, right=True, check_finite=False)
    keep = np.flatnonzero(value.imag >= 0)
    value = value[keep]
    right, left = deflated.restore(value, right[:, keep], left[:, keep])
    x, y = part.expand(model.shape_vector(right, value)), part.expand(model.left_vector(left))
    x = x / _largest(x, labels)
    whole = part.whole
    loss = ((2 * value * (whole.mass @ x) + whole.damping(speed) @ x) * y.conj()).sum(axis=0)
    y = y / loss.conj()
    parity = _PARITY[part.parity]
    found = [Mode(complex(value[k]), whole.coordinates, x[:, k], y[:, k], labels.label(value[k], x[:, k], speed), parity)
             for k in range(len(value))]
    return found, _constant_speed_modes(part, deflated, parity)


def _largest(x, labels):
    """The entry to scale each column by: its largest displacement, or its largest entry where no body is displaced."""
    displaced = labels.moving[np.isin(labels.dof, ("x", "y", "z"))]
    columns = np.arange(x.shape[1])
    overall = x[np.abs(x).argmax(axis=0), columns]
    if not len(displaced):
        return overall
    displacement = x[displaced][np.abs(x[displaced]).argmax(axis=0), columns]
    return np.where(np.abs(displacement) > _NEUTRAL * np.abs(overall), displacement, overall)


def _constant_speed_modes(part: Part, deflated, parity):
    """Uniform translation, and uniform speed with the rates of the coordinates as its shape."""
    model, names = part.model, part.whole.coordinates
    nothing = np.zeros(part.whole.size, dtype=complex)
    second = np.flatnonzero(~model.first_order)
    found = []
    chain = deflated.chain
    for k, label in zip(range(chain.shape[1]), ("uniform translation", "uniform speed")):
        shape = np.zeros(model.size, dtype=complex)
        if k == 0:
            shape = model.shape_vector(chain[:, 0], 0.0)
        else:
            start = np.count_nonzero(~model.first_order & ~model.cyclic)
            shape[second] = chain[start:start + len(second), 1]
        found.append(Mode(complex(deflated.eigenvalue[k]), names, part.expand(shape), nothing, label, parity))
    return found
