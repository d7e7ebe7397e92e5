# SPDX-License-Identifier: BSD-3-Clause
"""Bench records of dampers whose parameters are known, by an integrator of their own.

A Maxwell damper under an imposed elongation e(t), v = de/dt,

    F = k(|v|) (e - s),  C(ds/dt) = F,

is integrated here in the force of the damper by SciPy's Radau: ds/dt = C^-1(F), with C^-1 from a dense table
of the curve turned round, so that nothing is shared with the package's bench but the equation. What the sensors add: offset, drift, white
noise, a lag of the force channel, the start of the bench from rest.

Run as a script it writes the records that come along: ``python -m tests.oracles.damper_records railsym/data/dampers``.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator


@dataclass(frozen=True)
class TrueDamper:
    """Damping: N s/m, or (speed, force) of the curve; stiffness: N/m, None for none, or (speed, stiffness)."""

    damping: float | tuple
    stiffness: float | tuple | None = None

    def force(self, speed):
        """Force of the viscous element."""
        if np.isscalar(self.damping):
            return self.damping * speed
        return _odd_curve(*self.damping)(speed)

    def speed(self, force):
        """Speed of the viscous element at a force, by the inverse of its table."""
        if np.isscalar(self.damping):
            return force / self.damping
        return _inverse(self.damping)(force)

    def series_stiffness(self, speed):
        """N/m at a speed of the two ends."""
        if np.isscalar(self.stiffness):
            return self.stiffness + 0.0 * speed
        return _straight_on(PchipInterpolator(*self.stiffness), self.stiffness[0])(np.abs(speed))


def _straight_on(curve, x):
    """The curve, and its end tangents beyond."""
    low, high = x[0], x[-1]

    def value(at):
        inside = np.clip(at, low, high)
        return curve(inside) + (at - inside) * curve.derivative()(inside)
    return value


def _odd_curve(x, y):
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x[0] == 0.0:
        x, y = np.concatenate([-x[:0:-1], x]), np.concatenate([-y[:0:-1], y])
    return _straight_on(PchipInterpolator(x, y), x)


_inverses = {}


def _inverse(table):
    """Speed over force from a dense table of the curve, cubic between its points."""
    key = (tuple(table[0]), tuple(table[1]))
    if key not in _inverses:
        ends = 3.0 * np.max(np.abs(table[0]))
        level = np.linspace(-1.0, 1.0, 12001)
        speed = ends * (0.01 * level + 0.99 * level**3)
        force = _odd_curve(*table)(speed)
        _inverses[key] = _straight_on(PchipInterpolator(force, speed), force)
    return _inverses[key]


@dataclass(frozen=True)
class Sensors:
    """What the bench adds. Noise as a part of the r.m.s. value of each channel, lag in s, drift over the record in N."""

    noise: float = 0.0
    lag: float = 0.0
    force_offset: float = 0.0
    displacement_offset: float = 0.0
    force_drift: float = 0.0
    seed: int = 1


def bench_test(damper, frequency, amplitude, cycles=10, rate=1000.0, phase=0.0, rise=0.0, sensors=Sensors(), sine_only=True):
    """Time, displacement, force and velocity of a test that starts from an unloaded damper.

    Parameters
    ----------
    damper : TrueDamper
    frequency, amplitude : float
        Hz, m.
    rise : float
        s in which the amplitude rises from 0.

    Returns
    -------
    time, displacement, force, velocity : ndarray
    """
    omega = 2.0 * np.pi * frequency
    time = np.arange(0.0, cycles / frequency, 1.0 / rate)

    def motion(t):
        part = np.clip(t / rise, 0.0, 1.0) if rise else np.ones_like(t)
        window, slope = part * part * (3 - 2 * part), np.where(part < 1, 6 * part * (1 - part), 0.0) / (rise or 1.0)
        sine, cosine = np.sin(omega * t + phase), omega * np.cos(omega * t + phase)
        return amplitude * window * sine, amplitude * (window * cosine + slope * sine)

    asked = np.maximum(time - sensors.lag, 0.0)
    if damper.stiffness is None:
        force = damper.force(motion(asked)[1])
    else:
        force = _maxwell_force(damper, motion, asked, time[-1], frequency, amplitude)
    displacement, velocity = motion(time)
    random = np.random.default_rng(sensors.seed)
    force = force + sensors.force_offset + sensors.force_drift * time / time[-1] + _noise(random, force, sensors.noise)
    displacement = displacement + sensors.displacement_offset + _noise(random, displacement, sensors.noise)
    return time, displacement, force, velocity


def _noise(random, signal, part):
    return part * np.sqrt(np.mean(signal**2)) * random.standard_normal(signal.size)


def _maxwell_force(damper, motion, asked, end, frequency, amplitude):
    def rate(t, s):
        e, v = motion(np.asarray(t))
        return [damper.speed(damper.series_stiffness(v) * (e - s[0]))]

    start = motion(np.zeros(1))[0]
    solution = solve_ivp(rate, (0.0, end), start, method="Radau", rtol=1e-7, atol=1e-9 * amplitude, dense_output=True,
                         max_step=0.02 / frequency)
    e, v = motion(asked)
    return damper.series_stiffness(v) * (e - solution.sol(asked)[0])


# The damper of the records that come along: about 7e5 N s/m at the start, a knee at 8.5 kN, and a stiffness that falls with
# speed from 6.2e6 to 4.2e6 N/m; the paper's constant value is 5e6 N/m.
SHIPPED = TrueDamper(
    damping=((0.0, 0.004, 0.01, 0.016, 0.024, 0.04, 0.08), (0.0, 3400.0, 7000.0, 8800.0, 10200.0, 12000.0, 15000.0)),
    stiffness=((0.0, 0.005, 0.012, 0.02, 0.03, 0.05), (6.2e6, 5.9e6, 5.2e6, 4.7e6, 4.4e6, 4.2e6)))
SHIPPED_TESTS = ((0.5, 0.5), (0.5, 2.0), (1.0, 0.5), (1.0, 1.0), (1.0, 2.0), (1.0, 3.0), (2.0, 0.5), (2.0, 1.0), (2.0, 2.0),
                 (3.0, 0.5), (3.0, 1.0), (3.0, 1.5))
SHIPPED_SENSORS = {"noise": 0.01, "lag": 0.002, "force_offset": 90.0, "displacement_offset": 4e-5, "force_drift": 60.0}


def shipped_records(rate=500.0, cycles=7):
    """Name -> (time, displacement, force) of the records that come along."""
    found = {}
    for number, (frequency, millimetres) in enumerate(SHIPPED_TESTS):
        sensors = Sensors(seed=100 + number, **SHIPPED_SENSORS)
        name = f"{frequency:g}Hz_{millimetres:g}mm"
        found[name] = bench_test(SHIPPED, frequency, 1e-3 * millimetres, cycles, rate, rise=1.0 / frequency, sensors=sensors)[:3]
    return found


def write_csv(path, time, displacement, force):
    """A CSV file as `railsym.dampers.read_records` takes it, in s, mm and kN."""
    lines = ["time [s],displacement [mm],force [kN]"]
    lines += [f"{t:.3f},{1e3 * x:.5f},{1e-3 * f:.5f}" for t, x, f in zip(time, displacement, force)]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    for name, channels in shipped_records().items():
        write_csv(Path(sys.argv[1]) / f"{name}.csv", *channels)
