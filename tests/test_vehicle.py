# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle object: shipped vehicles, configurations, replace, parameters, immutability."""

import dataclasses
import math
import pickle
import re
import tomllib

import numpy as np
import pytest

from railsym.errors import VehicleFileError
from railsym.vehicle import SHIPPED, Quantity, load_vehicle, vehicles
from railsym.vehicle_layout import rotation

NAMES = ("bogie", "cooperrider", "manchester_vehicle1", "pendolino", "pendolino_tilting", "wheelset")
TABLE_II = {  # primary anti-yaw dampers, secondary ones, Maxwell models, friction
    "AS_K": (8, 4, True, 0.3),
    "noASS_K": (8, 0, True, 0.3),
    "noAS_K": (0, 0, True, 0.3),
    "AS_Mal_K": (8, 3, True, 0.3),
    "AS_noK": (8, 4, False, 0.3),
    "noAS_noK": (0, 0, False, 0.3),
    "AS_mu06": (8, 4, True, 0.6),
    "noASS_mu06": (0, 0, True, 0.6),
}


@pytest.fixture(scope="module")
def pendolino():
    return load_vehicle("pendolino")


def numbers_of_file(node):
    """How many numbers a parsed file holds in entries [value, "unit", ...]."""
    if isinstance(node, list) and len(node) > 1 and all(isinstance(item, str) for item in node[1:]):
        return len(node[0]) if isinstance(node[0], list) else int(not isinstance(node[0], str))
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return sum(numbers_of_file(child) for child in children)


def test_shipped_vehicles():
    assert vehicles() == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_parameters_hold_every_number_with_unit_and_origin(name):
    vehicle = load_vehicle(name)
    document = tomllib.loads((SHIPPED / f"{name}.toml").read_text())
    document.pop("configurations", None)
    given = {k: q for k, q in vehicle.parameters.items() if q.origin != "default of the file format"}
    assert sum(np.size(q.value) for q in given.values()) == numbers_of_file(document)
    assert all(q.unit and q.origin for q in vehicle.parameters.values())


@pytest.mark.parametrize("name", NAMES)
def test_shipped_vehicles_are_left_right_symmetric(name):
    vehicle = load_vehicle(name)

    def places(flip):
        # Adding 0 turns -0 into 0.
        ends = [(e.group, np.array([e.first.position, e.second.position]) * [1.0, flip, 1.0]) for e in vehicle.elements]
        return sorted((group, *(np.round(points, 9) + 0.0).flat) for group, points in ends)

    assert places(1.0) == places(-1.0)


@pytest.mark.parametrize("name", NAMES)
def test_left_is_negative_y(name):
    vehicle = load_vehicle(name)
    places = [(e.name, e.first.position) for e in vehicle.elements] + [(b.name, b.position) for b in vehicle.bodies]
    for thing, position in places:
        if thing.endswith(("left", "right")):
            assert (position[1] < 0) == thing.endswith("left"), thing


@pytest.mark.parametrize("name", NAMES)
def test_elements_end_near_the_bodies_they_join(name):
    # A position further than 2.2 m from a bogie, wheelset, axlebox or truss would be a slip of the pen.
    vehicle = load_vehicle(name)
    for element in vehicle.elements:
        for end in (element.first, element.second):
            body = end.body.partition(".")[0]
            if body not in ("car", "track"):
                assert np.linalg.norm(end.position - vehicle.body(body).position) < 2.2, element.name


def test_the_pendolino_is_of_31_bodies(pendolino):
    assert len(pendolino.bodies) + sum(len(b.axleboxes) for b in pendolino.bodies) == 31
    assert [b.name for b in pendolino.bodies if b.kind == "wheelset"] == ["wheelset1", "wheelset4", "wheelset2", "wheelset3"]
    assert {e.name for e in pendolino.elements if e.group == "anti_yaw_damper"} == {
        f"anti_yaw_damper.{end}_{side}" for end in ("front", "rear") for side in ("left", "right")
    }
    for name in ("anti_yaw_damper.front_left", "anti_yaw_damper.rear_right"):
        element = pendolino.element(name)
        assert (element.first.body, element.second.body) == ("bogie1" if "front" in name else "bogie2", "car")
        assert abs(element.first.position[1]) == 1.35


def test_an_axlebox_is_on_its_side(pendolino):
    left, right = pendolino.body("wheelset1").axleboxes
    assert (left.name, left.side, left.lateral_position) == ("wheelset1.axlebox_left", -1, -1.0)
    assert (right.name, right.side, right.lateral_position) == ("wheelset1.axlebox_right", 1, 1.0)


def test_the_left_axlebox_mirrors_the_right_one(pendolino):
    changed = pendolino.replace(
        {"wheelset_outer.axlebox.inertia": [2.0, 4.0, 3.0, 0.1, 0.2, 0.3], "wheelset_outer.axlebox.centre_offset": [0.05, 0.02, 0.01]}
    )
    left, right = changed.body("wheelset1").axleboxes
    np.testing.assert_array_equal(right.inertia, [[2.0, 0.1, 0.3], [0.1, 4.0, 0.2], [0.3, 0.2, 3.0]])
    np.testing.assert_array_equal(left.inertia, [[2.0, -0.1, 0.3], [-0.1, 4.0, -0.2], [0.3, -0.2, 3.0]])
    np.testing.assert_array_equal(left.centre_offset, [0.05, -0.02, 0.01])


@pytest.mark.parametrize("name", TABLE_II)
def test_configurations_of_table_ii(pendolino, name):
    primary, secondary, maxwell, friction = TABLE_II[name]
    vehicle = pendolino.configured(name)
    groups = [e.group for e in vehicle.elements]
    assert vehicle.configuration == name
    assert (groups.count("primary_anti_yaw_damper"), groups.count("anti_yaw_damper")) == (primary, secondary)
    assert vehicle.contact["friction"] == friction
    dampers = [e for e in vehicle.elements if e.group.endswith("damper")]
    assert {e.type for e in dampers} == {"maxwell" if maxwell else "damper"}
    others = [e.name for e in vehicle.elements if "anti_yaw" not in e.group]
    assert others == [e.name for e in pendolino.elements if "anti_yaw" not in e.group]


def test_the_configurations_are_those_of_table_ii(pendolino):
    assert set(pendolino.configurations) == set(TABLE_II)
    assert pendolino.configuration is None


def test_the_nominal_configuration_changes_no_number(pendolino):
    assert pendolino.configured("AS_K").parameters.components() == pendolino.parameters.components()


def test_a_removed_damper_is_the_front_left_one(pendolino):
    names = {e.name for e in pendolino.elements} - {e.name for e in pendolino.configured("AS_Mal_K").elements}
    assert names == {"anti_yaw_damper.front_left"}


def test_viscous_dampers_keep_their_damping(pendolino):
    viscous = pendolino.configured("AS_noK")
    damping = pendolino.parameters["anti_yaw_damper.damping"].value
    assert dict(viscous.element("anti_yaw_damper.front_left").parameters) == {"damping": damping}
    assert "anti_yaw_damper.series_stiffness" not in viscous.parameters
    with pytest.raises(VehicleFileError, match="AS_noK.*anti_yaw_damper.series_stiffness.*nearest"):
        viscous.replace({"anti_yaw_damper.series_stiffness": 5e6})


def test_parameters_of_removed_elements_go(pendolino):
    assert not [name for name in pendolino.configured("noAS_K").parameters if "anti_yaw" in name]
    one_less = pendolino.configured("AS_Mal_K").parameters
    assert "anti_yaw_damper.damping" in one_less and "anti_yaw_damper.front_left.first_position" not in one_less


def test_an_unknown_configuration_names_the_nearest(pendolino):
    with pytest.raises(VehicleFileError, match="'noASK'.*nearest: 'noAS_K'"):
        pendolino.configured("noASK")


def test_a_configuration_is_not_put_on_top_of_another(pendolino):
    with pytest.raises(VehicleFileError, match="on top of another"):
        pendolino.configured("AS_mu06").configured("noAS_K")


def test_replaced_parameters_stay_in_a_configuration(pendolino):
    vehicle = pendolino.replace({"car.mass": 40000, "contact.friction": 0.2})
    assert vehicle.configured("noAS_K").body("car").mass == 40000.0
    assert vehicle.configured("noAS_K").contact["friction"] == 0.2
    assert vehicle.configured("AS_mu06").contact["friction"] == 0.6  # the configuration sets it


def test_replace_changes_the_named_parts_only(pendolino):
    before = pendolino.parameters["anti_yaw_damper.series_stiffness"].value
    changed = pendolino.replace({"anti_yaw_damper.series_stiffness": 2 * before})
    for old, new in zip(pendolino.elements, changed.elements):
        if old.group == "anti_yaw_damper":
            assert (old.parameters["series_stiffness"], new.parameters["series_stiffness"]) == (before, 2 * before)
        else:
            assert old is new
    assert all(old is new for old, new in zip(pendolino.bodies, changed.bodies))
    assert changed.parameters["anti_yaw_damper.series_stiffness"].origin == "set by Vehicle.replace"


def test_replace_reaches_every_single_number():
    # Every number is scaled by 1 + 1e-7 on its own; a parameter that nothing uses would leave all parts alike.
    # A few are tied to others and refuse to be changed alone: Ixx = Izz of a wheelset, the axlebox that is as flat as a body can be
    # (1 + 3 = 4), and the zeros of a bump stop's curve.
    tied = re.compile(r"(wheelset.*inertia\.[02]|axlebox\.inertia\.1|curves\..*\.[xy]\.[01])")
    for name in NAMES:
        vehicle = load_vehicle(name)
        before = fingerprint(vehicle)
        for dotted, value in vehicle.parameters.components().items():
            new = value * (1 + 1e-7) if value not in (0.0, math.inf) else 1e-7 if value == 0.0 else 10.0
            try:
                after = fingerprint(vehicle.replace({dotted: new}))
            except VehicleFileError:
                assert tied.search(dotted), dotted
                continue
            assert after != before, dotted


def fingerprint(vehicle):
    """All numbers of the built parts, in order."""
    out = [vehicle.gravity, *vehicle.contact.values()]
    for body in vehicle.bodies:
        out += [body.mass, body.wheel_radius, body.contact_half_spacing, *body.position, *body.inertia.flat]
        for box in body.axleboxes:
            out += [box.mass, box.lateral_position, *box.inertia.flat, *box.centre_offset]
    for element in vehicle.elements:
        out += [*element.first.position, *element.second.position, *element.axes.flat]
        for value in element.parameters.values():
            out += [*value.x, *value.y] if hasattr(value, "x") else list(np.ravel(value))
    return out


def test_replace_one_component(pendolino):
    changed = pendolino.replace({"car.inertia.0": 66000.0, "car.inertia.2": 1.84e6, "bogie1.position.2": -0.6})
    np.testing.assert_array_equal(np.diag(changed.body("car").inertia), [66000.0, 1.87e6, 1.84e6])
    assert changed.body("bogie1").position[2] == -0.6
    assert changed.body("bogie2").position[2] == -0.55
    assert changed.parameters["car.inertia.0"].value == 66000.0


def test_replace_converts_quantities(pendolino):
    changed = pendolino.replace({"car.mass": Quantity(41.0, "t", "weighed")})
    assert changed.body("car").mass == 41000.0
    assert changed.parameters["car.mass"].origin == "weighed"
    component = pendolino.replace({"truss_frame_bushing.stiffness.1": Quantity(2.5, "MN/m", "bench")})
    assert component.parameters["truss_frame_bushing.stiffness.1"].value == 2.5e6
    with pytest.raises(VehicleFileError, match="car.mass.*wrong dimension"):
        pendolino.replace({"car.mass": Quantity(41.0, "kN", "weighed")})


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"anti_yaw_damper.stiffness": 1.0}, ["anti_yaw_damper.stiffness", "nearest: 'anti_yaw_damper.series_stiffness'"]),
        ({"bogie1.mass": 1.0}, ["bogie1.mass", "nearest: 'bogie.mass'"]),
        ({"car.inertia.3": 1.0}, ["car.inertia.3", "nearest: 'car.inertia'"]),
        ({"car.mass": -1.0}, ["car.mass = -1.0", "above 0"]),
        ({"car.mass": math.nan}, ["car.mass = nan"]),
        ({"car.mass": "heavy"}, ["car.mass = 'heavy'", "takes none"]),
        ({"car.mass": [1.0, 2.0, 3.0]}, ["car.mass", "3 numbers", "a single number"]),
        ({"car.inertia.0": 5e6}, ["car.inertia", "may not exceed"]),
        ({"car.inertia": np.eye(3)}, ["car.inertia", "shape (3, 3)"]),
        ({"anti_yaw_damper.damping_curve": "bench"}, ["anti_yaw_damper.damping_curve = 'bench'", "curves of the file: none"]),
        ({"traction_rod.front.second_position": [9.3, 0.0, -0.55]}, ["traction_rod.front.second_position", "apart"]),
        ({"truss_frame_bushing.superior1_left.first_position": [0.0, 0.0, -1.0]}, ["first_position", "unknown"]),
    ],
)
def test_replace_refuses_what_makes_no_vehicle(pendolino, changes, words):
    with pytest.raises(VehicleFileError) as caught:
        pendolino.replace(changes)
    for word in ["vehicle 'pendolino'", *words]:
        assert word in str(caught.value)


def test_a_curve_and_the_numbers_it_replaces_exclude_each_other():
    vehicle = load_vehicle("manchester_vehicle1")
    assert vehicle.element("lateral_bump_stop.front").parameters["curve"].y[-1] == 230000.0
    with pytest.raises(VehicleFileError, match="lateral_bump_stop.stiffness: is missing"):
        vehicle.replace({"lateral_bump_stop.clearance": 0.03})
    numbers = vehicle.replace({"lateral_bump_stop.clearance": 0.03, "lateral_bump_stop.stiffness": 5e5})
    assert dict(numbers.element("lateral_bump_stop.rear").parameters) == {"clearance": 0.03, "stiffness": 5e5}
    again = numbers.replace({"lateral_bump_stop.curve": "lateral_bump_stop"})
    assert set(again.element("lateral_bump_stop.rear").parameters) == {"curve"}
    assert "lateral_bump_stop.clearance" not in again.parameters


def test_replacing_a_curve_reaches_its_elements():
    vehicle = load_vehicle("manchester_vehicle1")
    stiffer = vehicle.replace({"curves.lateral_bump_stop.y": vehicle.curves["lateral_bump_stop"].y * 2})
    assert stiffer.element("lateral_bump_stop.front").parameters["curve"].y[-1] == 460000.0
    with pytest.raises(VehicleFileError, match="curves.lateral_bump_stop.x.*strictly increasing"):
        vehicle.replace({"curves.lateral_bump_stop.x.2": 0.025})


def test_orientation_turns_the_axes(pendolino):
    changed = pendolino.replace({"primary_spring.orientation": [math.pi / 2, 0.0, 0.0]})
    # Yawed by a quarter turn, the element's x axis points to the right and its y axis backwards (1e-15: cos(pi/2) in doubles).
    axes = changed.element("primary_spring.wheelset1_left").axes
    np.testing.assert_allclose(axes, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
    np.testing.assert_array_equal(pendolino.element("primary_spring.wheelset1_left").axes, np.eye(3))


def test_rotation_is_yaw_then_roll_then_pitch():
    # z points down, so a positive roll lowers the right side and a positive pitch raises the front.
    small = 1e-6
    np.testing.assert_allclose(rotation([0, small, 0])[:, 1], [0, 1, small], atol=1e-11)
    np.testing.assert_allclose(rotation([0, 0, small])[:, 0], [1, 0, -small], atol=1e-11)
    yaw, roll, pitch = 0.3, -0.4, 1.1
    combined = rotation([yaw, 0, 0]) @ rotation([0, roll, 0]) @ rotation([0, 0, pitch])
    np.testing.assert_allclose(rotation([yaw, roll, pitch]), combined, atol=1e-15)
    np.testing.assert_allclose(combined.T @ combined, np.eye(3), atol=1e-15)


def test_a_vehicle_cannot_be_changed_in_place(pendolino):
    before = fingerprint(pendolino)
    with pytest.raises(dataclasses.FrozenInstanceError):
        pendolino.gravity = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        pendolino.body("car").mass = 1.0
    car, element = pendolino.body("car"), pendolino.elements[0]
    arrays = [car.inertia, car.position, pendolino.parameters["car.inertia"].value]
    arrays += [element.axes, element.first.position, element.parameters["stiffness"]]
    arrays += [box.inertia for box in pendolino.body("wheelset1").axleboxes]
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
    for mapping in (pendolino.contact, pendolino.elements[0].parameters, pendolino.configurations):
        with pytest.raises(TypeError, match="read-only"):
            mapping["friction"] = 1.0
    with pytest.raises(TypeError):
        pendolino.parameters["car.mass"] = 1.0
    pendolino.replace({"car.inertia.0": 6e4})
    assert fingerprint(pendolino) == before


def test_an_array_given_to_replace_is_copied(pendolino):
    position = np.array([9.5, 0.0, -0.6])
    changed = pendolino.replace({"bogie1.position": position})
    position[:] = 0.0
    assert changed.body("bogie1").position[2] == -0.6


def test_a_vehicle_can_be_sent_to_another_process(pendolino):
    vehicle = pendolino.configured("noAS_K")
    copy = pickle.loads(pickle.dumps(vehicle))
    assert fingerprint(copy) == fingerprint(vehicle)
    assert copy.configuration == "noAS_K"
    assert copy.replace({"car.mass": 1e4}).body("car").mass == 1e4


def test_unknown_bodies_and_elements_name_the_nearest(pendolino):
    with pytest.raises(VehicleFileError, match="body 'bogie'.*nearest: 'bogie"):
        pendolino.body("bogie")
    with pytest.raises(VehicleFileError, match="element 'anti_yaw_damper'.*nearest: 'anti_yaw_damper"):
        pendolino.element("anti_yaw_damper")
    with pytest.raises(KeyError, match="nearest: 'car.mass'"):
        pendolino.parameters["car.mas"]
