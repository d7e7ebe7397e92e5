# SPDX-License-Identifier: BSD-3-Clause
"""The creep law "exact": its table against exact solutions, its slopes, symmetries, limits and edges."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railsym as rs
from derive.exact_contact import fit, table
from derive.exact_contact.coordinates import constants, scales, to_ball
from derive.exact_contact.rolling import Extrapolated, full_slip
from derive.exact_contact.samples import LARGEST, LEAST, PIECES
from derive.exact_contact.spline import HalfBall
from railsym.kalker import kalker_coefficients

DATA = Path(__file__).resolve().parent / "data" / "creep_reference.csv"
STEEL = rs.Material(8.2e10, 0.28)
MIRROR = np.array([1.0, -1.0, -1.0])  # lateral and spin change sign with the side, longitudinal does not
C, LIMIT = 5e-3, 0.3 * 8e4            # sqrt(a b) m, mu N in N


def law(ratio, e, **more):
    """h (n, 3) of dimensionless creepages e (n, 3): forces over mu N, moment over mu N sqrt(a b)."""
    creepages = np.asarray(e) * LIMIT / (STEEL.shear_modulus * C * C) / [1.0, 1.0, C]
    root = np.sqrt(ratio)
    return rs.creep_forces("exact", C * root, C / root, creepages, 8e4, 0.3, STEEL, **more) / [LIMIT, LIMIT, LIMIT * C]


def random_creepages(ratio, count, seed, sizes=(-1.5, 1.5)):
    """e (count, 3) from linear theory to full slip; a fifth of the components zero."""
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction[rng.random((count, 3)) < 0.2] = 0.0
    return 10 ** rng.uniform(*sizes, (count, 1)) * direction / scales(ratio)


def distance(found, wanted):
    """r.m.s. and largest of |dF|, r.m.s. and largest of |dM|."""
    force, moment = np.hypot(*(found - wanted)[:, :2].T), np.abs(found - wanted)[:, 2]
    return np.sqrt(np.mean(force**2)), force.max(), np.sqrt(np.mean(moment**2)), moment.max()


def test_against_an_independent_code():
    """400 cases on 60 x 40 elements; the figures of docs/creep_forces.md, rounded up."""
    t = np.genfromtxt(DATA, delimiter=",", names=True, skip_header=4, dtype=None, encoding="ascii")
    limit, c = t["mu"] * t["N_N"], np.sqrt(t["a_m"] * t["b_m"])
    creepages = np.stack([t["xi"], t["eta"], t["phi_1_per_m"]], axis=1) * MIRROR
    found = rs.creep_forces("exact", t["a_m"], t["b_m"], creepages, t["N_N"], t["mu"], STEEL) / limit[:, None] / np.stack([np.ones(400), np.ones(400), c], 1)
    wanted = np.stack([t["exact_fx_muN"], t["exact_fy_muN"], t["exact_mz_Nm"] / limit / c], axis=1) * MIRROR
    rms, largest, moment_rms, moment_largest = distance(found, wanted)
    assert 0.001 < rms < 0.005 and largest < 0.025
    assert moment_rms < 0.003 and moment_largest < 0.012


@pytest.mark.parametrize("ratio", (0.23, 0.66, 1.5, 4.4))
def test_against_our_own_solutions_between_the_nodes(ratio):
    """Ratios and creepages that the table has not seen."""
    e = random_creepages(ratio, 40, seed=int(100 * ratio))
    rms, largest, moment_rms, moment_largest = distance(law(ratio, e), Extrapolated(ratio, 400).forces(e))
    assert rms < 0.006 and largest < 0.025
    assert moment_rms < 0.005 and moment_largest < 0.02


def stored():
    """All coefficients (a/b, *ball, 3)."""
    with np.load(table.FILE) as kept:
        return kept["coefficients"] * kept["scale"]


def test_c_reads_the_table_as_the_generator_does():
    """The second implementation of the interpolation, in Python."""
    coefficients = stored()
    ball = HalfBall(coefficients.shape[1] - 2)
    for ratio in (0.1, 0.37, 1.0, 3.3, 9.9):
        e = np.abs(random_creepages(ratio, 60, seed=5, sizes=(-3, 3)))
        e[:, 1] *= np.where(np.arange(60) % 2, 1, -1)
        at = PIECES * np.log(ratio / LEAST) / np.log(LARGEST / LEAST)
        k = min(int(at), PIECES - 1)
        t = at - k
        full = np.tensordot([(1 - t) ** 2 / 2, 0.5 + t * (1 - t), t * t / 2], coefficients[k:k + 3], axes=1)
        wanted = fit.evaluate(ball, full, to_ball(e * scales(ratio)), ratio, 0.28)
        assert law(ratio, e) == pytest.approx(wanted, abs=1e-10)


@pytest.mark.parametrize("ratio", (0.05, 0.1, 0.4, 1.0, 3.0, 10.0, 30.0))
def test_slopes_at_zero_are_kalkers(ratio):
    a, b, G = C * np.sqrt(ratio), C / np.sqrt(ratio), STEEL.shear_modulus
    c = kalker_coefficients(ratio, 0.28)
    found = rs.creep_forces("exact", a, b, np.zeros(3), 8e4, 0.3, STEEL, kalker_weight=0.7, derivatives=True)
    assert np.all(found.forces == 0)
    expected = -0.7 * G * C**2 * np.array([[c.c11, 0, 0], [0, c.c22, C * c.c23], [0, -C * c.c23, C**2 * c.c33]])
    assert found.derivatives[:, :3] == pytest.approx(expected, rel=1e-9, abs=1e-6)
    assert np.all(found.derivatives[:, 3:] == 0)
    small = rs.creep_forces("exact", a, b, np.diag([1e-8, 1e-8, 1e-8 / C]), 8e4, 0.3, STEEL, kalker_weight=0.7)
    assert small.T == pytest.approx(expected * [1e-8, 1e-8, 1e-8 / C], rel=5e-3, abs=1e-9)


def test_derivatives_are_those_of_the_forces():
    """Central differences in all six variables, from adhesion to full slip."""
    rng = np.random.default_rng(6)
    n = 300
    a, b, load, friction = rng.uniform(2e-3, 8e-3, n), rng.uniform(2e-3, 8e-3, n), rng.uniform(1e4, 1e5, n), rng.uniform(0.1, 0.6, n)
    creepages, weight = 10 ** rng.uniform(-4.5, -1.8, (n, 1)) * rng.uniform(-1, 1, (n, 3)) * [1.0, 1.0, 150.0], rng.uniform(0.3, 1.0, n)
    numbers = np.column_stack([creepages, load, friction, weight])

    def forces(x, **more):
        return rs.creep_forces("exact", a, b, x[:, :3], x[:, 3], x[:, 4], STEEL, kalker_weight=x[:, 5], **more)

    found = forces(numbers, derivatives=True).derivatives
    scale = (friction * load)[:, None] * np.stack([np.ones(n), np.ones(n), np.sqrt(a * b)], axis=1)
    for j in range(6):
        step = np.zeros((n, 6))
        step[:, j] = 1e-5 * np.abs(numbers[:, j])
        error = np.abs((forces(numbers + step) - forces(numbers - step)) / 2 - found[..., j] * step[:, j, None]) / scale
        # cubic terms 1e-15, rounding 1e-16; second derivatives jump at knots: up to 1e-10 within a step of one
        assert np.quantile(error, 0.97) < 1e-13 and error.max() < 1e-9
        moved = np.abs(found[..., j] * step[:, j, None] / scale).max()
        assert moved > 1e-6  # the comparison could fail


def test_left_and_right_forward_and_backward_are_mirror_images():
    e = np.concatenate([random_creepages(1.3, 100, seed=2, sizes=(-4, 4)), 3 * np.eye(3), np.zeros((1, 3))])
    right = law(1.3, e)
    assert np.array_equal(law(1.3, e * MIRROR), right * MIRROR)
    assert np.array_equal(law(1.3, e * [-1, 1, 1]), right * [-1, 1, 1])
    assert np.array_equal(law(1.3, -e), -right)


@pytest.mark.parametrize("ratio", (0.1, 0.3, 1.0, 3.0, 10.0))
def test_force_never_exceeds_friction(ratio):
    found = law(ratio, random_creepages(ratio, 3000, seed=9, sizes=(-1, 6)))
    assert np.hypot(found[:, 0], found[:, 1]).max() <= 1 + 1e-12


@pytest.mark.parametrize("ratio", (0.2, 1.0, 5.0))
def test_full_slip(ratio):
    turn = np.linspace(0.1, 6.2, 9)
    slide = 1e3 * np.stack([np.cos(turn), np.sin(turn), np.zeros(9)], axis=1)
    found = law(ratio, slide)
    assert np.hypot(found[:, 0], found[:, 1]) == pytest.approx(1.0, abs=1e-5)
    assert found[:, :2] == pytest.approx(-slide[:, :2] / 1e3, abs=8e-3)
    e = random_creepages(ratio, 60, seed=3, sizes=(5, 6))
    rms, largest, moment_rms, moment_largest = distance(law(ratio, e), full_slip(ratio, e))
    assert rms < 0.006 and largest < 0.03
    assert moment_rms < 0.006 and moment_largest < 0.03


def test_force_and_slopes_are_continuous():
    """Along lines through the ball, over a/b and its ends: steps of 1e-7 move nothing by more than slopes say."""
    way = np.linspace(-40, 40, 2001)[:, None]
    for ratio, direction, offset in ((0.5, [0.3, 0.1, 0.2], [0, 0, 0]), (1.0, [0, 0, 0.2], [0.3, 0, 0]), (4.0, [0.01, 0.2, 0], [0, 0, 0.5])):
        e = way * np.array(direction) + offset
        near, far = (law(ratio, e + k * 1e-7 * np.array(direction)) for k in (0, 1))
        assert np.abs(far - near).max() < 1e-6
    e = random_creepages(1.0, 200, seed=4)
    for ratio in np.concatenate([[LEAST, LARGEST], LEAST * (LARGEST / LEAST) ** (np.arange(1, 10) / 10)]):
        assert np.abs(law(ratio * (1 + 1e-9), e) - law(ratio * (1 - 1e-9), e)).max() < 1e-6


def test_outside_the_table_the_ends_are_kept():
    """a/b of 0.02 and 50: finite, within friction, moments with the longer axis as arm."""
    for ratio in (0.02, 50.0):
        e = random_creepages(ratio, 500, seed=8, sizes=(-2, 5))
        found = law(ratio, e)
        assert np.all(np.isfinite(found)) and np.hypot(found[:, 0], found[:, 1]).max() <= 1 + 1e-12
        assert np.abs(found[:, 2]).max() < 1.5 * np.sqrt((ratio + 1 / ratio) / 2)


@pytest.mark.parametrize("poisson", (0.25, 0.30))
def test_other_materials_scale_with_kalkers_coefficients(poisson):
    ratio = 0.7
    e = random_creepages(ratio, 30, seed=12)
    creepages, root = e * LIMIT / (STEEL.shear_modulus * C * C) / [1.0, 1.0, C], np.sqrt(ratio)
    found = rs.creep_forces("exact", C * root, C / root, creepages, 8e4, 0.3, rs.Material(8.2e10, poisson)) / [LIMIT, LIMIT, LIMIT * C]
    wanted = Extrapolated(ratio, 400, poisson).forces(e)
    rms, largest, *_ = distance(found, wanted)
    assert rms < 0.007 and largest < 0.025


@settings(max_examples=150, deadline=None)
@given(*[st.floats(-1, 1)] * 2, st.floats(-300, 300), st.floats(0.1, 10), st.floats(-1e5, 1e6), st.floats(0, 1.0), st.floats(1e-3, 2.0))
def test_sensible_at_the_edges(xi, eta, phi, ratio, load, friction, weight):
    a, b = C * np.sqrt(ratio), C / np.sqrt(ratio)
    found = rs.creep_forces("exact", a, b, [xi, eta, phi], load, friction, STEEL, kalker_weight=weight, derivatives=True)
    assert np.all(np.isfinite(found.forces)) and np.all(np.isfinite(found.derivatives))
    limit = friction * max(load, 0.0)
    assert np.hypot(*found.forces[:2]) <= limit * (1 + 1e-9)
    assert abs(found.forces[2]) <= 1.3 * limit * max(a, b)
    if load <= 0 or friction == 0:
        assert np.all(found.forces == 0) and np.all(found.derivatives == 0)


def test_tiny_creepages_next_to_zero_have_kalkers_slopes():
    found = rs.creep_forces("exact", C, C, [[1e-200, 0, 0], [0, 0, 1e-160], [1e-12, -1e-12, 1e-10]], 8e4, 0.3, STEEL, derivatives=True)
    c, _ = constants(1.0)
    assert found.derivatives[:, 0, 0] == pytest.approx(-8.2e10 * C * C * c[0], rel=1e-6)


def test_the_c_function_refuses_what_is_no_table():
    from railsym._core import _doubles, ffi, lib
    from railsym._core_exact import creep_table

    rows, force = np.ones((15, 1)), np.empty((3, 1))
    good = creep_table()
    bad = ffi.new("rs_creep_table *", {"pieces": 0, "ratio_pieces": 10, "least": 0.1, "largest": 10.0, "coefficients": good.coefficients})
    assert lib.rs_creep_forces_exact(good, 1, _doubles(rows), _doubles(force), ffi.NULL) == lib.RS_OK
    assert lib.rs_creep_forces_exact(bad, 1, _doubles(rows), _doubles(force), ffi.NULL) == lib.RS_BAD_SIZE
    assert lib.rs_creep_forces_exact(good, -1, _doubles(rows), _doubles(force), ffi.NULL) == lib.RS_BAD_SIZE
    assert lib.rs_creep_forces(lib.RS_CREEP_EXACT, 1, 1, 1, _doubles(rows), _doubles(force), ffi.NULL) == lib.RS_BAD_INDEX


def test_the_shipped_table_is_small_and_complete():
    assert table.FILE.stat().st_size < 3e6
    coefficients = stored()
    n = table.PIECES
    assert coefficients.shape == (PIECES + 2, n + 2, 2 * n + 2, n + 2, 3)
    assert np.all(np.isfinite(coefficients)) and np.abs(coefficients).max() < 20
