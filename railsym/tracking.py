# SPDX-License-Identifier: BSD-3-Clause
"""Modes followed over speed as an assignment problem.

Left and right eigenvectors of one matrix are biorthogonal: y_i^H x_j = 0 for i != j. Between neighbouring speeds
|y_i^H x'_j| |y'_j^H x_i| is therefore near 1 for one and the same mode and near 0 otherwise, in any units. All modes are assigned
at once (a permutation, asserted), with the distance of the eigenvalues to tell apart modes of like shape. Where modes resemble
each other too little from speed to speed, speeds are put in between.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from railsym.constant_speed import deflate
from railsym.errors import ModelError
from railsym.linear_model import LinearModel
from railsym.mode_labels import MotionLabels
from railsym.symmetry import Part, split

_SIMILAR = 0.5             # similarity below which a speed is put in between
_WATCHED = 0.5             # damping ratio above which a mode may change its shape unwatched
_CLOSE = 0.01              # relative distance from its nearest neighbour below which modes may mix
_HALVINGS = 6              # of a step


@dataclass(frozen=True, eq=False)
class TrackedModes:
    """Modes followed over speed; one row a speed, one column a mode.

    Attributes
    ----------
    speed : ndarray, shape (k,)
        m/s.
    eigenvalue : ndarray, shape (k, m)
        1/s; every eigenvalue but those of uniform translation and uniform speed, conjugates included.
    similarity : ndarray, shape (k - 1, m)
        Of each mode with itself at the next speed, 1 for equal shapes.
    label : tuple of str, length m
        What moves, at the speed where the mode is least damped.
    message : str
        Speeds between which a mode changed its shape abruptly, if there are any.
    model : LinearModel
    """

    speed: np.ndarray
    eigenvalue: np.ndarray
    similarity: np.ndarray
    label: tuple[str, ...]
    message: str
    model: Any = field(repr=False)

    @property
    def frequency_hz(self) -> np.ndarray:
        """Hz, shape (k, m)."""
        return np.abs(self.eigenvalue.imag) / (2 * np.pi)

    @property
    def damping_ratio(self) -> np.ndarray:
        """Shape (k, m)."""
        return -self.eigenvalue.real / np.abs(self.eigenvalue)

    def plot(self, **options):
        """Draw the root locus; options and axes as `railsym.plots.plot_root_locus`."""
        from railsym.plots import plot_root_locus
        return plot_root_locus(self, **options)


@dataclass(frozen=True, eq=False)
class _Snapshot:
    """All modes of one part at one speed."""

    speed: float
    eigenvalue: np.ndarray
    right: np.ndarray
    left: np.ndarray

    def taken(self, order):
        return _Snapshot(self.speed, self.eigenvalue[order], self.right[:, order], self.left[:, order])


def track_modes(model: LinearModel, speeds) -> TrackedModes:
    """Follow every mode of a model over speeds.

    Parameters
    ----------
    model : LinearModel
        The linear equations.
    speeds : array_like, shape (k,)
        m/s, strictly monotone.

    Returns
    -------
    TrackedModes
        At the speeds asked for; speeds put in between serve the assignment only.

    Raises
    ------
    ModelError
        Speeds that are not strictly monotone, or whose constant-speed modes differ.
    """
    wanted = np.asarray(speeds, dtype=float)
    if wanted.ndim != 1 or len(wanted) == 0 or not (np.all(np.diff(wanted) > 0) or np.all(np.diff(wanted) < 0)):
        raise ModelError(f"speeds {speeds!r}: a strictly rising or falling sequence in m/s is needed")
    columns, similarities, labels, notes = [], [], [], []
    naming = MotionLabels(model)
    for part in split(model):
        chain, similarity, abrupt = _follow(part, wanted)
        columns.append(np.array([snapshot.eigenvalue for snapshot in chain]))
        similarities.append(similarity)
        labels += _labels(part, chain, naming)
        notes += abrupt
    return TrackedModes(wanted, np.hstack(columns), np.hstack(similarities), tuple(labels),
                        "; ".join(dict.fromkeys(notes)) or "every mode was followed", model)


def _snapshot(part: Part, speed) -> _Snapshot:
    from scipy.linalg import eig

    deflated = deflate(part.model, speed)
    value, left, right = eig(deflated.matrix, left=True, right=True, check_finite=False)
    right, left = deflated.restore(value, right, left)
    return _Snapshot(float(speed), value, right, left / (left.conj() * right).sum(axis=0).conj())


def _follow(part: Part, speeds):
    """Snapshots at the speeds, each in the order of the first, and how alike neighbours are."""
    chain, similarity, abrupt = [_snapshot(part, speeds[0])], [np.zeros((0, 0))], []
    for speed in speeds[1:]:
        following, alike, notes = _step(part, chain[-1], _snapshot(part, speed), _HALVINGS)
        chain.append(following)
        similarity.append(alike[None, :])
        abrupt += notes
    return chain, np.vstack(similarity[1:]) if len(similarity) > 1 else np.zeros((0, len(chain[0].eigenvalue))), abrupt


def _step(part, first, second, halvings):
    """The second snapshot in the order of the first; through a speed in between where shapes change too much."""
    if len(second.eigenvalue) != len(first.eigenvalue):
        raise ModelError(f"{len(first.eigenvalue)} modes at {first.speed:.4g} m/s but {len(second.eigenvalue)} at {second.speed:.4g} "
                         "m/s: uniform translation or uniform speed is not a mode at both; follow the modes in two ranges")
    order, similarity = assign(first, second)
    poor = _unlike(first, second.taken(order), similarity)
    if not poor.any():
        return second.taken(order), similarity, []
    if halvings == 0:
        value = first.eigenvalue[np.argmax(poor)]
        return second.taken(order), similarity, [f"a mode of {abs(value.imag) / (2 * np.pi):.3g} Hz changes its shape abruptly between "
                                                 f"{first.speed:.4g} and {second.speed:.4g} m/s"]
    middle, before, notes = _step(part, first, _snapshot(part, np.sqrt(first.speed * second.speed)), halvings - 1)
    second, after, more = _step(part, middle, second, halvings - 1)
    return second, before * after, notes + more


def assign(first, second):
    """Order of the second snapshot's modes that continues the first's, and the similarity of each pair.

    Returns
    -------
    order : ndarray of int
        A permutation: mode ``order[i]`` of the second continues mode i of the first.
    similarity : ndarray
        |y_i^H x'_j| |y'_j^H x_i|, at most 1.
    """
    from scipy.optimize import linear_sum_assignment

    forth = np.abs(first.left.conj().T @ second.right)
    back = np.abs(second.left.conj().T @ first.right).T
    similarity = np.minimum(forth * back, 1.0)
    size = np.abs(first.eigenvalue)[:, None] + np.abs(second.eigenvalue)
    distance = np.abs(first.eigenvalue[:, None] - second.eigenvalue) / size
    rows, order = linear_sum_assignment(distance - similarity)
    assert np.array_equal(rows, np.arange(len(order))) and np.array_equal(np.sort(order), rows), "not a permutation"
    return order, similarity[rows, order]


def _unlike(first, second, similarity):
    """Watched modes whose shape changed too much and that have no close neighbour to mix with."""
    value = first.eigenvalue
    oscillates = (value.imag != 0) & (second.eigenvalue.imag != 0)
    watched = oscillates & (-value.real < _WATCHED * np.abs(value))
    gap = np.abs(value[:, None] - value) + np.diag(np.full(len(value), np.inf))
    alone = gap.min(axis=1) > _CLOSE * np.abs(value)
    return watched & alone & (similarity < _SIMILAR)


def _labels(part: Part, chain, naming):
    """A label for each mode at the speed where it is least damped."""
    values = np.array([snapshot.eigenvalue for snapshot in chain])
    least = np.argmax(values.real / np.maximum(np.abs(values), 1e-300), axis=0)
    labels = []
    for mode, k in enumerate(least):
        snapshot = chain[k]
        value = snapshot.eigenvalue[mode]
        shape = part.expand(part.model.shape_vector(snapshot.right[:, mode], value))
        labels.append(naming.label(value, shape, snapshot.speed))
    return labels
