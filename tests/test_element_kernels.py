# SPDX-License-Identifier: BSD-3-Clause
"""Mechanics of the element kernels: virtual power, free pairs, potentials, dissipation, change of frame."""

import numpy as np
import pytest
from oracles.element_pair import (
    attitude,
    bushing_force,
    cross_matrix,
    deformation,
    deformation_rate,
    partial_omega,
    partial_rates,
    wrenches,
)
from oracles.kernel_inputs import random_instance, random_rotation

from railsym import _core

ELEMENTS = ("bushing", "line", "axis")
SPRING = {"kind": "spring_damper", "preload": 0.8, "stiffness": 1.7, "damping": 0.6}
ELASTIC = SPRING | {"damping": 0.0}
DAMPER = {"kind": "spring_damper", "damping": 0.6}
MAXWELL = {"kind": "maxwell", "stiffness": 1.4, "damping": 0.9}
ZERO3 = np.zeros(3)

# Roundoff of some hundred operations on numbers up to 30.
ROUNDOFF = 1e-12


@pytest.fixture(params=ELEMENTS)
def element(request):
    return request.param


def some(name, count=8):
    """Random instances between frames that lie and move anyhow."""
    rng = np.random.default_rng(21)
    return [random_instance(name, rng) for _ in range(count)]


def at_rest(one):
    """The frames do not move against each other."""
    return one.having(dD=ZERO3, wf=ZERO3)


def residual(one, law=SPRING):
    return _core.kernel_real(one.name, one.inputs(), (0, 0, 0), None if one.name == "bushing" else law)[0]


def stiffness(one, law):
    return _core.kernel_real(one.name, one.inputs(), (1, 0, 0), None if one.name == "bushing" else law)[1][:12, :12]


def force(one, law=SPRING):
    """Element forces (1 or 6) from the deformation alone; ``law`` is a spring and damper."""
    if one.name == "bushing":
        return bushing_force(one)
    stretch, rate = deformation(one, one.q[:12]), deformation_rate(one)
    return law.get("preload", 0.0) + law.get("stiffness", 0.0) * stretch + law["damping"] * rate


def test_forces_are_those_of_the_virtual_power(element):
    """r = (de/dq)^T f with e, de/dt and de/dq from the finite deformation by the complex step."""
    for one in some(element):
        expected = partial_rates(one).T @ force(one)
        np.testing.assert_allclose(residual(one)[:12], expected, rtol=0, atol=ROUNDOFF * np.abs(expected).max())


def test_power_is_force_times_rate(element):
    """Between frames that rest, the element takes the power f . de/dt from the bodies."""
    for one in map(at_rest, some(element)):
        f = force(one)
        power = residual(one)[:12] @ one.u[:12]
        assert power == pytest.approx(f @ deformation_rate(one), rel=ROUNDOFF, abs=ROUNDOFF * np.abs(f).max())


def test_pair_has_no_net_force_and_no_moment_about_any_point(element):
    """Force and moment on the two bodies, brought to the first frame and to one point, cancel."""
    point = np.array([3.0, -2.0, 5.0])
    for one in some(element):
        turned, q = one.matrix("C"), one.q
        force1, moment1, force2, moment2 = wrenches(one, residual(one))
        force2, moment2 = turned @ force2, turned @ moment2
        centre2 = one.get("D0", 3) + turned @ q[6:9]
        moment = moment1 + moment2 + np.cross(q[:3] - point, force1) + np.cross(centre2 - point, force2)
        scale = np.abs(residual(one)).max()
        np.testing.assert_allclose(force1 + force2, 0.0, atol=ROUNDOFF * scale)
        # Roll near 1.2 rad makes the partial velocities nearly dependent: a digit is lost.
        np.testing.assert_allclose(moment, 0.0, atol=100 * ROUNDOFF * scale)


def test_line_element_pulls_along_its_line():
    """The force on the first body points to the second marker when the law is in tension."""
    for one in some("line"):
        force1 = wrenches(one, residual(one, {"kind": "spring_damper", "preload": 2.0}))[0]
        reach = one.q[6:9] + attitude(one.q[9:12]) @ one.get("m2_0", 3)
        apart = one.get("D0", 3) + one.matrix("C") @ reach - one.q[:3] - attitude(one.q[3:6]) @ one.get("m1_0", 3)
        np.testing.assert_allclose(force1, 2.0 * apart / np.linalg.norm(apart), rtol=0, atol=ROUNDOFF)


def test_elastic_stiffness_is_symmetric(element):
    """Springs with preload derive from a potential, so r is its gradient and K its Hessian, everywhere.

    Without damping: a damper's force changes with the attitude too.
    """
    for one in map(at_rest, some(element)):
        one = one.having(c=np.zeros(6)) if element == "bushing" else one
        matrix = stiffness(one, ELASTIC)
        assert np.abs(matrix).max() > 0.1
        np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=ROUNDOFF * np.abs(matrix).max())


def test_symmetry_check_can_fail(element):
    one = at_rest(some(element)[0])
    matrix = stiffness(one, SPRING)
    assert np.abs(matrix - matrix.T).max() > 1e-3 * np.abs(matrix).max()


def test_residual_is_the_gradient_of_the_potential(element):
    """Work of the element along a finite path equals the change of the stored energy."""
    one = at_rest(some(element)[0])
    one = one.having(u=0 * one.u, **({"c": np.zeros(6)} if element == "bushing" else {}))

    def energy(q):
        stretch = deformation(one, q)
        if element == "bushing":
            stretch = stretch - one.get("e0_0", 6)
            return one.get("f0_0", 6) @ stretch + 0.5 * one.get("k0", 6) @ stretch**2
        return ELASTIC["preload"] * stretch[0] + 0.5 * ELASTIC["stiffness"] * stretch[0] ** 2

    end = np.zeros_like(one.q)
    end[:12] = np.random.default_rng(22).uniform(-0.5, 0.5, 12)
    nodes, weights = np.polynomial.legendre.leggauss(24)  # spectral on a smooth path
    work = sum(0.5 * w * (residual(one.having(q=one.q + 0.5 * (1 + x) * end), ELASTIC) @ end)
               for x, w in zip(nodes, weights, strict=True))
    assert work == pytest.approx(energy((one.q + end)[:12]) - energy(one.q[:12]), rel=1e-11)


def test_damping_never_gives_power(element):
    """With damping alone the element takes power from every motion between frames that rest."""
    for one in map(at_rest, some(element, 20)):
        if element == "bushing":
            one = one.having(k=np.zeros(6), f0_=np.zeros(6), c=np.abs(one.get("c0", 6)))
        power = residual(one, DAMPER)[:12] @ one.u[:12]
        assert power > 0.0  # never zero at random rates
        assert residual(one.having(u=-one.u), DAMPER)[:12] @ -one.u[:12] == pytest.approx(power, rel=1e-10)


@pytest.mark.parametrize("name", ["line", "axis"])
def test_maxwell_element_stores_and_dissipates(name):
    """Power taken = rate of the spring's energy + c (ds/dt)^2, on the state equation g = 0."""
    k, c = MAXWELL["stiffness"], MAXWELL["damping"]
    for one in map(at_rest, some(name)):
        stretch, rate = deformation(one, one.q[:12])[0], deformation_rate(one)[0]
        flow = k / c * (stretch - one.q[12])
        one = one.having(u=np.append(one.u[:12], flow))
        r = residual(one, MAXWELL)
        stored = k * (stretch - one.q[12]) * (rate - flow)
        assert abs(r[12]) < ROUNDOFF * k * abs(stretch - one.q[12])
        assert r[:12] @ one.u[:12] == pytest.approx(stored + c * flow**2, rel=1e-11)


def test_frames_that_coincide_give_the_same_frame_result(element):
    """C = I at rest: D may as well be counted to the second body's displacement."""
    for one in map(at_rest, some(element)):
        one = one.having(C=np.eye(3))
        shift = np.zeros_like(one.q)
        shift[6:9] = one.get("D0", 3)
        together = one.having(D=ZERO3, q=one.q + shift)
        expected = residual(together)
        np.testing.assert_allclose(residual(one), expected, rtol=0, atol=ROUNDOFF * np.abs(expected).max())


def angles_of(rotation):
    """Yaw, roll, pitch of Rz(yaw) Rx(roll) Ry(pitch), roll within 90 degrees."""
    roll = np.arcsin(np.clip(rotation[2, 1], -1.0, 1.0))
    return np.array([np.arctan2(-rotation[0, 1], rotation[1, 1]), roll, np.arctan2(-rotation[2, 0], rotation[2, 2])])


def in_first_frame(one):
    """The same element and motion with the second body counted in the first one's track frame."""
    turned, between, q, u = one.matrix("C"), one.get("D0", 3), one.q.copy(), one.u.copy()
    body = attitude(q[9:12])
    omega = turned @ (partial_omega(q[9:12]) @ u[9:12] + one.get("wf0", 3))
    u[6:9] = one.get("dD0", 3) + turned @ (u[6:9] + cross_matrix(one.get("wf0", 3)) @ q[6:9])
    q[6:9] = between + turned @ q[6:9]
    q[9:12] = angles_of(turned @ body)
    u[9:12] = np.linalg.solve(partial_omega(q[9:12]), omega)
    return one.having(C=np.eye(3), D=ZERO3, dD=ZERO3, wf=ZERO3, q=q, u=u)


def test_two_frames_give_the_result_of_a_common_one(element):
    """Forces between frames at an arbitrary relative pose and motion, against one common frame."""
    compared = 0
    for one in some(element, 12):
        common = in_first_frame(one)
        if abs(np.cos(common.q[10])) < 0.2:
            continue  # the common frame's angles are near their singularity
        found, expected = wrenches(one, residual(one)), wrenches(common, residual(common))
        turned = one.matrix("C")
        found = [*found[:2], turned @ found[2], turned @ found[3]]
        np.testing.assert_allclose(found, expected, rtol=0, atol=100 * ROUNDOFF * np.abs(expected).max())
        compared += 1
    assert compared > 6


def test_common_frame_check_can_fail():
    """A frame that turns a little otherwise is seen."""
    one = some("bushing")[0]
    other = one.having(C=one.matrix("C") @ random_rotation(np.random.default_rng(23)))
    assert np.abs(np.array(wrenches(one, residual(one))) - wrenches(other, residual(other))).max() > 1e-3
