# SPDX-License-Identifier: BSD-3-Clause
"""Random instances of the kernels: parameters, and coordinates with large angles."""

from dataclasses import dataclass, replace

import numpy as np

from railsym._core import kernels

# Step of the complex step: its square vanishes beside every number, so the only error is roundoff.
STEP = 1e-30

# Table of a curve through the origin: breakpoints and cubic pieces with a kink in the second derivative.
CURVE = (np.array([-0.4, -0.1, 0.2, 0.5]),
         np.array([[-1.1, 2.0, 1.5, -0.5], [-0.4, 3.0, 0.5, 2.0], [0.6, 2.5, -1.0, 0.7]]))
# As CURVE over a magnitude, which is never negative.
HALF_CURVE = (np.array([0.0, 0.3, 0.6]), np.array([[0.0, 1.0, 0.5, 0.4], [0.36, 2.0, -0.3, 0.8]]))


def random_rotation(rng):
    """A proper rotation matrix, uniformly distributed in effect."""
    matrix = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return matrix * np.linalg.det(matrix)


@dataclass(frozen=True)
class Instance:
    """One kernel with parameters in their slots and coordinates beside them."""

    name: str
    parameters: np.ndarray
    q: np.ndarray
    u: np.ndarray
    a: np.ndarray

    @property
    def kernel(self):
        return kernels()[self.name]

    def get(self, key, size=1):
        """The parameters in ``size`` slots from the one named ``key``; a scalar for one."""
        start = self.kernel.inputs.index(key)
        return self.parameters[start] if size == 1 else self.parameters[start:start + size]

    def matrix(self, key):
        return self.get(f"{key}00", 9).reshape(3, 3)

    def having(self, **changes):
        """The instance with other parameters (a vector or matrix fills its slots) or coordinates."""
        coordinates = {key: changes.pop(key) for key in "qua" if key in changes}
        parameters = self.parameters.copy()
        for key, value in changes.items():
            parameters[_slots(self.kernel, key, np.size(value))] = np.ravel(value)
        return replace(self, parameters=parameters, **coordinates)

    def inputs(self, dq=0.0, du=0.0, da=0.0):
        """Kernel inputs, coordinates moved by dq, du, da (which may be imaginary) in all their slots."""
        q, u, a = self.q + dq, self.u + du, self.a + da
        packed = self.parameters.astype(np.result_type(q, u, a))
        for part, values in enumerate((q, u, a, np.sin(q), np.cos(q))):
            slots = self.kernel.slots[:, part]
            packed[slots[slots >= 0]] = values[slots >= 0]
        return packed


def _slots(kernel, key, size):
    tail = {1: "", 3: "0", 6: "0", 9: "00"}[size]
    start = kernel.inputs.index(key + tail)
    return slice(start, start + size)


def random_instance(name, rng):
    """Every number of magnitude 0.5 to 1.5, so that no term hides; angles up to the full turn, roll below 1.2 rad.

    Rotation matrices are rotations. The speed of the wheel-rail kernel and its lengths are positive.
    """
    kernel = kernels()[name]
    size = len(kernel.inputs)
    parameters = rng.uniform(0.5, 1.5, size) * rng.choice([-1.0, 1.0], size)
    q, u, a = (rng.uniform(0.5, 1.5, kernel.coordinates) * rng.choice([-1.0, 1.0], kernel.coordinates)
               for _ in range(3))
    angle = kernel.slots[:, 3] >= 0
    q[angle] = rng.uniform(-1.2, 1.2, angle.sum())  # roll at +-pi/2 is where yaw and pitch are one
    yaw = np.array([k for k in (3, 9) if k < kernel.coordinates])
    q[yaw] *= 2.5
    instance = Instance(name, parameters, q, u, a)
    rotations = {key: random_rotation(rng) for key in ("C", "A1_", "A2_") if f"{key}00" in kernel.inputs}
    positive = {key: abs(instance.get(key)) for key in ("V", "b0", "r0") if key in kernel.inputs}
    return instance.having(**rotations, **positive)
