# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivities against finite differences of the critical speed itself."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.synthetic_models import Train, Wheelset

from railsym.critical_speed import critical_speed
from railsym.errors import ModelError
from railsym.sensitivity import Parameter, sensitivities, sensitivity
from railsym.stability import stability
from railsym.vehicle import load_vehicle

TRAIN_PARAMETERS = ("conicity", "kalker_weight", "yaw_damping", "yaw_series", "primary_longitudinal", "primary_lateral",
                    "secondary_shear", "lateral_damping", "car_mass", "bogie_yaw_inertia", "wheelbase")


def parameters_of(case, names):
    return [Parameter(name, getattr(case, name), "SI", lambda value, name=name: replace(case, **{name: value}).model()) for name in names]


@pytest.mark.parametrize("name", ["mass", "inertia", "lateral_stiffness", "yaw_stiffness", "creep", "conicity", "radius"])
def test_wheelset_against_its_closed_form(name):
    wheelset = Wheelset()
    point, = stability(wheelset.model())[0].crossings
    found = sensitivities(point, parameters_of(wheelset, [name]))
    value, step = getattr(wheelset, name), 1e-4 * getattr(wheelset, name)
    ahead, back = (replace(wheelset, **{name: value + s}).critical_speed() for s in (step, -step))
    # truncation of both central differences, 1e-8
    assert found.speed_derivative[0] == pytest.approx((ahead - back) / (2 * step), rel=1e-6)


@pytest.mark.parametrize("ratio", [0.0, 0.05])
@pytest.mark.parametrize("dampers", [(True,) * 4, (True, True, True, False)])
def test_train_against_critical_speeds(ratio, dampers):
    train = Train(yaw_dampers=dampers)
    point = stability(train.model(), (ratio,))[0].crossings[0]
    found = sensitivities(point, parameters_of(train, TRAIN_PARAMETERS))
    for name in ("conicity", "yaw_series", "bogie_yaw_inertia", "wheelbase"):
        step = 1e-4 * getattr(train, name)
        ahead, back = (stability(train.changed(**{name: getattr(train, name) + s}).model(), (ratio,))[0] for s in (step, -step))
        k = found.index(name)
        # truncation; the hunting modes of the two bogies lie 1 % apart, which bends their paths
        assert found.speed_derivative[k] == pytest.approx((ahead.speed - back.speed) / (2 * step), rel=2e-4), name
        assert found.frequency_derivative[k] == pytest.approx((ahead.frequency_hz - back.frequency_hz) / (2 * step), rel=2e-4), name


def test_table_is_sorted_by_relative_influence():
    train = Train()
    point, = stability(train.model())[0].crossings
    found = sensitivities(point, parameters_of(train, TRAIN_PARAMETERS))
    assert len(found) == len(TRAIN_PARAMETERS) and (np.diff(np.abs(found.speed_elasticity)) <= 0).all()
    assert np.allclose(found.speed_elasticity, found.values * found.speed_derivative / point.speed)
    assert found.speed_elasticity[found.index("conicity")] < 0 < found.speed_elasticity[found.index("yaw_series")]
    assert found.names[0] in found.table(1) and "bogie hunting" in found.table(1)


def test_similarity_rules_the_elasticities():
    """Stiffnesses, creep and masses times c leave V as it is: K and M fix the frequency, creep over V the damping."""
    wheelset = Wheelset()
    point, = stability(wheelset.model())[0].crossings
    found = sensitivities(point, parameters_of(wheelset, ["mass", "inertia", "lateral_stiffness", "yaw_stiffness", "creep"]))
    # rounding of forms of 1e7 N over steps of 1e-4
    assert found.speed_elasticity.sum() == pytest.approx(0.0, abs=1e-7)
    assert found.frequency_elasticity.sum() == pytest.approx(0.0, abs=1e-7)


def test_parameters_at_the_edge_of_what_is_permitted():
    """A damping of zero that must not turn negative, and numbers that cannot change at all."""
    wheelset = Wheelset()
    point, = stability(wheelset.model())[0].crossings

    def damped(value):
        if value < 0:
            raise ModelError("negative damping")
        model = wheelset.model()
        return replace(model, damping_constant=np.diag([value, 0.0]))

    def fixed(value):
        raise ModelError("nothing else fits")

    found = sensitivities(point, [Parameter("damping", 0.0, "N*s/m", damped), Parameter("fixed", 1.0, "-", fixed),
                                  Parameter("cone", np.inf, "m", fixed)])
    ahead, = stability(damped(10.0))
    assert found.speed_derivative[0] == pytest.approx((ahead.speed - point.speed) / 10.0, rel=1e-4)
    assert "nothing else fits" in found.skipped["fixed"] and "inf" in found.skipped["cone"]
    with pytest.raises(ModelError, match="left out"):
        found.index("fixed")
    with pytest.raises(ModelError, match="near: damping"):
        found.index("dampin")


@pytest.fixture(scope="module")
def bogie():
    return load_vehicle("bogie")


@pytest.mark.parametrize("ratio", [None, 0.05])
def test_vehicle_file_against_critical_speeds(bogie, ratio):
    components = bogie.parameters.components()
    stiffness = next(name for name, value in components.items() if ".stiffness.0" in name and value > 0)
    inertia = next(name for name in components if name.startswith("wheelset") and name.endswith("inertia.0"))
    inertia = f"{inertia} + {inertia[:-1]}2"
    names = ["conicity", stiffness, inertia, "contact.kalker_weight", "vehicle.gravity"]
    found = sensitivity(bogie, 0.2, damping_ratio=ratio, parameters=names)
    assert set(found.names) == set(names)
    for k, name in enumerate(found.names):
        step = 1e-4 * found.values[k]

        def speed(value, name=name):
            changes = {} if name == "conicity" else dict.fromkeys(name.split(" + "), value)
            return float(critical_speed(bogie.replace(changes), value if name == "conicity" else 0.2, damping_ratio=ratio).speed)

        difference = (speed(found.values[k] + step) - speed(found.values[k] - step)) / (2 * step)
        assert found.speed_derivative[k] == pytest.approx(difference, rel=1e-4), name


def test_every_number_of_a_vehicle_file_is_in_the_table(bogie):
    found = sensitivity(bogie, 0.2)
    listed = {part for name in (*found.names, *found.skipped) for part in name.split(" + ")}
    assert listed == set(bogie.parameters.components()) | {"conicity"}
    assert np.isfinite(found.speed_derivative).all()
    places = [k for k, name in enumerate(found.names) if ".position." in name]
    assert places and (found.scale[places] == 1.0).all()


def test_no_critical_speed_to_differentiate(bogie):
    with pytest.raises(ModelError, match="no mode becomes unstable"):
        sensitivity(bogie, 0.2, speed_range=(5.0, 10.0))
    with pytest.raises(ModelError, match="crossing 7 does not exist"):
        sensitivity(bogie, 0.2, crossing=7)
    with pytest.raises(ModelError, match="near: conicity"):
        sensitivity(bogie, 0.2, parameters=["conicit"])
