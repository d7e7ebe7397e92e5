# SPDX-License-Identifier: BSD-3-Clause
"""The tilting Pendolino in curves: balance by hand, mirror image, stops, failures, what an inertial unit feels."""

import sys

import numpy as np
import pytest
from oracles.tilting_body import Balance

import railsym as rs
from railsym.conical_contact import Cone
from railsym.errors import ConvergenceError, SimulationError, VehicleFileError
from railsym.prepared_vehicle import PreparedVehicle
from railsym.simulation import Controls, Simulation
from railsym.tilt_linkage import TiltLinkage
from railsym.track import Curve, Straight, Track, Transition

VEHICLE = rs.load_vehicle("pendolino_tilting")
LINKAGES = TiltLinkage(VEHICLE, "bolster1"), TiltLinkage(VEHICLE, "bolster2")
JACKS = tuple(jack for linkage in LINKAGES for jack in linkage.jacks)
CONES = rs.ConicalContact(zones=(Cone(0.1),))
WHEELSETS = tuple(f"wheelset{k}" for k in (1, 2, 3, 4))


def commands(angle):
    """Lengths of the jacks at a tilt angle (rad)."""
    return {jack: float(linkage.jack_length(jack, angle)) for linkage in LINKAGES for jack in linkage.jacks}


def curve(radius, cant, direction="right", transition=100.0):
    return Track([Straight(60.0), Transition(transition), Curve(radius, 900.0, cant, direction)])


def tilt(run):
    """Angle of the car body against the bolsters, rad."""
    return run["car.roll"] - 0.5 * (run["bolster1.roll"] + run["bolster2.roll"])


# --- a steady curve, by hand ---------------------------------------------------------------------------------------------------

RADIUS, CANT, SPEED = 3000.0, 0.06, 66.0  # wide, so that the wheelsets stay near the middle: 0.67 m/s2 of cant deficiency 160 mm
SLOPE = np.arcsin(CANT / 1.5)
OUTWARD = SPEED ** 2 / RADIUS * np.cos(SLOPE) - 9.81 * np.sin(SLOPE)
NAMES = ["*.roll", "*.y", "car.ay", "*.Q", "tilt_actuator.*.force", "tilt_actuator.*.length"]


@pytest.fixture(scope="module", params=[0.0, 6.0], ids=["passive", "6_degrees"])
def steady(request):
    """The equilibrium in the curve, and the balance by hand."""
    angle = np.radians(request.param)
    found = rs.quasi_static(VEHICLE, speed=SPEED, track=curve(RADIUS, CANT, transition=200.0), places=[0.0, 160.0, 500.0], contact=CONES,
                            commands=commands(angle), channels=NAMES)
    values = {name: found[name][-1] for name in found.channels}
    wheels = np.mean([values[f"{name}.roll"] for name in WHEELSETS])  # the cones lift one side by 0.03 degrees
    return values, wheels, Balance(VEHICLE, LINKAGES[0], OUTWARD, angle)


def test_rolls_of_the_steady_curve(steady):
    """Bogie, bolster and body against the axles within 2 % of the body's roll (passive: 0.64 degrees outward)."""
    values, wheels, balance = steady
    allowed = 0.02 * max(abs(balance.car), abs(balance.bolster))
    for names, expected in ((("bogie1", "bogie2"), balance.bogie), (("bolster1", "bolster2"), balance.bolster), (("car",), balance.car)):
        found = np.mean([values[f"{name}.roll"] for name in names]) - wheels
        assert found == pytest.approx(expected, abs=allowed)
    assert abs(balance.bolster) > 0.01


def test_acceleration_felt_in_the_steady_curve(steady):
    """V2/R cos(cant + roll) - g sin(cant + roll), with the body's roll by hand and the axles' from the run; tilting by 6 degrees takes 0.94 m/s2."""
    values, wheels, balance = steady
    lean = SLOPE + balance.car + wheels
    expected = SPEED ** 2 / RADIUS * np.cos(lean) - 9.81 * np.sin(lean)
    assert values["car.ay"] == pytest.approx(expected, abs=0.02 * OUTWARD)


def test_wheel_loads_of_the_steady_curve(steady):
    """Load moved to the outer wheels times their distance is the moment of everything about the track's middle; 2 % of it.

    Above the axles from the balance; wheelsets with axleboxes and halves of the trusses at their height; the sideways shift of all of it with the
    wheelsets; the spinning wheelsets' gyroscopic moment.
    """
    values, wheels, balance = steady
    moved = 0.75 * sum(values[f"{name}.left.Q"] - values[f"{name}.right.Q"] for name in WHEELSETS)
    shift = -np.mean([values[f"{name}.y"] for name in WHEELSETS])
    axles = OUTWARD * 0.46 * (2 * 1250 + 2 * 1550 + 8 * 90 + 124)
    gyroscopic = 4 * 90.0 * SPEED / 0.46 * SPEED / RADIUS
    expected = balance.overturning + axles + 51768 * 9.81 * shift + gyroscopic
    assert moved == pytest.approx(expected, rel=0.02)


def test_jack_forces_of_the_steady_curve(steady):
    """Virtual work: sum F dl/dtheta carries the body, which rises as it tilts and swings out."""
    values, _, balance = steady
    work = 0.0
    for linkage in LINKAGES:
        for jack in linkage.jacks:
            angle = linkage.angle(jack, values[f"{jack}.length"])
            work -= values[f"{jack}.force"] * (linkage.jack_length(jack, angle + 1e-4) - linkage.jack_length(jack, angle - 1e-4)) / 2e-4
    assert work == pytest.approx(balance.jack_moment, rel=0.02, abs=0.02 * 37400 * OUTWARD * 0.51)


def test_tilt_angle_is_that_of_the_links(steady):
    """Length of the jacks and angle of the body against the bolster: the four-bar linkage, within what links and brackets give (1 % of 6 degrees)."""
    values, _, _ = steady
    for number, linkage in enumerate(LINKAGES, 1):
        between = values["car.roll"] - values[f"bolster{number}.roll"]
        for jack in linkage.jacks:
            assert between == pytest.approx(linkage.angle(jack, values[f"{jack}.length"]), abs=1e-3)


def test_balance_can_fail():
    """Without the linkage's lift the jack moment at 6 degrees would be outside what the test allows."""
    balance = Balance(VEHICLE, LINKAGES[0], OUTWARD, np.radians(6.0))
    assert balance.jack_moment > 5.0 * 37400 * OUTWARD * 0.51


# --- mirror image ---------------------------------------------------------------------------------------------------------------

def test_mirrored_curve_and_command_mirror_the_motion():
    """Entry of a curve with the body tilted at 4 degrees/s: the same to rounding."""
    found = {}
    for side, sign in (("right", 1.0), ("left", -1.0)):
        lengths = {jack: [linkage.jack_length(jack, sign * np.radians(4.0 * 0.1 * k)) for k in range(21)] for linkage in LINKAGES for jack in linkage.jacks}

        def turn(controls, lengths=lengths):
            for jack, table in lengths.items():
                controls.command(jack, table[min(round(controls.time / 0.1), 20)])

        found[side] = rs.simulate(VEHICLE, speed=30.0, track=curve(600.0, 0.1, side), start=40.0, duration=3.0, contact=CONES, rate=20.0,
                                  controllers=[(turn, 10.0)], channels=["car.[yz]", "car.roll", "car.yaw", "bolster1.roll", "wheelset1.y", "tilt_actuator.*", "*.Q"])
    right, left = found["right"], found["left"]
    assert np.degrees(right["car.roll"]).max() > 5.0
    for name in ("car.y", "car.roll", "car.yaw", "bolster1.roll", "wheelset1.y"):
        np.testing.assert_allclose(left[name], -right[name], atol=1e-9)
    np.testing.assert_allclose(left["car.z"], right["car.z"], atol=1e-9)
    swap = {"left": "right", "right": "left"}
    for name in right.channels.match("tilt_actuator.front_left.*", "*.left.Q"):
        other = name.replace("left", swap["left"])
        scale = np.abs(right[name]).max()
        np.testing.assert_allclose(left[other], right[name], atol=1e-7 * scale)


# --- stops, limits, failures ----------------------------------------------------------------------------------------------------

COMPLIANCE = np.radians(0.35)  # docs/pendolino_tilting.md: all jacks at their limit and 2 m/s2


def test_stops_hold_the_body_at_eight_degrees():
    """Jacks that are told too much, in a curve at 2.04 m/s2 that pushes the same way: the stop's deflection by virtual work, and never beyond."""
    track, speed = curve(600.0, 0.0), 35.0
    start = rs.steady_state(VEHICLE, speed=speed, track=track, place=200.0)
    told = {jack: 0.4 if "left" in jack else -0.4 for jack in JACKS}
    run = rs.simulate(VEHICLE, speed=speed, track=track, start=200.0, duration=5.0, initial=start, rate=500.0,
                      controllers=[(lambda controls: [controls.command(jack, value) for jack, value in told.items()], 10.0)],
                      channels=["*.roll", "tilt_actuator.*", "tilt_end_stop.*.force"])
    angle = tilt(run)
    assert np.radians(8.0) < angle.max() < np.radians(8.0) + COMPLIANCE
    for jack in JACKS:
        assert np.abs(run[f"{jack}.force"]).max() <= 80e3 * (1.0 + 1e-12)  # the root of a sum of squares
        assert abs(run[f"{jack}.force"][-1]) == pytest.approx(80e3, rel=1e-6)
    end, h, linkage = angle[-1], 1e-4, LINKAGES[0]
    rates = sum(abs(linkage.jack_length(jack, end + h) - linkage.jack_length(jack, end - h)) for jack in linkage.jacks) / (2.0 * h)
    y, z = (linkage.shift(end + h) - linkage.shift(end - h)) / (2.0 * h)
    lean = 0.5 * (run["bolster1.roll"][-1] + run["bolster2.roll"][-1])
    push = 2.0 * 80e3 * rates + 37400.0 * (9.81 * z - (speed ** 2 / 600.0 - 9.81 * lean) * y)
    lever = abs(linkage.travel([0.0, -0.75], end + h)[0] - linkage.travel([0.0, -0.75], end - h)[0]) / (2.0 * h)
    stops = sum(abs(run[f"tilt_end_stop.{where}.force"][-1]) for where in ("front", "rear"))
    assert stops == pytest.approx(push / lever, rel=0.03)
    assert end - np.radians(8.0) == pytest.approx(push / lever / 4e7 / lever, rel=0.1)  # links and brackets give by 0.02 degrees


def test_jacks_turn_the_body_no_faster_than_their_rate():
    """What they follow: 0.12 m/s, 5.7 degrees/s; 0.06 s behind their command before that."""
    run = rs.simulate(VEHICLE, speed=20.0, duration=1.0, controllers=[(lambda controls: controls.command("tilt_actuator.front_left", 0.1), 10.0)],
                      rate=1000.0, channels=["tilt_actuator.front_left.s*"])
    rate, followed = run["tilt_actuator.front_left.s.rate"], run["tilt_actuator.front_left.s"]
    assert rate.max() == pytest.approx(0.12, rel=1e-6) and np.diff(followed).max() <= 0.12e-3 * (1.0 + 1e-6)
    late = run.time > 0.95
    np.testing.assert_allclose(rate[late], (0.1 - followed[late]) / 0.06, rtol=1e-3, atol=1e-9)
    assert rate[late].max() < 0.08


@pytest.fixture(scope="module")
def pair():
    return rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435)


@pytest.fixture(scope="module")
def tilted(pair):
    """The vehicle at 105 km/h in the curve of 500 m, tilted by 7.5 degrees."""
    track, speed = curve(500.0, 0.12), 105.0 / 3.6
    start = rs.steady_state(VEHICLE, speed=speed, track=track, place=200.0, contact=pair, commands=commands(np.radians(7.5)))
    options = {"track": track, "speed": speed, "start": 200.0, "contact": pair, "initial": start, "commands": commands(np.radians(7.5))}

    def run(kind, jacks=JACKS, duration=6.0):
        back = [(lambda controls: [controls.command(jack, 0.0) for jack in JACKS if controls.time > 0.5], 100.0)] if kind == "stuck" else []
        return rs.simulate(VEHICLE, duration=duration, faults=[(0.5, jack, kind) for jack in jacks], controllers=back,
                           channels=["*.roll", "car.ay", "tilt_actuator.*", "*.Y", "*.Q", "*.sum_Y"], **options)

    return run


def safe(run):
    """Y/Q below 0.8 (Nadal's limit of EN 14363 at 70 degrees and friction 0.36), no wheel unloaded below 40 % of its static 63.5 kN."""
    for name in run.channels.match("wheelset*.Y"):
        assert np.abs(run[name] / run[name.replace(".Y", ".Q")]).max() < 0.8
    return min(run[name].min() for name in run.channels.match("*.Q")) > 0.4 * 63.5e3


def test_jacks_that_stick_hold_the_body(tilted):
    """A command back to the middle does nothing; what failed is in the run's metadata, also in a file."""
    run = tilted("stuck", duration=3.0)
    np.testing.assert_allclose(tilt(run), tilt(run)[0], atol=1e-5)
    faults = run.info.extra["faults"]
    assert [fault["element"] for fault in faults] == list(JACKS) and {fault["fault"] for fault in faults} == {"stuck"}
    assert faults[0]["time"] == pytest.approx(0.5) and faults[0]["length"] == pytest.approx(run["tilt_actuator.front_left.length"][100], rel=1e-6)
    assert safe(run) and run.status == "completed"


def test_a_file_that_is_written_as_the_run_goes_tells_the_failures(tmp_path):
    rs.simulate(VEHICLE, speed=20.0, duration=0.2, save=tmp_path / "run.nc", channels=["car.roll"], faults=[(0.1, JACKS[1], "damped"), (0.05, JACKS[0], "free")])
    found = rs.Run.from_netcdf(tmp_path / "run.nc").info.extra["faults"]
    assert [(round(fault["time"], 6), fault["element"], fault["fault"]) for fault in found] == [(0.05, JACKS[0], "free"), (0.1, JACKS[1], "damped")]


@pytest.mark.parametrize("kind", ["free", "damped"])
def test_jacks_without_pressure_let_the_body_return(tilted, kind):
    """To where the links bring it: inward by the pendulum's angle m a h = m g rise; swinging for long where nothing damps it."""
    run = tilted(kind)
    angle = tilt(run)
    assert angle[0] > np.radians(7.0)
    bolster = 0.5 * (run["bolster1.roll"] + run["bolster2.roll"])[-1]
    slope = np.arcsin(0.12 / 1.5)
    a = (105 / 3.6) ** 2 / 500.0 * np.cos(slope) - 9.81 * np.sin(slope) - 9.81 * bolster
    h = 1e-3
    rises = -(LINKAGES[0].shift(h) + LINKAGES[0].shift(-h))[1] / h ** 2
    rest = a * 0.51 / (9.81 * rises)
    last = angle[run.time > 4.5]
    assert last.mean() == pytest.approx(rest, abs=np.radians(0.1 if kind == "damped" else 1.0))
    assert np.ptp(last) < np.radians(0.1) if kind == "damped" else np.ptp(last) > np.radians(1.0)
    assert safe(run) and run.status == "completed"
    for jack in JACKS:
        assert kind == "damped" or np.abs(run[f"{jack}.force"][run.time > 0.51]).max() == 0.0


def test_one_jack_that_fails_is_made_good_by_the_others(tilted):
    run = tilted("free", jacks=JACKS[:1], duration=3.0)
    assert np.abs(np.degrees(tilt(run) - tilt(run)[0])).max() < 0.5
    assert abs(run["tilt_actuator.front_right.force"][-1]) > 1.5 * abs(run["tilt_actuator.front_right.force"][0])
    assert safe(run)


# --- stability ------------------------------------------------------------------------------------------------------------------

def test_critical_speed_is_near_that_of_the_vehicle_without_tilt():
    """The mechanism gives a little: 3.2 % less in the nominal configuration, under 1.1 % in all others."""
    plain = rs.load_vehicle("pendolino")
    for name in plain.configurations:
        speeds = [rs.critical_speed(vehicle.configured(name), conicity=[0.2]).speed[0] for vehicle in (plain, VEHICLE)]
        assert speeds[1] / speeds[0] == pytest.approx(1.0, abs=0.035 if name in ("AS_K", "AS_mu06") else 0.012), name


def test_a_rigid_mechanism_leaves_the_critical_speed():
    stiff = {"swing_link.stiffness": 1e10, "tilt_guide.stiffness.0": 1e10, "tilt_guide.rotational_stiffness.2": 1e10, "tilt_actuator.stiffness": 1e10}
    speeds = [rs.critical_speed(vehicle, conicity=[0.2]).speed[0] for vehicle in (rs.load_vehicle("pendolino"), VEHICLE.replace(stiff))]
    assert speeds[1] == pytest.approx(speeds[0], rel=0.008)  # the bolsters' own inertia about x and z is at their places


@pytest.mark.parametrize("changes", [{"tilt_actuator.stiffness": 2e7, "swing_link.stiffness": 3e8}, {"tilt_actuator.lag": 0.1},
                                     {"tilt_actuator.lag": 0.0, "tilt_actuator.rate_limit": np.inf}], ids=["stiffnesses", "lag", "no lag"])
def test_cases_of_a_study_have_the_matrices_of_the_changed_vehicle(changes):
    """Also where the jacks' states go: they follow at once then."""
    contact = rs.LinearContact(conicity=0.2)
    found, wanted = PreparedVehicle(VEHICLE).linear_model(changes, contact), rs.linear_model(VEHICLE.replace(changes), contact)
    assert found.coordinates == wanted.coordinates and len(wanted.coordinates) == len(rs.linear_model(VEHICLE, contact).coordinates) - 4 * (0.0 in changes.values())
    for name in ("stiffness", "damping_constant"):
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), atol=1e-12 * np.abs(getattr(wanted, name)).max(), rtol=0)


def test_modes_tell_the_jacks_lag():
    """Each jack is followed in 60 ms whatever the vehicle does: an eigenvalue of -1/T a jack."""
    modes = rs.linearise(VEHICLE, 55.0, rs.LinearContact(conicity=0.2)).modes()
    lags = [mode for mode in modes if mode.label == "actuator lag, tilt_actuator"]
    assert len(lags) == 4
    np.testing.assert_allclose([mode.eigenvalue for mode in lags], -1.0 / 0.06, rtol=1e-6)


# --- what an inertial unit feels ------------------------------------------------------------------------------------------------

def test_inertial_unit_on_straight_track():
    """At rest on level track (0, 0, -g), and no turning."""
    controls = Controls(Simulation(VEHICLE, speed=20.0))
    for body in ("car", "bogie2", "wheelset3"):
        force, turning = controls.imu(body, VEHICLE.body(body).position + [0.3, 0.2, 0.1])
        np.testing.assert_allclose(force, [0.0, 0.0, -9.81], atol=1e-9)
        np.testing.assert_allclose(turning, 0.0, atol=1e-12)


def test_inertial_unit_in_a_steady_curve():
    """Lateral V2/R cos - g sin and vertical -(g cos + V2/R sin) of cant and roll; turning V/R about the track's normal."""
    track, speed, cant = curve(500.0, 0.12), 25.0, np.arcsin(0.12 / 1.5)
    start = rs.steady_state(VEHICLE, speed=speed, track=track, place=300.0, commands=commands(np.radians(5.0)))
    simulation = Simulation(VEHICLE, speed=speed, track=track, start=300.0, initial=start, commands=commands(np.radians(5.0)))
    controls = Controls(simulation)
    for body in ("car", "bogie1"):
        force, turning = controls.imu(body)
        lean, rush = cant + controls.position(f"{body}.roll"), speed ** 2 / 500.0
        assert force[1] == pytest.approx(rush * np.cos(lean) - 9.81 * np.sin(lean), rel=1e-3, abs=2e-3)
        assert force[2] == pytest.approx(-9.81 * np.cos(lean) - rush * np.sin(lean), rel=1e-3)
        np.testing.assert_allclose(turning, [0.0, speed / 500.0 * np.sin(lean), speed / 500.0 * np.cos(lean)], atol=5e-5)  # 0.03 degrees of pitch


def test_inertial_unit_in_a_transition():
    """Roll rate V d(cant angle)/ds of the track and the body's own; the channels of the same points read the same accelerations.

    The channels come from the same formula written apart in NumPy; the body tilts meanwhile, so that every term is there.
    """
    track, seen, told = curve(500.0, 0.12), [], commands(np.radians(6.0))
    units = {"frame": ("bogie1", [9.5, 0.3, -0.9]), "seat": ("car", [-6.0, 1.1, -1.9]), "axle": ("wheelset3", [-8.15, -0.4, -0.6])}

    def look(controls):
        for jack, length in told.items():
            controls.command(jack, length)
        seen.append((controls.time, *np.concatenate([part for unit in units.values() for part in controls.imu(*unit)]), controls.rate("bogie1.roll")))

    run = rs.simulate(VEHICLE, speed=[(0.0, 22.0), (3.0, 28.0)], track=track, start=40.0, duration=3.0, controllers=[(look, 100.0)], rate=100.0,
                      channels=["frame.*", "seat.*", "axle.*", "car.roll.rate", "V"], markers=units)
    time, *felt, own = np.array(seen).T
    felt = np.array(felt).reshape(3, 6, -1)
    assert np.abs(run["car.roll.rate"]).max() > 0.08
    for unit, values in zip(units, felt, strict=True):
        for axis, name in enumerate(("ax", "ay", "az")):
            np.testing.assert_allclose(values[axis] + (9.81 if name == "az" else 0.0), run[f"{unit}.{name}"][:len(time)], atol=1e-9)
    speed = run["V"][:len(time)]
    place = 40.0 + 9.5 + 22.0 * time + time ** 2
    cant = np.arcsin(np.clip((place - 60.0) / 100.0, 0.0, 1.0) * 0.12 / 1.5)
    inside = (place > 65.0) & (place < 124.0)
    rolls = speed * 0.12 / 1.5 / 100.0 / np.cos(cant)
    np.testing.assert_allclose(felt[0, 3][inside], (rolls + own)[inside], atol=1e-4)  # yaw against the track turns 1e-3 of V/R into it
    assert rolls[inside].min() > 0.015


# --- errors ---------------------------------------------------------------------------------------------------------------------

def test_errors_of_controllers():
    controls = Controls(Simulation(VEHICLE, speed=20.0))
    with pytest.raises(SimulationError, match=r"fault of 'tilt_actuator.front_left': 'frozen' is unknown.*stuck"):
        controls.fault("tilt_actuator.front_left", "frozen")
    with pytest.raises(SimulationError, match="fault of 'tilt_actuator.front_left' at -1.0 s: a time from 0 s on"):
        Simulation(VEHICLE, speed=20.0, faults=[(-1.0, "tilt_actuator.front_left", "free")])
    quick = VEHICLE.replace({"tilt_actuator.rate_limit": np.inf, "tilt_actuator.lag": 0.0})
    with pytest.raises(SimulationError, match="has nothing to be stuck at; give it a lag"):
        Simulation(quick, speed=20.0, faults=[(1.0, "tilt_actuator.front_left", "stuck")])
    with pytest.raises(SimulationError, match="length of 'jack': actuators of this vehicle are tilt_actuator.front_left"):
        controls.length("jack")
    with pytest.raises(SimulationError, match=r"imu on 'body': unknown.*bodies"):
        controls.imu("body")
    with pytest.raises(SimulationError, match="three finite numbers"):
        controls.imu("car", [0.0, np.nan, 1.0])


def test_commands_that_cannot_be_reached_say_so(monkeypatch):
    monkeypatch.setattr(sys.modules["railsym.simulation.quasi_static"], "_ITERATIONS", 0)
    with pytest.raises(ConvergenceError, match=r"beyond 0 % of the commands: {'tilt_actuator.front_left': .*force limit, stop"):
        rs.quasi_static(VEHICLE, speed=20.0, track=curve(600.0, 0.1), places=[0.0, 200.0], commands=commands(0.1))


def test_commands_beyond_the_stops_end_at_the_stops():
    far = {jack: 4.0 * value for jack, value in commands(np.radians(8.0)).items()}
    found = rs.quasi_static(VEHICLE, speed=20.0, track=curve(600.0, 0.1), places=[0.0], commands=far, channels=["*.roll"])
    assert np.radians(8.0) < tilt(found)[0] < np.radians(8.0) + COMPLIANCE


def test_a_rate_limit_needs_a_lag(tmp_path):
    from importlib.resources import files

    text = (files("railsym") / "data" / "vehicles" / "pendolino_tilting.toml").read_text()
    path = tmp_path / "hasty.toml"
    path.write_text(text.replace('lag = [0.06, "s"]\n', ""))
    with pytest.raises(VehicleFileError, match=r"tilt_actuator.rate_limit = 0.12: .* give tilt_actuator.lag above 0 s"):
        rs.load_vehicle(path)
    path.write_text(text.replace('stiffness = [1.0e7, "N/m"]', 'stiffness = [0, "N/m"]'))
    with pytest.raises(VehicleFileError, match="tilt_actuator.stiffness = 0.0: .* needs a stiffness above 0 N/m"):
        rs.load_vehicle(path)
    path.write_text(text.replace('force_limit = [80, "kN"]', 'force_limit = [0, "kN"]'))
    with pytest.raises(VehicleFileError, match="tilt_actuator.force_limit.*above 0, inf for no limit"):
        rs.load_vehicle(path)
