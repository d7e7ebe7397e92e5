# SPDX-License-Identifier: BSD-3-Clause
"""Track frame and body attitude, common to every kernel.

x along the track, y to the right, z down. A body's attitude in its track frame is
R = Rz(yaw) Rx(roll) Ry(pitch), pitch innermost. Sines and cosines are inputs, computed
once a body, so that kernels hold no library calls.
"""

from dataclasses import dataclass

import sympy as sm
from sympy.physics.mechanics import ReferenceFrame, dynamicsymbols

AXES = ("x", "y", "z")
ANGLES = ("yaw", "roll", "pitch")


@dataclass
class Attitude:
    """Rotation and partial angular velocities of one body in its track frame.

    Attributes
    ----------
    rotation : Matrix (3, 3)
        Maps body components to track-frame components.
    partial : Matrix (3, 3)
        Columns are the partial angular velocities of the yaw, roll and pitch rates.
    """

    rotation: sm.Matrix
    partial: sm.Matrix


def attitude_frames(track, angles, name):
    """Yawed, rolled and pitched frames of a body, by simple rotations."""
    yawed = ReferenceFrame(f"{name}_yawed")
    rolled = ReferenceFrame(f"{name}_rolled")
    pitched = ReferenceFrame(f"{name}_pitched")
    yawed.orient_axis(track, track.z, angles[0])
    rolled.orient_axis(yawed, yawed.x, angles[1])
    pitched.orient_axis(rolled, rolled.y, angles[2])
    return yawed, rolled, pitched


def trigonometry_map(angles, sines, cosines):
    """Replacement of sin and cos of the angles by input symbols."""
    table = {sm.sin(a): s for a, s in zip(angles, sines, strict=True)}
    return table | {sm.cos(a): c for a, c in zip(angles, cosines, strict=True)}


def declare_trigonometry(tape, tag=""):
    """Inputs sin and cos of yaw, roll and pitch."""
    sines = [tape.input(f"s{tag}_{a}", "-", f"sin of {a}{tag}") for a in ANGLES]
    cosines = [tape.input(f"c{tag}_{a}", "-", f"cos of {a}{tag}") for a in ANGLES]
    return sines, cosines


def attitude(tape, sines, cosines, tag=""):
    """Attitude of a body in its track frame, entries defined on the tape."""
    track = ReferenceFrame("T")
    angles = dynamicsymbols(f"yaw{tag} roll{tag} pitch{tag}")
    frames = attitude_frames(track, angles, f"B{tag}")
    table = trigonometry_map(angles, sines, cosines)
    omega = frames[2].ang_vel_in(track).to_matrix(track)
    rates = [a.diff() for a in angles]
    partial = omega.jacobian(rates).xreplace(table)
    rotation = track.dcm(frames[2]).xreplace(table)
    return Attitude(tape.let(f"R{tag}_", rotation), tape.let(f"E{tag}_", partial))


def angle_seeds(sines, cosines, cq):
    """Tangents of sin and cos for a unit seed cq of each angle."""
    return [{s: c * cq, c: -s * cq} for s, c in zip(sines, cosines, strict=True)]
