# SPDX-License-Identifier: BSD-3-Clause
"""One KanesMethod over a whole small vehicle in a straight track frame that moves at V(t).

Nothing here comes from derive/. Bodies are oriented by one body-fixed rotation each, element
forces are loads on points and frames of the vehicle; the deformations are vector products of
SymPy and their rates its time derivatives. Nothing is simplified.
"""

from dataclasses import dataclass

import numpy as np
import sympy as sm
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dot, dynamicsymbols, inertia

T = dynamicsymbols._t


@dataclass
class Attachment:
    """A frame and a point of it that an element can be attached to, with its design position."""

    frame: ReferenceFrame
    point: Point
    place: np.ndarray


class KaneVehicle:
    """Equations of a vehicle whose bodies are rigid bodies and wheelsets with axleboxes.

    `residual` gives the same rows as the assembled model: -(Fr + Fr*), then 0 = c ds/dt - k (e - s).
    """

    def __init__(self, vehicle):
        self.vehicle, self.track, self.origin = vehicle, ReferenceFrame("N"), Point("O")
        self.speed, self.gravity = dynamicsymbols("V"), sm.Symbol("g")
        self.origin.set_vel(self.track, self.speed * self.track.x)
        self.q, self.u, self.bodies, self.loads = [], [], [], []
        self.attached = {}
        for body in vehicle.bodies:
            self._add_wheelset(body) if body.kind == "wheelset" else self._add_rigid(body)
        self.deformations, self.forces = [], []
        for element in vehicle.elements:
            self._add_element(element)
        self._derive()

    def _coordinates(self, name, count):
        q = [dynamicsymbols(f"q_{name}_{k}") for k in range(count)]
        self.q += q
        self.u += [dynamicsymbols(f"u_{name}_{k}") for k in range(count)]
        return q

    def _centre(self, name, place, q):
        offset = sum((sm.Float(p) + c) * e for p, c, e in zip(place, q, self.track, strict=True))
        centre = self.origin.locatenew(f"C_{name}", offset)
        centre.set_vel(self.track, self.speed * self.track.x + sum(c.diff(T) * e for c, e in zip(q, self.track, strict=True)))
        return centre

    def _oriented(self, name, angles):
        frame = ReferenceFrame(name)
        frame.orient_body_fixed(self.track, tuple(angles), "ZXY")
        return frame

    def _add_body(self, name, frame, centre, mass, tensor, tensor_frame=None):
        dyadic = inertia(tensor_frame or frame, *(tensor[i] for i in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))))
        self.bodies.append(RigidBody(name, centre, frame, mass, (dyadic, centre)))
        self.loads.append((centre, mass * self.gravity * self.track.z))

    def _add_rigid(self, body):
        q = self._coordinates(body.name, 6)
        frame, centre = self._oriented(body.name, q[3:]), self._centre(body.name, body.position, q[:3])
        self._add_body(body.name, frame, centre, body.mass, body.inertia)
        self.attached[body.name] = Attachment(frame, centre, body.position)

    def _add_wheelset(self, body):
        q = self._coordinates(body.name, 8)
        axle, centre = self._oriented(body.name, [*q[3:5], 0]), self._centre(body.name, body.position, q[:3])
        wheels = ReferenceFrame(f"{body.name}_wheels")
        wheels.orient_axis(axle, axle.y, q[5])
        self._add_body(body.name, wheels, centre, body.mass, body.inertia)  # in the frame that spins
        self.attached[body.name] = Attachment(axle, centre, body.position)
        for box, pitch in zip(body.axleboxes, q[6:], strict=True):
            frame = self._oriented(box.name, [*q[3:5], pitch])
            arm = box.centre_offset + [0.0, box.lateral_position, 0.0]
            self._add_body(box.name, frame, self._fixed(box.name, centre, frame, arm), box.mass, box.inertia)
            self.attached[box.name] = Attachment(frame, centre, body.position)

    def _fixed(self, name, centre, frame, arm):
        """A point that moves with a frame."""
        point = centre.locatenew(f"P_{name}", sum(sm.Float(c) * e for c, e in zip(arm, frame, strict=True)))
        point.v2pt_theory(centre, self.track, frame)
        return point

    def _ends(self, element):
        """Frame and marker of both ends; the track's frame is the track, its origin under the other body."""
        found = []
        for end, other in ((element.first, element.second), (element.second, element.first)):
            if end.body == "track":
                place = self.attached[other.body].place
                base = self.origin.locatenew(f"B_{element.name}", sum(sm.Float(p) * e for p, e in zip(place, self.track, strict=True)))
                base.set_vel(self.track, self.speed * self.track.x)
                known = Attachment(self.track, base, place)
            else:
                known = self.attached[end.body]
            marker = self._fixed(f"{element.name}_{end.body}", known.point, known.frame, end.position - known.place)
            found.append((known.frame, marker))
        return found

    def _add_element(self, element):
        (frame1, marker1), (frame2, marker2) = self._ends(element)
        apart = marker2.pos_from(marker1)
        a, b = ([sum(sm.Float(c) * e for c, e in zip(column, frame, strict=True)) for column in element.axes.T]
                for frame in (frame1, frame2))
        start = len(self.deformations)
        if element.type in ("bushing", "anti_roll_bar"):
            self.deformations += [dot(apart, axis) for axis in a]
            self.deformations += [(dot(a[k], b[j]) - dot(a[j], b[k])) / 2 for j, k in ((1, 2), (2, 0), (0, 1))]
            f = self._new_forces(6, start)
            force = sum(f[k] * a[k] for k in range(3))
            # d(a . b)/dt = (relative angular velocity) . (b x a)
            pairs = zip(f[3:], ((1, 2), (2, 0), (0, 1)), strict=True)
            moment = sum(m * ((b[j] ^ a[k]) - (b[k] ^ a[j])) / 2 for m, (j, k) in pairs)
            self.loads += [(frame1, moment), (frame2, -moment)]
        else:
            along = apart if element.axis is None else a[element.axis]
            length = sm.sqrt(dot(apart, apart)) if element.axis is None else sm.Integer(1)
            self.deformations.append(length if element.axis is None else dot(apart, along))
            force = self._new_forces(1, start)[0] / length * along
        # The first body is pulled where the second marker is: in its own marker, and by the arm.
        self.loads += [(marker1, force), (frame1, apart ^ force), (marker2, -force)]

    def _new_forces(self, count, start):
        f = [sm.Symbol(f"f{start + k}") for k in range(count)]
        self.forces += f
        return f

    def _derive(self):
        rates = [q.diff(T) for q in self.q]
        method = KanesMethod(self.track, self.q, self.u, kd_eqs=[r - u for r, u in zip(rates, self.u, strict=True)])
        fr, frstar = method.kanes_equations(self.bodies, self.loads)
        a = [sm.Symbol(f"a{k}") for k in range(len(self.u))]
        speed_rate = sm.Symbol("dV")
        table = {u.diff(T): x for u, x in zip(self.u, a, strict=True)} | {self.speed.diff(T): speed_rate}
        rows = (-(fr + frstar)).xreplace(table)
        moved = dict(zip(rates, self.u, strict=True))
        stretch = sm.Matrix(self.deformations)
        stretch_rate = stretch.diff(T).xreplace(moved)
        self._rows = sm.lambdify((self.q, self.u, a, self.forces, self.speed, speed_rate, self.gravity), rows, cse=True)
        self._stretch = sm.lambdify((self.q, self.u), (stretch, stretch_rate), cse=True)

    def _laws(self, stretch, rest, rate, preload, s, s_rate):
        """Force of every component, and the rows of the Maxwell elements."""
        f, rows, k = [], [], 0
        for element in self.vehicle.elements:
            p = element.parameters
            zero, size = np.zeros(3), 6 if element.type in ("bushing", "anti_roll_bar") else 1
            e, v, f0 = (stretch - rest)[k:k + size], rate[k:k + size], preload[k:k + size]
            k += size
            if element.type == "maxwell":
                spring = p["series_stiffness"] * (e[0] - s[len(rows)])
                rows.append(p["damping"] * s_rate[len(rows)] - spring)
                f.append(f0 + spring)
                continue
            if element.type == "bushing":
                stiffness, damping = (np.concatenate([p[key], p.get(f"rotational_{key}", zero)]) for key in ("stiffness", "damping"))
            elif element.type == "anti_roll_bar":
                stiffness, damping = (np.eye(6)[3] * p[key] for key in ("stiffness", "damping"))
            else:
                stiffness, damping = p.get("stiffness", 0.0), p.get("damping", 0.0)
            f.append(f0 + stiffness * e + damping * v)
        return np.concatenate(f), rows

    def residual(self, q, u, a, speed, speed_rate, preload):
        """Rows of all coordinates; `preload` is one number a component, in the elements' order."""
        n = len(self.q)
        rest = np.ravel(self._stretch(np.zeros(n), np.zeros(n))[0])
        stretch, rate = map(np.ravel, self._stretch(q[:n], u[:n]))
        f, internal = self._laws(stretch, rest, rate, preload, q[n:], u[n:])
        return np.concatenate([np.ravel(self._rows(q[:n], u[:n], a[:n], f, speed, speed_rate, self.vehicle.gravity)), internal])
