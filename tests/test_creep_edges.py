# SPDX-License-Identifier: BSD-3-Clause
"""Creep laws at their edges: lift, no friction, pure spin, slender ellipses, creepages of 1, zero creepage, kinks, odd lengths.

A contact is drawn in the numbers u of ``csrc/creep.h`` (Kalker's linear forces over mu N): small u is adhesion, large u full slip.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railsym as rs
from railsym.kalker import kalker_coefficients

STEEL = rs.Material(8.2e10, 0.28)
LAWS = ("kalker_linear", "shen_hedrick_elkins", "polach", "fastsim", "fastrip", "exact")
SATURATING = LAWS[1:]
MIRROR = np.array([1.0, -1.0, -1.0])
# Largest |F|/(mu N). FASTSIM: 20 cells add 0.15 % to its parabola. Polach adds a force of spin to one that is bounded already.
LARGEST_FORCE = {"shen_hedrick_elkins": 1.0 + 1e-12, "polach": 1.5, "fastsim": 1.01, "fastrip": 1.0 + 1e-12, "exact": 1.0 + 1e-12}
# Lipschitz bounds on a 20 x 20 grid, a/b 0.1 to 10: of (Fx, Fy)/(mu N) and of Mz/(mu N sqrt(ab)), in |u|, the moment's in units of its
# linear slope; of F and M in N over mu. Twice what 700,000 contacts showed: 1.41 2.24 4.2 10.9, 1 0 1.25 3.6, 1 1.7 1.2 5.2.
STEEPEST = {"shen_hedrick_elkins": (1.5, 1.01, 1.1), "polach": (4.5, 0.0, 3.5), "fastsim": (8.0, 2.5, 2.5), "fastrip": (22.0, 7.5, 11.0), "exact": (4.0, 4.0, 4.0)}

edges = settings(max_examples=150, deadline=None, derandomize=True)


def signed(low, high):
    """Zero, or either sign of a number with a magnitude of 10^low to 10^high."""
    return st.one_of(st.just(0.0), st.builds(lambda s, e: s * 10.0**e, st.sampled_from([-1.0, 1.0]), st.floats(low, high)))


numbers = st.one_of(st.tuples(*3 * [signed(-9.0, 6.0)]), st.tuples(*3 * [st.floats(-3.0, 3.0)]), signed(-9.0, 6.0).map(lambda s: (0.0, 0.0, s)))
sizes = st.tuples(st.floats(-1.0, 1.0), st.floats(-3.0, -2.0), st.floats(-3.0, 6.0), st.floats(0.01, 0.8))  # log a/b, log sqrt(ab), log N, mu


class Drawn:
    """A contact from its sizes."""

    def __init__(self, size):
        log_ratio, log_arm, log_load, self.friction = size
        self.ratio, self.arm, self.load = 10.0**log_ratio, 10.0**log_arm, 10.0**log_load
        self.a, self.b = self.arm * np.sqrt(self.ratio), self.arm / np.sqrt(self.ratio)
        self.c = kalker_coefficients(self.ratio, STEEL.poisson)
        self.f = STEEL.shear_modulus * self.arm**2 * np.array([self.c.c11, self.c.c22, self.arm * self.c.c23])
        self.limit = self.friction * self.load
        self.unit = self.limit * np.array([1.0, 1.0, self.arm])
        self.moment_slope = np.hypot(self.c.c23 / self.c.c22, self.c.c33 / self.c.c23)  # of the linear moment in u

    def creepages(self, u):
        return np.asarray(u) * self.limit / self.f

    def h(self, law, u, **more):
        """Forces over mu N and mu N sqrt(ab)."""
        return self.forces(law, u, **more) / self.unit

    def forces(self, law, u, **change):
        given = {"load": self.load, "friction": self.friction} | change
        return rs.creep_forces(law, self.a, self.b, self.creepages(u), given.pop("load"), given.pop("friction"), STEEL, **given)


@pytest.mark.parametrize("law", LAWS)
@edges
@given(u=numbers, size=sizes)
def test_finite_bounded_and_mirrored(law, u, size):
    k = Drawn(size)
    found = k.forces(law, np.array([u, u * MIRROR, u * np.array([-1.0, 1.0, 1.0])]), derivatives=True)
    assert np.isfinite(found.forces).all() and np.isfinite(found.derivatives).all()
    h = found.forces / k.unit
    rounding = 1e-11 * max(1.0, np.abs(u).max())
    np.testing.assert_allclose(h[1], h[0] * MIRROR, rtol=0, atol=rounding)
    np.testing.assert_allclose(h[2], h[0] * [-1.0, 1.0, 1.0], rtol=0, atol=rounding)
    if law in SATURATING:
        assert np.hypot(*h[0, :2]) <= LARGEST_FORCE[law]
        assert abs(h[0, 2]) <= np.sqrt(max(k.ratio, 1.0 / k.ratio))  # all of mu N at the end of the longer semi-axis


@pytest.mark.parametrize("law", SATURATING)
@edges
@given(u=numbers, size=sizes, direction=st.tuples(*3 * [st.floats(-1.0, 1.0)]), log_step=st.floats(-9.0, 0.0))
def test_small_change_of_creepage_small_change_of_force(law, u, size, direction, log_step):
    k, step = Drawn(size), 10.0**log_step * np.array(direction)
    first, second = k.h(law, np.array([u, np.array(u) + step]))
    force, moment, _ = STEEPEST[law]
    rounding = 1e-10 + 1e-15 * np.abs(u).max()  # of u + step
    assert np.hypot(*(second - first)[:2]) <= force * np.linalg.norm(step) + rounding
    assert abs(second[2] - first[2]) <= moment * k.moment_slope * np.linalg.norm(step) + rounding


@pytest.mark.parametrize("law", SATURATING)
@edges
@given(u=numbers, size=sizes, more=st.floats(0.0, 1.0))
def test_small_change_of_load_small_change_of_force_down_to_lift(law, u, size, more):
    """For creepages held; the load may go all the way to zero and below."""
    k = Drawn(size)
    loads = k.load * np.array([1.0, more, 0.0, -1.0])
    found = k.forces(law, u, load=loads)
    assert np.all(found[2:] == 0)
    change = np.abs(found[0] - found[1]) / (k.friction * np.array([1.0, 1.0, k.arm]))
    slender = np.array([1.0, 1.0, np.sqrt(max(k.ratio, 1.0 / k.ratio))])
    assert np.all(change <= STEEPEST[law][2] * slender * (loads[0] - loads[1]) + 1e-9 * k.load)


def test_linear_theory_goes_to_zero_with_its_ellipse():
    """It has no limit of friction: at lift the ellipse, as N^(1/3), takes the force along (N^(2/3))."""
    loads = np.array([8e4, 8e1, 8e-2])
    size = 1e-3 * (loads / 1e4) ** (1 / 3)
    force = rs.creep_forces("kalker_linear", 1.2 * size, size, [1e-3, 1e-3, 0.0], loads, 0.3)
    np.testing.assert_allclose(force[1:, 1] / force[:-1, 1], 1e-2, rtol=1e-9)


@pytest.mark.parametrize("law", LAWS)
@edges
@given(xi=signed(-12.0, 0.0), eta=signed(-12.0, 0.0), phi=signed(-12.0, 4.0), size=sizes)
def test_creepages_up_to_one_and_any_spin_with_and_without_load_and_friction(law, xi, eta, phi, size):
    k = Drawn(size)
    loads, frictions = np.meshgrid([k.load, 1e-90, 0.0, -k.load], [k.friction, 0.0])
    found = rs.creep_forces(law, k.a, k.b, [xi, eta, phi], loads, frictions, STEEL, derivatives=True)
    assert np.isfinite(found.forces).all() and np.isfinite(found.derivatives).all()
    none = (loads <= 0) | (frictions == 0)
    assert np.all(found.forces[none] == 0) and np.all(found.derivatives[none] == 0)
    huge = rs.creep_forces(law, k.a, k.b, np.array([xi, eta, phi]) * 1e250, [1e-90, k.load], k.friction, STEEL)
    assert law not in SATURATING or np.isfinite(huge).all()


@pytest.mark.parametrize("law", LAWS)
@edges
@given(u=numbers, size=sizes)
def test_creep_forces_take_power_from_the_wheel(law, u, size):
    """F slip <= 0. Kalker linear, FASTSIM and FaStrip always; the others without spin (their forces of spin have no fitting moment)."""
    k = Drawn(size)
    u = np.array(u) * ([1.0, 1.0, 0.0] if law in ("shen_hedrick_elkins", "polach") else 1.0)
    parts = k.forces(law, u) * k.creepages(u)
    assert parts.sum() <= 1e-9 * np.abs(parts).sum()


def test_which_laws_may_give_power():
    """The other side of the test above: where docs/creep_forces.md warns, there is something to warn of."""
    k = Drawn((0.5, -2.3, 4.8, 0.3))
    u = np.random.default_rng(3).uniform(-3.0, 3.0, (4000, 3))
    gives = {law: np.mean((k.forces(law, u) * k.creepages(u)).sum(axis=1) > 0) for law in LAWS}
    assert gives["polach"] > 0.01
    assert [gives[law] for law in ("kalker_linear", "fastsim", "fastrip")] == [0.0, 0.0, 0.0]


def one_sided(k, law, u, j):
    """h there, slopes to both sides and the derivative, all over the unit of h and u (j < 3) or relative (load, friction, weight)."""
    if j < 3:
        step = 1e-6 * max(1.0, abs(u[j]))
        low, middle, high = k.h(law, np.array(u) + np.outer([-1.0, 0.0, 1.0], step * np.eye(3)[j]))
        exact = k.forces(law, u, derivatives=True).derivatives[:, j] * k.limit / k.f[j] / k.unit
    else:
        step, name = 1e-6, ("load", "friction", "kalker_weight")[j - 3]
        value = (k.load, k.friction, 1.0)[j - 3]
        low, middle, high = k.h(law, u, **{name: value * (1.0 + np.array([-step, 0.0, step]))})
        exact = k.forces(law, u, derivatives=True).derivatives[:, j] * value / k.unit
    return (middle - low) / step, (high - middle) / step, exact


@pytest.mark.parametrize("law", LAWS)
def test_derivatives_are_those_of_the_forces(law):
    """Central differences wherever both sides agree: a kink lies elsewhere. Kinks: FASTSIM, FaStrip where a cell begins to slip, Polach
    where |eta + phi a| = |eta|."""
    random = np.random.default_rng(17)
    smooth = total = 0
    for _ in range(60):
        k = Drawn((random.uniform(-1, 1), random.uniform(-3, -2), random.uniform(-3, 6), random.uniform(0.01, 0.8)))
        u = random.uniform(-3.0, 3.0, 3) if random.random() < 0.5 else 10.0 ** random.uniform(-6, 4, 3) * random.choice([-1, 1], 3)
        u[random.random(3) < 0.15] = 0.0
        for j in range(6):
            before, after, exact = one_sided(k, law, u, j)
            size = max(1.0, np.abs(exact).max(), np.abs(u).max() if law == "kalker_linear" else 0.0)
            kinked = np.abs(after - before).max() > 1e-4 * size
            total, smooth = total + 1, smooth + (not kinked)
            if not kinked:
                assert np.abs(0.5 * (before + after) - exact).max() <= 1e-4 * size, (u, k.ratio, j)
    assert smooth > 0.95 * total


@pytest.mark.parametrize("law", LAWS)
def test_nothing_jumps_at_zero_creepage(law):
    """Towards zero from any side the force goes to zero, and all derivatives to those at zero, but Polach's, whose mean of C11 and C22
    depends on the direction: his stay within twice Kalker's."""
    directions = np.random.default_rng(2).normal(size=(200, 3))
    directions = np.concatenate([directions / np.linalg.norm(directions, axis=1)[:, None], np.eye(3), -np.eye(3)])
    for log_ratio in (-1.0, 0.0, 1.0):
        k = Drawn((log_ratio, -2.3, 4.8, 0.3))
        per = k.limit / k.f / k.unit[:, None]
        zero = k.forces(law, np.zeros(3), derivatives=True)
        assert np.all(zero.forces == 0)
        for size in (1e-4, 1e-8, 1e-150):
            near = k.forces(law, size * directions, derivatives=True)
            assert np.abs(near.forces / k.unit).max() <= 3.0 * k.moment_slope * size
            change = np.abs(near.derivatives - zero.derivatives)
            slopes = (change[..., :3] * per).max(), (change[..., 3:] * [k.load, k.friction, 1.0] / k.unit[:, None]).max()
            # FaStrip: what slips behind the adhesion of a strip goes with size^(3/2), so slopes with its root (6.7 at most)
            # exact: its correction grows with the square of the creepage on the scale 1.5 of u (3.5 at most)
            allowed = {"polach": 2.0, "fastrip": 10.0 * size**0.5, "exact": 7.0 * size * max(1.0, k.moment_slope) ** 2}.get(law, 3.0 * size * max(1.0, k.moment_slope) ** 2) + 1e-12
            assert slopes[0] <= allowed and slopes[1] <= 3.0 * k.moment_slope * size


@pytest.mark.parametrize("law", ("fastsim", "fastrip"))
@pytest.mark.parametrize("ratio", (0.1, 1.0, 10.0))
def test_spin_goes_through_psi_one_without_a_jump(law, ratio):
    """Strip theory has no solution beyond |psi| = u3 = 1: its transition to FASTSIM, at no, longitudinal, and lateral creepage."""
    k = Drawn((np.log10(ratio), -2.3, 4.8, 0.3))
    spin = np.linspace(0.5, 1.5, 4001)
    for creepage in ((0.0, 0.0), (1e-6, 0.0), (0.3, 0.0), (0.0, 0.3), (0.0, -0.3), (0.0, 1e-6), (0.0, -1e-6)):
        u = np.column_stack([np.full(len(spin), creepage[0]), np.full(len(spin), creepage[1]), spin])
        slope = np.abs(np.diff(k.h(law, u), axis=0)).max() / (spin[1] - spin[0])
        assert slope < STEEPEST[law][0]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("count", (0, 1, 7, 8, 9, 1000))
def test_any_number_of_contacts_gives_the_bytes_of_each_alone(law, count):
    random = np.random.default_rng(count)
    a, b = random.uniform(1e-3, 8e-3, (2, count))
    creepages = random.normal(size=(count, 3)) * [2e-3, 2e-3, 0.4]
    load = random.uniform(-1e4, 1e5, count)
    found = rs.creep_forces(law, a, b, creepages, load, 0.3, STEEL, derivatives=True)
    assert found.forces.shape == (count, 3) and found.derivatives.shape == (count, 3, 6)
    for n in range(0, count, max(1, count // 25)):
        alone = rs.creep_forces(law, a[n], b[n], creepages[n], load[n], 0.3, STEEL, derivatives=True)
        assert np.array_equal(alone.forces, found.forces[n]) and np.array_equal(alone.derivatives, found.derivatives[n])


@pytest.mark.parametrize("law", LAWS)
def test_arguments_broadcast(law):
    a, load, friction = np.array([3e-3, 5e-3])[:, None, None], np.array([1e4, 0.0, 8e4])[:, None], np.array([0.1, 0.2, 0.3, 0.4])
    creepages = np.array([1e-3, -2e-3, 0.2])
    found = rs.creep_forces(law, a, 4e-3, creepages, load, friction, STEEL, derivatives=True)
    assert found.forces.shape == (2, 3, 4, 3) and found.derivatives.shape == (2, 3, 4, 3, 6)
    one = rs.creep_forces(law, 5e-3, 4e-3, creepages, 8e4, 0.2, STEEL, derivatives=True)
    assert np.array_equal(found.forces[1, 2, 1], one.forces) and np.array_equal(found.derivatives[1, 2, 1], one.derivatives)
    assert np.all(found.forces[:, 1] == 0)
    empty = rs.creep_forces(law, np.empty((0, 1)), 4e-3, np.zeros((4, 3)), 1e4, 0.3, STEEL, derivatives=True)
    assert empty.forces.shape == (0, 4, 3) and empty.derivatives.shape == (0, 4, 3, 6)


@pytest.mark.parametrize("law", ("fastsim", "fastrip"))
@pytest.mark.parametrize("grid", ((1, 1), (1, 20), (20, 1), (2, 2), (5, 3), (6, 70), (11, 9)))
def test_any_grid_is_one_algorithm(law, grid):
    """With and without slopes strips go side by side in other numbers: the same forces; and the oracle's."""
    from tests.oracles.creep_laws import LAWS as ORACLES
    from tests.oracles.creep_laws import Contact

    k = Drawn((0.3, -2.3, 4.8, 0.3))
    u = np.random.default_rng(4).uniform(-2.0, 2.0, (9, 3))
    plain, both = k.forces(law, u, grid=grid), k.forces(law, u, grid=grid, derivatives=True).forces
    np.testing.assert_allclose(plain / k.unit, both / k.unit, rtol=0, atol=1e-13)
    coefficients = [float(c) for c in k.c]
    for n in (0, 8):
        expected = ORACLES[law](Contact(*k.creepages(u[n]), k.load, k.friction, 1.0, k.a, k.b, STEEL.shear_modulus, *coefficients,
                                        strips=grid[0], cells=grid[1]))
        np.testing.assert_allclose(plain[n] / k.unit, np.real(expected) / k.unit, rtol=0, atol=1e-10)
