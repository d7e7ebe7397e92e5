# SPDX-License-Identifier: BSD-3-Clause
"""Places of a vehicle whose accelerations the criteria ask for."""

from __future__ import annotations

import re

import numpy as np

from railsym.criteria.errors import CriterionError

_SIDES = {-1: "left", 1: "right"}


def frame_markers(vehicle):
    """Points of the bogie frames above the axleboxes.

    Parameters
    ----------
    vehicle : railsym.Vehicle

    Returns
    -------
    dict of str to (str, ndarray (3,))
        Name such as ``"bogie1.above_wheelset1_left"``: the body it is fixed to, and its design position in vehicle coordinates
        (m): above the axlebox (or, without axleboxes, above the wheel), at the height of the frame's centre of mass. The run's channel is this
        name with ``.ay``.

    Raises
    ------
    CriterionError
        A wheelset that no body is joined to.

    Notes
    -----
    The frame of a wheelset is the heaviest body that an element joins to it or to its axleboxes, the car body (the heaviest of
    all) only where there is no other.
    """
    bodies = {body.name: body for body in vehicle.bodies}
    heaviest = max(vehicle.bodies, key=lambda body: body.mass).name
    markers = {}
    for wheelset in sorted((body for body in vehicle.bodies if body.kind == "wheelset"), key=lambda body: _natural(body.name)):
        frame = bodies[_frame(vehicle, wheelset, bodies, heaviest)]
        for side, word in _SIDES.items():
            lateral = next((box.lateral_position for box in wheelset.axleboxes if box.side == side), side * wheelset.contact_half_spacing)
            position = np.array([wheelset.position[0], lateral, frame.position[2]])
            markers[f"{frame.name}.above_{wheelset.name}_{word}"] = (frame.name, position)
    return markers


def _frame(vehicle, wheelset, bodies, heaviest):
    own = {wheelset.name, *(box.name for box in wheelset.axleboxes)}
    joined = set()
    for element in vehicle.elements:
        ends = {element.first.body, element.second.body}
        if ends & own:
            joined |= ends - own
    joined = {name for name in joined if name in bodies and bodies[name].kind == "rigid_body"}
    if not joined:
        raise CriterionError(f"{wheelset.name} is joined to no body, so it has no bogie frame")
    return max(joined - {heaviest} or joined, key=lambda name: (bodies[name].mass, name))


def _natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]
