# SPDX-License-Identifier: BSD-3-Clause
"""A ride over rough track

25 s of the Pendolino at 200 km/h over ERRI B176 irregularities, with non-linear contact from the profiles and FASTSIM: forces, the instability criterion, comfort.
"""

import sys

import matplotlib.pyplot as plt

import railsym as rs

train = rs.load_vehicle("pendolino").configured("AS_K")
pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)
track = rs.Track.straight(2000.0).with_irregularity("erri_b176_low", seed=1)
run = rs.simulate(train, speed=200 / 3.6, duration=25.0, track=track, contact=pair)
print(run.message)
print(rs.criteria.instability(run))
print(rs.criteria.comfort(run, place="car"))
figure, (above, below) = plt.subplots(2, 1, figsize=(9, 5), sharex=True, layout="constrained")
above.plot(run.time, 1e3 * run["wheelset1.y"], lw=0.8)
above.set(ylabel="wheelset 1, lateral, mm")
for wheel in ("left", "right"):
    below.plot(run.time, 1e-3 * run[f"wheelset1.{wheel}.Q"], lw=0.6, label=f"Q {wheel}")
    below.plot(run.time, 1e-3 * run[f"wheelset1.{wheel}.Y"], lw=0.6, label=f"Y {wheel}")
below.set(xlabel="time, s", ylabel="force on the rail, kN")
below.legend(ncols=4, fontsize=8)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "rough_track.png", dpi=110)
