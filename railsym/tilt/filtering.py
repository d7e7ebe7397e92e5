# SPDX-License-Identifier: BSD-3-Clause
"""Low-pass filter of second order, sample by sample (transposed direct form II)."""


class LowPass:
    """y = b0 x + z1;  z1 = b1 x - a1 y + z2;  z2 = b2 x - a2 y.

    Parameters
    ----------
    coefficients : (float, float, float, float, float)
        b0 b1 b2 a1 a2
    """

    def __init__(self, coefficients):
        self.b0, self.b1, self.b2, self.a1, self.a2 = coefficients
        self.z1 = self.z2 = 0.0

    def step(self, x):
        """The next output."""
        y = self.b0 * x + self.z1
        self.z1 = self.b1 * x - self.a1 * y + self.z2
        self.z2 = self.b2 * x - self.a2 * y
        return y
