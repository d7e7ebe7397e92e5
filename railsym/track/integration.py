# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of the track in C: heading and place as integrals of the alignment.

heading' = curvature; o' = (cos(heading) cos(slope), sin(heading) cos(slope), -sin(slope)), z down. Within a piece the place is a
polynomial, from a Chebyshev series of the integrand whose tail is below rounding; places of the pieces are summed in doubled
precision, so that differences of places do not lose digits far from the start.
"""

import numpy as np
from numpy.polynomial import chebyshev

from railsym._core_track import PIECE, PLACE_POWERS, POWERS
from railsym.errors import TrackError
from railsym.track.piecewise import common_joints

_LONGEST = 128.0          # m, of a piece: keeps the rounding of x = (s - middle)/half under 1e-14 m
_TAIL = 5e-16             # part of the integrand that may be left out, relative to 1
_SHORTEST = 1e-3          # m
_NODES = 32

_X = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
# series of degree _NODES - 1 through values at the nodes
_TO_SERIES = 2.0 / _NODES * np.cos(np.pi * np.outer(np.arange(_NODES), np.arange(_NODES) + 0.5) / _NODES)
_TO_SERIES[0] *= 0.5
# row k: powers of x of the integral of the Chebyshev polynomial k
_INTEGRALS = np.zeros((PLACE_POWERS - 1, PLACE_POWERS))
for _k, _row in enumerate(np.eye(PLACE_POWERS - 1)):
    _powers = chebyshev.cheb2poly(chebyshev.chebint(_row[:_k + 1]))
    _INTEGRALS[_k, :len(_powers)] = _powers


def pieces(line, longest=_LONGEST):
    """Joints and pieces of an alignment.

    Parameters
    ----------
    line : railsym.track.alignment.Alignment

    Returns
    -------
    joints : ndarray, shape (n + 1,)
        m
    pieces : ndarray of railsym._core_track.PIECE, shape (n,)
    """
    joints = common_joints([function for function, _ in line.parts()], longest)
    while True:
        made, tail = _pieces_on(line, joints)
        long = tail > _TAIL
        if not long.any():
            break
        if (np.diff(joints)[long] < _SHORTEST).any():
            raise TrackError(f"the curvature at s = {joints[:-1][long][0]:.6g} m changes too fast to be integrated; are the units right?")
        joints = np.union1d(joints, 0.5 * (joints[1:] + joints[:-1])[long])
    _chain(made, joints)
    return joints, made


def _pieces_on(line, joints):
    """Pieces with heading and place from 0 at their middles, and the tails of their series."""
    made = np.zeros(len(joints) - 1, dtype=PIECE)
    made["middle"], made["half"] = 0.5 * (joints[1:] + joints[:-1]), 0.5 * np.diff(joints)
    half = made["half"][:, None]
    for name, (function, _) in zip(("curvature", "cant", "slope"), line.parts(), strict=True):
        made[name] = function.on(joints)
    made["heading"][:, 1:] = half * made["curvature"] / np.arange(1, POWERS + 1)
    heading, slope = (_at_nodes(made[name]) for name in ("heading", "slope"))
    level = np.sqrt(1.0 - slope**2)
    tail = np.zeros(len(made))
    for k, values in enumerate((np.cos(heading) * level, np.sin(heading) * level)):
        series = (values - values[:, :1]) @ _TO_SERIES.T      # a constant stays one, without rounding
        series[:, 0] += values[:, 0]
        tail = np.maximum(tail, np.abs(series[:, PLACE_POWERS - 1:]).max(axis=1))
        made["place"][:, k] = half * _integrals(series[:, :PLACE_POWERS - 1])
    made["place"][:, 2, 1:POWERS + 1] = -half * made["slope"] / np.arange(1, POWERS + 1)
    return made, tail


def _at_nodes(rows):
    total = np.zeros((len(rows), _NODES))
    for k in range(rows.shape[1] - 1, -1, -1):
        total = total * _X + rows[:, k:k + 1]
    return total


def _integrals(series):
    """Powers of x of the integrals from 0 of Chebyshev series, shape (n, PLACE_POWERS)."""
    out = series @ _INTEGRALS
    out[:, 0] = 0.0
    return out


def _chain(made, joints):
    """Heading and place of the middles: the pieces laid end to end, both 0 at s = 0."""
    heading, place = made["heading"], made["place"]
    signs = (-1.0) ** np.arange(heading.shape[1])
    ends = heading.sum(axis=1), heading @ signs
    high, low = _doubled_sums(ends, made, joints, _heading_at)
    heading[:, 0] = high
    c, s = np.cos(high) - low * np.sin(high), np.sin(high) + low * np.cos(high)
    along, across = place[:, 0].copy(), place[:, 1].copy()
    place[:, 0] = c[:, None] * along - s[:, None] * across
    place[:, 1] = s[:, None] * along + c[:, None] * across
    signs = (-1.0) ** np.arange(PLACE_POWERS)
    for k in range(3):
        ends = place[:, k].sum(axis=1), place[:, k] @ signs
        made["base"][:, k], made["base_low"][:, k] = _doubled_sums(ends, made, joints, lambda piece, x, k=k: np.polyval(piece["place"][k][::-1], x))


def _heading_at(piece, x):
    return np.polyval(piece["heading"][::-1], x)


def _doubled_sums(ends, made, joints, value):
    """Values at the middles, as a sum of two numbers each, so that a piece begins as the one before ends and s = 0 has 0."""
    right, left = (part.tolist() for part in ends)
    sums = [(0.0, 0.0)]
    for k in range(len(right) - 1):
        sums.append(_plus(_plus(sums[-1], right[k]), -left[k + 1]))
    origin = int(np.clip(np.searchsorted(joints, 0.0, side="right") - 1, 0, len(made) - 1))
    at = float(value(made[origin], (0.0 - made["middle"][origin]) / made["half"][origin]))
    zero = _plus(sums[origin], at)
    moved = [_plus(_plus(one, -zero[0]), -zero[1]) for one in sums]
    return np.array(moved).T


def _plus(pair, number):
    """(high, low) + number without losing what rounding takes (Knuth's two-sum)."""
    high, low = pair
    total = high + number
    back = total - high
    low += (high - (total - back)) + (number - back)
    high = total + low
    return high, low - (high - total)
