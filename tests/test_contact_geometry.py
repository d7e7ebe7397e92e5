# SPDX-License-Identifier: BSD-3-Clause
"""Rigid contact against closed forms, a search over polylines, mirror images and the work of lifting."""

import numpy as np
import pytest
from oracles.profile_pairs import HALF, RADIUS, circle, cone, cone_on_round_edges, over_the_axis

import railsym as rs
from railsym.contact_geometry import Side
from railsym.errors import ContactError

MM = 1e-3
S1002 = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)


@pytest.mark.parametrize("conicity", [0.025, 0.2, 0.6])
def test_a_cone_on_round_edges(conicity):
    edge = 1.0 * MM
    pair = over_the_axis(cone(conicity), circle("rail", 1.0, "up", half_width=0.7))
    y = np.linspace(-12.0, 12.0, 25) * MM
    found = pair.contact(y)
    roll, (right, left), (angle_right, angle_left) = cone_on_round_edges(conicity, edge, y)
    # profiles are cubics between exact nodes 0.05 mm apart: on a 1 mm edge good to h^4/(384 R^3) = 2e-8 m in height, 1e-6 rad in angle
    np.testing.assert_allclose(found.roll, roll, atol=1e-7)
    np.testing.assert_allclose(found.right.rolling_radius, right, atol=2e-7)
    np.testing.assert_allclose(found.left.rolling_radius, left, atol=2e-7)
    np.testing.assert_allclose(found.right.contact_angle, angle_right, atol=1e-6)
    np.testing.assert_allclose(found.left.contact_angle, angle_left, atol=1e-6)


def test_without_roll_a_cone_has_its_conicity_exactly():
    pair = over_the_axis(cone(0.03), circle("rail", 300.0, "up"))
    y = np.linspace(-8.0, 8.0, 9) * MM
    found = pair.contact(y, with_roll=False)
    # contact rests at the same place of the circle
    np.testing.assert_allclose(found.rolling_radius_difference, 0.06 * y, atol=1e-10)
    np.testing.assert_allclose(found.right.rail_y, -0.3 * np.sin(np.arctan(0.03)), atol=1e-7)
    np.testing.assert_allclose(found.right.contact_angle, np.arctan(0.03), atol=1e-10)


@pytest.mark.parametrize("wheel_mm, bulge", [(500.0, "down"), (400.0, "up")])
def test_a_circle_on_a_circle(wheel_mm, bulge):
    """Contact is on the line of the two centres: sine of the angle = shift over the distance of the centres."""
    rail_mm = 300.0
    pair = over_the_axis(circle("wheel", wheel_mm, bulge, half_width=60.0), circle("rail", rail_mm, "up"))
    y = np.linspace(-2.0, 2.0, 9) * MM
    found = pair.contact(y, with_roll=False)
    curvature = -1.0 / wheel_mm if bulge == "up" else 1.0 / wheel_mm
    sine = -1e3 * y / (rail_mm + 1.0 / curvature)       # centres 800 mm apart, or 100 mm within each other
    np.testing.assert_allclose(np.sin(found.right.contact_angle), sine, atol=1e-8)
    np.testing.assert_allclose(1e3 * found.right.rail_y, -rail_mm * sine, atol=1e-4)
    np.testing.assert_allclose(1e3 * found.right.wheel_y, sine / curvature, atol=1e-4)
    np.testing.assert_allclose(found.right.wheel_curvature, 1e3 * curvature, rtol=1e-9)
    np.testing.assert_allclose(found.right.rail_curvature, 1e3 / rail_mm, rtol=1e-9)
    np.testing.assert_allclose(found.left.contact_angle, found.right.contact_angle[::-1], atol=1e-9)


def polyline_gap(pair, right, y, height, roll):
    """Least gap on one side, by another way: the wheel is turned and moved into the track, and compared with the rail over y."""
    sign = 1.0 if right else -1.0
    wheel, rail = pair.wheel, pair.rail.rotated(-np.arctan(pair.inclination))
    side = pair.sides[1]
    across, down = HALF + wheel.y, RADIUS + wheel.z - np.interp(0.0, wheel.y, wheel.z)
    c, s = np.cos(sign * roll), np.sin(sign * roll)
    moved = sign * y + c * across - s * down, height + s * across + c * down
    fine = np.arange(-36.0, 34.0, 0.002) * MM
    rail_z = np.interp(fine, rail.y, rail.z) - rail.z.min()
    return np.min(rail_z - np.interp(side.rail_offset + fine, *moved))


def test_both_wheels_touch_and_nothing_overlaps():
    y = np.array([-6.2, -5.1, -3.3, -0.2, 0.0, 0.13, 1.7, 4.9, 6.1, 6.4, 7.5]) * MM
    found, centre = S1002.contact(y), S1002.contact([0.0])
    start = -centre.right.rolling_radius[0]
    gap = polyline_gap(S1002, True, 0.0, start, 0.0)
    for k in range(len(y)):
        right, left = (polyline_gap(S1002, which, y[k], start + gap - found.lift[k], found.roll[k]) for which in (True, False))
        # chords of nodes 0.05 mm apart: 3e-8 m on R13, 70 degrees steep
        assert right == pytest.approx(0.0, abs=2e-7) and left == pytest.approx(0.0, abs=2e-7)


def test_left_is_the_mirror_image_of_right():
    y = np.linspace(-7.0, 7.0, 29) * MM
    found, mirrored = S1002.contact(y), S1002.contact(-y)
    for name in ("wheel_y", "rail_y", "rolling_radius", "contact_angle", "wheel_curvature"):
        np.testing.assert_allclose(getattr(found.left, name), getattr(mirrored.right, name), atol=1e-9)
    np.testing.assert_allclose(found.roll, -mirrored.roll, atol=1e-12)
    one = rs.ContactPair("S1002", "UIC60", wheel_left="EN15302_wheel_B", wheel_radius_left=0.459)
    other = rs.ContactPair("EN15302_wheel_B", "UIC60", wheel_left="S1002", wheel_radius=0.459, wheel_radius_left=0.460)
    np.testing.assert_allclose(one.contact(y).roll, -other.contact(-y).roll, atol=1e-10)
    np.testing.assert_allclose(one.contact(y).left.rolling_radius, other.contact(-y).right.rolling_radius, atol=1e-9)


def test_the_wheelset_rises_by_its_contact_angles():
    """Without roll the height of a wheel falls by tan(contact angle) a shift: dg/dy = 0 along the rail. Sign and value of the angle."""
    y = np.linspace(-6.5, 6.5, 5201) * MM
    found = S1002.contact(y, with_roll=False)
    slope = 0.5 * (np.tan(found.right.contact_angle) - np.tan(found.left.contact_angle))
    rise = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(y))])
    # the trapezoidal rule over jumps of the angle (tan up to 2.7) errs by 2.5 um times half the jump, each
    np.testing.assert_allclose(found.lift - found.lift[0], rise, atol=5e-6)
    assert found.lift[-1] > 0.2 * MM


def test_s1002_on_uic60_as_known():
    """REFERENCE of the field: rigid contact jumps 11 mm between 0 and 0.25 mm, again near 5 mm, and is at the flange from about 6.25 mm."""
    found = S1002.contact(np.array([0.0, 0.15, 0.25, 4.5, 5.25, 6.0, 6.4]) * MM)
    jump = 1e3 * (found.right.wheel_y[0] - found.right.wheel_y[2])
    assert jump == pytest.approx(11.0, abs=1.0)
    assert 1e3 * (found.right.wheel_y[3] - found.right.wheel_y[4]) > 8.0
    assert np.degrees(found.right.contact_angle[5]) < 30.0 < 65.0 < np.degrees(found.right.contact_angle[6])


def test_gauge_is_measured_14_mm_below_the_top():
    for gauge in (1.435, 1.432):
        pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 20, gauge=gauge)
        assert pair.track_gauge == pytest.approx(gauge, abs=1e-12)
    lying = rs.ContactPair("EN15302_wheel_A", "EN15302_rail_A", gauge=None)
    assert lying.track_gauge == pytest.approx(1.43516, abs=1e-5)          # EN 15302 prints 1435.16 mm
    # wider gauge, same wheelset: the flange comes to the rail later by half of it
    tight, wide = (rs.ContactPair("S1002", "UIC60", gauge=1.435 + extra).contact([6.3 * MM], with_roll=False) for extra in (0.0, 0.004))
    assert tight.right.rolling_radius[0] > wide.right.rolling_radius[0] + 0.5 * MM


def test_off_the_rail_is_an_error_that_names_wheel_and_shift():
    with pytest.raises(ContactError, match=r"left wheel: at a lateral shift of 150\.000 mm.*off the rail"):
        S1002.contact([0.0, 150 * MM], with_roll=False)
    with pytest.raises(ContactError, match=r"left wheel: at a lateral shift of -150\.000 mm"):
        S1002.contact([-150 * MM], with_roll=False)
    with pytest.raises(ContactError, match="finite numbers"):
        S1002.contact([np.nan])


@pytest.mark.parametrize("more, expected", [({"gauge": 1435}, "gauge is 1435 m"), ({"inclination": 40}, "a slope such as 1/40"),
                                            ({"wheel_radius": 0.0}, "wheel_radius"), ({"gauge": None}, "needs a gauge")])
def test_measures_that_cannot_be_are_refused(more, expected):
    with pytest.raises(ContactError, match=expected):
        rs.ContactPair("S1002", "UIC60", **more).contact([0.0])


def test_a_rail_as_it_lies_takes_no_inclination():
    with pytest.raises(ContactError, match="leave inclination out"):
        rs.ContactPair("S1002", "EN15302_rail_A", inclination=1 / 40).contact([0.0])


def test_derivatives_of_the_least_gap_are_those_of_differences():
    side: Side = S1002.sides[1]
    shift, height, roll = (np.array([v]) for v in (1.3 * MM, -0.4603, 0.4e-3))
    place, _ = side.closest(shift, height, roll)
    derivative = side.gap_derivatives(place, shift, height, roll)
    for value, step, move in ((derivative[0], 1e-7, (0.0, 1.0, 0.0)), (derivative[1], 1e-7, (0.0, 0.0, 1.0))):
        gaps = [side.closest(shift, height + sign * step * move[1], roll + sign * step * move[2])[1] for sign in (1.0, -1.0)]
        # central differences of a function of curvature below 10 /m, rounding 1e-16/1e-7
        assert value[0] == pytest.approx((gaps[0][0] - gaps[1][0]) / (2.0 * step), rel=1e-6)
