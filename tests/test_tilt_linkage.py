# SPDX-License-Identifier: BSD-3-Clause
"""The tilting mechanism's geometry: a four-bar linkage in closed form, and the body that swings on it."""

import numpy as np
import pytest

import railsym as rs
from railsym.errors import ModelError
from railsym.simulation import Simulation
from railsym.tilt_linkage import TiltLinkage

ANGLES = np.radians([-9.0, -4.0, -0.5, 0.0, 1e-3, 3.0, 8.0, 9.5])
BODY = 37400.0

# A body that hangs from the ground by the Pendolino's links, and one jack that holds it until it fails.
SWING = """
[vehicle]
name = "swing"
description = "a body on swing links"
gravity = [9.81, "m/s^2", "test"]
[origins]
test = "a test"
[contact]
origin = "test"
friction = [0.3, "-"]
kalker_weight = [1, "-"]
amplitude = [3, "mm"]
wheel_transverse_radius = [inf, "m"]
rail_transverse_radius = [300, "mm"]
young_modulus = [210, "GPa"]
poisson_ratio = [0.28, "-"]
[bodies.car]
kind = "rigid_body"
mass = [37400, "kg"]
inertia = [[64000, 1700000, 1700000], "kg*m^2"]
origin = "test"
at = { car = [[0, 0, -1.49], "m"] }
[elements.swing_link]
type = "traction_rod"
stiffness = [1e10, "N/m"]
origin = "test"
at = [
    { name = "a", first = "track", second = "car", first_position = [[9, -0.5, -1.2], "m"], second_position = [[9, -0.8125, -0.7], "m"] },
    { name = "b", first = "track", second = "car", first_position = [[9, 0.5, -1.2], "m"], second_position = [[9, 0.8125, -0.7], "m"] },
    { name = "c", first = "track", second = "car", first_position = [[-9, -0.5, -1.2], "m"], second_position = [[-9, -0.8125, -0.7], "m"] },
    { name = "d", first = "track", second = "car", first_position = [[-9, 0.5, -1.2], "m"], second_position = [[-9, 0.8125, -0.7], "m"] },
]
[elements.guide]
type = "bushing"
stiffness = [[1e8, 0, 0], "N/m"]
damping = [[1e7, 0, 0], "N*s/m"]
origin = "test"
at = [{ name = "a", first = "track", second = "car", position = [[0, 0, -1], "m"] }]
[elements.tilt_actuator]
type = "actuator"
mode = "length"
stiffness = [1e7, "N/m"]
damping = [1e5, "N*s/m"]
lag = [0.05, "s"]
bypass_damping = [3e4, "N*s/m"]
origin = "test"
at = [{ name = "a", first = "track", second = "car", first_position = [[0, 0.1, -0.8], "m"], second_position = [[0, 1.0, -0.8], "m"] }]
"""


@pytest.fixture(scope="module")
def linkage():
    return TiltLinkage(rs.load_vehicle("pendolino_tilting"))


@pytest.fixture(scope="module")
def swing(tmp_path_factory):
    path = tmp_path_factory.mktemp("swing") / "swing.toml"
    path.write_text(SWING)
    return rs.load_vehicle(path)


def turned(point, angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ point


def test_links_keep_their_length(linkage):
    """The numbers of the vehicle file: pivots 0.5 m out and 1.2 m high, 0.8125 m and 0.7 m; body 1.491 m high."""
    height = -rs.load_vehicle("pendolino_tilting").body("car").position[2]
    for angle in ANGLES:
        for side in (-1.0, 1.0):
            pivot = turned(np.array([side * 0.8125, height - 0.7]), angle) + linkage.shift(angle) - [0.0, height]
            assert np.hypot(*(pivot - [side * 0.5, -1.2])) == pytest.approx(np.hypot(0.3125, 0.5), rel=1e-13)


def test_the_body_turns_about_the_point_where_the_links_meet(linkage):
    """The velocity of that point of the body, by central differences, is zero."""
    assert linkage.roll_centre == pytest.approx(1.2 + 0.5 * 0.5 / 0.3125, rel=1e-13)
    for angle in ANGLES:
        centre, moving = linkage.centre(angle), linkage.shift(angle)
        rate = (linkage.shift(angle + 1e-6) - linkage.shift(angle - 1e-6)) / 2e-6
        arm = centre - moving
        np.testing.assert_allclose(rate + [-arm[1], arm[0]], 0.0, atol=1e-8)


def test_left_and_right_are_alike(linkage):
    np.testing.assert_allclose(linkage.shift(-ANGLES), linkage.shift(ANGLES) * [-1.0, 1.0], atol=1e-14)
    left, right = linkage.jacks
    np.testing.assert_allclose(linkage.jack_length(left, ANGLES), linkage.jack_length(right, -ANGLES), atol=1e-14)
    np.testing.assert_allclose(linkage.angle(left, linkage.jack_length(left, ANGLES)), ANGLES, atol=1e-7)


def test_the_stop_s_clearance_is_eight_degrees(linkage):
    vehicle = rs.load_vehicle("pendolino_tilting")
    stop = vehicle.element("tilt_end_stop.front")
    across = linkage.travel(stop.first.position[1:], np.radians([8.0, -8.0]))[:, 0]
    np.testing.assert_allclose(across, [-stop.parameters["clearance"], stop.parameters["clearance"]], atol=1e-6)


def test_errors_say_what_is_missing(linkage):
    with pytest.raises(ModelError, match="'pendolino' has no elements 'swing_link' that begin on 'bolster1'"):
        TiltLinkage(rs.load_vehicle("pendolino"))
    with pytest.raises(ModelError, match="beyond 10 degrees of tilt"):
        linkage.angle(linkage.jacks[0], 0.5)


def curvature(linkage):
    """How the centre rises with tilt: d2z/dtheta2 upward, and how it moves across: dy/dtheta."""
    h = 1e-3
    y, z = np.array([linkage.shift(a) for a in (-h, 0.0, h)]).T
    return -(z[2] - 2.0 * z[1] + z[0]) / h ** 2, (y[2] - y[0]) / (2.0 * h)


def swinging(vehicle, start, duration, kind="free"):
    """The body let go from a tilt angle: times, angles, rates."""
    linkage = TiltLinkage(vehicle, "track")
    across, down = linkage.shift(start)
    begin = {"car.y": across, "car.z": down, "car.roll": start}
    simulation = Simulation(vehicle, speed=1.0, contact=None, dt=1e-3, initial=begin, rho=1.0, rate=1000.0, faults=[(0.0, "tilt_actuator.a", kind)],
                            channels=["car.roll", "car.roll.rate", "car.[yz].rate", "car.z", "tilt_actuator.a.*"])
    simulation.run(duration)
    return linkage, simulation.result()


def test_frequency_of_the_free_body(swing):
    """omega^2 = m g (d2z/dtheta2) / (I + m (dy/dtheta)^2); the period from zero crossings at 0.3 degrees."""
    linkage, run = swinging(swing, np.radians(0.3), 6.0)
    rises, across = curvature(linkage)
    expected = np.sqrt(BODY * 9.81 * rises / (64000.0 + BODY * across ** 2)) / (2.0 * np.pi)
    (fault,) = run.info.extra["faults"]
    assert (fault["time"], fault["element"], fault["fault"]) == (0.0, "tilt_actuator.a", "free")
    assert fault["length"] == run["tilt_actuator.a.length"][0] and fault["force"] != 0.0
    roll = run["car.roll"][20:]
    down = np.flatnonzero((roll[:-1] > 0.0) & (roll[1:] <= 0.0))
    times = run.time[20:][down] + 1e-3 * roll[down] / (roll[down] - roll[down + 1])
    assert len(times) >= 3
    assert 1.0 / np.diff(times).mean() == pytest.approx(expected, rel=2e-3)  # links that give by 50 um, first step
    assert 0.5 < expected < 1.0


def test_energy_of_the_free_body(swing):
    """From 7.5 degrees: kinetic and potential energy on the linkage's path stay what they were; it swings through to the other side."""
    linkage, run = swinging(swing, np.radians(7.5), 2.0)
    roll, rate = run["car.roll"], run["car.roll.rate"]
    potential = -BODY * 9.81 * linkage.shift(roll)[:, 1]
    kinetic = 0.5 * (64000.0 * rate ** 2 + BODY * (run["car.y.rate"] ** 2 + run["car.z.rate"] ** 2))
    energy = kinetic + potential
    assert potential[0] > 1e4
    np.testing.assert_allclose(energy[20:], energy[0], rtol=5e-3)  # the links' own energy when the jack lets go
    assert roll.min() == pytest.approx(-np.radians(7.5), rel=5e-3)
    assert np.abs(run["tilt_actuator.a.force"][20:]).max() == 0.0
    measured = np.gradient(run["tilt_actuator.a.length"], run.time)[30:-1]
    np.testing.assert_allclose(measured, run["tilt_actuator.a.rate"][30:-1], atol=1e-3 * np.abs(measured).max())


THRUST = """mode = "force"
lag = [0.05, "s"]
rate_limit = [50, "kN/s"]
force_limit = [20, "kN"]
bypass_damping = [3e4, "N*s/m"]
origin = "test"
at = [{ name = "a", first = "track", second = "car", first_position = [[0, 0.1, -0.8], "m"], second_position = [[0, 1.0, -0.8], "m"] }]
[elements.helper]
type = "spring"
axis = "y"
stiffness = [1e5, "N/m"]
"""


def test_an_actuator_of_commanded_force(tmp_path):
    """Told to push with 30 kN it comes to 19.99 of its 20 kN, by 50 kN each second; stuck it keeps what it pushed with."""
    head, tail = SWING.split('mode = "length"')
    path = tmp_path / "thrust.toml"
    path.write_text(head + THRUST + tail.split("bypass_damping = [3e4, \"N*s/m\"]\n")[1])
    simulation = Simulation(rs.load_vehicle(path), speed=1.0, contact=None, rate=1000.0, channels=["tilt_actuator.a.*"], faults=[(1.5, "tilt_actuator.a", "stuck")])
    simulation.run(1.8, controllers=[(lambda controls: controls.command("tilt_actuator.a", 30e3 if controls.time < 1.5 else 0.0), 100.0)])
    run = simulation.result()
    assert [run.unit(f"tilt_actuator.a.{name}") for name in ("s", "s.rate", "force", "length")] == ["N", "N/s", "N", "m"]
    thrust, pushed = -run["tilt_actuator.a.force"], run["tilt_actuator.a.s"]
    assert thrust.max() <= 20e3 and thrust[-1] == pytest.approx(20e3 * (0.8 + 0.2 * np.tanh(3.5)), rel=1e-6)
    assert np.diff(pushed).max() == pytest.approx(50.0, rel=1e-6)
    low = (pushed < 16e3) & (run.time > 0.0)
    np.testing.assert_allclose(thrust[low], pushed[low], rtol=1e-6)
    np.testing.assert_allclose(pushed[run.time > 1.501], pushed[-1], rtol=1e-9)


def test_bypass_damping_takes_the_energy(swing):
    """A jack without pressure brings the body back to the middle, and takes what the fall gives: its work is the lost energy."""
    linkage, run = swinging(swing, np.radians(7.5), 12.0, "damped")
    assert abs(run["car.roll"][-1]) < np.radians(0.05)
    work = np.trapezoid(run["tilt_actuator.a.power"][20:], run.time[20:])
    roll, rate = run["car.roll"][20], run["car.roll.rate"][20]
    speed = run["car.y.rate"][20] ** 2 + run["car.z.rate"][20] ** 2
    energy = 0.5 * (64000.0 * rate ** 2 + BODY * speed) - BODY * 9.81 * linkage.shift(roll)[1]
    assert work == pytest.approx(-energy, rel=0.01)


def test_drawing_takes_links_and_centres_from_the_vehicle():
    import matplotlib

    matplotlib.use("Agg")
    from railsym.plots import plot_tilt_linkage, style

    vehicle = rs.load_vehicle("pendolino_tilting").replace({"swing_link.front_outer_left.first_position.2": -1.3, "swing_link.front_inner_left.first_position.2": -1.3,
                                                            "swing_link.front_outer_right.first_position.2": -1.3, "swing_link.front_inner_right.first_position.2": -1.3})
    upright, tilted = plot_tilt_linkage(vehicle, np.radians(6.0))
    for axes, angle in ((upright, 0.0), (tilted, np.radians(6.0))):
        links = [line for line in axes.lines if line.get_color() == style.VERMILION and line.get_linewidth() == 3.0]
        assert len(links) == 4 and all(line.get_ydata()[0] == pytest.approx(1.3) for line in links)
        centre = next(line for line in axes.lines if line.get_marker() == "X")
        place = TiltLinkage(vehicle).centre(angle) + [0.0, vehicle.body("car").position[2]]
        assert (centre.get_xdata()[0], -centre.get_ydata()[0]) == pytest.approx(tuple(place))
    matplotlib.pyplot.close("all")
