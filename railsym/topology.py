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
        Coordinate of the internal state of each element that has one.
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


def has_state(element):
    """Whether an element has an internal state: a Maxwell element, or an actuator that lags behind its command."""
    return element.type == "maxwell" or (element.type == "actuator" and element.parameters.get("lag", 0.0) > 0.0)


def topology(vehicle):
    """Coordinates of ``vehicle`` in the order of its bodies, then the elements that have a state."""
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
    inner = [e.name for e in vehicle.elements if has_state(e)]
    internal = {name: len(names) + k for k, name in enumerate(inner)}
    names += [f"{name}.s" for name in inner]
    last = [name.rsplit(".", 1)[1] for name in names]
    return Topology(
        tuple(names), start, internal, attachment,
        np.array([part in _ANGLES for part in last]),
        np.array([False] * (len(names) - len(inner)) + [True] * len(inner)),
        np.array([part == "spin" for part in last]),
    )


@dataclass(frozen=True)
class Pairs:
    """Where a list of elements is attached; one row an element.

    Attributes
    ----------
    index : ndarray of int, shape (count, 12)
        Coordinates of the first and the second end, -1 for one that does not exist.
    place1, place2 : ndarray, shape (count, 3)
        Design positions of the two bodies, m.
    marker1, marker2 : ndarray, shape (count, 3)
        Attachment points from those, m.
    """

    index: np.ndarray
    place1: np.ndarray
    place2: np.ndarray
    marker1: np.ndarray
    marker2: np.ndarray

    @property
    def apart(self):
        """Second attachment point from the first at the design position, shape (count, 3), m."""
        return self.place2 + self.marker2 - self.place1 - self.marker1


def pairs(topo, elements):
    """Attachments of a list of elements.

    The track as an end has the design position, and so the frame, of the other end's body.
    """
    index = np.empty((len(elements), 12), dtype=int)
    numbers = np.empty((4, len(elements), 3))
    for k, element in enumerate(elements):
        index1, place1 = topo.attachment[element.first.body]
        index2, place2 = topo.attachment[element.second.body]
        index[k, :6], index[k, 6:] = index1, index2
        numbers[0, k] = place2 if place1 is None else place1
        numbers[1, k] = place1 if place2 is None else place2
        numbers[2, k], numbers[3, k] = element.first.position, element.second.position
    place1, place2, point1, point2 = numbers
    return Pairs(index, place1, place2, point1 - place1, point2 - place2)
