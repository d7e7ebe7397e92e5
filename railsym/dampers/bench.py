# SPDX-License-Identifier: BSD-3-Clause
"""The virtual bench: the vehicle's element law in C, driven by imposed motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym import _core
from railsym.errors import ModelError


@dataclass(frozen=True, eq=False)
class Sweep:
    """Periodic response over frequency and amplitude.

    Attributes
    ----------
    frequencies, amplitudes : ndarray
        Hz (nf,) and m (na,).
    time, displacement, velocity, force, damper_elongation : ndarray
        One steady cycle each, shape (nf, na, samples); s, m, m/s, N, m.
    dynamic_stiffness : ndarray of complex, shape (nf, na)
        First harmonic of force over displacement, N/m.
    cycles : int
    """

    frequencies: np.ndarray
    amplitudes: np.ndarray
    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    damper_elongation: np.ndarray
    dynamic_stiffness: np.ndarray
    cycles: int

    @property
    def phase(self):
        """Phase of force before displacement, rad, shape (nf, na): pi/2 for a viscous damper, 0 for a spring."""
        return np.angle(self.dynamic_stiffness)

    @property
    def dissipated_energy(self):
        """Energy taken from the bench a cycle, J, shape (nf, na)."""
        return np.pi * self.amplitudes**2 * self.dynamic_stiffness.imag


def virtual_bench(model, time, displacement, velocity=None, substeps=1, start=None):
    """Force of a damper under imposed motion.

    Parameters
    ----------
    model : DamperModel
    time, displacement : array_like (n,)
        s, increasing; elongation in m.
    velocity : array_like (n,), optional
        m/s; by central differences of the displacement (second order) when left out.
    substeps : int
        Integration steps between two samples (TR-BDF2, second order).
    start : float, optional
        Elongation of the Maxwell model's damper at the first sample, m; the displacement there when left out (no force).

    Returns
    -------
    force, damper_elongation : ndarray (n,)
        N, positive when it pulls the ends together; m.

    Raises
    ------
    ModelError
        Arrays of different length, not finite, or time not increasing.
    CoreError
        A step that did not converge, with its time.
    """
    time, displacement = (np.asarray(part, dtype=float) for part in (time, displacement))
    if time.ndim != 1 or time.size < 2 or displacement.shape != time.shape:
        raise ModelError(f"virtual bench: time {time.shape} and displacement {displacement.shape} must be arrays of one length, at least 2")
    rate = np.gradient(displacement, time, edge_order=2 if time.size > 2 else 1) if velocity is None else np.asarray(velocity, dtype=float)
    if rate.shape != time.shape:
        raise ModelError(f"virtual bench: velocity {rate.shape} and time {time.shape} differ in length")
    for name, part in (("time", time), ("displacement", displacement), ("velocity", rate)):
        if not np.isfinite(part).all():
            raise ModelError(f"virtual bench: {name} is not finite at sample {int(np.argmin(np.isfinite(part)))}")
    if (np.diff(time) <= 0.0).any():
        raise ModelError(f"virtual bench: time does not increase after sample {int(np.argmax(np.diff(time) <= 0.0))}")
    if substeps < 1:
        raise ModelError(f"virtual bench: substeps = {substeps}, at least 1 is needed")
    first = displacement[0] if start is None else start
    force, state = _core.bench_run(model.force_law_record(), time, displacement, rate, int(substeps), float(first))
    return force, (state if model.kind == "maxwell" else displacement.copy())


def sweep(model, frequencies, amplitudes, cycles=1, samples_per_cycle=256):
    """Periodic loops, dynamic stiffness and phase under sines.

    Parameters
    ----------
    model : DamperModel
    frequencies, amplitudes : array_like
        Hz (nf,) and m (na,), positive.
    cycles : int
        How often the steady cycle is repeated in the loops (it is found by Newton on the period map, not by waiting).
    samples_per_cycle : int

    Returns
    -------
    Sweep
    """
    f, a = (np.atleast_1d(np.asarray(part, dtype=float)) for part in (frequencies, amplitudes))
    for name, part in (("frequencies", f), ("amplitudes", a)):
        if part.ndim != 1 or not (np.isfinite(part).all() and (part > 0.0).all()):
            raise ModelError(f"sweep: {name} {part!r} must be positive numbers")
    phase = 2.0 * np.pi * np.arange(samples_per_cycle) / samples_per_cycle
    shape = (f.size, a.size, samples_per_cycle)
    turning = 2.0 * np.pi * f[:, None, None]
    e = np.broadcast_to(a[:, None] * np.sin(phase), shape)
    v = turning * a[:, None] * np.cos(phase)
    force, s = _core.bench_cycles(model.force_law_record(), np.repeat(1.0 / f, a.size), e.reshape(-1, shape[2]), v.reshape(-1, shape[2]))
    force, s = force.reshape(shape), s.reshape(shape) if model.kind == "maxwell" else e
    stiffness = 2.0 * np.mean(force * np.exp(-1j * phase), axis=2) / (-1j * a)
    time = np.broadcast_to(phase / turning, shape)
    loops = [np.tile(part, cycles) for part in (e, v, force, s)]
    time = np.concatenate([time + k / f[:, None, None] for k in range(cycles)], axis=2)
    return Sweep(f, a, time, *loops, stiffness, cycles)


def steady_force(model, amplitude, frequency, samples=512):
    """Force (samples,) over one steady cycle of a sine of ``amplitude`` (m) and ``frequency`` (Hz), N."""
    return sweep(model, frequency, amplitude, samples_per_cycle=samples).force[0, 0]
