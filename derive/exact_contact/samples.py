# SPDX-License-Identifier: BSD-3-Clause
"""Solutions that the table is fitted to: points of the unit ball of coordinates.py for each a/b of the table."""

from __future__ import annotations

import numpy as np

from derive.exact_contact.coordinates import from_ball, scales
from derive.exact_contact.rolling import Extrapolated, full_slip

POISSON = 0.28
LEAST, LARGEST, PIECES = 0.1, 10.0, 10  # of a/b; pieces of the spline over log(a/b)
CELLS = 600
_SEED = 20
_POINTS = 8000, 600, 40, 1500       # inside, on a plane of symmetry, on an axis, on the surface
_FEWER_POINTS = 4200, 500, 40, 600  # above _LONG, where a solution costs ten times as much
_LONG = 6.0
_LARGEST_RADIUS = 0.99  # beyond: full slip


def positions():
    """Place of each a/b along the pieces, 0 to PIECES: ends and middles of pieces."""
    return np.concatenate([[0.0], np.arange(PIECES) + 0.5, [float(PIECES)]])


def ratios():
    """The a/b that are computed, increasing."""
    return LEAST * (LARGEST / LEAST) ** (positions() / PIECES)


def points(ratio):
    """Points s1 >= 0, s3 >= 0 of the unit ball at one a/b, the last ones on its surface: (n, 3), number inside.

    Planes and axes of symmetry, one creepage alone, are frequent in use and have points of their own.
    """
    from scipy.stats.qmc import Sobol

    def cube(dimension, count):
        found = Sobol(dimension, seed=_SEED).random(2 ** int(np.ceil(np.log2(4 * count))))
        return found * 2 - 1

    def ball(dimension, count):
        inside = cube(dimension, count)
        return inside[np.linalg.norm(inside, axis=1) < _LARGEST_RADIUS][:count]

    in_volume, in_plane, on_axis, on_surface = _FEWER_POINTS if ratio > _LONG else _POINTS
    volume, plane = ball(3, in_volume), ball(2, in_plane)
    zero = np.zeros(len(plane))
    axis = (np.arange(on_axis) + 0.5) / on_axis * _LARGEST_RADIUS
    axes = np.concatenate([np.outer(axis, e) for e in np.eye(3)])
    inside = np.concatenate([volume, np.stack([plane[:, 0], plane[:, 1], zero], 1), np.stack([zero, plane[:, 0], plane[:, 1]], 1), axes])
    square = cube(2, on_surface)[:on_surface]  # equal areas of the sphere
    z, angle = square[:, 0], np.pi * square[:, 1]
    ring = np.sqrt(1 - z * z)
    surface = np.concatenate([np.stack([ring * np.cos(angle), z, ring * np.sin(angle)], 1), np.eye(3)])
    both = np.concatenate([inside, surface])
    flip = np.where(both[:, 2] < 0, -1.0, 1.0)[:, None]  # all forces change sign with all creepages
    both = both * flip
    both[:, 0] = np.abs(both[:, 0])
    return both, len(inside)


def solved(ratio, cells=CELLS):
    """Forces Fx, Fy, Mz at `points`, shape (n, 3)."""
    s, inside = points(ratio)
    scale = scales(ratio, POISSON)
    found = Extrapolated(ratio, cells, POISSON).forces(from_ball(s[:inside]) / scale)
    return np.concatenate([found, full_slip(ratio, s[inside:] / scale)])
