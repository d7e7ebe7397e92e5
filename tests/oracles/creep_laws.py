# SPDX-License-Identifier: BSD-3-Clause
"""Creep laws of one contact written down from their papers, in physical units.

Every function takes a `Contact` whose numbers may be complex (derivatives by the
complex step: comparisons look at real parts) and returns Fx, Fy, Mz on the wheel.
Nothing here is shared with railsym.
"""

import cmath
from dataclasses import dataclass
from math import pi


@dataclass
class Contact:
    xi: complex
    eta: complex
    phi: complex
    load: complex
    friction: complex
    weight: complex
    a: float
    b: float
    G: float
    c11: float
    c22: float
    c23: float
    c33: float
    kA: float = 1.0
    kS: float = 1.0
    strips: int = 20
    cells: int = 20


def modulus(z):
    """|z| continued analytically from the real axis."""
    return z if z.real >= 0 else -z


def kalker_linear(k):
    G, c2 = k.weight * k.G, k.a * k.b
    c = c2**0.5
    return (-G * c2 * k.c11 * k.xi, -G * c2 * k.c22 * k.eta - G * c**3 * k.c23 * k.phi,
            G * c**3 * k.c23 * k.eta - G * c2**2 * k.c33 * k.phi)


def reduced(u):
    return 1 - u / 3 + u * u / 27 if u.real < 3 else 1 / u


def shen_hedrick_elkins(k):
    fx, fy, mz = kalker_linear(k)
    limit = k.friction * k.load
    force = cmath.sqrt(fx * fx + fy * fy)
    largest = 3 * pi / 16 * limit * (k.a * k.b) ** 0.5
    both = cmath.sqrt((force / limit) ** 2 + (mz / largest) ** 2)
    factor = reduced(force / limit)
    return fx * factor, fy * factor, mz * reduced(both)


def polach(k):
    """Polach 1999, equations as printed (the spin force with d), and kA, kS of 2005."""
    limit, G, a, b = k.friction * k.load, k.weight * k.G, k.a, k.b
    total = k.eta + k.phi * a
    lateral = total if abs(total.real) >= abs(k.eta.real) else k.eta
    sC = cmath.sqrt(k.xi**2 + lateral**2)
    cj = cmath.sqrt((k.c11 * k.xi) ** 2 + (k.c22 * k.eta) ** 2) / cmath.sqrt(k.xi**2 + k.eta**2)
    eps = pi / 4 * G * a * b * cj * sC / limit
    F = -2 * limit / pi * (k.kA * eps / (1 + (k.kA * eps) ** 2) + cmath.atan(k.kS * eps))
    KS = 1 + 6.3 * (1 - cmath.exp(-a / b))
    epsS = 8 / 3 * b * (a * b) ** 0.5 / limit * G * k.c23 * modulus(lateral) / KS
    d = (epsS**2 - 1) / (epsS**2 + 1)
    FyS = -9 / 16 * a * limit * KS * (epsS * (-(d**3) / 3 + d**2 / 2 - 1 / 6) + cmath.sqrt((1 - d**2) ** 3) / 3)
    return F * k.xi / sC, F * k.eta / sC + FyS * k.phi / sC, 0j


def fastsim(k):
    """Kalker 1982 strip by strip; tractions at the middles of equal cells."""
    a, b, G = k.a, k.b, k.weight * k.G
    L1, L2 = 8 * a / (3 * k.c11 * G), 8 * a / (3 * k.c22 * G)
    L3 = pi * a * (a / b) ** 0.5 / (4 * k.c23 * G)
    p0 = 2 * k.load / (pi * a * b)
    Fx = Fy = Mz = 0j
    dy = 2 * b / k.strips
    for j in range(k.strips):
        y = -b + (j + 0.5) * dy
        edge = a * (1 - (y / b) ** 2) ** 0.5
        dx = 2 * edge / k.cells
        px = py = 0j
        last = edge
        for i in range(k.cells):
            x = edge - (i + 0.5) * dx
            middle, length = (last + x) / 2, last - x
            px -= (k.xi / L1 - k.phi * y / L3) * length
            py -= (k.eta / L2 + k.phi * middle / L3) * length
            bound = k.friction * p0 * (1 - (x / a) ** 2 - (y / b) ** 2)
            size = cmath.sqrt(px * px + py * py)
            if size.real > bound.real:
                px, py = px * bound / size, py * bound / size
            Fx, Fy, Mz = Fx + px * dx * dy, Fy + py * dx * dy, Mz + (x * py - y * px) * dx * dy
            last = x
    return Fx, Fy, Mz


LAWS = {"kalker_linear": kalker_linear, "shen_hedrick_elkins": shen_hedrick_elkins, "polach": polach, "fastsim": fastsim}
