# SPDX-License-Identifier: BSD-3-Clause
"""The command railsym, run in this process: what it prints, its JSON, pictures, errors and exit status."""

import json
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import railsym as rs
from railsym.cli import main
from railsym.cli_stability import report
from railsym.vehicle import SHIPPED

BOGIE = ["stability", "bogie", "--conicity", "0.1,0.3"]


def run(capsys, *arguments):
    """Exit status, standard output and standard error."""
    status = main(arguments)
    return status, *capsys.readouterr()


def test_stability_prints_the_critical_speeds_of_the_api(capsys):
    status, out, err = run(capsys, *BOGIE, "--criterion", "real_part")
    assert (status, err) == (0, "")
    found = rs.stability_map(rs.load_vehicle("bogie"), conicity=[0.1, 0.3], criteria=["real_part"])
    rows = {line.split()[0]: line for line in out.splitlines() if line}
    for name, row in zip(found.configurations, found.results):
        for speed, frequency in zip(row[0].speed, row[0].frequency_hz):
            assert f"{3.6 * speed:.0f} ({frequency:.1f})" in rows[name]
    assert "real part = 0" in out and "km/h" in out and "Hz" in out


def test_stability_as_json_holds_si_numbers_and_nothing_else(capsys):
    status, out, _ = run(capsys, *BOGIE, "--criterion", "real_part", "damping_ratio=5%", "--json")
    data = json.loads(out)
    assert status == 0 and data["vehicle"] == "bogie" and data["units"]["speed"] == "m/s"
    assert len(data["cases"]) == 2 * 2 * 2
    case = next(c for c in data["cases"] if c["criterion"] == "damping_ratio" and c["conicity"] == 0.3)
    vehicle = rs.load_vehicle("bogie").configured(case["configuration"])
    expected = rs.critical_speed(vehicle, conicity=0.3, damping_ratio=0.05)
    # the same computation twice; the scan may be shared between criteria, the solution is to rounding
    assert case["speed"] == pytest.approx(float(expected.speed), rel=1e-9)
    assert case["crossings"][0]["becomes"] == "unstable"
    assert data["contact"][case["configuration"]]["wheel_transverse_radius"] == "inf"


def test_json_to_a_file_leaves_the_table(capsys, tmp_path):
    target = tmp_path / "result.json"
    status, out, _ = run(capsys, *BOGIE, "--criterion", "real_part", "--json", str(target))
    assert status == 0 and "conicity" in out
    assert json.loads(target.read_text())["cases"][0]["message"]


def test_no_critical_speed_is_a_dash_with_its_reason(capsys):
    status, out, _ = run(capsys, *BOGIE, "--criterion", "real_part", "--speed-range", "20:40", "km/h")
    assert status == 0
    assert sum(line.split()[1:] == ["--", "--"] for line in out.splitlines()) == 2
    assert "conicity 0.1, 0.3: none from 20 to 40 km/h" in out
    status, out, _ = run(capsys, *BOGIE, "--criterion", "real_part", "--speed-range", "20:40km/h", "--json")
    assert [c["speed"] for c in json.loads(out)["cases"]] == [None] * 4


def test_already_unstable_says_so(capsys):
    status, out, _ = run(capsys, *BOGIE, "--criterion", "real_part", "--speed-range", "800:850km/h")
    assert status == 0 and "--" in out and "already unstable at the lowest speed" in out


def test_several_crossings_are_told():
    """Beyond the criterion, back, and beyond again: a star and all the speeds."""
    steps = tuple(SimpleNamespace(speed=v, direction=d) for v, d in ((20.0, 1), (30.0, -1), (50.0, 1)))
    result = SimpleNamespace(conicity=[0.1], speed=np.ma.array([20.0]), frequency_hz=np.ma.array([0.7]), crossings=(steps,),
                             message=("",), damping_ratio=0.1, speed_range=(5.0, 250.0))
    found = SimpleNamespace(configurations=("made_up",), results=((result,),), damping_ratios=(0.1,), conicity=np.array([0.1]))
    text = report(SimpleNamespace(name="made", description="up"), found)
    assert "72 (0.7)*" in text
    assert "* made_up, damping ratio = 10 %, conicity 0.1: below from 72, above from 108, below from 180 km/h" in text


def test_vehicle_without_configurations(capsys):
    status, out, _ = run(capsys, "stability", "wheelset", "--conicity", "0.3", "--criterion", "real_part")
    assert status == 0 and out.splitlines()[-1].startswith("wheelset")


def test_friction_and_amplitude_reach_the_contact(capsys):
    options = (*BOGIE, "--criterion", "real_part", "--friction", "0.6", "--amplitude", "5mm", "--json")
    data = json.loads(run(capsys, *options)[1])
    contact = rs.LinearContact(friction=0.6, amplitude=5e-3)
    expected = rs.critical_speed(rs.load_vehicle("bogie").configured("with_anti_yaw_dampers"), [0.1], contact=contact)
    assert data["cases"][0]["speed"] == pytest.approx(expected.speed[0], rel=1e-9)
    assert data["contact"]["with_anti_yaw_dampers"]["amplitude"] == 5e-3


def test_sensitivity_table(capsys):
    arguments = ("stability", "bogie", "--configuration", "with_anti_yaw_dampers", "--conicity", "0.2", "--sensitivity")
    status, out, _ = run(capsys, *arguments)
    assert status == 0 and "% of speed for 1 %" in out and "primary.stiffness.0" in out and "position" not in out
    listed = [line for line in out.splitlines() if line.startswith("conicity  ")]
    assert any(" -0." in line for line in listed), "critical speed falls as conicity rises"


@pytest.mark.parametrize("more", [[], ["--configuration", "with_anti_yaw_dampers"]])
def test_stability_plot(capsys, tmp_path, more):
    target = tmp_path / "stability.png"
    assert run(capsys, *BOGIE, *more, "--plot", str(target))[0] == 0
    assert target.read_bytes().startswith(b"\x89PNG")


def test_modes_lists_them_and_draws_one(capsys, tmp_path):
    target = tmp_path / "mode.svg"
    status, out, _ = run(capsys, "modes", "bogie", "--speed", "300", "km/h", "--conicity", "0.3", "--plot", str(target))
    assert status == 0 and "bogie hunting" in out and out.splitlines()[-1].startswith("unstable: bogie hunting")
    assert b"<svg" in target.read_bytes()[:1000]


def test_modes_as_json(capsys):
    status, out, _ = run(capsys, "modes", "bogie", "--speed", "30m/s", "--configuration", "without_anti_yaw_dampers", "--json")
    data = json.loads(out)
    assert status == 0 and data["configuration"] == "without_anti_yaw_dampers" and data["speed"] == 30.0
    vehicle = rs.load_vehicle("bogie").configured("without_anti_yaw_dampers")
    modes = rs.linearise(vehicle, 30.0, rs.LinearContact(conicity=0.2)).modes()
    for entry in data["modes"]:
        assert entry["frequency_hz"] == pytest.approx(modes[entry["number"]].frequency_hz, rel=1e-12)


def test_modes_followed_over_speed(capsys, tmp_path):
    target = tmp_path / "locus.png"
    status, out, _ = run(capsys, "modes", "bogie", "--speed", "100:300:3km/h", "--plot", str(target))
    assert status == 0 and [line.split()[0] for line in out.splitlines()[3:6]] == ["100", "200", "300"]
    assert target.stat().st_size > 10_000
    data = json.loads(run(capsys, "modes", "bogie", "--speed", "100:300:3km/h", "--json")[1])
    assert len(data["modes"][0]["eigenvalue"]) == 3


def test_vehicles(capsys):
    status, out, _ = run(capsys, "vehicles")
    assert status == 0 and all(f"{name}:" in out for name in rs.vehicles())
    assert "31 bodies" in out and "noAS_noK" in out
    data = {v["name"]: v for v in json.loads(run(capsys, "vehicles", "--json")[1])}
    assert len(data["pendolino"]["configurations"]) == 8


@pytest.mark.parametrize("arguments, words", [
    (["stability", "pendolin"], ["'pendolino'"]),
    (["stability", "bogie", "--configuration", "with_anti_yaw_damper"], ["nearest: 'with_anti_yaw_dampers'"]),
    (["stability", "wheelset", "--configuration", "AS_K"], ["no configurations"]),
    (["stability", "bogie", "--configuration", "a", "a"], ["twice"]),
    (["stability", "bogie", "--criterion", "damping=0.05"], ["nearest: damping_ratio"]),
    (["stability", "bogie", "--conicity", "0.1:0.2"], ["first:last:count"]),
    (["stability", "bogie", "--friction", "-1"], ["friction", "positive"]),
    (["stability", "bogie", "--friktion", "1"], ["'--friktion'", "nearest: --friction"]),
    (["stability", "bogie", "--speed-range", "20:700"], ["no unit"]),
    (["stability", "bogie", "--amplitude", "3kg"], ["wrong dimension"]),
    (["stability", "bogie", "--plot", "picture.xyz"], [".png"]),
    (["stability", "bogie", "--plot", "/no/such/place/a.png"], ["no directory"]),
    (["modes", "bogie"], ["--speed"]),
    (["modes", "bogie", "--speed", "200"], ["no unit", "200km/h"]),
    (["modes", "bogie", "--speed", "50m/s", "--conicity", "0.1,0.2"], ["one conicity"]),
    (["modes", "bogie", "--speed", "50m/s", "--mode", "9999"], ["--mode 9999"]),
    (["stabilty"], ["nearest: stability"]),
    ([], ["COMMAND"]),
])
def test_an_error_is_one_message_and_status_2(capsys, arguments, words):
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert err.startswith("railsym: ") and err.count("\n") == 1 and "Traceback" not in err
    assert all(word in err for word in words), err


def test_file_with_an_error_names_the_key(capsys, tmp_path):
    source = tmp_path / "mine.toml"
    source.write_text((SHIPPED / "wheelset.toml").read_text().replace("wheel_radius", "wheel_radus"))
    status, _, err = run(capsys, "stability", str(source))
    assert status == 2 and "mine.toml" in err and "wheel_radus" in err and "nearest: 'wheel_radius'" in err


def test_version(capsys):
    with pytest.raises(SystemExit) as left:
        main(["--version"])
    assert left.value.code == 0
    assert capsys.readouterr().out == f"railsym {rs.__version__}\n"


def test_runs_as_a_module(tmp_path):
    """From another directory: in the checkout ``python -m`` would find the source without its compiled library."""
    done = subprocess.run([sys.executable, "-m", "railsym", "modes", "bogie"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.startswith("railsym: ")


def test_a_reader_that_leaves_does_not_cost_the_picture(tmp_path):
    """As ``railsym ... | head -1`` does: the pipe is closed before anything is printed."""
    picture = tmp_path / "bogie.png"
    code = f"import sys; from railsym.cli import main; sys.exit(main({[*BOGIE, '--plot', str(picture)]!r}))"
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path)
    process.stdout.close()
    errors = process.stderr.read().decode()
    process.stderr.close()
    assert (process.wait(), errors) == (0, "")
    assert picture.stat().st_size > 1000
