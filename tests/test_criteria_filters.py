# SPDX-License-Identifier: BSD-3-Clause
"""Filters, sliding windows and percentiles against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railsym as rs
from railsym.criteria import Butterworth, CriterionError, percentile_analysis, sliding_mean, sliding_rms

criteria = rs.criteria
RATE = 500.0
TIME = np.arange(10_000) / RATE


@pytest.mark.parametrize("low, high", [(0.0, 20.0), (4.0, 8.0), (0.4, 10.0)])
@pytest.mark.parametrize("order", [2, 4, 8])
@pytest.mark.parametrize("zero_phase", [True, False])
def test_minus_3_db_at_the_cut_offs_of_what_comes_out(low, high, order, zero_phase):
    one = Butterworth(low, high, order, zero_phase)
    edges = [f for f in (low, high) if f]
    np.testing.assert_allclose(np.abs(one.response(edges, RATE)), np.sqrt(0.5), rtol=1e-9)
    centre = 0.0 if not low else np.arctan(np.sqrt(np.prod(np.tan(np.pi * np.array([low, high]) / RATE)))) * RATE / np.pi
    assert abs(one.response([centre], RATE)[0]) == pytest.approx(1.0, abs=1e-8)


def test_slope_is_that_of_the_order():
    """An octave further out, far from the cut-off, the gain falls by 2^order, run once or twice."""
    for zero_phase in (True, False):
        far = np.abs(Butterworth(0.0, 2.0, 4, zero_phase).response([20.0, 40.0], 5000.0))
        assert far[0] / far[1] == pytest.approx(16.0, rel=0.02)


def test_causal_filter_is_scipys_own():
    from scipy import signal

    frequency = np.linspace(1.0, 20.0, 40)
    sections = signal.butter(4, (4.0, 8.0), "bandpass", fs=RATE, output="sos")
    np.testing.assert_allclose(Butterworth(4.0, 8.0, 4, False).response(frequency, RATE), signal.freqz_sos(sections, frequency, fs=RATE)[1],
                               rtol=1e-9)


@pytest.mark.parametrize("low, high", [(0.0, 20.0), (4.0, 8.0), (0.4, 10.0)])
@settings(max_examples=20, deadline=None)
@given(frequency=st.floats(1.0, 30.0), amplitude=st.floats(0.1, 100.0), phase=st.floats(0.0, 6.28))
def test_a_sine_comes_out_with_the_gain_of_the_response(low, high, frequency, amplitude, phase):
    """Away from the ends, where the filter still swings in."""
    one = Butterworth(low, high)
    wave = np.sin(2 * np.pi * frequency * TIME + phase)
    out = one.apply(amplitude * wave, RATE)
    inner = slice(3000, 7000)
    gain = abs(one.response([frequency], RATE)[0])
    np.testing.assert_allclose(out[inner], amplitude * gain * wave[inner], atol=2e-4 * amplitude)


def test_a_filter_that_cannot_be_says_what_is_needed():
    with pytest.raises(CriterionError, match="needs a sampling rate of at least 40 Hz; the signal has 30 Hz"):
        Butterworth(4.0, 8.0).apply(np.zeros(1000), 30.0)
    with pytest.raises(CriterionError, match="ay: filter Butterworth 4 to 8 Hz, order 4, zero phase needs at least 0.75 s; the signal is 0.198 s"):
        Butterworth(4.0, 8.0).apply(np.zeros(100), RATE, "ay")
    for wrong in ((8.0, 4.0), (-1.0, 4.0), (0.0, np.inf)):
        with pytest.raises(CriterionError, match="0 <= low < high"):
            Butterworth(*wrong)
    with pytest.raises(CriterionError, match="an even one with zero_phase"):
        Butterworth(4.0, 8.0, 3)


def test_sliding_mean_of_a_step_is_a_ramp_over_the_window():
    """A step from 0 to 3 between 50 and 50.001 m: the mean over 2 m rises linearly from 49 m to 51 m."""
    distance = np.array([0.0, 10.0, 50.0, 50.001, 70.0, 100.0])
    middle, mean = sliding_mean(distance, np.array([0.0, 0.0, 0.0, 3.0, 3.0, 3.0]))
    np.testing.assert_allclose(np.diff(middle), 0.5)
    assert (middle[0], middle[-1]) == (1.0, 99.0)
    np.testing.assert_allclose(mean, 3.0 * np.clip((middle + 1.0 - 50.0005) / 2.0, 0.0, 1.0), atol=1e-3)
    inside = np.argmin(np.abs(middle - 50.0))
    assert mean[inside] == pytest.approx(1.5 - 3 * 0.0005 / 2, rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(0.01, 2.0), min_size=8, max_size=40), st.floats(-5, 5), st.floats(-5, 5), st.floats(0.3, 2.0))
def test_sliding_mean_of_a_straight_line_is_its_middle(gaps, slope, offset, length):
    """Exact for any spacing of the samples."""
    distance = np.cumsum([0.0, *gaps])
    if distance[-1] < length:
        return
    middle, mean = sliding_mean(distance, offset + slope * distance, length, 0.25)
    np.testing.assert_allclose(mean, offset + slope * middle, atol=1e-9)
    assert middle[-1] + 0.5 * length <= distance[-1] + 1e-9 and middle[-1] + 0.5 * length > distance[-1] - 0.25 - 1e-9


def test_sliding_rms_of_a_sine_over_whole_periods():
    distance = np.arange(0.0, 500.0, 0.01)
    _, rms = sliding_rms(distance, 4.0 * np.sin(2 * np.pi * distance / 10.0), 100.0, 10.0)
    np.testing.assert_allclose(rms, 4.0 / np.sqrt(2.0), rtol=1e-5)
    with pytest.raises(CriterionError, match="a window of 100 m needs at least that distance; the record covers 49.99 m"):
        sliding_rms(distance[:5000], distance[:5000])


def test_percentiles_of_known_distributions_by_section():
    """Uniform on 0..1 sampled evenly: the percentile is its own value; a section scaled by two gives twice that."""
    distance = np.arange(2000.0)
    values = np.concatenate((np.linspace(0, 1, 1000), np.linspace(0, -2, 1000)))
    found = percentile_analysis(distance, values, (0.15, 50.0, 99.85), [(0, 999), (1000, 1999)])
    np.testing.assert_allclose(found.values, [[0.0015, 0.5, 0.9985], [-1.997, -1.0, -0.003]], atol=1e-12)
    assert found.largest == pytest.approx(-1.997)
    normal = np.random.default_rng(3).normal(2.0, 0.5, 200_000)
    tails = percentile_analysis(np.arange(200_000.0), normal).values[0]
    # 2.9677 standard deviations hold 99.7 %; the percentile of 200,000 draws scatters by 0.016 of one
    np.testing.assert_allclose(tails, [2.0 - 2.9677 * 0.5, 2.0 + 2.9677 * 0.5], atol=0.03)


def test_estimated_largest_value_over_sections():
    values = np.repeat([1.0, 2.0, 3.0, 2.0], 100)
    found = percentile_analysis(np.arange(400.0), values, (99.85,), 100.0 - 1e-9)
    assert len(found.sections) == 3 or len(found.sections) == 4
    found = percentile_analysis(np.arange(400.0), values, (99.85,), [(0, 99), (100, 199), (200, 299), (300, 399)])
    assert found.mean[0] == 2.0 and found.deviation[0] == pytest.approx(np.sqrt(2 / 3))
    assert found.estimated(2.2)[0] == pytest.approx(2.0 + 2.2 * np.sqrt(2 / 3))
    with pytest.raises(CriterionError, match="at least 2 are needed"):
        percentile_analysis(np.arange(400.0), values).estimated()


@pytest.mark.parametrize("sections, message", [
    (1000.0, "the record covers 399 m; at least one section must fit"), (-1.0, "at least one section"), ([(0, 10, 20)], "pairs of start and end"),
    ([(10, 0)], "pairs of start and end"), ([(900, 950)], "section 900 to 950 m has no sample; the signal covers 0 to 399 m")])
def test_sections_that_do_not_fit(sections, message):
    with pytest.raises(CriterionError, match=message):
        percentile_analysis(np.arange(400.0), np.zeros(400), sections=sections)


def test_every_limit_has_unit_edition_trust_and_origin():
    for name, limit in criteria.limits().items():
        assert limit.unit and limit.edition and limit.origin and limit.meaning and limit.trust in ("V1", "V2", "R"), name
        assert (limit.trust == "R") == ("recalled" in limit.origin), name
    with pytest.raises(CriterionError, match="there is no limit 'YQQ'; near: YQ"):
        criteria.limits("YQQ")


def test_limits_are_what_the_project_recorded():
    from railsym.criteria.limits import sum_Y_limit, wheel_load_limit

    assert criteria.limits("YQ").value == 0.8 and criteria.limits("frame_acceleration").value == 8.0
    assert sum_Y_limit(66e3).value == pytest.approx(10e3 + 132e3 / 3)
    assert sum_Y_limit(66e3, 0.85).value == pytest.approx(0.85 * (10e3 + 132e3 / 3)) and sum_Y_limit(66e3).trust == "R"
    assert wheel_load_limit(66e3, 200 / 3.6).value == 156e3
    assert [wheel_load_limit(200e3, kmh / 3.6).value for kmh in (160, 161, 250, 251, 301)] == [200e3, 190e3, 180e3, 170e3, 160e3]


def test_no_verdict_on_a_recalled_limit():
    """A number may be compared with a recalled one, but nothing is called within a limit, let alone compliant."""
    recalled, trusted = criteria.Limit("a", 10.0, "m", "R"), criteria.Limit("b", 10.0, "m", "V1")
    for value in (9.0, -11.0):
        text = str(criteria.Assessed("x", value, "m", recalled))
        assert "no verdict" in text and "limit" not in text.split("no verdict")[0] and "complian" not in text
    assert criteria.Assessed("x", -11.0, "m", trusted).verdict == "over the limit 10 m (V1)"
    assert criteria.Assessed("x", 9.0, "m", trusted).verdict == "within the limit 10 m (V1)"
    assert criteria.Assessed("x", 9.0, "m").over is None and criteria.Assessed("x", -5.0, "m", trusted).ratio == 0.5


def test_public_names_are_functions_also_when_their_module_was_imported_first(tmp_path):
    import subprocess
    import sys

    code = ("import railsym.criteria.comfort, railsym.criteria.instability, railsym as rs\n"
            "print(all(callable(getattr(rs.criteria, n)) for n in rs.criteria.__all__))")
    assert subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.strip() == "True"
    with pytest.raises(AttributeError, match="it offers"):
        criteria.comfrot
