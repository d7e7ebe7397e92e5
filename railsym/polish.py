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
    # both unknowns in units of themselves: the 2 x 2 system is then well scaled
    scaled = derivative * unknown
    try:
        change = np.linalg.solve(scaled, [-value.real, -value.imag])
    except np.linalg.LinAlgError:
        raise failed() from None
    length = float(np.abs(change).max())
    if not np.isfinite(length):
        raise failed()
    return unknown * (1.0 + change * min(1.0, _LONGEST / max(length, 1e-300))), length


def _failed(what, steps, speed, eigenvalue):
    return ConvergenceError(f"Newton's method for the {what} near {speed:.4g} m/s, eigenvalue {eigenvalue:.5g} 1/s did not converge "
                            f"in {steps} steps; scan the speeds in smaller steps")


class _Bordered:
    """The bordered system in coordinates scaled to like size, with borders that follow the vectors."""

    def __init__(self, model: LinearModel, eigenvalue, speed, right, left):
        self.model = model
        stiff = np.abs(eigenvalue**2 * model.mass.diagonal() + eigenvalue * model.damping(speed).diagonal()
                       + model.stiffness.diagonal())
        self.scale = 1.0 / np.sqrt(np.where(stiff > 0, stiff, 1.0))
        both = self.scale[:, None] * self.scale
        self.mass, self.stiffness = model.mass * both, model.stiffness * both
        self.constant, self.with_speed = model.damping_constant * both, model.damping_speed * both
        self.with_inverse_speed = model.damping_inverse_speed * both
        self.right, self.left = _unit(right / self.scale), _unit(left / self.scale)

    def solve(self, eigenvalue, speed):
        """g, dg/dlambda and dg/dV; keeps the vectors."""
        from scipy.linalg.lapack import zgetrf, zgetrs

        n, square = self.model.size, eigenvalue**2
        damping = self.constant + speed * self.with_speed + self.with_inverse_speed / speed
        matrix = np.zeros((n + 1, n + 1), dtype=complex, order="F")
        matrix.real[:n, :n] = square.real * self.mass + eigenvalue.real * damping + self.stiffness
        matrix.imag[:n, :n] = square.imag * self.mass + eigenvalue.imag * damping
        matrix[:n, n], matrix[n, :n] = self.left, self.right.conj()
        factors, pivots, status = zgetrf(matrix, overwrite_a=True)
        if status:
            raise _failed("eigenvalue", 0, speed, eigenvalue)
        last = np.zeros(n + 1, dtype=complex)
        last[n] = 1.0
        solution, adjoint = (zgetrs(factors, pivots, last, trans=transposed)[0] for transposed in (0, 2))
        x, y = solution[:n], adjoint[:n]
        self.right, self.left = _unit(x), _unit(y)
        by_eigenvalue = -(y.conj() @ (2 * eigenvalue * (self.mass @ x) + damping @ x))
        by_speed = -eigenvalue * (y.conj() @ (self.with_speed @ x - self.with_inverse_speed @ x / speed**2))
        return solution[n], by_eigenvalue, by_speed

    def point(self, eigenvalue, speed, steps) -> EigenPoint:
        """The converged point, its vectors scaled to y^H T' x = 1."""
        _, by_eigenvalue, by_speed = self.solve(eigenvalue, speed)
        x, y = self.scale * self.right, self.scale * self.left
        matrix = self.model.dynamic_stiffness(eigenvalue, speed)
        residual = (np.abs(matrix @ x) / np.maximum(np.abs(matrix) @ np.abs(x), 1e-300)).max()
        norm = y.conj() @ (self.model.dynamic_stiffness_slope(eigenvalue, speed) @ x)
        return EigenPoint(speed, complex(eigenvalue), x, y / norm.conj(), complex(-by_speed / by_eigenvalue), float(residual), steps)


def _unit(vector):
    return vector / np.linalg.norm(vector)
