# SPDX-License-Identifier: BSD-3-Clause
"""Runs: channels by name, selection, metadata, spectrum."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railsym as rs
from railsym.results import Channel, Ending, ResultError, RunInfo, UnknownChannelError
from railsym.results.spectrum import amplitude_spectrum


def a_run(count=200, rate=100.0):
    time = np.arange(count) / rate
    channels = [Channel("bogie1.y", "m", "lateral position", "bogie1"), Channel("wheelset1.left.Y", "N"), Channel("wheelset1.right.Y", "N"),
                Channel("wheelset1.left.Q", "N"), Channel("wheelset1.left.YQ", "-")]
    values = np.random.default_rng(1).normal(size=(count, len(channels)))
    return rs.Run(time, values, channels, RunInfo(vehicle="pendolino", speed=60.0))


def test_channels_by_name_with_unit_and_place():
    run = a_run()
    assert run["bogie1.y"].shape == (200,) and run["bogie1.y"].dtype == np.float64
    assert run.unit("bogie1.y") == "m" and run.channels["bogie1.y"].place == "bogie1"
    assert run["time"] is run.time and run.unit("time") == "s" and "bogie1.y" in run and "bogie9.y" not in run


def test_values_cannot_be_changed_by_accident():
    with pytest.raises(ValueError, match="read-only"):
        a_run()["bogie1.y"][0] = 1.0


def test_patterns_select_channels_in_order():
    run = a_run()
    assert run.channels.match("*.Y") == ("wheelset1.left.Y", "wheelset1.right.Y")
    assert tuple(run.select("*.right.*", "bogie?.y").channels) == ("bogie1.y", "wheelset1.right.Y")
    assert run.channels.match("nothing*") == ()
    np.testing.assert_array_equal(run.select("*.Y")["wheelset1.right.Y"], run["wheelset1.right.Y"])


def test_an_unknown_channel_gives_near_names_and_the_list():
    with pytest.raises(KeyError) as caught:
        a_run()["bogie1.yy"]
    assert isinstance(caught.value, rs.RailsymError)
    assert str(caught.value) == ("there is no channel 'bogie1.yy'; near: bogie1.y; there are 5: bogie1.y, wheelset1.left.Y, wheelset1.right.Y, "
                                 "wheelset1.left.Q, wheelset1.left.YQ")
    with pytest.raises(UnknownChannelError, match=r"no channel fits '\*\.Z'"):
        a_run().select("*.Y", "*.Z")


def test_a_long_list_of_channels_is_shortened_by_kind():
    channels = [Channel(f"body{k}.{c}", "m") for k in range(50) for c in "xyz"]
    run = rs.Run(np.arange(2.0), np.zeros((2, 150)), channels)
    with pytest.raises(UnknownChannelError, match=r"there are 150: body0\.x \.\.\. body49\.x, body0\.y \.\.\. body49\.y, body0\.z \.\.\. body49\.z$"):
        run["nothing"]


def test_between_takes_both_ends():
    run = a_run()
    part = run.between(0.5, 0.75)
    assert part.time[0] == 0.5 and part.time[-1] == 0.75 and len(part) == 26
    np.testing.assert_array_equal(part["bogie1.y"], run["bogie1.y"][50:76])
    assert len(run.between(-np.inf, np.inf)) == 200
    for span in ((3.0, 4.0), (0.503, 0.507), (0.6, 0.5)):
        with pytest.raises(ResultError, match="no sample lies between"):
            run.between(*span)


@pytest.mark.parametrize("time, values, message", [
    ([0.0, 1.0, 1.0], [1, 2, 3], r"time does not increase: 1 s is followed by 1 s \(sample 2\)"),
    ([0.0, np.nan, 1.0], [1, 2, 3], "time is not finite at sample 1"),
    ([0.0, 1.0], [1, 2, 3], r"channel a has shape \(3,\), time has \(2,\)"),
    ([0.0, 1.0], ["1", "2"], "real numbers are needed"),
    ([0.0, 1.0], [1j, 2], "real numbers are needed"),
    ([[0.0, 1.0]], [1, 2], r"time has shape \(1, 2\)"),
])
def test_what_does_not_fit_together_is_refused(time, values, message):
    with pytest.raises(ResultError, match=message):
        rs.Run(time, {"a": np.array(values)}, [Channel("a", "m")])


def test_names_units_and_counts_are_checked():
    for name in ("a b", "time", "", "1a", "a/b", "a,b"):
        with pytest.raises(ResultError, match="channel name"):
            Channel(name, "m")
    with pytest.raises(ResultError, match="'-' for a pure number"):
        Channel("a", "")
    with pytest.raises(ResultError, match="given twice"):
        rs.Run([0.0], np.zeros((1, 2)), [Channel("a", "m"), Channel("a", "m")])
    with pytest.raises(ResultError, match=r"\(1, 2\) is needed"):
        rs.Run([0.0], np.zeros((2, 1)), [Channel("a", "m"), Channel("b", "m")])
    with pytest.raises(ResultError, match="no unit is given for b"):
        rs.Run.from_arrays([0.0], {"a": [1.0], "b": [1.0]}, {"a": "m"})
    with pytest.raises(UnknownChannelError, match="values are given for 'b'"):
        rs.Run([0.0], {"a": [1.0], "b": [2.0]}, [Channel("a", "m")])


def test_ending_in_words():
    assert str(Ending("derailed", "wheelset3.left", 1.204, 72.24)) == "derailed (wheelset3.left) at t = 1.204 s, s = 72.24 m"
    assert str(Ending("not_converged", time=0.5, detail="bogie1.yaw")) == "did not converge at t = 0.5 s: bogie1.yaw"
    with pytest.raises(ResultError, match="completed, derailed, not_converged, interrupted"):
        Ending("finished")
    run = a_run().with_info(ending=Ending("derailed", "wheelset3.left", 1.2, 72.0), message="wheel climb")
    assert run.status == "derailed" and run.message == "wheel climb" and "derailed (wheelset3.left)" in repr(run)


def test_metadata_hold_what_json_holds():
    info = RunInfo(parameters={"a.b": np.float64(0.1), "c": np.arange(3)}, extra={"wheel_loads": {"w.left": 55e3}}, speed=np.float64(60))
    assert info.parameters == {"a.b": 0.1, "c": [0, 1, 2]} and RunInfo.from_json(info.to_json()) == info
    assert info.railsym_version == rs.__version__
    with pytest.raises(ResultError, match="metadata extra.x: object cannot be saved"):
        RunInfo(extra={"x": object()})


def test_metadata_of_a_newer_railsym_are_kept():
    text = RunInfo(vehicle="v").to_json().replace('"vehicle"', '"wind": 3.0, "vehicle"')
    assert RunInfo.from_json(text).extra == {"wind": 3.0}


def test_uniform_step_or_where_it_is_not():
    assert a_run().step == pytest.approx(0.01, rel=1e-12)
    time = np.append(np.arange(100) / 1024, 0.1)
    run = rs.Run(time, {"a": np.zeros(101)}, [Channel("a", "m")])
    with pytest.raises(ResultError, match=r"a step of 0.00332031 s at t = 0.0966797 s.*run\.resampled\(1024\)"):
        run.step
    far = rs.Run(1e6 + np.arange(1000) * 1e-3, {"a": np.zeros(1000)}, [Channel("a", "m")])
    assert far.step == pytest.approx(1e-3, rel=1e-6)


def test_resampling_a_landed_step():
    time = np.sort(np.append(np.arange(1001) * 1e-3, 0.50037))
    run = rs.Run(time, {"a": np.sin(2 * np.pi * 5 * time)}, [Channel("a", "m")]).resampled(1000 * 1.001)
    assert run.step == pytest.approx(1 / 1001.0)
    # PCHIP on 200 points a period: second order at the crests, h^2 w^2/8
    np.testing.assert_allclose(run["a"], np.sin(2 * np.pi * 5 * run.time), atol=2e-4)
    with pytest.raises(ResultError, match="below the run's mean rate of 1001 Hz"):
        run.resampled(500.0)


@settings(max_examples=25, deadline=None)
@given(frequency=st.floats(1.0, 20.0), amplitude=st.floats(0.1, 50.0), phase=st.floats(0.0, 6.28), offset=st.floats(-100.0, 100.0))
def test_spectrum_of_a_sine_between_two_lines(frequency, amplitude, phase, offset):
    time = np.arange(4000) * 2.5e-3
    found = amplitude_spectrum(time, offset + amplitude * np.sin(2 * np.pi * frequency * time + phase))
    # the line at the negative frequency leaks in: Hann side lobes at 20 lines are 1e-4 of the peak
    assert found.dominant_hz == pytest.approx(frequency, abs=2e-3 * found.resolution_hz)
    assert found.dominant_amplitude == pytest.approx(amplitude, rel=1e-3)


def test_spectrum_names_the_dominant_frequency_of_the_band():
    time = np.arange(10_000) * 1e-3
    run = rs.Run.from_arrays(time, {"a": 3 * np.sin(2 * np.pi * 1.3 * time) + np.sin(2 * np.pi * 5.25 * time)}, {"a": "m/s^2"})
    found = run.spectrum("a", band=(4, 8))
    assert found.message == "a: 5.250 Hz dominates between 4 and 8 Hz, amplitude 1 m/s^2"
    assert run.spectrum("a").dominant_hz == pytest.approx(1.3, abs=1e-3)
    assert run.spectrum("a", start=5.0).resolution_hz == pytest.approx(0.4, rel=1e-3)
    line = np.argmin(np.abs(found.frequency - 1.3))
    assert found.amplitude[line] == pytest.approx(3.0, rel=1e-3)
    assert "nothing moves" in amplitude_spectrum(time, np.full(10_000, 2.0)).message


def test_a_spectrum_that_cannot_be_says_what_is_needed():
    time = np.arange(100) * 0.05
    flat = np.zeros(100)
    with pytest.raises(ResultError, match="sampled at 20 Hz; a band up to 12 Hz needs at least 24 Hz"):
        amplitude_spectrum(time, flat, (4, 12))
    with pytest.raises(ResultError, match="5 s long; to look between 4 and 4.2 Hz at least 10 s are needed"):
        amplitude_spectrum(time, flat, (4.0, 4.2))
    with pytest.raises(ResultError, match="not finite at t = 0.15 s"):
        amplitude_spectrum(time, np.where(time == time[3], np.nan, 0.0))
    with pytest.raises(ResultError, match="at least 16"):
        amplitude_spectrum(time[:5], flat[:5])


def test_plots_draw_what_was_asked():
    run = a_run()
    panels = run.plot(["*.Y", "bogie1.y"])
    assert [panel.get_ylabel() for panel in panels] == ["y, m", "Y, kN"]
    assert [len(panel.lines) for panel in panels] == [1, 2]
    np.testing.assert_array_equal(panels[1].lines[1].get_ydata(), 1e-3 * run["wheelset1.right.Y"])
    time = np.arange(3000) * 4e-3
    between = rs.Run.from_arrays(time, {"a": np.sin(2 * np.pi * 5.54 * time)}, {"a": "m"}).spectrum("a", band=(0.5, 12.0))
    panel = between.plot()
    assert panel.get_ylabel() == "amplitude, m" and panel.get_ylim()[1] > between.dominant_amplitude > between.amplitude.max()
