# SPDX-License-Identifier: BSD-3-Clause
"""Critical speed of the Pendolino

31 bodies, with anti-yaw dampers and without, and with one of them missing: as good as none. The dampers are Maxwell models; viscous ones promise far more than a
real damper gives.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs

train = rs.load_vehicle("pendolino")
conicity = np.linspace(0.1, 0.4, 7)
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for name, words in (("AS_noK", "viscous anti-yaw dampers"), ("AS_K", "anti-yaw dampers"), ("AS_Mal_K", "one absent"), ("noAS_K", "none")):
    found = rs.critical_speed(train.configured(name), conicity=conicity)
    axes.plot(conicity, found.speed * 3.6, "o-", label=words)
    print(f"{words:25s} {found.speed[2] * 3.6:.0f} km/h at conicity {conicity[2]:.1f}, {found.frequency_hz[2]:.1f} Hz")
axes.set(xlabel="equivalent conicity", ylabel="critical speed, km/h", ylim=(0, None))
axes.legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "critical_speed.png", dpi=110)
