# SPDX-License-Identifier: BSD-3-Clause
"""Shooting and continuation against a motion whose branch, fold and multipliers are known in closed form.

    x' = a r-part - omega y, y' likewise, with r' = r (V - V0 + b r^2 - c r^4): the normal form of a subcritical Hopf point with a fold at
    V0 - b^2/(4 c), r^2 = b/(2 c); on the branch the multiplier is exp(T (2 b r^2 - 4 c r^4)).
"""

import numpy as np
import pytest

from railsym.nonlinear.continuation import from_hopf, from_motion
from railsym.nonlinear.hopf import Hopf
from railsym.nonlinear.rolling import FlowError

V0, OMEGA = 20.0, 30.0
B, C = 2.0e6, 2.0e11        # 1/(s m^2), 1/(s m^4): fold at 15 m/s with 2.236 mm


class Normal:
    """The normal form in the place of a vehicle; states are y of a wheelset, its rate, and one that decays fast."""

    names, wheelsets, size, dt = ("wheelset.y", "wheelset.y.rate", "other.y"), ("wheelset",), 3, 1e-3
    lateral, lateral_rate = np.array([0]), np.array([1])

    def __init__(self):
        self.speed, self.integrations = None, 0

    def set_speed(self, speed):
        self.speed = speed

    def slope(self, z):
        x, y = z[0], z[1] / OMEGA
        growth = self.speed - V0 + B * (x * x + y * y) - C * (x * x + y * y) ** 2
        return np.array([growth * x + OMEGA * y, OMEGA * (growth * y - OMEGA * x), -50.0 * z[2] + 3.0 * x])

    def flow(self, z, duration, steps, every=None):
        self.integrations += 1
        h, rows = duration / steps, []
        for k in range(steps):
            a = self.slope(z)
            b = self.slope(z + 0.5 * h * a)
            c = self.slope(z + 0.5 * h * b)
            z = z + h / 6.0 * (a + 2.0 * b + 2.0 * c + self.slope(z + h * c))
            if abs(z[0]) > 10e-3:
                raise FlowError("left")
            rows.append([z[0]])
        return z, np.array(rows)


@pytest.fixture(scope="module")
def branch():
    shape = np.array([1.0, 1j * OMEGA, 3.0 / (50.0 + 1j * OMEGA)])
    return from_hopf(Normal(), Hopf(V0, OMEGA, np.zeros(3), shape, True), (10.0, 22.0), points=80)


def test_branch_turns_at_the_fold_of_the_normal_form(branch):
    assert len(branch.folds) == 1
    fold = branch.folds[0]
    assert fold.speed == pytest.approx(V0 - B**2 / (4.0 * C), abs=1e-4)
    # at a fold the speed does not tell the amplitude: 1e-4 m/s are 0.4 % of it
    assert fold.amplitude.max() == pytest.approx(np.sqrt(B / (2.0 * C)), rel=1e-2)


def test_orbits_lie_on_the_normal_form(branch):
    square = branch.amplitude**2
    # extremes over 2.6 ms samples miss the crest by up to (omega h/2)^2/2
    np.testing.assert_allclose(branch.speed, V0 - B * square + C * square**2, atol=0.02)
    assert branch.frequency_hz == pytest.approx(OMEGA / (2.0 * np.pi), rel=1e-6)
    assert branch.speed[0] < V0 and branch.ending == "the end of the speeds asked for"


def test_floquet_multipliers_are_those_of_the_normal_form(branch):
    square = branch.amplitude**2
    exact = np.exp(2.0 * np.pi / OMEGA * (2.0 * B * square - 4.0 * C * square**2))
    # differences over 1 um err by their curvature, some 1e-3
    np.testing.assert_allclose(np.abs(branch.dominant), exact, rtol=5e-3, atol=5e-3)
    below, above = square < 0.9 * B / (2.0 * C), square > 1.1 * B / (2.0 * C)
    assert not branch.stable[below].any() and branch.stable[above].all() and above.sum() > 5


def test_branch_from_a_simulated_motion_reaches_the_same_fold():
    system = Normal()
    system.set_speed(17.0)
    z = np.array([3e-3, 0.0, 0.0])
    for _ in range(30):
        z, _ = system.flow(z, 2.0 * np.pi / OMEGA, 209)
    found = from_motion(system, z, 2.0 * np.pi / OMEGA, 17.0, (10.0, 22.0), -1.0, points=12)
    assert found.folds[0].speed == pytest.approx(V0 - B**2 / (4.0 * C), abs=1e-4)
    assert found.stable[0] and not found.stable[-1]
