# SPDX-License-Identifier: BSD-3-Clause
"""Linear critical speed of the non-linear model: where a pair of eigenvalues about steady rolling crosses the imaginary axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_SLOWEST = 0.5    # rad/s, of a pair that counts as an oscillation
_XTOL = 1e-9      # m/s


@dataclass(frozen=True, eq=False)
class Hopf:
    """A speed at which steady rolling loses or regains stability.

    Attributes
    ----------
    speed : float
        m/s
    frequency : float
        rad/s
    equilibrium : ndarray (size,)
    shape : ndarray (size,), complex
        Eigenvector of +i frequency, largest lateral displacement of a wheelset 1 m and real.
    rising : bool
        True where it becomes unstable with speed.
    """

    speed: float
    frequency: float
    equilibrium: np.ndarray
    shape: np.ndarray
    rising: bool

    @property
    def frequency_hz(self):
        """Hz"""
        return self.frequency / (2.0 * np.pi)


class Stability:
    """Growth rates of small motions about steady rolling, the equilibrium followed from speed to speed."""

    def __init__(self, system):
        self.system, self._guess = system, None

    def growth(self, speed):
        """Largest real part (1/s) of the oscillations at a speed (m/s)."""
        self._guess = self.system.equilibrium(speed, self._guess)
        values = np.linalg.eigvals(self.system.state_matrix(self._guess))
        return float(values.real[values.imag > _SLOWEST].max())

    def crossings(self, speeds):
        """`Hopf` points between increasing speeds (m/s) on whose two sides the stability differs."""
        from scipy.optimize import brentq

        growth = [self.growth(speed) for speed in speeds]
        found = []
        for k in np.flatnonzero(np.diff(np.sign(growth))):
            speed = brentq(self.growth, speeds[k], speeds[k + 1], xtol=_XTOL)
            found.append(self._point(speed, growth[k] < growth[k + 1]))
        return found, np.array(growth)

    def _point(self, speed, rising):
        z = self.system.equilibrium(speed, self._guess)
        values, vectors = np.linalg.eig(self.system.state_matrix(z))
        oscillating = np.flatnonzero(values.imag > _SLOWEST)
        k = oscillating[np.argmax(values.real[oscillating])]
        shape = vectors[:, k]
        lateral = shape[self.system.lateral]
        return Hopf(float(speed), float(values[k].imag), z, shape / lateral[np.argmax(np.abs(lateral))], bool(rising))
