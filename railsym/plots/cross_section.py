# SPDX-License-Identifier: BSD-3-Clause
"""The leading end of a vehicle seen from behind: wheelset, bogie frame, car body, and what joins them."""

from __future__ import annotations

import numpy as np

from railsym.plots.outlines import LINES, SHORTEST, WHEEL_WIDTH, Outline, box_of, half_width

_BEAM = (0.24, 0.30)          # m, drawn width and height of a frame's side member
_CROSS_MEMBER = 0.14          # m, drawn height
_AXLEBOX = (0.20, 0.26)       # m, drawn width and height
_FLANGE = (0.030, 0.028)      # m, drawn width and height of a flange (S1002)


def cross_section(vehicle):
    """Outlines of the leading wheelset, its frame and the car body in the plane of y and z.

    Parameters
    ----------
    vehicle : Vehicle
        With at least one wheelset.

    Returns
    -------
    list of railsym.plots.outlines.Outline
    """
    wheelset = max((b for b in vehicle.bodies if b.kind == "wheelset"), key=lambda body: body.position[0])
    frame, car = _frame_and_car(vehicle, wheelset)
    found = _wheelset(wheelset)
    if car is not None:
        found.append(_car(vehicle, car))
    if frame is not None:
        found += _frame(vehicle, frame, None if car is None else car.name)
    kept = {wheelset.name, *(box.name for box in wheelset.axleboxes), *(body.name for body in (frame, car) if body is not None)}
    return found + _elements(vehicle, kept)


def _frame_and_car(vehicle, wheelset):
    """Body that carries the wheelset's axleboxes, and the body on top of it; None where there is none."""
    rigid = sorted((b for b in vehicle.bodies if b.kind != "wheelset"), key=lambda body: -body.mass)
    if len(rigid) < 2:
        return (rigid[0] if rigid else None), None
    from railsym.criteria.markers import frame_markers

    name = next(body for marker, (body, _) in frame_markers(vehicle).items() if f"above_{wheelset.name}_" in marker)
    return vehicle.body(name), None if rigid[0].name == name else rigid[0]


def _rectangle(middle, width, height):
    y, z = 0.5 * width * np.array([-1, 1, 1, -1, -1]), 0.5 * height * np.array([-1, -1, 1, 1, -1])
    return middle + np.column_stack([np.zeros(5), y, z])


def _whole(points, name, kind):
    return Outline(points, (name,) * len(points), kind)


def _wheelset(body):
    length = max([body.contact_half_spacing + WHEEL_WIDTH] + [abs(box.lateral_position) for box in body.axleboxes])
    found = [_whole(body.position + np.array([[0.0, -length, 0.0], [0.0, length, 0.0]]), body.name, "axle")]
    found += [_whole(body.position + _wheel(side, body), body.name, "wheel") for side in (-1, 1)]
    boxes = ((box.name, body.position + np.array([0.0, box.lateral_position, 0.0])) for box in body.axleboxes)
    return found + [_whole(_rectangle(middle, *_AXLEBOX), name, "axlebox") for name, middle in boxes]


def _wheel(side, body):
    """Rim with a flange on its inner side, top and bottom; from the wheelset's centre."""
    r, inner = body.wheel_radius, body.contact_half_spacing - 0.070
    outline = [(inner, r + _FLANGE[1]), (inner + _FLANGE[0], r + _FLANGE[1]), (inner + 1.6 * _FLANGE[0], r), (inner + WHEEL_WIDTH, r)]
    outline += [(y, -z) for y, z in reversed(outline)]
    return np.array([(0.0, side * y, z) for y, z in outline + outline[:1]])


def _car(vehicle, body):
    size, floor = box_of(body), -2.2 * max(b.wheel_radius for b in vehicle.bodies if b.kind == "wheelset")
    roof = min(body.position[2] - 0.5 * size[2], floor - 0.3)
    middle = np.array([body.position[0], body.position[1], 0.5 * (roof + floor)])
    return _whole(_rectangle(middle, size[1], floor - roof), body.name, "car")


def _frame(vehicle, body, car):
    reach = half_width(vehicle, body, car)
    beams = [_whole(_rectangle(body.position + np.array([0.0, side * reach, 0.0]), *_BEAM), body.name, "frame") for side in (-1, 1)]
    return [*beams, _whole(_rectangle(body.position, 2.0 * reach - _BEAM[0], _CROSS_MEMBER), body.name, "frame")]


def _elements(vehicle, kept):
    found = []
    for element in vehicle.elements:
        points = np.array([element.first.position, element.second.position])
        if element.type in LINES and {element.first.body, element.second.body} <= kept and np.hypot(*(points[1] - points[0])[1:]) > SHORTEST:
            found.append(Outline(points, (element.first.body, element.second.body), "element"))
    return found
