# SPDX-License-Identifier: BSD-3-Clause
"""The solver behind the law "exact": closed forms, Kalker's table, an independent code, its own equations; the table's spline."""

from pathlib import Path

import numpy as np
import pytest

from derive.exact_contact import fit, samples, table
from derive.exact_contact.coordinates import constants, from_ball, scales, to_ball
from derive.exact_contact.patch import Patch, _slip_of_lines, linear_coefficients, patch
from derive.exact_contact.rolling import Extrapolated, Rolling, coarse_grid, full_slip
from derive.exact_contact.spline import HalfBall
from railsym.kalker import kalker_coefficients

DATA = Path(__file__).resolve().parent / "data" / "creep_reference.csv"
MIRROR = np.array([1.0, -1.0, -1.0])


def line_contact(cells):
    """A contact of length 2 that is endless along y, bound sqrt(1 - x^2)."""
    edges = np.linspace(1.0, -1.0, cells + 1)
    middle, half = (edges[1:] + edges[:-1]) / 2, np.full(cells, 1.0 / cells)
    x, observed, y = middle - half / 2, middle + half / 2, np.zeros(cells)
    bound = -np.diff(edges * np.sqrt(1 - edges**2) + np.arcsin(edges)) / 2 / (2 * half)
    slip = _slip_of_lines(observed[:, None] - x, np.zeros((cells, cells)), 1e4, 0.28) * np.repeat(2 * half, 2)
    return Patch(x, y, observed, middle, 2 * half, bound, slip)


@pytest.mark.parametrize("part, compliance", [(1, 2.0), (0, 2.0 * 0.72)])
def test_line_contact_is_carters(part, compliance):
    """Carter 1926: creepage w leaves 1 - d = w/compliance of the length in slip and carries 1 - d^2 of the bound."""
    coarse, fine = (Rolling(line_contact(n)) for n in (40, 80))
    for share in (0.1, 0.35, 0.7, 0.95):
        creepage = np.zeros((1, 3))
        creepage[0, part] = share * compliance
        found = (2 * fine.forces(creepage, 1e-6) - coarse.forces(creepage, 1e-6))[0] / (np.pi / 2)
        # extrapolated as for the table; what is left is where in a cell the slip ends
        assert found[part] == pytest.approx(-(1 - (1 - share) ** 2), abs=1e-3)
        assert abs(found[1 - part]) < 1e-6


@pytest.mark.parametrize("ratio", (0.1, 0.5, 1.0, 2.0, 5.0))
def test_linear_theory_is_kalkers(ratio):
    """Extrapolated over two grids; his table is printed to three digits."""
    strips, cells = coarse_grid(ratio, 500)
    coarse, fine = (linear_coefficients(patch(ratio, n * strips, n * cells)) for n in (1, 2))
    c = kalker_coefficients(ratio, 0.28)
    found = (2 * fine - coarse) / np.array([c.c11, c.c22, c.c23, c.c23, c.c33])
    assert found[:4] == pytest.approx(1.0, abs=8e-3)
    assert found[4] == pytest.approx(1.0, abs=0.025)  # C33 is the small difference of two large parts where a > b
    assert fine[2] == pytest.approx(fine[3], rel=1e-3)  # C23 = C32, which nothing enforces


def test_small_creepage_is_linear():
    cells = patch(1.5, 8, 20)
    linear = linear_coefficients(cells)
    found = Rolling(cells).forces(np.diag([1e-4, 1e-4, 1e-4]), tolerance=1e-8) / 1e-4
    assert -found[[0, 1, 2], [0, 1, 1]] == pytest.approx(linear[:3], rel=2e-3)


@pytest.mark.parametrize("ratio", (0.3, 1.0, 3.0))
def test_solutions_satisfy_the_laws_of_rolling(ratio):
    cells = patch(ratio, *coarse_grid(ratio, 400))
    creepages = np.array([[0.1, 0.05, 0.1], [0.0, -0.2, 0.3], [0.5, 0.2, 0.0], [0.02, 0.0, -0.6]])
    p = Rolling(cells).tractions(creepages, tolerance=1e-6).astype(float)
    slip = cells.slip @ p + cells.rigid @ creepages.T
    p, slip = p.reshape(-1, 2, 4), slip.reshape(-1, 2, 4)
    size, speed = np.linalg.norm(p, axis=1), np.linalg.norm(slip, axis=1)
    bound = cells.bound[:, None]
    assert np.all(size <= bound * (1 + 1e-6))
    sticks = size < bound * (1 - 1e-4)
    assert speed[sticks].max() < 1e-4
    assert np.abs(slip + speed[:, None] * p / size[:, None])[~np.broadcast_to(sticks[:, None], slip.shape)].max() < 1e-3
    assert sticks.any() and not sticks.all()


def test_against_an_independent_code():
    """20 of the 400 cases on 60 x 40 elements, whose own error with spin is about 0.01."""
    t = np.genfromtxt(DATA, delimiter=",", names=True, skip_header=4, dtype=None, encoding="ascii")
    limit, c, errors = t["mu"] * t["N_N"], np.sqrt(t["a_m"] * t["b_m"]), []
    e = np.stack([t["xi"], t["eta"], t["phi_1_per_m"] * c], 1) * MIRROR * (8.2e10 * c * c / limit)[:, None]
    wanted = np.stack([t["exact_fx_muN"], t["exact_fy_muN"], t["exact_mz_Nm"] / limit / c], 1) * MIRROR
    for ratio in (0.5, 1.0):
        chosen = np.nonzero(np.abs(t["a_m"] / t["b_m"] - ratio) < 1e-3)[0][::8]
        errors.append(Extrapolated(ratio).forces(e[chosen]) - wanted[chosen])
    errors = np.concatenate(errors)
    assert len(errors) >= 20
    assert np.hypot(errors[:, 0], errors[:, 1]).max() < 0.01
    assert np.sqrt(np.mean(np.sum(errors[:, :2] ** 2, axis=1))) < 0.004
    assert np.abs(errors[:, 2]).max() < 0.01


def test_finer_grids_agree_with_the_extrapolation():
    e = np.array([[0.05, 0.1, 0.2], [0.2, 0.0, 0.1], [0.0, -0.1, 0.4]])
    single = [Rolling(patch(1.0, n * 4, n * 6)).forces(e, 1e-5) for n in (1, 2, 3)]
    extrapolated = Extrapolated(1.0, 400).forces(e, 1e-5)
    errors = [np.abs(found - extrapolated).max() for found in single]
    assert errors[0] > 1.6 * errors[1] > 1.6 * 1.2 * errors[2]


@pytest.mark.parametrize("ratio", (0.2, 1.0, 4.0))
def test_full_slip(ratio):
    far = 3e3 * np.array([[0.6, -0.2, 0.5], [0.0, 0.0, 1.0], [1.0, 0.3, 0.0]])
    exact = full_slip(ratio, far)
    assert np.hypot(*exact[2, :2]) == pytest.approx(1.0, rel=1e-12)
    if ratio == 1.0:  # a disc that turns on the spot: 3 pi/16
        assert exact[1] == pytest.approx([0, 0, -3 * np.pi / 16], abs=1e-4)
    assert Extrapolated(ratio, 500).forces(far) == pytest.approx(exact, abs=0.02)


def test_a_case_that_is_not_solved_is_named():
    with pytest.raises(RuntimeError, match="1 cases not solved.*after 4 iterations.*0.3"):
        Rolling(patch(1.0, 4, 6)).forces(np.array([[0.3, 0.1, 0.1]]), most=4)


def test_coordinates_go_back():
    v = np.array([[0.1, -2.0, 30.0], [0.0, 0.0, 1e-6]])
    assert from_ball(to_ball(v)) == pytest.approx(v, rel=1e-9)
    c, spin = constants(2.0)
    assert scales(2.0) == pytest.approx([c[0], c[1], spin])


def test_spline_is_its_own_mirror_image_and_smooth():
    rng = np.random.default_rng(4)
    ball = HalfBall(3)
    full = ball.expand(rng.normal(size=(4, 8, 4, 3)))
    s = np.array([[0.0, 0.3, 0.4], [0.2, 0.3, 0.0]])
    assert ball.values(full, s[:1])[0, 0] == pytest.approx(0, abs=1e-14)
    other = ball.values(full, s[1:] * [1, -1, 1])
    assert other == pytest.approx(ball.values(full, s[1:]) * [1, -1, -1], abs=1e-13)
    for component in range(3):
        free = full[1:, :, 1:, component].ravel()
        inside = rng.uniform(0, 0.99, (20, 3))
        assert ball.design(inside, component) @ free == pytest.approx(ball.values(full, inside)[:, component], abs=1e-12)
    for knot in (np.array([1 / 3, 0.1, 0.1]), np.array([0.1, -1 / 3, 0.1]), np.array([0.1, 0.1, 2 / 3])):
        axis = np.argmax(np.abs(knot))
        step = 1e-6 * np.eye(3)[axis]
        low, at, high = (ball.values(full, (knot + k * step)[None])[0] for k in (-1, 0, 1))
        assert high - at == pytest.approx(at - low, abs=1e-10)  # a step of slope would show as 1e-6


def test_fit_returns_a_table_that_lies_in_its_space():
    """Forces made from known coefficients come back; those of full slip do not have to."""
    ball, rng = HalfBall(4), np.random.default_rng(1)
    s = samples.points(1.0)[0]
    n = np.arange(5)[:, None, None] / 5, np.arange(10)[None, :, None] / 5 - 1, np.arange(5)[None, None, :] / 5
    free = np.stack([-0.5 * n[0] + 0 * n[1] * n[2], -0.5 * n[1] + 0 * n[0] * n[2], -0.3 * n[1] * n[2] + 0 * n[0]], axis=-1)
    full = ball.expand(free + 0.02 * rng.normal(size=free.shape))
    forces = fit.evaluate(ball, full, s, 1.0, 0.28)
    again = fit.evaluate(ball, fit.fitted(ball, s, forces, 1.0, 0.28, smoothing=1e-5), s, 1.0, 0.28)
    assert again == pytest.approx(forces, abs=2e-3)


def test_the_file_is_the_same_each_time(tmp_path):
    coefficients = np.random.default_rng(3).normal(size=(12, 4, 6, 4, 3))
    for name in ("one.npz", "two.npz"):
        table.write(coefficients, tmp_path / name)
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()
    with np.load(tmp_path / "one.npz") as kept:
        assert kept["coefficients"] * kept["scale"] == pytest.approx(coefficients, abs=np.abs(coefficients).max() / 32767)


def test_spline_over_the_ratios_passes_through_its_nodes():
    values = np.sin(samples.positions())
    found = table.over_ratios(values[:, None, None])
    middle = found[1:-1, 0, 0] * 0.75 + (found[:-2, 0, 0] + found[2:, 0, 0]) * 0.125
    assert middle == pytest.approx(values[1:-1], abs=1e-12)
    assert (found[0, 0, 0] + found[1, 0, 0]) / 2 == pytest.approx(values[0], abs=1e-12)
