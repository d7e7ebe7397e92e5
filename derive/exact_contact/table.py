# SPDX-License-Identifier: BSD-3-Clause
"""The shipped table: coefficients over log(a/b) and the half ball, and its file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from derive.exact_contact import fit, samples
from derive.exact_contact.spline import HalfBall

PIECES = 15  # of the half ball, a unit
FILE = Path(__file__).resolve().parents[2] / "railsym" / "data" / "contact" / "exact_table.npz"


def over_ratios(nodes):
    """Coefficients of the quadratic spline over log(a/b), (pieces + 2, ...), from values at `samples.ratios`."""
    at = samples.positions()
    start = np.minimum(at.astype(int), samples.PIECES - 1)
    t = at - start
    matrix = np.zeros((len(at), samples.PIECES + 2))
    for k, weight in enumerate(((1 - t) ** 2 / 2, 0.5 + t * (1 - t), t * t / 2)):
        matrix[np.arange(len(at)), start + k] += weight
    return np.linalg.solve(matrix, nodes.reshape(len(at), -1)).reshape(nodes.shape)


def fitted(forces):
    """Coefficients (ratios, *ball, 3) from the forces (points, 3) at `samples.points` of each of `samples.ratios`."""
    ball = HalfBall(PIECES)
    nodes = [fit.fitted(ball, samples.points(ratio)[0], found, ratio, samples.POISSON)
             for found, ratio in zip(forces, samples.ratios(), strict=True)]
    return over_ratios(np.array(nodes))


def write(coefficients, path=FILE):
    """Save as 16-bit integers of one scale a component; the same coefficients give the same bytes."""
    scale = np.abs(coefficients).max(axis=(0, 1, 2, 3)) / 32767
    np.savez_compressed(path, coefficients=np.rint(coefficients / scale).astype(np.int16), scale=scale,
                        ratio_range=np.array([samples.LEAST, samples.LARGEST]))
