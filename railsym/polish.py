# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method on the full nonlinear eigenproblem T(lambda, V) x = 0, down to rounding.

T is singular where the scalar g of the bordered system

    [ T    b ] [ x ]   [ 0 ]
    [ c^H  0 ] [ g ] = [ 1 ]

vanishes, and dg = -y^H dT x with the solution y of the transposed system (Govaerts 2000, Numerical Methods for Bifurcations of
Dynamical Equilibria, ch. 3): one LU factorisation a step gives g and all its derivatives. At a critical speed lambda lies on
the ray of one damping ratio zeta, lambda = omega (-zeta + i sqrt(1 - zeta^2)), so omega and V are the two real unknowns of the
complex equation g = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from railsym.errors import ConvergenceError
from railsym.linear_model import LinearModel

_STEP = 1e-7           # relative step after which Newton's quadratic convergence leaves rounding only
_MOST_STEPS = 25
_LONGEST = 0.25        # largest relative change of V or omega in one step


@dataclass(frozen=True, eq=False)
class EigenPoint:
    """An eigenvalue with its vectors at a speed.

    Attributes
    ----------
    speed : float
        m/s.
    eigenvalue : complex
        1/s.
    right, left : ndarray, shape (n,)
        T x = 0 and y^H T = 0, scaled to y^H (dT/dlambda) x = 1.
    slope : complex
        d(eigenvalue)/dV, 1/m.
    residual : float
        Largest of |T x| / (|T| |x|), row by row.
    steps : int
        Newton steps taken.
    """

    speed: float
    eigenvalue: complex
    right: np.ndarray
    left: np.ndarray
    slope: complex
    residual: float
    steps: int


def polish_crossing(model: LinearModel, speed, eigenvalue, right, left, damping_ratio=0.0) -> EigenPoint:
    """The speed at which an eigenvalue has a given damping ratio.

    Parameters
    ----------
    model : LinearModel
        The full model or one half of a symmetric one.
    speed : float
        Estimate, m/s.
    eigenvalue : complex
        Estimate with positive imaginary part, 1/s.
    right, left : ndarray, shape (n,)
        Estimates of the vectors.
    damping_ratio : float
        zeta; 0 asks for a real part of zero.

    Returns
    -------
    EigenPoint
        With an eigenvalue whose damping ratio is zeta to rounding.

    Raises
    ------
    ConvergenceError
        No convergence in 25 steps, or a speed or frequency that left the positive numbers.
    """
    ray = -damping_ratio + 1j * np.sqrt(1.0 - damping_ratio**2)
    bordered = _Bordered(model, eigenvalue, speed, right, left)
    unknown = np.array([abs(eigenvalue), speed])
    for step in range(1, _MOST_STEPS + 1):
        omega, speed = unknown
        value, by_eigenvalue, by_speed = bordered.solve(omega * ray, speed)
        derivative = np.array([[(by_eigenvalue * ray).real, by_speed.real], [(by_eigenvalue * ray).imag, by_speed.imag]])
        unknown, change = _advanced(unknown, derivative, value, partial(_failed, "crossing", step, speed, omega * ray))
        if change < _STEP:
            return bordered.point(unknown[0] * ray, float(unknown[1]), step)
    raise _failed("crossing", step, speed, omega * ray)


def polish_eigenvalue(model: LinearModel, speed, eigenvalue, right, left) -> EigenPoint:
    """An eigenvalue at a fixed speed; arguments and errors as `polish_crossing`."""
    bordered = _Bordered(model, eigenvalue, speed, right, left)
    for step in range(1, _MOST_STEPS + 1):
        value, by_eigenvalue, _ = bordered.solve(eigenvalue, speed)
        move = -value / by_eigenvalue
        if not np.isfinite(move):
            break
        move *= min(1.0, _LONGEST * abs(eigenvalue) / max(abs(move), 1e-300))
        eigenvalue = eigenvalue + move
        if abs(move) < _STEP * abs(eigenvalue):
            return bordered.point(eigenvalue, speed, step)
    raise _failed("eigenvalue", step, speed, eigenvalue)


def _advanced(unknown, derivative, value, failed):
    """One damped Newton step in (omega, V), and its relative length."""
    # both unknowns in units of themselves: the 2 x 2 system is then well scaled, and Cramer's rule as good as any
    (a, b), (c, d) = (derivative * unknown).tolist()
    determinant = a * d - b * c
    if determinant == 0.0:
        raise failed()
    change = np.array([b * value.imag - d * value.real, c * value.real - a * value.imag]) / determinant
    length = float(np.abs(change).max())
    if not np.isfinite(length):
        raise failed()
    return unknown * (1.0 + change * min(1.0, _LONGEST / max(length, 1e-300))), length


def _failed(what, steps, speed, eigenvalue):
    return ConvergenceError(f"Newton's method for the {what} near {speed:.4g} m/s, eigenvalue {eigenvalue:.5g} 1/s did not converge "
                            f"in {steps} steps; scan the speeds in smaller steps")


class _Bordered:
    """The bordered system in coordinates scaled to like size, with borders that follow the vectors.

    Of the matrices only the entries that are not zero are kept, each as its share in M, C0, C1, C2 and K.
    """

    def __init__(self, model: LinearModel, eigenvalue, speed, right, left):
        self.row, self.column, entries = model.entries
        self.place = self.row + (model.size + 1) * self.column      # in the bordered matrix, column after column
        diagonal = self.row == self.column
        stiff = np.zeros(model.size)
        stiff[self.row[diagonal]] = np.abs(_combined(_factors(eigenvalue, speed), entries[:, diagonal]))
        scale = 1.0 / np.sqrt(np.where(stiff > 0, stiff, 1.0))
        self.entries = entries * (scale[self.row] * scale[self.column])
        self.scale, self.right, self.left = scale, _unit(right / scale), _unit(left / scale)

    def solve(self, eigenvalue, speed):
        """g, dg/dlambda and dg/dV; keeps the vectors and the factors."""
        from scipy.linalg.lapack import zgetrf

        n = len(self.scale)
        values = np.zeros((n + 1) ** 2, dtype=complex)
        values[self.place] = _combined(_factors(eigenvalue, speed), self.entries)
        matrix = values.reshape(n + 1, n + 1).T
        matrix[:n, n], matrix[n, :n] = self.left, self.right.conj()
        *self.factors, status = zgetrf(matrix, overwrite_a=True)
        if status:
            raise _failed("eigenvalue", 0, speed, eigenvalue)
        last = np.zeros(n + 1, dtype=complex)
        last[n] = 1.0
        solution, adjoint = self._back(last, 0), self._back(last, 2)
        x, y = solution[:n], adjoint[:n]
        self.right, self.left = _unit(x), _unit(y)
        return solution[n], *self._slopes(eigenvalue, speed, x, y)

    def _back(self, side, transposed):
        """Solution of the factorised system, or of its conjugate transpose (2)."""
        from scipy.linalg.lapack import zgetrs

        return zgetrs(*self.factors, side, trans=transposed)[0]

    def _slopes(self, eigenvalue, speed, x, y):
        """-y^H (dT/dlambda) x and -y^H (dT/dV) x."""
        terms = (y.conj()[self.row] * x[self.column]).view(float).reshape(-1, 2)
        inertia, constant, with_speed, with_inverse_speed, _ = (self.entries @ terms).view(complex)[:, 0]
        by_eigenvalue = 2 * eigenvalue * inertia + constant + speed * with_speed + with_inverse_speed / speed
        return -by_eigenvalue, -eigenvalue * (with_speed - with_inverse_speed / speed**2)

    def point(self, eigenvalue, speed, steps) -> EigenPoint:
        """The converged point, its vectors scaled to y^H T' x = 1.

        The vectors belong to the point before the last step: one correction with the factors of that point leaves an error of the
        order of the step squared, which is rounding.
        """
        entries = _combined(_factors(eigenvalue, speed), self.entries)
        x = self._corrected(self.right, entries, self.row, self.column, 0)
        y = self._corrected(self.left, entries.conj(), self.column, self.row, 2)
        by_eigenvalue, by_speed = self._slopes(eigenvalue, speed, x, y)
        size = np.bincount(self.row, np.abs(entries) * np.abs(x)[self.column], len(x))
        residual = (np.abs(self._product(entries, x, self.row, self.column)) / np.maximum(size, 1e-300)).max()
        return EigenPoint(speed, complex(eigenvalue), self.scale * x, self.scale * y / -by_eigenvalue.conj(),
                          complex(-by_speed / by_eigenvalue), float(residual), steps)

    @staticmethod
    def _product(entries, vector, row, column):
        terms = entries * vector[column]
        return np.bincount(row, terms.real, len(vector)) + 1j * np.bincount(row, terms.imag, len(vector))

    def _corrected(self, vector, entries, row, column, transposed):
        force = np.append(self._product(entries, vector, row, column), 0.0)
        return _unit(vector - self._back(force, transposed)[:-1])


def _factors(eigenvalue, speed):
    """Factors of M, C0, C1, C2 and K in T(lambda, V)."""
    return np.array([eigenvalue**2, eigenvalue, eigenvalue * speed, eigenvalue / speed, 1.0])


def _combined(factors, entries):
    """Complex factors (5,) times real entries (5, k), without a complex copy of the entries."""
    real, imaginary = np.array([factors.real, factors.imag]) @ entries
    return real + 1j * imaginary


def _unit(vector):
    return vector / np.linalg.norm(vector)
