# SPDX-License-Identifier: BSD-3-Clause
"""railsym switch: verdicts, JSON, pictures, errors."""

import json

import pytest

import railsym as rs
from railsym.cli import main

CASE = ["switch", "pendolino", "--configuration", "noAS_K", "--wheel", "S1002", "--rail", "UIC60", "--inclination", "1:40", "--no-threshold",
        "--ratio", "0.8,1.05", "--after", "3.4s"]


def run(capsys, *arguments):
    """Exit status, standard output and standard error."""
    status = main(arguments)
    return status, *capsys.readouterr()


def test_verdicts_json_and_pictures(capsys, tmp_path):
    pictures, data = [tmp_path / "a.png", tmp_path / "b.svg"], tmp_path / "study.json"
    status, out, err = run(capsys, *CASE, "--plot", str(pictures[0]), "--plot-amplitudes", str(pictures[1]), "--json", str(data))
    assert (status, err) == (0, "")
    lines = {line.split()[0]: line for line in out.splitlines() if line.startswith(("0.80", "1.05"))}
    assert " stable " in lines["0.80"] and " unstable " in lines["1.05"]
    vehicle = rs.load_vehicle("pendolino").configured("noAS_K")
    V0 = float(rs.critical_speed(vehicle, contact=rs.ContactPair("S1002", "UIC60", inclination=1 / 40).linear_contact(3e-3)).speed)
    assert f"V0 = {3.6 * V0:.1f} km/h" in out and "bump, both rails, 5 mm over 10 m" in out and "assumed" in out
    found = json.loads(data.read_text())
    assert found["reference"] == pytest.approx(V0, rel=1e-9) and found["threshold"] is None
    assert [entry["verdict"] for entry in found["runs"]] == ["stable", "unstable"]
    assert found["runs"][1]["speed"] == pytest.approx(1.05 * V0, rel=1e-9) and found["units"]["sustained"] == "m/s^2"
    assert pictures[0].read_bytes().startswith(b"\x89PNG") and b"<svg" in pictures[1].read_bytes()[:1000]


@pytest.mark.parametrize("arguments, words", [
    (["--ratio", "0.9,0.8"], "ascending"),
    (["--reference", "250"], "has no unit"),
    (["--reference", "0km/h"], "above 0"),
    (["--amplitude", "2,3mm"], "one amplitude"),
    (["--switch-amplitude", "5"], "has no unit"),
    (["--switch-shape", "bumpy"], "bump"),
    (["--wheel", "S1002"], "a rail is needed too"),
    (["--law", "fastsimm"], "fastsim"),
    (["--plot", "study.xyz"], ".png"),
    (["--swich-length", "5m"], "nearest: --switch-length"),
])
def test_errors_say_what_to_do(capsys, arguments, words):
    status, out, err = run(capsys, "switch", "pendolino", "--configuration", "noAS_K", *arguments)
    assert status == 2 and out == "" and words in err and err.count("\n") == 1
