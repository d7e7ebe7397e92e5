# SPDX-License-Identifier: BSD-3-Clause
"""A limit cycle, and how to fall into it

Linear theory says at which speed a small motion grows; how far it grows only the profiles decide. The wheelsets of the trailing bogie start from 0.5 mm and from 5 mm, below and above the
linear critical speed (230 km/h).
"""

import sys

import matplotlib.pyplot as plt

import railsym as rs

train = rs.load_vehicle("pendolino").configured("noAS_K")
pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)
figure, panels = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
for axes, speed in zip(panels, (60.0, 75.0)):
    for start in (0.5e-3, 5e-3):
        run = rs.simulate(train, speed=speed, duration=6.0, contact=pair, initial={"wheelset3.y": start, "wheelset4.y": start}, law="polach")
        axes.plot(run.time, 1e3 * run["wheelset4.y"], lw=0.9, label=f"from {1e3 * start:g} mm")
        late = run["wheelset4.y"][run.time > 4.5]
        print(f"{speed * 3.6:.0f} km/h from {1e3 * start:g} mm: {500 * (late.max() - late.min()):.1f} mm after 5 s")
    axes.set(xlabel="time, s", title=f"{speed * 3.6:.0f} km/h")
panels[0].set_ylabel("wheelset 4, lateral, mm")
panels[0].legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "limit_cycle.png", dpi=110)
