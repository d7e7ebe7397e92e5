# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of criteria.md: ``python docs/make_criteria_images.py`` with railsym installed.

The signals are those of the linear train without anti-yaw dampers (matrix exponential), 2 % above its critical speed, after a lateral
shift of the first wheelset, and not of a simulation: they show the criteria, not the vehicle.
"""

from pathlib import Path

import matplotlib
import numpy as np
from scipy.linalg import expm

import railsym as rs

HERE = Path(__file__).resolve().parent / "images"
STEP, SAMPLES = 4e-3, 3000      # s, 12 s


def linear_run(vehicle, speed, contact, shift):
    """Accelerations above the axleboxes of the linear vehicle whose first wheelset starts ``shift`` (m) off the centre."""
    lin = rs.linearise(vehicle, speed, contact)
    place = {name: k for k, name in enumerate(lin.states)}
    propagate, states = expm(STEP * lin.A), np.zeros((SAMPLES, len(place)))
    states[0, place["wheelset1.y"]] = shift
    for k in range(1, SAMPLES):
        states[k] = propagate @ states[k - 1]
    values = {}
    for name, (body, position) in rs.criteria.frame_markers(vehicle).items():
        lateral, yaw = (lin.A[place[f"{body}.{c}.rate"]] for c in ("y", "yaw"))
        values[f"{name}.ay"] = states @ (lateral + (position - vehicle.body(body).position)[0] * yaw)
    return rs.Run.from_arrays(np.arange(SAMPLES) * STEP, values, dict.fromkeys(values, "m/s^2"), vehicle=vehicle.name, speed=speed)


def main():
    """Both pictures."""
    matplotlib.use("Agg")
    vehicle = rs.load_vehicle("pendolino").configured("noAS_K")
    speed = 1.02 * float(rs.critical_speed(vehicle, 0.2).speed)
    run = linear_run(vehicle, speed, rs.LinearContact(conicity=0.2), 0.6e-3)
    found = rs.criteria.instability(run)
    print(found)
    print(rs.criteria.hunting_frequency(run, start=6.0))
    for axes, name in ((found.plot(), "instability.png"), (run.spectrum("bogie1.above_wheelset1_left.ay", band=(0.5, 12.0)).plot(), "spectrum.png")):
        figure = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()[0].figure
        figure.savefig(HERE / name, dpi=96, metadata={"Software": None}, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
