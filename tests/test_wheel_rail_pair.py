# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces of S1002 on UIC 60, one to one in forty: a wheelset pushed aside until its flange carries it."""

import numpy as np
import pytest
from oracles.wheel_rail_cases import SPEED, rolling, wheelset

import railsym as rs

WEIGHT = 1.2e5
VERTICAL = np.ix_([2, 4], [2, 4])
WEIGHTS = np.array([1, -8, 8, -1]) / 12


@pytest.fixture(scope="module")
def pair():
    return rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435)


def balanced(forces, shift, yaw=0.0):
    """Coordinates at a lateral shift where the wheels carry WEIGHT without a moment in roll, by Newton's method on the blocks."""
    q, steps = np.array([0.0, 0.0, 0.0, yaw, 0.0, 0.0]), []
    for y in np.append(np.arange(0.0, shift, 2e-4), shift):
        q[1] = y
        for step in range(30):
            rows, blocks = forces.rows(q, rolling(), SPEED, seed=(1.0, 0.0))
            error = rows[0, [2, 4]] - [WEIGHT, 0.0]
            if np.abs(error).max() < 1e-7 * WEIGHT:
                break
            change = -np.linalg.solve(blocks[0][VERTICAL], error)
            q[[2, 4]] += change * min(1.0, 5e-5 / np.abs(change).max())
        steps.append(step)
    return q, max(steps)


def test_wheelset_rides_up_its_flange(pair):
    forces = wheelset(pair, friction=0.0)
    lateral = []
    for shift in (0.0, 1e-3, 3e-3, 5e-3, 6e-3, 6.3e-3):
        q, steps = balanced(forces, shift)
        assert steps <= 10  # the blocks are the slopes: Newton's method would not get there with others
        rows, _ = forces.rows(q, rolling(), SPEED)
        lateral.append(rows[0, 1])
    found = forces.outputs()
    assert np.all(np.diff(lateral) > 0) and lateral[-1] > 5e4
    assert found.Y[1] - found.Y[0] == pytest.approx(lateral[-1]) and found.Q.sum() == pytest.approx(WEIGHT)
    assert found.patches[1] == 2 and np.degrees(found.angle[1].max()) > 45


def test_normal_forces_do_not_drive_the_wheelset(pair):
    """Normals meet the axle and are square to the rail: no moment about the axle, no force along the track.

    The table knows the yawed wheel's outline to the second order in yaw: 1e-5 of N r at 10 mrad.
    """
    forces = wheelset(pair, friction=0.0)
    for shift, yaw in ((5e-3, 5e-3), (6e-3, -5e-3), (6.3e-3, -1e-2)):
        rows, _ = forces.rows(balanced(forces, shift, yaw)[0], rolling(), SPEED)
        assert abs(rows[0, 5]) < 2e-5 * WEIGHT * 0.46
        assert abs(rows[0, 0]) < 1e-9 * WEIGHT


# Not midway between nodes of the table (0.2 mm apart on the tread), where its splines have other second slopes on both sides.
@pytest.mark.parametrize("shift, yaw", [(3.6e-4, 0.0), (3e-3, 4e-3), (5.03e-3, -3e-3), (6.2e-3, 2e-3)])
def test_pencil_at_one_and_two_points(pair, shift, yaw):
    forces = wheelset(pair, law="polach", damping=1.0)
    q, u = balanced(wheelset(pair, friction=0.0), shift, yaw)[0], rolling(x=0.05, y=0.03, yaw=0.02)
    _, blocks = forces.rows(q, u, SPEED, seed=(1.0, 0.0))
    for j, step in enumerate([1e-6, 2e-7, 2e-7, 2e-6, 2e-7, 1e-3]):
        at = [forces.rows(q + k * step * np.eye(6)[j], u, SPEED)[0][0] for k in (-2, -1, 1, 2)]
        expected = WEIGHTS @ at / step
        scale = max(100.0, np.abs(expected).max())  # the spin's column is zero
        np.testing.assert_allclose(blocks[0, :, j] / scale, expected / scale, rtol=0, atol=2e-6)


def test_static_loads_of_a_vehicle_on_the_pair(pair):
    vehicle = rs.load_vehicle("cooperrider")
    with pytest.raises(rs.RailsymError, match=r"wheelset1: its centre is 0.425 m above the rails, the contact is for wheels of 0.46 m; .*wheel_radius"):
        rs.WheelRail(vehicle, pair)
    own = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435, wheel_radius=0.425)
    forces = rs.WheelRail(vehicle, own, law="fastsim", friction=0.0)
    u = np.zeros(forces.size)
    for one in forces.wheelsets:
        u[one.first + 5] = -30.0 / 0.425
    forces.rows(np.zeros(forces.size), u, 30.0)
    from railsym.linear import rolling_vehicle

    np.testing.assert_allclose(forces.outputs().Q, rolling_vehicle(vehicle).preload.wheel_loads, rtol=1e-8)
