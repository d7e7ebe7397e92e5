# SPDX-License-Identifier: BSD-3-Clause
"""Forces in curves

Equilibria of the Pendolino in curves of 250 to 1500 m at 100 mm cant deficiency: derailment ratio Y/Q, angle of attack and wear of the leading wheelset.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs

train = rs.load_vehicle("pendolino").configured("AS_K")
pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)
found = rs.curving(train, radius=np.linspace(250.0, 1500.0, 11), cant=0.15, cant_deficiency=[0.1], contact=pair)
figure, panels = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
for wheel in ("left", "right"):
    panels[0].plot(found.radius, found.of("YQ", f"wheelset1.{wheel}")[0], "o-", label=wheel)
    panels[2].plot(found.radius, found.of("t_gamma", f"wheelset1.{wheel}")[0], "o-", label=wheel)
panels[1].plot(found.radius, 1e3 * found.of("angle_of_attack", "wheelset1")[0], "o-")
for axes, words in zip(panels, ("Y/Q of wheelset 1", "angle of attack, mrad", "wear number T-gamma, N")):
    axes.set(xlabel="radius, m", title=words)
panels[0].legend()
print(f"R = {found.radius[0]:.0f} m: Y/Q {found.of('YQ', 'wheelset1.left')[0, 0]:.2f} outside, wear number {found.of('t_gamma', 'wheelset1.left')[0, 0]:.0f} N")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "curves.png", dpi=110)
