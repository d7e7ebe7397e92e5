# SPDX-License-Identifier: BSD-3-Clause
"""The linear critical speed of the non-linear Pendolino: of the table, not of how deep it goes, and where growth turns to decay."""

from functools import cache

import numpy as np
import pytest

import railsym as rs
from railsym.contact_pair import DEEPEST_IN_MOTION
from railsym.nonlinear.hopf import Stability
from railsym.nonlinear.rolling import RollingSystem

PAIR = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)


@cache
def rolling(deepest):
    return RollingSystem(rs.load_vehicle("pendolino").configured("noAS_K"), PAIR.table(deepest=deepest), law="fastsim")


@cache
def hopf(deepest):
    return Stability(rolling(deepest)).crossings([58.0, 70.0])[0][0]


@pytest.mark.parametrize("deepest", [2e-4, 3e-4, 5e-4, DEEPEST_IN_MOTION])
def test_critical_speed_at_every_depth_of_the_table(deepest):
    # 63.5 m/s: 64 strips a patch in place of 16, nodes of the shift every 25 to 50 um in place of 200, 24 and 36 levels in place of 11
    # (63.49 to 63.58 m/s, 2026-11-27); with 6 levels 61.5 to 63.2 m/s
    assert hopf(deepest).speed == pytest.approx(63.5, rel=3e-3)
    assert hopf(deepest).frequency_hz == pytest.approx(6.42, abs=0.02)


@pytest.mark.parametrize("factor", [0.995, 1.005])
def test_small_motions_grow_and_decay_as_the_eigenvalue_says(factor):
    # 20 periods of its own mode from 10 um, in the table that simulations make; the step of 1 ms adds 1e-4 1/s
    system, speed = rolling(DEEPEST_IN_MOTION), factor * hopf(DEEPEST_IN_MOTION).speed
    z = system.equilibrium(speed)
    values, vectors = np.linalg.eig(system.state_matrix(z))
    oscillating = np.flatnonzero(values.imag > 0.5)
    k = oscillating[np.argmax(values[oscillating].real)]
    shape, period = vectors[:, k], 2.0 * np.pi / values[k].imag
    steps = int(round(period / 1e-3))
    _, path = system.flow(z + 1e-5 * (shape / np.abs(shape[system.lateral]).max()).real, 20.0 * period, 20 * steps, 1)
    largest = np.abs(path[:20 * steps, 0]).reshape(20, steps).max(axis=1)
    growth = np.polyfit(np.arange(20) * period, np.log(largest), 1)[0]
    assert np.sign(growth) == np.sign(factor - 1.0)
    assert growth == pytest.approx(values[k].real, abs=1e-3)
