# SPDX-License-Identifier: BSD-3-Clause
"""Modes followed over speed."""

from types import SimpleNamespace

import numpy as np
import pytest
from oracles.synthetic_models import CrossingPaths, Train, coasting

from railsym.errors import ModelError
from railsym.tracking import assign, track_modes


def test_paths_that_cross_keep_their_modes():
    """The rising frequency of the pair passes the oscillator's at 55 m/s: order of frequency would swap the two."""
    case = CrossingPaths()
    speeds = np.linspace(5.0, 120.0, 9)
    tracked = track_modes(case.model(), speeds)
    expected = case.frequencies(speeds)
    assert expected[1, 0] < expected[2, 0] and expected[1, -1] > expected[2, -1]
    found = [tracked.frequency_hz[:, k] * 2 * np.pi for k in range(6) if tracked.eigenvalue[0, k].imag > 0]
    for path in expected:
        assert min(np.abs(one - path).max() for one in found) < 1e-9


def test_order_at_each_speed_is_a_permutation_of_the_dense_eigenvalues():
    model = Train().model()
    speeds = [20.0, 35.0, 60.0]
    tracked = track_modes(model, speeds)
    for row, speed in zip(tracked.eigenvalue, speeds):
        dense = np.linalg.eigvals(model.state_matrix(speed))
        dense = dense[np.abs(dense) > 1e-3]
        assert np.allclose(np.sort(np.abs(row)), np.sort(np.abs(dense)), rtol=1e-6)


def test_assignment_undoes_a_shuffle():
    rng = np.random.default_rng(4)
    right = rng.normal(size=(12, 12)) + 1j * rng.normal(size=(12, 12))
    first = SimpleNamespace(eigenvalue=1j * np.arange(1.0, 13.0), right=right, left=np.linalg.inv(right).conj().T)
    shuffle = rng.permutation(12)
    # eigenvalues of the second reversed: only the vectors tell the modes apart
    second = SimpleNamespace(eigenvalue=first.eigenvalue[::-1][shuffle], right=right[:, shuffle], left=first.left[:, shuffle])
    order, similarity = assign(first, second)
    assert np.array_equal(shuffle[order], np.arange(12))
    assert np.allclose(similarity, 1.0)


def test_following_back_gives_the_same_paths():
    model, speeds = Train(yaw_dampers=(True, True, True, False)).model(), np.array([30.0, 40.0, 52.0])
    up, down = track_modes(model, speeds), track_modes(model, speeds[::-1])
    watched = (np.abs(up.frequency_hz - 5.0) < 4.9).all(axis=0) & (up.damping_ratio < 0.3).all(axis=0)
    assert watched.sum() >= 12
    ends = {tuple(np.round(up.eigenvalue[[0, -1], k], 6)) for k in np.flatnonzero(watched)}
    back = {tuple(np.round(down.eigenvalue[[-1, 0], k], 6)) for k in range(down.eigenvalue.shape[1])}
    assert ends <= back


def test_hunting_is_followed_into_instability_and_named():
    tracked = track_modes(Train().model(), np.linspace(20.0, 80.0, 7))
    hunting = [k for k, label in enumerate(tracked.label) if label == "bogie hunting, leading"]
    damping, above = tracked.damping_ratio, tracked.eigenvalue[0].imag > 0
    onset = [k for k in hunting if damping[0, k] > 0.1 and damping[-1, k] < 0 and above[k]]
    assert len(onset) == 1
    assert (np.diff(tracked.damping_ratio[:, onset[0]]) < 0).all()
    assert tracked.message == "every mode was followed"


def test_constant_speed_modes_are_left_out():
    tracked = track_modes(coasting(), [10.0, 20.0])
    assert tracked.eigenvalue.shape == (2, 6) and np.abs(tracked.eigenvalue).min() > 1.0


@pytest.mark.parametrize("speeds", [[], [10.0, 10.0], [10.0, 30.0, 20.0], [[10.0], [20.0]]])
def test_speeds_must_rise_or_fall(speeds):
    with pytest.raises(ModelError, match="strictly"):
        track_modes(coasting(), speeds)
