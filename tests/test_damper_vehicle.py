# SPDX-License-Identifier: BSD-3-Clause
"""Identified dampers in the linearised vehicle: tangents about rest, equivalents at an amplitude."""

import numpy as np
import pytest

import railsym as rs
from railsym.dampers import DamperModel, put_into
from railsym.dampers.vehicle_table import critical_speeds, equivalent

CURVED = DamperModel("maxwell", damping_curve=((0.0, 0.01, 0.03), (0.0, 7e3, 1e4)), series_stiffness_curve=((0.0, 0.01, 0.03), (6e6, 5e6, 4.5e6)))


def speed_of(path):
    return float(rs.critical_speed(rs.load_vehicle(path), 0.2).speed)


def test_a_curve_counts_in_stability_as_its_tangent_at_rest(tmp_path):
    damping, stiffness = CURVED.linearised()
    tangent = DamperModel("maxwell", damping=damping, series_stiffness=stiffness)
    curved = speed_of(put_into("pendolino", CURVED, tmp_path / "a.toml"))
    # two assemblies of one linear model: the tolerance is that of the crossing
    assert curved == pytest.approx(speed_of(put_into("pendolino", tangent, tmp_path / "b.toml")), rel=1e-6)
    softer = CURVED.replace(damping_curve=((0.0, 0.01, 0.03), (0.0, 2e3, 3e3)))
    assert abs(speed_of(put_into("pendolino", softer, tmp_path / "c.toml")) / curved - 1.0) > 0.02


def test_the_equivalent_of_a_linear_damper_is_itself():
    linear = DamperModel("maxwell", damping=5e5, series_stiffness=4e6)
    found = equivalent(linear, 2e-3, 1.5)
    # the bench integrates: its first harmonic is good to 1e-4
    assert (found.damping, found.series_stiffness) == pytest.approx((5e5, 4e6), rel=1e-3)
    assert equivalent(DamperModel("viscous", damping=3e5), 1e-3, 2.0).damping == pytest.approx(3e5, rel=1e-3)


def test_table_of_critical_speeds():
    linear = DamperModel("maxwell", damping=5e5, series_stiffness=4e6)
    found = critical_speeds("pendolino", {"maxwell": linear}, conicity=(0.2,), amplitudes=(2e-3,))
    assert found.rows[:2] == ("as in the file", "maxwell, about rest") and found.rows[2].startswith("maxwell, 2 mm at ")
    assert found.speed[1, 0] == pytest.approx(found.speed[2, 0], rel=1e-3)        # linear: no amplitude in it
    assert abs(found.speed[0, 0] / found.speed[1, 0] - 1.0) > 0.01
    assert "maxwell, about rest" in "\n".join(found.lines())
    assert np.isfinite(found.as_data()["speed"]["as in the file"][0])


def test_a_model_without_a_critical_speed_takes_the_frequency_of_the_files_damper():
    stiff = DamperModel("viscous", damping_curve=((0.0, 0.001, 0.03), (0.0, 3e3, 6e3)))
    found = critical_speeds("pendolino", {"viscous": stiff}, conicity=(0.1,), amplitudes=(3e-3,))
    assert np.ma.is_masked(found.speed[1, 0]) and not np.ma.is_masked(found.speed[0, 0])
    assert found.rows[2] == f"viscous, 3 mm at {found.frequency_hz[0, 0]:.1f} Hz" and found.speed[2, 0] > 10.0


def test_shipped_records_and_the_virtual_bench_agree():
    """Two integrators of one equation: SciPy's Radau in the generator, the vehicle's element law in C."""
    from railsym.dampers import clean, read_records, shipped_records
    from tests.oracles.damper_records import SHIPPED, SHIPPED_SENSORS

    model = DamperModel("maxwell", damping_curve=SHIPPED.damping, series_stiffness_curve=SHIPPED.stiffness)
    for record in read_records(shipped_records()):
        found = clean(record)
        late = np.exp(-2j * np.pi * found.frequency * SHIPPED_SENSORS["lag"])
        expected = late * model.describing_function(found.amplitude, found.frequency)
        # 1 % noise in displacement and force, some 900 samples: 0.07 % of deviation; 0.3 % of transient may be left
        assert found.dynamic_stiffness == pytest.approx(expected, rel=4e-3)


def test_the_same_element_runs_in_the_transient(tmp_path):
    """In a run of the whole vehicle the identified damper's force is its curve of the rate of its state, and its spring's share of the elongation."""
    from railsym.dampers.models import curve_value

    vehicle = rs.load_vehicle(put_into("pendolino", CURVED, tmp_path / "a.toml")).configured("AS_K")
    names = [f"anti_yaw_damper.front_left.{part}" for part in ("force", "s", "s.rate")]
    run = rs.simulate(vehicle, speed=70.0, duration=0.6, dt=5e-4, contact=rs.LinearContact(conicity=0.2), initial={"bogie1.yaw": 5e-4}, channels=names, rate=2000)
    force, state, rate = (run[name] for name in names)
    assert np.abs(force).max() > 3e3
    # after the jolt of the start has left the rates (rho = 0.9 a step); then what the iteration leaves, some ten newtons
    np.testing.assert_allclose(force[60:], curve_value(CURVED.force_law_record()["damping_curve"], rate[60:]), atol=30.0)
    # and the virtual bench, driven by the elongation of the run, gives the same force: e = s + force/k(|de/dt|), k from the curve at rest
    linear = CURVED.replace(series_stiffness_curve=None, series_stiffness=6e6)
    again = rs.load_vehicle(put_into("pendolino", linear, tmp_path / "b.toml")).configured("AS_K")
    run = rs.simulate(again, speed=70.0, duration=0.6, dt=5e-4, contact=rs.LinearContact(conicity=0.2), initial={"bogie1.yaw": 5e-4}, channels=names, rate=2000)
    force, state, rate = (run[name] for name in names)
    from railsym._core import bench_run

    elongation = state + force / 6e6
    bench, _ = bench_run(linear.force_law_record(), run.time, elongation, np.gradient(elongation, run.time), substeps=4, start=float(state[0]))
    np.testing.assert_allclose(bench, force, atol=0.02 * np.abs(force).max())
