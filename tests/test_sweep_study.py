# SPDX-License-Identifier: BSD-3-Clause
"""Studies as data: files, units, hashes, and what is refused with which words."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import railsym as rs
from railsym import sweep
from railsym.vehicle import SHIPPED
import railsym.sweep.run_criteria  # noqa: F401
import railsym.sweep.transient  # noqa: F401

TEXT = """
[study]
vehicle = "pendolino"
seed = 7
keep = ["speed", "*_hz"]

[analysis]
kind = "critical_speed"
conicity = 0.2
criterion = "damping_ratio"
damping_ratio = 0.05
speed_range = [[20, 700], "km/h"]

[set]
"car.mass" = [38, "t"]
"contact.friction" = [0.35, "-"]

[plan]
kind = "latin_hypercube"
cases = 20

[factors]
configuration = { values = ["AS_K", "AS_Mal_K"] }
"anti_yaw_damper.series_stiffness" = { uniform = [[4, 6], "MN/m"] }
"truss_axlebox_bushing.stiffness.0" = { normal = [[100, 5], "%"], low = 85.0, high = 115.0 }
"contact.conicity" = { grid = [[0.1, 0.4], "-"], points = 4 }
"car.inertia.0" = { lognormal = [[100], "%"], sigma = 0.1 }
"contact.kalker_weight" = { triangular = [[0.5, 0.8, 1.0], "-"] }
"""


def written(folder, old="", new=""):
    assert not old or TEXT.count(old) == 1
    path = folder / "study.toml"
    path.write_text(TEXT.replace(old, new) if old else TEXT)
    return path


def python():
    """The same study from Python, in SI."""
    own = rs.load_vehicle("pendolino").configured("AS_K").parameters
    return rs.Study(
        "pendolino", sweep.CriticalSpeed(0.2, "damping_ratio", 0.05, speed_range=(20 / 3.6, 700 / 3.6)),
        {"configuration": ["AS_K", "AS_Mal_K"], "anti_yaw_damper.series_stiffness": sweep.Uniform(4e6, 6e6),
         "truss_axlebox_bushing.stiffness.0": sweep.Normal(*(own["truss_axlebox_bushing.stiffness.0"].value * np.array([1, 0.05, 0.85, 1.15]))),
         "contact.conicity": sweep.Grid(0.1, 0.4, 4), "car.inertia.0": sweep.LogNormal(own["car.inertia.0"].value, 0.1),
         "contact.kalker_weight": sweep.Triangular(0.5, 0.8, 1.0)},
        sweep.LatinHypercube(20), set={"car.mass": 38e3, "contact.friction": 0.35}, keep=["speed", "*_hz"], seed=7)


def test_a_file_and_python_give_the_same_cases(tmp_path):
    study = sweep.Study.load(written(tmp_path))
    np.testing.assert_allclose(study.rows(), python().rows(), rtol=1e-14)     # kilometres and per cents, converted one way or the other
    assert study.analysis.criterion == "damping_ratio" and list(study.outputs) == ["speed", "frequency_hz"]
    np.testing.assert_allclose(study.analysis.speed_range, (20 / 3.6, 700 / 3.6), rtol=1e-15)
    assert study.units == ("", "N/m", "N/m", "-", "kg*m^2", "-")


def test_what_a_case_is(tmp_path):
    study = sweep.Study.load(written(tmp_path))
    for number in (0, 7, 19):
        case, row = study.case(number), study.rows()[number]
        parameters = case.vehicle.parameters
        assert case.vehicle.configuration == ("AS_K", "AS_Mal_K")[int(row[0])] and parameters["car.mass"].value == 38e3
        assert parameters["anti_yaw_damper.series_stiffness"].value == row[1] and parameters["car.inertia.0"].value == row[4]
        assert case.settings == {"contact.friction": 0.35, "contact.conicity": row[3], "contact.kalker_weight": row[5]}


def test_saving_and_loading_changes_nothing(tmp_path):
    study = sweep.Study.load(written(tmp_path))
    study.save(tmp_path / "again.toml")
    again = sweep.Study.load(tmp_path / "again.toml")
    assert again.hash == study.hash and (again.rows() == study.rows()).all() and again.document() == study.document()
    assert json.loads(json.dumps(study.document())) == study.document()


def test_long_tables_go_into_a_file_of_their_own(tmp_path):
    rows = np.random.default_rng(1).uniform(0.1, 0.4, (3000, 1))
    study = rs.Study("wheelset", sweep.CriticalSpeed(), {"contact.conicity": sweep.Uniform(0, 1)}, rows)
    study.save(tmp_path / "study.toml")
    assert (tmp_path / "study_cases.npy").exists() and len((tmp_path / "study.toml").read_text()) < 1000
    assert sweep.Study.load(tmp_path / "study.toml").hash == study.hash
    np.savetxt(tmp_path / "cases.csv", rows[:5], delimiter=",", fmt="%.17g")
    text = (tmp_path / "study.toml").read_text().replace("study_cases.npy", "cases.csv")
    (tmp_path / "study.toml").write_text(text)
    assert (sweep.Study.load(tmp_path / "study.toml").rows() == rows[:5]).all()


def test_a_vehicle_file_is_looked_up_beside_the_study_and_is_part_of_it(tmp_path):
    (tmp_path / "there").mkdir()
    shutil.copy(SHIPPED / "wheelset.toml", tmp_path / "there" / "mine.toml")
    study = rs.Study(tmp_path / "there" / "mine.toml", sweep.CriticalSpeed(), {"wheelset.mass": sweep.Uniform(90, 110, unit="%")}, sweep.LatinHypercube(3))
    study.save(tmp_path / "study.toml")
    assert 'vehicle = "there/mine.toml"' in (tmp_path / "study.toml").read_text()
    assert sweep.Study.load(tmp_path / "study.toml").hash == study.hash
    study.run(tmp_path / "r.nc")
    other = (tmp_path / "there" / "mine.toml").read_text().replace("0.3, ", "0.31, ", 1)
    (tmp_path / "there" / "mine.toml").write_text(other)
    with pytest.raises(sweep.StoreError, match="another study .another vehicle file"):
        sweep.Study.load(tmp_path / "study.toml").run(tmp_path / "r.nc")


def test_hashes_tell_studies_apart():
    def hash_of(**changes):
        given = {"vehicle": "wheelset", "analysis": sweep.CriticalSpeed(), "factors": {"contact.conicity": sweep.Uniform(0.1, 0.2)},
                 "plan": sweep.LatinHypercube(5), "seed": 0, "set": None, "keep": None} | changes
        return rs.Study(**given).hash

    variants = [{}, {"vehicle": "bogie"}, {"analysis": sweep.CriticalSpeed(damping_ratio=0.05)}, {"factors": {"contact.conicity": sweep.Uniform(0.1, 0.21)}},
                {"factors": {"contact.friction": sweep.Uniform(0.1, 0.2)}}, {"plan": sweep.LatinHypercube(6)}, {"plan": sweep.Sobol(5)}, {"seed": 1},
                {"set": {"contact.friction": 0.2}}, {"keep": ["speed"]}]
    hashes = [hash_of(**changes) for changes in variants]
    assert len(set(hashes)) == len(variants)
    assert hash_of(factors={"contact.conicity": sweep.Uniform(0.1, 0.2, unit="-")}) == hashes[0]


@pytest.mark.parametrize("old, new, words", [
    ('"pendolino"', '"pendolin"', "nearest: 'pendolino'"),
    ("seed = 7", "sead = 7", "study.toml: .study. sead is unknown; nearest: 'seed'"),
    ("seed = 7", "seed = -1", "seed = -1: a whole number from 0"),
    ('"critical_speed"', '"critical"', "analysis 'critical' is unknown; nearest: 'critical_speed'"),
    ("conicity = 0.2\n", "conicty = 0.2\n", "conicty is unknown; nearest: 'conicity'"),
    ('[[20, 700], "km/h"]', "[20, 700]", 'a number is written .value, "unit".*"m/s"'),
    ('[[20, 700], "km/h"]', '[[20, 700], "kN"]', "wrong dimension"),
    ('"*_hz"', '"hertz"', "keep: 'hertz' is unknown"),
    ('"latin_hypercube"', '"latin"', "nearest: 'latin_hypercube'"),
    ("cases = 20", "case = 20", "case is unknown; nearest: 'cases'"),
    ("cases = 20", "", "missing 1 required"),
    ("anti_yaw_damper.series_stiffness", "anti_yaw_damper.stiffness", "is unknown; nearest"),
    ("truss_axlebox_bushing.stiffness.0", "truss_axlebox_bushing.stiffness", "name one of them, such as 'truss_axlebox_bushing.stiffness.0'"),
    ('[[4, 6], "MN/m"]', "[4, 6]", "write numbers and their unit"),
    ('[[4, 6], "MN/m"]', '[[4, 6], "kN"]', "series_stiffness.*wrong dimension"),
    ('[[4, 6], "MN/m"]', '[[6, 4], "MN/m"]', "low must lie below high"),
    ("sigma = 0.1", "sgima = 0.1", "sgima is unknown; nearest: 'sigma'"),
    ("sigma = 0.1", 'sigma = "a"', "finite number"),
    ("{ grid =", "{ gird =", "kind is unknown; nearest: 'grid'"),
    ('"AS_Mal_K"]', '"AS_Mal"]', "AS_Mal"),
    ('[38, "t"]', "38", 'a number is written .value, "unit".'),
    ('"car.mass"', '"car.weight"', "car.weight.*unknown"),
    ("[plan]", "[plans]", "plans is unknown; nearest: 'plan'"),
])
def test_what_is_wrong_in_a_file_is_told(tmp_path, old, new, words):
    with pytest.raises((sweep.SweepError, rs.errors.VehicleFileError), match=words) as found:
        sweep.Study.load(written(tmp_path, old, new))
    assert "Traceback" not in str(found.value) and len(str(found.value)) < 500


@pytest.mark.parametrize("changes, words", [
    ({"analysis": "critical_speed"}, "analysis is 'critical_speed'"), ({"factors": {}}, "at least one factor"), ({"plan": 20}, "plan is 20"),
    ({"factors": {"contact.conicity": 0.3}}, "Grid, List, Uniform"), ({"factors": {"x": [1.0]}}, "'x' is unknown"),
    ({"factors": {"contact.wheel_transverse_radius": sweep.Uniform(0.1, 0.2, unit="kg")}}, "wrong dimension"),
    ({"factors": {"contact.roll_parameter": sweep.Uniform(90, 110, unit="%")}}, "in %, but neither"),
    ({"factors": {"wheelset.mass": ["heavy"]}}, "lists texts"), ({"set": {"contact.friction": "high"}}, "finite number"),
])
def test_what_is_wrong_in_python_is_told(changes, words):
    given = {"vehicle": "wheelset", "analysis": sweep.CriticalSpeed(), "factors": {"contact.conicity": sweep.Uniform(0.1, 0.2)},
             "plan": sweep.LatinHypercube(5)} | changes
    with pytest.raises(sweep.SweepError, match=words):
        rs.Study(**given)


def test_results_by_name(tmp_path):
    study = rs.Study("pendolino", sweep.CriticalSpeed(0.2), {"configuration": ["AS_K", "AS_Mal_K"]}, sweep.FullGrid(), keep=["speed"])
    results = study.run(tmp_path / "r.nc")
    assert results["configuration"].tolist() == ["AS_K", "AS_Mal_K"] and results.outputs == ("speed",) and results["speed"][0] != results["speed"][1]
    with pytest.raises(sweep.SweepError, match="'sped' is unknown; nearest: 'speed'"):
        results["sped"]
    assert sweep.load(tmp_path / "r.nc")["configuration"].tolist() == ["AS_K", "AS_Mal_K"]
    with pytest.raises(sweep.StoreError, match="there is no store"):
        sweep.load(tmp_path / "other.nc")


def test_results_in_xarray(tmp_path):
    pytest.importorskip("xarray")
    study = rs.Study("wheelset", sweep.CriticalSpeed(), {"contact.conicity": sweep.Grid(0.2, 0.4, 3)}, sweep.FullGrid())
    data = study.run(tmp_path / "r.nc").to_xarray()
    assert data["speed"].attrs["units"] == "m/s" and data["contact.conicity"].values.tolist() == [0.2, 0.30000000000000004, 0.4]
    assert data["speed"].dims == ("case",) and data["status"].values.tolist() == ["done"] * 3


def test_the_study_of_the_documentation(tmp_path):
    page = (Path(__file__).parent.parent / "docs" / "studies_sweep.md").read_text()
    (tmp_path / "study.toml").write_text(page.partition("```toml\n")[2].partition("```")[0])
    study = sweep.Study.load(tmp_path / "study.toml")
    assert study.size == 200 and study.set == {"car.mass": 38e3} and list(study.outputs) == ["speed", "frequency_hz"]
    analyses = set(sweep.analysis.KINDS)
    assert all(f"`{kind}`" in page for kind in analyses | set(sweep.plans.KINDS)) and all(f"{{ {kind} =" in page for kind in sweep.factors.KINDS)
    for criterion in sweep.run_criteria.CRITERIA.values():
        assert all(f"`{name}`" in page for name in criterion.outputs)
