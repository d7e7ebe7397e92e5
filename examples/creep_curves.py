# SPDX-License-Identifier: BSD-3-Clause
"""Creep forces by six laws

How the force between wheel and rail grows with longitudinal creepage, with and without spin. All laws begin with Kalker's coefficients (but FASTSIM and Polach not quite with
spin) and end at the friction limit; between them they differ by some per cent.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs

A, B, LOAD, FRICTION = 6e-3, 5e-3, 60e3, 0.3
steel = rs.Material(shear_modulus=8.2e10, poisson=0.28)
creepage = np.linspace(0.0, 5e-3, 101)
figure, panels = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
NAMES = {"exact": "exact theory", "fastrip": "FaStrip", "fastsim": "FASTSIM", "polach": "Polach", "shen_hedrick_elkins": "Shen-Hedrick-Elkins", "kalker_linear": "Kalker, linear"}
for axes, spin in zip(panels, (0.0, 0.4)):
    creepages = np.column_stack([creepage, np.zeros_like(creepage), np.full_like(creepage, spin)])
    for law, name in NAMES.items():
        forces = rs.creep_forces(law, A, B, creepages, LOAD, FRICTION, steel)
        total = np.hypot(forces[:, 0], forces[:, 1]) / (FRICTION * LOAD)
        axes.plot(1e3 * creepage, total, "k-" if law == "exact" else "-", label=name)
        print(f"spin {spin} 1/m, {name:20s} {np.interp(1e-3, creepage, total):.3f} of the friction limit at 1 per mil")
    axes.set(xlabel="longitudinal creepage, per mil", ylim=(0, 1.1), title=f"spin {spin} 1/m")
panels[0].set_ylabel("tangential force over friction limit")
panels[0].legend(loc="lower right")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "creep_curves.png", dpi=110)
