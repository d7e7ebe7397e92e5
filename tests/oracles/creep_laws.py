# SPDX-License-Identifier: BSD-3-Clause
"""Creep laws of one contact written down from their papers, in physical units.

Every function takes a `Contact` whose numbers may be complex (derivatives by the
complex step: comparisons look at real parts) and returns Fx, Fy, Mz on the wheel.
Nothing here is shared with railsym.
"""

import cmath
from dataclasses import dataclass
from math import cos, pi, sin


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


def smaller(x, y):
    return x if x.real <= y.real else y


def fastrip(k):
    """Sichani, Enblom, Berg 2016, with the two transitions of csrc/creep/fastrip.c; integrals by the inverse sine."""
    a, b, G, r = k.a, k.b, k.weight * k.G, (k.a / k.b) ** 0.5
    p0 = 1.5 * k.load / (pi * a * b)
    unit = 2 * k.friction * p0 / G  # creepage of a half-plane at which all of it slips
    Fx = Fy = Mz = 0j
    for j in range(k.strips):
        angle = (j + 0.5) * pi / k.strips
        y, edge, dy = b * cos(angle), a * sin(angle), b * sin(angle) * pi / k.strips
        psi = -3 * G * (a * b) ** 0.5 * k.c23 * k.phi / (2 * pi * k.friction * p0)
        xi = -4 * k.c11 / pi**2 * k.xi / unit + 16 * k.c33 / (3 * pi**2) * 3 * r * (a * b) ** 0.5 * k.phi * y / b / unit
        eta = -4 * k.c22 / pi**2 * k.eta / unit
        tau, w = fastrip_adhesion(xi, eta, psi, edge / a)
        sums = fastrip_strip(k, G, p0, tau, w, y, edge)
        s = 2 * tau - 1
        slipped = area(s)
        D = (pi / 2 - slipped - pi / 2 * (1 - tau) ** 2) / tau
        tD = (cmath.sqrt(1 - s * s) ** 3 / 3 - pi / 2 * tau * (1 - tau) ** 2) / tau
        theory = [xi * D, eta * D + psi * edge / a * (pi / 2 - slipped),
                  eta * tD + psi * edge / a * cmath.sqrt(1 - s * s) ** 3 / 3]
        qx, qy, qty = (edge * k.friction * p0 * (w * (t + edge / a * slip) + (1 - w) * edge / a * own)
                       for t, slip, own in zip(theory, *sums, strict=True))
        Fx, Fy, Mz = Fx + qx * dy, Fy + qy * dy, Mz + (edge * qty - y * qx) * dy
    return Fx, Fy, Mz


def area(t):
    """int sqrt(1 - t^2) from -1."""
    return (t * cmath.sqrt(1 - t * t) + cmath.asin(t)) / 2 + pi / 4


def smooth(z):
    z = 0j if z.real < 0 else smaller(z, 1 + 0j)
    return z * z * (3 - 2 * z)


def fastrip_adhesion(xi, eta, psi, L):
    """tau and the weight of strip theory."""
    square = eta**2 + (1 - psi**2) * xi**2
    below = cmath.sqrt(square) - eta * psi
    if square.real < 0 or below.real <= 0:
        return 1.0 + 0j, 0j
    e = (xi**2 + eta**2) / below / L
    R = (psi**2 - 1) * L / below * (2 - e if e.real < 1 else e)
    spin = 1 - psi**2 if abs(psi.real) < 1 else 0j
    r = (below + 0.5 * spin) / (cmath.sqrt(xi**2 + eta**2) + 0.5)
    return smaller(e, 1 + 0j), smooth(2 * (1 - R)) * smooth(2 * r)


def fastrip_strip(k, G, p0, tau, w, y, edge):
    """FASTSIM on one strip: integrals of its direction over the slip behind the adhesion, and of its own traction."""
    a, b = k.a, k.b
    own = (3 * k.c11 * G / (8 * a), 3 * k.c22 * G / (8 * a), 4 * k.c23 * G / (pi * a * (a / b) ** 0.5))  # 1/L1, 1/L2, 1/L3
    one = sum(own) / 3
    stiffness = [one + w * (1 - tau**4) * (c - one) for c in own]
    px = py = 0j
    slip, alone, last, end = [0j] * 3, [0j] * 3, 1.0, 2 * tau - 1
    for i in range(k.cells):
        t = 1 - (2 * i + 1) / k.cells
        length, middle = (last - t) * edge, (last + t) / 2 * edge
        px -= (stiffness[0] * k.xi - stiffness[2] * k.phi * y) * length
        py -= (stiffness[1] * k.eta + stiffness[2] * k.phi * middle) * length
        size, bound = cmath.sqrt(px * px + py * py), k.friction * p0 * edge / a * (1 - t * t) ** 0.5
        n = (px / size, py / size)
        if size.real > bound.real:
            px, py = n[0] * bound, n[1] * bound
        low, high = max(-1.0, t - 1 / k.cells), min(1.0, t + 1 / k.cells)
        for to, upper, (x_, y_) in ((slip, smaller(end, high + 0j), n), (alone, high + 0j, (px / bound, py / bound))):
            if upper.real > low:
                share = area(upper) - area(low)
                turn = (cmath.sqrt(1 - low**2) ** 3 - cmath.sqrt(1 - upper**2) ** 3) / 3
                to[0], to[1], to[2] = to[0] + share * x_, to[1] + share * y_, to[2] + turn * y_
        last = t
    return slip, alone


LAWS = {"kalker_linear": kalker_linear, "shen_hedrick_elkins": shen_hedrick_elkins, "polach": polach, "fastsim": fastsim,
        "fastrip": fastrip}
