# SPDX-License-Identifier: BSD-3-Clause
"""Element kernels by partial velocities: bushing, line element, axis element.

An element joins a marker on a first body (i) and one on a second body (j), possibly in
two track frames. Its deformation e is seen from the first marker; the generalised force
of coordinate k is -f de/dq_k, written as force and moment on the partial velocities of
each body. The force on the first body acts at the point of it that coincides with the
second marker, so the pair is free of moment about any point.

Springs, dampers, Maxwell elements, bump stops, traction rods and actuators share the
geometry of a kernel here and differ by the scalar law that the kernel calls
(``csrc/laws.h``): f(e, de/dt, s, ds/dt) with one internal state s, g(...) = 0.
"""

from dataclasses import dataclass

import sympy as sm

from derive.frames import ANGLES, AXES, Attitude, angle_seeds, attitude, declare_trigonometry
from derive.tangent import pencil
from derive.tape import Tape, cross

COORDINATES = AXES + ANGLES


@dataclass
class Side:
    """One end of an element: its body's coordinates, attitude and marker."""

    displacement: sm.Matrix
    rates: sm.Matrix
    sines: list
    cosines: list
    attitude: Attitude
    arm: sm.Matrix  # marker from the body's centre, track-frame components
    omega: sm.Matrix  # angular velocity in the track frame


def declare_side(tape, tag):
    """Inputs of one body and its marker; defines attitude, arm and angular velocity."""
    displacement = tape.vector(f"q{tag}_", 3, "m", f"displacement of body {tag}")
    rates = sm.Matrix([tape.input(f"u{tag}_{n}", "m/s or rad/s", f"rate {n} of body {tag}")
                       for n in COORDINATES])
    sines, cosines = declare_trigonometry(tape, tag)
    marker = tape.vector(f"m{tag}_", 3, "m", f"marker in body {tag}, from its centre")
    turn = attitude(tape, sines, cosines, tag)
    arm = tape.let(f"arm{tag}_", turn.rotation * marker)
    omega = tape.let(f"om{tag}_", turn.partial * rates[3:, :])
    return Side(displacement, rates, sines, cosines, turn, arm, omega)


@dataclass
class Pair:
    """Two ends and how the second track frame lies and moves in the first."""

    first: Side
    second: Side
    turn: sm.Matrix  # second track frame to first
    separation: sm.Matrix  # second marker from the first, first track frame
    velocity: sm.Matrix  # its rate in the first track frame
    omega: sm.Matrix  # second body against first, first track frame


def declare_pair(tape):
    """Both ends, the relative pose of their track frames, separation and its rate."""
    first, second = declare_side(tape, "1"), declare_side(tape, "2")
    between = tape.vector("D", 3, "m", "design position of body 2 from body 1's, in track frame 1")
    turn = tape.matrix("C", "-", "track frame 2 to track frame 1")
    between_rate = tape.vector("dD", 3, "m/s", "rate of D in track frame 1")
    frame_omega = tape.vector("wf", 3, "rad/s", "angular velocity of track frame 2 in 1, in 2")
    reach = tape.let("reach", second.displacement + second.arm)
    separation = tape.let("d", between + turn * reach - first.displacement - first.arm)
    omega2 = tape.let("omf", second.omega + frame_omega)
    moved = tape.let("moved", second.rates[:3, :] + cross(second.omega, second.arm)
                     + cross(frame_omega, reach))
    velocity = tape.let("v", between_rate + turn * moved
                        - first.rates[:3, :] - cross(first.omega, first.arm))
    omega = tape.let("om", turn * omega2 - first.omega)
    return Pair(first, second, turn, separation, velocity, omega)


def generalised_forces(tape, pair, force, moment=None):
    """Residual contributions of ``force`` and ``moment`` (on body 2 they act with a minus).

    Both in track frame 1. Rows: x y z yaw roll pitch of body 1, then of body 2.
    """
    moment = sm.zeros(3, 1) if moment is None else moment
    reach = tape.let("lever", pair.separation + pair.first.arm)
    torque1 = tape.let("tq1_", cross(reach, force) + moment)
    force2 = tape.let("F2_", pair.turn.T * force)
    torque2 = tape.let("tq2_", cross(pair.second.arm, force2) + pair.turn.T * moment)
    return [
        *(-force), *(-(pair.first.attitude.partial.T * torque1)),
        *force2, *(pair.second.attitude.partial.T * torque2),
    ]


def pair_seeds(pair):
    """Twelve seeds: coordinate and rate of each body move together by cq and cu."""
    cq, cu = sm.symbols("cq cu", real=True)
    seeds = []
    for side in (pair.first, pair.second):
        angles = angle_seeds(side.sines, side.cosines, cq)
        for k in range(3):
            seeds.append({side.displacement[k]: cq, side.rates[k]: cu})
        for k in range(3):
            seeds.append({side.rates[3 + k]: cu} | angles[k])
    return seeds


def bushing():
    """Six-component bushing: linear stiffness, damping and preload in the first marker's axes.

    Translations are the separation in those axes; rotations are half the antisymmetric
    part of the relative rotation matrix, so that stiffness forces derive from a potential.
    """
    tape = Tape("bushing", "Six-component bushing between two markers")
    stiffness = tape.vector("k", 6, "N/m or N*m/rad", "stiffness")
    damping = tape.vector("c", 6, "N*s/m or N*m*s/rad", "damping")
    preload = tape.vector("f0_", 6, "N or N*m", "force at design position")
    free = tape.vector("e0_", 6, "m or rad", "deformation at design position")
    axes1 = tape.matrix("A1_", "-", "marker axes in body 1")
    axes2 = tape.matrix("A2_", "-", "marker axes in body 2")
    pair = declare_pair(tape)
    to_track = tape.let("B1_", pair.first.attitude.rotation * axes1)
    second = tape.let("B2_", pair.second.attitude.rotation * axes2)

    shift = tape.let("e", to_track.T * pair.separation)
    shift_rate = tape.let("ed", to_track.T * tape.let("vr", pair.velocity - cross(pair.first.omega, pair.separation)))
    turned = tape.let("CB", pair.turn * second)
    relative = tape.let("Q", to_track.T * turned)
    axial = [(2, 1), (0, 2), (1, 0)]
    rotation = sm.Matrix([(relative[i, j] - relative[j, i]) / 2 for i, j in axial])
    # d(rotation)/dt = (tr Q I - Q) w / 2 for dQ/dt = w x Q
    rate_map = tape.let("L", (relative.trace() * sm.eye(3) - relative) / 2)
    spin = tape.let("wm", to_track.T * pair.omega)

    def law(rows, deformation, rate):
        return [preload[r] + stiffness[r] * (x - free[r]) + damping[r] * v
                for r, x, v in zip(rows, deformation, rate, strict=True)]

    force = tape.let("fm", sm.Matrix(law(range(3), shift, shift_rate)))
    couple = tape.let("mm", sm.Matrix(law(range(3, 6), rotation, rate_map * spin)))
    track_force = tape.let("F", to_track * force)
    track_moment = tape.let("M", to_track * tape.let("mL", rate_map.T * couple))
    rows = generalised_forces(tape, pair, track_force, track_moment)
    return pencil(tape, rows, pair_seeds(pair))


def _with_law(tape, pair, elongation, rate, direction):
    """Residual, pencil of an element whose scalar law acts along ``direction``."""
    state = tape.input("s", "m", "internal state (elongation of the damper)")
    state_rate = tape.input("ds", "m/s", "rate of the internal state")
    rate = tape.let("edot", rate)
    force, state_residual = tape.law(elongation, rate, state, state_rate)
    rows = generalised_forces(tape, pair, tape.let("F", direction * force))
    cq, cu = sm.symbols("cq cu", real=True)
    seeds = [*pair_seeds(pair), {state: cq, state_rate: cu}]
    return pencil(tape, [*rows, state_residual], seeds)


def line():
    """Law along the line of two points; e is the change of their distance."""
    tape = Tape("line", "Law along the line of two points")
    free = tape.input("e0", "m", "distance at design position")
    pair = declare_pair(tape)
    d = pair.separation
    length = tape.let("len", sm.sqrt(tape.let("len2", d.dot(d))))
    inverse = tape.let("inv", 1 / length)
    direction = tape.let("n", d * inverse)
    elongation = tape.let("e", length - free)
    return _with_law(tape, pair, elongation, direction.dot(pair.velocity), direction)


def axis():
    """Law along an axis fixed in the first body; e is the separation along it."""
    tape = Tape("axis", "Law along an axis of the first body")
    free = tape.input("e0", "m", "separation along the axis at design position")
    local = tape.vector("ax", 3, "-", "axis in body 1, unit vector")
    pair = declare_pair(tape)
    direction = tape.let("n", pair.first.attitude.rotation * local)
    elongation = tape.let("e", direction.dot(pair.separation) - free)
    relative = tape.let("vr", pair.velocity - cross(pair.first.omega, pair.separation))
    return _with_law(tape, pair, elongation, direction.dot(relative), direction)
