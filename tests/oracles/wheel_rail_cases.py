# SPDX-License-Identifier: BSD-3-Clause
"""Wheelsets on conical contacts for the tests of the wheel-rail forces in motion."""

import numpy as np
from oracles.wheel_rail_motion import Setting, State

from railsym.creep import Material
from railsym.conical_contact import Cone, ConicalContact
from railsym.wheel_rail import WheelRail, WheelsetPlace

R0, SPEED = 0.46, 35.0
TREAD = Cone(0.1)
# A flange at 68 degrees, 6 mm from the gauge face of the rail along y: 5.6 mm along its normal.
FLANGE = Cone(2.5, half_spacing=0.715, radius=0.472, rail_radius=0.013, gap=5.6e-3)
TWO_ZONES = ConicalContact((TREAD, FLANGE))
TREAD_ONLY = ConicalContact((TREAD,))
FORCES = {"damping": 0.0, "law": "polach"}


def wheelset(contact=TREAD_ONLY, **options):
    """WheelRail of one wheelset, each wheel carrying 60 kN at rest."""
    options = {"wheel_loads": 6e4} | FORCES | options
    return WheelRail([WheelsetPlace("wheelset 1", 0, (0.0, 0.0, -R0))], contact, **options)


def setting(contact, forces, **options):
    """The same for the oracle."""
    options = FORCES | options
    zones = [contact._zone(zone) for zone in contact.zones]
    return Setting(contact.zones, tuple(z["stiffness"] for z in zones), tuple((z["a"], z["b"]) for z in zones), options["law"],
                   options.get("friction", 0.3), options["damping"], float(forces.sink[0]), options.get("kalker_weight", 1.0),
                   material=options.get("material", Material()))


def rolling(**rates):
    """Rates of pure rolling on r0, with changes by name."""
    u = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -SPEED / R0])
    for name, value in rates.items():
        u[("x", "y", "z", "yaw", "roll", "spin").index(name)] += value
    return u


def random_state(rng, shift=0.0):
    """A wheelset away from its place on rails away from theirs, in a curve; `shift` against them to the right, m.

    It rolls with its shift so that both treads stay in contact.
    """
    rails = rng.normal(size=(2, 4)) * [1e-4, 1e-5, 4e-3, 5e-4] + rng.normal(size=4) * [1e-3, 1e-5, 0.0, 0.0]
    q = rng.normal(size=6) * [2e-2, 1e-4, 1e-5, 5e-3, 1e-5, 1.0]
    q[1] += shift + rails[:, 0].mean()
    q[4] -= TREAD.slope * (q[1] - rails[:, 0].mean()) / (TREAD.half_spacing - R0 * TREAD.slope)
    u = rolling() + rng.normal(size=6) * [0.1, 0.1, 0.02, 0.05, 0.02, 0.2]
    return State(q, u, SPEED, rng.normal(size=3) * 0.05, rails)


def lie(rails):
    """Eight numbers of rs_wheel_rail_rows from (left, right) of (y, z, dy/ds, dz/ds)."""
    return np.concatenate([rails[0][:2], rails[1][:2], rails[0][2:], rails[1][2:]])


def rows_of(forces, state, seed=None):
    return forces.rows(state.q, state.u, state.speed, state.w, lie(state.rails), seed)
