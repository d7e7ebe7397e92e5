# SPDX-License-Identifier: BSD-3-Clause
"""Cost of tilting control: the S-curve of the paper with ERRI low irregularities at 1 ms, uncontrolled, with the controller in C and in Python at 100 Hz.

CPU times, the least of several rounds in turns, so that all three meet the same machine. The peer is the run without control.
"""

from time import process_time, perf_counter

import numpy as np

import railsym as rs
from benchmarks.measure import Figure
from railsym.contact_pair import DEEPEST_IN_MOTION
from railsym.simulation import Simulation
from railsym.tilt import CompiledController, Controller, TiltParameters, TiltUnit
from railsym.track import load_track

SPEED, DURATION, ROUNDS = 105.0 / 3.6, 30.0, 9


def tilt_figures():
    """Real time with the controller in Python, and what the controllers add."""
    vehicle, track = rs.load_vehicle("pendolino_tilting").configured("AS_K"), load_track("s_curve_500").with_irregularity("erri_b176_low", seed=1)
    table = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table(deepest=DEEPEST_IN_MOTION)
    laws = {"none": None, "C": CompiledController, "Python": Controller}
    best = dict.fromkeys(laws, np.inf)
    for _ in range(ROUNDS):
        for name, law in laws.items():
            best[name] = min(best[name], _time(vehicle, track, table, law))
    steps = DURATION / 1e-3
    note = "33 bodies, ERRI low, FASTSIM 20 x 20, sensors read every ms"
    yield Figure("controlled S-curve, Python at 100 Hz", DURATION / best["Python"], "", 40.0, f"times real time; {note}", at_least=True)
    yield Figure("controlled S-curve in C over uncontrolled", best["C"] / best["none"], "", 1.10, f"{1e6 * best['C'] / steps:.1f} and {1e6 * best['none'] / steps:.1f} us a step")
    yield Figure("controlled S-curve in C", DURATION / best["C"], "", None, "times real time")
    yield from alone()


def _time(vehicle, track, table, law):
    simulation = Simulation(vehicle, speed=SPEED, track=track, contact=table, law="fastsim", channels=["car.roll", "car.ay"], rate=100.0)
    control = [] if law is None else [TiltUnit(law(TiltParameters())).controller]
    start = process_time()
    simulation.run(DURATION, controllers=control)
    return process_time() - start


def alone():
    """A sample of the controllers by themselves."""
    rng = np.random.default_rng(1)
    signals = np.column_stack([*(0.05 * rng.standard_normal((5, 2000))), np.full(2000, SPEED), SPEED * 0.01 * np.arange(2000)])
    times, p = 0.01 * np.arange(2000), TiltParameters(follow_tolerance=1.0)
    for name, kind in (("C", CompiledController), ("Python", Controller)):
        best = np.inf
        for _ in range(5):
            start = perf_counter()
            kind(p).replay(times, signals)
            best = min(best, perf_counter() - start)
        yield Figure(f"a sample of the tilting controller in {name}", 1e6 * best / 2000, "us", None, "on recorded signals")
