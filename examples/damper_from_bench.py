# SPDX-License-Identifier: BSD-3-Clause
"""A damper from bench records

The shipped records (synthetic ones, as no bench data are published) become a Maxwell damper whose series stiffness falls with speed. The loop at 3 Hz and 1.5 mm tells it from one
with a constant stiffness; the loop at 1 Hz and 1 mm does not.
"""

import sys
from importlib.resources import files

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs


def closed(cycle):
    """The cycle and its first value again."""
    return np.append(cycle, cycle[0])


records = rs.dampers.read_records(files("railsym") / "data" / "dampers")
tests = rs.dampers.clean_all(records)
fits = {kind: rs.dampers.identify(tests, model=kind) for kind in ("maxwell", "maxwell_nonlinear")}
figure, panels = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for axes, name in zip(panels, ("1Hz_1mm", "3Hz_1.5mm")):
    (test,) = (one for one in tests if one.name == name)
    _, displacement, _, force = test.mean_cycle
    axes.plot(1e3 * closed(displacement), 1e-3 * closed(force), "k-", lw=3, alpha=0.3, label="measured (mean cycle)")
    for kind, fit in fits.items():
        loop = rs.dampers.sweep(fit.model, test.frequency, test.amplitude)
        axes.plot(1e3 * closed(loop.displacement[0, 0]), 1e-3 * closed(loop.force[0, 0]), label=kind.replace("_", ", ").replace("nonlinear", "stiffness over speed"))
        (error,) = (one.loop_error for one in fit.tests if one.name == name)
        print(f"{name:10s} {kind:18s} loop error {100 * error:.1f} %")
    axes.set(xlabel="elongation, mm", ylabel="force, kN", title=name.replace("Hz_", " Hz, ").replace("mm", " mm"))
panels[0].legend(fontsize=8)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "damper_from_bench.png", dpi=110)
