# SPDX-License-Identifier: BSD-3-Clause
"""Frictionless contact on an elastic half-space, on a grid: any gap, no assumption on the shape of the patch.

Boussinesq's influence of a uniformly loaded rectangle (A. E. H. Love 1929; K. L. Johnson, Contact Mechanics, 1985, eq. 3.25), applied
by FFT, and conjugate gradients on the pressures that stay positive (I. A. Polonsky, L. M. Keer, Wear 231 (1999) 206-219).
"""

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2


class HalfSpace:
    """A grid of nx x ny cells (dx, dy in m) on bodies of the contact modulus E' (N/m^2)."""

    def __init__(self, nx, ny, dx, dy, modulus):
        self.shape, self.dx, self.dy = (nx, ny), dx, dy
        x, y = np.meshgrid(np.arange(-nx + 1, nx) * dx, np.arange(-ny + 1, ny) * dy, indexing="ij")
        a, b = 0.5 * dx, 0.5 * dy
        corner = lambda p, q: p * np.arcsinh(q / np.abs(p)) + q * np.arcsinh(p / np.abs(q))  # noqa: E731
        kernel = (corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)) / (np.pi * modulus)
        self._size = tuple(next_fast_len(2 * n - 1, real=True) for n in self.shape)
        padded = np.zeros(self._size)
        padded[:kernel.shape[0], :kernel.shape[1]] = kernel
        self._kernel = rfft2(np.roll(padded, (-nx + 1, -ny + 1), (0, 1)))

    def deflection(self, pressure):
        return irfft2(rfft2(pressure, self._size) * self._kernel, self._size)[:self.shape[0], :self.shape[1]]

    def pressure(self, gap, tolerance=1e-6):
        """Pressure (N/m^2) of bodies that would overlap where ``gap`` (m) is negative."""
        depth = -gap.min()
        p, direction = np.where(gap < 0.0, 1e8, 0.0), np.zeros(self.shape)
        before, go_on = 1.0, 0.0
        for _ in range(600):
            left = self.deflection(p) + gap
            touching = p > 0.0
            size = np.sum(left[touching] ** 2)
            direction = np.where(touching, left + go_on * size / before * direction, 0.0)
            before = size
            moved = self.deflection(direction)
            step = np.sum(left[touching] * direction[touching]) / np.sum(moved[touching] * direction[touching])
            p = np.maximum(p - step * direction, 0.0)
            overlapping = (p == 0.0) & (left < 0.0) & ~touching
            p[overlapping] = -step * left[overlapping]
            go_on = 0.0 if overlapping.any() else 1.0
            if np.sqrt(size / touching.sum()) < tolerance * depth and not overlapping.any():
                return p
        raise AssertionError("conjugate gradients did not converge")


def wheel_on_rail(side, shift, load, modulus, dx=4e-4, dy=2e-4, length=0.026, width=0.052):
    """One wheel (a `railsym.contact_geometry.Side`) without roll under a normal load; gaps along the normal, over the arc of the rail.

    Returns load N, rolling radius m and place on the rail m (means weighted by pressure), vertical approach m, area m^2, longest half length m,
    and runs of contact across (pairs of places on the rail, m).
    """
    y = np.linspace(side.rail.y[0], side.rail.y[-1], 8001)
    z, slope = side.rail.z(y), side.rail.slope(y)
    across = y - shift
    radius, wheel_slope = side.wheel.z(across), side.wheel.slope(across)
    gap = np.where(np.isfinite(radius), z + side.radius - radius, 0.02)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    middle = np.interp(y[gap.argmin()], y, arc)
    s = np.arange(middle - 0.5 * width, middle + 0.5 * width, dy)
    at = lambda values: np.interp(s, arc, values)  # noqa: E731
    cosine, r, place = 1.0 / np.sqrt(1.0 + at(np.nan_to_num(wheel_slope)) ** 2), at(np.nan_to_num(radius, nan=side.radius)), at(y)
    x = np.arange(-0.5 * length, 0.5 * length, dx) + 0.5 * dx
    body = HalfSpace(len(x), len(s), dx, dy, modulus)
    profile = np.where((s > arc[0]) & (s < arc[-1]), at(gap) - gap.min(), 0.02)
    depth = 7e-5 * (load / 6e4) ** (2 / 3)
    for _ in range(12):
        p = body.pressure((profile - depth) * cosine + 0.5 * cosine / r * x[:, None] ** 2)
        total = p.sum() * dx * dy
        if abs(total / load - 1.0) < 1e-5:
            break
        depth *= (load / total) ** (2 / 3)
    strips = p.sum(axis=0)
    touching = np.flatnonzero(np.diff(np.concatenate([[0], (strips > 0).astype(int), [0]])))
    runs = [(place[a], place[b - 1]) for a, b in touching.reshape(-1, 2)]
    return {"load": total, "radius": strips @ r / strips.sum(), "place": strips @ place / strips.sum(), "depth": depth, "area": (p > 0).sum() * dx * dy,
            "a": 0.5 * dx * (p > 0).sum(axis=0).max(), "runs": runs, "angle": strips @ -np.arctan(at(np.nan_to_num(wheel_slope))) / strips.sum()}
