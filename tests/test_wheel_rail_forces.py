# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces in motion: a plain second implementation, energy, symmetry, invariance, signs."""

import numpy as np
import pytest
from oracles import wheel_rail_motion as oracle
from oracles.element_pair import turn
from oracles.wheel_rail_cases import FLANGE, R0, SPEED, TREAD, TREAD_ONLY, TWO_ZONES, random_state, rolling, rows_of, setting, wheelset
from oracles.wheel_rail_motion import State

from railsym.conical_contact import Cone, ConicalContact

REST = np.zeros(6)
# The oracle finds the contact's place along the rail by a search, to sqrt(2^-53) of a lever of 0.5 m: radii and creepages
# to 1e-8, times creep coefficients of 1e7 N. It differences the penetration over 2 us: 1e-16/1e-6 m/s.
SEARCHED = 5e-7


def states(shifts=(0.0, 2e-3, -3e-3, 6e-3, -6e-3), seed=401):
    rng = np.random.default_rng(seed)
    return [random_state(rng, shift) for shift in shifts]


# --- against the plain implementation ---------------------------------------------------------------------------

@pytest.mark.parametrize("law", ["kalker_linear", "shen_hedrick_elkins", "polach", "fastsim", "fastrip"])
def test_rows_are_those_of_the_plain_implementation(law):
    options = {"law": law, "damping": 2.0, "friction": 0.25, "kalker_weight": 0.8}
    forces = wheelset(TWO_ZONES, **options)
    given = setting(TWO_ZONES, forces, **options)
    zones = set()
    for state in states():
        rows, _ = rows_of(forces, state)
        parts = [oracle.wheel(given, state, side) for side in (-1, 1)]
        zones |= {patch["zone"] for _, patches in parts for patch in patches}
        expected = sum(part for part, _ in parts)
        np.testing.assert_allclose(rows[0], expected, rtol=0, atol=SEARCHED * np.abs(expected).max())
    assert zones == {0, 1}  # the flange took part


def test_outputs_are_those_of_the_plain_implementation():
    options = {"law": "polach", "damping": 2.0}
    forces = wheelset(TWO_ZONES, **options)
    given = setting(TWO_ZONES, forces, **options)
    for state in states(seed=402):
        rows_of(forces, state)
        found = forces.outputs()
        for k, side in enumerate((-1, 1)):
            _, patches = oracle.wheel(given, state, side)
            total = sum((p["wheel_force"] for p in patches), np.zeros(3))
            scale = max(1.0, np.abs(total).max())
            np.testing.assert_allclose([found.Y[k], found.Q[k], found.X[k]], [-side * total[1], -total[2], total[0]],
                                       rtol=0, atol=SEARCHED * scale)
            assert found.patches[k] == len(patches)
            wear = sum(abs(p["force"][:2] * p["creepage"][:2]).sum() for p in patches)
            assert found.t_gamma[k] == pytest.approx(wear, rel=1e-5, abs=1e-9)
            for p in patches:
                zone = p["zone"]
                assert found.load[k, zone] == pytest.approx(p["load"], rel=1e-6)
                np.testing.assert_allclose(found.creepage[k, zone], p["creepage"], rtol=0, atol=1e-7)
                np.testing.assert_allclose(found.force[k, zone], p["force"], rtol=0, atol=1e-6 * p["load"])
                arm = oracle.attitude(state.q).T @ p["arm"]
                assert found.across[k, zone] == pytest.approx(side * arm[1], abs=1e-7)


# --- energy -----------------------------------------------------------------------------------------------------

def test_normal_forces_are_the_gradient_of_the_elastic_energy():
    """No friction, no damping, rails level along the track: rows = dE/dq, so they do work on the penetration only."""
    forces = wheelset(TWO_ZONES, friction=0.0)
    given = setting(TWO_ZONES, forces)
    for state in states(seed=403):
        state.rails[:, 2:] = 0.0  # a rail that climbs takes power from the speed V, which is not a coordinate
        rows, _ = rows_of(forces, state)
        gradient = np.zeros(6)
        for j, step in enumerate([1e-6] * 3 + [1e-6, 1e-6, 1e-3]):
            at = [oracle.potential(given, State(state.q + s * step * np.eye(6)[j], state.u, SPEED, state.w, state.rails))
                  for s in (-2, -1, 1, 2)]
            gradient[j] = np.dot([1, -8, 8, -1], at) / (12 * step)
        # roundoff of 2 J over 1e-6; truncation (1e-6/8e-5)^4
        np.testing.assert_allclose(rows[0], gradient, rtol=0, atol=2e-7 * np.abs(gradient).max())


def test_creep_forces_take_power():
    forces = wheelset(TWO_ZONES, law="fastsim")
    for state in states(seed=404):
        rows_of(forces, state)
        found = forces.outputs()
        power = np.sum(found.creepage * found.force, axis=2)
        assert np.all(power[found.load > 0] < 0) and np.all(power[found.load == 0] == 0)


# --- symmetry and invariance ------------------------------------------------------------------------------------

MIRROR = np.array([1.0, -1.0, 1.0, -1.0, -1.0, 1.0])


def mirrored(state):
    rails = state.rails[::-1] * [-1.0, 1.0, -1.0, 1.0]
    return State(state.q * MIRROR, state.u * MIRROR, state.speed, state.w * [-1.0, 1.0, -1.0], rails)


@pytest.mark.parametrize("law, rest", [("polach", 0.0), ("kalker_linear", 0.0), ("fastsim", 1e-12)])
def test_mirrored_motion_has_mirrored_forces(law, rest):
    """To the last bit; FASTSIM sums its strips from one edge to the other, so in another order."""
    forces = wheelset(TWO_ZONES, law=law, damping=1.0)
    for state in states(seed=405):
        rows, blocks = rows_of(forces, state, (1.0, 0.3))
        Y, Q = forces.outputs().Y, forces.outputs().Q
        other, other_blocks = rows_of(forces, mirrored(state), (1.0, 0.3))
        found = forces.outputs()
        for there, here in ((other[0], rows[0] * MIRROR), (other_blocks[0], blocks[0] * np.outer(MIRROR, MIRROR)),
                            (found.Y, Y[::-1]), (found.Q, Q[::-1])):
            np.testing.assert_allclose(there, here, rtol=0, atol=rest * np.abs(here).max())


def test_rails_that_move_are_a_wheelset_that_moves_the_other_way():
    forces = wheelset(TWO_ZONES)
    for state in states(seed=406):
        state.rails[:] = state.rails[0]  # both alike: no cross level
        moved = State(state.q - [0, *state.rails[0, :2], 0, 0, 0], state.u, SPEED, state.w, state.rails * [0, 0, 1, 1])
        # the frame's own turning moves a wheelset that lies elsewhere at another speed
        moved.w = state.w = np.zeros(3)
        np.testing.assert_allclose(rows_of(forces, state)[0], rows_of(forces, moved)[0], rtol=0, atol=1e-6)


def test_rails_turned_by_cross_level_are_a_track_frame_that_is_turned():
    """Left rail up, right rail down by the same: forces in the turned frame are those without deviation, turned."""
    forces = wheelset()
    tilt = 4e-3
    state = states(seed=407)[1]
    state.w, state.rails = np.zeros(3), np.zeros((2, 4))
    level, _ = rows_of(forces, state)
    about = turn(0, tilt)
    # Rail heads at (+-b, 0) turn about the track's centre: they go down by b sin(tilt) and in by b (1 - cos(tilt)).
    b = 0.75
    rails = np.array([[b * (1 - np.cos(tilt)), -b * np.sin(tilt), 0, 0], [-b * (1 - np.cos(tilt)), b * np.sin(tilt), 0, 0]])
    offset = np.array([0.0, 0.0, -R0])
    axle = about @ oracle.attitude(state.q) @ np.array([0.0, 1.0, 0.0])
    q = np.concatenate([about @ (offset + state.q[:3]) - offset, [np.arctan2(-axle[0], axle[1]), np.arcsin(axle[2]), 0.0]])
    turned, _ = rows_of(forces, State(q, rates_of(about, state, q), SPEED, state.w, rails))
    np.testing.assert_allclose(turned[0, :3], about @ level[0, :3], rtol=0, atol=1e-5)
    np.testing.assert_allclose(turned[0, 5], level[0, 5], rtol=0, atol=1e-5)


def rates_of(about, state, q):
    """Rates of the coordinates in a frame turned by `about` that have the same velocities."""
    spin = about @ np.column_stack([np.eye(3)[2], turn(2, state.q[3])[:, 0], oracle.attitude(state.q)[:, 1]]) @ state.u[3:]
    axes = np.column_stack([np.eye(3)[2], turn(2, q[3])[:, 0], oracle.attitude(q)[:, 1]])
    velocity = about @ (np.array([SPEED, 0, 0]) + state.u[:3]) - [SPEED, 0, 0]
    return np.concatenate([velocity, np.linalg.solve(axes, spin)])


def test_rails_askew_are_a_track_frame_that_is_askew():
    """A rail's heading is no slip: the same motion seen from a frame turned by it, the material of the rail at rest."""
    forces = wheelset(damping=1.0)
    for heading in (1e-3, 2e-3):
        state = states(seed=408)[0]
        state.w, state.rails = np.zeros(3), np.zeros((2, 4))
        straight, _ = rows_of(forces, state)
        about = turn(2, heading)
        q = np.concatenate([about @ state.q[:3], [state.q[3] + heading, *state.q[4:]]])
        q[1] = state.q[1]  # the rails pass through the wheelset's section at their design place
        rails = np.tile([0.0, 0.0, np.tan(heading), 0.0], (2, 1))
        askew, _ = rows_of(forces, State(q, rates_of(about, state, q), SPEED, state.w, rails))
        expected = np.concatenate([about @ straight[0, :3], straight[0, 3:]])
        # The rails' distance square to them shrinks by 1.5 m heading^2/2 = 3 um at 2e-3.
        np.testing.assert_allclose(askew[0], expected, rtol=0, atol=3e9 * 0.1 * heading**2 / 2 * 0.75)
        np.testing.assert_allclose(askew[0, 0] + askew[0, 1] * 1j, expected[0] + expected[1] * 1j, rtol=2e-3)


# --- signs and closed forms -------------------------------------------------------------------------------------

def test_cylinders_that_roll_without_creep_carry_their_load_only():
    forces = wheelset(ConicalContact((Cone(0.0),)), law="fastsim")
    rows, _ = forces.rows(REST, rolling(), SPEED)
    np.testing.assert_allclose(rows[0], [0, 0, 1.2e5, 0, 0, 0], rtol=0, atol=1e-6)
    found = forces.outputs()
    np.testing.assert_allclose(found.creepage[:, 0], 0, atol=1e-15)
    np.testing.assert_allclose(found.Q, 6e4, rtol=1e-12)


def test_wheelset_that_points_to_the_right_is_pushed_to_the_right():
    forces = wheelset(ConicalContact((Cone(0.0),)))
    rows, _ = forces.rows([0, 0, 0, 1e-3, 0, 0], rolling(), SPEED)
    assert rows[0, 1] < -1e4  # residual: minus the force
    found = forces.outputs()
    np.testing.assert_allclose(found.creepage[:, 0, 1], -1e-3, rtol=1e-5)
    np.testing.assert_array_equal(np.sign(found.Y), [1, -1])  # on the rails: to the left


def test_cones_that_shift_to_the_right_steer_to_the_left():
    forces = wheelset(ConicalContact((Cone(0.1),)), law="kalker_linear")
    rows, _ = forces.rows([0, 1e-3, 0, 0, -0.1e-3 / 0.75, 0], rolling(), SPEED)
    found = forces.outputs()
    # side lam yc/r0: the roll moves the contact over the wheel by its levers to the axle and to the centre of the rail's head
    along = 0.1 * (1e-3 + (R0 + TREAD.rail_radius) * 0.1e-3 / 0.75) / R0
    np.testing.assert_allclose(found.creepage[:, 0, 0], [along, -along], rtol=0.01)
    assert found.X[1] > 0 > found.X[0] and rows[0, 3] > 0


def test_spin_creepage_of_a_cone():
    forces = wheelset()
    forces.rows(REST, rolling(), SPEED)
    found = forces.outputs()
    sine = np.sin(np.arctan(TREAD.slope))
    np.testing.assert_allclose(found.creepage[:, 0, 2], [sine / R0, -sine / R0], rtol=1e-12)
    np.testing.assert_allclose(found.angle[:, 0], np.arctan(TREAD.slope), rtol=1e-12)


def test_flange_pushes_its_rail_outwards_and_its_wheelset_back():
    forces = wheelset(TWO_ZONES)
    touching = []
    for shift in (3e-3, 6e-3, 6.2e-3, 6.4e-3):
        rows, _ = forces.rows([0, shift, 0, 0, 0, 0], rolling(), SPEED)
        found = forces.outputs()
        touching.append(found.load[1, 1])
        assert found.load[0, 1] == 0.0
    assert touching[0] == 0.0 and touching[-1] > touching[-2] > 0.0
    assert found.patches[1] == 2
    assert found.angle[1, 1] == pytest.approx(np.arctan(FLANGE.slope), abs=1e-3)
    assert found.Y[1] > 1e4 and rows[0, 1] > 1e4
    assert found.Y[1] - found.Y[0] == pytest.approx(rows[0, 1])  # sum of Y, to the right, against the force on the wheelset
    assert found.Q.sum() == pytest.approx(rows[0, 2])


def test_yawed_flange_touches_ahead_where_the_wheel_runs_against_the_rail():
    """Positive yaw turns the wheelset to the right: the right flange touches ahead of the axle."""
    forces = wheelset(TWO_ZONES)
    ahead = []
    for yaw in (-0.02, 0.02):
        forces.rows([0, 6.4e-3, 0, yaw, 0, 0], rolling(), SPEED)
        ahead.append(forces.outputs().x[1, 1])
    assert ahead[1] == pytest.approx(-ahead[0], rel=1e-12)
    assert ahead[1] == pytest.approx(FLANGE.radius * FLANGE.slope * 0.02, rel=0.05)


# --- load -------------------------------------------------------------------------------------------------------

def test_wheels_in_the_air_carry_exactly_nothing():
    forces = wheelset(TWO_ZONES, damping=1.0)
    rows, blocks = forces.rows([0, 1e-3, -1e-3, 0, 0, 0], rolling(z=0.5), SPEED, seed=(1.0, 1.0))
    found = forces.outputs()
    for part in (rows, blocks, found.Y, found.Q, found.X, found.t_gamma, found.load, found.force, found.patches):
        assert not np.any(part)


def test_one_wheel_in_the_air():
    forces = wheelset()
    rows, _ = forces.rows([0, 0, 0, 0, 5e-3, 0], rolling(), SPEED)
    found = forces.outputs()
    np.testing.assert_array_equal(found.patches, [0, 1])
    assert found.Q[0] == 0.0 and found.Q[1] > 1e5 and rows[0, 4] > 0


@pytest.mark.parametrize("law", ["polach", "fastsim"])
def test_contact_comes_back_without_a_jump(law):
    """Loads and creep forces grow from nothing: every step over the touch is of the order of its elastic load."""
    forces = wheelset(law=law, damping=1.0)
    sink = forces.sink[0]
    heights = -sink + np.array([-1e-8, 1e-12, 1e-10, 1e-9, 1e-8])
    found = np.array([np.abs(forces.rows([0, 0, z, 0, 0, 0], rolling(y=0.1), SPEED)[0][0]).max() for z in heights])
    stiffness = setting(TREAD_ONLY, forces).stiffness[0]
    # Both wheels, lever and damping: within a factor of 3 of 2 k z^(3/2).
    assert found[0] == 0.0 and np.all(found[1:] < 6 * stiffness * (heights[1:] + sink) ** 1.5)
    assert np.all(found[1:] > 0)


def test_damping_of_the_load():
    """N = N_elastic (1 + chi rate), not below zero."""
    chi = 1.5
    forces = wheelset(ConicalContact((Cone(0.0),)), damping=chi)
    loads = []
    for rate in (-1.0, -1 / chi, -0.4, 0.0, 0.2):
        forces.rows(REST, rolling(z=rate), SPEED)
        loads.append(forces.outputs().load[0, 0])
    np.testing.assert_allclose(loads, [0.0, 0.0, 6e4 * (1 - 0.4 * chi), 6e4, 6e4 * (1 + 0.2 * chi)], rtol=1e-12, atol=1e-9)
    # Rails that rise at 20 mm/s are a wheelset that sinks. On a climb of c it is also nearer to its rail by r0 c^2/2, 0.08 of 77 um.
    forces.rows(REST, rolling(), SPEED, rail=[0, 0, 0, 0, 0, -0.02 / SPEED, 0, -0.02 / SPEED])
    assert forces.outputs().load[0, 0] == pytest.approx(6e4 * (1 + 0.02 * chi), rel=2e-3)


def test_wheels_sink_by_what_carries_their_load():
    loads = [5e4, 7e4]
    forces = wheelset(TWO_ZONES, wheel_loads=loads, friction=0.0)
    forces.rows(REST, rolling(), SPEED)
    np.testing.assert_allclose(forces.outputs().Q, loads, rtol=1e-9)
    assert forces.sink[1] > forces.sink[0] > 5e-5
