# SPDX-License-Identifier: BSD-3-Clause
"""The assembled Pendolino is the paper's: masses and inertia against the totals of its Table I, and the guidance of an axlebox."""

import numpy as np
import pytest

from railsym.vehicle import load_vehicle

# Table I: number of bodies, mass (kg), Ixx, Iyy, Izz (kg m^2).
TABLE_I = {
    "car": (1, 39000, (65000, 1870000, 1850000)),
    "bogie": (2, 3100, (2000, 2150, 4130)),
    "wheelset_outer": (2, 1250, (820, 90, 820)),
    "wheelset_inner": (2, 1550, (820, 90, 820)),
    "axlebox": (8, 90, (1, 4, 3)),
    "superior_truss": (8, 11, (0.5, 0.4, 0.4)),
    "inferior_truss": (8, 20, (0.1, 0.3, 0.3)),
}


def mass_points(vehicle):
    """(group, mass, centre of mass, inertia) of every rigid body, axleboxes included."""
    for body in vehicle.bodies:
        yield body.group, body.mass, body.position, body.inertia
        for box in body.axleboxes:
            yield "axlebox", box.mass, body.position + [0.0, box.lateral_position, 0.0] + box.centre_offset, box.inertia


def assembled(vehicle):
    """Mass, centre of mass and inertia about it of the whole vehicle (parallel-axis theorem)."""
    points = list(mass_points(vehicle))
    mass = sum(m for _, m, _, _ in points)
    centre = sum(m * r for _, m, r, _ in points) / mass
    inertia = np.zeros((3, 3))
    for _, m, r, own in points:
        d = r - centre
        inertia += own + m * (d @ d * np.eye(3) - np.outer(d, d))
    return mass, centre, inertia


@pytest.fixture(scope="module")
def pendolino():
    return load_vehicle("pendolino")


def test_every_row_of_table_i(pendolino):
    rows = {}
    for group, mass, _, inertia in mass_points(pendolino):
        rows.setdefault(group, []).append((mass, tuple(np.diag(inertia))))
    assert {group: (len(row), *row[0]) for group, row in rows.items()} == TABLE_I
    assert all(len(set(row)) == 1 for row in rows.values())


def test_totals_of_table_i(pendolino):
    mass, centre, inertia = assembled(pendolino)
    assert sum(number for number, _, _ in TABLE_I.values()) == 31
    assert mass == 51768  # printed 51,770: rounded to 10 kg
    assert abs(centre[0]) < 1e-12 and abs(centre[1]) < 1e-12
    # Printed 82,389. The heights that are not in the paper (car body, trusses) were chosen for it; 1 is its rounding.
    assert inertia[0, 0] == pytest.approx(82389, abs=1.0)
    # Printed 3,027,380 and 3,003,000 (with its lost digit): both 0.17 to 0.28 % below what pivot spacing and wheelbase give.
    assert inertia[1, 1] == pytest.approx(3027380, rel=0.0018)
    assert inertia[2, 2] == pytest.approx(3003000, rel=0.0028)
    # The same sums by hand, rounded to 50 kg m^2.
    assert inertia[1, 1] == pytest.approx(3032500, abs=50)
    assert inertia[2, 2] == pytest.approx(3011250, abs=50)
    # Mirror symmetry left-right and front-rear leaves no products (rounding of sums near 3e6).
    np.testing.assert_allclose(inertia - np.diag(np.diag(inertia)), 0.0, atol=1e-7)


def test_axle_load_is_that_of_the_class(pendolino):
    # 51,768 kg on four axles: 12.9 t; the class runs at 13.5 t with passengers.
    assert assembled(pendolino)[0] / 4 == 12942


@pytest.mark.parametrize(
    "name, mass",
    [
        ("cooperrider", 44388 + 2 * 2918.9 + 4 * 1022),
        ("manchester_vehicle1", 32000 + 2 * 2615 + 4 * 1813),
        ("bogie", 19500 + 3100 + 2 * 1250 + 4 * 90),
        ("wheelset", 1250),
    ],
)
def test_masses_of_the_other_vehicles(name, mass):
    assert assembled(load_vehicle(name))[0] == pytest.approx(mass, rel=1e-15)


def cross(r):
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def test_trusses_and_spring_guide_an_axlebox_as_derived(pendolino):
    # Static condensation of one axlebox (centre moved, free to pitch on its axle) with its two free trusses, frame held.
    box, free = "wheelset1.axlebox_right", ["superior_truss1_right", "inferior_truss1_right"]
    centres = {box: pendolino.body("wheelset1").position + [0.0, 1.0, 0.0]}
    centres |= {name: pendolino.body(name).position for name in free}
    column = {name: 6 * i for i, name in enumerate(centres)}
    stiffness = np.zeros((18, 18))
    for element in pendolino.elements:
        ends = [(e, s) for e, s in ((element.first, -1.0), (element.second, 1.0)) if e.body in column]
        if element.type != "bushing" or not ends:
            continue
        relative = np.zeros((6, 18))
        for end, sign in ends:
            i = column[end.body]
            relative[:, i : i + 6] = sign * np.eye(6)
            relative[:3, i + 3 : i + 6] = -sign * cross(end.position - centres[end.body])
        k = np.concatenate([element.parameters["stiffness"], element.parameters["rotational_stiffness"]])
        stiffness += relative.T @ (k[:, None] * relative)
    moved, loose = [0, 1, 2], [4, *range(6, 18)]
    coupling = stiffness[np.ix_(moved, loose)]
    guidance = stiffness[np.ix_(moved, moved)] - coupling @ np.linalg.solve(stiffness[np.ix_(loose, loose)], coupling.T)
    # By hand, as the file's origin text derives it: two bushings in series and two trusses in parallel with the coil spring; laterally
    # a truss of length 0.5 m turns as well. The spring's lever about the axle (longitudinally) and the trusses (vertically) make 3 %.
    numbers = {name: quantity.value for name, quantity in pendolino.parameters.items()}
    along, across, _ = numbers["truss_frame_bushing.stiffness"]
    turning = numbers["truss_frame_bushing.rotational_stiffness"][2]
    coil = numbers["primary_spring.stiffness"]
    lateral = 2.0 / (2.0 / across + 0.5**2 / (2.0 * turning))
    np.testing.assert_allclose(np.diag(guidance), coil + [along, lateral, 0.0], rtol=0.03)
    assert guidance[1, 1] == pytest.approx(coil[1] + lateral, rel=1e-3)
    np.testing.assert_allclose(guidance - np.diag(np.diag(guidance)), 0.0, atol=0.01 * 1.1e6)


def test_the_tilting_vehicle_is_the_paper_s_too():
    """Car body and bolsters together are Table I's car body: mass, centre of mass, inertia; so the whole is as before."""
    plain, tilting = assembled(load_vehicle("pendolino")), assembled(load_vehicle("pendolino_tilting"))
    assert tilting[0] == plain[0] == 51768
    np.testing.assert_allclose(tilting[1], plain[1], atol=1e-9)
    np.testing.assert_allclose(tilting[2], plain[2], rtol=1e-9, atol=1e-6)
