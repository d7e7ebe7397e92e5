# SPDX-License-Identifier: BSD-3-Clause
"""What a step does besides solving: memory, places it lands on, iterations, rails within it, what it names when it fails."""

import os
import shutil
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import railsym as rs
from railsym.conical_contact import Cone, ConicalContact
from railsym.simulation import Simulation
from railsym.simulation.failure import ending_of
from railsym.track import Curve, Straight, Track, Transition
from railsym.track.irregularity import read_irregularity

BOGIE = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
CONES = ConicalContact(zones=(Cone(0.1),))
ROUGH = Track.straight(400.0).with_irregularity("erri_b176_low", seed=1)

FULL = """
import resource, signal
import railsym as rs
from railsym.conical_contact import Cone, ConicalContact

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
given = {"speed": 40.0, "contact": ConicalContact(zones=(Cone(0.1),)), "channels": "*.y", "rate": 1000.0, "save": "run.nc"}
vehicle = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
rs.simulate(vehicle, duration=0.1, **given)
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
try:
    rs.simulate(vehicle, duration=20.0, **given)
except rs.RailsymError as error:
    run, written = error.run, rs.Run.from_netcdf("run.nc.part")
    print(error)
    assert "file of that name is as it was" in str(error) and run.status == "interrupted" and "File too large" in run.message
    assert len(run) > len(written) > 4000 and (run["car.y"][:len(written)] == written["car.y"]).all()
print(len(rs.Run.from_netcdf("run.nc")))
"""
COUNTER = """
#include <stddef.h>
void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t), *__libc_memalign(size_t, size_t);
static long calls;
long allocations(void) { return calls; }
void *malloc(size_t n) { calls++; return __libc_malloc(n); }
void *calloc(size_t k, size_t n) { calls++; return __libc_calloc(k, n); }
void *realloc(void *p, size_t n) { calls++; return __libc_realloc(p, n); }
void *aligned_alloc(size_t a, size_t n) { calls++; return __libc_memalign(a, n); }
"""
COUNTED = """
import ctypes
import numpy as np
import railsym as rs
from railsym.conical_contact import Cone, ConicalContact
from railsym.simulation import Simulation
from railsym.simulation.failure import ending_of

track = rs.Track.straight(400.0).with_irregularity("erri_b176_low", seed=1)
vehicle = rs.load_vehicle("bogie").configured("with_anti_yaw_dampers")
simulation = Simulation(vehicle, speed=40.0, track=track, contact=ConicalContact(zones=(Cone(0.1),)), channels="*.Q", rate=1000.0, tolerance=1e-5)
integrator, room = simulation.parts.integrator, np.empty((2000, len(simulation.recorder.raw)))
allocations, found = ctypes.CDLL(None).allocations, []
for steps in (100, 10, 1000):
    before = allocations()
    integrator.run(steps, 1, room)
    found.append(allocations() - before)
report = integrator.report
assert before > 1000 and report.steps == 1110 and report.residuals > 1200 and report.wheel_factors > 3, (report.residuals, report.wheel_factors)
print(*found[1:])
"""


@pytest.mark.skipif(not sys.platform.startswith("linux") or not shutil.which("cc"), reason="counts allocations in front of glibc, by a library made here")
def test_no_allocation_in_a_step(tmp_path):
    """A thousand steps with samples, second iterations and new factors allocate as often as ten: what the call itself takes."""
    (tmp_path / "counter.c").write_text(COUNTER)
    subprocess.run(["cc", "-shared", "-fPIC", "-fno-builtin", "counter.c", "-o", "counter.so"], cwd=tmp_path, check=True)
    done = subprocess.run([sys.executable, "-c", COUNTED], capture_output=True, text=True, timeout=60, env=os.environ | {"LD_PRELOAD": str(tmp_path / "counter.so")})
    assert done.returncode == 0, done.stderr
    few, many = map(int, done.stdout.split())
    assert many <= few + 3 and many < 50


def test_steps_land_on_the_ends_of_transitions(monkeypatch):
    """A body passes the ends of a transition at its own time, which no step of 2 ms would meet: there the step ends and accelerations are
    found anew."""
    from railsym.simulation.assembled import Assembled

    track = Track([Straight(3.0137), Transition(2.0), Curve(300.0, 100.0, 0.0, "right")])

    def run():
        simulation = Simulation(BOGIE, speed=20.0, track=track, contact=CONES, dt=2e-3, channels="s")
        simulation.run(0.5)
        return simulation.parts.integrator.report.pencils, simulation.parts.kinks(0.5)

    pencils, kinks = run()
    off = np.abs(kinks / 2e-3 - np.round(kinks / 2e-3)) > 0.01
    assert off.sum() >= 4
    monkeypatch.setattr(Assembled, "kinks", lambda self, end: np.empty(0))
    # each kink takes a mass matrix, and one for the shorter step before it and after it
    assert pencils - run()[0] >= 2 * off.sum()


def test_a_second_iteration_where_the_residual_asks_for_it():
    """One step in twenty takes a second residual at the usual tolerance; at a tight one most do. What is left wrong is within it."""
    found = []
    for tolerance in (1e-2, 1e-8):
        simulation = Simulation(BOGIE, speed=40.0, track=ROUGH, contact=CONES, tolerance=tolerance, channels="*.ay", rate=1000.0)
        simulation.run(1.0)
        report = simulation.parts.integrator.report
        found.append(((report.residuals + report.wheel_factors + report.pencils) / report.steps, simulation.result()["car.ay"]))
    looks = [looks for looks, _ in found]
    assert looks[0] < 1.15 < 1.5 < looks[1]
    assert 0.0 < np.abs(found[0][1] - found[1][1]).max() < 1e-2


def test_wheel_forces_on_rails_that_bend_within_a_step():
    """Rails go straight within a step, as places do in the scheme: slow parts of Q do not depend on the step. With the rails at the place
    in between, as they are there, Q below 20 Hz is wrong by a tenth of its variation: half a micrometre on a contact of 1 GN/m."""
    from scipy.signal import butter, sosfiltfilt

    slow = butter(4, 20.0, fs=500.0, output="sos")
    courses = [sosfiltfilt(slow, rs.simulate(BOGIE, speed=60.0, duration=1.0, dt=dt, track=ROUGH, contact=CONES, law="polach",
                                             channels="wheelset1.left.Q", rate=500.0)["wheelset1.left.Q"]) for dt in (1e-3, 1e-4)]
    varies, wrong = courses[1].std(), (courses[0] - courses[1]).std()
    assert varies > 500.0 and wrong < 0.02 * varies


def test_what_is_not_a_number_is_named_wherever_it_is():
    """In an applied force, in the state of a wheelset and in a rate: the run ends before the step, with what there was."""
    for name, part, said in (("car.roll", None, "car.roll"), ("wheelset2.y", 0, "wheelset2"), ("frame.z", 1, "frame.z")):
        simulation = Simulation(BOGIE, speed=40.0, contact=CONES, channels="*.y", rate=1000.0)
        simulation.run(0.01)
        integrator, number = simulation.parts.integrator, simulation.parts.names.index(name)
        if part is None:
            integrator.force[number] = np.nan
        else:
            state = integrator.state()
            state[part][number] = np.nan
            status = integrator.start(simulation.time, *state[:2])
            assert status
            assert said in str(ending_of(simulation.parts, status))
            continue
        simulation.run(0.01)
        run = simulation.result()
        assert run.status == "not_converged" and said in run.message and len(run) == 11


def test_ctrl_c_returns_what_was_computed():
    """The signal comes while C is at work: every sample up to the time at which the run says it was interrupted is there."""
    simulation = Simulation(BOGIE, speed=40.0, contact=CONES, channels="*.y", rate=1000.0)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    simulation.run(3600.0)
    timer.join()
    run = simulation.result()
    assert run.status == "interrupted" and run.info.ending.time > 0.4 and len(run) == run.info.extra["counts"]["steps"] + 1
    assert run.time[-1] == pytest.approx(run.info.ending.time, abs=1e-9)


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are POSIX")
def test_a_full_disk_loses_neither_the_run_nor_the_one_before(tmp_path):
    done = subprocess.run([sys.executable, "-c", FULL], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "writing stopped after" in done.stdout and done.stdout.split()[-1] == "101"


def test_irregularities_shorter_than_the_run(tmp_path):
    """A measured file that ends before the track does, and a track that ends before the run does."""
    path = tmp_path / "short.csv"
    s = np.arange(0.0, 50.1, 0.5)
    path.write_text("s [m],vertical [mm]\n" + "".join(f"{x:g},{np.sin(x):.6f}\n" for x in s))
    measured = read_irregularity(path)
    with pytest.raises(rs.RailsymError, match="ends at s = 50 m, the track at 200 m: it is 150 m too short; shorten the track, or say covers=False"):
        Track.straight(200.0).with_irregularity(measured)
    with pytest.raises(rs.RailsymError, match="beyond its end"):
        Simulation(BOGIE, speed=40.0, track=Track.straight(50.0).with_irregularity(measured), contact=CONES).run(5.0)
