# SPDX-License-Identifier: BSD-3-Clause
"""Lag of the force channel behind the displacement channel, over tests of different frequency and amplitude.

One test cannot tell the lag: to first order in frequency a lag tau acts as a longer relaxation time c/k of the damper. Several
tests can, through magnitude and phase together. The model here is as poor as possible: a series compliance and a damping that
is a smooth function of the force's amplitude (and so of the damper's own speed),

    X/F = (1/k + 1/(i omega c)) exp(i omega tau),  ln c = a0 + a1 u + a2 u^2,  u = ln |F|
"""

from __future__ import annotations

import numpy as np

LARGEST = 0.02              # s, either way
_USEFUL_DEVIATION = 0.002   # s: with more the tests do not tell the lag


def estimate_lag(cleaned):
    """Lag of the force by least squares on the first harmonics of all tests.

    Parameters
    ----------
    cleaned : sequence of CleanRecord

    Returns
    -------
    lag : float
        s; 0 where the tests do not tell.
    deviation : float
        s, its standard deviation by the scatter about the fit; inf where the tests do not tell.
    """
    stiffness = np.array([one.dynamic_stiffness for one in cleaned])
    angular = 2.0 * np.pi * np.array([one.frequency for one in cleaned])
    force = np.abs(stiffness) * np.array([one.amplitude for one in cleaned])
    curved = min(2, max(0, (2 * len(cleaned) - 4) // 3), len({round(np.log(f), 1) for f in force}) - 1)
    if len(cleaned) < 3 or angular.max() < 1.2 * angular.min():
        return 0.0, np.inf
    from scipy.optimize import least_squares

    powers = np.log(force / np.exp(np.mean(np.log(force)))) ** np.arange(1 + curved)[:, None]
    scale = float(np.median(np.abs(stiffness)))
    damping = scale / float(np.median(angular))

    def misfit(p):
        ratio = _log_stiffness(p, angular, powers, scale, damping)[0] - np.log(stiffness)
        return np.concatenate([ratio.real, np.angle(np.exp(1j * ratio.imag))])

    def slopes(p):
        change = _log_stiffness(p, angular, powers, scale, damping)[1]
        return np.concatenate([change.real, change.imag], axis=1).T

    best = None
    for lag in (0.0, 0.003):
        start = np.zeros(3 + curved)
        start[0] = 1e2 * lag
        found = least_squares(misfit, start, slopes, x_scale=1.0, max_nfev=100, method="lm", ftol=1e-6, xtol=1e-6)
        best = found if best is None or found.cost < best.cost else best
    lag = 1e-2 * best.x[0]
    freedom = max(1, 2 * len(cleaned) - best.x.size)
    covariance = np.linalg.pinv(best.jac.T @ best.jac) * max(2.0 * best.cost / freedom, 1e-10)
    deviation = 1e-2 * float(np.sqrt(covariance[0, 0]))
    if abs(lag) > LARGEST or not deviation < _USEFUL_DEVIATION:
        return 0.0, np.inf
    return float(lag), deviation


def _log_stiffness(p, angular, powers, scale, damping):
    """ln of the dynamic stiffness (tests,), and its slopes (unknowns, tests).

    p = lag / 10 ms, ln of the series stiffness / scale, and coefficients of ln(c / damping) over ``powers``.
    """
    stored = np.exp(-p[1]) / scale
    lost = np.exp(-(p[2:] @ powers)) / (1j * angular * damping)
    delay = -1e-2j * angular
    whole = stored + lost
    return delay * p[0] - np.log(whole), np.concatenate([delay[None], (stored / whole)[None], powers * (lost / whole)])
