# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail kernel of the linear contact, one wheel a lane, by partial velocities.

Small contact slopes: rolling radius and slope are linear in the lateral shift at the
contact, the load is linear in the penetration, creep forces are Kalker's linear ones.
``docs/linear_contact.md`` states what is exact and what is assumed.
"""

import sympy as sm

from derive.frames import AXES, angle_seeds
from derive.tangent import pencil
from derive.tape import Tape, cross

COORDINATES = AXES + ("yaw", "roll", "spin")


def _declare_parameters(tape):
    names = {
        "side": ("-", "-1 left, +1 right"),
        "b0": ("m", "lateral distance of the contact from the wheelset's centre"),
        "r0": ("m", "rolling radius, centred"),
        "lam": ("-", "conicity: slope of the rolling radius over the lateral shift"),
        "slope": ("-", "contact slope to the track plane, centred"),
        "grad": ("rad/m", "slope of the contact slope over the lateral shift"),
        "N0": ("N", "normal load at rest"),
        "kH": ("N/m", "normal contact stiffness"),
        "f11": ("N", "longitudinal creep coefficient"),
        "f22": ("N", "lateral creep coefficient"),
        "f23": ("N*m", "lateral-spin creep coefficient"),
        "f33": ("N*m^2", "spin creep coefficient"),
    }
    return {n: tape.input(n, unit, meaning) for n, (unit, meaning) in names.items()}


def wheel_rail():
    """Kernel of one wheel: coordinates x y z yaw roll spin of its wheelset."""
    tape = Tape("wheel_rail", "Linear wheel-rail contact of one wheel")
    par = _declare_parameters(tape)
    offset = tape.vector("offset", 3, "m", "design position of the wheelset in the track frame")
    speed = tape.input("V", "m/s", "speed of the track frame")
    omega_track = tape.vector("w", 3, "rad/s", "angular velocity of the track frame")
    q = tape.vector("q_", 3, "m", "displacement of the wheelset")
    u = [tape.input(f"u_{n}", "m/s or rad/s", f"rate of {n}") for n in COORDINATES]
    s = [tape.input(f"s_{n}", "-", f"sin of {n}") for n in ("yaw", "roll")]
    c = [tape.input(f"c_{n}", "-", f"cos of {n}") for n in ("yaw", "roll")]

    forward = sm.Matrix([c[0], s[0], 0])  # rolling direction, level
    across = sm.Matrix([-s[0], c[0], 0])
    axle = tape.let("axle", c[1] * across + sm.Matrix([0, 0, s[1]]))
    down = tape.let("down", -s[1] * across + sm.Matrix([0, 0, c[1]]))

    shift = tape.let("yc", q[1] - par["r0"] * s[1])
    radius = tape.let("r", par["r0"] + par["side"] * par["lam"] * shift)
    slope = tape.let("delta", par["slope"] + par["side"] * par["grad"] * shift)
    normal_rows = _normal_rows(tape, par, q, s, c, shift)

    normal = tape.let("nrm", par["side"] * slope * across + sm.Matrix([0, 0, 1]))
    arm = tape.let("arm", par["side"] * par["b0"] * axle + radius * down)
    turning = [sm.Matrix([0, 0, 1]), forward, axle]  # partial angular velocities
    omega = tape.let("om", sum((rate * e for rate, e in zip(u[3:], turning, strict=True)), omega_track))
    centre = tape.let("vc", sm.Matrix([speed, 0, 0]) + cross(omega_track, offset + q) + sm.Matrix(u[:3]))
    contact = tape.let("v", centre + cross(omega, arm))
    creep_rows = _creep_rows(tape, par, speed, (forward, across, normal), turning, arm, contact, omega)

    rows = [a + b for a, b in zip(normal_rows, creep_rows, strict=True)]
    return pencil(tape, rows, _seeds(q, u, s, c))


def _normal_load(tape, par, q, s, shift):
    """N = N0 + kH p, with roll = sin(roll) and yaw = sin(yaw) to this order:

    p = z + side (b0 roll + slope yc) + (grad - slope/b0) yc^2 / 2
        - y roll + (r0 + b0 slope) roll^2 / 2 - b0 slope yaw^2 / 2.

    The first line ties the penetration to the contact slope; the second says that the
    contact keeps its place on the rail while the wheelset shifts, rolls and yaws over it.
    """
    hollow = tape.let("hollow", par["grad"] - par["slope"] / par["b0"])
    lever = tape.let("lever", par["r0"] + par["b0"] * par["slope"])
    tied = q[2] + par["side"] * (par["b0"] * s[1] + par["slope"] * shift) + hollow * shift * shift / 2
    stays = lever * s[1] * s[1] / 2 - q[1] * s[1] - par["b0"] * par["slope"] * s[0] * s[0] / 2
    penetration = tape.let("pen", tied + stays)
    return hollow, lever, tape.let("N", par["N0"] + par["kH"] * penetration)


def _normal_rows(tape, par, q, s, c, shift):
    """N dp/dq: the normal force does work on the penetration only."""
    hollow, lever, load = _normal_load(tape, par, q, s, shift)
    along = tape.let("py", par["side"] * par["slope"] + hollow * shift)
    roll = par["side"] * par["b0"] - par["r0"] * along - q[1] + lever * s[1]
    yaw = -par["b0"] * par["slope"] * s[0] * c[0]
    return [0, load * (along - s[1]), load, load * yaw, load * roll * c[1], 0]


def _creep_rows(tape, par, speed, directions, turning, arm, contact, omega):
    """-(Fx dvx/du + Fy dvy/du + Mz dwn/du) on the contact's partial velocities."""
    forward, across, normal = directions
    inverse = tape.let("iV", 1 / speed)
    xi = tape.let("xi", forward.dot(contact) * inverse)
    eta = tape.let("eta", across.dot(contact) * inverse)
    spin = tape.let("spin", normal.dot(omega) * inverse)
    longitudinal = tape.let("Fx", -par["f11"] * xi)
    lateral = tape.let("Fy", -(par["f22"] * eta + par["f23"] * spin))
    moment = tape.let("Mz", par["f23"] * eta - par["f33"] * spin)
    force = tape.let("Ft", longitudinal * forward + lateral * across)
    torque = tape.let("tq", cross(arm, force) + moment * normal)
    return [*(-force), *(-axis.dot(torque) for axis in turning)]


def _seeds(q, u, s, c):
    cq, cu = sm.symbols("cq cu", real=True)
    angles = angle_seeds(s, c, cq)
    seeds = [{q[k]: cq, u[k]: cu} for k in range(3)]
    seeds += [{u[3 + k]: cu} | angles[k] for k in range(2)]
    return [*seeds, {u[5]: cu}]
