# SPDX-License-Identifier: BSD-3-Clause
"""Body kernels by Kane's method: rigid body, wheelset, wheelset with two axleboxes.

Every body moves relative to its own track frame, whose motion is an input: speed V along
the frame's x, angular velocity w and their rates. The residual is inertia less gravity,
r = -(Fr + Fr*), so that element kernels add to it.
"""

from dataclasses import dataclass

import sympy as sm
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from derive.frames import (
    ANGLES,
    AXES,
    angle_seeds,
    attitude_frames,
    declare_trigonometry,
    trigonometry_map,
)
from derive.tangent import pencil
from derive.tape import Tape

INERTIA = ("xx", "yy", "zz", "xy", "yz", "xz")
PAIR_SIDES = ("left", "right")


@dataclass
class TrackFrame:
    """Moving frame with the dynamicsymbols that stand for its motion."""

    inertial: ReferenceFrame
    frame: ReferenceFrame
    origin: Point
    speed: sm.Expr
    omega: tuple
    gravity: sm.Matrix

    @classmethod
    def declare(cls, gravity):
        """Frame at speed V along x, turning at w0 w1 w2 (its own components)."""
        inertial, frame, origin = ReferenceFrame("N"), ReferenceFrame("T"), Point("O")
        speed, *omega = dynamicsymbols("V w0 w1 w2")
        frame.set_ang_vel(inertial, sum(w * e for w, e in zip(omega, frame, strict=True)))
        origin.set_vel(inertial, speed * frame.x)
        return cls(inertial, frame, origin, speed, tuple(omega), gravity)

    def rate_map(self, tape_motion):
        """Replace the frame's dynamicsymbols and their rates by tape inputs."""
        symbols = (self.speed, *self.omega)
        values, rates = tape_motion
        table = {s.diff(): r for s, r in zip(symbols, rates, strict=True)}
        return table, dict(zip(symbols, values, strict=True))

    def point(self, name, offset):
        """A point fixed by ``offset`` (components in the frame) with its velocity in N."""
        place = sum((c * e for c, e in zip(offset, self.frame, strict=True)), 0 * self.frame.x)
        point = self.origin.locatenew(name, place)
        velocity = self.origin.vel(self.inertial) + place.dt(self.inertial)
        point.set_vel(self.inertial, velocity)
        return point


def declare_inertia(tape, tag=""):
    """Six inputs: the entries of an inertia tensor about the centre of mass."""
    return [tape.input(f"I{tag}_{e}", "kg*m^2", f"inertia {e} {tag}".strip()) for e in INERTIA]


def declare_track_motion(tape):
    """Inputs: speed, angular velocity, their rates and gravity, in the track frame."""
    values = [tape.input("V", "m/s", "speed of the track frame along its x")]
    values += list(tape.vector("w", 3, "rad/s", "angular velocity of the track frame"))
    rates = [tape.input("dV", "m/s^2", "rate of the speed")]
    rates += list(tape.vector("dw", 3, "rad/s^2", "rate of the angular velocity's components"))
    gravity = tape.vector("grav", 3, "m/s^2", "gravity in the track frame")
    return (values, rates), gravity


def declare_coordinates(tape, names):
    """Inputs u, a of every coordinate, and the three displacements."""
    displacement = [tape.input(f"q_{n}", "m", f"displacement {n}") for n in names[:3]]
    rates = [tape.input(f"u_{n}", "m/s or rad/s", f"rate of {n}") for n in names]
    accelerations = [tape.input(f"a_{n}", "m/s^2 or rad/s^2", f"rate of u_{n}") for n in names]
    return displacement, rates, accelerations


def kane_residual(track, coordinates, bodies, loads):
    """r = -(Fr + Fr*) with u = dq/dt; kinematical equations q' - u = 0."""
    speeds = dynamicsymbols(" ".join(f"u_{k}" for k in range(len(coordinates))))
    kinematics = [q.diff() - u for q, u in zip(coordinates, speeds, strict=True)]
    method = KanesMethod(track.inertial, coordinates, speeds, kd_eqs=kinematics)
    fr, frstar = method.kanes_equations(bodies, loads)
    return -(fr + frstar), speeds


def substitute(expressions, *tables):
    """Apply replacement tables in order (rates before the functions they are rates of)."""
    for table in tables:
        expressions = [e.xreplace(table) for e in expressions]
    return expressions


def weight(body, track):
    """Gravity on a body, a load for KanesMethod."""
    acceleration = sum(g * e for g, e in zip(track.gravity, track.frame, strict=True))
    return (body.masscenter, body.mass * acceleration)


def seeds_of(rates, accelerations, displacement, angle_tangents):
    """Pencil seeds: coordinate j moves q, u and a together by cq, cu and ca."""
    cq, cu, ca = sm.symbols("cq cu ca", real=True)
    seeds = []
    for k, (u, a) in enumerate(zip(rates, accelerations, strict=True)):
        seed = {u: cu, a: ca}
        if k < 3:
            seed[displacement[k]] = cq
        seed.update(angle_tangents.get(k, {}))
        seeds.append(seed)
    return seeds


def rigid_body():
    """Kernel of a rigid body: 6 coordinates x y z yaw roll pitch."""
    tape = Tape("rigid_body", "Rigid body in a moving track frame, by Kane's method")
    mass = tape.input("m", "kg", "mass")
    tensor = declare_inertia(tape)
    offset = tape.vector("offset", 3, "m", "design position in the track frame")
    motion, gravity = declare_track_motion(tape)
    track = TrackFrame.declare(gravity)
    displacement, rates, accelerations = declare_coordinates(tape, AXES + ANGLES)
    sines, cosines = declare_trigonometry(tape)

    q = dynamicsymbols("q_x q_y q_z yaw roll pitch")
    frame = attitude_frames(track.frame, q[3:], "B")[2]
    centre = track.point("C", [offset[k] + q[k] for k in range(3)])
    body = RigidBody("body", centre, frame, mass, (inertia(frame, *tensor), centre))
    residual, speeds = kane_residual(track, q, [body], [weight(body, track)])

    return _finish(tape, track, motion, residual, q, speeds, displacement, rates,
                   accelerations, {3: 0, 4: 1, 5: 2}, sines, cosines, [])


def wheelset(axleboxes):
    """Kernel of a wheelset, its axleboxes turning on the axle if asked.

    Coordinates x y z yaw roll spin, then the pitch of the left and the right axlebox.
    The spin angle is cyclic: only its rate appears, because the axle's inertia is the
    same in the frame that does not spin.
    """
    name = "wheelset_with_axleboxes" if axleboxes else "wheelset"
    tape = Tape(name, "Wheelset" + (" with two axleboxes turning on its axle" if axleboxes else ""))
    mass = tape.input("m", "kg", "mass of the wheelset")
    across = tape.input("I_xx", "kg*m^2", "inertia about x and z")
    along = tape.input("I_yy", "kg*m^2", "inertia about the axle")
    boxes = [_declare_axlebox(tape, side) for side in PAIR_SIDES] if axleboxes else []
    offset = tape.vector("offset", 3, "m", "design position in the track frame")
    motion, gravity = declare_track_motion(tape)
    track = TrackFrame.declare(gravity)
    names = AXES + ("yaw", "roll", "spin") + tuple(f"pitch_{s}" for s in PAIR_SIDES if boxes)
    displacement, rates, accelerations = declare_coordinates(tape, names)
    sines, cosines = _wheelset_trigonometry(tape, boxes)

    q = dynamicsymbols("q_x q_y q_z yaw roll spin" + (" pitch_left pitch_right" if boxes else ""))
    axle = attitude_frames(track.frame, [*q[3:5], 0], "A")[1]
    wheel = ReferenceFrame("W")
    wheel.orient_axis(axle, axle.y, q[5])
    centre = track.point("C", [offset[k] + q[k] for k in range(3)])
    tensor = inertia(axle, across, along, across)
    bodies = [RigidBody("wheelset", centre, wheel, mass, (tensor, centre))]
    bodies += [_axlebox(track, axle, centre, box, q[6 + k], k) for k, box in enumerate(boxes)]
    residual, speeds = kane_residual(track, q, bodies, [weight(b, track) for b in bodies])

    angles = {3: 0, 4: 1} | {6 + k: 2 + k for k in range(len(boxes))}
    return _finish(tape, track, motion, residual, q, speeds, displacement, rates,
                   accelerations, angles, sines, cosines, [q[5]])


def _declare_axlebox(tape, side):
    mass = tape.input(f"m_{side}", "kg", f"mass of the {side} axlebox")
    tensor = declare_inertia(tape, side)
    place = tape.vector(f"c_{side}", 3, "m", f"centre of the {side} axlebox from the wheelset's, in the axlebox")
    return mass, tensor, place


def _wheelset_trigonometry(tape, boxes):
    names = ["yaw", "roll"] + [f"pitch_{s}" for s in PAIR_SIDES if boxes]
    sines = [tape.input(f"s_{n}", "-", f"sin of {n}") for n in names]
    cosines = [tape.input(f"c_{n}", "-", f"cos of {n}") for n in names]
    return sines, cosines


def _axlebox(track, axle, centre, box, pitch, index):
    mass, tensor, place = box
    frame = ReferenceFrame(f"X{index}")
    frame.orient_axis(axle, axle.y, pitch)
    arm = place[0] * frame.x + place[1] * axle.y + place[2] * frame.z
    point = centre.locatenew(f"P{index}", arm)
    velocity = centre.vel(track.inertial) + (frame.ang_vel_in(track.inertial) ^ arm)
    point.set_vel(track.inertial, velocity)
    return RigidBody(f"axlebox{index}", point, frame, mass, (inertia(frame, *tensor), point))


def _finish(tape, track, motion, residual, q, speeds, displacement, rates, accelerations,
            angles, sines, cosines, cyclic):
    """Replace dynamicsymbols by inputs, share subexpressions, push the tangents."""
    rate_table, value_table = track.rate_map(motion)
    accel = {u.diff(): a for u, a in zip(speeds, accelerations, strict=True)}
    names = {q[k]: d for k, d in enumerate(displacement)}
    names |= dict(zip(speeds, rates, strict=True)) | value_table
    trig = trigonometry_map([q[k] for k in angles], sines, cosines)
    short = substitute(list(residual), accel | rate_table, trig, names)
    left = set().union(*(e.free_symbols for e in short)) - {i.symbol for i in tape.inputs}
    if left:
        raise RuntimeError(f"kernel {tape.name}: symbols {sorted(map(str, left))} are not inputs")
    residual = tape.common("x", short)
    cq = sm.Symbol("cq", real=True)
    tangents = angle_seeds(sines, cosines, cq)
    seeds = seeds_of(rates, accelerations, displacement, {k: tangents[i] for k, i in angles.items()})
    return pencil(tape, residual, seeds)
