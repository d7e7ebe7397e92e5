# SPDX-License-Identifier: BSD-3-Clause
"""Wheel-rail forces of one wheelset, plainly: rotation matrices, searched contacts, differences, virtual power.

Nothing is mirrored here: each wheel and its rail stand where they stand in the track frame. The contact of a cone and a
round rail is the least distance along the rail, found by a search; penetration rates are differences over a short time;
rows come from the rates of the contact's material point under unit rates of the coordinates.
"""

from dataclasses import dataclass, field

import numpy as np
from oracles.element_pair import turn
from scipy.optimize import minimize_scalar

import railsym as rs

EX, EY, EZ = np.eye(3)


@dataclass
class State:
    """One wheelset; `rails` is (left, right) of (y, z, dy/ds, dz/ds)."""

    q: np.ndarray
    u: np.ndarray
    speed: float
    w: np.ndarray = field(default_factory=lambda: np.zeros(3))
    rails: np.ndarray = field(default_factory=lambda: np.zeros((2, 4)))


@dataclass
class Setting:
    """What does not move."""

    zones: tuple  # of railsym.wheel_rail.Cone
    stiffness: tuple  # N/m^(3/2), one a zone
    semi_axes: tuple  # m^(1/2), a and b over sqrt(penetration), one a zone
    law: str
    friction: float
    damping: float
    sink: float
    weight: float = 1.0
    r0: float = 0.46
    spacing: float = 1.5
    material: rs.Material = field(default_factory=rs.Material)


def rail_frame(state, side, spacing):
    """Axes (columns) and place of one rail's head in the track frame, in the plane of the wheelset."""
    y, z, heading, climb = state.rails[(side + 1) // 2]
    cross_level = np.arcsin((state.rails[1][1] - state.rails[0][1]) / spacing)
    level = np.hypot(1.0, heading)
    axes = turn(2, np.arctan(heading)) @ turn(1, -np.arctan(climb / level)) @ turn(0, cross_level)
    return axes, np.array([state.q[0], side * spacing / 2 + y, z])


def attitude(q):
    return turn(2, q[3]) @ turn(0, q[4])


@dataclass
class Touch:
    penetration: float
    normal: np.ndarray  # into the rail, track frame
    arm: np.ndarray  # contact from the wheelset's centre, track frame
    forward: np.ndarray  # rolling direction, track frame


def touch(setting, state, side, zone):
    """Least distance of one zone's cone from its rail; positive penetration: contact."""
    axes, head = rail_frame(state, side, setting.spacing)
    centre = np.array([0.0, 0.0, -setting.r0]) + state.q[:3] + setting.sink * axes[:, 2]
    axle = attitude(state.q) @ EY
    angle = np.arctan(zone.slope)
    away = zone.rail_radius + zone.gap
    circle = np.array([0.0, side * (zone.half_spacing - setting.spacing / 2 + away * np.sin(angle)),
                       zone.radius - setting.r0 + away * np.cos(angle)])

    def parts(along):
        arm = head + axes @ (circle + along * EX) - centre
        outward = side * axle @ arm
        radial = arm - (axle @ arm) * axle
        return arm, outward, radial

    def distance(along):
        _, outward, radial = parts(along)
        return (np.linalg.norm(radial) - zone.radius + zone.slope * (outward - zone.half_spacing)) * np.cos(angle)

    found = minimize_scalar(distance, bracket=(-0.05, 0.05), method="brent", options={"xtol": 1e-12})
    arm, _, radial = parts(found.x)
    normal = np.cos(angle) * (radial / np.linalg.norm(radial) + side * zone.slope * axle)
    forward = np.cross(axle, axes[:, 2])
    return Touch(zone.rail_radius - found.fun, normal, arm - found.fun * normal, forward / np.linalg.norm(forward))


def later(state, time):
    """The state after a short time; the rails pass under the wheelset. It does not run along them by q_x."""
    rails = state.rails.copy()
    rails[:, :2] += state.speed * time * state.rails[:, 2:]
    return State(state.q + time * state.u, state.u, state.speed, state.w, rails)


def penetration_rate(setting, state, side, zone, time=1e-6):
    ahead, behind = (touch(setting, later(state, t), side, zone).penetration for t in (time, -time))
    return (ahead - behind) / (2 * time)


def material_rates(state, arm):
    """Velocity at the contact and angular velocity of the wheelset, and both for unit rates of each coordinate."""
    turning = [EZ, turn(2, state.q[3]) @ EX, attitude(state.q) @ EY]
    spin = state.w + sum(rate * axis for rate, axis in zip(state.u[3:], turning))
    place = np.array([0.0, 0.0, -0.46]) + state.q[:3]
    velocity = state.speed * EX + np.cross(state.w, place) + state.u[:3] + np.cross(spin, arm)
    partial = [(axis, np.zeros(3)) for axis in np.eye(3)] + [(np.cross(axis, arm), axis) for axis in turning]
    return velocity, spin, partial


def wheel(setting, state, side):
    """Rows (6) of one wheel and its patches: list of dict."""
    rows, patches = np.zeros(6), []
    for number, zone in enumerate(setting.zones):
        at = touch(setting, state, side, zone)
        if at.penetration <= 0.0:
            continue
        elastic = setting.stiffness[number] * at.penetration**1.5
        load = max(0.0, elastic * (1.0 + setting.damping * penetration_rate(setting, state, side, zone)))
        t1 = at.forward - (at.forward @ at.normal) * at.normal
        t1 /= np.linalg.norm(t1)
        t2 = np.cross(at.normal, t1)
        velocity, spin, partial = material_rates(state, at.arm)
        creepage = np.array([t1 @ velocity, t2 @ velocity, at.normal @ spin]) / state.speed
        a, b = (size * np.sqrt(at.penetration) for size in setting.semi_axes[number])
        creep = rs.creep_forces(setting.law, a, b, creepage, load, setting.friction, setting.material, kalker_weight=setting.weight)
        force, moment = creep[0] * t1 + creep[1] * t2 - load * at.normal, creep[2] * at.normal
        rows -= [force @ v + moment @ w for v, w in partial]
        patches.append({"zone": number, "load": load, "creepage": creepage, "force": creep, "arm": at.arm, "normal": at.normal,
                        "wheel_force": force})
    return rows, patches


def potential(setting, state):
    """Elastic energy of both wheels, J."""
    energy = 0.0
    for side in (-1, 1):
        for stiffness, zone in zip(setting.stiffness, setting.zones):
            energy += 0.4 * stiffness * max(0.0, touch(setting, state, side, zone).penetration) ** 2.5
    return energy
