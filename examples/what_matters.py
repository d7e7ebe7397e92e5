# SPDX-License-Identifier: BSD-3-Clause
"""What moves the critical speed

One eigenproblem gives the derivative of the critical speed to every number of the vehicle file. The bars are the change for one per cent more of each.
"""

import sys

import matplotlib.pyplot as plt

import railsym as rs

train = rs.load_vehicle("pendolino").configured("AS_K")
found = rs.sensitivity(train, conicity=0.2)
print(found.table(8))
axes = rs.plots.plot_sensitivities(found)
plt.gcf().savefig(sys.argv[1] if len(sys.argv) > 1 else "what_matters.png", dpi=110)
