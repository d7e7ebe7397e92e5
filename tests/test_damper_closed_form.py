# SPDX-License-Identifier: BSD-3-Clause
"""Linear Maxwell damper under a sine, through bench, cleaning and identification, against loop area, phase and stiffness in closed form.

    oint F de = pi X^2 c omega / (1 + (omega c/k)^2),  tan(phase) = k/(omega c),  |K| = omega c / sqrt(1 + (omega c/k)^2)
"""

import numpy as np
import pytest

from railsym.dampers import DamperModel, Record, RecordError, clean, clean_all, identify, virtual_bench

TESTS = [(f, a) for f in (0.5, 1.0, 2.0, 4.0) for a in (0.5e-3, 2e-3)]
PAIRS = [(1e5, 2e6), (4e5, 5e6), (1e6, 2e6), (1e6, 1e7)]


def bench_record(c, k, frequency, amplitude, lag=0.0, rate=1000.0, cycles=8):
    """A test on the virtual bench, from rest in the middle of the stroke; the force channel is late by ``lag`` (s)."""
    omega = 2.0 * np.pi * frequency
    time = np.arange(int(cycles * rate / frequency)) / rate
    model = DamperModel("maxwell", damping=c, series_stiffness=k)
    fine = np.arange(10 * time.size) / (10.0 * rate)
    force, _ = virtual_bench(model, fine, amplitude * np.sin(omega * fine), amplitude * omega * np.cos(omega * fine))
    late = np.interp(time - lag, fine, force, left=0.0)
    return Record(time, amplitude * np.sin(omega * time), late, name=f"{frequency:g} Hz {1e3 * amplitude:g} mm")


@pytest.mark.parametrize(("c", "k"), PAIRS)
def test_area_phase_and_stiffness_of_a_loop(c, k):
    for frequency, amplitude in TESTS:
        omega, found = 2.0 * np.pi * frequency, clean(bench_record(c, k, frequency, amplitude))
        ratio = omega * c / k
        # cycles within 0.3 % of the steady one are kept; c/k = 0.5 s leaves the most in their mean
        assert found.dissipated_energy == pytest.approx(np.pi * amplitude**2 * c * omega / (1.0 + ratio**2), rel=2e-3)
        assert np.angle(found.dynamic_stiffness) == pytest.approx(np.arctan2(1.0, ratio), abs=1e-3)
        assert abs(found.dynamic_stiffness) == pytest.approx(omega * c / np.hypot(1.0, ratio), rel=1e-3)


@pytest.mark.parametrize("method", ["energy", "least_squares"])
@pytest.mark.parametrize("lag", [-2e-3, 0.0, 3e-3])
@pytest.mark.parametrize(("c", "k"), PAIRS)
def test_bench_and_identification_are_inverse(c, k, lag, method):
    fit = identify(clean_all([bench_record(c, k, f, a, lag) for f, a in TESTS]), "maxwell", method, damping="constant")
    assert (fit.damping, fit.series_stiffness) == pytest.approx((c, k), rel=0.01)
    assert fit.lag == pytest.approx(lag, abs=5e-5)


def test_a_loop_run_backwards_is_refused():
    """The time the other way round is the sign of the damping: phase and area turn, the magnitude does not."""
    record = bench_record(4e5, 5e6, 1.0, 1e-3)
    with pytest.raises(RecordError, match="the damper gives .* J a cycle"):
        clean(Record(record.time, record.displacement[::-1], record.force[::-1]))
