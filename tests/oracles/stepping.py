# SPDX-License-Identifier: BSD-3-Clause
"""Integrators over a model without the driver, and what a linear vehicle does exactly."""

import numpy as np
from scipy.linalg import expm

from railsym._core_integrator import Integrator
from railsym.contact import LinearContact
from railsym.linear import RollingVehicle


def blocks(model):
    """Number of the body of each coordinate that is no internal one."""
    starts = [model.topology.start[body.name] for body in model.vehicle.bodies]
    second = int((~model.topology.first_order).sum())
    return np.searchsorted(starts, np.arange(second), side="right") - 1


def integrator(model, step, rho=0.9, tolerance=1e-6):
    return Integrator(model.assembly, blocks(model), step, rho, tolerance)


def rolling_model(vehicle, speed, **contact):
    """A preloaded model on linear contact, alone with its work space."""
    rolling = RollingVehicle(vehicle)
    rolling.model.add_wheels(rolling.contacts(LinearContact(**contact).resolved(vehicle.contact)))
    rolling.model.set_speed(speed)
    return rolling.model


def motion(it, q, u, steps, every=1):
    """q at samples (m + 1, n), from q and u."""
    n = it.size
    it.set_channels([("position", k, 0, 0) for k in range(n)])
    assert it.start(0.0, q, u) == 0
    samples = np.empty((steps // every, n))
    status, rows = it.run(steps, every, samples)
    assert (status, rows) == (0, steps // every)
    return np.vstack([q, samples])


def linear_motion(lin, q, times):
    """States (m, ns) of x' = A x from displacements q (n,) at rest against the rolling motion; equidistant times."""
    x = np.zeros(len(lin.states))
    names = list(lin.model.coordinates)
    for k, state in enumerate(lin.states):
        if state in names:
            x[k] = q[names.index(state)]
    one, found = expm(lin.A * (times[1] - times[0])), [x]
    for _ in times[1:]:
        found.append(one @ found[-1])
    return np.array(found)
