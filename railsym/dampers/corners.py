# SPDX-License-Identifier: BSD-3-Clause
"""Corners of a damping curve, where a valve opens.

Least squares from a rounded start may end with one corner resolved into several bends, steep before the corner and too flat behind it: a minimum of
its own, as the prior takes one large bend for as likely as three small ones. Here such a group of bends is replaced by the corner of
the straight lines on either side of it; whoever calls keeps it where the tests and the prior like it better.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym.dampers.solve import bends

_LARGE = 4.0        # usual changes of slope: the bend that a corner is built around
_SOME = 2.0         # the least that belongs to it
_REACH = 1.5        # ratio of speeds from the largest bend to the ends of its group


def with_corners(made, x):
    """The same curve with its groups of large bends, the largest of either direction, replaced by corners.

    Parameters
    ----------
    made : Parametrisation
    x : ndarray

    Returns
    -------
    (Parametrisation, ndarray) or None
        None where there is no such group.
    """
    if made.damping_nodes is None:
        return None
    nodes, bend = np.array(made.damping_nodes), bends(made, x)
    damping, stiffness, lag = made.split(x)
    force = made.forces(damping)
    moved = [_sharpen(nodes, force, bend, side) for side in (nodes[1:-1] > 0.0, nodes[1:-1] < 0.0)]
    if not any(moved):
        return None
    shaped = replace(made, damping_nodes=nodes)
    return shaped, np.concatenate([shaped.vector(force, np.ones(max(len(stiffness), 1)), 0.0)[:len(nodes) - 1], stiffness, lag])


def _sharpen(nodes, force, bend, side):
    """Replace the largest group of bends on one side, in place; whether there was one."""
    size = np.where(side, np.abs(bend), 0.0)
    if size.size == 0 or size.max() < _LARGE:
        return False
    at = nodes[1:-1]
    top = np.abs(at[np.argmax(size)])
    group = np.flatnonzero((size > _SOME) & (np.abs(at) < _REACH * top) & (np.abs(at) * _REACH > top)) + 1
    first, last = group[0], group[-1]
    before = (force[first] - force[first - 1]) / (nodes[first] - nodes[first - 1])
    after = (force[last + 1] - force[last]) / (nodes[last + 1] - nodes[last])
    # force[first] + before (w - first) = force[last] + after (w - last)
    corner = (force[last] - force[first] + before * nodes[first] - after * nodes[last]) / (before - after) if before != after else np.inf
    if last == first or not top / _REACH < np.abs(corner) < top * _REACH or corner * nodes[first] < 0.0:
        return False
    # bends that overshoot have their corner beyond them
    inner = np.flatnonzero((nodes >= min(nodes[first], corner)) & (nodes <= max(nodes[last], corner)))
    w, lines = nodes[inner], np.array([force[first] - before * nodes[first], force[last] - after * nodes[last]])
    force[inner] = np.where(w < corner, lines[0] + before * w, lines[1] + after * w)
    nearest = inner[np.argmin(np.abs(w - corner))]
    nodes[nearest], force[nearest] = corner, lines[0] + before * corner
    return True
