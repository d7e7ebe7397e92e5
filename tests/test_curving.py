# SPDX-License-Identifier: BSD-3-Clause
"""Curving studies: closed forms of simple vehicles, Newton's laws of whole ones, energy, mirror image, failures, runs."""

import json

import numpy as np
import pytest

import railsym as rs
from railsym.conical_contact import Cone
from railsym.errors import SimulationError, TrackError

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = rs.ConicalContact(zones=(Cone(0.1),))
GRAVITY = 9.81


@pytest.fixture(scope="module")
def table():
    return rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table(deepest=6e-4)


@pytest.fixture(scope="module")
def pendolino(table):
    return rs.curving(rs.load_vehicle("pendolino"), radius=[300.0, 1500.0, 600.0], cant=0.15, cant_deficiency=[0.0, 0.1], contact=table)


def mass_of(vehicle):
    return sum(b.mass + sum(box.mass for box in b.axleboxes) for b in vehicle.bodies)


@pytest.mark.parametrize("deficiency", [0.0, 0.1])
def test_a_free_wheelset_rolls_where_its_radii_differ_as_the_rails_do(deficiency):
    """Pure rolling: (r0 + l y)/(r0 - l y) = (R + e)/(R - e), so y = r0 e/(R l); a lateral force adds yaw, hardly a shift.

    l is the cone's slope g, more by the roll g y/e that the shift goes with: the wheel's lowest point moves by r0 g y/e, the contact on the
    round head by rho g y/e, so that l = g (1 + (r0 + rho) g/e); the next power of that, 0.3 %, is left out.
    """
    free = rs.load_vehicle("wheelset").replace({f"guide.stiffness.{k}": 1.0 for k in range(3)})
    radius, slope = np.array([1500.0, 2500.0]), 0.05
    conicity = slope * (1.0 + (0.46 + 0.3) * slope / 0.75)
    found = rs.curving(free, radius=radius, cant=0.1, cant_deficiency=[deficiency], contact=rs.ConicalContact(zones=(Cone(slope),)), law="kalker_linear")
    np.testing.assert_allclose(found.y[0, :, 0], -0.46 * 0.75 / (radius * conicity), rtol=0.005)
    if deficiency == 0.0:
        assert np.abs(found.angle_of_attack).max() < 2e-5


def test_wheelsets_of_a_stiff_bogie_stand_against_the_rails_by_its_wheelbase_over_the_radius(table):
    """Frames of the two wheelsets are turned by 2a/R against each other, the wheelsets are not: trailing less leading angle = 2a/R."""
    stiff = BOGIE.replace({f"primary.stiffness.{k}": 1e9 for k in range(2)})
    radius = np.array([500.0, 1000.0])
    found = rs.curving(stiff, radius=radius, cant=0.1, speed=[20.0], contact=table)
    np.testing.assert_allclose(found.angle_of_attack[0, :, 1] - found.angle_of_attack[0, :, 0], 2.7 / radius, rtol=0.02)


def test_wheel_loads_balance_the_moments_of_the_bodies_about_the_track():
    """Moments about the centre of the track, bodies where they are: sum m (a h + g y) = 0.75 m (Q outer - Q inner) + what the contacts' shift adds."""
    speed, radius, cant = 28.0, 1000.0, 0.06
    names = ["*.y", "*.Q", "*.Y", "*.roll", "*.across"]
    track = rs.Track([rs.track.Straight(10.0), rs.track.Transition(60.0), rs.track.Curve(radius, 100.0, cant)])
    run = rs.quasi_static(BOGIE, speed=speed, track=track, places=[5.0, 40.0, 120.0], contact=CONES, channels=names)
    sine = cant / 1.5
    cosine = np.sqrt(1.0 - sine ** 2)
    lateral, vertical = speed ** 2 / radius * cosine - GRAVITY * sine, GRAVITY * cosine + speed ** 2 / radius * sine
    moment = 0.0                                             # outwards: the curve is to the right, the bodies move to the left
    for body in BOGIE.bodies:
        arc = (1.35 ** 2 - body.position[0] ** 2) / (2.0 * radius)      # the rails under the wheelsets lie that far to the right of the bogie's
        if body.kind == "wheelset":                          # the spin's momentum turns with the track
            moment += body.inertia[1, 1] * speed ** 2 / (body.wheel_radius * radius)
        for part in (body, *body.axleboxes):
            moment += part.mass * (lateral * -body.position[2] + vertical * (arc - run[f"{body.name}.y"][-1]))
    outer, inner = (sum(run[f"wheelset{k}.{side}.Q"][-1] for k in (1, 2)) for side in ("left", "right"))
    assert moment > 1e4
    assert 0.75 * (outer - inner) == pytest.approx(moment, rel=0.005)      # the contacts move by 0.15 mm on the round heads
    found = rs.curving(BOGIE, radius=radius, cant=cant, speed=speed, contact=CONES)
    assert found.Q[0, 0, found.outer].sum() == pytest.approx(outer, rel=2e-4)      # the other way along the track: place of the hold


def test_sum_of_Y_is_mass_times_lateral_acceleration(pendolino):
    """Of the whole vehicle; the bodies' frames lie on the arc, which leaves (8.5 m/R)^2/2."""
    total = pendolino.sum_Y.sum(axis=2)
    np.testing.assert_allclose(total[1], -mass_of(rs.load_vehicle("pendolino")) * pendolino.lateral_acceleration[1], rtol=1.5e-3)
    assert np.abs(total[0]).max() < 60.0
    np.testing.assert_allclose(pendolino.lateral_acceleration[1], 0.1 / 1.5 * GRAVITY)
    np.testing.assert_allclose(pendolino.sum_Y, pendolino.Y[:, :, 1::2] - pendolino.Y[:, :, 0::2], atol=1e-6)
    np.testing.assert_allclose(pendolino.YQ, pendolino.Y / pendolino.Q)


def test_order_is_that_of_the_train_and_of_the_radii_as_given(pendolino):
    assert pendolino.wheelsets == ("wheelset1", "wheelset2", "wheelset3", "wheelset4") and pendolino.wheels[:2] == ("wheelset1.left", "wheelset1.right")
    assert pendolino.Y.shape == (2, 3, 8) and pendolino.patch_t_gamma.shape == (2, 3, 8, 3)
    attack = pendolino.angle_of_attack[1, :, 0]
    assert attack[0] < attack[2] < attack[1] < 0.0           # the tighter the curve, the more the leading wheelset points outwards
    assert (pendolino.t_gamma[1, 0] > pendolino.t_gamma[1, 1]).all()
    alone = rs.curving(rs.load_vehicle("pendolino"), radius=300.0, cant=0.15, cant_deficiency=0.1,
                       contact=rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table(deepest=6e-4))
    np.testing.assert_allclose(alone.Y[0, 0], pendolino.Y[1, 0], atol=0.5)            # whichever way it was reached; N
    np.testing.assert_array_equal(pendolino.of("t_gamma", "wheelset1.left"), pendolino.t_gamma[:, :, 0])


def test_wear_number_by_patches_and_wheels(pendolino, table):
    """C's sum of a wheel against NumPy's of the patches, from creepages and forces of the same equilibrium."""
    np.testing.assert_allclose(pendolino.patch_t_gamma.sum(axis=3), pendolino.t_gamma, rtol=1e-9)
    vehicle, curve = rs.load_vehicle("pendolino"), rs.Track([rs.track.Straight(30.0), rs.track.Transition(60.0), rs.track.Curve(300.0, 60.0, 0.15)])
    names = [f"wheelset1.left.zone{zone}.{name}" for zone in range(3) for name in ("Fx", "Fy", "Mz", "xi", "eta", "phi")]
    run = rs.quasi_static(vehicle, speed=22.2, track=curve, places=[10.0, 120.0], contact=table, channels=[*names, "wheelset1.left.*"])
    value = {name: run[name][-1] for name in run.channels}
    wear = sum(abs(value[f"wheelset1.left.zone{k}.F{a}"] * value[f"wheelset1.left.zone{k}.{c}"]) for k in range(3) for a, c in (("x", "xi"), ("y", "eta")))
    spin = sum(value[f"wheelset1.left.zone{k}.{f}"] * value[f"wheelset1.left.zone{k}.{c}"] for k in range(3)
               for f, c in (("Fx", "xi"), ("Fy", "eta"), ("Mz", "phi")))
    assert value["wheelset1.left.patches"] >= 2 and wear > 50.0
    assert value["wheelset1.left.t_gamma"] == pytest.approx(wear, rel=1e-12)
    assert value["wheelset1.left.dissipation"] == pytest.approx(-spin, rel=1e-12)
    assert value["wheelset1.left.YQ"] == value["wheelset1.left.Y"] / value["wheelset1.left.Q"]


def test_the_drive_does_the_work_that_the_contacts_take(table):
    """Energy in a steady curve: force along the track times speed = dissipation of all contacts times speed; no cant, so no share of gravity."""
    vehicle, curve = rs.load_vehicle("manchester_vehicle1"), rs.Track([rs.track.Straight(30.0), rs.track.Transition(60.0), rs.track.Curve(400.0, 60.0)])
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435, wheel_radius=vehicle.body("wheelset1").wheel_radius)
    simulation = rs.Simulation(vehicle, speed=20.0, track=curve, contact=pair, channels="s")
    (coordinate,), (stiffness,), _ = simulation.parts.holds
    held = simulation.parts.names[coordinate]
    run = rs.quasi_static(vehicle, speed=20.0, track=curve, places=[15.0, 120.0], contact=pair, channels=[held, "*.dissipation", "*.t_gamma"])
    drive = -stiffness * run[held][-1]
    taken = sum(run[name][-1] for name in run.channels.match("*.dissipation"))
    assert taken > 300.0
    # the table's normal forces have a moment about the axle of up to 2e-5 N r (docs/wheel_rail_forces.md)
    assert drive == pytest.approx(taken, abs=2e-5 * GRAVITY * mass_of(vehicle))
    wear = sum(run[name][-1] for name in run.channels.match("*right.t_gamma", "*left.t_gamma"))
    assert wear == pytest.approx(taken, rel=0.1)             # without the work of spin


def test_the_drive_does_the_work_that_closed_form_contacts_take():
    """The same with cones, whose normal forces do no work; the guide of the car turns with the track, so that its moment works too."""
    curve = rs.Track([rs.track.Straight(10.0), rs.track.Transition(60.0), rs.track.Curve(900.0, 60.0)])
    simulation = rs.Simulation(BOGIE, speed=15.0, track=curve, contact=CONES, channels="s")
    (coordinate,), (stiffness,), _ = simulation.parts.holds
    held = simulation.parts.names[coordinate]
    run = rs.quasi_static(BOGIE, speed=15.0, track=curve, places=[3.0, 100.0], contact=CONES, channels=[held, "hold.car.fx", "car.yaw", "*.dissipation"])
    taken = sum(run[name][-1] for name in run.channels.match("*.dissipation"))
    assert taken > 10.0
    drive = run["hold.car.fx"][-1] - stiffness * run[held][-1] - 1e8 * run["car.yaw"][-1] / 900.0
    assert drive == pytest.approx(taken, rel=1e-3)


def test_mirror_image(table, pendolino):
    left = rs.curving(rs.load_vehicle("pendolino"), radius=[300.0, 1500.0, 600.0], cant=0.15, cant_deficiency=[0.0, 0.1], contact=table, direction="left")
    swapped = np.array([1, 0, 3, 2, 5, 4, 7, 6])
    np.testing.assert_allclose(left.Y[:, :, swapped], pendolino.Y, atol=0.5)            # N: what the iteration leaves
    np.testing.assert_allclose(left.t_gamma[:, :, swapped], pendolino.t_gamma, atol=0.02)
    np.testing.assert_allclose(left.angle_of_attack, -pendolino.angle_of_attack, atol=1e-7)
    assert (left.outer == pendolino.outer + 1).all()


def test_a_run_that_starts_there_stays_there(table, pendolino):
    """Two contacts at the leading wheel: the equilibrium that the iteration found is the one that motion keeps."""
    vehicle, speed = rs.load_vehicle("pendolino"), float(pendolino.speed[1, 0])
    curve = rs.Track([rs.track.Straight(30.0), rs.track.Transition(60.0), rs.track.Curve(300.0, 200.0, 0.15)])
    state = rs.steady_state(vehicle, speed=speed, track=curve, place=130.0, contact=table)
    run = rs.simulate(vehicle, speed=speed, track=curve, start=130.0, duration=3.0, contact=table, initial=state, channels=["*.left.Y", "*.angle_of_attack"])
    for k, name in enumerate(pendolino.wheelsets):
        assert run[f"{name}.left.Y"][-1] == pytest.approx(pendolino.Y[1, 0, 2 * k], abs=40.0)      # N; the hold still settles
        assert run[f"{name}.angle_of_attack"][-1] == pytest.approx(pendolino.angle_of_attack[1, 0, k], abs=1e-5)


@pytest.mark.parametrize("name", [name for name in rs.vehicles() if name != "pendolino"])      # which the others are about
def test_every_shipped_vehicle_runs_through_curves(name):
    vehicle = rs.load_vehicle(name)
    wheelset = next(b for b in vehicle.bodies if b.kind == "wheelset")
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435, wheel_radius=wheelset.wheel_radius)
    radius = [300.0, 500.0, 1000.0, 3000.0] if name != "wheelset" else [1000.0, 3000.0]
    found = rs.curving(vehicle, radius=radius, cant=0.1, cant_deficiency=0.05, contact=pair)
    assert not found.failures and np.isfinite(found.Q).all()
    if name != "wheelset":                                   # which is guided by springs from the track
        np.testing.assert_allclose(found.sum_Y.sum(axis=2), -mass_of(vehicle) * found.lateral_acceleration, rtol=5e-3)


def test_a_curve_without_equilibrium_is_told_and_the_rest_is_kept():
    found = rs.curving(BOGIE, radius=[1500.0, 12.0, 900.0], cant=0.0, speed=10.0, contact=CONES)
    assert [(f.radius, f.analysis) for f in found.failures] == [(12.0, "quasi-static")]
    assert "wheelset" in found.failures[0].reason
    assert np.isnan(found.Y[0, 1]).all() and np.isfinite(found.Y[0, [0, 2]]).all()
    assert "1 of 3 without result" in found.message and "R = 12 m at 36 km/h" in found.message
    data = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert data["quasi_static"]["Y"][0][1] == [None] * 4 and data["failures"][0]["radius"] == 12.0


def test_a_run_that_derails_is_told_too():
    found = rs.curving(BOGIE, radius=[1500.0, 100.0], cant=0.0, speed=12.0, contact=CONES, dynamic=True, length=40.0)
    assert [(f.radius, f.analysis) for f in found.failures] == [(100.0, "quasi-static"), (100.0, "dynamic")]
    assert "derailed (wheelset" in found.failures[1].reason and np.isfinite(found.largest["YQ"][0, 0]).all()
    assert np.isnan(found.largest["YQ"][0, 1]).all() and "2 of 4 without result" in found.message


def test_limits_are_those_of_the_criteria_and_recalled_ones_give_no_verdict(pendolino):
    by_name = {item.name: (item, where) for item, where in pendolino.assessed()}
    ratio, where = by_name["Y/Q quasi-static"]
    assert ratio.value == pytest.approx(np.abs(pendolino.YQ).max()) and ratio.verdict.startswith("within the limit 0.8")
    assert where.startswith("wheelset1.left, R = 300 m")
    for name, (item, _) in by_name.items():
        if item.limit.trust == "R":
            assert "no verdict" in item.verdict, name
    assert by_name["Y quasi-static"][0].limit.value == pytest.approx(30e3 + 10.5e6 / 300.0)


def test_runs_with_irregularities_reach_more_than_the_equilibrium():
    found = rs.curving(BOGIE, radius=[900.0, 1500.0], cant=0.1, cant_deficiency=0.1, contact=CONES, dynamic=True, length=100.0, seed=2)
    assert not found.failures
    assert (np.abs(found.largest["YQ"][0, :, found.outer[0]]) > np.abs(found.YQ[0, :, found.outer[0]])).all()
    np.testing.assert_allclose(found.largest["Y"], found.Y, atol=2500.0)               # N, medians on an irregular 100 m
    assert found.largest["sum_Y"].shape == (1, 2, 2) and "Y/Q 99.85 %" in found.table()
    assert {"Y/Q, 2 m mean, 99.85 %", "sum Y, 2 m mean, 99.85 %"} <= {item.name for item, _ in found.assessed()}


def test_drawings(pendolino, tmp_path):
    drawn = pendolino.plot()
    assert drawn.shape == (3, 2) and len(drawn[0, 0].get_lines()) >= 8
    np.testing.assert_allclose(drawn[0, 0].get_lines()[0].get_xdata(), [300.0, 600.0, 1500.0])
    pendolino.plot(path=tmp_path / "c.png")
    assert (tmp_path / "c.png").stat().st_size > 10_000


@pytest.mark.parametrize("changes, message", [
    ({"radius": -300.0}, "For a curve to the left"), ({"radius": [300.0, 300.0]}, "each radius once"), ({"cant": 150.0}, "are the units right"),
    ({"cant": [0.1, 0.1, 0.1]}, "one for each of the 2 radii"), ({"speed": 20.0}, "either speed"), ({"cant_deficiency": None}, "either speed"),
    ({"cant_deficiency": -0.2}, "standing still"), ({"cant_deficiency": 100.0}, "are the units right"), ({"contact": rs.LinearContact()}, "needs wheel-rail forces"),
    ({"dynamic": True, "irregularity": "erri_b176_lo"}, "nearest: 'erri_b176_low'"), ({"dynamic": True, "length": 5.0}, "20 to 2000 m"),
    ({"direction": "up"}, '"right" or "left"'), ({"seed": 1}, "belong to dynamic"), ({"radius": "wide"}, "numbers in m"),
])
def test_bad_input(changes, message):
    with pytest.raises((SimulationError, TrackError), match=message):
        rs.curving(BOGIE, **({"radius": [300.0, 500.0], "cant": 0.1, "cant_deficiency": 0.05, "contact": CONES} | changes))


def test_unknown_quantity_and_wheel(pendolino):
    with pytest.raises(SimulationError, match="nearest.*t_gamma|t_gamma"):
        pendolino.of("tgamma", "wheelset1.left")
    with pytest.raises(SimulationError, match="wheelset1.left"):
        pendolino.of("Y", "wheelset1.lef")


def test_speed_and_cant_deficiency_are_each_other():
    """V^2/R cos(c) - g sin(c) = g I/1.5 both ways; 80 mm at 1000 m without cant is 22.87 m/s, by hand."""
    from railsym.curving.cases import cases

    asked = cases([300.0, 1000.0], [0.15, 0.02], None, [-0.01, 0.1], GRAVITY)
    again = cases([300.0], [0.15], asked.speed[:, 0], None, GRAVITY)
    np.testing.assert_allclose(again.cant_deficiency[:, 0], [-0.01, 0.1], rtol=1e-12)
    assert cases(1000.0, 0.0, None, 0.08, GRAVITY).speed[0, 0] == pytest.approx(np.sqrt(1000.0 * GRAVITY * 0.08 / 1.5), rel=1e-12)
    with pytest.raises(SimulationError, match="more than 612 km/h"):
        cases(50e3, 0.15, None, 0.15, GRAVITY)


def test_static_loads_are_in_the_order_of_the_wheels(pendolino):
    simulation = rs.Simulation(rs.load_vehicle("pendolino"), speed=10.0, contact=CONES, channels="s")
    loads = simulation.info.extra["wheel_loads"]
    np.testing.assert_allclose(pendolino.static_load, [loads[wheel] for wheel in pendolino.wheels], rtol=1e-9)


def test_angle_of_attack_is_against_the_rails_under_the_wheelset():
    """Rails that bend over 80 m, slowly run over: wheelsets yaw with them, and stand against them by little."""
    s = np.arange(0.0, 301.0, 0.5)
    slope = 5e-3 * 2 * np.pi / 80.0
    wavy = rs.Track.straight(300.0).with_irregularity(rs.track.MeasuredIrregularity(s, alignment=5e-3 * np.sin(2 * np.pi * s / 80.0)))
    found = rs.simulate(BOGIE, speed=10.0, track=wavy, duration=28.0, contact=CONES, channels=["s", "wheelset2.yaw", "wheelset2.angle_of_attack"])
    inside = found["s"] > 100.0
    assert np.abs(found["wheelset2.yaw"][inside]).max() == pytest.approx(slope, rel=0.3)
    assert np.abs(found["wheelset2.angle_of_attack"][inside]).max() < 0.4 * slope
    rails = wavy.rails(found["s"] - 1.35)
    np.testing.assert_allclose(found["wheelset2.angle_of_attack"], found["wheelset2.yaw"] - np.arctan(rails.left_y_slope), atol=1e-12)
