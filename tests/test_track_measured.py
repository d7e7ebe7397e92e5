# SPDX-License-Identifier: BSD-3-Clause
"""Measured geometry: every way to write it gives the same line; noise, gaps and wrong units."""

import numpy as np
import pytest

import railsym as rs
from railsym.errors import TrackError
from railsym.track import Curve, MeasuredGeometry, Straight, Track, Transition, load_track, read_geometry

LINE = Track([Straight(60), Transition(60), Curve(400, 120, 0.12, "left"), Transition(120), Curve(600, 100, 0.08), Transition(60), Straight(60)])
S = np.arange(0.0, LINE.length + 0.1, 2.5)
CURVATURE, CANT = LINE.curvature(S), LINE.cant(S)
GRADIENT = 0.004 * np.sin(S / 120.0)


def written(folder, heading, *columns, name="line.csv"):
    rows = "\n".join(", ".join(f"{value:.15g}" for value in row) for row in zip(*columns, strict=True))
    (folder / name).write_text(f"{heading}\n{rows}\n", encoding="utf-8")
    return folder / name


RADIUS = np.divide(1.0, CURVATURE, out=np.zeros_like(CURVATURE), where=CURVATURE != 0.0)
# sagitta of a chord of 20 m in a circle: R - sqrt(R^2 - 10^2)
VERSINE = np.array([0.0 if k == 0.0 else np.sign(k) * (1 / abs(k) - np.sqrt(1 / k ** 2 - 100.0)) for k in CURVATURE])


@pytest.mark.parametrize("heading, columns, options", [
    ("s [m], curvature [1/m], cant [m], gradient [-]", (S, CURVATURE, CANT, GRADIENT), {}),
    ("s [km], curvature [1/km], cant [mm], gradient [mm/m]", (1e-3 * S, 1e3 * CURVATURE, 1e3 * CANT, 1e3 * GRADIENT), {}),
    ("s [m], radius [m], cant [rad], gradient [rad]", (S, RADIUS, np.arcsin(CANT / 1.5), np.arctan(GRADIENT)), {}),
    ("s [m], radius [km], cant [deg], gradient [deg]", (S, 1e-3 * RADIUS, np.degrees(np.arcsin(CANT / 1.5)), np.degrees(np.arctan(GRADIENT))), {}),
    ("s [m], versine [mm], cant [mm], gradient [mm/m]", (S, 1e3 * VERSINE, 1e3 * CANT, 1e3 * GRADIENT), {"chord": 20.0}),
    ("s [m], curvature [1/km], cant [mm], gradient [mm/m]", (S, -1e3 * CURVATURE, -1e3 * CANT, 1e3 * GRADIENT), {"curve_positive": "left", "cant_positive": "right"}),
    ("s [m], curvature [1/km], cant [mm], gradient [mm/m]", (S, 1e3 * CURVATURE, 1e3 * np.abs(CANT), 1e3 * GRADIENT), {"cant_positive": "outer"}),
])
def test_every_way_to_write_it_is_the_same_line(tmp_path, heading, columns, options):
    found = read_geometry(written(tmp_path, heading, *columns), **options)
    np.testing.assert_allclose(found.curvature, CURVATURE, atol=1e-12)
    np.testing.assert_allclose(found.cant, CANT, atol=1e-12)
    np.testing.assert_allclose(found.gradient, GRADIENT, atol=1e-12)
    track = Track.from_file(tmp_path / "line.csv", name="mine", **options)
    assert track.name == "mine" and track.length == pytest.approx(LINE.length)


def test_options_in_a_track_file_and_a_csv_as_a_track(tmp_path):
    written(tmp_path, "s [m], curvature [1/km], cant [mm]", S, -1e3 * CURVATURE, 1e3 * np.abs(CANT))
    (tmp_path / "line.toml").write_text('[geometry]\nfile = "line.csv"\ncurve_positive = "left"\ncant_positive = "outer"\nsmoothing = [15, "m"]\n')
    track = load_track(tmp_path / "line.toml")
    middle = (S > 150.0) & (S < 210.0)
    np.testing.assert_allclose(track.curvature(S[middle]), -1.0 / 400.0, atol=2e-6)
    assert load_track(tmp_path / "line.csv").curvature(180.0) == pytest.approx(1.0 / 400.0)
    again = track.to_toml(tmp_path / "again.toml")
    assert load_track(tmp_path / "again.toml").to_toml() == again


def test_main_points_of_a_plan_are_joined_by_straight_lines(tmp_path):
    points = np.array([0.0, 60.0, 120.0, 240.0, 360.0, 460.0, 520.0, 580.0])
    path = written(tmp_path, "s [m], radius [m], cant [mm]", points, [0, 0, -400, -400, 600, 600, 0, 0], [0, 0, -120, -120, 80, 80, 0, 0])
    track = Track.from_file(path, interpolation="linear")
    inside = np.linspace(2.0, 578.0, 200)
    away = np.min(np.abs(inside[:, None] - points[None, :]), axis=1) > 1.0       # corners are rounded over 1 m
    np.testing.assert_allclose(track.curvature(inside[away]), LINE.curvature(inside[away]), atol=1e-12)
    np.testing.assert_allclose(track.cant(inside[away]), LINE.cant(inside[away]), atol=1e-12)
    np.testing.assert_allclose(track.frame(580.0).place, LINE.frame(580.0).place, atol=1e-9)
    with pytest.raises(TrackError, match='gap of 120 m between s = 120 and 240 m.*interpolation="linear"'):
        read_geometry(path, largest_gap=100.0)


def test_smoothing_takes_the_noise_and_leaves_the_line():
    """White noise of a record every 2.5 m: what a wavelength of 40 m lets through is a part of 2 x 2.5/40 of its power, and the response's."""
    noise = 1e-4 * np.random.default_rng(1).normal(size=len(S))
    rough = MeasuredGeometry(S, CURVATURE + noise, CANT)
    smooth = rough.smoothed(40.0)
    inside = (S > 50.0) & (S < 540.0)
    left = (smooth.curvature - MeasuredGeometry(S, CURVATURE, CANT).smoothed(40.0).curvature)[inside]
    assert left.std() < 0.45 * noise.std() and left.std() > 0.2 * noise.std()          # sqrt(0.125) = 0.35
    wave = MeasuredGeometry(S, 1e-3 * np.cos(2 * np.pi * S / 40.0)).smoothed(40.0)
    at_crest = wave.curvature[(S > 200.0) & (S < 400.0)].max()
    assert at_crest == pytest.approx(0.5e-3, rel=0.01)
    gone = MeasuredGeometry(S, 1e-3 * np.cos(2 * np.pi * S / 10.0)).smoothed(40.0)
    assert np.abs(gone.curvature[(S > 200.0) & (S < 400.0)]).max() < 2e-6
    turned = np.trapezoid(smooth.curvature - rough.curvature, S)
    assert abs(turned) < 1e-3                                                              # rad: the direction stays
    uneven = np.sort(np.random.default_rng(2).choice(S, 150, replace=False))
    assert np.ptp(np.diff(MeasuredGeometry(uneven, np.interp(uneven, S, CURVATURE)).smoothed(40.0).s)) < 1e-9


@pytest.mark.parametrize("heading, columns, options, message", [
    ("s [m], curvature [1/m]", (S, 1e3 * CURVATURE), {}, "is the unit of curvature right|are the units right"),
    ("s [m], curvature [1/km]", (S, CURVATURE), {}, "curvature is nowhere more than 2.5e-06 1/m, no curve below a radius of 200 km"),
    ("s [m], curvature [1/km], cant [m]", (S, 1e3 * CURVATURE, 1e3 * CANT), {}, "cant = .* are the units right"),
    ("s [m], curvature [1/km], cant [mm]", (S, 1e3 * CURVATURE, CANT), {}, "no cant above 0.2 mm"),
    ("s [m], curvature [1/km], gradient [mm/m]", (S, 1e3 * CURVATURE, GRADIENT), {}, "no gradient above 0.01 per mille"),
    ("s [m], curvature [1/km], gradient [-]", (S, 1e3 * CURVATURE, 1e3 * GRADIENT), {}, "gradient = .* are the units right"),
    ("s [km], curvature [1/km]", (1e2 * S, 1e3 * CURVATURE), {}, "is the unit of s right"),
    ("s [m], curvature [1/km]", (1e-3 * S, 1e3 * CURVATURE), {}, "is the unit of s right"),
    ("s [m], versine [m]", (S, 1e3 * VERSINE), {"chord": 20.0}, "versine = .* are the units right"),
    ("s [m], versine [mm]", (S, 1e3 * VERSINE), {}, "chord=20.0"), ("s [m], radius [m]", (S, RADIUS), {"chord": 20.0}, "belongs to versines"),
    ("s [m], radius [m], curvature [1/m]", (S, RADIUS, CURVATURE), {}, "are curvature and radius"), ("s [m], cant [mm]", (S, CANT), {}, "there is none"),
    ("s [m], curvature [m]", (S, CURVATURE), {}, "wrong dimension"), ("s [m], curvature", (S, CURVATURE), {}, "says no unit"),
    ("s [m], curvature [1/m]", (S[::-1], CURVATURE), {}, "s must increase"),
    ("s [m], curvature [1/m]", (np.delete(S, range(20, 40)), np.delete(CURVATURE, range(20, 40))), {}, "a gap of 52.5 m between s = 47.5 and 100 m"),
    ("s [m], curvature [1/m], cant [mm]", (S, 0.0 * S, 1e3 * np.abs(CANT)), {"cant_positive": "outer"}, "cant of 120 mm on a line without curves"),
    ("s [m], curvature [1/m]", (S, CURVATURE), {"curve_positive": "rigth"}, "nearest: 'right'"),
    ("s [m], curvature [1/m]", (S, CURVATURE), {"smoothing": 4.0}, "wavelength between two steps"),
])
def test_what_is_wrong_is_told(tmp_path, heading, columns, options, message):
    path = written(tmp_path, heading, *columns)
    with pytest.raises(TrackError, match=message) as caught:
        Track.from_file(path, **options)
    assert "line" in str(caught.value)


def test_cant_far_from_any_curve_has_no_outer_rail(tmp_path):
    s = np.arange(0.0, 1001.0, 5.0)
    path = written(tmp_path, "s [m], curvature [1/km], cant [mm]", s, np.where(s > 600.0, 2.0, 0.0), np.where((s > 600.0) | (s < 100.0), 60.0, 0.0))
    with pytest.raises(TrackError, match="cant 60 mm at s = 0 m, 605 m from the nearest curve"):
        read_geometry(path, cant_positive="outer")
    path = written(tmp_path, "s [m], curvature [1/km], cant [mm]", s, np.where(s > 600.0, -2.0, 0.0), np.clip(s - 500.0, 0.0, 60.0))
    assert read_geometry(path, cant_positive="outer").cant[110] == pytest.approx(-0.05)        # a ramp before the curve


def test_named_tracks_are_what_they_say():
    turnout, line, curve = load_track("turnout_300"), load_track("line_20km"), load_track("curve_500")
    assert turnout.curvature(65.0) == pytest.approx(1.0 / 300.0) and turnout.cant(65.0) == 0.0 and turnout.curvature(45.0) == 0.0
    heading = turnout.frame(turnout.length).attitude[:, 0]
    assert np.arctan2(heading[1], heading[0]) == pytest.approx(np.arctan(1 / 9), abs=1e-5)
    assert not len(turnout.jumps)                            # rounded over 1 m: a run can follow
    assert line.length == 20000.0 and len(line.irregularities) == 1
    assert curve.curvature(300.0) == pytest.approx(1 / 500.0) and curve.cant(300.0) == pytest.approx(0.1)
    assert load_track("straight").length == 2000.0


def test_a_run_over_the_diverging_route():
    """Curving without transition: the bogie feels V^2/R at once; sum of Y over the turnout is the mass times it."""
    bogie = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
    found = rs.simulate(bogie, speed=10.0, track=load_track("turnout_300"), duration=17.0,
                        contact=rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435), channels=["s", "*.sum_Y", "car.ay"])
    assert found.status == "completed"
    inside = (found["s"] > 62.0) & (found["s"] < 80.0)
    total = sum(found[name] for name in found.channels.match("*.sum_Y"))
    mass = sum(b.mass + sum(box.mass for box in b.axleboxes) for b in bogie.bodies)
    assert total[inside].mean() == pytest.approx(-mass * 10.0 ** 2 / 300.0, rel=0.1)
