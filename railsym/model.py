# SPDX-License-Identifier: BSD-3-Clause
"""From a vehicle to the tables that the C library assembles from.

Each kernel gets one row a body, element or wheel: its parameters in the kernel's input slots,
the coordinates it touches, and (line and axis elements) its force law.
"""

import numpy as np

from railsym import _core
from railsym.force_laws import law_record
from railsym.topology import pairs, topology
from railsym.track_frames import UniformTrack, body_motion, relative_poses

_TENSOR = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}
_BODY_KERNELS = ("rigid_body", "wheelset", "wheelset_with_axleboxes")
BUSHINGS = ("bushing", "anti_roll_bar")     # types of element with six components
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

    def _add(self, name, columns, index, laws=None):
        """Add the instances of one kernel from columns of inputs."""
        if len(index):
            self._tables[name] = input_table(name, columns, len(index))
            self.assembly.add(name, self._tables[name], index, laws)

    def _add_bodies(self):
        self._bodies = {name: [b for b in self.vehicle.bodies if _body_kernel(b) == name] for name in _BODY_KERNELS}
        for name, bodies in self._bodies.items():
            if bodies:
                start = np.array([[self.topology.start[b.name]] for b in bodies])
                self._add(name, _body_columns(bodies), start + np.arange(_core.kernels()[name].coordinates))

    def body_instances(self):
        """Name of each body -> number of its kernel, number of its instance, design position (3,) in m."""
        count, found = dict.fromkeys(_BODY_KERNELS, 0), {}
        for body in self.vehicle.bodies:
            name = body.kind + ("_with_axleboxes" if body.axleboxes else "")
            found[body.name] = _core.kernels()[name].number, count[name], body.position
            count[name] += 1
        return found

    def _add_elements(self):
        split = {"bushing": [], "line": [], "axis": []}
        for element in self.vehicle.elements:
            six = element.type in BUSHINGS
            split["bushing" if six else "line" if element.axis is None else "axis"].append(element)
        self.bushings, self.laws = split["bushing"], [*split["line"], *split["axis"]]
        self._lines = len(split["line"])
        self._pairs = {name: pairs(self.topology, elements) for name, elements in split.items()}
        self._law_tables = {}
        for name, elements in split.items():
            self._law_tables[name] = None
            if elements and name != "bushing":
                self._law_tables[name] = _core.Laws([law_record(e) for e in elements])
            if elements:
                self._add(name, *self._element_columns(name, elements), self._law_tables[name])

    def _element_columns(self, name, elements):
        """Inputs and coordinates of the elements of one kernel."""
        pair = self._pairs[name]
        apart = pair.apart  # on straight track: a curve deforms the elements, it does not make them longer
        columns = {"m1_": pair.marker1, "m2_": pair.marker2, **relative_poses(self.track, 0.0, pair)}
        if name == "bushing":
            axes, (stiffness, damping) = np.array([e.axes for e in elements]), bushing_diagonals(elements)
            free = np.einsum("nji,nj->ni", axes, apart)
            own = {"k": stiffness, "c": damping, "A1_": axes, "A2_": axes, "e0_": np.hstack([free, 0.0 * free])}
            return columns | own, pair.index
        internal = [[self.topology.internal.get(e.name, -1)] for e in elements]
        index = np.hstack([pair.index, internal])
        if name == "line":
            return columns | {"e0": np.linalg.norm(apart, axis=1)}, index
        axis = law_directions(elements, apart)
        return columns | {"ax": axis, "e0": np.sum(axis * apart, axis=1)}, index

    @property
    def bushing_pairs(self):
        """Attachments of `bushings`."""
        return self._pairs["bushing"]

    @property
    def law_pairs(self):
        """Attachments of `laws`."""
        return pairs(self.topology, self.laws)

    def set_speed(self, speed, speed_rate=0.0):
        """Move all track frames at ``speed`` (m/s)."""
        motion = body_motion(self.track, speed, speed_rate, self.vehicle.gravity)
        for name in _BODY_KERNELS:
            for key, value in motion.items():
                self._fill(name, key, value)
        for key in ("V", "w0", "w1", "w2"):
            self._fill("wheel_rail", key, motion[key])
        if self.track.curvature:
            self._move_pairs(speed)

    def _fill(self, kernel, key, value):
        if kernel in self._tables:
            self.assembly.set_input(kernel, key, np.full(len(self._tables[kernel]), value))

    def _move_pairs(self, speed):
        """Rates of the track frames against each other, which differ in a curve."""
        for name in self._law_tables.keys() & self._tables.keys():
            pose = relative_poses(self.track, speed, self._pairs[name])
            for key in ("dD", "wf"):
                for k in range(3):
                    self.assembly.set_input(name, f"{key}{k}", pose[key][:, k])

    def set_bodies(self, bodies):
        """Give bodies of one group other masses and inertias; they stay where they are."""
        name = _body_kernel(bodies[0])
        rows = [k for k, b in enumerate(self._bodies[name]) if b.group == bodies[0].group]
        self._set_inputs(name, rows, input_table(name, _body_columns(bodies), len(bodies)))

    def set_bushings(self, rows, stiffness, damping):
        """Give bushings other stiffnesses and dampings, (6,) each; ``rows`` counts in `bushings`."""
        slot, values = _core.kernels()["bushing"].slot_of, self._tables["bushing"][rows]
        values[:, slot["k0"]:slot["k0"] + 6], values[:, slot["c0"]:slot["c0"] + 6] = stiffness, damping
        self._set_inputs("bushing", rows, values)

    def set_laws(self, rows, record):
        """Give line and axis elements the numbers of another law record of the same kind; ``rows`` counts in `laws`."""
        for name, first, after in (("line", 0, self._lines), ("axis", self._lines, len(self.laws))):
            inside = [row - first for row in rows if first <= row < after]
            if inside:
                self._law_tables[name].set_numbers(inside, record)

    def _set_inputs(self, kernel, rows, values):
        """Give instances of a kernel other inputs (rows, inputs); slots that change from step to step hold 0 in both."""
        table = self._tables[kernel]
        changed = np.flatnonzero((table[rows] != values).any(axis=0))
        table[rows] = values
        for slot in changed:
            self.assembly.set_input(kernel, _core.kernels()[kernel].inputs[slot], table[:, slot])

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
        for name, values in (("line", law_forces[:self._lines]), ("axis", law_forces[self._lines:])):
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
        bodies = [body for body, _ in self.wheels]
        start = np.array([[self.topology.start[body.name]] for body in bodies])
        columns = {slot: getattr(contacts, field) for slot, field in _WHEEL_SLOTS.items()}
        columns |= {
            "side": np.array([side for _, side in self.wheels]),
            "b0": np.array([body.contact_half_spacing for body in bodies]),
            "r0": np.array([body.wheel_radius for body in bodies]),
            "offset": np.array([[0.0, *body.position[1:]] for body in bodies]),
            "V": np.ones(len(bodies)),
        }
        return columns, start + np.arange(6)

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


def input_table(name, columns, count):
    """Inputs of a kernel (count, inputs) from columns (count,), (count, k) or (count, 3, 3).

    A vector or matrix is named by what stands before the index of its first entry.
    """
    slot = _core.kernels()[name].slot_of
    table = np.zeros((count, len(slot)))
    for key, values in columns.items():
        first = next(slot[key + tail] for tail in ("", "0", "00") if key + tail in slot)
        flat = np.reshape(values, (count, -1))
        table[:, first:first + flat.shape[1]] = flat
    return table


def set_wheels(assembly, contacts):
    """Give the wheel-rail kernel of an assembly new contact parameters."""
    for slot, field in _WHEEL_SLOTS.items():
        assembly.set_input("wheel_rail", slot, getattr(contacts, field))


def _body_kernel(body):
    return body.kind + ("_with_axleboxes" if body.axleboxes else "")


def _body_columns(bodies):
    """Inputs of bodies of one kernel."""
    rows = [_body_row(b) for b in bodies]
    return {key: np.array([row[key] for row in rows]) for key in rows[0]}


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


def law_directions(elements, apart):
    """Unit vectors (count, 3) that line and axis elements act along at the design position."""
    along = np.array([np.zeros(3) if e.axis is None else e.axes[:, e.axis] for e in elements]).reshape(-1, 3)
    line = np.array([e.axis is None for e in elements], dtype=bool)
    along[line] = apart[line] / np.linalg.norm(apart[line], axis=1, keepdims=True)
    return along


def bushing_diagonals(elements):
    """Stiffnesses and dampings (count, 6) of bushings and anti-roll bars."""
    stiffness, damping = np.zeros((2, len(elements), 6))
    for k, element in enumerate(elements):
        p = element.parameters
        if element.type == "anti_roll_bar":
            roll = 3 + (element.axis or 0)
            stiffness[k, roll], damping[k, roll] = p["stiffness"], p.get("damping", 0.0)
            continue
        for target, names in ((stiffness, ("stiffness", "rotational_stiffness")),
                              (damping, ("damping", "rotational_damping"))):
            for start, name in zip((0, 3), names, strict=True):
                if name in p:
                    target[k, start:start + 3] = p[name]
    return stiffness, damping
