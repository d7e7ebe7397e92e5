# SPDX-License-Identifier: BSD-3-Clause
"""Running studies: the same bytes by any number of workers, nothing lost, nothing mixed."""

import numpy as np
import pytest

import railsym as rs
from railsym import sweep

FACTORS = {"contact.conicity": sweep.Grid(0.2, 0.4, 4), "wheelset.mass": sweep.Normal(100, 5, unit="%")}


def study(cases=12, **changes):
    return rs.Study("wheelset", sweep.CriticalSpeed(), FACTORS, sweep.LatinHypercube(cases), **{"seed": 1} | changes)


def test_outputs_are_those_of_critical_speed(tmp_path):
    results = study().run(tmp_path / "r.nc")
    for k in range(0, 12, 5):
        case = results.study.case(k)
        found = rs.critical_speed(case.vehicle, case.settings["contact.conicity"])
        assert results["speed"][k] == found.speed or (np.isnan(results["speed"][k]) and found.speed is np.ma.masked)
        assert case.vehicle.parameters["wheelset.mass"].value == results["wheelset.mass"][k]
    assert (results.status == "done").all() and not results.errors and results.unit("speed") == "m/s"


def test_bytes_do_not_depend_on_workers(tmp_path):
    for workers in (1, 2):
        study().run(tmp_path / f"{workers}.nc", workers=workers)
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()


def test_a_store_is_read_back(tmp_path):
    results = study().run(tmp_path / "r.nc")
    again = sweep.load(tmp_path / "r.nc")
    assert again.study.hash == results.study.hash
    for name in (*results.names, *results.outputs):
        np.testing.assert_array_equal(again[name], results[name])


def test_another_study_is_refused_and_the_store_intact(tmp_path):
    study().run(tmp_path / "r.nc")
    before = (tmp_path / "r.nc").read_bytes()
    with pytest.raises(sweep.StoreError, match="another study.*study.seed there: 1, here: 2"):
        study(seed=2).run(tmp_path / "r.nc")
    assert (tmp_path / "r.nc").read_bytes() == before
