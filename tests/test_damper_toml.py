# SPDX-License-Identifier: BSD-3-Clause
"""An identified damper in the vehicle file: read back, and the whole vehicle with it."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest

import railsym as rs
from railsym.dampers import RecordError, damper_toml, put_into

SPEED, FORCE = (0.0, 0.01, 0.03, 0.1 / 3), (0.0, 7000.0, 12000.0, 12345.678901234567)
STIFFNESS = (6e6, 5e6, 4.5e6, 4.4e6)


def model(kind="maxwell", damping=None, curve=None, stiffness=None, stiffness_curve=None):
    return SimpleNamespace(kind=kind, damping=damping, damping_curve=curve, series_stiffness=stiffness, series_stiffness_curve=stiffness_curve)


CURVED = model(curve=(SPEED, FORCE), stiffness_curve=(SPEED, STIFFNESS))
MODELS = {"viscous": model("viscous", 3e5), "viscous curve": model("viscous", curve=(SPEED, FORCE)),
          "maxwell": model(damping=1.2345678e6, stiffness=5e6), "curve": model(curve=(SPEED, FORCE), stiffness=5e6), "curves": CURVED}


def test_written_lines_hold_every_digit(tmp_path):
    text = damper_toml(CURVED, tmp_path / "damper.toml", "yaw")
    assert (tmp_path / "damper.toml").read_text() == text
    read = tomllib.loads(text)
    assert read["curves"]["yaw_damping"]["x"] == [list(SPEED), "m/s"]
    assert read["curves"]["yaw_damping"]["y"] == [list(FORCE), "N"]
    assert read["elements"]["yaw"] == {"type": "maxwell", "damping_curve": "yaw_damping", "series_stiffness_curve": "yaw_series_stiffness",
                                       "origin": "yaw_bench"}
    assert "yaw_bench" in read["origins"]


@pytest.mark.parametrize("name", MODELS)
def test_the_vehicle_reads_the_same_numbers(tmp_path, name):
    wanted = MODELS[name]
    vehicle = rs.load_vehicle(put_into("pendolino", wanted, tmp_path / "vehicle.toml"))
    element = vehicle.element("anti_yaw_damper.front_left")
    assert element.type == ("maxwell" if wanted.kind == "maxwell" else "damper")
    given = element.parameters
    if wanted.damping_curve is None:
        assert given["damping"] == wanted.damping
    else:
        curve = given["damping_curve" if wanted.kind == "maxwell" else "curve"]
        assert np.array_equal(curve.x, SPEED) and np.array_equal(curve.y, FORCE)
    if wanted.series_stiffness is not None:
        assert given["series_stiffness"] == wanted.series_stiffness
    if wanted.series_stiffness_curve is not None:
        assert np.array_equal(given["series_stiffness_curve"].y, STIFFNESS)
    # nothing else has changed
    before = rs.load_vehicle("pendolino")
    assert [one.name for one in vehicle.elements] == [one.name for one in before.elements]
    assert set(vehicle.configurations) == set(before.configurations)
    assert np.array_equal(element.first.position, before.element("anti_yaw_damper.front_left").first.position)
    for configuration in vehicle.configurations:
        vehicle.configured(configuration)


def test_groups_and_names_that_cannot_be_used(tmp_path):
    with pytest.raises(RecordError, match="no group of elements 'yaw'; there are truss"):
        put_into("pendolino", CURVED, tmp_path / "v.toml", group="yaw")
    with pytest.raises(RecordError, match="is a bushing, not a damper"):
        put_into("pendolino", CURVED, tmp_path / "v.toml", group="secondary_spring")
    with pytest.raises(RecordError, match="vehicle file pendolin: "):
        put_into("pendolin", CURVED, tmp_path / "v.toml")
    with pytest.raises(RecordError, match="letters"):
        damper_toml(CURVED, name="a b")
