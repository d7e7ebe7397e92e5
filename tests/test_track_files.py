# SPDX-License-Identifier: BSD-3-Clause
"""Track files: what is written is read again to the last bit; what is wrong is named. The drawing shows what the track is."""

import pickle

import matplotlib.pyplot as plt
import numpy as np
import pytest

import railsym as rs
from railsym.errors import TrackError
from railsym.track import (Curve, Gradient, MeasuredGeometry, MeasuredIrregularity, Straight, Switch, Track, Transition, VerticalCurve,
                           load_track, read_geometry)
from railsym.track import tracks as shipped

EXAMPLE = """\
[track]
name = "trial"

[[sections]]
type = "straight"
length = [0.1, "km"]

[[sections]]
type = "transition"
length = [50, "m"]
kind = "bloss"

[[sections]]
type = "curve"
radius = [500, "m"]
length = [200, "m"]
direction = "left"
cant = [100, "mm"]

[[vertical]]
type = "gradient"
length = [350, "m"]
gradient = [5, "mm/m"]

[[irregularities]]
spectrum = "erri_b176_low"
seed = 1
wavelengths = [[3, 70], "m"]

[[switches]]
start = [10, "m"]
length = [8, "m"]
amplitude = [4, "mm"]
shape = "bump"
"""


def written(tmp_path, text):
    (tmp_path / "trial.toml").write_text(text, encoding="utf-8")
    return tmp_path / "trial.toml"


def tracks():
    s = np.arange(0.0, 300.1, 0.7)
    sections = [Straight(50), Transition(40, "cosine", "bloss"), Curve(700, 100, 0.05), Transition(60, end_radius=np.inf, end_cant=0.01)]
    plain = Track([*sections, Straight(60, cant=0.01)],
                  vertical=[Gradient(100, 0.003), VerticalCurve(length=70), Gradient(140, -0.001)], rounding=0.5, name='a "b" \\ \u00e4')
    yield plain
    yield plain.with_irregularity("erri_b176_high", seed=7, wavelengths=(2.5, 80), start=10, length=200, fade=12.5, scale=0.3).mirrored()
    yield plain.with_switch(Switch(5, 6, -3e-3, "blade", "left", crossing_start=30, crossing_length=1, crossing_depth=2e-3))
    yield Track(MeasuredGeometry(s, 1e-3 * np.sin(s / 50), 0.03 * np.sin(s / 50), 0.002 * np.cos(s / 90), name="line 7"), name="line")
    yield Track.straight(200).with_irregularity(MeasuredIrregularity(s, gauge=1e-3 * np.sin(s), alignment=1e-3 * np.cos(s), fade=5, covers=False, name="car"))
    yield Track.straight(200).with_irregularity(MeasuredIrregularity(s, left_y=1e-3 * np.sin(s)))


@pytest.mark.parametrize("track", list(tracks()))
def test_what_is_written_is_read_again(track, tmp_path):
    text = track.to_toml(tmp_path / "track.toml")
    again = rs.load_track(tmp_path / "track.toml")
    assert again.to_toml() == text and again.name == track.name and again.length == track.length
    s = np.linspace(-100.0, track.length, 777)
    for name, value in vars(track.frame(s)).items():
        assert (getattr(again.frame(s), name) == value).all(), name
    for name, value in vars(track.rails(s)).items():
        assert (getattr(again.rails(s), name) == value).all(), name
    assert (again.kinks == track.kinks).all()


def test_a_track_goes_to_other_processes():
    track = Track.straight(100).with_irregularity("erri_b176_low", seed=1)
    again = pickle.loads(pickle.dumps(track))
    assert (again.rails([30.0, 70.0]).left_y == track.rails([30.0, 70.0]).left_y).all() and again.to_toml() == track.to_toml()


def test_a_track_file_says_what_it_says(tmp_path):
    track = load_track(written(tmp_path, EXAMPLE))
    assert track.sections == (Straight(100.0), Transition(50.0, "bloss"), Curve(500.0, 200.0, 0.1, "left"))
    assert track.name == "trial" and track.irregularities[0].wavelengths == (3.0, 70.0) and track.switches[0] == Switch(10.0, 8.0, 4e-3, "bump")
    assert track.curvature(300.0) == -1 / 500 and track.cant(300.0) == pytest.approx(-0.1) and track.gradient(100.0) == pytest.approx(0.005)


@pytest.mark.parametrize("old, new, message", [
    ('radius = [500, "m"]', 'radius = [-500, "m"]', r'trial.toml: sections\[3\]: curve: radius = -500 m: a radius is positive'),
    ('cant = [100, "mm"]', 'cant = [100, "m"]', r"sections\[3\]: curve: cant = 100 m is outside"),
    ('cant = [100, "mm"]', 'cant = [100, "kN"]', r"sections\[3\].cant = .*wrong dimension: allowed are 'm', 'mm'"),
    ('cant = [100, "mm"]', "cant = 0.1", r'sections\[3\].cant = 0.1: a number is written \[value, "unit"\]'),
    ('cant = [100, "mm"]', 'cnat = [100, "mm"]', r"sections\[3\].cnat: key is unknown; nearest: 'cant'"),
    ('cant = [100, "mm"]', 'cant = [nan, "mm"]', r"sections\[3\].cant = .* is not a number"),
    ('cant = [100, "mm"]', 'cant = [[1, 2], "mm"]', "a single number is needed"),
    ('cant = [100, "mm"]', 'cant = [100, "mn"]', "which is not one of"),
    ('kind = "bloss"', 'kind = "blos"', r"sections\[2\]: transition: kind 'blos' is unknown; nearest: 'bloss'"),
    ('kind = "bloss"', "kind = 3", r"sections\[2\].kind = 3: a text is needed"),
    ('type = "curve"', 'type = "curv"', r"sections\[3\].type = 'curv': unknown; nearest: 'curve'"),
    ('type = "curve"', "", r"sections\[3\].type: is missing; allowed: straight, curve, transition"),
    ('radius = [500, "m"]', "", r"sections\[3\].radius: is missing"),
    ("seed = 1", "seed = 1.0", "a whole number is needed"),
    ("seed = 1", "", r"irregularities\[1\].seed: is missing"),
    ('"erri_b176_low"', '"erri_b176_lo"', r"irregularities\[1\]: spectrum 'erri_b176_lo' is unknown; nearest: 'erri_b176_low'"),
    ("[[3, 70]", "[[3, 70, 90]", "a list of 2 numbers is needed"),
    ("[[switches]]", "[[swiches]]", "nearest: 'switches'"),
    ("[[switches]]", "[switches]", r"a list of tables is needed: \[\[switches\]\]"),
    ("[[switches]]", '[geometry]\nfile = "x.csv"\n[[switches]]', "give either"),
    ('length = [350, "m"]', 'length = [300, "m"]', "trial.toml: track: the vertical sections are 300 m long together"),
    ('name = "trial"', "name = ", "cannot be read"),
    ('spectrum = "erri_b176_low"\nseed = 1\nwavelengths = [[3, 70], "m"]', 'file = "no.csv"', r"irregularities\[1\]: .*no.csv: cannot be read"),
])
def test_what_is_wrong_in_a_file_is_named(tmp_path, old, new, message):
    assert old in EXAMPLE
    with pytest.raises(TrackError, match=message):
        load_track(written(tmp_path, EXAMPLE.replace(old, new)))


def test_tracks_that_come_along():
    assert shipped() == ("curve_500", "line_20km", "s_curve_500", "straight", "straight_erri_high", "straight_erri_low", "turnout_300")
    for name in shipped():
        track = rs.load_track(name)
        assert track.name == name and len(track.jumps) == 0
    # what its head says: 1.05 m/s^2 left at 105 km/h
    track = rs.load_track("s_curve_500")
    frame, speed = track.frame(300.0), 105 / 3.6
    assert speed**2 * frame.turning[2] - frame.gravity(9.81)[1] == pytest.approx(1.05, abs=0.01)
    with pytest.raises(TrackError, match="nearest: 's_curve_500'"):
        rs.load_track("s_curve_50")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(TrackError, match="no.toml: cannot be read .No such file"):
        load_track(tmp_path / "no.toml")


def test_measured_geometry_from_a_file(tmp_path):
    s = np.arange(0.0, 500.1, 10.0)
    curvature, cant, gradient = 2e-3 * np.sin(s / 80), 0.06 * np.sin(s / 80), 0.004 * np.cos(s / 100)
    rows = "\n".join(", ".join(f"{v:.12f}" for v in row) for row in zip(12.0 + 1e-3 * s, 1e3 * curvature, 1e3 * cant, 1e3 * gradient, strict=True))
    (tmp_path / "line.csv").write_text("s [km], curvature [1/km], cant [mm], gradient [mm/m]\n" + rows)
    (tmp_path / "line.toml").write_text('[track]\nname = "line"\n[geometry]\nfile = "line.csv"\n')
    for track in (Track.from_file(tmp_path / "line.csv"), load_track(tmp_path / "line.toml")):
        assert track.length == pytest.approx(500.0, abs=1e-9) and track.name == "line"
        assert np.allclose(track.curvature(s[1:-1]), curvature[1:-1], atol=1e-9) and np.allclose(track.cant(s[1:-1]), cant[1:-1], atol=1e-9)
        assert np.allclose(track.gradient(s[1:-1]), gradient[1:-1], atol=1e-9)
    (tmp_path / "short.csv").write_text("s [m], curvature [1/km]\n0, 0\n10, 1\n20, 0\n")
    with pytest.raises(TrackError, match="3 points; at least 4"):
        read_geometry(tmp_path / "short.csv")
    (tmp_path / "other.csv").write_text("s [m], curvture [1/km]\n0, 0\n10, 1\n20, 0\n")
    with pytest.raises(TrackError, match="nearest: 'curvature'"):
        read_geometry(tmp_path / "other.csv")


def test_what_cannot_be_written_is_said(tmp_path):
    with pytest.raises(TrackError, match="cannot be written"):
        rs.Track.straight(10).to_toml(tmp_path / "none" / "x.toml")


def test_drawing(tmp_path):
    track = Track.s_curve(500, 100, transition=40, cant=0.1)
    axes = track.plot()
    assert set(axes) == {"curvature", "cant", "gradient", "plan"}
    line = max((one for one in axes["curvature"].lines if len(one.get_xdata()) > 2), key=lambda one: len(one.get_xdata()))
    assert np.allclose(line.get_ydata(), 1e3 * track.curvature(line.get_xdata()))
    assert axes["curvature"].get_ylabel() == "1/km" and axes["plan"].yaxis_inverted()
    plan = axes["plan"].lines[0].get_xydata()
    assert np.allclose(plan[-1], track.frame(track.length).place[:2])
    plt.close("all")
    axes = track.with_irregularity("erri_b176_low", seed=1).plot(path=tmp_path / "track.png", title="trial")
    assert {"lateral", "vertical"} <= set(axes) and (tmp_path / "track.png").stat().st_size > 10000
    assert [text.get_text() for text in axes["lateral"].get_legend().get_texts()] == ["alignment, + to the right", "gauge, + wider"]
    assert not plt.get_fignums()
