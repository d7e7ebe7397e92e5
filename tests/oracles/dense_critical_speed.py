# SPDX-License-Identifier: BSD-3-Clause
"""The lowest critical speed from dense eigenvalues alone: no reduction, no paths, no Newton's method.

At each speed the modes that count are found anew: all of them for the real part; for a damping ratio those between 0.3 and 20 Hz
with more than a tenth of their kinetic energy in y, yaw and roll. The vehicle becomes unstable where the number of modes below
the criterion rises, which is where the excess Re(lambda) + zeta |lambda| of the next one passes zero.
"""

import numpy as np

from railsym.linear_model import LinearModel

BAND = 2 * np.pi * np.array([0.3, 20.0])
LATERAL = 0.1
ROUNDING = 1e-7        # 1/s: dense eigenvalues of the constant-speed pair, which is +-sqrt(rounding of 1e-16) in exact arithmetic 0


class DenseModes:
    """Excess of the modes that count, speed by speed.

    Parameters
    ----------
    models : list of LinearModel
        A whole model, or both halves of a symmetric one (the antisymmetric half first).
    damping_ratio : float
    """

    def __init__(self, models: list[LinearModel], damping_ratio: float):
        self.models, self.damping_ratio = models, damping_ratio

    def excesses(self, speed) -> np.ndarray:
        """Largest first, 1/s."""
        parts = self.models if self.damping_ratio == 0.0 or len(self.models) == 1 else self.models[:1]
        values = np.concatenate([self._counting(model, speed) for model in parts])
        return np.sort(values.real + self.damping_ratio * np.abs(values))[::-1]

    def _counting(self, model, speed):
        matrix = model.state_matrix(speed)
        if self.damping_ratio == 0.0:
            values = np.linalg.eigvals(matrix)
            return values[np.abs(values) > 0.05]          # the constant-speed pair, and nothing else of a train on springs
        if len(self.models) == 2:
            values = np.linalg.eigvals(matrix)
            return values[(values.imag > BAND[0]) & (values.imag < BAND[1])]
        values, states = np.linalg.eig(matrix)
        inside = (values.imag > BAND[0]) & (values.imag < BAND[1])
        return values[inside][_lateral_share(model, states[:, inside], values[inside]) > LATERAL]

    def below(self, speed) -> int:
        """Number of modes below the criterion."""
        return int(np.count_nonzero(self.excesses(speed) > ROUNDING))

    def crosses(self, speed, before, relative) -> bool:
        """Does the mode next to ``before`` others pass the criterion within a relative distance of a speed?"""
        low, high = (self.excesses(speed * (1.0 + side * relative))[before] for side in (-1, 1))
        return bool(low < 0.0 < high)


def _lateral_share(model, states, values):
    shape = model.shape_vector(states, values)
    last = np.array([name.rpartition(".")[2] for name in model.coordinates])
    energy = np.real(shape.conj() * (model.mass @ shape)).clip(min=0.0)
    return energy[np.isin(last, ("y", "yaw", "roll"))].sum(axis=0) / energy.sum(axis=0)
