# SPDX-License-Identifier: BSD-3-Clause
"""Strict reading: every kind of bad input is one error that names file, key, value, what is allowed, and the nearest match."""

import copy
import math
import re
import tomllib
from pathlib import Path

import pytest

from railsym import vehicle_file
from railsym.errors import VehicleFileError
from railsym.vehicle import Quantity, load_vehicle

GOOD = """
[vehicle]
name = "trial"
description = "a frame on one wheelset"
gravity = [9.81, "m/s^2", "book"]

[origins]
book = "a book"

[contact]
origin = "book"
friction = [0.3, "-"]
kalker_weight = [1.0, "-"]
amplitude = [3, "mm"]
wheel_transverse_radius = [inf, "m"]
rail_transverse_radius = [300, "mm"]
young_modulus = [210, "GPa"]
poisson_ratio = [0.28, "-"]

[bodies.frame]
kind = "rigid_body"
mass = [3.1, "t"]
inertia = [[2000, 2150, 4130], "kg*m^2"]
origin = "book"
at = { frame = [[0, 0, -0.55], "m"] }

[bodies.axle]
kind = "wheelset"
mass = [1250, "kg"]
inertia = [[820, 90, 820], "kg*m^2"]
wheel_radius = [460, "mm"]
contact_half_spacing = [0.75, "m"]
origin = "book"
at = { wheelset1 = [[0, 0, -0.46], "m"] }

[bodies.axle.axlebox]
mass = [90, "kg"]
inertia = [[1, 4, 3], "kg*m^2"]
lateral_position = [1.0, "m"]

[curves.force_speed]
x = [[0, 0.1, 0.2], "m/s"]
y = [[0, 4, 6], "kN"]
origin = "book"

[curves.force_deflection]
x = [[0, 10, 20], "mm"]
y = [[0, 1, 5], "kN"]
origin = "book"

[elements.primary]
type = "bushing"
stiffness = [[4, 2, 1], "MN/m"]
origin = "book"
at = [
    { name = "left", first = "wheelset1.axlebox_left", second = "frame", position = [[0, -1, -0.46], "m"] },
    { name = "right", first = "wheelset1.axlebox_right", second = "frame", position = [[0, 1, -0.46], "m"] },
]

[elements.yaw_damper]
type = "maxwell"
damping = [1200, "kN*s/m"]
series_stiffness = [5, "kN/mm"]
origin = "book"
at = [ { name = "one", first = "frame", second = "track", first_position = [[0, 1.3, -0.6], "m"], second_position = [[-0.8, 1.3, -0.6], "m"] } ]

[elements.stop]
type = "bump_stop"
axis = "y"
clearance = [30, "mm"]
stiffness = [1, "kN/mm"]
origin = "book"
at = [ { name = "one", first = "frame", second = "track", position = [[0, 0, -0.6], "m"] } ]

[configurations.bare]
description = "no yaw damper"
remove = ["yaw_damper"]
set = { "contact.friction" = [0.6, "-", "book"] }
"""

NO_VALUE = None

# (what to replace, by what, key of the message, value in the message or None, words the message must hold)
BAD = {
    "unknown key": ("mass = [3.1", "mas = [3.1", "bodies.frame.mas", "3.1", ["nearest: 'mass'", "allowed keys", "inertia"]),
    "unknown section": ("[elements.stop]", "[element.stop]", "element", NO_VALUE, ["nearest: 'elements'"]),
    "unknown key of an element": ("series_stiffness = ", "serial_stiffness = ", "elements.yaw_damper.serial_stiffness", "[5, 'kN/mm']", ["nearest: 'series_stiffness'"]),
    "unknown key of an instance": ('name = "left", first', 'nam = "left", first', "elements.primary.at[0].nam", "left", ["nearest: 'name'"]),
    "axis where there is none": ('type = "bushing"', 'type = "bushing"\naxis = "x"', "elements.primary.axis", "x", ["allowed keys"]),
    "missing key": ('mass = [3.1, "t"]', "", "bodies.frame.mass", NO_VALUE, ["is missing", "inertia"]),
    "missing contact number": ('friction = [0.3, "-"]', "", "contact.friction", NO_VALUE, ["is missing"]),
    "missing section": ("[contact]", "[bodies.contact_]", "contact", NO_VALUE, ["is missing"]),
    "missing body": ('second = "frame", position = [[0, -1', 'second = "fram", position = [[0, -1', "elements.primary.at[0].second", "fram", ["nearest: 'frame'", "wheelset1.axlebox_left", "track"]),
    "missing axlebox": ("wheelset1.axlebox_left", "wheelset1.axlebox_lef", "elements.primary.at[0].first", "wheelset1.axlebox_lef", ["nearest: 'wheelset1.axlebox_left'"]),
    "a group is no body": ('first = "wheelset1.axlebox_left"', 'first = "axle"', "elements.primary.at[0].first", "axle", ["wheelset1"]),
    "negative mass": ("mass = [3.1", "mass = [-3.1", "bodies.frame.mass", "-3.1", ["above 0", "kg"]),
    "zero mass": ("mass = [90", "mass = [0", "bodies.axle.axlebox.mass", "0", ["above 0"]),
    "negative stiffness": ("[[4, 2, 1]", "[[4, -2, 1]", "elements.primary.stiffness", "[[4, -2, 1], 'MN/m']", ["0 or above", "N/m"]),
    "zero series stiffness": ("series_stiffness = [5", "series_stiffness = [0", "elements.yaw_damper.series_stiffness", "0", ["above 0"]),
    "negative inertia": ("[[2000, 2150", "[[-2000, 2150", "bodies.frame.inertia", "-2000", ["above 0", "principal"]),
    "inertia of no body": ("[[2000, 2150, 4130]", "[[2000, 2150, 4160]", "bodies.frame.inertia", "4160", ["may not exceed the sum"]),
    "indefinite tensor": ("[[2000, 2150, 4130]", "[[2000, 2150, 4130, 2100, 0, 0]", "bodies.frame.inertia", "2100", ["above 0"]),
    "inertia of no axlebox": ("[[1, 4, 3]", "[[1, 4, 2.9]", "bodies.axle.axlebox.inertia", "2.9", ["may not exceed the sum"]),
    "unround wheelset": ("[[820, 90, 820]", "[[820, 90, 821]", "bodies.axle.inertia", "821", ["Ixx must equal Izz"]),
    "number of components": ("[[2000, 2150, 4130]", "[[2000, 2150]", "bodies.frame.inertia", "2150", ["2 numbers", "3 numbers or a list of 6"]),
    "single number for a list": ('[[4, 2, 1], "MN/m"]', '[4, "MN/m"]', "elements.primary.stiffness", "4", ["a single number", "a list of 3"]),
    "element on itself": ('first = "wheelset1.axlebox_right", second = "frame"', 'first = "frame", second = "frame"', "elements.primary.at[1].second", "frame", ["joins a body to itself"]),
    "track to track": ('first = "frame", second = "track", position', 'first = "track", second = "track", position', "elements.stop.at[0].second", "track", ["joins a body to itself"]),
    "wrong unit": ('damping = [1200, "kN*s/m"]', 'damping = [1200, "kN/m"]', "elements.yaw_damper.damping", "1200, 'kN/m'", ["wrong dimension", "'N*s/m'"]),
    "unknown unit": ('clearance = [30, "mm"]', 'clearance = [30, "inch"]', "elements.stop.clearance", "30, 'inch'", ["'inch'", "mm"]),
    "angle is no number": ('friction = [0.3, "-"]', 'friction = [0.3, "rad"]', "contact.friction", "0.3", ["wrong dimension", "'-'"]),
    "number without unit": ('mass = [3.1, "t"]', "mass = 3100", "bodies.frame.mass", "3100", ['[value, "unit"]']),
    "missing origin": ('"m/s^2", "book"]', '"m/s^2"]', "vehicle.gravity", "9.81", ["no origin", "[origins]"]),
    "missing origin of a position": ('[[-0.8, 1.3, -0.6], "m"] }', '[[-0.8, 1.3, -0.6], "m", "boo"] }', "elements.yaw_damper.at[0].second_position", "boo", ["nearest: 'book'"]),
    "unknown origin": ('origin = "book"\nfriction', 'origin = "bok"\nfriction', "contact.origin", "bok", ["nearest: 'book'"]),
    "nan": ("friction = [0.3", "friction = [nan", "contact.friction", "nan", ["other than nan"]),
    "infinity": ("mass = [3.1", "mass = [inf", "bodies.frame.mass", "inf", ["finite"]),
    "text for a number": ("mass = [3.1", 'mass = ["3.1"', "bodies.frame.mass", "3.1", ["a number"]),
    "truth for a number": ("mass = [3.1", "mass = [true", "bodies.frame.mass", "True", ["a number"]),
    "poisson ratio": ("poisson_ratio = [0.28", "poisson_ratio = [0.5", "contact.poisson_ratio", "0.5", ["below 0.5"]),
    "duplicate element": ('name = "right"', 'name = "left"', "elements.primary.at[1].name", "left", ["already an element"]),
    "duplicate body": ("{ wheelset1 = ", "{ frame = ", "bodies.axle.at.frame", "-0.46", ["already a body"]),
    "group named as a body": ("[elements.stop]", "[elements.wheelset1]", "elements.wheelset1", NO_VALUE, ["already that of", "bodies.axle"]),
    "group named as a group": ("[elements.stop]", "[elements.axle]", "elements.axle", NO_VALUE, ["already that of"]),
    "reserved name": ("{ wheelset1 = ", "{ track = ", "bodies.axle.at.track", "track", ["reserved"]),
    "name with a dot": ('name = "right"', 'name = "a.b"', "elements.primary.at[1].name", "a.b", ["letters, digits"]),
    "unknown kind": ('kind = "rigid_body"', 'kind = "rigid body"', "bodies.frame.kind", "rigid body", ["nearest: 'rigid_body'", "wheelset"]),
    "unknown type": ('type = "maxwell"', 'type = "maxwel"', "elements.yaw_damper.type", "maxwel", ["nearest: 'maxwell'", "bushing"]),
    "unknown axis": ('axis = "y"', 'axis = "Y"', "elements.stop.axis", "Y", ["x, y, z"]),
    "missing axis": ('axis = "y"', "", "elements.stop.axis", NO_VALUE, ["is missing", "x, y, z"]),
    "no line": ("[[-0.8, 1.3, -0.6]", "[[0, 1.3, -0.6009]", "elements.yaw_damper.one.second_position", "-0.6009", ["0.001 m apart"]),
    "two kinds of position": ("second_position = [[-0.8", "position = [[-0.8", "elements.yaw_damper.at[0].position", "-0.8", ["both first_position and second_position"]),
    "below the track": ("[[0, 0, -0.55]", "[[0, 0, 0.55]", "bodies.frame.at.frame", "0.55", ["z points down", "negative"]),
    "wheels in the air": ("[[0, 0, -0.46]", "[[0, 0, -0.50]", "bodies.axle.at.wheelset1", "-0.5", ["do not touch the rails", "-0.46"]),
    "unknown curve": ('damping = [1200, "kN*s/m"]', 'damping_curve = "force_sped"', "elements.yaw_damper.damping_curve", "force_sped", ["nearest: 'force_speed'"]),
    "curve of another kind": ('damping = [1200, "kN*s/m"]', 'damping_curve = "force_deflection"', "elements.yaw_damper.damping_curve", "force_deflection", ["N over m;", "N over m/s"]),
    "curve beside its number": ('damping = [1200, "kN*s/m"]', 'damping = [1200, "kN*s/m"]\ndamping_curve = "force_speed"', "elements.yaw_damper.damping", "1200", ["give one of the two"]),
    "neither curve nor number": ('damping = [1200, "kN*s/m"]', "", "elements.yaw_damper.damping", NO_VALUE, ["is missing", "damping_curve"]),
    "curve not increasing": ("[[0, 0.1, 0.2]", "[[0, 0.1, 0.1]", "curves.force_speed.x", "0.1", ["strictly increasing"]),
    "curve not monotone": ("[[0, 4, 6]", "[[0, 4, 3]", "curves.force_speed.y", "3000", ["monotone"]),
    "curve of unequal columns": ("[[0, 4, 6]", "[[0, 4]", "curves.force_speed.y", "4000", ["as many as x"]),
    "curve in another unit": ('[[0, 0.1, 0.2], "m/s"]', '[[0, 0.1, 0.2], "s"]', "curves.force_speed.x", "'s'", ["m or m/s"]),
    "configuration removes nothing": ('remove = ["yaw_damper"]', 'remove = ["yaw_dampr"]', "configurations.bare.remove", "yaw_dampr", ["nearest: 'yaw_damper'"]),
    "configuration removes no such element": ('remove = ["yaw_damper"]', 'remove = ["yaw_damper.two"]', "configurations.bare.remove", "yaw_damper.two", ["nearest: 'yaw_damper.one'"]),
    "viscous bushing": ('remove = ["yaw_damper"]', 'viscous = ["primary"]', "configurations.bare.viscous", "primary", ["'bushing'", "maxwell", "yaw_damper"]),
    "configuration sets nothing": ('"contact.friction" =', '"contact.frction" =', "configurations.bare.set.contact.frction", NO_VALUE, ["nearest: 'contact.friction'"]),
    "configuration sets a bad value": ('[0.6, "-", "book"]', '[-0.6, "-", "book"]', "configurations.bare.set.contact.friction", "-0.6", ["above 0"]),
    "configuration sets a wrong unit": ('[0.6, "-", "book"]', '[0.6, "N", "book"]', "configurations.bare.set.contact.friction", "0.6", ["wrong dimension"]),
    "configuration without origin": ('[0.6, "-", "book"]', '[0.6, "-"]', "configurations.bare.set.contact.friction", "0.6", ["no origin"]),
    "configuration with an unquoted name": ('"contact.friction" = [0.6', "contact.friction = [0.6", "configurations.bare.set.contact", NO_VALUE, ["quoted"]),
    "configuration without description": ('description = "no yaw damper"', "", "configurations.bare.description", NO_VALUE, ["is missing"]),
}


def write(folder, text):
    path = folder / "trial.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_good_file_loads(tmp_path):
    vehicle = load_vehicle(write(tmp_path, GOOD))
    assert vehicle.name == "trial"
    assert vehicle.body("frame").mass == 3100.0
    assert vehicle.element("stop.one").parameters["clearance"] == 0.03
    assert vehicle.attachments == ("frame", "wheelset1", "wheelset1.axlebox_left", "wheelset1.axlebox_right", "track")


LIMITS = {"lag", "rate_limit", "force_limit", "bypass_damping"}


@pytest.mark.parametrize("case", BAD, ids=lambda case: case.replace(" ", "_"))
def test_bad_input_is_one_clear_error(tmp_path, case):
    old, new, key, value, words = BAD[case]
    assert GOOD.count(old) == 1, f"the case must change exactly one place: {old!r}"
    with pytest.raises(VehicleFileError) as caught:
        load_vehicle(write(tmp_path, GOOD.replace(old, new)))
    message = str(caught.value)
    start = f"trial.toml: {key}: " if value is NO_VALUE else f"trial.toml: {key} = "
    assert message.startswith(start)
    if value is not NO_VALUE:
        assert value in message.removeprefix(start).partition(": ")[0]
    for word in words:
        assert word in message


def test_a_syntax_error_names_file_and_line(tmp_path):
    text = GOOD.replace('kind = "rigid_body"', "kind = rigid_body")
    line = 1 + next(i for i, row in enumerate(text.splitlines()) if row == "kind = rigid_body")
    with pytest.raises(VehicleFileError, match=rf"trial\.toml: TOML syntax: .*line {line}"):
        load_vehicle(write(tmp_path, text))


def test_a_repeated_key_names_file_and_line(tmp_path):
    with pytest.raises(VehicleFileError, match=r"trial\.toml: TOML syntax: .*line 23"):
        load_vehicle(write(tmp_path, GOOD.replace('mass = [3.1, "t"]', 'mass = [3.1, "t"]\nmass = [3.2, "t"]')))


def test_an_unknown_vehicle_lists_the_shipped_ones():
    with pytest.raises(VehicleFileError, match="nearest: 'pendolino'.*wheelset"):
        load_vehicle("pendolno")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(VehicleFileError, match="nowhere.toml.*no such file"):
        load_vehicle(tmp_path / "nowhere.toml")


@pytest.mark.parametrize(
    "table, parameters",
    [
        ('type = "spring"\ncurve = "force_deflection"\naxis = "z"', {"curve"}),
        ('type = "damper"\ndamping = [3, "kN*s/m"]\naxis = "z"', {"damping"}),
        ('type = "damper"\ncurve = "force_speed"\naxis = "z"', {"curve"}),
        ('type = "bump_stop"\ncurve = "force_deflection"\naxis = "z"', {"curve"}),
        ('type = "anti_roll_bar"\nstiffness = [1, "MN*m/rad"]', {"stiffness", "damping"}),
        ('type = "actuator"\nmode = "force"\naxis = "y"', {"mode", "stiffness", "damping"} | LIMITS),
        ('type = "actuator"\nmode = "length"\nstiffness = [1, "MN/m"]\ndamping = [1, "kN*s/m"]\naxis = "y"', {"mode", "stiffness", "damping"} | LIMITS),
    ],
)
def test_every_type_reads_its_parameters(tmp_path, table, parameters):
    text = GOOD.replace('type = "bump_stop"\naxis = "y"\nclearance = [30, "mm"]\nstiffness = [1, "kN/mm"]', table)
    assert text != GOOD
    element = load_vehicle(write(tmp_path, text)).element("stop.one")
    assert set(element.parameters) == parameters


def test_an_actuator_of_commanded_length_needs_its_spring(tmp_path):
    text = GOOD.replace('type = "bump_stop"\naxis = "y"\nclearance = [30, "mm"]', 'type = "actuator"\nmode = "length"\naxis = "y"')
    with pytest.raises(VehicleFileError, match="elements.stop.damping: is missing"):
        load_vehicle(write(tmp_path, text))


def test_origins_are_the_nearest_given(tmp_path):
    text = GOOD.replace('book = "a book"', 'book = "a book"\nrule = "a ruler"').replace('[[0, 0, -0.55], "m"]', '[[0, 0, -0.55], "m", "rule"]')
    parameters = load_vehicle(write(tmp_path, text)).parameters
    assert parameters["frame.position"].origin == "a ruler"
    assert parameters["frame.mass"].origin == parameters["primary.left.position"].origin == "a book"
    assert parameters["axle.axlebox.mass"].origin == "a book"
    assert parameters["primary.damping"].origin == "default of the file format"


def test_the_examples_of_the_docs_load(tmp_path):
    text = (Path(__file__).parents[1] / "docs" / "vehicle_file.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```toml\n(.*?)```", text, flags=re.DOTALL)
    car = '[bodies.car]\nkind = "rigid_body"\nmass = [39, "t"]\ninertia = [[65, 1870, 1850], "t*m^2"]\norigin = "report"\nat = { car = [[0, 0, -1.475], "m"] }\n'
    vehicle = load_vehicle(write(tmp_path, "\n".join([*blocks, car])))
    assert [b.name for b in vehicle.bodies] == ["bogie1", "bogie2", "wheelset1", "car"]
    bench = vehicle.replace({"anti_yaw_damper.damping_curve": "bench", "anti_yaw_damper.series_stiffness": 2e6, "car.inertia.0": 6e4})
    assert bench.element("anti_yaw_damper.front_left").parameters["damping_curve"].y[-1] == 9000.0
    assert vehicle.configured("one_damper_absent").elements == ()


def nodes(node, path=()):
    """Path of every table, list and value of a parsed file."""
    if path:
        yield path
    for key, child in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ():
        yield from nodes(child, (*path, key))


@pytest.mark.parametrize("damage", [1, "x", [], {}, True, math.nan, 10**400, [[1, 2], "m"], ["a", "b"], [{}], {"a": 1}], ids=repr)
def test_any_damage_is_one_error_of_the_reader(tmp_path, monkeypatch, damage):
    # Each node of the good file in turn is overwritten: some files stay good, no other exception may come out.
    good, refused, path = tomllib.loads(GOOD), 0, write(tmp_path, GOOD)
    for *way, last in list(nodes(good)):
        document = copy.deepcopy(good)
        node = document
        for key in way:
            node = node[key]
        node[last] = damage
        monkeypatch.setattr(vehicle_file.tomllib, "loads", lambda _, document=document: document)
        try:
            load_vehicle(path)
        except VehicleFileError as error:
            assert str(error).startswith("trial.toml: ")
            refused += 1
    assert refused > 150


@pytest.mark.parametrize("damage", [None, object(), 1j, {}, 10**400, [[]], [1, "m"], True, Quantity("a", "m", "x"), Quantity([1], "q", "x")])
def test_any_damage_is_one_error_of_replace(damage):
    vehicle = load_vehicle("manchester_vehicle1")
    for name in [*vehicle.parameters, *vehicle.parameters.components(), "", "car", "car.", "lateral_bump_stop.curve"]:
        with pytest.raises(VehicleFileError):
            vehicle.replace({name: damage})
