# SPDX-License-Identifier: BSD-3-Clause
"""The energy method: damping from the energy dissipated, stiffness from the energy stored.

A Maxwell damper, F = D(w) and e = s + j F with w = ds/dt and j = 1/k, has under a cycle

    oint F de = oint D(w) w dt          dissipated in the damper
    e - int R(F) dt = j F               elongation stored in the spring, R the inverse of D

For a sine and constants this is Re(1/K) = 1/k and Im(1/K) = -1/(omega c): here. For curves: `elongation`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

LARGEST_LAG = 0.02  # s, either way


@dataclass(frozen=True, eq=False)
class Loops:
    """One mean cycle of every test, on one grid of phases.

    Attributes
    ----------
    angular : ndarray (tests,)
        rad/s.
    displacement, velocity, force : ndarray (tests, points)
        m, m/s, N; the force without its mean.
    harmonics : ndarray of complex, shape (tests, orders)
        Of the force, order 1 first, N.
    kept : ndarray of bool, shape (tests, orders)
        Orders that the sampling can tell.
    scale : ndarray (tests,)
        Root mean square of the force, N.
    mean : ndarray (tests,)
        N, of the force: what an asymmetric damper adds to its loop.
    noise : ndarray (tests,)
        Root mean square of the force that differs from cycle to cycle, N.
    deviation : ndarray (tests, orders)
        Standard deviation of the harmonics, N (root mean square of the complex error).
    """

    angular: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    harmonics: np.ndarray
    kept: np.ndarray
    scale: np.ndarray
    mean: np.ndarray
    noise: np.ndarray
    deviation: np.ndarray

    @property
    def period(self):
        """s, shape (tests,)."""
        return 2.0 * np.pi / self.angular

    def shifted(self, lag):
        """The same loops with the force ``lag`` (s) earlier."""
        order = 1 + np.arange(self.harmonics.shape[1])
        turned = self.harmonics * np.exp(1j * order * self.angular[:, None] * lag)
        return replace(self, force=synthesis(turned * self._clear, self.force.shape[1]), harmonics=turned)

    def only(self, test):
        """The loop of one test."""
        return replace(self, **{name: getattr(self, name)[test:test + 1] for name in self.__dataclass_fields__})

    def coarse(self, step=None):
        """Every so many points; without ``step`` down to 64 a cycle, which are enough for 31 harmonics."""
        step = max(1, self.force.shape[1] // 64) if step is None else step
        return replace(self, displacement=self.displacement[:, ::step], velocity=self.velocity[:, ::step], force=self.force[:, ::step])

    @property
    def _clear(self):
        """Harmonics that stand out of the noise; the others would only make the damper's speed noisy."""
        return np.abs(self.harmonics) > 2.8 * self.deviation


def synthesis(harmonics, points):
    """Signal (tests, points) of harmonics (tests, orders), order 1 first."""
    spectrum = np.zeros((len(harmonics), points // 2 + 1), dtype=complex)
    orders = min(harmonics.shape[1], points // 2 - 1)
    spectrum[:, 1:1 + orders] = 0.5 * points * harmonics[:, :orders]
    return np.fft.irfft(spectrum, points, axis=1)


def loops_of(cleaned, points=256, orders=31):
    """Loops of cleaned records.

    Parameters
    ----------
    cleaned : sequence of CleanRecord
    """
    count = len(cleaned)
    angular = 2.0 * np.pi * np.array([one.frequency for one in cleaned])
    force, motion = np.zeros((count, orders), dtype=complex), np.zeros((count, orders), dtype=complex)
    kept = np.zeros((count, orders), dtype=bool)
    for k, one in enumerate(cleaned):
        _, e, _, f = one.mean_cycle
        top = min(orders, (len(e) - 1) // 2)
        motion[k, :top] = 2.0 * np.fft.rfft(e)[1:1 + top] / len(e)
        force[k, :top] = 2.0 * np.fft.rfft(f)[1:1 + top] / len(f)
        kept[k, :top] = True
    rate = 1j * (1 + np.arange(orders)) * angular[:, None] * motion
    scale = np.sqrt(0.5 * np.sum(np.abs(force) ** 2, axis=1))
    noise, mean = (np.array(part) for part in ([one.noise for one in cleaned], [np.mean(one.force) for one in cleaned]))
    deviation = np.array([_deviations(one, orders) for one in cleaned])
    made = Loops(angular, synthesis(motion, points), synthesis(rate, points), synthesis(force, points), force, kept, scale, mean, noise, deviation)
    return made.shifted(0.0)


def _deviations(one, orders):
    """Standard deviation (orders,) of the force's harmonics in a CleanRecord; by white noise where it has none."""
    white = 2.0 * one.noise / np.sqrt(one.cycles * one.samples_per_cycle)
    found = np.full(orders, white)
    if one.deviation is not None:
        found[:len(one.deviation)] = one.deviation[:orders]
    return found


def hats(x, nodes):
    """Hat functions (len(nodes), ...) of ``nodes`` at ``x``; the last two go straight on beyond the end."""
    piece = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, len(nodes) - 2)
    t = (x - nodes[piece]) / (nodes[piece + 1] - nodes[piece])
    out = np.zeros((len(nodes), *np.shape(x)))
    flat, at = out.reshape(len(nodes), -1), np.arange(np.size(x))
    flat[piece.ravel(), at] = 1.0 - t.ravel()
    flat[piece.ravel() + 1, at] += t.ravel()
    return out


def constants(loops, lag=None, viscous=False):
    """Stiffness (N/m), damping (N s/m) and lag (s) of constants by the first harmonics alone; ``viscous``: without 1/k.

    X/F = (1/k + 1/(i omega c)) exp(i omega lag): the real part is the energy stored, the imaginary one that dissipated. It is
    linear in 1/k and 1/c; the lag is searched where it is None. Mean harmonics are all but free of noise.
    """
    motion = 2.0 * np.fft.rfft(loops.displacement, axis=1)[:, 1] / loops.displacement.shape[1]
    ratio, omega = loops.harmonics[:, 0] / motion, loops.angular
    lags, width = (np.linspace(-LARGEST_LAG, LARGEST_LAG, 81), 1e-3) if lag is None else (np.array([lag]), 0.0)
    while True:
        spring = ratio * np.exp(1j * omega * lags[:, None])
        damper = spring / (1j * omega)                     # at right angles to ``spring`` in the complex plane
        compliance = (not viscous) * np.maximum(np.sum(spring.real, axis=1) / np.sum(np.abs(spring) ** 2, axis=1), 1e-10)
        fluidity = np.maximum(np.sum(damper.real, axis=1) / np.sum(np.abs(damper) ** 2, axis=1), 1e-10)
        left = np.sum(np.abs(compliance[:, None] * spring + fluidity[:, None] * damper - 1.0) ** 2, axis=1)
        best = int(np.argmin(left))
        if width < 1e-6:
            return np.inf if viscous else 1.0 / float(compliance[best]), 1.0 / float(fluidity[best]), float(lags[best])
        lags = np.clip(lags[best] + np.linspace(-width, width, 41), -LARGEST_LAG, LARGEST_LAG)
        width *= 0.1


def speed_nodes(loops, symmetric, count=18):
    """Speeds (m/s) for a viscous curve: shares of the largest test's range and of the logarithm of all ranges."""
    peak = np.abs(loops.velocity).max(axis=1)
    half = shared(0.3 * peak.min() / peak.max(), count)
    return peak.max() * half if symmetric else np.concatenate([loops.velocity.min() * half[:0:-1], loops.velocity.max() * half])


def shared(low, count, also=None, weights=(1.0, 1.0, 1.0)):
    """Points (count,) from 0 to 1 that share the range, the logarithm of 1 + x/low, and a rising function ``also`` of x."""
    fine = np.linspace(0.0, 1.0, 2001) ** 2
    share = weights[0] * fine + weights[1] * np.log1p(fine / low) / np.log1p(1.0 / low)
    if also is not None:
        grown = also(fine)
        share = share + weights[2] * grown / max(grown[-1], 1e-300)
    return np.interp(np.linspace(0.0, share[-1], count), share, fine)


def damper_speed(loops, compliance, stiffness_nodes=None):
    """Speed (m/s) of the damper alone: v - d(j F)/dt, shape (tests, points)."""
    j = compliance[0] if stiffness_nodes is None else np.tensordot(compliance, hats(np.abs(loops.velocity), stiffness_nodes), 1)
    spectrum = np.fft.rfft(j * loops.force, axis=1)
    order = np.arange(spectrum.shape[1])
    spectrum *= 1j * order * loops.angular[:, None]
    spectrum[:, 41:] = 0.0  # noise of no use, multiplied by its order
    return loops.velocity - np.fft.irfft(spectrum, loops.force.shape[1], axis=1)


def dissipated(loops, speed):
    """Damping c (N s/m) by the energy balance int F w dt = int F^2 dt / c, over all tests.

    The force is known better than the speed w, whose noise would bias int w^2 dt.
    """
    taken = np.mean(loops.force * speed, axis=1)
    own = np.mean(speed**2, axis=1)
    square = np.mean(loops.force**2, axis=1)
    weight = 1.0 / (square * np.maximum(np.mean(loops.velocity**2, axis=1), own) + 1e-300)
    return float(np.sum(square**2 * weight) / max(np.sum(square * taken * weight), 1e-300))


def force_curve(loops, speed, nodes, steepest=np.inf):
    """Rising force (N) at ``nodes`` (m/s, 0 among them with no force) by least squares of F = D(w); each test has its mean."""
    from scipy.optimize import nnls

    zero = int(np.argmin(np.abs(nodes)))
    above = [np.clip(speed, nodes[k], nodes[k + 1]) - nodes[k] for k in range(zero, len(nodes) - 1)]
    below = [np.clip(speed, nodes[k], nodes[k + 1]) - nodes[k + 1] for k in range(zero)]
    if zero == 0:  # odd
        above = [part - np.clip(-speed, nodes[k], nodes[k + 1]) + nodes[k] for k, part in enumerate(above)]
    bases = np.array([(part - part.mean(axis=1, keepdims=True)) / loops.scale[:, None] for part in (*below, *above)])
    table = bases.reshape(len(bases), -1).T
    wanted = (loops.force / loops.scale[:, None]).ravel()
    size = np.sqrt(np.sum(table**2, axis=0)) + 1e-300
    table = table / size
    root = np.linalg.cholesky(table.T @ table + 1e-9 * np.eye(len(bases))).T
    slopes = nnls(root, np.linalg.solve(root.T, table.T @ wanted))[0] / size
    rise = np.minimum(slopes, steepest) * np.diff(nodes)
    force = np.concatenate([[0.0], np.cumsum(rise)])
    return force - force[zero]
