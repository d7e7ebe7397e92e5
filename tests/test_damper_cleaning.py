# SPDX-License-Identifier: BSD-3-Clause
"""Cleaning of bench records against closed forms and against records of known defects."""

import warnings
from functools import lru_cache

import numpy as np
import pytest

from railsym.dampers import Record, RecordError, RecordWarning, clean, clean_all
from tests.oracles.damper_records import Sensors, TrueDamper, bench_test

TESTS = ((0.5, 2.0), (1.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 0.5), (3.0, 1.5))


def linear_test(c, k, frequency, amplitude, noise=0.0, lag=0.0, offset=0.0, phase=0.4, cycles=8, rate=1000.0, seed=1):
    """Steady linear Maxwell damper: F = k i omega c/(k + i omega c) X."""
    omega, time = 2 * np.pi * frequency, np.arange(0.0, cycles / frequency, 1.0 / rate)
    stiffness = 1.0 / (1.0 / k + 1.0 / (1j * omega * c))
    turning = amplitude * np.exp(1j * (omega * time + phase - 0.5 * np.pi))
    force = (stiffness * turning * np.exp(-1j * omega * lag)).real
    random = np.random.default_rng(seed)
    displacement = turning.real + noise * amplitude / np.sqrt(2) * random.standard_normal(time.size) + 1e-4 * (offset != 0)
    force = force + offset + noise * np.std(force) * random.standard_normal(time.size)
    return Record(time, displacement, force, name=f"{frequency:g}Hz"), stiffness


@pytest.mark.parametrize("phase", [0.0, 0.4, 2.0, -3.0])
@pytest.mark.parametrize("rate", [500.0, 1003.7, 5000.0])
def test_noise_free_record_gives_the_closed_form(phase, rate):
    record, stiffness = linear_test(3e5, 5e6, 2.3, 1e-3, offset=150.0, phase=phase, rate=rate)
    found = clean(record)
    # interpolation: 0.023 (omega step)^4 = 2e-8 at 500 Hz; the offset of the displacement goes into the window by less than 1e-4
    assert found.frequency == pytest.approx(2.3, rel=1e-6)
    assert found.amplitude == pytest.approx(1e-3, rel=1e-5)
    assert found.dynamic_stiffness == pytest.approx(stiffness, rel=1e-4)
    assert found.force_offset == pytest.approx(150.0, abs=0.5)
    assert found.dissipated_energy == pytest.approx(np.pi * stiffness.imag * 1e-6, rel=1e-4)
    assert found.displacement == pytest.approx(1e-3 * np.sin(2 * np.pi * 2.3 * found.time), abs=2e-8)
    assert found.velocity == pytest.approx(2 * np.pi * 2.3e-3 * np.cos(2 * np.pi * 2.3 * found.time), abs=3e-7)
    assert found.force.size == found.cycles * found.samples_per_cycle and found.cycles in (7, 8)


def test_noise_and_lag_over_several_tests():
    pairs = [linear_test(3e5, 5e6, f, 1e-3 * a, noise=0.02, lag=0.003, offset=200.0, seed=n) for n, (f, a) in enumerate(TESTS)]
    found = clean_all([record for record, _ in pairs])
    for one, (_, stiffness) in zip(found, pairs):
        turned = stiffness * np.exp(-2j * np.pi * one.frequency * 0.003)
        # 2 % noise over some 2700 samples: 0.05 % in each of force and displacement; three deviations
        assert one.dynamic_stiffness == pytest.approx(turned, rel=3e-3)
        # interpolation between samples takes up to a fifth off white noise
        assert one.noise == pytest.approx(0.018 * np.std(one.force), rel=0.2)
    assert found[0].lag == pytest.approx(0.003, abs=3e-4)
    assert found[0].lag_deviation < 3e-4


def test_one_test_does_not_tell_the_lag():
    found, = clean_all(linear_test(3e5, 5e6, 1.0, 1e-3, lag=0.003)[0])
    assert found.lag == 0.0 and found.lag_deviation == np.inf


@lru_cache(maxsize=None)
def from_rest(lag=0.0):
    damper = TrueDamper(6e5, 3e6)
    return bench_test(damper, 2.0, 1e-3, 10, 500.0, rise=0.7, sensors=Sensors(lag=lag, force_drift=80.0))


def test_transients_and_drift_are_left_out():
    found = clean(Record(*from_rest()[:3], name="start"))
    stiffness = 1.0 / (1.0 / 3e6 + 1.0 / (4j * np.pi * 6e5))
    # cycles within 0.3 % are steady: what is left of the transient is below that
    assert found.dynamic_stiffness == pytest.approx(stiffness, rel=2e-3)
    assert found.cycles < 10 and any("transients" in text for text in found.messages)


def test_bench_at_rest_before_and_after():
    record, stiffness = linear_test(3e5, 5e6, 2.0, 1e-3, cycles=10)
    pad = np.zeros(2000)
    time = np.arange(record.time.size + 4000) * 1e-3
    found = clean(Record(time, np.r_[pad, record.displacement, pad], np.r_[pad, record.force, pad]))
    assert found.dynamic_stiffness == pytest.approx(stiffness, rel=1e-3)


def test_uneven_sampling():
    record, stiffness = linear_test(3e5, 5e6, 2.0, 1e-3)
    keep = np.random.default_rng(5).random(record.time.size) > 0.1
    with pytest.warns(RecordWarning, match="missing samples"):
        found = clean(Record(record.time[keep], record.displacement[keep], record.force[keep]))
    assert found.dynamic_stiffness == pytest.approx(stiffness, rel=1e-4)


@pytest.mark.parametrize("compliance", [0.0, 1.0 / 1.5e6])
def test_offset_of_an_asymmetric_damper_is_not_its_mean(compliance):
    """Motion made from the force: the damper itself moves as a sine, and the spring in series adds F/k."""
    time, omega = np.arange(0.0, 10.0, 1e-3), 2 * np.pi
    speed = omega * 1e-3 * np.cos(omega * time)
    force = np.where(speed > 0, 6e5, 3e5) * speed
    found = clean(Record(time, 1e-3 * np.sin(omega * time) + compliance * force, force + 300.0))
    # 15 harmonics of the motion and 30 of a force with a kink at rest: within 2 % of its peak of 3770 N
    assert found.force_offset == pytest.approx(300.0, abs=80.0)
    assert force.mean() > 250.0


def spoilt(**change):
    record, _ = linear_test(3e5, 5e6, 1.0, 1e-3)
    given = {"time": record.time, "displacement": record.displacement, "force": record.force, "name": "spoilt"}
    return Record(**{**given, **{key: value(record) if callable(value) else value for key, value in change.items()}})


def without(record, at, number):
    return np.delete(record, np.arange(at, at + number))


DEFECTS = {
    "clipped": ({"force": lambda r: np.clip(r.force, -1500.0, 1500.0)}, "clipped"),
    "clipped on one side": ({"force": lambda r: np.minimum(r.force, 1600.0)}, "clipped"),
    "displacement in mm": ({"displacement": lambda r: 1e3 * r.displacement}, "off by 1000"),
    "displacement too small": ({"displacement": lambda r: 1e-3 * r.displacement}, "off by 1000"),
    "force in kN": ({"force": lambda r: 1e-3 * r.force}, "off by 1000"),
    "force in mN": ({"force": lambda r: 1e3 * r.force}, "off by 1000"),
    "time in ms": ({"time": lambda r: 1e3 * r.time}, "off by 1000"),
    "swapped": ({"displacement": lambda r: r.force, "force": lambda r: r.displacement}, "swapped"),
    "swapped, scaled": ({"displacement": lambda r: 1e-6 * r.force, "force": lambda r: 1e6 * r.displacement}, "swapped"),
    "sign": ({"force": lambda r: -r.force}, "other sign"),
    "short": ({"time": lambda r: r.time[:1800], "displacement": lambda r: r.displacement[:1800], "force": lambda r: r.force[:1800]}, "1.8 cycles"),
    "gap": ({key: lambda r, key=key: without(getattr(r, key), 3000, 400) for key in ("time", "displacement", "force")}, "gap of 0.401 s"),
    "no motion": ({"displacement": lambda r: 0 * r.time}, "does not move"),
    "no force": ({"force": lambda r: 0 * r.time}, "constant"),
    "random displacement": ({"displacement": lambda r: 1e-3 * np.random.default_rng(1).standard_normal(r.time.size)}, "."),
    "frequency": ({"nominal_frequency": 1000.0}, "off by 1000"),
    "amplitude": ({"nominal_amplitude": 1.0}, "off by 1000"),
    "velocity in mm/s": ({"velocity": lambda r: 1e3 * np.gradient(r.displacement, r.time)}, "off by 1000"),
    "velocity sign": ({"velocity": lambda r: -np.gradient(r.displacement, r.time)}, "wrong sign"),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects_are_named_with_their_test(name):
    change, message = DEFECTS[name]
    with pytest.raises(RecordError, match="test 'spoilt'.*" + message):
        clean(spoilt(**change))


def test_a_sound_record_has_no_defect():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        clean(spoilt())
        clean(spoilt(force=lambda r: 20.0 * np.round(r.force / 20.0)))      # a coarse converter is not clipping


def test_a_test_unlike_the_others_is_named():
    records = [linear_test(3e5, 5e6, f, 1e-3)[0] for f in (1.0, 2.0, 3.0)]
    odd = Record(records[1].time, 1e3 * records[1].displacement, records[1].force, name="odd")
    with pytest.raises(RecordError, match="test 'odd'.*off by 1000"):
        clean_all([records[0], odd, records[2]], check_units=False)


def test_velocity_channel_behind_the_displacement_warns():
    with pytest.warns(RecordWarning, match="3.0 ms behind"):
        clean(spoilt(velocity=lambda r: 2e-3 * np.pi * np.cos(2 * np.pi * (r.time - 0.003) + 0.4)))
