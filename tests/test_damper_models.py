# SPDX-License-Identifier: BSD-3-Clause
"""Damper models: records of force laws, tangents, describing functions, refusals."""

import numpy as np
import pytest

from railsym.dampers.models import DamperModel
from railsym.errors import ModelError


def test_tangent_of_curves():
    model = DamperModel("maxwell", damping_curve=([0.0, 0.1, 0.2], [0.0, 1e4, 2e4]), series_stiffness_curve=([0.0, 0.1], [3e6, 6e6]))
    assert model.linearised() == pytest.approx((1e5, 3e6), rel=1e-12)
    assert DamperModel("viscous", damping=2e5).linearised() == (2e5, np.inf)


def test_describing_function_of_a_linear_model_is_its_dynamic_stiffness():
    model = DamperModel("maxwell", damping=3e5, series_stiffness=4e6)
    # 512 steps a cycle.
    assert model.describing_function(1e-3, 2.0) == pytest.approx(model.dynamic_stiffness(2.0), rel=1e-5)
    assert model.linearised(1e-3, 2.0) == pytest.approx((3e5, 4e6), rel=1e-4)


def test_describing_function_of_dry_friction():
    """F = F0 sign(v): 4 F0/(pi a) in phase with speed; the corner at 1 % of the speed costs 1e-4."""
    model = DamperModel("viscous", damping_curve=([0.0, 1e-4, 2e-4, 1.0], [0.0, 1000.0, 1000.0, 1000.0]))
    found = model.describing_function(1e-3, 10.0)
    assert found.imag == pytest.approx(4.0 * 1000.0 / (np.pi * 1e-3), rel=1e-3)
    assert abs(found.real) < 1e-3 * found.imag


@pytest.mark.parametrize(("kind", "given", "words"), [
    ("elastic", {"damping": 1.0}, "kinds: viscous, maxwell"),
    ("viscous", {}, "either damping or damping_curve"),
    ("viscous", {"damping": -1.0}, "not above 0"),
    ("viscous", {"damping": 1.0, "series_stiffness": 1.0}, "no series stiffness"),
    ("maxwell", {"damping": 1.0}, "series_stiffness"),
    ("viscous", {"damping_curve": ([0.0, 0.1], [0.0, -5.0])}, "falls with speed"),
    ("viscous", {"damping_curve": ([0.01, 0.1], [0.0, 5.0])}, "begins at"),
])
def test_refusals(kind, given, words):
    with pytest.raises(ModelError, match=words):
        DamperModel(kind, **given)
