# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces over a contact table, beside the closed form of the same surfaces; vehicles; errors."""

import numpy as np
import pytest
from oracles.wheel_rail_cases import R0, SPEED, TREAD_ONLY, lie, random_state, rolling, rows_of, wheelset
from oracles.wheel_rail_motion import State

import railsym as rs
from railsym._core import lib
from railsym.contact_table import OutOfTableError
from railsym.errors import ContactError
from railsym.conical_contact import Cone, ConicalContact
from railsym.wheel_rail import WheelRail, WheelsetPlace


@pytest.fixture(scope="module")
def cone_table():
    """Table of the cone TREAD on its round rail."""
    from benchmarks.wheel_rail import table_of_a_cone

    return table_of_a_cone()


def test_table_of_a_cone_gives_the_forces_of_its_closed_form(cone_table):
    """Two theories of the elastic contact: Hertz's ellipse here, the table's strips there; 0.2 % in the penetration at rest."""
    over_table, closed = wheelset(cone_table), wheelset(TREAD_ONLY)
    np.testing.assert_allclose(over_table.sink, closed.sink, rtol=5e-3)
    for y, yaw in ((0.0, 0.0), (1e-3, 0.0), (-2e-3, 4e-3), (3e-3, -6e-3)):
        q, u = [0, y, 0, yaw, -0.1 * y / 0.704, 0], rolling(y=0.02, spin=0.05)
        rows = [forces.rows(q, u, SPEED)[0][0] for forces in (over_table, closed)]
        a, b = (forces.outputs() for forces in (over_table, closed))
        np.testing.assert_allclose(a.creepage[:, 0], b.creepage[:, 0], rtol=0, atol=1e-5)
        np.testing.assert_allclose(a.angle[:, 0], b.angle[:, 0], rtol=0, atol=1e-4)
        np.testing.assert_allclose(a.x[:, 0], b.x[:, 0], rtol=0, atol=5e-6)
        np.testing.assert_allclose(rows[0], rows[1], rtol=0, atol=5e-4 * np.abs(rows[1]).max())


@pytest.mark.parametrize("law", ["kalker_linear", "shen_hedrick_elkins", "polach"])
def test_pencil_over_a_table_is_the_derivative_of_the_rows(law):
    """The wheel's curvature, so a/b and Kalker's coefficients, change with its place."""
    from benchmarks.wheel_rail import table_of_a_cone

    forces = wheelset(table_of_a_cone(wave=1.5), law=law, damping=1.0)
    rng = np.random.default_rng(431)
    weights = np.array([1, -8, 8, -1]) / 12
    ratios = []
    for shift in (0.0, 1.3e-3, -2.4e-3):
        state = random_state(rng, shift)
        for seed, steps in (((1.0, 0.0), [1e-6, 1e-6, 2e-7, 1e-5, 2e-7, 1e-3]), ((0.0, 1.0), [1e-3] * 6)):
            _, blocks = rows_of(forces, state, seed)
            for j, step in enumerate(steps):
                at = [rows_of(forces, State(state.q + k * step * seed[0] * np.eye(6)[j], state.u + k * step * seed[1] * np.eye(6)[j],
                                            SPEED, state.w, state.rails))[0][0] for k in (-2, -1, 1, 2)]
                expected = weights @ at / step
                scale = max(1.0, np.abs(expected).max())
                np.testing.assert_allclose(blocks[0, :, j] / scale, expected / scale, rtol=0, atol=5e-7)
        ratios += list(forces.outputs().a[:, 0] / forces.outputs().b[:, 0])
    assert max(ratios) > 1.1 * min(ratios)


def test_rows_are_the_same_with_and_without_slopes(cone_table):
    """Without a pencil tables are read without slopes: another sum of the same products, 1e-15 of each."""
    for contact in (cone_table, rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435)):
        forces = wheelset(contact, law="fastsim")
        for y, yaw in ((0.0, 0.0), (1e-3, 2e-3), (-2e-3, 4e-3)):
            q, u = [0, y, 0, yaw, -0.1 * y / 0.704, 0], rolling(y=0.02, spin=0.05)
            alone, _ = forces.rows(q, u, SPEED)
            outputs = forces.outputs()
            beside, blocks = forces.rows(q, u, SPEED, seed=(1.0, 2e3))
            assert np.abs(blocks).max() > 0
            np.testing.assert_allclose(alone, beside, rtol=0, atol=1e-10 * np.abs(beside).max())
            for name in ("load", "x", "radius", "angle", "a", "b", "creepage"):
                np.testing.assert_allclose(getattr(outputs, name), getattr(forces.outputs(), name), rtol=1e-10, atol=1e-13)


def test_errors_of_a_table_name_wheel_quantity_and_range(cone_table):
    forces = wheelset(cone_table)
    for q, said in (([0, -6e-3, 0, 0, 0, 0], r"wheelset 1, left: lateral shift -6 mm is outside the contact table \[-5, 5\] mm"),
                    ([0, 0, 0, 0, 5e-3, 0], r"wheelset 1, left: roll 5 mrad is outside the contact table \[-3, 3\] mrad"),
                    ([0, 0, 1e-3, 0, 0, 0], r"wheelset 1, left: penetration 1.07\d mm is outside the contact table \[0, 0.3\] mm")):
        with pytest.raises(OutOfTableError, match=said):
            forces.rows(q, rolling(), SPEED)
        with pytest.raises(OutOfTableError, match="wheelset 1, left: .* at t = 1.204 s"):
            forces.explain(lib.RS_OUT_OF_TABLE, SPEED, time=1.204)


@pytest.mark.parametrize("place, quantity, value", [([0, 0, 0.02, 0.01, -0.03, 0], "penetration", None), ([0, -0.021, 0, 0, 0, 0], "lateral shift", -0.021),
                                                    ([0, 0, 0, 0, 0.11, 0], "roll", 0.11)])
def test_errors_of_cones_too(place, quantity, value):
    forces = wheelset()
    with pytest.raises(OutOfTableError) as caught:
        forces.rows(place, rolling(), SPEED)
    error = caught.value
    assert error.quantity == quantity and not error.limits[0] <= error.value <= error.limits[1]
    assert value is None or error.value == pytest.approx(value)


def test_penetration_that_an_error_names_is_the_one_of_the_load():
    forces = wheelset()
    stiffness = TREAD_ONLY._zone(TREAD_ONLY.zones[0])["stiffness"]
    y, roll, z, yaw = 1e-3, -1e-4, 3e-5, 0.02
    forces.rows([0, y, z, yaw, roll, 0], rolling(), SPEED)
    found = [TREAD_ONLY._penetration((side * y, side * roll, z + forces.sink[0], side * yaw)) for side in (-1, 1)]
    np.testing.assert_allclose(forces.outputs().load[:, 0], stiffness * np.array(found) ** 1.5, rtol=1e-9)


# --- vehicles ---------------------------------------------------------------------------------------------------

def test_design_position_of_a_vehicle_carries_its_static_loads():
    vehicle = rs.load_vehicle("pendolino")
    forces = WheelRail(vehicle, ConicalContact((Cone(0.05),)), law="fastsim", friction=0.0)
    n = forces.size
    u = np.zeros(n)
    for one in forces.wheelsets:
        u[one.first + 5] = -60.0 / 0.46
    rows, blocks = forces.rows(np.zeros(n), u, 60.0, seed=(1.0, 0.0))
    assert rows.shape == (4, 6) and blocks.shape == (4, 6, 6)
    from railsym.linear import rolling_vehicle

    np.testing.assert_allclose(forces.outputs().Q, rolling_vehicle(vehicle).preload.wheel_loads, rtol=1e-9)


def test_wheelsets_are_independent_of_each_other():
    """Patches of all wheels share lanes: each wheelset alone gives the same bytes."""
    places = [WheelsetPlace(f"wheelset {k + 1}", 6 * k, (0.0, 0.0, -R0)) for k in range(5)]
    together = WheelRail(places, TREAD_ONLY, law="fastsim", wheel_loads=6e4, friction=np.linspace(0.1, 0.5, 10))
    rng = np.random.default_rng(432)
    states = [random_state(rng) for _ in places]
    q, u = (np.concatenate([getattr(s, key) for s in states]) for key in "qu")
    rows, blocks = together.rows(q, u, SPEED, [s.w for s in states], [lie(s.rails) for s in states], (1.0, 2.0))
    for k, state in enumerate(states):
        alone = WheelRail(places[:1], TREAD_ONLY, law="fastsim", wheel_loads=6e4, friction=np.linspace(0.1, 0.5, 10)[2 * k:2 * k + 2])
        own, own_blocks = rows_of(alone, state, (1.0, 2.0))
        np.testing.assert_array_equal(own[0], rows[k])
        np.testing.assert_array_equal(own_blocks[0], blocks[k])


def test_left_and_right_may_differ():
    """Profiles, friction and loads of their own."""
    steep = ConicalContact((Cone(0.2),))
    forces = wheelset((TREAD_ONLY, steep), law="polach", friction=[0.1, 0.4], wheel_loads=[5e4, 7e4])
    forces.rows([0, 0, 0, 0.01, 0, 0], rolling(y=1.0), SPEED)  # full slip sideways
    found = forces.outputs()
    np.testing.assert_allclose(np.tan(found.angle[:, 0]), [0.1, 0.2], rtol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(found.force[:, 0, :2], axis=1) / found.load[:, 0], [0.1, 0.4], rtol=0.1)
    assert found.load[1, 0] > 1.3 * found.load[0, 0]


def test_rails_come_in_the_order_of_the_track():
    """A track whose rails lie askew gives what the wheels take: each wheel's own rail, places before slopes."""
    from railsym.track import Track

    track = Track.straight(200.0).with_irregularity("erri_b176_low", seed=3)
    rails = 0.05 * track.core.rails(np.array([100.0]))[0]  # vertically some tenths of the penetration
    forces, q = wheelset(friction=0.0), np.zeros(6)
    q[1] = 0.5 * (rails[0] + rails[2])
    found = []
    for lies in (rails, rails * [1, 1, 1, 1, 0, 0, 0, 0]):
        forces.rows(q, rolling(), SPEED, rail=lies)
        found.append(forces.outputs().load[:, 0])
    by_hand = []
    for side, (y, z) in ((0, rails[:2]), (1, rails[2:4])):
        forces.rows([0, q[1] - y, -z, 0, 0, 0], rolling(), SPEED)
        by_hand.append(forces.outputs().load[side, 0])
    # what the rails' own turning and heading change is below a tenth of what their places do
    np.testing.assert_allclose(found[1], by_hand, rtol=0.02)
    assert np.ptp(found[1]) > 100.0


# --- errors -----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("speed", [0.0, -3.0, float("nan")])
def test_speed_must_be_positive(speed):
    with pytest.raises(ContactError, match="speed is .* m/s; .* must be positive"):
        wheelset().rows(np.zeros(6), rolling(), speed)


def test_bad_states_are_named_and_nothing_is_kept():
    forces = wheelset()
    fine = forces.rows(np.zeros(6), rolling(), SPEED)[0]
    for q, u, said in (([0, np.nan, 0, 0, 0, 0], rolling(), "left: its lateral shift against the rail is nan"),
                       (np.zeros(6), rolling(y=np.inf), "left: its forces are not finite"),
                       ([0, 0.03, 0, 0, 0, 0], rolling(), r"left: lateral shift 30 mm is outside the contact table \[-20, 20\] mm"),
                       (np.zeros(5), rolling(), "q: the wheelsets' coordinates reach number 5")):
        with pytest.raises(ContactError, match=said):
            forces.rows(q, u, SPEED)
    np.testing.assert_array_equal(forces.rows(np.zeros(6), rolling(), SPEED)[0], fine)


@pytest.mark.parametrize("options, said", [
    ({"law": "fastsin"}, "did you mean 'fastsim'"), ({"friction": -0.1}, "friction .* not be negative|finite and not negative"),
    ({"friction": [0.1, 0.2, 0.3]}, "one number or one a wheel"), ({"kalker_weight": 0.0}, "kalker_weight must be positive"),
    ({"damping": np.nan}, "damping .s/m. must be finite"), ({"grid": (0, 5)}, "grid needs"), ({"reduction": (0.5, 0.8)}, "kS <= kA"),
    ({"rail_spacing": 0.0}, "rail_spacing is 0.0 m"), ({"wheel_loads": 1e12}, r"cannot carry the static load of wheelset 1, left, 1e\+12 N: .* is outside the contact table"),
])
def test_bad_parameters(options, said):
    with pytest.raises(ContactError, match=said):
        wheelset(**options)


def test_what_is_not_a_contact_or_has_no_wheelset():
    with pytest.raises(ContactError, match="contact is str; .* need a ContactPair"):
        wheelset("S1002")
    with pytest.raises(ContactError, match="at least one wheelset"):
        WheelRail([], TREAD_ONLY)


def test_slender_ellipses_beyond_the_coefficients_are_refused():
    from railsym._core_wheel_rail import WheelRailCore, cones
    from railsym.wheel_rail import kalker_table

    start, step, cubics = kalker_table(0.28)
    shape = cones(R0, [TREAD_ONLY._zone(TREAD_ONLY.zones[0]) | {"a": 1.0, "b": 1e-4}], (0.02, 0.1, 0.02))
    wheel = {"shape": shape, "sink": 5e-5, "friction": 0.3, "weight": 1.0, "damping": 0.0}
    creep = {"law": "polach", "strips": 1, "cells": 1, "modulus": 8.2e10, "adhesion": 1.0, "slip": 1.0, "start": start, "step": step, "c": cubics}
    given = [{"first": 0, "offset": (0.0, 0.0, -R0), "spacing": 1.5, "wheels": (wheel, wheel)}]
    with pytest.raises(ContactError, match="wheelset 1, left: a contact ellipse with a/b = 1e.04 is outside .* 0.001 to 1000"):
        WheelRailCore(given, creep).rows(np.zeros(6), rolling(), SPEED, None, None, None)
    with pytest.raises(ContactError, match="cannot be made: .* grid 0 x 1"):
        WheelRailCore(given, creep | {"strips": 0})
