# SPDX-License-Identifier: BSD-3-Clause
"""Runs that stay in their file, and speed against place."""

import pickle

import numpy as np
import pytest

import railsym as rs
from railsym.conical_contact import Cone
from railsym.errors import SimulationError
from railsym.results import Channel, FileRun, ResultFileError

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = rs.ConicalContact(zones=(Cone(0.1),))
TRACK = rs.Track.straight(200.0).with_irregularity("erri_b176_low", seed=3)


def run(**options):
    return rs.simulate(BOGIE, speed=30.0, duration=5.0, track=TRACK, contact=CONES, **options)


def test_a_run_kept_in_its_file_is_the_run(tmp_path):
    memory, file = run(save=tmp_path / "a.nc"), run(save=tmp_path / "b.nc", keep="file")
    assert isinstance(file, FileRun) and file.path == tmp_path / "b.nc" and len(file) == len(memory) == 1001
    assert list(file.channels.values()) == list(memory.channels.values()) and file.info == memory.info and repr(file) == repr(memory)
    for name in ("time", *memory.channels):
        assert file[name].tobytes() == memory[name].tobytes(), name
        assert not file[name].flags.writeable
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    part, same = file.between(1.0, 2.0).select("*.Q"), memory.between(1.0, 2.0).select("*.Q")
    assert isinstance(part, FileRun) and part["wheelset1.left.Q"].tobytes() == same["wheelset1.left.Q"].tobytes()
    part.to_netcdf(tmp_path / "c.nc")
    same.to_netcdf(tmp_path / "d.nc")
    assert (tmp_path / "c.nc").read_bytes() == (tmp_path / "d.nc").read_bytes()
    assert type(file.loaded()) is rs.Run and file.with_info(message="x").message == "x"
    assert file.spectrum("car.ay").message == memory.spectrum("car.ay").message
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(part)).time, part.time)
    with pytest.raises(KeyError, match="there is no channel 'car.yy'"):
        file["car.yy"]
    with pytest.raises(rs.RailsymError, match="no sample lies between"):
        file.between(90.0, 91.0)


def test_criteria_take_a_run_in_a_file_as_one_in_memory(tmp_path):
    file = run(save=tmp_path / "b.nc", keep="file")
    for judge in (lambda r: rs.criteria.derailment(r, sections=50.0), rs.criteria.instability, lambda r: rs.criteria.body_acceleration(r, channels="car.ay", band=(1.0, 10.0))):
        one, other = judge(file), judge(file.loaded())
        assert str(one) == str(other)
    assert one.statistics["car.ay"].values.tobytes() == other.statistics["car.ay"].values.tobytes()


def test_what_another_run_writes_under_the_name_does_not_change_it(tmp_path):
    file = run(save=tmp_path / "b.nc", keep="file")
    before = file["car.y"].copy()
    rs.Run([0.0, 1.0], {"car.y": [1.0, 2.0]}, [Channel("car.y", "m")]).to_netcdf(tmp_path / "b.nc")
    np.testing.assert_array_equal(file["car.y"], before)


def test_a_file_that_was_cut_says_so(tmp_path):
    file = run(save=tmp_path / "b.nc", keep="file")
    with open(tmp_path / "b.nc", "r+b") as target:
        target.truncate((tmp_path / "b.nc").stat().st_size // 2)
    with pytest.raises(ResultFileError, match="was cut off"):
        file["car.y"]


def test_a_run_that_ends_early_keeps_its_file(tmp_path):
    def stop(controls):
        if controls.time > 2.0:
            raise KeyboardInterrupt

    found = run(save=tmp_path / "b.nc", keep="file", controllers=[(stop, 100.0)])
    assert found.status == "interrupted" and found.time[-1] == pytest.approx(2.0, abs=0.02)
    assert not list(tmp_path.glob("*.part*"))


def test_bad_ways_of_keeping(tmp_path):
    with pytest.raises(SimulationError, match='save="run.nc"'):
        run(keep="file")
    with pytest.raises(SimulationError, match="'memory', or in the 'file'"):
        run(keep="disk", save=tmp_path / "b.nc")
    simulation = rs.Simulation(BOGIE, speed=30.0, track=TRACK, contact=CONES)
    with rs.ChannelWriter(tmp_path / "b.nc", simulation.recorder.channels) as writer:
        simulation.run(0.5, writer=writer, keep="file")
        with pytest.raises(SimulationError, match="go on with keep"):
            simulation.run(0.5)
        simulation.run(0.5, writer=writer, keep="file")
    assert len(simulation.result()) == 200


# --- speed against place -------------------------------------------------------------------------------------------------


def test_braking_is_even_and_where_it_was_asked_for():
    """v^2 = 40^2 - 2 a (s - 100)."""
    asked = rs.SpeedOverDistance([0.0, 100.0, 380.0], [40.0, 40.0, 30.0])
    np.testing.assert_allclose(asked.acceleration, [0.0, -1.25])
    profile = asked.profile(start=-20.0)
    s = np.linspace(-20.0, 400.0, 43)
    np.testing.assert_allclose(profile.at(profile.when(s)), asked.at(s), rtol=1e-12)
    np.testing.assert_allclose(profile.place(profile.when(s)), s, atol=1e-9)


def test_a_run_brakes_at_its_place():
    asked = rs.SpeedOverDistance([0.0, 50.0, 150.0], [30.0, 30.0, 26.0])
    found = rs.simulate(BOGIE, speed=asked, duration=6.0, contact=CONES, channels=["s", "V", "car.ax"])
    np.testing.assert_allclose(found["V"], asked.at(found["s"]), rtol=1e-12)
    inside = (found["s"] > 80.0) & (found["s"] < 140.0)
    assert found["car.ax"][inside].mean() == pytest.approx((26.0 ** 2 - 30.0 ** 2) / 200.0, rel=0.02)


def test_the_fastest_run_within_limits():
    """Speeds up with a behind a limit and brakes with b before one; nowhere faster than allowed; short stretches have a peak."""
    place, limit = np.array([0.0, 1000.0, 1400.0, 1700.0, 3000.0]), np.array([30.0, 20.0, 40.0, 10.0, 25.0])
    found = rs.SpeedOverDistance.from_limits(place, limit, acceleration=0.5, braking=0.8)
    s = np.linspace(0.0, 4000.0, 4001)
    allowed = limit[np.clip(np.searchsorted(place, s, side="right") - 1, 0, None)]
    assert (found.at(s) <= allowed * (1 + 1e-12)).all()
    assert set(np.round(found.acceleration, 9)) <= {0.5, -0.8, 0.0}
    assert found.at(999.0) ** 2 == pytest.approx(20.0 ** 2 + 2 * 0.8 * 1.0)
    assert found.at(4000.0) == 25.0 and found.at(3000.0) == pytest.approx(10.0)
    top = found.at(np.linspace(1400.0, 1700.0, 30001)).max()
    assert top < 40.0 and top ** 2 == pytest.approx((0.8 * 20.0 ** 2 + 0.5 * 10.0 ** 2 + 2 * 0.5 * 0.8 * 300.0) / 1.3, rel=1e-4)


@pytest.mark.parametrize("text, name, kind", [
    ("s [m], speed [km/h]\n0, 108\n100, 108\n200, 90\n", "a.csv", rs.SpeedOverDistance),
    ("time [s], speed [m/s]\n0, 20\n10, 30\n", "a.csv", rs.simulation.SpeedProfile),
    ('[speed]\ns = [[0, 100], "m"]\nlimit = [[108, 72], "km/h"]\nbraking = [0.8, "m/s^2"]\nacceleration = [0.3, "m/s^2"]\n', "a.toml", rs.SpeedOverDistance),
])
def test_files(tmp_path, text, name, kind):
    (tmp_path / name).write_text(text)
    found = rs.load_speed(tmp_path / name)
    assert isinstance(found, kind)
    assert rs.simulation.SpeedProfile.of(str(tmp_path / name), 0.0).at(0.0) > 19.0


@pytest.mark.parametrize("make, message", [
    (lambda p: rs.SpeedOverDistance([0.0, 10.0], [40.0, 10.0]), "-75 m/s\\^2, beyond 1.5 m/s\\^2: give it 500 m"),
    (lambda p: rs.SpeedOverDistance([10.0, 0.0], [4.0, 4.0]), "increasing"), (lambda p: rs.SpeedOverDistance([0.0, 10.0], [4.0, 0.0]), "above 0 m/s everywhere"),
    (lambda p: rs.SpeedOverDistance([0.0], [4.0, 5.0]), "as many places"), (lambda p: rs.SpeedOverDistance([0.0], [4.0], -1.0), "max_acceleration"),
    (lambda p: rs.SpeedOverDistance.from_limits([0.0], [4.0], acceleration=0.0, braking=1.0), "acceleration = 0.0"),
    (lambda p: rs.load_speed(p / "no.csv"), "cannot be read"), (lambda p: rs.load_speed(p / "no.toml"), "cannot be read"),
])
def test_bad_speeds(tmp_path, make, message):
    with pytest.raises(SimulationError, match=message):
        make(tmp_path)


@pytest.mark.parametrize("text, message", [
    ("s [m], v [km/h]\n0, 1\n1, 2\n", "a.csv: column 'v'"), ("s [m], time [s], speed [m/s]\n0, 0, 1\n1, 1, 2\n", "a.csv: give s and speed"),
    ("time [s], limit [m/s]\n0, 1\n1, 2\n", "a.csv: give s and speed"), ("s [m], speed [m]\n0, 1\n1, 2\n", "column 'speed'"),
])
def test_bad_files(tmp_path, text, message):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(SimulationError, match=message):
        rs.load_speed(tmp_path / "a.csv")


# --- sections ------------------------------------------------------------------------------------------------------------


def test_sections_of_a_line_are_straight_or_full_curve():
    line = rs.load_track("line_20km")
    found = rs.criteria.track_sections(line)
    for part in found:
        inside = line.curvature(np.linspace(part.start, part.end, 50))
        assert np.ptp(inside) < 2.1e-5 + 0.1 * abs(inside.mean()), part
    built = np.array([800.0, 1000.0, 1200.0, 1500.0, 2000.0, 3000.0])
    nearest = {float(built[np.abs(built / part.radius - 1.0).argmin()]) for part in found if np.isfinite(part.radius)}
    assert nearest == set(built)
    assert all(np.abs(built / part.radius - 1.0).min() < 5e-3 for part in found if np.isfinite(part.radius))      # the end of a ramp within 5 %
    assert all(part.end - part.start == 250.0 for part in found) and 60 < len(found) < 80
    first = next(part for part in found if part.direction == "right")
    assert first.radius == pytest.approx(1500.0, rel=5e-3) and first.cant == pytest.approx(0.1, rel=0.01)
    left = next(part for part in found if part.direction == "left")
    assert left.cant == pytest.approx(0.11, rel=0.01)
    tight = rs.criteria.track_sections(rs.Track.curve(300.0, 200.0, transition=50.0, cant=0.1))
    assert [part.end - part.start for part in tight if part.direction == "right"] == [70.0, 70.0]
    assert len(rs.criteria.track_sections(line, length=100.0, first=0.0, last=1000.0)) == 10
    for options, message in (({"first": -1.0}, "runs from 0 to 20000"), ({"length": 0.5}, "at least 2 m"), ({"first": 1000.0, "last": 1100.0}, "no section")):
        with pytest.raises(rs.RailsymError, match=message):
            rs.criteria.track_sections(line, **options)


def test_percentiles_by_section_of_a_run_in_a_file(tmp_path):
    found = run(save=tmp_path / "b.nc", keep="file")
    parts = rs.criteria.track_sections(TRACK, length=40.0, first=10.0, last=140.0)
    judged = rs.criteria.derailment(found, sections=[(part.start, part.end) for part in parts])
    values = judged.statistics["Q wheelset1.left"].values
    assert values.shape == (3, 1) and judged["Q wheelset1.left"].value == values.max()


def test_static_wheel_loads_come_with_a_run():
    """Q0 of the criteria is the vehicle's, not the median in a curve: half of the weight on each wheelset's sides."""
    found = run()
    loads = found.info.extra["wheel_loads"]
    weight = BOGIE.gravity * sum(b.mass + sum(box.mass for box in b.axleboxes) for b in BOGIE.bodies)
    assert list(loads) == ["wheelset1.left", "wheelset1.right", "wheelset2.left", "wheelset2.right"] and sum(loads.values()) == pytest.approx(weight, rel=1e-6)
    judged = rs.criteria.derailment(found)
    assert judged.wheel_load == loads and not any("medians" in note for note in judged.notes)


def test_an_unfinished_file_is_read_too(tmp_path):
    """What a killed program left: counted samples, called interrupted."""
    writer = rs.ChannelWriter(tmp_path / "run.nc", [Channel("car.y", "m"), Channel("s", "m")])
    writer.write([0.0, 1.0, 2.0], np.arange(6.0).reshape(3, 2))
    writer.flush()
    found = rs.Run.from_netcdf(tmp_path / "run.nc.part", lazy=True)
    np.testing.assert_array_equal(found["s"], [1.0, 3.0, 5.0])
    assert found.status == "interrupted" and len(found) == 3 and len(found.select("s").channels) == 1
