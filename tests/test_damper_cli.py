# SPDX-License-Identifier: BSD-3-Clause
"""``railsym damper`` on the records that come along: table, picture, vehicle-file lines, errors."""

import json
import tomllib

import pytest

from railsym.cli import main
from tests.oracles.damper_records import SHIPPED, SHIPPED_SENSORS


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("damper")
    status = main(["damper", "--model", "maxwell_nonlinear", "--plot", str(folder / "d.png"), "--write", str(folder / "d.toml"),
                   "--json", str(folder / "d.json")])
    assert status == 0
    return folder


def test_one_command_gives_picture_lines_and_numbers(done):
    assert (done / "d.png").stat().st_size > 50_000
    written = tomllib.loads((done / "d.toml").read_text())
    element = written["elements"]["anti_yaw_damper"]
    assert element["type"] == "maxwell" and element["series_stiffness_curve"] in written["curves"]
    data = json.loads((done / "d.json").read_text())
    assert set(data["models"]) == {"viscous", "maxwell", "maxwell_nonlinear"} and len(data["tests"]) == 12


def test_shipped_records_give_their_parameters_back(done):
    """5 % at 1 % noise and 2 ms lag: the curves where the tests reach them, in the middle of their speeds."""
    import numpy as np

    from railsym.plots.dampers import _straight_on

    model = json.loads((done / "d.json").read_text())["models"]["maxwell_nonlinear"]
    speed = np.array([0.006, 0.012, 0.018, 0.025])
    stiffness = _straight_on(*map(np.array, model["series_stiffness_curve"]), speed)
    assert stiffness == pytest.approx(SHIPPED.series_stiffness(speed), rel=0.05)
    x, y = map(np.array, model["damping_curve"])
    speed = np.array([0.003, 0.008])
    force = np.interp(speed, x, y)
    # within 3 % of the peak force, some 10 kN
    assert force == pytest.approx(SHIPPED.force(speed), abs=500.0)
    assert SHIPPED_SENSORS["noise"] == 0.01


def test_better_models_fit_better(done):
    tests = json.loads((done / "d.json").read_text())["tests"]
    mean = {name: sum(test["errors"][name]["loop"] for test in tests) / len(tests) for name in tests[0]["errors"]}
    assert mean["maxwell_nonlinear"] < 0.03 < mean["viscous"] and mean["maxwell_nonlinear"] < mean["maxwell"]


@pytest.mark.parametrize("arguments, message", [
    (["no_such.csv"], "there is no file no_such.csv"),
    (["--units", "length=mm"], "'length=mm': write channel=..., with a channel of time"),
    (["--plot", "x.jpgg"], "must end in one of"),
    (["--write", "/no/such/x.toml"], "there is no directory"),
    (["--modl", "maxwell"], "nearest: --model"),
])
def test_errors_are_one_line(capsys, arguments, message):
    assert main(["damper", *arguments]) == 2
    shown = capsys.readouterr().err
    assert message in shown and shown.count("\n") == 1
