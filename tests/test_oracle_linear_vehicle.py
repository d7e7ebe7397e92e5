# SPDX-License-Identifier: BSD-3-Clause
"""The independent linear model must itself obey mechanics before anything is compared with it."""

import numpy as np
import pytest
from oracles import stand_ins
from oracles.deformations import elongation, rotation, translation
from oracles.finite_motion import finite_deformation, finite_marker
from oracles.linear_vehicle import independent_model, static_state
from oracles.small_rotations import marker_motion
from oracles.wheel_rail import ContactTerms

VEHICLES = {"coach": stand_ins.coach, "bogie_with_links": stand_ins.bogie_with_links}
ODD = {"y": -1, "yaw": -1, "roll": -1}


@pytest.fixture(params=sorted(VEHICLES))
def case(request):
    return VEHICLES[request.param]()


def translation_vector(model, direction):
    moved = np.array([name.endswith("." + direction) for name in model.names])
    return moved.astype(float)


@pytest.mark.parametrize("kind, expand", [("translation", translation), ("rotation", rotation),
                                          ("elongation", elongation)])
@pytest.mark.parametrize("counts", [(6, 6), (5, 6), (0, 6), (6, 5)])
def test_expansion_matches_finite_motion(kind, expand, counts):
    """Complex step of the finite motion gives the gradient, its central difference the Hessian."""
    rng = np.random.default_rng(3)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    places, centres = rng.normal(size=(2, 3)), rng.normal(size=(2, 3))
    n = sum(counts)

    def deformation(q):
        parts = np.split(q, [counts[0]])
        return finite_deformation(kind, *(finite_marker(*a) for a in zip(parts, places, centres)), axes)

    def gradient(q):
        return np.array([deformation(q + 1e-30j * e).imag / 1e-30 for e in np.eye(n)]).T

    motions = [marker_motion(range(m), *a) for m, a in zip(counts, zip(places, centres))]
    first, second = expand(*motions) if kind == "elongation" else expand(*motions, axes)
    step = 1e-4
    difference = np.array([(gradient(step * e) - gradient(-step * e)) / (2 * step) for e in np.eye(n)])
    assert np.allclose(first, gradient(np.zeros(n)), rtol=0, atol=1e-13)
    # Central difference: step^2/6 times the third derivative, of order 1.
    assert np.allclose(second, difference.transpose(1, 2, 0), rtol=0, atol=1e-7)


def test_whole_vehicle_moves_forward_and_turns_freely(case):
    """Nothing but the guide to the track resists a translation; the wheels do not feel x."""
    model = independent_model(case, stand_ins.usual_wheels(case), 40.0)
    guide = sum(e.parameters["stiffness"][0] for e in case.elements if "track" in (e.first.body, e.second.body))
    force = model.stiffness @ translation_vector(model, "x")
    body = np.array([name == "body.x" for name in model.names]) * guide
    # Round-off of stiffnesses up to 1e9 N/m.
    assert np.allclose(force, body, rtol=0, atol=1e-5)


def test_rigid_rotation_under_gravity_turns_only_the_weight():
    """A free vehicle yawed about the vertical needs no force, with preload and geometric stiffness in place."""
    coach = stand_ins.coach()
    model = independent_model(coach, None, 0.0)
    turn = np.zeros(len(model.names))
    for body in coach.bodies:
        turn[model.names.index(body.name + ".yaw")] = 1.0
        turn[model.names.index(body.name + ".y")] = body.position[0]
        turn[model.names.index(body.name + ".x")] = -body.position[1]
    assert np.abs(model.stiffness @ turn).max() < 1e-5
    assert np.abs(independent_model(coach, None, 0.0).stiffness).max() > 1e6


def test_rolling_the_vehicle_about_the_track_needs_the_moment_of_its_weight(case):
    """Force K q of a rigid roll = turning the forces with the vehicle: weight W h per radian, side force W."""
    model = independent_model(case, None, 0.0)
    roll = np.zeros(len(model.names))
    for body in case.bodies:
        roll[model.names.index(body.name + ".roll")] = 1.0
        roll[model.names.index(body.name + ".y")] = -body.position[2]
    force = model.stiffness @ roll
    for body in case.bodies:
        if body.kind == "wheelset" or any(body.name in (e.first.body, e.second.body) and "track" in
                                          (e.first.body, e.second.body) for e in case.elements):
            continue
        # The elements' forces hold the weight upwards; rolled by 1 rad they push m g sideways: -m g to balance.
        side = force[model.names.index(body.name + ".y")]
        assert side == pytest.approx(-body.mass * case.gravity, rel=1e-6)


def test_mass_and_elastic_matrices(case):
    """M symmetric positive; K symmetric without wheels (all forces have a potential); damping not negative."""
    model = independent_model(case, None, 0.0)
    second = ~model.first_order
    mass = model.mass[np.ix_(second, second)]
    assert np.allclose(mass, mass.T, rtol=1e-14, atol=0) and np.linalg.eigvalsh(mass).min() > 0
    assert np.allclose(model.stiffness, model.stiffness.T, rtol=0, atol=1e-6)
    assert np.linalg.eigvalsh(model.damping).min() > -1e-9 * np.abs(model.damping).max()


def test_kinetic_energy_of_a_moving_train(case):
    """Mass felt by a translation is the sum of all masses; turning adds the inertia about the vehicle's origin."""
    model = independent_model(case, None, 0.0)
    total = sum(body.mass + sum(box.mass for box in body.axleboxes) for body in case.bodies)
    for direction in "xyz":
        moved = translation_vector(model, direction)
        assert moved @ model.mass @ moved == pytest.approx(total, rel=1e-12)
    turn, inertia = np.zeros(len(model.names)), 0.0
    for body in case.bodies:
        for name, rate in (("yaw", 1.0), ("x", -body.position[1]), ("y", body.position[0])):
            turn[model.names.index(f"{body.name}.{name}")] = rate
        inertia += body.inertia[2, 2] + body.mass * (body.position[:2] ** 2).sum()
        for box in body.axleboxes:
            centre = body.position + box.centre_offset + [0.0, box.lateral_position, 0.0]
            inertia += box.inertia[2, 2] + box.mass * (centre[:2] ** 2).sum()
    assert turn @ model.mass @ turn == pytest.approx(inertia, rel=1e-12)


def test_gyroscopic_terms_do_no_work(case):
    slow, fast = (independent_model(case, None, v).damping for v in (0.0, 50.0))
    gyroscopic = fast - slow
    assert np.abs(gyroscopic).max() > 1e3
    assert np.array_equal(gyroscopic, -gyroscopic.T)


def test_gyroscope_precesses_the_right_way():
    """Rolling forward the spin vector points left; what turns it is the moment (rate) x (spin vector)."""
    vehicle, _ = stand_ins.single_wheelset()
    damping = independent_model(vehicle, None, 46.0).damping
    spin_vector = np.array([0.0, -46.0 / 0.46 * 0.1, 0.0])
    needed = np.cross([0.0, 0.0, 1.0], spin_vector)
    assert damping[4, 3] == pytest.approx(needed[0])
    needed = np.cross([1.0, 0.0, 0.0], spin_vector)
    assert damping[3, 4] == pytest.approx(needed[2])


def test_total_weight_rests_on_the_wheels(case):
    preload, loads = static_state(case)
    total = sum(body.mass + sum(box.mass for box in body.axleboxes) for body in case.bodies)
    assert loads.sum() == pytest.approx(total * case.gravity, rel=1e-9)
    assert np.allclose(loads[0::2], loads[1::2], rtol=1e-9)
    dampers = [e.name for e in case.elements if e.type in ("maxwell", "damper", "bump_stop")]
    assert dampers and all(np.array_equal(preload[name], [0.0]) for name in dampers)


def test_load_beside_the_middle_rests_on_its_wheel():
    """A body over the right rail: all its weight on that wheel (moment balance)."""
    axle = stand_ins.wheelset("wheelset1", 0.0, 100.0, (10.0, 1.0, 10.0))
    block = stand_ins.rigid_body("block", (0, 0.75, -1.0), 1000.0, (10.0, 10.0, 10.0))
    glue = stand_ins.element("glue.one", "bushing", "wheelset1", "block", (0, 0.1, -0.7),
                             stiffness=np.full(3, 1e6), rotational_stiffness=np.full(3, 1e6))
    _, loads = static_state(stand_ins.vehicle([axle, block], [glue]))
    assert loads == pytest.approx([50.0 * 9.81, 1050.0 * 9.81], rel=1e-9)


def test_klingel_wavelength():
    """A light wheelset, slow, without spin creepage: wavelength 2 pi sqrt(r0 b0 / conicity), whatever it rolls on."""
    vehicle, wheels = stand_ins.single_wheelset()
    speed = 1.0
    values = independent_model(vehicle, wheels, speed).eigenvalues()
    weaving = values[(np.abs(values.imag) > 0.1) & (np.abs(values.imag) < 10.0)]
    assert len(weaving) == 2
    wavelength = speed / (np.abs(weaving.imag[0]) / (2.0 * np.pi))
    # Inertia of 1 kg against creep of 1e7 N: relative change m lam V^2/(f r0 b0) of 1e-7.
    assert wavelength == pytest.approx(2.0 * np.pi * np.sqrt(0.46 * 0.75 / 0.2), rel=1e-5)


def mirror_matrix(vehicle, model):
    """Matrix that maps q to the mirrored motion of a vehicle that is its own mirror image."""
    def partner(name):
        swapped = name.replace("left", "*").replace("right", "left").replace("*", "right")
        return model.names.index(swapped)

    signs = {e.name + ".s": -1 if e.axis == 1 else 1 for e in vehicle.elements}
    matrix = np.zeros((len(model.names),) * 2)
    for column, name in enumerate(model.names):
        matrix[partner(name), column] = signs.get(name, ODD.get(name.split(".")[-1], 1))
    return matrix


@pytest.mark.parametrize("terms", [ContactTerms(), ContactTerms("wheelset", "exact", "track"),
                                   ContactTerms("potential", "none", "none")])
def test_mirror_symmetry(case, terms):
    model = independent_model(case, stand_ins.usual_wheels(case), 60.0, terms=terms)
    mirror = mirror_matrix(case, model)
    for matrix in (model.mass, model.damping, model.stiffness):
        assert np.allclose(mirror.T @ matrix @ mirror, matrix, rtol=0, atol=1e-9 * np.abs(matrix).max())


def test_stationary_rolling_needs_no_force(case):
    """Rolling a little faster: x' = v, spin' = -v/r0, is a rigid motion without creepage.

    With the tilted normal a torque f33 delta0^2/r0 a wheel is left, since spin creepage is divided by the constant V.
    """
    model = independent_model(case, stand_ins.usual_wheels(case), 30.0, terms=ContactTerms(tilt="none"))
    rates = translation_vector(model, "x")
    rates[model.cyclic] = -1.0 / 0.46
    moved = [i for i, name in enumerate(model.names) if name != "body.x"]
    assert np.abs((model.damping @ rates)[moved]).max() < 1e-6
    assert not model.stiffness[:, model.cyclic].any()


def test_edge_hessian_is_the_cone_on_an_edge():
    """Second derivative of the exact penetration of a rail edge into a cone, by complex-step gradient."""
    from oracles.wheel_rail import _edge_hessian

    b0, r0, slope = 0.75, 0.46, 0.1
    for side in (-1, 1):
        def penetration(q):
            _, y, z, yaw, roll, _ = q
            across, down = side * b0 / np.cos(yaw) - y, r0 - z
            lateral = across * np.cos(roll) + down * np.sin(roll)
            return r0 + slope * b0 - side * slope * lateral + across * np.sin(roll) - down * np.cos(roll)

        def gradient(q):
            return np.array([penetration(q + 1e-30j * e).imag / 1e-30 for e in np.eye(6)])

        numeric = np.array([(gradient(1e-5 * e) - gradient(-1e-5 * e)) / 2e-5 for e in np.eye(6)])
        assert np.allclose(numeric, _edge_hessian(side, b0, r0, slope), rtol=0, atol=1e-9)


def test_axlebox_hangs_from_the_axle_as_a_pendulum():
    """Frequency sqrt(m g c / (I + m c^2)) of a box whose centre is c below the axle."""
    mass, inertia, below = 90.0, 4.0, 0.1
    axle = stand_ins.wheelset("wheelset1", 0.0, 1000.0, (800.0, 90.0, 800.0),
                              axlebox=(mass, (1.0, inertia, 3.0), 1.0, (0.0, 0.0, below)))
    model = independent_model(stand_ins.vehicle([axle], []), None, 0.0)
    for label in ("left", "right"):
        place = model.names.index(f"wheelset1.axlebox_{label}.pitch")
        assert model.stiffness[place, place] == pytest.approx(mass * 9.81 * below)
        assert model.mass[place, place] == pytest.approx(inertia + mass * below**2)
    roll = model.names.index("wheelset1.roll")
    assert model.stiffness[roll, roll] == pytest.approx(2 * mass * 9.81 * below)


def test_maxwell_spring_carries_the_difference_of_elongations():
    """f = k (e - s): no force anywhere when the damper has taken the whole elongation."""
    coach = stand_ins.coach()
    model = independent_model(coach, None, 0.0, preload=False)
    springs = independent_model(stand_ins.vehicle(coach.bodies, [e for e in coach.elements if e.type != "maxwell"]),
                                None, 0.0, preload=False)
    motion = np.where(np.array(model.names) == "car.y", 1.0, 0.0)
    motion[model.first_order] = 1.0  # first marker on the bogie, second on the car: elongation +y
    force = model.stiffness @ motion
    assert np.allclose(force[~model.first_order], springs.stiffness @ motion[~model.first_order], rtol=0, atol=1e-6)
    assert np.allclose(force[model.first_order], 0.0, atol=1e-6)
