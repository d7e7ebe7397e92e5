# SPDX-License-Identifier: BSD-3-Clause
"""Pencil of the wheel-rail forces in motion: against differences of the rows, and against the linear contact."""

from types import SimpleNamespace

import numpy as np
import pytest
from oracles.wheel_rail import ContactTerms, wheel_matrices
from oracles.wheel_rail_cases import R0, SPEED, TWO_ZONES, random_state, rolling, rows_of, wheelset
from oracles.wheel_rail_motion import State

from railsym._core_wheel_rail import WheelRailCore, cones
from railsym.kalker import kalker_coefficients
from railsym.wheel_rail import kalker_table

EIGHTH_ORDER = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0.0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])


def differences(forces, state, seed, steps):
    """Columns cq drows/dq + cu drows/du by central differences of eighth order along (cq, cu)."""
    columns = np.zeros((6, 6))
    for j in range(6):
        for k, weight in zip(range(-4, 5), EIGHTH_ORDER):
            if weight:
                dq, du = (k * steps[j] * part * np.eye(6)[j] for part in seed)
                moved = State(state.q + dq, state.u + du, state.speed, state.w, state.rails)
                columns[:, j] += weight * rows_of(forces, moved)[0][0]
    return columns / steps


def states():
    rng = np.random.default_rng(411)
    return [random_state(rng, shift) for shift in (0.0, 2e-3, -3e-3, 6e-3, -6e-3)]


# Every force law here is smooth but for Polach's corner; loads are (3/2)-powers of a penetration of 80 um, so that a step of
# 2 um leaves (2/80)^8 of the derivative, and roundoff of 1e-12 of the rows over the step leaves 1e-6 of the smallest ones.
@pytest.mark.parametrize("law", ["kalker_linear", "shen_hedrick_elkins", "polach"])
@pytest.mark.parametrize("seed", [(1.0, 0.0), (0.0, 1.0)])
def test_pencil_is_the_derivative_of_the_rows(law, seed):
    forces = wheelset(TWO_ZONES, law=law, damping=2.0, friction=0.25, kalker_weight=0.8)
    steps = np.array([2e-6, 2e-6, 2e-6, 4e-5, 2e-6, 1e-3]) if seed[0] else np.array([1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3])
    zones = set()
    for state in states():
        _, blocks = rows_of(forces, state, seed)
        zones |= set(np.flatnonzero(forces.outputs().load.any(axis=0)))
        expected = differences(forces, state, seed, steps)
        scale = np.abs(expected).max(axis=0)
        scale = np.maximum(scale, 1.0)
        np.testing.assert_allclose(blocks[0] / scale, expected / scale, rtol=0, atol=2e-6)
    assert zones == {0, 1}


def test_pencil_is_linear_in_its_seed():
    forces = wheelset(TWO_ZONES, law="fastsim", damping=2.0)
    for state in states():
        stiffness, damping, both = (rows_of(forces, state, seed)[1] for seed in ((1.0, 0.0), (0.0, 1.0), (3.0, 40.0)))
        expected = 3.0 * stiffness + 40.0 * damping
        np.testing.assert_allclose(both, expected, rtol=0, atol=1e-13 * np.abs(expected).max())


def test_pencil_of_the_tabulated_law():
    """Its second derivatives jump at the knots of its spline, up to eight of which lie under the difference: 3e-4 of a slope."""
    forces = wheelset(TWO_ZONES, law="exact", damping=2.0, friction=0.25, kalker_weight=0.8)
    for state in states():
        for seed, steps in (((1.0, 0.0), [5e-7, 5e-7, 5e-7, 1e-5, 5e-7, 1e-3]), ((0.0, 1.0), [2e-4] * 6)):
            _, blocks = rows_of(forces, state, seed)
            expected = differences(forces, state, seed, np.array(steps))
            scale = np.maximum(np.abs(expected).max(axis=0), 1.0)
            np.testing.assert_allclose(blocks[0] / scale, expected / scale, rtol=0, atol=3e-4)


@pytest.mark.parametrize("law", ["fastsim", "fastrip"])
def test_pencil_of_laws_with_cells(law):
    """Their forces have slopes that jump by a cell's weight where a cell begins to slip: on 60 x 60 cells the chord over
    many jumps is near the slope."""
    forces = wheelset(TWO_ZONES, law=law, damping=2.0, grid=(60, 60))
    for state in states():
        for seed, steps in (((1.0, 0.0), [2e-6, 2e-6, 2e-6, 4e-5, 2e-6, 1e-3]), ((0.0, 1.0), [2e-3] * 6)):
            _, blocks = rows_of(forces, state, seed)
            expected = differences(forces, state, seed, np.array(steps))
            scale = np.abs(expected).max(axis=0)
            scale = np.maximum(scale, 1.0)
            np.testing.assert_allclose(blocks[0] / scale, expected / scale, rtol=0, atol=0.02)


def test_rows_with_and_without_the_pencil_are_the_same():
    for law in ("polach", "fastsim"):
        forces = wheelset(TWO_ZONES, law=law)
        for state in states():
            alone, none = rows_of(forces, state)
            rows, _ = rows_of(forces, state, (1.0, 0.0))
            assert none is None
            np.testing.assert_allclose(rows, alone, rtol=0, atol=1e-12 * np.abs(alone).max())
            np.testing.assert_array_equal(rows_of(forces, state)[0], alone)  # and again: same bytes


@pytest.mark.parametrize("poisson", [0.0, 0.28, 0.5])
def test_table_of_kalker_coefficients(poisson):
    start, step, cubics = kalker_table(poisson)
    ratio = np.exp(np.random.default_rng(412).uniform(start, -start, 400))
    place = np.log(ratio) - start
    piece = np.minimum((place / step).astype(int), len(cubics) - 1)
    t = place - piece * step
    values = sum(cubics[piece, :, k] * t[:, None] ** k for k in range(4))
    np.testing.assert_allclose(values, np.array(kalker_coefficients(ratio, poisson)).T, rtol=1e-5)


# --- against the linear contact ---------------------------------------------------------------------------------

B0, LOAD, STIFFNESS, A, B, MODULUS = 0.75, 6e4, 9e10, 6e-3, 4.5e-3, 8.2e10
PENETRATION = (LOAD / STIFFNESS) ** (2 / 3)


def edge_contact(slope, friction=0.3):
    """Cones on the edges of two rails, centred, each wheel with the load LOAD, by Kalker's linear law."""
    root = np.sqrt(PENETRATION)
    shape = cones(R0, [{"slope": slope, "b0": B0, "radius": R0, "rail_y": B0, "rail_z": 0.0, "rail_radius": 0.0,
                        "a": A / root, "b": B / root, "stiffness": STIFFNESS}], (0.02, 0.1, 0.02))
    start, step, cubics = kalker_table(0.28)
    creep = {"law": "kalker_linear", "strips": 1, "cells": 1, "modulus": MODULUS, "adhesion": 1.0, "slip": 1.0,
             "start": start, "step": step, "c": cubics}
    wheel = {"shape": shape, "sink": PENETRATION * np.sqrt(1 + slope**2), "friction": friction, "weight": 1.0, "damping": 0.0}
    return WheelRailCore([{"first": 0, "offset": (0.0, 0.0, -R0), "spacing": 1.5, "wheels": (wheel, wheel)}], creep)


def linear_wheels(slope):
    c, area = kalker_coefficients(A / B, 0.28), A * B
    return [SimpleNamespace(side=side, load=LOAD, wheel_radius=R0, contact_half_spacing=B0, conicity=slope, slope=slope,
                            slope_gradient=slope / B0, normal_stiffness=1.5 * LOAD / PENETRATION, f11=MODULUS * area * c.c11,
                            f22=MODULUS * area * c.c22, f23=MODULUS * area**1.5 * c.c23, f33=MODULUS * area**2 * c.c33)
            for side in (-1.0, 1.0)]


def without_creep(wheel):
    return SimpleNamespace(**(vars(wheel) | {"f11": 0.0, "f22": 0.0, "f23": 0.0, "f33": 0.0}))


# Sizes of the entries: creep stiffness 1e7 N of the level rows, wheel load 1e5 N, contact stiffness 2e9 N/m of the load's.
def test_gravitational_and_contact_stiffness_are_the_linear_ones():
    """Normal forces alone, about the centred place: the difference is of second order in the slope of the cone."""
    for slope in (0.01, 0.02, 0.04):
        _, blocks = edge_contact(slope, friction=0.0).rows(np.zeros(6), rolling(), SPEED, None, None, (1.0, 0.0))
        expected = sum(wheel_matrices(without_creep(wheel), SPEED)[0] for wheel in linear_wheels(slope))
        allowed = np.full((6, 6), LOAD * slope**2)
        allowed[np.ix_([1, 2, 4], [1, 2, 4])] = 1.5 * LOAD / PENETRATION * slope**2 * np.array(
            [[5 * slope**2, 0, 5 * slope], [0, 3, 0], [5 * slope, 0, 3]])
        np.testing.assert_array_less(np.abs(blocks[0] - expected), allowed + 1e-6)


def rigid_lateral(slope):
    """Columns: coordinates, but a lateral shift rolls so that both wheels keep touching; the pure roll is left out."""
    motion = np.eye(6)[:, [0, 1, 2, 3, 5]]
    motion[4, 1] = -slope / (B0 - R0 * slope)
    return motion


def test_gravitational_lateral_stiffness_along_rigid_contact():
    """(2N/b0) [2 sigma + (r0 + b0 lam) sigma^2/b0], docs/linear_contact.md, from forces that are far larger."""
    for slope in (0.02, 0.1):
        _, blocks = edge_contact(slope, friction=0.0).rows(np.zeros(6), rolling(), SPEED, None, None, (1.0, 0.0))
        motion = rigid_lateral(slope)[:, 1]
        sigma = slope * B0 / (B0 - R0 * slope)
        expected = 2 * LOAD / B0 * (2 * sigma + (R0 + B0 * slope) * sigma**2 / B0)
        assert motion @ blocks[0] @ motion == pytest.approx(expected, rel=3 * slope**2)


def test_creep_part_is_the_linear_one_along_rigid_contact():
    """Contact slope and radius of a cone on edges follow yc alone only along rigid contact, what the linear contact assumes.

    Its own kernel leaves the tilt of the lateral direction out; the comparison takes the formulas that keep it.
    """
    left = []
    for slope in (0.01, 0.02, 0.04):
        wheels, terms = linear_wheels(slope), ContactTerms(tilt="exact")
        expected = [sum(parts) for parts in zip(*(wheel_matrices(wheel, SPEED, terms) for wheel in wheels))]
        errors = []
        for seed, matrix in zip(((1.0, 0.0), (0.0, 1.0)), expected):
            core, motion = edge_contact(slope), rigid_lateral(slope)
            _, blocks = core.rows(np.zeros(6), rolling(), SPEED, None, None, seed)
            errors.append(np.abs((blocks[0] - matrix) @ motion)[[0, 1, 3, 4, 5]][:, [0, 1, 3, 4]].max() / wheels[0].f22)
        left.append(errors)
    # In units of f22. Stiffness: what sinks into a slope of a cone touches at a radius larger by slope^2.
    assert np.all(np.array(left) < np.array([3.0, 1e-3]) * np.array([[0.01], [0.02], [0.04]]) ** 2)


def test_rows_of_the_kernel_for_small_motions():
    """Generated kernel against this one for a small motion along rigid contact: to the second order in slope and motion."""
    from oracles.kernel_inputs import random_instance

    slope = 0.01
    core = edge_contact(slope)
    wheels = linear_wheels(slope)
    one = random_instance("wheel_rail", np.random.default_rng(413))
    q, u = 1e-5 * rigid_lateral(slope) @ np.array([1.0, 1.0, 0.0, 1.0, 0.0]), rolling(x=1e-3, y=2e-4, yaw=3e-4, spin=1e-3)
    rows, _ = core.rows(q, u, SPEED, None, None, None)
    from railsym import _core

    kernel = np.zeros(6)
    for wheel in wheels:
        values = {"side": wheel.side, "b0": B0, "r0": R0, "lam": slope, "slope": slope, "grad": slope / B0, "N0": LOAD,
                  "kH": wheel.normal_stiffness, "V": SPEED} | {key: getattr(wheel, key) for key in ("f11", "f22", "f23", "f33")}
        instance = one.having(q=q, u=u, w=np.zeros(3), offset=np.array([0.0, 0.0, -R0]), **values)
        kernel += _core.kernel_real("wheel_rail", instance.inputs(), (0.0, 0.0, 0.0))[0]
    # creep forces of 300 N here, loads of 1.2e5 N, of which slope^2 is 12 N
    np.testing.assert_allclose(rows[0], kernel, rtol=0, atol=6.0)
    assert np.abs(kernel[[0, 1, 3, 5]]).min() > 50.0
