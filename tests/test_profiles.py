# SPDX-License-Identifier: BSD-3-Clause
"""Profiles from formulas: printed points, angle and curvature against differences, curves through points."""

import csv
from pathlib import Path

import numpy as np
import pytest

import railsym as rs
from railsym.profiles import Profile, ProfileError
from railsym.profiles.formulas import profile_from_zones

DATA = Path(__file__).resolve().parent / "data"
MM = 1e-3


def printed_points():
    with open(DATA / "en15302_points.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: np.array([[float(r["y_mm"]), float(r["z_mm"])] for r in rows if r["profile"] == name]) for name in {r["profile"] for r in rows}}


@pytest.mark.parametrize("name, points", sorted(printed_points().items()), ids=lambda v: v if isinstance(v, str) else "")
def test_reference_profiles_pass_through_their_printed_points(name, points):
    profile = rs.load_profile(name)
    inside = (points[:, 0] > 1e3 * profile.y[0] + 1.0) & (points[:, 0] < 1e3 * profile.y[-1])
    z = np.interp(points[inside, 0], 1e3 * profile.y, 1e3 * profile.z)
    # points printed to 1e-5 mm, zone constants to 1e-4 mm; chords between nodes lie 2e-5 mm off the arc at most
    assert inside.sum() > 25
    np.testing.assert_allclose(z, points[inside, 1], atol=2e-4)


@pytest.mark.parametrize("name", rs.profiles())
def test_angle_and_curvature_are_those_of_the_curve(name):
    profile = rs.load_profile(name)
    sign = -1.0 if profile.kind == "wheel" else 1.0
    chord = np.arctan2(np.diff(profile.z), np.diff(profile.y))
    mean = 0.5 * (profile.angle[1:] + profile.angle[:-1])
    bent = np.abs(np.diff(profile.angle)) > 0.02      # edges between zones, such as a chamfer
    np.testing.assert_allclose(chord[~bent], mean[~bent], atol=0.012)     # zones of wheels A and I miss each other by 5e-4 mm in a chord of 0.05 mm
    turn = sign * np.diff(profile.angle) / np.diff(profile.arc_length)
    between = 0.5 * (profile.curvature[1:] + profile.curvature[:-1])
    step = np.abs(np.diff(profile.curvature)) > 0.5                       # zones meet with a jump of curvature
    np.testing.assert_allclose(turn[~bent & ~step], between[~bent & ~step], atol=1.5, rtol=2e-3)


def test_the_uic60_head_is_rail_a_of_en15302_turned_by_a_twentieth():
    """Two files with different numbers: the arcs of one against the canted arcs of the other."""
    canted, reference = rs.load_profile("UIC60").rotated(-0.05), rs.load_profile("EN15302_rail_A")
    top = [float(p.y[p.z.argmin()]) for p in (canted, reference)]
    inner = reference.y[5:-5:7]
    z = np.interp(inner - top[1] + top[0], canted.y, canted.z) - canted.z.min()
    shallow = np.abs(reference.angle[5:-5:7]) < 1.0
    # constants printed to 1e-5 mm; the top's place is known to 0.05 mm on R300: parallel shift times slope
    assert np.abs(z - reference.z[5:-5:7] + reference.z.min())[shallow].max() < 0.05 * MM * 1.6


def test_60e1_is_not_uic60():
    first, second = (rs.load_profile(name) for name in ("UIC60", "60E1"))
    apart = np.abs(np.interp(first.y, second.y, second.z) - first.z)[np.abs(first.y) < 34 * MM].max()
    assert apart == pytest.approx(0.0405 * MM, abs=0.001 * MM)


def test_s1002_has_the_measures_of_its_name():
    wheel = rs.load_profile("S1002")
    assert wheel.z.max() == pytest.approx(28.0 * MM, abs=1e-6)                           # flange height 28 mm
    below = np.interp(-10.0 * MM, -wheel.z[wheel.z.argmax():][::1], wheel.y[wheel.z.argmax():])
    assert below + 70.0 * MM == pytest.approx(32.5 * MM, abs=0.02 * MM)                  # flange 32.5 mm thick, 10 mm below the tape circle
    assert np.degrees(-wheel.angle.min()) == pytest.approx(70.0, abs=0.01)               # flange angle
    assert np.tan(wheel.angle[-1]) == pytest.approx(-1.0 / 15.0, abs=1e-6)


def test_a_profile_is_read_only_and_turns_about_its_origin():
    rail = rs.load_profile("UIC60")
    with pytest.raises(ValueError):
        rail.y[0] = 0.0
    turned = rail.rotated(0.3)
    np.testing.assert_allclose(np.hypot(turned.y, turned.z), np.hypot(rail.y, rail.z), atol=1e-15)
    assert turned.z[-1] > rail.z[-1]                      # the field side, y > 0, goes down
    np.testing.assert_allclose(turned.angle - rail.angle, 0.3)


def test_zones_that_do_not_meet_are_named():
    zones = [{"type": "polynomial", "from": -10.0, "to": 0.0, "coefficients": [0.0]},
             {"type": "polynomial", "from": 0.0, "to": 10.0, "coefficients": [0.01]}]
    with pytest.raises(ProfileError, match="zones 1 and 2 are 0.0100 mm apart"):
        profile_from_zones("step", "rail", zones)
    with pytest.raises(ProfileError, match="zone 1.*'centre' is missing"):
        profile_from_zones("arc", "rail", [{"type": "arc", "from": 0.0, "to": 1.0}])
    with pytest.raises(ProfileError, match="reaches beyond the circle"):
        profile_from_zones("arc", "rail", [{"type": "arc", "from": 0.0, "to": 2.0, "centre": [0.0, 1.0], "radius": 1.0, "bulge": "up"}])


def test_unknown_names_say_what_there_is():
    with pytest.raises(ProfileError, match="nearest: S1002.*UIC60"):
        rs.load_profile("S1003")
    with pytest.raises(ProfileError, match="is a wheel, and a rail is needed"):
        rs.load_profile("S1002", "rail")
    with pytest.raises(ProfileError, match="is a formula"):
        rs.load_profile("S1002", smoothing=1e-5)


def points_of(name, spacing=0.4 * MM):
    profile = rs.load_profile(name)
    at = np.arange(2e-3, profile.arc_length[-1] - 2e-3, spacing)
    return profile, *(np.interp(at, profile.arc_length, v) for v in (profile.y, profile.z))


@pytest.mark.parametrize("name", ["S1002", "UIC60"])
def test_a_curve_through_points_is_the_curve_they_came_from(name):
    profile, y, z = points_of(name)
    found = Profile.from_points("again", profile.kind, y, z)
    inner = found.y[(found.y > y.min() + 2 * MM) & (found.y < y.max() - 2 * MM)]
    z_found, z_true = (np.interp(inner, p.y, p.z) for p in (found, profile))
    # at a jump of curvature (line to R13) a spline errs like h^2 dk/8 = 1.5 um, h = 0.4 mm; elsewhere a hundred times less
    assert np.abs(z_found - z_true).max() < 1.2e-6
    assert np.median(np.abs(z_found - z_true)) < 1e-9
    assert found.deviation < 1e-9
    assert (np.diff(found.arc_length) > 0.0).all()


def test_smoothing_keeps_its_stated_distance_and_finds_the_curvature():
    profile, y, z = points_of("S1002", 0.25 * MM)
    noise = 10e-6
    rng = np.random.default_rng(3)
    noisy = [v + noise / np.sqrt(2.0) * rng.standard_normal(len(v)) for v in (y, z)]
    found = Profile.from_points("worn", "wheel", *noisy, smoothing=noise)
    fine = np.linspace(0.0, found.arc_length[-1], 40 * len(found.y))           # 1.3 um apart
    curve = [np.interp(fine, found.arc_length, v) for v in (found.y, found.z)]
    rms = np.sqrt(np.mean([np.min((curve[0] - a) ** 2 + (curve[1] - b) ** 2) for a, b in zip(*noisy)]))
    assert rms < 1.05 * noise                                     # the tolerance is kept
    assert 3e-6 < found.deviation < 6 * noise
    tread = np.linspace(-20 * MM, 25 * MM, 200)
    error = np.interp(tread, found.y, found.curvature) - np.interp(tread, profile.y, profile.curvature)
    rough = Profile.from_points("rough", "wheel", *noisy)
    unsmoothed = np.interp(tread, rough.y, rough.curvature) - np.interp(tread, profile.y, profile.curvature)
    # 10 um of noise every 0.25 mm is a curvature of 100 1/m; smoothing finds the tread's to a few 1/m
    assert np.sqrt(np.mean(error**2)) < 4.0 < 30.0 < np.sqrt(np.mean(unsmoothed**2))


def test_smoothing_beyond_reason_is_refused():
    profile, y, z = points_of("S1002")
    for value in (-1e-6, np.nan, 0.02):
        with pytest.raises(ProfileError, match="it must be from 0 to 0.001 m"):
            Profile.from_points("worn", "wheel", y, z, smoothing=value)
