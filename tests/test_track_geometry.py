# SPDX-License-Identifier: BSD-3-Clause
"""Geometry of the track against closed forms, quadrature and finite differences."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import fresnel

import railsym as rs
from railsym.errors import TrackError
from railsym.track import Curve, Gradient, MeasuredGeometry, Straight, Track, Transition, VerticalCurve
from railsym.track.shapes import shape
from railsym.track_frames import UniformTrack, body_motion, relative_pose

KINDS = ("clothoid", "bloss", "cosine", "sine", "helmert")
FORMS = {
    "clothoid": lambda x: x,
    "bloss": lambda x: 3 * x**2 - 2 * x**3,
    "cosine": lambda x: 0.5 * (1 - np.cos(np.pi * x)),
    "sine": lambda x: x - np.sin(2 * np.pi * x) / (2 * np.pi),
    "helmert": lambda x: np.where(x < 0.5, 2 * x**2, 1 - 2 * (1 - x) ** 2),
}


def hilly(kind="bloss", **options):
    """Every kind of section at once."""
    curved = 6000 * (Gradient(1, 0.01).sine - Gradient(1, -0.015).sine)
    return Track([Straight(80), Transition(60, kind), Curve(400, 150, cant=0.12), Transition(90, kind, end_radius=600, end_direction="left", end_cant=0.05),
                  Curve(600, 120, cant=0.05, direction="left"), Transition(50, kind, "cosine"), Straight(100)],
                 vertical=[Gradient(120, 0.01), VerticalCurve(radius=6000), Gradient(650 - 120 - curved, -0.015)],
                 **options)


def away_from_joints(track, count=400, gap=0.01):
    s = np.random.default_rng(5).uniform(track.start + gap, track.length - gap, count)
    joints = np.concatenate([part.joints for part, _ in track.alignment.parts()])
    return s[np.abs(s[:, None] - joints).min(axis=1) > gap]


def derivative(function, s, h=2e-3):
    """Fourth-order central difference."""
    return (8 * (function(s + h) - function(s - h)) - (function(s + 2 * h) - function(s - 2 * h))) / (12 * h)


# --- one section ---------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("radius, direction", [(300.0, "right"), (1000.0, "left"), (np.inf, "right")])
@pytest.mark.parametrize("cant_angle, gradient", [(0.0, 0.0), (0.08, 0.01), (-0.05, -0.03)])
def test_one_section_is_the_uniform_track(radius, direction, cant_angle, gradient):
    sign = {"right": 1.0, "left": -1.0}[direction]
    cant = 1.5 * np.sin(cant_angle)
    section = Curve(radius, 1000, cant=sign * cant, direction=direction) if np.isfinite(radius) else Straight(1000, cant=cant)
    track = Track([section], vertical=[Gradient(1000, np.tan(gradient))])
    uniform = UniformTrack(sign / radius, cant_angle, gradient)
    assert len(track.kinks) == 0
    for s in (-99.0, 0.0, 3.7, 512.3, 1000.0):
        frame = track.frame(s)
        assert np.abs(frame.place - uniform.position(s)).max() < 1e-12      # heading 3.3 to 4e-16, over 600 m, in either
        assert np.abs(frame.attitude - uniform.attitude(s)).max() < 1e-15
        assert np.abs(frame.turning - uniform.turning()).max() < 1e-17 and not frame.turning_rate.any()
        expected, found = body_motion(uniform, 40.0, 0.3, 9.81), frame.motion(40.0, 0.3, 9.81)
        assert found.keys() == expected.keys()
        assert all(abs(found[key] - expected[key]) < 2e-15 for key in expected)
    expected = relative_pose(uniform, 40.0, [403.0, 1.0, -0.5], [422.0, -1.0, -1.6])
    found = track.relative_pose(403.0, 422.0, 40.0, [0, 1.0, -0.5], [0, -1.0, -1.6])
    for key, value in expected.items():
        assert np.abs(found[key] - value).max() < 1e-13, key      # UniformTrack subtracts places of some 400 m


def test_clothoid_ends_where_the_fresnel_integrals_say():
    length, radius = 80.0, 400.0
    track = Track([Transition(length), Curve(radius, 10)], rounding=0)
    unit = np.sqrt(np.pi * length * radius)
    s = np.linspace(0.0, length, 41)
    across, along = (unit * part for part in fresnel(s / unit))
    place = track.frame(s).place
    assert np.abs(place - np.stack([along, across, 0 * s], axis=1)).max() < 5e-14
    assert np.allclose(track.frame(s).attitude[:, 1, 0], np.sin(s**2 / (2 * radius * length)), atol=1e-15, rtol=0)


@pytest.mark.parametrize("radius", [25.0, 250.0])
def test_a_full_circle_closes(radius):
    track = Track([Curve(radius, 2 * np.pi * radius, direction="left")])
    assert np.abs(track.frame(track.length).place).max() < 1e-12 and np.abs(track.frame(track.length).attitude - np.eye(3)).max() < 1e-14
    s = np.linspace(0.0, track.length, 500)
    from_centre = track.frame(s).place[:, :2] + [0.0, radius]      # a curve to the left: y < 0
    assert np.abs(np.hypot(*from_centre.T) - radius).max() < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_shapes_are_their_formulas(kind):
    x = np.linspace(0.0, 1.0, 1001)
    assert np.abs(shape(kind)(x) - FORMS[kind](x)).max() < 3e-13
    assert shape(kind).steps((0,)).size == 0


@pytest.mark.parametrize("kind", KINDS)
def test_a_transition_turns_half_as_much_as_its_curve(kind):
    track = Track([Straight(10), Transition(70, kind), Curve(350, 10, cant=0.1)], rounding=0)
    heading = np.arctan2(*track.frame(80.0).attitude[[1, 0], 0])
    assert heading == pytest.approx(0.5 * 70 / 350, abs=1e-13)
    x = np.linspace(0.0, 1.0, 50)
    assert np.allclose(track.curvature(10 + 70 * x), FORMS[kind](x) / 350, atol=1e-15)
    assert np.allclose(track.cant(10 + 70 * x), 0.1 * FORMS[kind](x), atol=1e-12)


def test_cant_raises_the_left_rail():
    frame = Track([Straight(10, cant=0.15)]).frame(5.0)
    left, right = (frame.place + frame.attitude @ [0.0, side * 0.75, 0.0] for side in (-1.0, 1.0))
    assert right[2] - left[2] == pytest.approx(0.15, abs=1e-15)      # z down
    assert Track([Curve(500, 10, cant=0.1, direction="left")]).cant(5.0) == pytest.approx(-0.1)


def test_height_over_gradients_and_a_vertical_curve():
    track = Track([Straight(400)], vertical=[Gradient(100, 0.02), VerticalCurve(length=200), Gradient(100, -0.01)], rounding=0)
    first, last = (g / np.hypot(1, g) for g in (0.02, -0.01))
    s = np.array([100.0, 200.0, 300.0, 400.0])
    t = np.clip(s - 100, 0, 200)
    height = 100 * first + first * t + (last - first) * t**2 / 400 + last * np.clip(s - 300, 0, None)
    assert np.allclose(-track.frame(s).place[:, 2], height, atol=1e-13)
    assert np.allclose(track.gradient([50.0, 350.0]), [0.02, -0.01], atol=1e-15)


# --- frames, their turning and their poses ---------------------------------------------------------------------------------

@pytest.mark.parametrize("kind", KINDS)
def test_frame_derivatives(kind):
    """o' = P e_x, turning = vee(P^T P'), turning_rate = turning'."""
    track = hilly(kind)
    s = away_from_joints(track)
    frame = track.frame(s)
    assert np.abs(derivative(lambda at: track.frame(at).place, s) - frame.attitude[:, :, 0]).max() < 1e-9
    spin = np.einsum("nji,njk->nik", frame.attitude, derivative(lambda at: track.frame(at).attitude, s))
    vee = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    assert np.abs(vee - frame.turning).max() < 1e-12 and np.abs(frame.turning).max() > 1e-3
    rate = derivative(lambda at: track.frame(at).turning, s)
    assert np.abs(rate - frame.turning_rate).max() < 1e-12 and np.abs(frame.turning_rate).max() > 1e-4
    assert np.abs(np.einsum("nji,njk->nik", frame.attitude, frame.attitude) - np.eye(3)).max() < 2e-15


def test_frames_are_continuous_at_every_joint():
    track = hilly("cosine")
    joints = np.unique(np.concatenate([part.joints for part, _ in track.alignment.parts()]))[1:-1]
    eps = 1e-9
    before, after = track.frame(joints - eps), track.frame(joints + eps)
    assert np.abs(after.place - before.place - 2 * eps * after.attitude[:, :, 0]).max() < 2e-13
    assert np.abs(after.attitude - before.attitude).max() < 1e-11      # 2e-9 m of turning under 4e-3 1/m
    assert np.abs(after.turning - before.turning).max() < 1e-10


def test_pose_rates_are_derivatives_of_the_pose():
    track, speed = hilly(), 37.0
    s = np.random.default_rng(8).uniform(0.0, 620.0, 200)
    s = s[np.abs(s[:, None] + np.array([0.0, 19.0])[:, None, None] - np.concatenate([p.joints for p, _ in track.alignment.parts()])).min(axis=(0, 2)) > 0.01]
    offsets = [0.0, 1.2, -0.7], [0.0, -0.9, -1.8]
    pose = track.relative_pose(s, s + 19.0, speed, *offsets)
    of = lambda key: lambda at: track.relative_pose(at, at + 19.0, speed, *offsets)[key]  # noqa: E731
    assert np.abs(speed * derivative(of("D"), s) - pose["dD"]).max() < 1e-8
    spin = speed * np.einsum("nji,njk->nik", pose["C"], derivative(of("C"), s))
    assert np.abs(np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1) - pose["wf"]).max() < 1e-9


@pytest.mark.parametrize("far", [0.0, 18000.3])
def test_pose_in_a_transition_against_quadrature(far):
    """Level clothoid; 18 km out a difference of rounded places would be off by 4e-12 m."""
    radius, length = 431.7, 87.3
    track = Track([Straight(far + 10.0), Transition(length), Curve(radius, 100.0)])
    for s1 in far + 10.0 + np.array([0.0, 13.7, 60.1]):
        s2, t1 = s1 + 20.0, s1 - (far + 10.0)
        turn = lambda t: (t - t1) * (t + t1) / (2 * radius * length)  # noqa: B023, E731
        nodes, weights = np.polynomial.legendre.leggauss(20)
        expected = [10.0 * weights @ f(turn(t1 + 10.0 * (nodes + 1.0))) for f in (np.cos, np.sin)]
        assert np.abs(track.relative_pose(s1, s2)["D"] - [*expected, 0.0]).max() < 3e-14


def test_the_same_curve_far_out_gives_the_same_pose():
    one = [Transition(50), Curve(300, 100, cant=0.1), Transition(50), Straight(50)]
    track = Track([Straight(50), *(40 * one)])
    s = np.linspace(0.0, 150.0, 100)
    near, far = (track.relative_pose(start + s, start + s + 20.0, 30.0) for start in (50.0, 50.0 + 39 * 250.0))
    for key in near:
        # s itself is only known to 2e-12 there: D turns by 2e-12 m over the radius
        assert np.abs(near[key] - far[key]).max() < 5e-12, key


def test_mirrored_track_is_the_mirror_image_bit_for_bit():
    track = hilly().with_irregularity("erri_b176_high", seed=4).with_switch(start=30, length=12, amplitude=4e-3, rails="left")
    other, s, flip = track.mirrored(), np.linspace(-100.0, 650.0, 3001), np.diag([1.0, -1.0, 1.0])
    a, b = track.frame(s), other.frame(s)
    assert (b.place == a.place @ flip).all() and (b.attitude == flip @ a.attitude @ flip).all()
    assert (b.turning == -a.turning @ flip).all() and (b.turning_rate == -a.turning_rate @ flip).all()
    a, b = track.rails(s), other.rails(s)
    assert (b.right_y == -a.left_y).all() and (b.left_y == -a.right_y).all() and (b.left_z == a.right_z).all()
    assert np.abs(a.left_y).max() > 1e-3 and other.mirrored().to_toml() == track.to_toml()


# --- kinks and rounding ------------------------------------------------------------------------------------------------------

def test_kinks_are_the_ends_of_sections_where_a_derivative_jumps():
    track = Track([Straight(100), Transition(50), Curve(500, 200, cant=0.1), Transition(60, "bloss"), Straight(50)], rounding=0)
    assert np.allclose(track.kinks, [100, 150, 350, 410], atol=1e-12)
    assert np.allclose(track.jumps, [100, 150], atol=1e-12)      # the linear ramp begins with a step of roll rate, a Bloss one does not
    rounded = Track(track.sections)
    assert len(rounded.jumps) == 0 and np.allclose(rounded.kinks, [100, 150, 350, 410])
    assert len(Track([Straight(100), Transition(50, "sine"), Curve(500, 100, cant=0.1)]).kinks) == 0
    assert rounded.core.next_kink(99.9) == 100.0 and rounded.core.next_kink(100.0) == 150.0 and rounded.core.next_kink(410.0) == np.inf


def test_rounding_keeps_the_direction_and_makes_the_turning_continuous():
    sharp, smooth = (Track.turnout(300, length=40, rounding=rounding) for rounding in (0.0, 1.0))
    assert np.allclose(sharp.jumps, [30, 70]) and len(smooth.jumps) == 0
    ends = [track.frame(100.0) for track in (sharp, smooth)]
    assert np.abs(ends[0].attitude - ends[1].attitude).max() < 1e-14
    assert np.abs(ends[0].place - ends[1].place).max() < 1e-3
    s = np.linspace(29.0, 31.0, 2001)
    assert np.abs(np.diff(smooth.frame(s).turning[:, 2])).max() < 1e-5 < np.abs(np.diff(sharp.frame(s).turning[:, 2])).max()


def test_the_track_goes_on_as_it_begins_before_its_start():
    track = Track([Curve(200, 50, cant=0.08)])
    s = np.linspace(-100.0, 50.0, 7)
    assert np.allclose(track.frame(s).place, [UniformTrack(1 / 200).position(at) for at in s], atol=1e-13)
    assert track.start == -100.0 and track.curvature(-100.0) == 1 / 200


# --- measured geometry -------------------------------------------------------------------------------------------------------

def test_measured_geometry_converges_to_the_line_it_was_taken_from():
    """Points of a smooth line: the end's error falls with the fourth power of their distance."""
    curvature = lambda s: 2e-3 * np.sin(s / 70.0)  # noqa: E731
    heading = lambda s: 0.14 * (1 - np.cos(s / 70.0))  # noqa: E731
    exact = np.array([quad(lambda s: f(heading(s)), 0, 400, epsabs=1e-13, limit=200)[0] for f in (np.cos, np.sin)])
    errors = []
    for step in (20.0, 10.0, 5.0):
        s = np.arange(0.0, 401.0, step)
        track = Track(MeasuredGeometry(s + 12000.0, curvature(s), 0.05 * np.sin(s / 70.0)))
        errors.append(np.abs(track.frame(400.0).place[:2] - exact).max())
    assert track.length == 400.0 and errors[-1] < 1e-4
    assert np.log2(errors[1] / errors[2]) > 3.5
    assert track.cant(35.0) == pytest.approx(0.05 * np.sin(0.5), abs=1e-6)
    assert len(track.kinks[track.kinks > 1.0]) == 0      # a cubic spline has none


def test_a_long_measured_line_is_quick_and_small():
    s = np.arange(0.0, 20001.0, 5.0)
    track = Track(MeasuredGeometry(s, 1e-3 * np.sin(s / 200.0), 0.08 * np.sin(s / 200.0)))
    assert np.linalg.norm(track.relative_pose(19900.0, 19920.0)["D"]) == pytest.approx(20.0, abs=0.01)


# --- what does not fit ---------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("make, message", [
    (lambda: Curve(-500, 100), 'direction="left"'),
    (lambda: Curve(0, 100), "radius is positive"),
    (lambda: Curve(5, 100), "units"),
    (lambda: Curve(500, 100, cant=0.35), "cant = 0.35 m"),
    (lambda: Curve(500, 100, cant=np.nan), "not finite"),
    (lambda: Curve(500, 100, direction="rigth"), "nearest: 'right'"),
    (lambda: Straight(0), "above 0 m"),
    (lambda: Straight("10 m"), "not a number"),
    (lambda: Transition(50, "clotoid"), "nearest: 'clothoid'"),
    (lambda: Gradient(50, 5), "gradient = 5"),
    (lambda: VerticalCurve(), "either radius"),
    (lambda: Track([]), "at least one section"),
    (lambda: Track(["straight"]), "none of Straight"),
    (lambda: Track([Straight(10), Curve(500, 100, cant=0.1)]), "cant jumps from 0 to 0.1 m at s = 10 m; put a Transition"),
    (lambda: Track([Straight(10), Transition(50)]), "nothing follows"),
    (lambda: Track([Straight(10), Transition(50), Transition(50), Straight(10)]), "another transition follows"),
    (lambda: Track([Straight(10), Curve(500, 0.4), Straight(10)]), "less than the rounding of 1 m"),
    (lambda: Track([Straight(10), Curve(500, 0.4)]), "before the end of the track"),
    (lambda: Track([Straight(100)], vertical=[Gradient(90, 0.01)]), "90 m long together, the track is 100 m"),
    (lambda: Track([Straight(100)], vertical=[Gradient(50, 0.01), Gradient(50, 0.02)]), "put a VerticalCurve between"),
    (lambda: Track([Straight(100)], vertical=[VerticalCurve(length=100)]), "between two gradients"),
    (lambda: Track(MeasuredGeometry([0, 10, 20, 30], [0, 1, 1, 0])), "curvature = 1 1/m at s = 10 m"),
    (lambda: MeasuredGeometry([0, 10, 10, 30], [0, 0, 0, 0]), "10 m is followed by 10 m"),
    (lambda: MeasuredGeometry([0, 10, 20, 30], [0, 0, np.nan, 0]), r"curvature\[2\] is not finite"),
    (lambda: MeasuredGeometry([0, 10, 20, 30], [0, 0, 0]), "4 values of s, but 3 of curvature"),
    (lambda: rs.Track.turnout(300), "either length"),
])
def test_what_does_not_fit_is_said(make, message):
    with pytest.raises(TrackError, match=message):
        make()


@pytest.mark.parametrize("s, message", [
    (612.5, r"s = 612.5 m lies 112.5 m beyond its end: the track is 500 m long"),
    (-120.0, "20 m before its start"),
    (np.nan, "no place"),
])
def test_a_place_off_the_track_is_named(s, message):
    track = rs.Track.straight(500)
    for ask in (track.frame, track.rails, track.curvature, lambda at: track.relative_pose(10.0, at), lambda at: track.check_run(0.0, at)):
        with pytest.raises(TrackError, match=message):
            ask(s if np.isnan(s) else np.array(s))
    with pytest.raises(TrackError, match=message):
        track.frame([1.0, 2.0, s, 3.0])
