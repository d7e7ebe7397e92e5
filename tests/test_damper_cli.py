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
                   "--json", str(folder / "d.json"), "--map", str(folder / "map.png")])
    assert status == 0
    return folder


def test_one_command_gives_picture_lines_and_numbers(done):
    assert (done / "d.png").stat().st_size > 50_000 and (done / "map.png").stat().st_size > 50_000
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


def test_the_map_shows_stiffness_and_phase_of_the_closed_form():
    """Filled levels of a linear damper: the highest colour lies where |K| is highest, and a test's place is marked."""
    import matplotlib.pyplot as plt
    import numpy as np

    from railsym.dampers import DamperModel, sweep
    from railsym.plots.damper_map import plot_damper_map

    model = DamperModel("maxwell", damping=4e5, series_stiffness=5e6)
    axes = np.ravel(plot_damper_map(model))
    for place, high, low in zip(axes[:2], (1e-6 * abs(model.dynamic_stiffness(10.0)), np.degrees(np.angle(model.dynamic_stiffness(0.2)))),
                                (1e-6 * abs(model.dynamic_stiffness(0.2)), np.degrees(np.angle(model.dynamic_stiffness(10.0))))):
        levels = np.concatenate([one.levels for one in place.collections if hasattr(one, "levels")])
        step = np.diff(np.unique(levels)).min()
        assert levels.min() == pytest.approx(low, abs=1.01 * step) and levels.max() == pytest.approx(high, abs=1.01 * step)
    assert abs(sweep(model, 2.0, 1e-3).dynamic_stiffness[0, 0]) == pytest.approx(abs(model.dynamic_stiffness(2.0)), rel=1e-4)
    plt.close("all")
