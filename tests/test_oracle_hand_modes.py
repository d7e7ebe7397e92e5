# SPDX-License-Identifier: BSD-3-Clause
"""Car-body modes and wheel loads of the independent model against textbook formulas."""

import numpy as np
import pytest
from oracles import hand_modes, stand_ins
from oracles.hand_modes import SpringPlane
from oracles.linear_vehicle import independent_model

SECONDARY = SpringPlane(longitudinal=4 * 160e3, lateral=4 * 160e3, vertical=4 * 430e3, half_spacing=1.0,
                        half_base=9.5, roll=2 * 0.94e6 + 4 * 10.5e3, pitch=4 * 10.5e3)
PRIMARY = SpringPlane(longitudinal=8 * 31.391e6, lateral=8 * 3.884e6, vertical=8 * 1.22e6, half_spacing=1.0,
                      half_base=1.28)
SPRINGS_BELOW_CAR = 1.8 - 0.8275


def oracle_frequencies(model, chosen, together=()):
    """Undamped frequencies (Hz) with all but `chosen` held; `together` names that move as one, a tuple a group."""
    columns = []
    for group in [(name,) for name in chosen] + list(together):
        columns.append([float(name in group) for name in model.names])
    motion = np.array(columns).T
    # A Maxwell element without damping follows its ends: s = e carries no force, and is left out with its spring.
    inner = model.first_order
    stiffness = model.stiffness[np.ix_(~inner, ~inner)].copy()
    coupling = model.stiffness[np.ix_(~inner, inner)]
    if inner.any():
        stiffness -= coupling @ np.linalg.solve(model.stiffness[np.ix_(inner, inner)], coupling.T)
    motion = motion[~inner]
    mass = model.mass[np.ix_(~inner, ~inner)]
    return hand_modes.frequencies(motion.T @ mass @ motion, motion.T @ stiffness @ motion)


@pytest.fixture(scope="module")
def coach():
    return independent_model(stand_ins.coach(), None, 0.0)


# Both sides are exact to first order; only round-off of stiffnesses 1e8 against 1e5 differs.
CLOSE = dict(rel=1e-9)


def test_bounce(coach):
    assert oracle_frequencies(coach, ["car.z"])[0] == pytest.approx(hand_modes.bounce(32000.0, SECONDARY), **CLOSE)
    found = oracle_frequencies(coach, ["car.z"], [("bogie1.z", "bogie2.z")])
    assert found == pytest.approx(hand_modes.bounce_with_bogies(32000.0, 2 * 2615.0, SECONDARY, PRIMARY), **CLOSE)


def test_pitch(coach):
    expected = hand_modes.pitch(32000.0, 1.97e6, SECONDARY, SPRINGS_BELOW_CAR)
    assert oracle_frequencies(coach, ["car.x", "car.pitch"]) == pytest.approx(expected, **CLOSE)


def test_sway_over_held_bogies(coach):
    expected = hand_modes.sway(32000.0, 56800.0, SECONDARY, SPRINGS_BELOW_CAR)
    assert oracle_frequencies(coach, ["car.y", "car.roll"]) == pytest.approx(expected, **CLOSE)
    # The weight term must matter, or this test could not see its sign.
    light = hand_modes.sway(32000.0, 56800.0, SECONDARY, SPRINGS_BELOW_CAR, gravity=0.0)
    assert not np.allclose(light, expected, rtol=1e-3)


def test_sway_with_bogies(coach):
    found = oracle_frequencies(coach, ["car.y", "car.roll"], [("bogie1.y", "bogie2.y"), ("bogie1.roll", "bogie2.roll")])
    heights = (SPRINGS_BELOW_CAR, 0.8275 - 0.6, 0.6 - 0.46)
    expected = hand_modes.sway_with_bogies((32000.0, 56800.0), (2 * 2615.0, 2 * 1722.0), SECONDARY, PRIMARY, heights)
    assert found == pytest.approx(expected, **CLOSE)


def test_wheel_loads(coach):
    expected = hand_modes.wheel_load(32000.0, 2615.0, 1813.0)
    assert coach.wheel_loads == pytest.approx(np.full(8, expected), rel=1e-9)
