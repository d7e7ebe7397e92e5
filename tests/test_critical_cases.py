# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of many changed vehicles against single runs and against dense eigenvalues."""

import pickle

import numpy as np
import pytest

from railsym.critical_cases import CriticalSpeedSolver, critical_speeds
from railsym.critical_speed import critical_speed
from railsym.errors import ModelError, VehicleFileError
from railsym.vehicle import load_vehicle

@pytest.fixture(scope="module")
def bogie():
    return load_vehicle("bogie")


def damping_name(vehicle):
    return next(name for name in vehicle.parameters if name.endswith(".damping") and isinstance(vehicle.parameters[name].value, float))


def test_cases_are_those_of_single_runs(bogie):
    name = damping_name(bogie)
    value = bogie.parameters[name].value
    found = critical_speeds(bogie, [{}, {name: 0.5 * value}], conicity=[0.1, 0.3])
    for k, (vehicle, conicity) in enumerate([(bogie, 0.1), (bogie.replace({name: 0.5 * value}), 0.3)]):
        single = critical_speed(vehicle, conicity)
        # both are polished on the full matrices to rounding
        assert found.speed[k] == pytest.approx(float(single.speed), rel=1e-10)
        assert found.frequency_hz[k] == pytest.approx(float(single.frequency_hz), rel=1e-10)
        assert found.label[k] == str(single.label)


def test_names_and_values_are_the_same_cases(bogie):
    name = damping_name(bogie)
    values = bogie.parameters[name].value * np.array([[0.7], [1.2]])
    by_array = critical_speeds(bogie, ([name], values), conicity=0.2)
    by_mapping = critical_speeds(bogie, [{name: v} for v in values[:, 0]], conicity=0.2)
    assert by_array.speed.tobytes() == by_mapping.speed.tobytes()
    assert by_array.message == by_mapping.message and len(by_array) == 2


def test_a_failing_case_is_told_and_the_others_go_on(bogie):
    name = damping_name(bogie)
    found = critical_speeds(bogie, [{name: -1.0}, {}], conicity=0.2)
    assert found.failed.tolist() == [True, False] and found.speed.mask.tolist() == [True, False]
    assert name in found.message[0] and found.speed[1] > 0.0


def test_the_solver_raises(bogie):
    solver = CriticalSpeedSolver(bogie, conicity=0.2)
    with pytest.raises(VehicleFileError, match="nearest"):
        solver.solve({damping_name(bogie)[:-1]: 1.0})
    with pytest.raises(ModelError, match="cases\\[1\\]"):
        critical_speeds(bogie, [{}, 3.0])
    with pytest.raises(ModelError, match="2 cases"):
        critical_speeds(bogie, [{}, {}], conicity=[0.1, 0.2, 0.3])
    with pytest.raises(ModelError, match="2 names"):
        critical_speeds(bogie, (["a", "b"], np.zeros((4, 3))))


def test_order_and_processes_do_not_matter(bogie):
    name = damping_name(bogie)
    cases = [{name: f * bogie.parameters[name].value} for f in (0.6, 1.0, 1.7)]
    solver = CriticalSpeedSolver(bogie, conicity=0.2, damping_ratio=0.05)
    forwards = [solver.solve(case) for case in cases]
    sent = pickle.loads(pickle.dumps(solver))
    backwards = [sent.solve(case) for case in reversed(cases)][::-1]
    for a, b in zip(forwards, backwards, strict=True):
        assert (a.speed, a.frequency_hz, a.message) == (b.speed, b.frequency_hz, b.message)
        assert a.crossings[0].right.tobytes() == b.crossings[0].right.tobytes()
