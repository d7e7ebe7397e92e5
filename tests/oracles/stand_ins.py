# SPDX-License-Identifier: BSD-3-Clause
"""Small vehicles written out in code, so that the oracle can be tested without any vehicle file."""

from types import SimpleNamespace

import numpy as np

GRAVITY = 9.81


def rigid_body(name, position, mass, inertia):
    """Rigid body with principal inertias."""
    return SimpleNamespace(name=name, kind="rigid_body", position=np.array(position, float), mass=mass,
                           inertia=np.diag(inertia), axleboxes=())


def wheelset(name, x, mass, inertia, radius=0.46, half_spacing=0.75, axlebox=None):
    """Wheelset at height `radius`; `axlebox` = (mass, principal inertias, lateral position, centre offset)."""
    boxes = []
    for side, label in ((-1, "left"), (1, "right")) if axlebox else ():
        box_mass, box_inertia, lateral, offset = axlebox
        boxes.append(SimpleNamespace(name=f"{name}.axlebox_{label}", side=side, mass=box_mass,
                                     inertia=np.diag(box_inertia), lateral_position=side * lateral,
                                     centre_offset=np.array(offset, float)))
    return SimpleNamespace(name=name, kind="wheelset", position=np.array([x, 0.0, -radius]), mass=mass,
                           inertia=np.diag(inertia), wheel_radius=radius, contact_half_spacing=half_spacing,
                           axleboxes=tuple(boxes))


def element(name, kind, first, second, at, at_second=None, axis=None, **parameters):
    """Element between two attachments, axes those of the vehicle."""
    ends = [SimpleNamespace(body=body, position=np.array(place, float))
            for body, place in ((first, at), (second, at if at_second is None else at_second))]
    return SimpleNamespace(name=name, group=name.split(".")[0], type=kind, first=ends[0], second=ends[1],
                           axes=np.eye(3), axis=axis, parameters=parameters)


def vehicle(bodies, elements):
    """Anything with bodies, elements and gravity."""
    return SimpleNamespace(bodies=tuple(bodies), elements=tuple(elements), gravity=GRAVITY)


def coach():
    """Manchester Benchmarks vehicle 1 with plain springs (no series stiffness, no traction rod)."""
    bodies = [rigid_body("car", (0, 0, -1.8), 32000.0, (56800.0, 1.97e6, 1.97e6))]
    parts = []
    number = 0
    for bogie, sign in (("bogie1", 1), ("bogie2", -1)):
        x = 9.5 * sign
        bodies.append(rigid_body(bogie, (x, 0, -0.6), 2615.0, (1722.0, 1476.0, 3067.0)))
        parts += _coach_secondary(bogie, x)
        for offset in (1.28, -1.28):
            number += 1
            name = f"wheelset{number}"
            bodies.append(wheelset(name, x + offset, 1813.0, (1120.0, 112.0, 1120.0)))
            parts += [element(f"primary.{name}_{label}", "bushing", name, bogie, (x + offset, y, -0.46),
                              stiffness=np.array([31.391e6, 3.884e6, 1.22e6]), damping=np.array([15e3, 2e3, 4e3]))
                      for label, y in (("left", -1.0), ("right", 1.0))]
    return vehicle(bodies, parts)


def _coach_secondary(bogie, x):
    parts = [element(f"roll_bar.{bogie}", "anti_roll_bar", bogie, "car", (x, 0, -0.8275), axis=0, stiffness=0.94e6)]
    for label, y in (("left", -1.0), ("right", 1.0)):
        place = (x, y, -0.8275)
        parts.append(element(f"secondary.{bogie}_{label}", "bushing", bogie, "car", place,
                             stiffness=np.array([160e3, 160e3, 430e3]),
                             rotational_stiffness=np.array([10500.0, 10500.0, 0.0])))
        parts.append(element(f"lateral_damper.{bogie}_{label}", "maxwell", bogie, "car", place, axis=1,
                             damping=16e3, series_stiffness=6e6))
        parts.append(element(f"vertical_damper.{bogie}_{label}", "damper", bogie, "car", place, axis=2, damping=20e3))
    return parts


def bogie_with_links():
    """One bogie under a heavy body: axleboxes on the axle held by longitudinal links, line elements everywhere."""
    bodies = [rigid_body("body", (0, 0, -1.6), 16000.0, (3e4, 3e4, 3e4)),
              rigid_body("frame", (0, 0, -0.6), 3000.0, (2000.0, 2150.0, 4130.0))]
    parts = [element("traction", "traction_rod", "frame", "body", (-0.4, 0, -0.6), (0.4, 0, -0.65), stiffness=5e6,
                     damping=1e3),
             element("bar.centre", "anti_roll_bar", "frame", "body", (0, 0, -0.9), axis=0, stiffness=1e6),
             element("guide.centre", "bushing", "track", "body", (0, 0, -1.6), stiffness=np.array([1e5, 1e5, 0.0]),
                     rotational_stiffness=np.array([2e5, 2e5, 2e5]))]
    for label, y in (("left", -1.0), ("right", 1.0)):
        parts.append(element(f"flexicoil.{label}", "bushing", "frame", "body", (0, y, -0.7), (0, y, -1.1),
                             stiffness=np.array([2.3e5, 2.3e5, 4.2e5]), damping=np.array([1e3, 2e3, 2e4])))
        parts.append(element(f"yaw_damper.{label}", "maxwell", "frame", "body", (0.1, 1.35 * y, -0.7),
                             (0.8, 1.35 * y, -0.72), damping=1.2e6, series_stiffness=2.3e6))
        parts.append(element(f"stop.{label}", "bump_stop", "frame", "body", (0, 0.3 * y, -0.8), axis=1,
                             clearance=0.025, stiffness=1e6))
    for name, x in (("wheelset1", 1.35), ("wheelset2", -1.35)):
        bodies.append(wheelset(name, x, 1250.0, (820.0, 90.0, 820.0), axlebox=(90.0, (1.0, 4.0, 3.0), 1.0,
                                                                              (0.02, 0.0, 0.03))))
        for label, y in (("left", -1.0), ("right", 1.0)):
            _add_link(bodies, parts, name, label, x, y)
    return vehicle(bodies, parts)


def _add_link(bodies, parts, name, label, x, y):
    """A link as a body between axlebox and frame, and the coil spring and damper beside it."""
    box, inward = f"{name}.axlebox_{label}", -np.sign(x)
    where = f"{name}_{label}"
    soft = np.array([8e6, 3e6, 3e6])
    turning = np.array([500.0, 200.0, 500.0])
    bodies.append(rigid_body(f"link_{where}", (x + 0.4 * inward, y, -0.55), 20.0, (0.1, 0.3, 0.3)))
    parts += [
        element(f"box_rubber.{where}", "bushing", box, f"link_{where}", (x + 0.15 * inward, y, -0.55),
                stiffness=soft, rotational_stiffness=turning, rotational_damping=0.01 * turning),
        element(f"frame_rubber.{where}", "bushing", f"link_{where}", "frame", (x + 0.65 * inward, y, -0.55),
                stiffness=soft, rotational_stiffness=turning, damping=1e-3 * soft),
        element(f"coil.{where}", "spring", box, "frame", (x, y, -0.6), (x, y, -0.85), stiffness=9e5),
        element(f"damper.{where}", "maxwell", box, "frame", (x + 0.2, 1.1 * y, -0.5), (x + 0.15, 1.1 * y, -0.8),
                damping=1.5e4, series_stiffness=5e6),
        element(f"retainer.{where}", "spring", box, "frame", (x - 0.1 * inward, y, -0.4), axis=2, stiffness=2e5)]


def single_wheelset(**contact):
    """A free wheelset and its wheels; keywords replace contact numbers."""
    body = wheelset("wheelset1", 0.0, 1.0, (1.0, 0.1, 1.0))
    numbers = dict(load=1e5, conicity=0.2, slope=0.05, slope_gradient=0.0, normal_stiffness=1e9, f11=1e7, f22=1e7,
                   f23=0.0, f33=0.0) | contact
    return vehicle([body], []), wheels([body], **numbers)


def wheels(wheelsets, **numbers):
    """Contact numbers alike on all wheels, left before right."""
    count = 2 * len(wheelsets)
    arrays = {name: np.full(count, float(value)) for name, value in numbers.items()}
    arrays["side"] = np.tile([-1.0, 1.0], len(wheelsets))
    for field in ("wheel_radius", "contact_half_spacing"):
        arrays[field] = np.repeat([getattr(body, field) for body in wheelsets], 2)
    return SimpleNamespace(**arrays)


def usual_wheels(some_vehicle, load=60e3, conicity=0.2):
    """Typical contact numbers for every wheelset of a vehicle."""
    wheelsets = [body for body in some_vehicle.bodies if body.kind == "wheelset"]
    return wheels(wheelsets, load=load, conicity=conicity, slope=0.178, slope_gradient=0.23, normal_stiffness=1e9,
                  f11=1.1e7, f22=9e6, f23=2.5e4, f33=120.0)
