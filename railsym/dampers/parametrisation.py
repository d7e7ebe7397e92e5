# SPDX-License-Identifier: BSD-3-Clause
"""Unknowns of a fit: logarithms of constants, rises of curves (so that curves are monotone), lags in ms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.dampers.models import DamperModel

_LEAST_RISE = 1e-5   # of the greatest force: a flat curve has no inverse
_LAG_UNIT = 1e-3     # s


@dataclass(frozen=True, eq=False)
class Parametrisation:
    """What is fitted.

    Attributes
    ----------
    kind : str
    damping_nodes, stiffness_nodes : ndarray or None
        m/s; None for a constant.
    top_force : float
        N, unit of the damping curve's rises.
    rising : bool
        Direction of the stiffness curve.
    lags : int
        Lags at the end of the vector: 0, 1 (common) or one a test.
    """

    kind: str
    damping_nodes: np.ndarray | None
    stiffness_nodes: np.ndarray | None
    top_force: float
    rising: bool = True
    lags: int = 1
    lag_unit = _LAG_UNIT

    @property
    def sizes(self):
        """Unknowns of damping, stiffness, lag."""
        stiffness = 0 if self.kind == "viscous" else 1 if self.stiffness_nodes is None else len(self.stiffness_nodes)
        return 1 if self.damping_nodes is None else len(self.damping_nodes) - 1, stiffness, self.lags

    @property
    def names(self):
        """Name of each unknown."""
        d, k, lags = self.sizes
        damping = ["damping"] if self.damping_nodes is None else [f"damping_curve[{i}]" for i in range(d)]
        stiffness = ["series_stiffness"] if self.stiffness_nodes is None else [f"series_stiffness_curve[{i}]" for i in range(k)]
        return [*damping, *stiffness[:k], *(["lag"] if lags == 1 else [f"lag[{i}]" for i in range(lags)])]

    def split(self, x):
        """Parts of the vector: damping, stiffness, lag."""
        d, k, _ = self.sizes
        return x[:d], x[d:d + k], x[d + k:]

    def lag(self, x):
        """s, one or one a test."""
        return _LAG_UNIT * self.split(x)[2] if self.lags else np.zeros(1)

    def model(self, x, origin=""):
        """The damper of a vector."""
        damping, stiffness, _ = self.split(x)
        given = {"damping": float(np.exp(damping[0]))} if self.damping_nodes is None else {"damping_curve": (self.damping_nodes, self.forces(damping))}
        if self.kind == "maxwell" and self.stiffness_nodes is None:
            given["series_stiffness"] = float(np.exp(stiffness[0]))
        elif self.kind == "maxwell":
            given["series_stiffness_curve"] = (self.stiffness_nodes, self.stiffnesses(stiffness))
        return DamperModel(self.kind, origin=origin, **given)

    def forces(self, rises):
        """N at the nodes of the damping curve."""
        force = np.concatenate([[0.0], np.cumsum(rises)]) * self.top_force
        return force - force[int(np.argmin(np.abs(self.damping_nodes)))]

    def stiffnesses(self, x):
        """N/m at the nodes of the stiffness curve."""
        return np.exp(x[0] + (1.0 if self.rising else -1.0) * np.concatenate([[0.0], np.cumsum(x[1:])]))

    def vector(self, damping, stiffness=(), lag=()):
        """Vector of a constant or curve of forces (N), a constant or curve of stiffnesses (N/m), lags (s)."""
        if self.damping_nodes is None:
            first = np.log(np.atleast_1d(damping))
        else:
            first = np.maximum(np.diff(damping) / self.top_force, 2.0 * _LEAST_RISE)
        second = np.log(np.atleast_1d(stiffness)) if self.kind == "maxwell" else np.zeros(0)
        if second.size > 1:
            second[1:] = np.maximum(np.diff(second) * (1.0 if self.rising else -1.0), 1e-3)
        return np.concatenate([first, second, np.broadcast_to(np.atleast_1d(lag) / _LAG_UNIT, (self.lags,)) if self.lags else []])

    def bounds(self, given=None, largest_lag=0.02):
        """Lower and upper bounds; ``given`` maps "damping", "series_stiffness", "lag" to pairs in SI (of constants)."""
        given = given or {}
        d, k, lags = self.sizes
        if self.damping_nodes is None:
            low, high = [[limit] for limit in np.log(given.get("damping", (1e2, 1e9)))]
        else:
            low, high = [_LEAST_RISE] * d, [10.0] * d
        if k:
            limits = np.log(given.get("series_stiffness", (1e4, 1e10)))
            low, high = [*low, limits[0], *[0.0] * (k - 1)], [*high, limits[1], *[4.0] * (k - 1)]
        limits = np.array(given.get("lag", (-largest_lag, largest_lag))) / _LAG_UNIT
        return np.array([*low, *[limits[0]] * lags], dtype=float), np.array([*high, *[limits[1]] * lags], dtype=float)


def stiffness_nodes(velocity):
    """Speeds (m/s) for a stiffness curve."""
    return np.abs(velocity).max() * np.array([0.0, 0.05, 0.12, 0.24, 0.42, 0.68, 1.0])
