# SPDX-License-Identifier: BSD-3-Clause
"""Analyses of studies against the functions that they stand on, and against closed forms."""

import numpy as np
import pytest

import railsym as rs
from railsym import criteria, sweep


def run(tmp_path, vehicle, analysis, factors, plan=None, **options):
    return rs.Study(vehicle, analysis, factors, plan or sweep.FullGrid(), **options).run(tmp_path / "r.nc")


def test_modes_are_those_of_linearise(tmp_path):
    results = run(tmp_path, "bogie", sweep.Modes(speed=50.0, count=2), {"speed": sweep.List([100.0, 250.0], unit="km/h"), "contact.conicity": [0.1, 0.3]})
    for k in range(4):
        speed, conicity = results.factors[k]
        modes = rs.linearise(rs.load_vehicle("bogie"), speed, rs.LinearContact(conicity=conicity)).modes()
        least = sorted((m for m in modes if 0.3 <= m.frequency_hz <= 20.0), key=lambda m: m.damping_ratio)
        # the matrices are summed in another order: eigenvalues of some 1e2 1/s to 1e-9 of that
        np.testing.assert_allclose([results[f"mode{n}.damping_ratio"][k] for n in (1, 2)], [m.damping_ratio for m in least[:2]], atol=1e-8)
        assert results["mode1.label"][k] == least[0].label and results["unstable"][k] == len(modes.unstable)
    assert results["unstable"][3] > 0 and results["mode1.damping_ratio"][3] < 0


def test_critical_speed_is_where_the_least_damped_mode_is_neutral(tmp_path):
    found = run(tmp_path, "bogie", sweep.CriticalSpeed(), {"contact.conicity": [0.2]})
    modes = rs.Study("bogie", sweep.Modes(speed=float(found["speed"][0]), conicity=0.2), {"speed": sweep.List([100], unit="%")}, sweep.FullGrid()).run(tmp_path / "m.nc")
    assert abs(modes["mode1.damping_ratio"][0]) < 1e-8 and modes["mode1.frequency_hz"][0] == pytest.approx(found["frequency_hz"][0], rel=1e-8)


def test_verdicts_without_a_critical_speed(tmp_path):
    slow = run(tmp_path, "wheelset", sweep.CriticalSpeed(speed_range=(5.0, 20.0)), {"contact.conicity": [0.2]})
    assert slow["verdict"].tolist() == ["stable"] and np.isnan(slow["speed"][0]) and slow.status.tolist() == ["done"]
    fast = rs.Study("wheelset", sweep.CriticalSpeed(speed_range=(245.0, 250.0)), {"contact.conicity": [0.3]}, sweep.FullGrid()).run(tmp_path / "f.nc")
    assert fast["verdict"].tolist() == ["unstable_at_start"]


def test_damper_loop_is_the_closed_form(tmp_path):
    """Maxwell element: K = i w c k / (k + i w c)."""
    factors = {"anti_yaw_damper.series_stiffness": [4e6, 6e6], "anti_yaw_damper.damping": [2e5, 8e5], "loop.frequency": [1.0, 3.0]}
    results = run(tmp_path, "pendolino", sweep.DamperLoop("anti_yaw_damper", frequency=1.0, amplitude=2e-3), factors, configuration="AS_K")
    k, c, w = results.factors[:, 0], results.factors[:, 1], 2.0 * np.pi * results.factors[:, 2]
    stiffness = 1j * w * c * k / (k + 1j * w * c)
    # the bench integrates 256 steps a cycle to second order
    np.testing.assert_allclose(results["dynamic_stiffness"], abs(stiffness), rtol=1e-3)
    np.testing.assert_allclose(results["phase"], np.angle(stiffness), atol=1e-3)
    np.testing.assert_allclose(results["dissipated_energy"], np.pi * 4e-6 * stiffness.imag, rtol=1e-3)
    np.testing.assert_allclose(results["peak_force"], 2e-3 * abs(stiffness), rtol=1e-3)


def test_a_group_that_is_no_damper():
    with pytest.raises(sweep.SweepError, match="damper loop: element 'traction_rod' is unknown .groups of dampers"):
        rs.Study("pendolino", sweep.DamperLoop("traction_rod", 1.0, 1e-3), {"loop.frequency": [1.0]}, sweep.FullGrid(), configuration="AS_K")


def test_runs_are_those_of_simulate(tmp_path):
    analysis = sweep.Transient(speed=40.0, duration=2.0, irregularity="erri_b176_low", criteria=("instability", "derailment"))
    factors = {"contact.friction": [0.25], "track.irregularity_seed": [3.0], "track.irregularity_scale": [1.5], "wheelset.mass": sweep.List([110], unit="%")}
    results = run(tmp_path, "cooperrider", analysis, factors)
    vehicle = rs.load_vehicle("cooperrider")
    vehicle = vehicle.replace({"wheelset.mass": vehicle.parameters["wheelset.mass"].value * 1.1})
    body = next(b for b in vehicle.bodies if b.kind == "wheelset")
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, wheel_radius=body.wheel_radius, flange_back_distance=2 * (body.contact_half_spacing - 0.07))
    track = rs.Track.straight(110.0).with_irregularity("erri_b176_low", seed=3, scale=1.5)
    one = rs.simulate(vehicle, speed=40.0, duration=2.0, track=track, contact=pair.table(deepest=6e-4), law="fastsim", friction=0.25)
    # the tracks are not equally long, so their cosines are summed in another order; 2 s of motion make a little of it
    assert results["instability.peak"][0] == pytest.approx(max(b.peak for b in criteria.instability(one).axleboxes), rel=1e-5)
    assert results["derailment.YQ"][0] == pytest.approx(abs(criteria.derailment(one).worst("Y/Q").value), rel=1e-5)
    assert results["ending"].tolist() == ["completed"] and results["time"][0] == pytest.approx(2.0)


def test_a_linear_run_is_proportional_to_where_it_starts(tmp_path):
    analysis = sweep.Transient(speed=20.0, duration=1.0, conicity=0.1, criteria="hunting")
    results = run(tmp_path, "cooperrider", analysis, {"initial.wheelset1.y": sweep.List([0.1, 0.2], unit="mm")})
    one, two = results["hunting.amplitude"]
    # rotations are full: the second order is 1e-4 m over half the gauge, less than 1e-3
    assert one > 0 and two / one == pytest.approx(2.0, rel=1e-3)


def test_the_sections_of_a_track_are_factors(tmp_path):
    analysis = sweep.Transient(speed=30.0, duration=1.0, track="s_curve_500", conicity=0.1, criteria=())
    study = rs.Study("cooperrider", analysis, {"track.sections.0.length": [40.0, 80.0], "track.radius": [400.0], "track.cant": [0.05]}, sweep.FullGrid())
    from railsym.sweep.run_surroundings import track_for

    original = rs.track.load_track("s_curve_500")
    for number, length in ((0, 40.0), (1, 80.0)):
        track, duration = track_for(analysis, study.loaded, study.case(number).settings, 30.0)
        assert track.sections[0].length == length and duration == 1.0
        curves = [section for section in track.sections if isinstance(section, rs.track.Curve)]
        assert len(curves) == 2 and {(c.radius, c.cant) for c in curves} == {(400.0, 0.05)}
        assert track.length == pytest.approx(original.length - original.sections[0].length + length)


def test_a_run_that_stops_early_is_a_result(tmp_path):
    analysis = sweep.Transient(speed=60.0, duration=3.0, irregularity="erri_b176_high", criteria=("instability", "comfort"))
    results = run(tmp_path, "cooperrider", analysis, {"track.irregularity_scale": [4.0]})
    assert results["ending"][0] in ("derailed", "not_converged") and results.status.tolist() == ["done"] and results["time"][0] < 3.0
    assert np.isnan(results["comfort.N_MV"][0])


@pytest.mark.parametrize("changes, words", [({"criteria": ("stability",)}, "criterion 'stability' is unknown; nearest: 'instability'"),
                                            ({"duration": None}, "needs a duration")])
def test_runs_that_cannot_be(changes, words):
    with pytest.raises(sweep.SweepError, match=words):
        sweep.Transient(**{"speed": 40.0, "duration": 2.0} | changes)


def test_a_run_longer_than_its_track_is_the_case_s_error(tmp_path):
    analysis = sweep.Transient(speed=30.0, duration=1000.0, track="s_curve_500", criteria=())
    results = run(tmp_path, "cooperrider", analysis, {"speed": [30.0]})
    assert "m long, and 1000 s at 30 m/s take 30000 m" in results.errors[0]


def test_an_analysis_of_ones_own_from_a_file(tmp_path):
    (tmp_path / "study.toml").write_text(f"""
        [study]
        vehicle = "wheelset"
        [analysis]
        kind = "sweep_analysis:Logged"
        log = "{tmp_path / 'log'}"
        [plan]
        kind = "full_grid"
        [factors]
        x = {{ values = [[1, 2, 3], "-"] }}
    """)
    assert sweep.Study.load(tmp_path / "study.toml").run(tmp_path / "r.nc")["y"].tolist() == [1.0, 4.0, 9.0]


def test_the_order_of_cases_does_not_matter(tmp_path):
    """A case gives the same bits alone, after others, and before them."""
    factors = {"contact.conicity": sweep.Uniform(0.1, 0.4), "contact.friction": sweep.Uniform(0.2, 0.4), "frame.mass": sweep.Uniform(90, 110, unit="%")}
    rows = rs.Study("bogie", sweep.CriticalSpeed(), factors, sweep.LatinHypercube(6)).rows()
    there = rs.Study("bogie", sweep.CriticalSpeed(), factors, sweep.Table(rows, scale="si")).run(tmp_path / "1.nc")
    back = rs.Study("bogie", sweep.CriticalSpeed(), factors, sweep.Table(rows[::-1], scale="si")).run(tmp_path / "2.nc")
    assert there["speed"].tolist() == back["speed"][::-1].tolist() and np.isfinite(there["speed"]).all()


def test_tilt_runs_are_those_of_the_tilting_study(tmp_path):
    from railsym.studies.tilt import make_scene

    vehicle = rs.load_vehicle("pendolino_tilting").configured("AS_K")
    track = rs.track.Track.curve(500.0, 20.0, transition=40.0, cant=0.1, before=30.0, after=45.0)
    track.to_toml(tmp_path / "curve.toml")
    analysis = sweep.Tilt(track=str(tmp_path / "curve.toml"), active=False)
    results = run(tmp_path, "pendolino_tilting", analysis, {"speed": sweep.List([105.0], unit="km/h")}, configuration="AS_K")
    passive = make_scene(vehicle, rs.track.load_track(tmp_path / "curve.toml"), 105.0 / 3.6).case("passive", "")
    # one contact table made twice, one run twice: the same bits but for the spacing of the tape circles, which is computed here
    assert results["ride.peak"][0] == pytest.approx(passive.ride[passive.worst]["peak"], rel=1e-6)
    assert results["tilt.state"].tolist() == ["no control"] and np.isnan(results["tilt.delay"][0])
    active = rs.Study("pendolino_tilting", sweep.Tilt(track=str(tmp_path / "curve.toml")), {"tilt.share": [0.3, 0.6]}, sweep.FullGrid(), configuration="AS_K")
    results = active.run(tmp_path / "a.nc")
    assert results["ride.peak"][1] < results["ride.peak"][0] < passive.ride[passive.worst]["peak"] and results["tilt.largest"][1] > results["tilt.largest"][0]


def test_a_vehicle_that_does_not_tilt():
    with pytest.raises(rs.errors.RailsymError, match="tilt"):
        rs.Study("pendolino", sweep.Tilt(), {"speed": [30.0]}, sweep.FullGrid(), configuration="AS_K")
