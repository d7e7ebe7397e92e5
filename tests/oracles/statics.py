# SPDX-License-Identifier: BSD-3-Clause
"""Forces that make the design position the equilibrium at rest on straight level track."""

import numpy as np


def static_deflection(stiffness, gravity_force, held):
    """Smallest displacement that balances gravity on elastic supports, and the reactions where it is held.

    Solves K d = F + R with d = 0 on `held` (indices) and R = 0 elsewhere.  Directions that no element resists
    (longitudinal position, spin) are left at zero by the minimum norm; a load along one of them has no equilibrium.

    Returns
    -------
    deflection (n,), reactions (len(held),)

    Raises
    ------
    ValueError
        No equilibrium: gravity loads a direction that nothing resists.
    """
    n = len(gravity_force)
    free = np.setdiff1d(np.arange(n), held)
    deflection = np.zeros(n)
    # rcond: real vehicles span 1e4 ... 1e9 N/m, round-off of rigid directions is 1e-16 of the largest.
    deflection[free] = np.linalg.lstsq(stiffness[np.ix_(free, free)], gravity_force[free], rcond=1e-13)[0]
    balance = stiffness @ deflection - gravity_force
    worst = np.abs(balance[free]).max(initial=0.0)
    if worst > 1e-6 * np.abs(gravity_force).max():
        place = free[np.argmax(np.abs(balance[free]))]
        raise ValueError(f"no static equilibrium: coordinate {place} keeps a load of {worst:.4g} N (or N m)")
    return deflection, balance[held]


def wheel_loads(reaction_z, reaction_roll, half_spacing):
    """Normal loads (left, right) of a wheelset from its generalised reactions.

    The rails push up: R_z = -(N_l + N_r), R_roll = -b0 (N_r - N_l).
    """
    mean, difference = -0.5 * reaction_z, -0.5 * reaction_roll / half_spacing
    return mean - difference, mean + difference
