# SPDX-License-Identifier: BSD-3-Clause
"""Groups of bends that become the corner of the lines on either side."""

import numpy as np
import pytest

from railsym.dampers.corners import with_corners
from railsym.dampers.parametrisation import Parametrisation

NODES = np.array([0.0, 0.004, 0.008, 0.012, 0.016, 0.0185, 0.0205, 0.0215, 0.024, 0.028, 0.034, 0.042, 0.05])
CORNER, BEFORE, AFTER = 0.0203, 3e5, 1e5          # m/s; N s/m


def valve(speed):
    """N: straight up to the corner, and on with less slope."""
    return np.where(speed < CORNER, BEFORE * speed, BEFORE * CORNER + AFTER * (speed - CORNER))


def unknowns(force, nodes=NODES):
    made = Parametrisation("viscous", nodes, None, float(force[-1]), True, 1)
    return made, made.vector(force, np.inf, 1e-3)


def test_three_bends_become_the_corner_between_their_lines():
    """Steep before the corner and too flat behind it, as least squares may end."""
    force = valve(NODES)
    force[6:8] += [220.0, 135.0]
    made, x = with_corners(*unknowns(force))
    found = made.forces(made.split(x)[0])
    assert CORNER in [pytest.approx(node, abs=1e-12) for node in made.damping_nodes]
    assert np.abs(found - valve(made.damping_nodes)).max() < 1e-9 * force[-1]
    assert made.split(x)[2] == pytest.approx([1.0])          # the lag, ms, is left alone


def test_either_side_of_an_asymmetric_curve():
    nodes = np.concatenate([-NODES[:0:-1], NODES])
    true = np.where(nodes < 0.0, -0.75 * valve(-nodes), valve(nodes))
    force = true.copy()
    force[np.isin(nodes, NODES[6:8])] += [220.0, 135.0]
    force[np.isin(nodes, -NODES[6:8])] -= [101.25, 165.0]
    made, x = with_corners(*unknowns(force, nodes))
    found = made.forces(made.split(x)[0])
    wanted = np.where(made.damping_nodes < 0.0, -0.75 * valve(-made.damping_nodes), valve(made.damping_nodes))
    assert np.abs(found - wanted).max() < 1e-9 * force[-1]


def test_a_curve_without_a_corner_is_left_alone():
    assert with_corners(*unknowns(4e5 * NODES / (1.0 + NODES / 0.03))) is None
