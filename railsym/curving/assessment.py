# SPDX-License-Identifier: BSD-3-Clause
"""Forces of a curving study against the limits of ``railsym.criteria``; no verdict on a limit that is only recalled."""

from __future__ import annotations

import numpy as np

from railsym.criteria.derailment import quasi_static_Y_limit
from railsym.criteria.limits import Assessed, limits, sum_Y_limit


def assessed(found):
    """The largest of each quantity over all curves, against its limit.

    Parameters
    ----------
    found : Curving

    Returns
    -------
    tuple of (Assessed, str)
        And where: wheel or wheelset, radius, speed.
    """
    loads = found.static_load.reshape(-1, 2).mean(axis=1)
    shift = [sum_Y_limit(load) for load in loads]
    guiding = [quasi_static_Y_limit(radius) for radius in found.radius]
    parts = [
        _worst(found, "Y/Q quasi-static", "-", found.YQ, found.wheels, lambda j, k, i: limits("YQ")),
        _worst(found, "Y quasi-static", "N", found.Y, found.wheels, lambda j, k, i: guiding[k]),
        _worst(found, "Q quasi-static", "N", found.Q, found.wheels, lambda j, k, i: limits("Q_quasi_static")),
        _worst(found, "sum Y quasi-static", "N", found.sum_Y, found.wheelsets, lambda j, k, i: shift[i]),
    ]
    if found.largest is not None:
        parts += [
            _worst(found, "Y/Q, 2 m mean, 99.85 %", "-", found.largest["YQ"], found.wheels, lambda j, k, i: limits("YQ")),
            _worst(found, "sum Y, 2 m mean, 99.85 %", "N", found.largest["sum_Y"], found.wheelsets, lambda j, k, i: shift[i]),
        ]
    return tuple(part for part in parts if part is not None)


def _worst(found, name, unit, values, items, limit_of):
    """The value nearest to, or farthest beyond, its limit."""
    if not np.isfinite(values).any() and not np.isinf(values).any():
        return None
    bound = np.array([[[limit_of(j, k, i).value for i in range(values.shape[2])] for k in range(values.shape[1])] for j in range(values.shape[0])])
    j, k, i = np.unravel_index(np.nanargmax(np.abs(values) / bound), values.shape)
    where = f"{items[i]}, R = {found.radius[k]:g} m, {3.6 * found.speed[j, k]:.4g} km/h"
    return Assessed(name, float(values[j, k, i]), unit, limit_of(j, k, i)), where
