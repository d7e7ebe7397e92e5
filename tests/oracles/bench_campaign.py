# SPDX-License-Identifier: BSD-3-Clause
"""A second generator of bench records: random dampers, tests and sensors, sharing nothing with the package but the equation.

A Maxwell damper under an imposed elongation e(t), v = de/dt,

    F = k(|v|) (e - s),  ds/dt = C^-1(F),

with C and k in closed form (no tables of nodes, no monotone cubics), all tests of a campaign at once by SciPy's LSODA over cycles.
What the bench adds: start from rest with or without a ramp, white or coloured noise, hum, lag of either sign, offset, drift,
jittered time stamps, a clock that does not begin at zero, units of mm and kN, sampling of 200 Hz to 5 kHz.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

PER_CYCLE = 1024        # samples of the solution
SHAPES = ("linear", "knee", "progressive", "blow-off", "friction", "friction and blow-off")


@dataclass(frozen=True)
class ClosedDamper:
    """c N s/m at rest, k N/m at rest (None: viscous), shapes of C and k.

    ``bend`` m/s: speed at which C bends; ``ratio``: force in compression over that in extension; ``drop``, ``spread``:
    k(|v|) = k (1 - drop |v|/(|v| + spread)); ``dry`` N and ``stick`` m/s: friction dry tanh(w/stick).
    """

    c: float
    k: float | None
    shape: str = "linear"
    bend: float = 0.02
    ratio: float = 1.0
    drop: float = 0.0
    spread: float = 0.02
    dry: float = 0.0
    stick: float = 5e-4

    def force(self, w):
        """N at a speed w (m/s) of the damper itself."""
        w = np.asarray(w, dtype=float)
        u, c, b = np.abs(w), self.c, self.bend
        if self.shape == "knee":
            f = c * b * (np.tanh(u / b) + 0.15 * u / b)
        elif self.shape == "progressive":
            f = c * u * (1.0 + u / b)
        elif "blow-off" in self.shape:
            f = c * np.where(u < b, u, b + 0.06 * (u - b))
        else:
            f = c * u
        f = f + self.dry * np.tanh(u / self.stick)
        return np.where(w < 0.0, -self.ratio * f, f)

    def stiffness(self, v):
        """N/m at a speed v (m/s) of the ends."""
        v = np.abs(v)
        return self.k * (1.0 - self.drop * v / (v + self.spread))

    def inverse(self, fastest):
        """Function from force (N) to speed (m/s), by a dense table up to four times ``fastest``."""
        level = np.linspace(-1.0, 1.0, 40001)
        w = 4.0 * fastest * (0.02 * level + 0.98 * level**3)
        f = self.force(w)
        return lambda force: np.interp(force, f, w)


@dataclass(frozen=True)
class Bench:
    """What the bench and its sensors do. Noise as a part of the r.m.s. value of each channel; s, N, m."""

    rate: float = 1000.0
    cycles: int = 10
    noise: float = 0.0
    colour: float = 0.0
    hum: float = 0.0
    lag: float = 0.0
    force_offset: float = 0.0
    displacement_offset: float = 0.0
    force_drift: float = 0.0
    jitter: float = 0.0
    begin: float = 0.0
    ramp: float = 0.0
    steady: bool = False
    millimetres: bool = False
    velocity: bool = False
    seed: int = 0


@dataclass
class Campaign:
    """Records as mappings for `railsym.dampers.read_records`, and the truth."""

    damper: ClosedDamper
    bench: Bench
    tests: list
    records: list
    units: dict
    fastest: np.ndarray = field(default=None)    # lowest and highest speed of the damper itself
    ends: float = 0.0                           # highest speed of the ends


def solved(damper, tests, bench):
    """Damper elongation (tests, n) over cycles, and phases at the start."""
    random = np.random.default_rng(bench.seed)
    f, a = np.array(tests).T
    phase = random.uniform(0.0, 2.0 * np.pi, len(f)) if not bench.ramp else np.zeros(len(f))
    before = 8 if bench.steady else 0
    last = before + bench.cycles + 0.01 * f.max() + 0.1
    grid = np.arange(0.0, last + 1.0 / PER_CYCLE, 1.0 / PER_CYCLE)
    if damper.k is None:
        return grid, None, phase, before
    inverse = damper.inverse(2.0 * np.pi * np.max(f * a))

    def rate(tau, s):
        e, v = motion(tau, f, a, phase, bench.ramp)
        return inverse(damper.stiffness(v) * (e - s)) / f

    start = motion(0.0, f, a, phase, bench.ramp)[0]
    found = solve_ivp(rate, (0.0, grid[-1]), start, "LSODA", grid, rtol=1e-8, atol=1e-8 * a.min(), lband=0, uband=0, max_step=0.02)
    return grid, found.y, phase, before


def motion(tau, f, a, phase, ramp):
    """Elongation (m) and its rate (m/s) over cycles tau."""
    part = np.clip(tau / ramp, 0.0, 1.0) if ramp else np.ones_like(tau)
    window, slope = part**2 * (3.0 - 2.0 * part), (6.0 * part * (1.0 - part) / ramp if ramp else 0.0)
    angle = 2.0 * np.pi * tau + phase
    return a * window * np.sin(angle), a * f * (2.0 * np.pi * window * np.cos(angle) + slope * np.sin(angle))


def campaign(damper, tests, bench):
    """Records of all tests (Hz, m) of a damper on a bench."""
    random = np.random.default_rng(bench.seed + 1)
    grid, s, phase, before = solved(damper, tests, bench)
    made, low, high, ends = [], 0.0, 0.0, 0.0
    for i, (f, a) in enumerate(tests):
        n = int(bench.cycles / f * bench.rate)
        true = np.arange(n) / bench.rate
        true = true + bench.jitter / bench.rate * random.uniform(-0.5, 0.5, n)
        e, v = motion(before + f * true, f, a, phase[i], bench.ramp)
        late = np.maximum(before + f * (true - bench.lag), 0.0)
        el, vl = motion(late, f, a, phase[i], bench.ramp)
        if damper.k is None:
            force, own = damper.force(vl), v
        else:
            own = CubicSpline(grid, s[i])
            force, own = damper.stiffness(vl) * (el - own(late)), own(late[late > late[-1] - 1.0], 1) * f
        low, high, ends = min(low, own.min()), max(high, own.max()), max(ends, 2.0 * np.pi * f * a)
        force = force + bench.force_offset + bench.force_drift * (true / true[-1] - 0.5) + _noise(random, force, bench, true)
        e = e + bench.displacement_offset + _noise(random, e, bench, true)
        factor = (1e3, 1e-3) if bench.millimetres else (1.0, 1.0)
        one = {"name": f"{f:.3g}Hz_{1e3 * a:.3g}mm", "time": bench.begin + true, "displacement": factor[0] * e, "force": factor[1] * force}
        if bench.velocity:
            one["velocity"] = v * (1e3 if bench.millimetres else 1.0)
        made.append(one)
    units = {"displacement": "mm", "force": "kN"} if bench.millimetres else {}
    if bench.velocity and bench.millimetres:
        units["velocity"] = "mm/s"
    return Campaign(damper, bench, list(tests), made, units, np.array([low, high]), ends)


def _noise(random, signal, bench, time):
    """White noise, or of a first-order filter, of the same r.m.s. value; and mains hum."""
    size = np.std(signal)
    white = random.standard_normal(signal.size)
    if bench.colour:
        white = lfilter([np.sqrt(1.0 - bench.colour**2)], [1.0, -bench.colour], white)
    return size * (bench.noise * white + bench.hum * np.sqrt(2.0) * np.sin(2.0 * np.pi * 50.0 * time + random.uniform(0, 6.28)))


def random_tests(random, count=12, slowest=0.2, fastest=10.0, speed=0.15):
    """Frequencies (Hz) and amplitudes (m): four frequencies over a factor of five at least, three amplitudes each."""
    while True:
        f = np.sort(np.exp(random.uniform(np.log(slowest), np.log(fastest), max(2, count // 3))))
        if f[-1] / f[0] > 5.0 and f[-1] > 1.5:
            break
    tests = []
    for one in f:
        top = min(10e-3, speed / (2.0 * np.pi * one))
        low = min(0.2e-3, 0.5 * top)
        tests += [(float(one), float(a)) for a in np.sort(np.exp(random.uniform(np.log(low), np.log(top), 3)))]
    return tests


def random_bench(random, tests, noise, seed, **fixed):
    """Sensors and sampling drawn at random; at least 24 samples in a cycle."""
    fastest = max(f for f, _ in tests)
    given = {
        "rate": float(np.exp(random.uniform(np.log(max(200.0, 24 * fastest)), np.log(5000.0)))),
        "cycles": int(random.integers(6, 14)), "noise": noise, "colour": float(random.choice([0.0, 0.0, 0.7, 0.95])) if noise else 0.0,
        "lag": float(random.choice([0.0, 0.003, random.uniform(-0.005, 0.005)])), "force_offset": float(random.uniform(-300, 300)),
        "displacement_offset": float(random.uniform(-1e-3, 1e-3)), "force_drift": float(random.choice([0.0, random.uniform(-200, 200)])),
        "jitter": float(random.choice([0.0, 0.0, 0.3])), "begin": float(random.choice([0.0, 12.5, 36000.0])),
        "ramp": float(random.choice([0.0, 0.0, 1.5])), "steady": bool(random.integers(2)), "millimetres": bool(random.integers(2)),
        "velocity": bool(random.integers(2)), "seed": seed}
    return Bench(**{**given, **fixed})


def random_damper(random, tests, kind):
    """kind: viscous, viscous curve, linear, curve, nonlinear (curve and k over speed), asymmetric."""
    c, k = 10.0 ** random.uniform(5.0, 6.0), 10.0 ** random.uniform(np.log10(2e6), 7.0)
    ends = max(2.0 * np.pi * f * a for f, a in tests)
    if kind in ("viscous", "linear"):
        return ClosedDamper(c, None if kind == "viscous" else k)
    shape = str(random.choice(SHAPES[1:]))
    dry = random.uniform(0.03, 0.15) * c * ends * 0.3 if "friction" in shape else 0.0
    drop = 0.0
    if kind in ("nonlinear", "asymmetric"):
        drop = random.uniform(0.15, 0.5) * random.choice([1.0, 1.0, -1.0])
    return ClosedDamper(c, None if kind == "viscous curve" else k, shape, ends * random.uniform(0.08, 0.35),
                        float(random.choice([0.6, 0.75, 1.4])) if kind == "asymmetric" else 1.0, drop, ends * random.uniform(0.1, 0.5), dry,
                        ends * random.uniform(0.01, 0.03))


def random_campaign(seed, kind="linear", noise=0.0, **fixed):
    """A campaign of 12 tests, all drawn from ``seed``."""
    random = np.random.default_rng(1000 + seed)
    tests = random_tests(random)
    return campaign(random_damper(random, tests, kind), tests, random_bench(random, tests, noise, seed, **fixed))
