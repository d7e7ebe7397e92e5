# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of profiles whose rigid contact has a closed form: cones on round edges, circles on circles."""

import numpy as np

from railsym.contact_pair import ContactPair
from railsym.profiles.formulas import profile_from_zones

HALF, RADIUS = 0.75, 0.46          # tape circle from the track's centre, wheel radius, m


def cone(conicity):
    """A conical tread of 120 mm."""
    return profile_from_zones("cone", "wheel", [{"type": "polynomial", "from": -60.0, "to": 60.0, "coefficients": [0.0, -conicity]}])


def circle(kind, radius_mm, bulge, half_width=12.0):
    """An arc whose top (bottom) is at the origin; a rail gets straight sides, where gauge is measured."""
    sign = 1.0 if bulge == "up" else -1.0
    arc = {"type": "arc", "from": -half_width, "to": half_width, "centre": [0.0, sign * radius_mm], "radius": radius_mm, "bulge": bulge}
    if kind == "wheel":
        return profile_from_zones("circle", kind, [arc])
    end = radius_mm - np.sqrt(radius_mm**2 - half_width**2)
    sides = [{"type": "segment", "start": [s * (half_width + 20.0), end + 20.0], "end": [s * half_width, end]} for s in (-1.0, 1.0)]
    right = {**sides[1], "start": sides[1]["end"], "end": sides[1]["start"]}
    return profile_from_zones("round", kind, [sides[0], arc, right])


def over_the_axis(wheel, rail, **more):
    """A pair with the rails' axes under the tape circles."""
    from railsym.contact_pair import inner_side

    gauge = 2.0 * (HALF + inner_side(rail))
    return ContactPair(wheel, rail, inclination=0.0, gauge=gauge, wheel_radius=RADIUS, **more)


def cone_on_round_edges(conicity, edge, y):
    """Roll, and rolling radius and contact angle right and left, of a cone on two edges of the radius ``edge`` (m).

    A cone on a round edge is the cone moved outward by that radius on the edge's centre. With h the depth of the centres below the
    wheelset's centre, tan(roll) (b0 - lam h) = -lam y and cos(roll) h = r0 + edge sqrt(1 + lam^2) - y sin(roll) - lam b0 (cos(roll) - 1).
    """
    root = np.sqrt(1.0 + conicity**2)
    h, roll = RADIUS, 0.0
    for _ in range(200):
        roll = np.arctan(-conicity * y / (HALF - conicity * h))
        h = (RADIUS + edge * root - y * np.sin(roll) - conicity * HALF * (np.cos(roll) - 1.0)) / np.cos(roll)
    radius, angle = [], []
    for side in (1.0, -1.0):
        across = np.cos(roll) * (HALF - side * y) + side * np.sin(roll) * h - edge * conicity / root
        radius.append(RADIUS - conicity * (across - HALF))
        angle.append(np.arctan(conicity) - side * roll)
    return roll, radius, angle
