# SPDX-License-Identifier: BSD-3-Clause
"""Piecewise polynomials of arc length, each piece over its own x = (s - start)/length in 0..1."""

from dataclasses import dataclass
from math import comb

import numpy as np

POWERS = 8      # up to degree 7, as RS_TRACK_POWERS
_SAME_JOINT = 1e-9      # m, joints nearer than this are one: sums of lengths differ in rounding


@dataclass(frozen=True, eq=False)
class PiecewisePolynomial:
    """f(s) = sum_k c[i, k] x^k between joints i and i + 1.

    Attributes
    ----------
    joints : ndarray, shape (n + 1,)
    coefficients : ndarray, shape (n, POWERS)
    """

    joints: np.ndarray
    coefficients: np.ndarray

    @classmethod
    def of(cls, joints, rows):
        """From joints and coefficients of any degree up to 7."""
        coefficients = np.zeros((len(rows), POWERS))
        for to, row in zip(coefficients, rows, strict=True):
            to[:len(row)] = row
        return cls(np.array(joints, dtype=float), coefficients)

    @classmethod
    def two_point_taylor(cls, joints, derivatives):
        """Degree 7: value and three derivatives, ``derivatives(x)`` -> 4 arrays, are met at each joint."""
        joints = np.asarray(joints, dtype=float)
        scaled = np.array(derivatives(joints)).T
        rows = [hermite(scaled[i], scaled[i + 1], joints[i + 1] - joints[i]) for i in range(len(joints) - 1)]
        return cls.of(joints, rows)

    def stretched(self, start, length, low, high):
        """low + (high - low) f over start..start + length, for an f on 0..1."""
        coefficients = (high - low) * self.coefficients
        coefficients[:, 0] += low
        joints = start + length * self.joints
        return PiecewisePolynomial(joints, coefficients)

    def index(self, s):
        """Piece of each s; at a joint the one behind it."""
        return np.clip(np.searchsorted(self.joints, s, side="right") - 1, 0, len(self.coefficients) - 1)

    def __call__(self, s, derivative=0):
        """Value or derivative at s."""
        s = np.asarray(s, dtype=float)
        return self.at(self.index(s), s, derivative)

    def at(self, piece, s, derivative=0):
        """Value or derivative at s by the polynomial of the given piece."""
        length = self.joints[piece + 1] - self.joints[piece]
        x = (s - self.joints[piece]) / length
        total = np.zeros_like(x)
        for k in range(POWERS - 1, derivative - 1, -1):
            falling = np.prod(np.arange(k - derivative + 1, k + 1, dtype=float))
            total = total * x + falling * self.coefficients[piece, k]
        return total / length**derivative

    def jumps(self, derivative):
        """Step of a derivative at each inner joint, shape (n - 1,)."""
        inner, left = self.joints[1:-1], np.arange(len(self.coefficients) - 1)
        return self.at(left + 1, inner, derivative) - self.at(left, inner, derivative)

    def steps(self, derivatives):
        """Inner joints where one of the derivatives steps by more than rounding."""
        found = np.zeros(len(self.joints) - 2, dtype=bool)
        piece, length = np.arange(len(self.coefficients)), np.diff(self.joints)
        for order in derivatives:
            scale = max(np.abs(self.at(piece, self.joints[:-1] + part * length, order)).max() for part in (0.0, 0.3, 0.7, 1.0))
            found |= np.abs(self.jumps(order)) > 1e-7 * scale
        return self.joints[1:-1][found]

    def on(self, joints):
        """Coefficients of the same function over other joints that include its own, in powers of -1 <= x <= 1.

        Returns
        -------
        ndarray, shape (len(joints) - 1, POWERS)
        """
        return self._over(0.5 * (joints[1:] + joints[:-1]), 0.5 * np.diff(joints), 0.5 * (joints[1:] + joints[:-1]))

    def _over(self, origin, unit, inside):
        """Coefficients in powers of x = (s - origin)/unit of the pieces that hold the places ``inside``."""
        piece = self.index(inside)
        length = self.joints[piece + 1] - self.joints[piece]
        return _composed(self.coefficients[piece], (origin - self.joints[piece]) / length, unit / length)

    def replaced(self, start, end):
        """The same with a polynomial of degree 5 from start to end that meets value and two derivatives there."""
        left, right = self.index(start), np.clip(np.searchsorted(self.joints, end, side="left") - 1, 0, None)
        ends = [[float(self.at(piece, np.float64(s), order)) for order in range(3)] for piece, s in ((left, start), (right, end))]
        before, after = self.joints < start - _SAME_JOINT, self.joints > end + _SAME_JOINT
        joints = np.concatenate([self.joints[before], [start, end], self.joints[after]])
        coefficients = self._over(joints[:-1], np.diff(joints), 0.5 * (joints[1:] + joints[:-1]))
        coefficients[np.searchsorted(joints, start)] = np.concatenate([hermite(*ends, end - start), [0.0] * (POWERS - 6)])
        return PiecewisePolynomial(joints, coefficients)


def joined(parts):
    """One function of consecutive ones."""
    joints = np.concatenate([part.joints[:-1] for part in parts] + [parts[-1].joints[-1:]])
    return PiecewisePolynomial(joints, np.concatenate([part.coefficients for part in parts]))


def common_joints(functions, longest):
    """Joints of several functions together, and more so that no piece is longer than ``longest`` (m)."""
    merged = np.unique(np.concatenate([f.joints for f in functions]))
    merged = merged[np.concatenate([[True], np.diff(merged) > _SAME_JOINT])]
    parts = [np.linspace(a, b, int(np.ceil((b - a) / longest)) + 1)[:-1] for a, b in zip(merged[:-1], merged[1:], strict=True)]
    return np.concatenate([*parts, merged[-1:]])


def hermite(left, right, length):
    """Coefficients over 0..1 that meet as many derivatives (by s) as are given at both ends of a piece of that length."""
    count = len(left)
    scale = length ** np.arange(count)
    matrix, target = np.zeros((2 * count, 2 * count)), np.concatenate([scale * left, scale * right])
    for order in range(count):
        matrix[order, order] = np.prod(np.arange(1, order + 1, dtype=float))
        for k in range(order, 2 * count):
            matrix[count + order, k] = np.prod(np.arange(k - order + 1, k + 1, dtype=float))
    return np.linalg.solve(matrix, target)


def _composed(rows, shift, scale):
    """Coefficients of p(shift + scale x) for rows of coefficients of p; constants stay bit for bit."""
    shift, scale = (np.broadcast_to(np.asarray(part, dtype=float), len(rows)) for part in (shift, scale))
    out = np.zeros_like(rows)
    for k in range(rows.shape[1]):
        for j in range(k + 1):
            out[:, j] += rows[:, k] * comb(k, j) * shift ** (k - j) * scale**j
    return out
