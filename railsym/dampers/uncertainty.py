# SPDX-License-Identifier: BSD-3-Clause
"""Confidence intervals and identifiability from the Jacobian of a least-squares fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_ILL = 1e6       # condition of the scaled Jacobian
_ALIKE = 0.98    # correlation of two estimates above which the tests hardly tell them apart
_NEAR = 0.02


@dataclass(frozen=True, eq=False)
class Identifiability:
    """How well the tests tell the parameters apart.

    Attributes
    ----------
    condition : float
        Of the Jacobian with columns of length one.
    correlation : ndarray (p, p)
    names : tuple of str
    warnings : tuple of str
    """

    condition: float
    correlation: np.ndarray
    names: tuple[str, ...]
    warnings: tuple[str, ...]


def covariance(jacobian, deviation, misfit):
    """Covariance of the unknowns of an unweighted fit.

    Parameters
    ----------
    jacobian : ndarray (n, p)
        Of the misfit and, below, of the wish for smooth curves.
    deviation : ndarray (m,)
        Standard deviation of each entry of the misfit by noise; the rows below have the mean one.
    misfit : ndarray (m,)
        What is left: where it is more than the noise says, all deviations are larger by that.

    Notes
    -----
    P J' V J P with P = (J'J)^-1 and V the variances: entries of coloured noise differ, and an interval by the mean variance alone would
    be too narrow for constants, which hang on the first harmonics.
    """
    excess = max(1.0, float(np.sqrt(misfit @ misfit / (deviation @ deviation))))
    all_rows = np.concatenate([deviation, np.full(len(jacobian) - len(deviation), np.sqrt(np.mean(deviation**2)))]) * excess
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    moved = inverse @ (jacobian * all_rows[:, None]).T
    return moved @ moved.T


def estimated_weights(cycles):
    """Factor on a covariance whose weights come from as many cycles of each test (Meier 1953, Biometrics 9, 59-73, for equal weights).

    Weights prefer tests whose noise happens to look small. The first harmonic's variance, a line through three orders, has 2.4
    degrees of freedom for each cycle but the first.
    """
    freedom = 2.4 * (np.asarray(cycles, dtype=float) - 1.0)
    return 1.0 + 4.0 * (1.0 - 1.0 / freedom.size) * float(np.mean(1.0 / freedom))


def intervals(parametrisation, x, spread, freedom):
    """Name -> (low, high), 95 %: constants in SI; curves as pairs of arrays at their nodes."""
    from scipy.stats import t

    factor = t.ppf(0.975, max(freedom, 1))
    d, k, lags = parametrisation.sizes
    deviation = factor * np.sqrt(np.maximum(np.diag(spread), 0.0))
    found = {}
    if parametrisation.damping_nodes is None:
        found["damping"] = _by_inverse(x[0], deviation[0])
    else:
        zero = int(np.argmin(np.abs(parametrisation.damping_nodes)))
        sums = np.tril(np.ones((d + 1, d)), -1)
        found["damping_curve"] = _band(sums - sums[zero], parametrisation.top_force * x[:d], parametrisation.top_force**2 * spread[:d, :d], factor)
    if k == 1:
        found["series_stiffness"] = _by_inverse(x[d], deviation[d])
    elif k:
        sums = np.tril(np.ones((k, k)))
        sums[:, 1:] *= 1.0 if parametrisation.rising else -1.0
        low, high = _band(sums, x[d:d + k], spread[d:d + k, d:d + k], factor)
        found["series_stiffness_curve"] = np.exp(np.clip(low, -700, 700)), np.exp(np.clip(high, -700, 700))
    if lags == 1:
        found["lag"] = tuple(1e-3 * float(x[-1] + s * deviation[-1]) for s in (-1, 1))
    return found


def _by_inverse(logarithm, deviation):
    """Interval of a constant through that of its inverse, in which the elongation is linear; up to inf where noise can do without it."""
    value = float(np.exp(logarithm))
    return value / (1.0 + deviation), value / (1.0 - deviation) if deviation < 1.0 else np.inf


def _band(combine, x, spread, factor):
    middle = combine @ x
    half = factor * np.sqrt(np.maximum(np.diag(combine @ spread @ combine.T), 0.0))
    return middle - half, middle + half


def identifiability(parametrisation, x, jacobian, spread, bounds, confidence):
    """Condition, correlations, and warnings in words."""
    names = parametrisation.names
    length = np.linalg.norm(jacobian, axis=0)
    scaled = jacobian / np.where(length > 0.0, length, 1.0)
    values = np.linalg.svd(scaled, compute_uv=False)
    condition = float(values[0] / values[-1]) if values[-1] > 0.0 else np.inf
    size = np.sqrt(np.maximum(np.diag(spread), 1e-300))
    correlation = spread / np.outer(size, size)
    said = []
    if condition > _ILL or (length <= 0.0).any():
        said.append(f"the tests do not tell all parameters apart (condition {condition:.1e})")
    d, k, lags = parametrisation.sizes
    constants = ([0] if d == 1 else []) + ([d] if k == 1 else []) + ([d + k] if lags == 1 else [])
    for place, i in enumerate(constants):
        for j in constants[place + 1:]:
            if abs(correlation[i, j]) > _ALIKE and max(size[i] / _unit(names[i]), size[j] / _unit(names[j])) > _NEAR:
                said.append(f"{names[i]} and {names[j]} are hardly told apart by these tests (correlation {correlation[i, j]:+.3f}); "
                            "add tests of higher or lower frequency")
    for i in constants:
        if not bounds[0][i] + 1e-3 < x[i] < bounds[1][i] - 1e-3:
            said.append(f"{names[i]} is at its bound")
        elif names[i] != "lag" and 1.96 * size[i] > 0.2:
            said.append(f"{names[i]} is known to no better than {100 * 1.96 * size[i]:.0f} %")
    return Identifiability(condition, correlation, tuple(names), (*said, *_loose_curves(confidence)))


def _loose_curves(confidence):
    """Messages for curves whose intervals are wide: the damping curve beside its peak, the stiffness beside itself."""
    said = []
    for name, limit, of in (("damping_curve", 0.03, "of its peak force"), ("series_stiffness_curve", 0.2, "somewhere")):
        if name in confidence:
            low, high = confidence[name]
            middle = np.abs(0.5 * (low + high))
            width = float(np.max(0.5 * (high - low) / (middle.max() if name == "damping_curve" else middle)))
            if width > limit:
                said.append(f"{name} is known to no better than {100 * width:.0f} % {of}")
    return said


def _unit(name):
    return 20.0 if name == "lag" else 1.0
