# SPDX-License-Identifier: BSD-3-Clause
"""Ten thousand critical speeds, of a wheelset and of the 31-body vehicle: the same bytes however they were computed."""

import time

import numpy as np
import pytest
from sweep_analysis import LoggedSpeed, numbers
from sweep_processes import dask_client
from test_sweep_kill import killed_and_resumed

import railsym as rs
from railsym import sweep

pytestmark = pytest.mark.slow
CASES = 10_000


def study(folder, cases=CASES):
    vehicle, factors = folder.name.rstrip("0123456789"), {"contact.conicity": sweep.Uniform(0.05, 0.4), "contact.friction": sweep.Uniform(0.2, 0.4)}
    if vehicle == "wheelset":
        factors |= {"wheelset.mass": sweep.Normal(100, 5, unit="%")}
        return rs.Study(vehicle, LoggedSpeed(log=str(folder / "log")), factors, sweep.LatinHypercube(cases), seed=1)
    factors |= {"anti_yaw_damper.series_stiffness": sweep.Uniform(4, 6, unit="MN/m"),
                "anti_yaw_damper.damping": sweep.Uniform(80, 120, unit="%"), "truss_axlebox_bushing.stiffness.0": sweep.Normal(100, 5, unit="%"),
                "car.mass": sweep.Uniform(95, 105, unit="%")}
    return rs.Study(vehicle, LoggedSpeed(log=str(folder / "log")), factors, sweep.LatinHypercube(cases), configuration="AS_K", seed=1)


@pytest.fixture(scope="module", params=["wheelset", "pendolino"])
def folder(request, tmp_path_factory):
    return tmp_path_factory.mktemp(request.param)


def computed(folder, name, **place):
    """Run the study, count its cases, and keep its bytes."""
    (folder / "log").unlink(missing_ok=True)
    start = time.perf_counter()
    results = study(folder).run(folder / f"{name}.nc", **place)
    assert results.complete and not results.errors and len(numbers(folder / "log")) == CASES
    print(name, f"{time.perf_counter() - start:.1f} s", results.message)
    return (folder / f"{name}.nc").read_bytes()


@pytest.fixture(scope="module")
def reference(folder):
    return computed(folder, "serial")


@pytest.mark.parametrize("workers", [2, 4])
def test_by_processes(folder, reference, workers):
    assert computed(folder, f"by_{workers}", workers=workers) == reference


def test_on_dask(folder, reference):
    pytest.importorskip("distributed")
    with dask_client(folder, 2) as client:
        assert computed(folder, "dask", executor=client) == reference


def test_killed_twenty_times_and_resumed(folder, reference):
    before, count = killed_and_resumed(folder, study(folder), 20, np.random.default_rng(1), (1, 700))
    assert (folder / "r.nc").read_bytes() == reference
    assert len(before) == 21 and len(before[-1]) < CASES
    print("computed again:", count - CASES)
    # 2 chunks for each of 2 workers and one being written: of 0.1 s or of the first guesses, which cases of a few ms keep below 64
    assert count - CASES <= 20 * 5 * 64


def test_spread_of_the_speeds(folder, reference):
    """Conicity decides: the critical speed falls with it, by rank."""
    from scipy.stats import spearmanr

    results = sweep.load(folder / "serial.nc")
    found = np.isfinite(results["speed"])
    assert found.mean() > 0.3 and spearmanr(results["contact.conicity"][found], results["speed"][found]).statistic < -0.7
