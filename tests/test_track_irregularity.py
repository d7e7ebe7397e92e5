# SPDX-License-Identifier: BSD-3-Clause
"""Irregularities: the generated signals return their spectrum; which rail moves how; files, filters, switches."""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import welch

import railsym as rs
from railsym.errors import TrackError
from railsym.track import MeasuredIrregularity, RandomIrregularity, Straight, Switch, Track, load_spectrum, read_irregularity, spectra
from railsym.track.irregularity import write_irregularity
from railsym.track.layers import SIGNALS, rails_of, signals_of

LONG = 8000.0

# Simpack's polynomial form of the same spectra, S = b0/(a0 + a2 W^2 + W^4): numbers printed there, not derived from the TOML
SIMPACK = {("erri_b176_low", "alignment"): 1.440846e-07, ("erri_b176_high", "alignment"): 4.164787e-07,
           ("erri_b176_low", "vertical"): 2.741619e-07, ("erri_b176_high", "vertical"): 7.343623e-07}


@pytest.mark.parametrize("name, signal", SIMPACK)
def test_spectrum_is_the_published_polynomial(name, signal):
    wavenumber = np.geomspace(0.03, 3.0, 50)
    expected = SIMPACK[name, signal] / (0.00028855 + 0.6803895 * wavenumber**2 + wavenumber**4)
    assert np.allclose(load_spectrum(name).densities[signal](wavenumber), expected, rtol=1e-6)


def test_cant_and_gauge_spectra():
    """Cant is 1.5 m times the angle whose density is (A/b^2) Oc^2 W^2/(...), b = 0.75 m; gauge has its own amplitude."""
    densities, w = load_spectrum("erri_b176_low").densities, np.array([0.1, 0.438, 2.0])
    shape = 0.8246**2 * w**2 / ((w**2 + 0.0206**2) * (w**2 + 0.8246**2) * (w**2 + 0.438**2))
    assert np.allclose(densities["cant"](w), 1.5**2 * 4.032e-7 / 0.75**2 * shape, rtol=1e-12)
    assert np.allclose(densities["gauge"](w), 5.32e-8 * shape, rtol=1e-12)


@pytest.fixture(scope="module")
def measured_density():
    """Mean Welch density of the rails' signals over seeds: wavenumber, and one-sided density (m^2/(rad/m)) of each signal.

    Taken from the track as the wheels see it, by another step than that of its spline.
    """
    step, found = 0.3, []
    for seed in range(6):
        rails = Track.straight(LONG).with_irregularity("erri_b176_low", seed=seed).rails(np.arange(50.0, LONG - 50.0, step))
        signals = np.stack([getattr(rails, name) for name in SIGNALS])
        cycles, density = welch(signals, fs=1.0 / step, nperseg=2048, window="hann")      # one-sided, m^2/(cycles/m)
        found.append(density / (2 * np.pi))
    return 2 * np.pi * cycles, np.mean(found, axis=0)


@pytest.mark.parametrize("signal", SIGNALS)
def test_generated_signal_returns_its_spectrum(measured_density, signal):
    """In bands of a third: a factor of 2 (sides, or rad and cycles) would be seen at once."""
    wavenumber, density = measured_density
    target = load_spectrum("erri_b176_low").densities[signal](np.maximum(wavenumber, 1e-6))
    edges = np.geomspace(2 * np.pi / 60.0, 2 * np.pi / 3.5, 9)
    found = density[SIGNALS.index(signal)]
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        inside = (wavenumber >= low) & (wavenumber < high)
        assert found[inside].sum() / target[inside].sum() == pytest.approx(1.0, abs=0.12)      # few independent values in the longest band: 6 % there
    inside = (wavenumber >= edges[0]) & (wavenumber < edges[-1])
    assert (found[inside] / target[inside]).mean() == pytest.approx(1.0, abs=0.02)


def test_variance_is_the_integral_over_the_band():
    irregularity = RandomIrregularity("erri_b176_high", seed=2)
    _, signals = irregularity.signals(40000.0)
    spectrum = load_spectrum("erri_b176_high")
    for k, name in enumerate(SIGNALS):
        assert signals[:, k].var() == pytest.approx(spectrum.variance(name), rel=0.03)


def test_nothing_outside_the_band():
    step, signals = RandomIrregularity("erri_b176_low", seed=1, wavelengths=(5.0, 40.0)).signals(4096 * 5.0 / 16 - 5.0 / 16)
    window = np.hanning(len(signals))[:, None]
    power = np.abs(np.fft.rfft(signals * window, axis=0)) ** 2
    wavelength = 1.0 / np.maximum(np.fft.rfftfreq(len(signals), step), 1e-9)
    outside = (wavelength > 44.0) | (wavelength < 4.8)
    assert (power[outside].sum(axis=0) < 1e-4 * power.sum(axis=0)).all()


def test_the_sides_of_a_spectrum_are_its_own(tmp_path):
    """The same numbers called two-sided hold twice the variance."""
    text = (Path(rs.__file__).parent / "data/track/erri_b176_low.toml").read_text(encoding="utf-8")
    (tmp_path / "two.toml").write_text(text.replace('"one-sided"', '"two-sided"'))
    one, two = (RandomIrregularity(spectrum, seed=1).signals(1000.0)[1] for spectrum in ("erri_b176_low", str(tmp_path / "two.toml")))
    assert np.allclose(two, np.sqrt(2.0) * one, rtol=1e-12, atol=1e-16)


def test_a_spectrum_given_as_a_table(tmp_path):
    omega = np.geomspace(0.05, 3.0, 40)
    density = 1e-6 / omega**2.5
    rows = [f"[{', '.join(map(repr, map(float, column)))}]" for column in (omega, 1e6 * density)]
    (tmp_path / "line.toml").write_text('name = "line"\nsides = "one-sided"\nwavelengths = [[3, 100], "m"]\n[origins]\n'
                                        f'[vertical]\nwavenumber = [{rows[0]}, "rad/m"]\ndensity = [{rows[1]}, "mm^2*m/rad"]\n')
    spectrum = load_spectrum(str(tmp_path / "line.toml"))
    assert np.allclose(spectrum.densities["vertical"](np.array([0.1, 0.5, 2.0])), 1e-6 / np.array([0.1, 0.5, 2.0]) ** 2.5, rtol=1e-9)
    _, signals = RandomIrregularity(str(tmp_path / "line.toml"), seed=1).signals(300.0)
    assert signals[:, 1].any() and not signals[:, [0, 2, 3]].any()
    with pytest.raises(TrackError, match="covers wavelengths of 2.094 to 125.7 m"):
        Track.straight(300).with_irregularity(str(tmp_path / "line.toml"), seed=1, wavelengths=(1.0, 50.0))


def test_the_same_seed_is_the_same_track():
    s = np.array([60.0, 123.4, 456.7])
    first, again, other = (Track.straight(500).with_irregularity("erri_b176_low", seed=seed).rails(s) for seed in (1, 1, 2))
    assert (first.left_y == again.left_y).all() and not np.isclose(first.left_y, other.left_y).any()
    # stored 2026-11: the random numbers behind them are the same on every machine
    assert np.allclose(first.left_y, STORED[0], rtol=1e-9) and np.allclose(first.right_z, STORED[1], rtol=1e-9)


STORED = [-0.00115265111767136, 0.001009524072949324, -0.0032609691422445354], [0.0005068552194104739, 0.0001699500488242687, 0.00021155692438649365]


def test_signals_are_independent():
    _, signals = RandomIrregularity("erri_b176_low", seed=3).signals(20000.0)
    assert np.abs(np.corrcoef(signals.T) - np.eye(4)).max() < 0.1


def test_it_fades_in_and_out():
    track = Track.straight(400).with_irregularity("erri_b176_high", seed=1, start=50, length=200, fade=30)
    s = np.linspace(-100.0, 400.0, 50001)
    rails = track.rails(s)
    quiet = (s <= 48.0) | (s >= 252.0)
    assert np.abs(rails.left_y[quiet]).max() < 1e-9 and np.abs(rails.left_y[~quiet]).max() > 1e-3
    whole = Track.straight(400).with_irregularity("erri_b176_high", seed=1, start=50, fade=1.0)
    assert track.rails(150.0).left_y == pytest.approx(whole.rails(150.0).left_y, abs=1e-6)
    end = whole.rails([400.0 - 1e-7, 400.0])
    assert np.ptp(end.left_y) < 1e-9 and np.ptp(end.left_y_slope) < 1e-6 and abs(end.left_y_slope[1]) > 1e-6
    assert abs(whole.rails(400.0).left_y) > 1e-5 and len(track.kinks) == 0      # it may run on to the end of the track


@pytest.mark.parametrize("signal, rails", [
    ("alignment", {"left_y": 1.0, "right_y": 1.0}),
    ("vertical", {"left_z": 1.0, "right_z": 1.0}),
    ("cant", {"left_z": -0.5, "right_z": 0.5}),
    ("gauge", {"left_y": -0.5, "right_y": 0.5}),
])
def test_which_rail_moves_how(signal, rails):
    s = np.linspace(0.0, 200.0, 401)
    values = 3e-3 * np.sin(s / 10.0) ** 2
    track = Track.straight(200).with_irregularity(MeasuredIrregularity(s, **{signal: values}))
    found, at = track.rails(s), s > 25.0
    for name in ("left_y", "left_z", "right_y", "right_z"):
        assert np.allclose(getattr(found, name)[at], rails.get(name, 0.0) * values[at], atol=1e-15)
    assert np.allclose(getattr(found, signal)[at], values[at], atol=1e-15)
    signals = np.random.default_rng(1).normal(size=(5, 4))
    assert np.allclose(signals_of(rails_of(signals)), signals, atol=1e-15)


def test_the_rails_are_smooth_and_their_slopes_are_derivatives():
    track = Track.straight(300).with_irregularity("erri_b176_high", seed=1).with_switch(start=100, length=10, amplitude=5e-3, shape="bump")
    s, h = np.random.default_rng(2).uniform(5.0, 295.0, 500), 1e-4
    for name in ("left_y", "left_z", "right_y", "right_z"):
        f = lambda at: getattr(track.rails(at), name)  # noqa: B023, E731
        assert np.abs((f(s + h) - f(s - h)) / (2 * h) - getattr(track.rails(s), f"{name}_slope")).max() < 1e-8
        slope = lambda at: getattr(track.rails(at), f"{name}_slope")  # noqa: B023, E731
        nodes = 3.0 / 16 * np.arange(10, 1500)
        assert np.abs(slope(nodes + 1e-9) - slope(nodes - 1e-9)).max() < 1e-10      # continuous
        curved = [(slope(nodes + d + 1e-6) - slope(nodes + d)) / 1e-6 for d in (-2e-6, 1e-6)]
        assert np.abs(curved[1] - curved[0]).max() < 1e-5 * np.abs(curved[0]).max() + 1e-7      # continuous second derivative


def test_the_spline_keeps_the_shortest_wavelength():
    step, length = 3.0 / 16, 3.0
    s = step * np.arange(800)
    wave = np.cos(2 * np.pi * s / length)
    track = Track([Straight(float(s[-1]))]).with_irregularity(MeasuredIrregularity(s, vertical=1e-3 * wave, fade=10))
    at = np.linspace(30.0, 120.0, 5001)
    assert np.abs(track.rails(at).vertical - 1e-3 * np.cos(2 * np.pi * at / length)).max() < 1e-3 * 1e-4


def test_layers_add_up():
    s, plain = np.linspace(0, 300, 1000), Track.straight(300)
    one, two = plain.with_irregularity("erri_b176_low", seed=1), plain.with_irregularity("erri_b176_low", seed=2, scale=0.5)
    both = one.with_irregularity("erri_b176_low", seed=2, scale=0.5)
    assert np.allclose(both.rails(s).left_y, one.rails(s).left_y + two.rails(s).left_y, atol=1e-17)


# --- measured ------------------------------------------------------------------------------------------------------------------

def test_irregularity_from_a_file(tmp_path):
    s = np.arange(0.0, 300.1, 0.25)
    signals = 1e-3 * np.stack([np.sin(s / (3.0 + k)) for k in range(4)], axis=1)
    write_irregularity(tmp_path / "car.csv", s, rails_of(signals))
    rails = rails_of(signals)
    lines = ["s [km]; left_y [mm]; left_z [mm]; right_y [mm]; right_z [mm]"]
    lines += ["; ".join(f"{v:.12f}".replace(".", ",") for v in (1e-3 * at, *(1e3 * row))) for at, row in zip(s, rails, strict=True)]
    (tmp_path / "rails.csv").write_text("# made for the test\n" + "\n".join(lines))
    tracks = [Track.straight(300).with_irregularity(given) for given in (tmp_path / "car.csv", read_irregularity(tmp_path / "rails.csv"))]
    at = s[(s > 25.0) & (s <= 300.0)]
    for track in tracks:
        found = track.rails(at)
        assert np.allclose(np.stack([getattr(found, name) for name in SIGNALS], axis=1), signals[(s > 25.0) & (s <= 300.0)], atol=1e-12)


def test_uneven_points_are_joined_by_a_spline():
    s = np.cumsum(np.random.default_rng(1).uniform(0.2, 0.6, 800))
    track = Track.straight(250).with_irregularity(MeasuredIrregularity(s, vertical=2e-3 * np.sin(s / 2)))
    at = np.linspace(30, 249, 3000)
    assert np.abs(track.rails(at).vertical - 2e-3 * np.sin(at / 2)).max() < 2e-6


def test_a_band_of_wavelengths():
    s = np.arange(0.0, 2000.0, 0.25)
    wave = lambda length: MeasuredIrregularity(s, vertical=1e-3 * np.sin(2 * np.pi * s / length)).filtered((3.0, 25.0)).vertical[2000:6000]  # noqa: E731
    assert np.abs(wave(10.0) - 1e-3 * np.sin(2 * np.pi * s[2000:6000] / 10.0)).max() < 1e-5      # no shift
    for length, gain in ((25.0, 0.5), (3.0, 0.5), (100.0, 0.0)):
        assert np.abs(wave(length)).max() == pytest.approx(1e-3 * gain, abs=2e-5)


@pytest.mark.parametrize("text, message", [
    ("s [m], vertical [mm]\n0, 0\n100, 1\n150, 1\n", r"ends at s = 150 m, the track at 200 m: it is 50 m too short"),
    ("s [m], vertical [mm]\n0, 0\n100, nan\n200, 1\n", "line 3: .* not finite"),
    ("s [m], vertical [mm]\n0, 0\n100,\n200, 1\n", "line 3: .* is not a row of numbers"),
    ("s [m], vertical [mm]\n0, 0\n100, 1, 3\n200, 1\n", "line 3: 3 numbers, but 2 headings"),
    ("s [m], vertcal [mm]\n0, 0\n200, 1\n", "nearest: 'vertical'"),
    ("s [m], vertical\n0, 0\n200, 1\n", r'says no unit; write "vertical \[m\]"'),
    ("s [m], vertical [kN]\n0, 0\n200, 1\n", "wrong dimension"),
    ("s [m], vertical [m]\n0, 0\n200, 1\n", "beyond 0.1 m; are the units right"),
    ("s [m], vertical [mm], vertical [mm]\n0, 0, 0\n200, 1, 1\n", "there twice"),
    ("s [m], vertical [mm]\n0, 0\n", "1 line of numbers; at least 2"),
    ("", "is empty"),
    ("vertical [mm]\n0\n200\n", "column 's' is missing"),
    ("s [m], vertical [mm]\n0, 0\n50, 1\n40, 1\n200, 2\n", "50 m is followed by 40 m"),
    ("s [m]\n0\n200\n", "give signals"),
    ("s [m], vertical [mm], left_y [mm]\n0, 0, 0\n200, 1, 1\n", "one of the two"),
    ("s [m], vertical [mm]\n300, 0\n400, 1\n", "outside the track from 0 to 200 m"),
])
def test_a_file_that_cannot_be_used_says_why(tmp_path, text, message):
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(TrackError, match=message):
        Track.straight(200).with_irregularity(read_irregularity(tmp_path / "bad.csv"))


@pytest.mark.parametrize("ask, message", [
    (lambda t: t.with_irregularity("erri_b176_lwo", seed=1), "nearest: 'erri_b176_low'"),
    (lambda t: t.with_irregularity("erri_b176_low"), "give a seed"),
    (lambda t: t.with_irregularity("car.csv", seed=1), "is measured"),
    (lambda t: t.with_irregularity("car.csv"), "car.csv: cannot be read"),
    (lambda t: t.with_irregularity("own.toml", seed=1), "own.toml: cannot be read"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1.5), "whole number"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, wavelengths=(30, 3)), "the shortest comes first"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, wavelengths=3), "two numbers in m"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, fade=0), "fade = 0 m"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, fade=300), "shorter than its fading"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, start=150, length=100), "does not lie on the track"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, scale=np.inf), "not finite"),
    (lambda t: t.with_irregularity("erri_b176_low", seed=1, wavelengths=(1e-6, 1)), "make the shortest wavelength longer"),
    (lambda t: t.with_irregularity(3.0), "is none"),
    (lambda t: t.with_switch(start=195, length=10, amplitude=1e-3), "does not lie on the track"),
    (lambda t: t.with_switch(start=10, length=10, amplitude=1.0), "amplitude = 1 m"),
    (lambda t: t.with_switch(start=10, length=10, amplitude=1e-3, shape="halfsine"), "nearest: 'half_sine'"),
    (lambda t: t.with_switch(start=10, length=10, amplitude=1e-3, crossing_depth=1e-3), "a crossing needs"),
])
def test_what_cannot_be_used_says_why(ask, message):
    with pytest.raises(TrackError, match=message):
        ask(Track.straight(200))


def test_spectra_that_come_along():
    assert spectra() == ("erri_b176_high", "erri_b176_low")
    for name in spectra():
        spectrum = load_spectrum(name)
        assert set(spectrum.densities) == set(SIGNALS) and "one-sided" in spectrum.origins["verified"]


# --- switch --------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("shape, function, tolerance", [
    ("half_sine", lambda x: np.sin(np.pi * x), 1e-7),      # nodes 10 mm apart, values as coefficients: h^2/6 of the second derivative
    ("bump", lambda x: 0.5 * (1 - np.cos(2 * np.pi * x)), 1e-9),      # its second derivative jumps at the ends
    ("smooth_step", lambda x: 10 * x**3 - 15 * x**4 + 6 * x**5, 1e-10),
    ("blade", lambda x: np.interp(x, [0, 0.3, 1], [0, 1, 0]), 1e-6),      # rounded at the corners
])
def test_switch_shapes(shape, function, tolerance):
    track = Track.straight(100).with_switch(start=20, length=8, amplitude=6e-3, shape=shape, rails="right")
    s = np.linspace(20.02, 27.98, 3001)
    s = s[np.abs(s - 22.4) > 0.02]
    rails = track.rails(s)
    assert np.abs(rails.right_y - 6e-3 * function((s - 20) / 8)).max() < tolerance and not rails.left_y.any() and not rails.right_z.any()
    before, behind = track.rails([0.0, 19.97]), track.rails([28.03, 60.0, 100.0])
    assert np.abs(before.right_y).max() < 1e-9 and np.abs(behind.right_y - (6e-3 if shape == "smooth_step" else 0.0)).max() < 1e-9
    corners = {"half_sine": [20, 28], "blade": [20, 22.4, 28]}.get(shape, [])
    assert np.allclose(track.kinks, corners, atol=1e-9)


def test_a_crossing_dips_the_moved_rail():
    switch = Switch(10, 5, 4e-3, "blade", rails="left", crossing_start=30, crossing_length=1.0, crossing_depth=3e-3)
    rails = Track.straight(50).with_switch(switch).rails([30.5, 32.0])
    assert rails.left_z == pytest.approx([3e-3, 0.0], abs=1e-9) and not rails.right_z.any() and not rails.left_y.any()
