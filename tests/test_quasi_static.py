# SPDX-License-Identifier: BSD-3-Clause
"""Equilibria in curves: forces on the track by Newton's law, mirror image, and the end of a long run."""

import numpy as np
import pytest

import railsym as rs
from railsym.conical_contact import Cone
from railsym.errors import ConvergenceError
from railsym.track import Curve, Straight, Track, Transition

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = rs.ConicalContact(zones=(Cone(0.1),))
RADIUS, CANT, SPEED = 1000.0, 0.06, 20.0


def track(direction="right"):
    return Track([Straight(10.0), Transition(40.0), Curve(RADIUS, 260.0, CANT, direction)])


@pytest.mark.parametrize("contact", ["linear", CONES])
def test_a_long_run_ends_in_the_equilibrium(contact):
    found = rs.quasi_static(BOGIE, speed=SPEED, track=track(), places=[0.0, 30.0, 200.0], contact=contact, channels=["*.y", "*.yaw", "*.roll"])
    run = rs.simulate(BOGIE, speed=SPEED, track=track(), duration=13.0, start=0.0, contact=contact, channels=["*.y", "*.yaw", "*.roll"], rate=10.0)
    assert abs(found["frame.y"][-1]) > 1e-4
    for name in found.channels:
        assert run[name][-1] == pytest.approx(found[name][-1], abs=5e-6), name  # what is left of the entry


def test_a_run_that_starts_from_the_equilibrium_stays_there():
    state = rs.steady_state(BOGIE, speed=SPEED, track=track(), place=120.0, contact=CONES)
    names = ["wheelset1.y", "wheelset1.yaw", "frame.y", "frame.roll"]
    run = rs.simulate(BOGIE, speed=SPEED, track=track(), start=120.0, duration=3.0, contact=CONES, initial=state, channels=names)
    found = rs.quasi_static(BOGIE, speed=SPEED, track=track(), places=[0.0, 30.0, 120.0], contact=CONES, channels=names)
    assert abs(found["wheelset1.y"][-1]) > 1e-4
    for name in names:      # the soft hold along the track finds its place: micrometres
        np.testing.assert_allclose(run[name], found[name][-1], atol=2e-6)


def test_forces_on_the_track_are_mass_times_acceleration():
    """Across the track: sum of Y = -m (V^2/R cos(c) - g sin(c)); square to it: sum of Q = m (g cos(c) + V^2/R sin(c))."""
    found = rs.quasi_static(BOGIE, speed=SPEED, track=track(), places=[0.0, 30.0, 200.0], contact=CONES, channels=["*.sum_Y", "*.Q"])
    mass = sum(b.mass + sum(box.mass for box in b.axleboxes) for b in BOGIE.bodies)
    sine, rush = CANT / 1.5, SPEED ** 2 / RADIUS
    across = rush * np.sqrt(1.0 - sine ** 2) - BOGIE.gravity * sine
    down = BOGIE.gravity * np.sqrt(1.0 - sine ** 2) + rush * sine
    lateral = sum(found[name][-1] for name in found.channels.match("*.sum_Y"))
    vertical = sum(found[name][-1] for name in found.channels.match("*.Q"))
    held = 0.02 * mass * abs(across)  # bodies on the curve's chord: their frames' axes differ by 1.25 m/1000 m
    assert lateral == pytest.approx(-mass * across, abs=held)
    assert vertical == pytest.approx(mass * down, rel=1e-3)


def test_mirror_image():
    right, left = (rs.quasi_static(BOGIE, speed=SPEED, track=track(side), places=[0.0, 30.0, 200.0], contact=CONES,
                                   channels=["wheelset1.y", "wheelset1.left.Q", "wheelset1.right.Q"]) for side in ("right", "left"))
    np.testing.assert_allclose(left["wheelset1.y"], -right["wheelset1.y"], atol=1e-9)
    np.testing.assert_allclose(left["wheelset1.left.Q"], right["wheelset1.right.Q"], rtol=1e-6)


def test_unstable_vehicle_has_an_equilibrium_too():
    """Far above the critical speed the same iteration finds what no run would show."""
    vehicle = rs.load_vehicle("bogie").configured("without_anti_yaw_dampers")
    speed = 1.3 * float(rs.critical_speed(vehicle, conicity=0.2).speed)
    wide = Track([Straight(10.0), Transition(200.0), Curve(20e3, 300.0)])
    found = rs.quasi_static(vehicle, speed=speed, track=wide, places=[0.0, 100.0, 300.0], contact=rs.LinearContact(conicity=0.2))
    assert found.status == "completed" and 1e-6 < abs(found["wheelset1.y"][-1]) < 5e-3


def test_a_curve_too_tight_says_where():
    tight = Track([Straight(10.0), Transition(20.0), Curve(15.0, 30.0)])
    with pytest.raises(ConvergenceError, match="no equilibrium was found beyond s ="):
        rs.quasi_static(BOGIE, speed=10.0, track=tight, places=[0.0, 10.0, 20.0, 40.0], contact=CONES)
