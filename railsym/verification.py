# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds against the dense eigenvalues of the whole model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym.constant_speed import deflate
from railsym.errors import ConvergenceError
from railsym.linear_model import LinearModel
from railsym.speed_scan import excess
from railsym.stability import Stability

_BETWEEN = 5           # dense eigenproblems between two neighbouring crossings
_AGREE = 1e-6          # relative; dense eigenvalues of well separated modes are good to about 1e-10
_UNSTABLE = 1e-8       # Re / |lambda| that dense rounding does not reach


def dense_eigenvalues(model: LinearModel, speed) -> np.ndarray:
    """All eigenvalues at a speed in m/s, 1/s, uniform translation and uniform speed taken out."""
    return np.linalg.eigvals(deflate(model, speed).matrix)


def verify_stability(model: LinearModel, result: Stability, speed_range, lowest_only: bool = False) -> Stability:
    """Check a result, and say so in its message.

    Every crossing must be a dense eigenvalue of the whole model at its speed. For the real part the vehicle must also be stable
    or unstable between the crossings as they say; with ``lowest_only`` up to the critical speed, beyond which the result says
    nothing.

    Raises
    ------
    ConvergenceError
        Naming the first speed at which the two disagree.
    """
    for crossing in result.crossings:
        value = dense_eigenvalues(model, crossing.speed)
        error = np.abs(value / crossing.eigenvalue - 1.0).min()
        if error > _AGREE:
            raise ConvergenceError(f"no dense eigenvalue at {crossing.speed:.6g} m/s lies within {_AGREE:g} of {crossing.eigenvalue:.6g} "
                                   f"1/s (nearest: {error:.1e}); the crossing is not one of the whole model")
    checked = len(result.crossings)
    if all(c.criterion == 0.0 for c in result.crossings) and result.damping_ratio == 0.0:
        checked += _verify_between(model, result, speed_range, lowest_only)
    return replace(result, message=f"{result.message}; verified with dense eigenvalues at {checked} speeds")


def _verify_between(model, result, speed_range, lowest_only):
    bounds = np.log([speed_range[0], *(c.speed for c in result.crossings), speed_range[1]])
    if lowest_only and (result.crossings or result.unstable_at_start):
        bounds = bounds[:2] if result.crossings else bounds[[0, 0]]
    unstable = result.unstable_at_start
    checked = 0
    for low, high, crossing in zip(bounds, bounds[1:], (*result.crossings, None)):
        steps = _BETWEEN if high > low else 1
        for speed in np.exp(low + (high - low) * (np.arange(steps) + 0.5) / steps):
            value = dense_eigenvalues(model, speed)
            growing = value[excess(value, 0.0) > _UNSTABLE * np.abs(value)]
            if bool(len(growing)) != unstable:
                raise ConvergenceError(f"at {speed:.6g} m/s the crossings say {'unstable' if unstable else 'stable'}, the dense "
                                       f"eigenvalues have {len(growing)} with a positive real part {growing[:3]}")
            checked += 1
        unstable = unstable if crossing is None else crossing.direction > 0
    return checked
