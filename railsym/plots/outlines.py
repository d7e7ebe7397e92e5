# SPDX-License-Identifier: BSD-3-Clause
"""Outlines of a vehicle's bodies for drawings, to scale as far as its data tell.

A vehicle file has no shapes. A rigid body is drawn as the uniform box with its mass and principal inertias,

    length^2 = 6 (Iyy + Izz - Ixx)/m,   width^2 = 6 (Ixx + Izz - Iyy)/m,   height^2 = 6 (Ixx + Iyy - Izz)/m,

a bogie frame as two side members through its primary suspension and a cross member, a light link as the line between its
attachments, a wheelset by its axle, its wheels' diameter and its contact spacing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_LINK_SHARE = 0.01           # of the heaviest body's mass, below which a body is a link
WHEEL_WIDTH = 0.135          # m, of a wheel's rim (EN 13715)
_AXLEBOX = (0.36, 0.22)      # m, drawn length and width of an axlebox
LINES = ("damper", "maxwell", "spring", "traction_rod", "actuator")      # element types drawn as a line
SHORTEST = 0.25              # m, an element shorter than this in the view is not drawn


@dataclass(frozen=True, eq=False)
class Outline:
    """A polyline fixed to one body, or a line between two.

    Attributes
    ----------
    points : ndarray, shape (k, 3)
        m, vehicle coordinates.
    bodies : tuple of str, length k
        Attachment that each point moves with.
    kind : str
        "car", "frame", "link", "axle", "wheel", "axlebox" or "element".
    """

    points: np.ndarray
    bodies: tuple[str, ...]
    kind: str


def box_of(body):
    """Length, width and height (m) of the uniform box with the body's mass and inertia."""
    xx, yy, zz = np.diag(body.inertia)
    return np.sqrt(np.maximum(6.0 * np.array([yy + zz - xx, xx + zz - yy, xx + yy - zz]) / body.mass, 0.0))


def outlines(vehicle, view="above"):
    """Everything to draw of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle
    view : {"above", "side"}

    Returns
    -------
    list of Outline
    """
    across = 1 if view == "above" else 2
    rigid = [b for b in vehicle.bodies if b.kind != "wheelset"]
    heaviest = max((b.mass for b in rigid), default=0.0)
    car = next((b.name for b in rigid if b.mass == heaviest), "")
    found = []
    for body in vehicle.bodies:
        if body.kind == "wheelset":
            found += _wheelset(body, view)
        elif body.name == car:
            found.append(_car(vehicle, body, view))
        elif body.mass < _LINK_SHARE * heaviest:
            found += _link(vehicle, body)
        else:
            found += _frame(vehicle, body, car, view)
    return found + _elements(vehicle, across)


def _car(vehicle, body, view):
    size, centre = box_of(body), body.position.copy()
    if view == "above":
        return _closed(centre, size[0], size[1], 1, body.name, "car")
    # the box of the inertia reaches below the floor: cut it above the wheels
    floor = -2.2 * max((b.wheel_radius for b in vehicle.bodies if b.kind == "wheelset"), default=0.0)
    roof = min(centre[2] - 0.5 * size[2], floor)
    centre[2] = 0.5 * (roof + floor)
    return _closed(centre, size[0], floor - roof, 2, body.name, "car")


def _rectangle(centre, length, breadth, across):
    """Corners of a rectangle in the plane of x and axis ``across``."""
    corners = np.zeros((4, 3)) + centre
    corners[:, 0] += 0.5 * length * np.array([1, 1, -1, -1])
    corners[:, across] += 0.5 * breadth * np.array([-1, 1, 1, -1])
    return corners


def _closed(centre, length, breadth, across, name, kind):
    corners = _rectangle(centre, length, breadth, across)
    return Outline(np.vstack([corners, corners[:1]]), (name,) * 5, kind)


def _ends(vehicle, name):
    """Points where elements meet a body, with the other end's attachment."""
    for element in vehicle.elements:
        for own, other in ((element.first, element.second), (element.second, element.first)):
            if own.body == name:
                yield own.position, other.body


def _link(vehicle, body):
    points = np.array([position for position, _ in _ends(vehicle, body.name)])
    if len(points) < 2:
        return []
    order = np.argsort(points[:, 0])
    return [Outline(points[order[[0, -1]]], (body.name,) * 2, "link")]


def _arms(vehicle, body, car):
    """Places (k, 3) on a frame, from its centre, where anything but the car body is attached."""
    return np.array([p for p, other in _ends(vehicle, body.name) if other != car]).reshape(-1, 3) - body.position


def half_width(vehicle, body, car):
    """Lateral distance (m) of a frame's side members from its centre: where its primary suspension stands."""
    sides = np.abs(_arms(vehicle, body, car)[:, 1])
    sides = sides[sides > 0.1]
    return float(np.median(sides)) if len(sides) else 0.5 * float(box_of(body)[1])


def _frame(vehicle, body, car, view):
    size = box_of(body)
    if view == "side":
        return [_closed(body.position, size[0], 0.5 * size[2], 2, body.name, "frame")]
    arms, reach = _arms(vehicle, body, car), half_width(vehicle, body, car)
    length = max(size[0], 2.0 * np.abs(arms[:, 0]).max(initial=0.0))
    beam = min(0.28, 0.4 * reach)
    edges = [(-length, -reach - beam / 2), (length, -reach - beam / 2), (length, -reach + beam / 2),
             (1.4 * beam, -reach + beam / 2), (1.4 * beam, reach - beam / 2), (length, reach - beam / 2),
             (length, reach + beam / 2), (-length, reach + beam / 2), (-length, reach - beam / 2),
             (-1.4 * beam, reach - beam / 2), (-1.4 * beam, -reach + beam / 2), (-length, -reach + beam / 2)]
    points = np.array([(0.5 * x, y, 0.0) for x, y in edges + edges[:1]]) + body.position
    return [Outline(points, (body.name,) * len(points), "frame")]


def _wheelset(body, view):
    reach = body.contact_half_spacing
    boxes = [_box_outline(body, box, view) for box in body.axleboxes]
    if view == "side":
        angle = np.linspace(0.0, 2.0 * np.pi, 49)
        rim = body.position + body.wheel_radius * np.column_stack([np.cos(angle), 0.0 * angle, np.sin(angle)])
        return [Outline(rim, (body.name,) * len(rim), "wheel")] + boxes[:1]
    length = max([reach + WHEEL_WIDTH] + [abs(box.lateral_position) for box in body.axleboxes])
    axle = body.position + np.array([[0.0, -length, 0.0], [0.0, length, 0.0]])
    wheels = [_closed(body.position + np.array([0.0, side * reach, 0.0]), 2.0 * body.wheel_radius, WHEEL_WIDTH, 1, body.name, "wheel")
              for side in (-1, 1)]
    return [Outline(axle, (body.name,) * 2, "axle"), *wheels, *boxes]


def _box_outline(body, box, view):
    centre = body.position + np.array([0.0, box.lateral_position, 0.0])
    return _closed(centre, *_AXLEBOX, 1 if view == "above" else 2, box.name, "axlebox")


def _elements(vehicle, across):
    found = []
    for element in vehicle.elements:
        points = np.array([element.first.position, element.second.position])
        seen = np.delete(points[1] - points[0], 3 - across)
        if element.type in LINES and np.hypot(*seen) > SHORTEST:
            found.append(Outline(points, (element.first.body, element.second.body), "element"))
    return found
