# SPDX-License-Identifier: BSD-3-Clause
"""Linear wheel-rail forces of one wheelset rolling at speed V, from virtual power on paper.

Coordinates x y z yaw roll spin (a row vector over them below); side s = -1 left, +1 right; conicity lam, contact slope
delta = delta0 + s eps yc, yc = y - r0 roll the lateral shift at the contact, which is s b0 to the side and r0 below
the wheelset's centre.  Contact axes: x forward, n = (0, s delta, 1) into the rail, t = (0, 1, 0), or with `tilt`
(0, 1, -s delta) in the contact plane.

Normal force.  Virtual work -N dp of the penetration p, N = N0 + kH p: stiffness kH g g^T + N0 d2p, with
g = dp = (0, s delta0, 1, 0, s (b0 - r0 delta0), 0).  The second derivative d2p is that of a cone of slope delta0 that
lies on the edge of a rail (see `_edge_hessian`; there eps = delta0/b0 comes from the roll alone), and
(eps - delta0/b0) h h^T with h = dyc for a profile whose slope changes by eps.

Velocity of the wheel's material at the contact, w = (roll', 0, yaw') + Omega (-yaw, 1, roll), Omega = -V/r0 + spin',
arm (0, s b0, r0 + s lam yc):
    v_x = V + x' + w_y r_z - w_z r_y  ->  x' + r0 spin' - s b0 yaw' - V s lam yc/r0
    v_y = y' + w_z r_x - w_x r_z      ->  y' - r0 roll' - V yaw
    w.n                               ->  -V s delta/r0 - V roll/r0 + yaw' + s delta0 spin'
so xi = v_x/V, eta = v_y/V, spin = w.n/V.  Forces on the wheel Fx = -f11 xi, Fy = -(f22 eta + f23 spin),
Mz = f23 eta - f33 spin, and by virtual power they load the coordinates through the same velocity rows; the constant
part of Fy and Mz, from spin = -s delta0/r0, also acts through the change of those rows.
"""

from dataclasses import dataclass

import numpy as np

X, Y, Z, YAW, ROLL, SPIN = range(6)


@dataclass(frozen=True)
class ContactTerms:
    """Which small-angle terms of the contact are kept; the defaults are the formulas above.

    load_point : where the normal load acts, that is the second derivative of p times N0.
        "rail": as above, the contact keeps its place on the rail;
        "potential": p = z + s b0 roll + s delta0 yc + eps yc^2/2 only, no change of the lever arms;
        "wheelset": "potential", and the point of the load fixed in the wheelset's yaw-roll axes, which adds
        -N0 (r0 + b0 delta0) on roll, -N0 b0 delta0 on yaw and smaller products of delta0;
        "none": no term in N0.
    tilt : how the slope delta0 enters the velocity rows, and so the directions of the creep forces.
        "none": not at all; "normal": only n, s delta0 spin' in the spin creepage, while t stays in the track plane;
        "first_order": also t, -s delta0 z' - b0 delta0 roll' in eta; "exact": the same with cos and sin of delta0,
        which differs by delta0^2/2 (8 % at a slope of 0.4).
    spin_preload : change of direction and lever arm of the constant forces Fy0 = f23 s delta0/r0 and
        Mz0 = f33 s delta0/r0.  "none"; "wheelset": x and t yaw with the wheelset; "track": they do not.  Which of
        t and n also follow the change of slope is said by `tilt`.
    """

    load_point: str = "rail"
    tilt: str = "normal"
    spin_preload: str = "wheelset"


def _row(**entries):
    row = np.zeros(6)
    for name, value in entries.items():
        row[{"x": X, "y": Y, "z": Z, "yaw": YAW, "roll": ROLL, "spin": SPIN}[name]] = value
    return row


def wheel_matrices(wheel, speed, terms=ContactTerms()):
    """Stiffness and damping (6, 6) of one wheel; `wheel` has the scalar fields of one entry of WheelContacts."""
    stiffness = _normal_stiffness(wheel, terms)
    damping = np.zeros((6, 6))
    rows = _creep_rows(wheel, terms)
    flexible = {"xi": {"xi": -wheel.f11}, "eta": {"eta": -wheel.f22, "spin": -wheel.f23},
                "spin": {"eta": wheel.f23, "spin": -wheel.f33}}
    for load, sources in flexible.items():
        for creepage, slope in sources.items():
            rate, shift = rows[creepage]
            damping -= slope * np.outer(rows[load][0], rate) / speed
            stiffness -= slope * np.outer(rows[load][0], shift)
    if terms.spin_preload != "none":
        stiffness += _spin_preload_stiffness(wheel, terms)
    return stiffness, damping


def _creep_rows(wheel, terms):
    """For each creepage: (row of velocity v, row a) such that creepage = v.q'/V + a.q + constant."""
    s, b0, r0 = wheel.side, wheel.contact_half_spacing, wheel.wheel_radius
    cosine, sine = (np.cos(wheel.slope), np.sin(wheel.slope)) if terms.tilt == "exact" else (1.0, wheel.slope)
    tangent, normal = {"none": (0.0, 0.0), "normal": (0.0, sine)}.get(terms.tilt, (sine, sine))
    shift = _row(y=1.0, roll=-r0)
    xi = _row(x=1.0, spin=r0, yaw=-s * b0), -s * wheel.conicity / r0 * shift
    eta = cosine * shift + tangent * _row(z=-s, roll=-b0), _row(yaw=-cosine)
    spin = _row(yaw=cosine, spin=s * normal), -cosine / r0 * (wheel.slope_gradient * shift + _row(roll=1.0))
    return {"xi": xi, "eta": eta, "spin": spin}


def _normal_stiffness(wheel, terms):
    s, b0, r0, slope = wheel.side, wheel.contact_half_spacing, wheel.wheel_radius, wheel.slope
    shift = _row(y=1.0, roll=-r0)
    gradient = _row(z=1.0, roll=s * b0) + s * slope * shift
    stiffness = wheel.normal_stiffness * np.outer(gradient, gradient)
    if terms.load_point not in ("rail", "potential", "wheelset", "none"):
        raise ValueError(f"unknown load_point {terms.load_point!r}")
    if terms.load_point == "none":
        return stiffness
    if terms.load_point == "rail":
        own = wheel.slope_gradient - slope / b0
        return stiffness + wheel.load * (_edge_hessian(s, b0, r0, slope) + own * np.outer(shift, shift))
    stiffness += wheel.load * wheel.slope_gradient * np.outer(shift, shift)
    if terms.load_point == "wheelset":
        stiffness[ROLL, ROLL] -= wheel.load * (r0 + b0 * slope)
        stiffness[YAW, YAW] -= wheel.load * b0 * slope
        # Products of delta0 with lam and eps: changed lever arm of the side force, and cos(delta).
        stiffness[Z] -= wheel.load * s * slope * wheel.slope_gradient * shift
        stiffness[ROLL] -= wheel.load * slope * (wheel.conicity + b0 * wheel.slope_gradient) * shift
        stiffness[SPIN, YAW] += wheel.load * s * r0 * slope
    return stiffness


def _edge_hessian(s, b0, r0, slope):
    """Second derivative of the rail edge's penetration into a cone.

    Rail edge (s b0, r0) seen in the wheelset: Y = (s b0 - y) cos roll + (r0 - z) sin roll, Z = -(s b0 - y) sin roll
    + (r0 - z) cos roll; p = r0 + slope b0 - s slope Y - Z; yaw stretches Y to s b0 / cos yaw.
    """
    hessian = np.zeros((6, 6))
    hessian[Y, ROLL] = hessian[ROLL, Y] = -1.0
    hessian[Z, ROLL] = hessian[ROLL, Z] = s * slope
    hessian[ROLL, ROLL] = r0 + slope * b0
    hessian[YAW, YAW] = -slope * b0
    return hessian


def _spin_preload_stiffness(wheel, terms):
    """Minus the change of the generalised forces of constant Fy0, Mz0 when their velocity rows change."""
    s, b0, r0 = wheel.side, wheel.contact_half_spacing, wheel.wheel_radius
    lateral, moment = wheel.f23 * s * wheel.slope / r0, wheel.f33 * s * wheel.slope / r0
    shift = _row(y=1.0, roll=-r0)
    tilt = wheel.slope_gradient * shift
    # Lever arm of the side force about x: rolling radius, and the contact that turns with the axle.
    change = lateral * np.outer(_row(roll=-1.0), s * wheel.conicity * shift + _row(roll=s * b0))
    if terms.tilt in ("first_order", "exact"):
        change += lateral * np.outer(_row(z=-1.0, roll=-s * b0), tilt)
    if terms.tilt != "none":
        change += moment * np.outer(_row(spin=1.0), tilt + _row(roll=1.0))
    if terms.spin_preload == "wheelset":
        change += lateral * np.outer(_row(x=-1.0), _row(yaw=1.0))
    else:
        change += lateral * np.outer(_row(yaw=-s * b0, spin=r0), _row(yaw=1.0))
    return -change
