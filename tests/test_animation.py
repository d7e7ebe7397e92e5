# SPDX-License-Identifier: BSD-3-Clause
"""Animations: what is drawn where, what is written, errors."""

import shutil

import numpy as np
import pytest
from PIL import Image

import railsym as rs
from railsym.errors import SimulationError
from railsym.plots.animation import animate, animation_channels, moved
from railsym.plots.cross_section import cross_section
from railsym.plots.mode_shape import displacement
from railsym.plots.outlines import outlines
from railsym.plots.scene import Panel, PassingTrack, new_scene
from railsym.studies import SWITCH, switch_track


@pytest.fixture(scope="module")
def vehicle():
    return rs.load_vehicle("pendolino")


def made_run(vehicle, **shapes):
    """1 s at 60 m/s; coordinates by name as functions of time, the others 0."""
    time = np.linspace(0.0, 1.0, 201)
    values = {name: np.zeros(201) for name in animation_channels(vehicle)} | {"s": 60.0 * time, "V": np.full(201, 60.0)}
    values |= {name.replace("__", "."): function(time) for name, function in shapes.items()}
    return rs.Run.from_arrays(time, values, {name: "m" for name in values})


def test_outlines_move_as_those_of_a_mode(vehicle):
    rng = np.random.default_rng(3)
    shape = {name: float(rng.normal()) for name in animation_channels(vehicle) if name not in ("s", "V")}
    states = {name: np.array([0.0, value]) for name, value in shape.items()}
    for outline in [*outlines(vehicle), *outlines(vehicle, "side"), *cross_section(vehicle)]:
        found = moved(outline, vehicle, states, 2)
        np.testing.assert_array_equal(found[0], 0.0)
        np.testing.assert_allclose(found[1], displacement(shape, vehicle, outline).real, rtol=1e-12, atol=1e-12)


def test_the_cross_section_is_the_leading_end_to_scale(vehicle):
    drawn = cross_section(vehicle)
    kinds = [outline.kind for outline in drawn]
    assert kinds.count("wheel") == 2 and kinds.count("axlebox") == 2 and kinds.count("car") == 1 and kinds.count("frame") == 3
    bodies = {name.partition(".")[0] for outline in drawn for name in outline.bodies}
    leading = max((b for b in vehicle.bodies if b.kind == "wheelset"), key=lambda b: b.position[0])
    assert leading.name in bodies and not any(b.kind == "wheelset" and b.name in bodies for b in vehicle.bodies if b is not leading)
    wheels = [outline.points for outline in drawn if outline.kind == "wheel"]
    lowest = sorted(np.unique(np.round(wheels[0][:, 2], 6)))[-2]
    assert lowest == pytest.approx(0.0, abs=1e-9)                    # the tread stands on the rail; below it only the flange
    assert np.abs(wheels[0][:, 1]).min() == pytest.approx(0.68)      # flange backs 1360 mm apart
    for name in ("bogie", "wheelset"):
        assert cross_section(rs.load_vehicle(name))


def test_displacements_and_rails_are_drawn_times_the_factor(vehicle):
    run = made_run(vehicle, wheelset1__y=lambda t: 2e-3 + 0.0 * t)
    states = {name: run[name][:2] for name in animation_channels(vehicle)}
    drawn = outlines(vehicle)
    _, (whole, bogie, behind), _ = new_scene(vehicle)
    panel = Panel(whole, drawn, [moved(outline, vehicle, states, 2) for outline in drawn], (0, 1), 20.0)
    panel.show(1)
    axle = next(k for k, outline in enumerate(drawn) if outline.kind == "axle" and outline.bodies[0] == "wheelset1")
    np.testing.assert_allclose(panel.lines[axle].get_ydata(), drawn[axle].points[:, 1] + 0.040, atol=1e-12)
    rails = PassingTrack((whole, bogie, behind), vehicle, 20.0)
    rails.show(switch_track(SWITCH, 100.0), 25.0)                    # 5 mm to the right at s = 25 m
    x, y = rails.rails[0][1].get_data()
    assert np.interp(0.0, x, y) == pytest.approx(0.75 + 0.1, abs=1e-3)
    assert y[0] == pytest.approx(0.75)
    head = rails.heads[1].get_xy()
    ahead = switch_track(SWITCH, 100.0).rails(25.0 + rails.ahead).right_y
    assert 0.5 * (head[:, 0].min() + head[:, 0].max()) == pytest.approx(0.75 + 20.0 * float(ahead), abs=1e-9)


def test_gif_has_the_pictures_and_they_differ(vehicle, tmp_path):
    run = made_run(vehicle, bogie1__y=lambda t: 5e-3 * np.sin(2 * np.pi * t), wheelset1__y=lambda t: 5e-3 * np.sin(2 * np.pi * t))
    found = animate(run, vehicle, tmp_path / "run.gif", frames=5)
    assert found.factor == 50.0 and found.frames == 5 and found.slowdown == pytest.approx(0.25)
    assert "motions times 50" in found.message and found.size == (tmp_path / "run.gif").stat().st_size < 500_000
    with Image.open(tmp_path / "run.gif") as picture:
        assert picture.n_frames == 5
        shots = []
        for k in range(5):
            picture.seek(k)
            shots.append(np.asarray(picture.convert("L"), dtype=int))
    # at t = 0.25 and 0.75 the leading bogie stands on opposite sides; the window of it is the lower left
    assert all((np.abs(a - b)[150:, :400] > 40).sum() > 500 for a, b in zip(shots, shots[1:]))


def test_slowdown_gives_the_number_of_pictures(vehicle, tmp_path):
    run = made_run(vehicle)
    found = animate(run, vehicle, tmp_path / "rest.gif", start=0.5, end=0.75, slowdown=1.0)
    assert (found.frames, found.slowdown, found.factor) == (5, 1.0, 1.0)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_mp4(vehicle, tmp_path):
    found = animate(made_run(vehicle), vehicle, tmp_path / "run.mp4", frames=4)
    assert found.size > 1000


def test_what_cannot_be_animated_is_said(vehicle, tmp_path, monkeypatch):
    run = made_run(vehicle)
    for path, options, words in [("run.avi", {}, ".gif or .mp4"), ("none/run.gif", {}, "no directory"), ("run.gif", {"start": 3.0}, "nothing to show"),
                                 ("run.gif", {"slowdown": 0.0}, "slowdown"), ("run.gif", {"factor": -1.0}, "factor"),
                                 ("run.gif", {"slowdown": 1e4}, "2000")]:
        with pytest.raises(SimulationError, match=words):
            animate(run, vehicle, tmp_path / path, **options)
    with pytest.raises(SimulationError, match="lacks .* such as car.x"):
        animate(run.select("s", "V"), vehicle, tmp_path / "run.gif")
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(SimulationError, match="ffmpeg, which is not installed"):
        animate(run, vehicle, tmp_path / "run.mp4")
    assert not list(tmp_path.iterdir())
