# SPDX-License-Identifier: BSD-3-Clause
"""Equivalent conicity of S1002 on UIC 60

The same wheel on the same rail is a different pair at another inclination: 1:40 steers, 1:20 hardly does. Elastic contact smooths what rigid contact jumps over.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import railsym as rs

amplitudes = np.linspace(0.5e-3, 6e-3, 23)
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for name, inclination in (("1:40", 1 / 40), ("1:20", 1 / 20)):
    pair = rs.ContactPair("S1002", "UIC60", inclination=inclination)
    rigid = pair.equivalent_conicity(amplitudes).conicity
    axes.plot(1e3 * amplitudes, rigid, label=f"rail inclined {name}, rigid")
    print(f"{name}: {np.interp(3e-3, amplitudes, rigid):.3f} at 3 mm")
    if name == "1:40":
        elastic = pair.equivalent_conicity(amplitudes, load=60e3).conicity
        axes.plot(1e3 * amplitudes, elastic, "--", label=f"rail inclined {name}, elastic under 60 kN")
axes.set(xlabel="amplitude of the lateral motion, mm", ylabel="equivalent conicity", ylim=(0, None))
axes.legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "equivalent_conicity.png", dpi=110)
