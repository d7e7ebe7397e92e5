# SPDX-License-Identifier: BSD-3-Clause
"""A wheelset hunts

Two cones on an axle steer themselves back to the middle of the track and past it: the wheelset hunts. Slowly rolling and alone it does so with Klingel's
wavelength 2 pi sqrt(b r/lambda), whatever its mass; held by springs it is stable up to a critical speed, beyond which the motion grows.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs

RADIUS, HALF_SPACING = 0.46, 0.75
wheelset = rs.load_vehicle("wheelset")
soft = wheelset.replace({"guide.stiffness.0": 6e5, "guide.stiffness.1": 3e5})            # N/m
free = wheelset.replace({"guide.stiffness.0": 10.0, "guide.stiffness.1": 10.0})            # N/m: next to nothing in the track plane
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")

for conicity in (0.1, 0.2, 0.4):
    klingel = 2.0 * np.pi * np.sqrt(HALF_SPACING * RADIUS / conicity)
    modes = rs.linearise(free, speed=2.0, contact=rs.LinearContact(conicity=conicity)).modes()
    hunting = min((mode for mode in modes if mode.frequency_hz > 0.0), key=lambda mode: abs(mode.frequency_hz - 2.0 / klingel))
    print(f"conicity {conicity}: Klingel {klingel:.1f} m, railsym at 2 m/s {2.0 / hunting.frequency_hz:.1f} m")

conicities = np.linspace(0.05, 0.5, 10)
found = rs.critical_speed(soft, conicity=conicities)
left.plot(conicities, found.speed * 3.6, "o-")
left.set(xlabel="equivalent conicity", ylabel="critical speed, km/h", title="the higher the conicity the earlier")

contact = rs.LinearContact(conicity=0.2)
critical = rs.critical_speed(soft, conicity=[0.2]).speed[0]
for share in (0.9, 1.0, 1.05):
    run = rs.simulate(soft, speed=share * critical, contact=contact, duration=2.0, initial={"wheelset.y": 2e-3})
    right.plot(run.time, 1e3 * run["wheelset.y"], label=f"{share:g} of the critical speed")
right.set(xlabel="time, s", ylabel="lateral shift, mm", ylim=(-8, 8), title="conicity 0.2, let go at 2 mm")
right.legend(loc="upper left")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "wheelset_hunting.png", dpi=110)
