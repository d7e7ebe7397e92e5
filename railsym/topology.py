# SPDX-License-Identifier: BSD-3-Clause
"""Which coordinates a vehicle has, and which of them each attachment moves with."""

from dataclasses import dataclass

import numpy as np

from railsym.vehicle_parts import TRACK

RIGID = ("x", "y", "z", "yaw", "roll", "pitch")
WHEELSET = ("x", "y", "z", "yaw", "roll", "spin")
_ANGLES = ("yaw", "roll", "pitch")


@dataclass(frozen=True)
class Topology:
    """Coordinates of a vehicle and of its attachments.

    Attributes
    ----------
    coordinates : tuple of str, length n
    start : dict of str to int
        First coordinate of each body.
    internal : dict of str to int
        Coordinate of the internal state of each Maxwell element.
    attachment : dict of str to (ndarray of int, shape (6,), ndarray, shape (3,))
        Coordinates x y z yaw roll pitch (-1: does not exist) and design position (m).
    is_angle, first_order, cyclic : ndarray of bool, shape (n,)
    """

    coordinates: tuple
    start: dict
    internal: dict
    attachment: dict
    is_angle: np.ndarray
    first_order: np.ndarray
    cyclic: np.ndarray


def body_coordinates(body):
    """Names of one body's coordinates."""
    own = RIGID if body.kind == "rigid_body" else WHEELSET
    boxes = [f"{box.name}.pitch" for box in body.axleboxes]
    return [f"{body.name}.{name}" for name in own] + boxes


def topology(vehicle):
    """Coordinates of ``vehicle`` in the order of its bodies, then its Maxwell elements."""
    names, start, attachment = [], {}, {}
    for body in vehicle.bodies:
        first = start[body.name] = len(names)
        names += body_coordinates(body)
        index = np.arange(first, first + 6)
        if body.kind != "rigid_body":
            index[5] = -1  # the axle as an attachment does not spin
        attachment[body.name] = (index, body.position)
        for k, box in enumerate(body.axleboxes):
            attachment[box.name] = (np.array([*index[:5], first + 6 + k]), body.position)
    attachment[TRACK] = (np.full(6, -1), None)
    maxwell = [e.name for e in vehicle.elements if e.type == "maxwell"]
    internal = {name: len(names) + k for k, name in enumerate(maxwell)}
    names += [f"{name}.s" for name in maxwell]
    last = [name.rsplit(".", 1)[1] for name in names]
    return Topology(
        tuple(names), start, internal, attachment,
        np.array([part in _ANGLES for part in last]),
        np.array([False] * (len(names) - len(maxwell)) + [True] * len(maxwell)),
        np.array([part == "spin" for part in last]),
    )


def ends(topo, element):
    """Indices, design positions and markers of both ends of an element.

    The track as an end has the design position, and so the frame, of the other end's body.
    """
    found = [topo.attachment[end.body] for end in (element.first, element.second)]
    index = [part[0] for part in found]
    place = [part[1] for part in found]
    place = [place[k] if place[k] is not None else place[1 - k] for k in range(2)]
    marker = [end.position - p for end, p in zip((element.first, element.second), place, strict=True)]
    return np.concatenate(index), place, marker
