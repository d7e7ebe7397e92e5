# SPDX-License-Identifier: BSD-3-Clause
"""Every kernel: its pencil by the complex step, and its lanes against the complex kernel.

The complex step differentiates the residual itself, at random large angles, frame motions
and parameters; the pencil comes from the tangents that `derive` pushed through the code.
"""

from dataclasses import replace

import numpy as np
import pytest
from oracles.element_pair import deformation
from oracles.kernel_inputs import CURVE, HALF_CURVE, STEP, random_instance

from railsym import _core

# (cq, cu, ca): stiffness, damping, mass, and all three together as an integrator asks for them.
SEEDS = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.7, -1.3, 2.1)]

# Roundoff of some thousand operations on numbers of order one, relative to the largest entry.
ROUNDOFF = 1e-12

PLAIN = ("rigid_body", "wheelset", "wheelset_with_axleboxes", "bushing", "wheel_rail")
LAWS = {
    "spring_damper": {"kind": "spring_damper", "preload": 0.8, "stiffness": 1.7, "damping": 0.6},
    "spring_damper_curves": {"kind": "spring_damper", "stiffness": 0.4, "stiffness_curve": CURVE, "damping_curve": CURVE},
    "maxwell": {"kind": "maxwell", "preload": -0.3, "stiffness": 1.4, "damping": 0.9},
    "maxwell_curves": {"kind": "maxwell", "stiffness": 0.5, "stiffness_curve": HALF_CURVE, "damping_curve": CURVE},
    "bump_stop": {"kind": "bump_stop", "preload": 0.2, "clearance": 0.25, "stiffness": 2.0},
    "bump_stop_curve": {"kind": "bump_stop", "clearance": 0.1, "stiffness": 0.3, "stiffness_curve": HALF_CURVE},
    "actuator_force": {"kind": "actuator_force", "damping": 0.5, "command": 1.3},
    "actuator_length": {"kind": "actuator_length", "preload": 0.6, "stiffness": 1.1, "damping": 0.5, "command": 0.2},
    "actuator_limits": {"kind": "actuator_length", "preload": 0.2, "stiffness": 1.1, "damping": 0.5, "command": 0.6, "lag": 0.4,
                        "rate_limit": 1.2, "force_limit": 0.9},
    "actuator_thrust": {"kind": "actuator_force", "damping": 0.5, "command": -0.7, "lag": 0.8, "rate_limit": 1.4, "force_limit": 1.5},
    "actuator_stuck": {"kind": "actuator_length", "stiffness": 1.1, "damping": 0.5, "lag": 0.4, "rate_limit": 1.2, "fault": "stuck"},
    "actuator_damped": {"kind": "actuator_length", "preload": 0.2, "stiffness": 1.1, "damping": 0.5, "lag": 0.4, "force_limit": 0.9,
                        "bypass_damping": 0.8, "fault": "damped"},
}
# Elongations below, inside and above the tables and the clearance.
ELONGATIONS = (-0.8, -0.15, 0.05, 0.35, 0.9)
# Rates so slow that they stay inside the tables, and so fast that they leave them.
PACES = (0.05, 1.0)


def stretched(name, rng, elongation, pace):
    """Random line or axis element at a chosen elongation; all motion scaled by ``pace``."""
    one = random_instance(name, rng)
    slow = {key: pace * one.get(f"{key}0", 3) for key in ("dD", "wf")}
    one = one.having(u=pace * one.u, **slow)
    return one.having(e0=one.get("e0") + deformation(one, one.q[:12])[0] - elongation)


def complex_step(one, seed, law):
    """Column j: derivative of the residual along the seed of coordinate j."""
    columns = []
    for direction in 1j * STEP * np.eye(one.kernel.coordinates):
        moved = one.inputs(*(c * direction for c in seed))
        columns.append(_core.kernel_complex(one.name, moved, seed, law)[0].imag / STEP)
    return np.array(columns).T


def mismatch(one, seed, law=None, pencil=None):
    """Largest difference of pencil and complex step, relative to the largest entry."""
    if pencil is None:
        pencil = _core.kernel_complex(one.name, one.inputs(), seed, law)[1].real
    expected = complex_step(one, seed, law)
    return np.abs(pencil - expected).max() / max(np.abs(expected).max(), 1e-300)


def law_cases(name, rng):
    return [stretched(name, rng, e, pace) for e in ELONGATIONS for pace in PACES]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", PLAIN)
def test_pencil_is_the_derivative_of_the_residual(name, seed):
    rng = np.random.default_rng(7)
    for _ in range(6):
        assert mismatch(random_instance(name, rng), seed) < ROUNDOFF


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ["line", "axis"])
def test_pencil_with_every_force_law(name, law):
    rng = np.random.default_rng(8)
    for one in law_cases(name, rng):
        for seed in SEEDS[:2] + SEEDS[3:]:
            assert mismatch(one, seed, LAWS[law]) < ROUNDOFF


@pytest.mark.parametrize("name", ["line", "axis"])
def test_force_elements_have_no_mass(name):
    one = random_instance(name, np.random.default_rng(9))
    assert not _core.kernel_complex(name, one.inputs(), SEEDS[2], LAWS["maxwell"])[1].any()


@pytest.mark.parametrize("name", PLAIN)
def test_check_of_the_pencil_can_fail(name):
    """A wrong seed and a wrong entry, of a thousand roundoffs, are both seen."""
    one = random_instance(name, np.random.default_rng(10))
    pencil = _core.kernel_complex(name, one.inputs(), SEEDS[3])[1].real
    assert mismatch(one, SEEDS[3], pencil=pencil) < ROUNDOFF
    assert mismatch(one, (0.8, -1.2, 2.1), pencil=pencil) > 1e-3
    wrong = pencil.copy()
    wrong[2, 2] += 1e3 * ROUNDOFF * np.abs(pencil).max()
    assert mismatch(one, SEEDS[3], pencil=wrong) > ROUNDOFF


def test_check_of_the_laws_can_fail():
    """The tangent of a spring is not that of a spring of another stiffness."""
    one = random_instance("line", np.random.default_rng(11))
    law = LAWS["spring_damper"]
    pencil = _core.kernel_complex("line", one.inputs(), SEEDS[0], law | {"stiffness": 1.701})[1].real
    assert mismatch(one, SEEDS[0], law, pencil) > 1e-5


def instances(name, rng, count):
    """Different instances with different laws, where the kernel has laws."""
    kinds = list(LAWS.values()) if _core.kernels()[name].has_law else [None]
    laws = [kinds[k % len(kinds)] for k in range(count)]
    ones = [random_instance(name, rng) for _ in range(count)]
    return ones, laws


def assemble(name, ones, laws, index):
    """Assembly of several instances of one kernel."""
    kernel = _core.kernels()[name]
    is_angle = np.zeros(index.max() + 1, dtype=bool)
    is_angle[index[:, kernel.slots[:, 3] >= 0]] = True
    assembly = _core.Assembly(is_angle)
    table = np.array([one.parameters for one in ones])
    assembly.add(name, table, index, _core.Laws(laws) if laws[0] else None)
    return assembly


@pytest.mark.parametrize("name", sorted(_core.kernels()))
def test_lanes_agree_with_the_complex_kernel(name):
    """Eleven different instances: one full block of lanes, and one that is padded."""
    ones, laws = instances(name, np.random.default_rng(12), 11)
    size = ones[0].kernel.coordinates
    index = np.arange(11 * size).reshape(11, size)
    assembly = assemble(name, ones, laws, index)
    state = [np.concatenate([getattr(one, part) for one in ones]) for part in "qua"]
    residual, pencil = assembly.residual(*state), assembly.pencil(*state, SEEDS[3])
    for k, (one, law) in enumerate(zip(ones, laws, strict=True)):
        r, s = _core.kernel_complex(name, one.inputs(), SEEDS[3], law)
        own = index[k]
        # The same operations in another order of the compiler's choice.
        np.testing.assert_allclose(residual[own], r.real, rtol=0, atol=1e-13 * np.abs(r).max())
        np.testing.assert_allclose(pencil[np.ix_(own, own)], s.real, rtol=0, atol=1e-13 * np.abs(s).max())
        pencil[np.ix_(own, own)] = 0.0
    assert not pencil.any()


@pytest.mark.parametrize("name", sorted(_core.kernels()))
def test_single_real_kernel_agrees_with_the_complex_one(name):
    (one,), (law,) = instances(name, np.random.default_rng(13), 1)
    real = _core.kernel_real(name, one.inputs(), SEEDS[3], law)
    for found, expected in zip(real, _core.kernel_complex(name, one.inputs(), SEEDS[3], law), strict=True):
        np.testing.assert_allclose(found, expected.real, rtol=0, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("name", ["bushing", "line", "axis"])
def test_missing_coordinates_are_held_at_zero(name):
    """An element to the track: the second body's coordinates do not exist, so they stay zero."""
    (one,), (law,) = instances(name, np.random.default_rng(14), 1)
    there = np.ones(one.kernel.coordinates, dtype=bool)
    there[6:12] = False
    held = replace(one, q=one.q * there, u=one.u * there)
    r, s = _core.kernel_complex(name, held.inputs(), SEEDS[3], law)
    index = np.where(there, np.cumsum(there) - 1, -1)[None]
    assembly = assemble(name, [one], [law], index)
    state = [part[there] for part in (one.q, one.u, one.a)]
    np.testing.assert_allclose(assembly.residual(*state), r.real[there], rtol=0, atol=1e-13 * np.abs(r).max())
    np.testing.assert_allclose(assembly.pencil(*state, SEEDS[3]), s.real[np.ix_(there, there)],
                               rtol=0, atol=1e-13 * np.abs(s).max())


def test_two_instances_on_the_same_coordinates_add_up():
    (one,), _ = instances("bushing", np.random.default_rng(15), 1)
    single = assemble("bushing", [one], [None], np.arange(12)[None])
    double = assemble("bushing", [one, one], [None], np.tile(np.arange(12), (2, 1)))
    state = (one.q, one.u, one.a)
    np.testing.assert_array_equal(double.residual(*state), 2 * single.residual(*state))
    np.testing.assert_array_equal(double.pencil(*state, SEEDS[0]), 2 * single.pencil(*state, SEEDS[0]))
