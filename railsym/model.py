# SPDX-License-Identifier: BSD-3-Clause
"""From a vehicle to the tables that the C library assembles from.

Each kernel gets one row a body, element or wheel: its parameters in the kernel's input slots,
the coordinates it touches, and (line and axis elements) its force law.
"""

import numpy as np

from railsym import _core
from railsym.errors import ModelError
from railsym.force_laws import law_record
from railsym.topology import ends, topology
from railsym.track_frames import UniformTrack, body_motion, relative_pose

_TENSOR = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}
_SIDES = {-1: "left", 1: "right"}
_WHEEL_SLOTS = {"lam": "conicity", "slope": "slope", "grad": "slope_gradient", "N0": "load",
                "kH": "normal_stiffness", "f11": "f11", "f22": "f22", "f23": "f23", "f33": "f33"}


class Model:
    """The equations of motion of a vehicle on a track of constant geometry.

    Parameters
    ----------
    vehicle : Vehicle
    track : UniformTrack, optional
        Straight and level by default.

    Attributes
    ----------
    topology : Topology
    assembly : railsym._core.Assembly
        Residual and pencil over all coordinates.
    bushings, laws : list of Element
        The elements of six components, and those with a scalar law, in the order of their tables.
    wheels : list of (Body, side)
        Left and right wheel of every wheelset.
    """

    def __init__(self, vehicle, track=UniformTrack()):
        self.vehicle, self.track = vehicle, track
        self.topology = topology(vehicle)
        self.assembly = _core.Assembly(self.topology.is_angle)
        self._rest = np.zeros(len(self.topology.coordinates))
        self._tables = {}
        self._add_bodies()
        self._add_elements()
        self.wheels = [(b, side) for b in vehicle.bodies if b.kind == "wheelset" for side in (-1, 1)]
        self.set_speed(1.0)

    @property
    def size(self):
        """Number of coordinates."""
        return len(self.topology.coordinates)

    def _add(self, name, rows, index, laws=None):
        """Add the rows (dicts of input name to value) of one kernel."""
        if rows:
            self.assembly.add(name, input_table(name, rows), index, laws)
            self._tables[name] = len(rows)

    def _add_bodies(self):
        rows = {name: [] for name in ("rigid_body", "wheelset", "wheelset_with_axleboxes")}
        index = {name: [] for name in rows}
        for body in self.vehicle.bodies:
            name = body.kind + ("_with_axleboxes" if body.axleboxes else "")
            start = self.topology.start[body.name]
            rows[name].append(_body_row(body))
            index[name].append(np.arange(start, start + _core.kernels()[name].coordinates))
        for name, found in rows.items():
            self._add(name, found, index[name])

    def _add_elements(self):
        split = {"bushing": [], "line": [], "axis": []}
        for element in self.vehicle.elements:
            six = element.type in ("bushing", "anti_roll_bar")
            split["bushing" if six else "line" if element.axis is None else "axis"].append(element)
        self.bushings, self.laws = split["bushing"], [*split["line"], *split["axis"]]
        self._law_tables = {}
        for name, elements in split.items():
            parts = [self._element_row(name, e) for e in elements]
            laws = _core.Laws([law_record(e) for e in elements]) if elements and name != "bushing" else None
            self._law_tables[name] = laws
            self._add(name, [row for row, _ in parts], [i for _, i in parts], laws)

    def _element_row(self, kernel, element):
        """Inputs and coordinates of one element."""
        index, place, marker = ends(self.topology, element)
        pose = relative_pose(self.track, 0.0, *place)
        row = {"m1_": marker[0], "m2_": marker[1], **pose}
        apart = pose["D"] + pose["C"] @ marker[1] - marker[0]
        if kernel == "bushing":
            return row | _bushing_row(element, apart), index
        index = [*index, self.topology.internal.get(element.name, -1)]
        if kernel == "axis":
            axis = element.axes[:, element.axis]
            return row | {"ax": axis, "e0": axis @ apart}, index
        return row | {"e0": np.linalg.norm(apart)}, index

    def set_speed(self, speed, speed_rate=0.0):
        """Move all track frames at ``speed`` (m/s)."""
        motion = body_motion(self.track, speed, speed_rate, self.vehicle.gravity)
        for name in ("rigid_body", "wheelset", "wheelset_with_axleboxes"):
            for key, value in motion.items():
                self._fill(name, key, value)
        for key in ("V", "w0", "w1", "w2"):
            self._fill("wheel_rail", key, motion[key])
        if self.track.curvature:
            self._move_pairs(speed)

    def _fill(self, kernel, key, value):
        if kernel in self._tables:
            self.assembly.set_input(kernel, key, np.full(self._tables[kernel], value))

    def _move_pairs(self, speed):
        """Rates of the track frames against each other, which differ in a curve."""
        groups = {"bushing": self.bushings}
        groups["line"] = [e for e in self.laws if e.axis is None]
        groups["axis"] = [e for e in self.laws if e.axis is not None]
        for name, elements in groups.items():
            poses = [relative_pose(self.track, speed, *ends(self.topology, e)[1]) for e in elements]
            for key in ("dD", "wf"):
                for k in range(3 if poses else 0):
                    self.assembly.set_input(name, f"{key}{k}", [p[key][k] for p in poses])

    def set_preload(self, bushing_forces, law_forces):
        """Static forces at the design position.

        Parameters
        ----------
        bushing_forces : ndarray, shape (len(bushings), 6)
            N and N m, element axes.
        law_forces : ndarray, shape (len(laws),)
            N, positive pulls the ends together.
        """
        for k in range(6 if self.bushings else 0):
            self.assembly.set_input("bushing", f"f0_{k}", bushing_forces[:, k])
        lines = sum(e.axis is None for e in self.laws)
        for name, values in (("line", law_forces[:lines]), ("axis", law_forces[lines:])):
            if self._law_tables[name] is not None:
                self._law_tables[name].set_preload(values)

    def add_wheels(self, contacts):
        """Add the linear wheel-rail contact, or give it new parameters.

        Parameters
        ----------
        contacts : WheelContacts
            One entry a wheel, in the order of `wheels`.
        """
        if "wheel_rail" in self._tables:
            set_wheels(self.assembly, contacts)
        else:
            self._add("wheel_rail", *self.wheel_rows(contacts))

    def wheel_rows(self, contacts):
        """Inputs and coordinates of the wheel-rail kernel, one row a wheel."""
        rows, index = [], []
        for k, (body, side) in enumerate(self.wheels):
            start = self.topology.start[body.name]
            index.append(np.arange(start, start + 6))
            rows.append({slot: getattr(contacts, field)[k] for slot, field in _WHEEL_SLOTS.items()} | {
                "side": side, "b0": body.contact_half_spacing, "r0": body.wheel_radius, "V": 1.0,
                "offset": np.array([0.0, *body.position[1:]])})
        return rows, index

    def rolling(self, speed):
        """Rates of the design motion: wheelsets spin at -V/r0, all else rests; shape (n,)."""
        u = np.zeros(self.size)
        for body in self.vehicle.bodies:
            if body.kind == "wheelset":
                u[self.topology.start[body.name] + 5] = -speed / body.wheel_radius
        return u

    def residual(self, q=None, u=None, a=None):
        """Residual of the equations of motion, shape (n,); zeros where a state is not given."""
        return self.assembly.residual(*(self._rest if v is None else v for v in (q, u, a)))

    def pencil(self, seed, q=None, u=None, a=None):
        """cq dr/dq + cu dr/du + ca dr/da, shape (n, n), for seed (cq, cu, ca)."""
        return self.assembly.pencil(*(self._rest if v is None else v for v in (q, u, a)), seed)


def input_table(name, rows):
    """Inputs of a kernel (len(rows), inputs) from dicts of name to number, vector or matrix.

    A vector or matrix is named by what stands before the index of its first entry.
    """
    slot = _core.kernels()[name].slot_of
    table = np.zeros((len(rows), len(slot)))
    for line, row in zip(table, rows, strict=True):
        for key, value in row.items():
            start = slot.get(key)
            if start is not None:
                line[start] = value
            else:
                start = slot[key + ("00" if key + "00" in slot else "0")]
                line[start:start + np.size(value)] = np.ravel(value)
    return table


def set_wheels(assembly, contacts):
    """Give the wheel-rail kernel of an assembly new contact parameters."""
    for slot, field in _WHEEL_SLOTS.items():
        assembly.set_input("wheel_rail", slot, getattr(contacts, field))


def _body_row(body):
    row = {"m": body.mass, "offset": np.array([0.0, *body.position[1:]])}
    if body.kind == "rigid_body":
        return row | {f"I_{key}": body.inertia[place] for key, place in _TENSOR.items()}
    row |= {"I_xx": body.inertia[0, 0], "I_yy": body.inertia[1, 1]}
    for box in body.axleboxes:
        side = _SIDES[box.side]
        row[f"m_{side}"] = box.mass
        row[f"c_{side}"] = np.array([0.0, box.lateral_position, 0.0]) + box.centre_offset
        row |= {f"I{side}_{key}": box.inertia[place] for key, place in _TENSOR.items()}
    return row


def _bushing_row(element, apart):
    stiffness, damping = bushing_diagonals(element)
    return {"k": stiffness, "c": damping, "A1_": element.axes, "A2_": element.axes,
            "e0_": np.concatenate([element.axes.T @ apart, np.zeros(3)])}


def bushing_diagonals(element):
    """Six stiffnesses and six dampings of a bushing or an anti-roll bar."""
    p, zero = element.parameters, np.zeros(3)
    if element.type == "anti_roll_bar":
        column = np.eye(6)[3 + (element.axis or 0)]
        return p["stiffness"] * column, p.get("damping", 0.0) * column
    if element.type != "bushing":
        raise ModelError(f"{element.name}: {element.type} is no element of six components")
    pairs = (("stiffness", "rotational_stiffness"), ("damping", "rotational_damping"))
    return tuple(np.concatenate([p.get(a, zero), p.get(b, zero)]) for a, b in pairs)
