# SPDX-License-Identifier: BSD-3-Clause
"""The optimised Pendolino

How certain is a critical speed when its parameters have tolerances, and which anti-yaw damper is best? 200 trains within tolerances as a study; then the damper with the
highest critical speed at conicity 0.3, by the analytic gradient, and the same tolerances about it.
"""

import sys
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import railsym as rs
from railsym.optimise import Objective, Problem, SpeedDesign, Variable, optimise

train = rs.load_vehicle("pendolino").configured("AS_K")
damper = ("anti_yaw_damper.damping", "anti_yaw_damper.series_stiffness")
variables = [Variable(damper[0], 1e5, 1.2e6, "N*s/m", scale="log"), Variable(damper[1], 3e6, 7e6, "N/m")]
best = optimise(Problem(variables, SpeedDesign(train, damper, conicity=[0.3]), [Objective("speed(0.3)", "maximise", "m/s")]))
print(best)

figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for words, values in (("as in the file", {}), ("optimised damper", best.values)):
    nominal = train.replace(values).parameters
    factors = {name: rs.sweep.Normal(nominal[name].value, 0.1 * nominal[name].value) for name in (*damper, "traction_rod.stiffness")}
    study = rs.Study("pendolino", rs.sweep.CriticalSpeed(), {**factors, "contact.conicity": rs.sweep.Normal(0.3, 0.03)}, rs.sweep.LatinHypercube(200), configuration="AS_K", seed=1)
    with TemporaryDirectory() as folder:
        speed = 3.6 * study.run(f"{folder}/results.nc")["speed"]
    axes.hist(speed, bins=20, alpha=0.6, label=f"{words}: {speed.mean():.0f} km/h, deviation {speed.std():.0f}")
axes.set(xlabel="critical speed at conicity 0.3 with deviation 0.03, km/h", ylabel="trains of 200")
axes.legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "optimised_pendolino.png", dpi=110)
