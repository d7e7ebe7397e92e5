# SPDX-License-Identifier: BSD-3-Clause
"""Independent linear model of a whole vehicle: M q'' + C(V) q' + K q = 0 about straight running at speed V.

Written from mechanics on paper (see the modules beside this one), without the package's kernels; of the package it
sees only the vehicle's data and the numbers of the wheel contacts.

Kept: every first-order term; the second-order terms of element deformations under static force, of axlebox weights
(pendulum) and of the normal wheel loads as `ContactTerms` says.  Dropped: second-order terms in the static deflection
itself (the design position is the equilibrium), and those that `ContactTerms` leaves out.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from .body_matrices import body_coordinates, body_terms
from .element_laws import element_deformation, linear_law
from .small_rotations import marker_motion
from .statics import static_deflection, wheel_loads
from .wheel_rail import ContactTerms, wheel_matrices


@dataclass(frozen=True)
class IndependentModel:
    """Linear model over q_all, SI.

    names : tuple of n coordinate names
    mass, damping, stiffness : (n, n); Maxwell states have no mass
    wheel_loads : (2 wheelsets,) static normal loads, left before right, in the order of the wheelsets
    preload : element name -> (m,) static force components on the second marker's deformation
    first_order : (n,) True for Maxwell states; cyclic : (n,) True for wheelset spin
    """

    names: tuple
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    wheel_loads: np.ndarray
    preload: dict
    first_order: np.ndarray
    cyclic: np.ndarray

    def eigenvalues(self):
        """Eigenvalues of the state matrix, 1/s, without the spin angles."""
        return np.linalg.eigvals(self.state_matrix())

    def state_matrix(self):
        """A over [q without spin angles and Maxwell states, rates of all of second order, Maxwell states]."""
        second, inner = np.flatnonzero(~self.first_order), np.flatnonzero(self.first_order)
        kept = np.flatnonzero(~self.first_order & ~self.cyclic)
        m, c, k = self.mass, self.damping, self.stiffness
        n1, n2, n3 = len(kept), len(second), len(inner)
        state = np.zeros((n1 + n2 + n3, n1 + n2 + n3))
        state[:n1, n1:n1 + n2] = np.eye(len(m))[np.ix_(kept, second)]
        forces = [k[np.ix_(second, kept)], c[np.ix_(second, second)], k[np.ix_(second, inner)]]
        state[n1:n1 + n2] = -np.linalg.solve(m[np.ix_(second, second)], np.hstack(forces))
        flow = [k[np.ix_(inner, kept)], c[np.ix_(inner, second)], k[np.ix_(inner, inner)]]
        state[n1 + n2:] = -np.linalg.solve(c[np.ix_(inner, inner)], np.hstack(flow))
        return state


class Layout:
    """Places of all coordinates, and the motion of any attachment."""

    def __init__(self, vehicle):
        self.names, self.start, self._attachments = [], {}, {"track": ((), np.zeros(3))}
        for body in vehicle.bodies:
            self._add_body(body)
        self.states = {}
        for element in vehicle.elements:
            if element.type == "maxwell" or element.parameters.get("lag", 0.0) > 0.0:
                self.states[element.name] = len(self.names)
                self.names.append(element.name + ".s")

    def _add_body(self, body):
        first = len(self.names)
        self.start[body.name] = first
        self.names += [f"{body.name}.{coordinate}" for coordinate in body_coordinates(body)]
        places = tuple(range(first, first + 6))
        centre = np.asarray(body.position, float)
        if body.kind != "wheelset":
            self._attachments[body.name] = (places, centre)
            return
        self._attachments[body.name] = (places[:5], centre)
        for number, box in enumerate(body.axleboxes):
            self._attachments[box.name] = ((*places[:5], first + 6 + number), centre)

    def motion(self, end):
        """Second-order motion of an element's end."""
        places, centre = self._attachments[end.body]
        return marker_motion(places, end.position, centre)


@dataclass(frozen=True)
class _Placed:
    """An element with its law and deformation spread over all n coordinates: J (m, n), H (m, n, n) compact."""

    element: object
    law: object
    gradient: np.ndarray
    places: np.ndarray
    hessian: np.ndarray

    @property
    def elastic(self):
        """Stiffness that can carry a static force, (m,)."""
        return np.zeros_like(self.law.stiffness) if self.law.series else self.law.stiffness

    def geometric_stiffness(self, force, n):
        """Sum over the components of f0 d2e/dq2, (n, n); both ends may share coordinates."""
        total = np.zeros((n, n))
        np.add.at(total, np.ix_(self.places, self.places), np.einsum("m,mab->ab", force, self.hessian))
        return total


def _place_elements(vehicle, layout):
    placed = []
    for element in vehicle.elements:
        first, second = layout.motion(element.first), layout.motion(element.second)
        local, hessian = element_deformation(element, first, second)
        places = np.concatenate([first.indices, second.indices])
        gradient = np.zeros((len(local), len(layout.names)))
        np.add.at(gradient, (slice(None), places), local)
        placed.append(_Placed(element, linear_law(element), gradient, places, hessian))
    return placed


def _elastic_stiffness(placed, n):
    total = np.zeros((n, n))
    for item in placed:
        total += item.gradient.T @ (item.elastic[:, None] * item.gradient)
    return total


def static_state(vehicle):
    """Static forces of the elements and wheel loads at rest: (element name -> (m,), loads (2 wheelsets,))."""
    layout = Layout(vehicle)
    return _static_state(vehicle, layout, _place_elements(vehicle, layout))


def _static_state(vehicle, layout, placed):
    n = len(layout.names)
    weight = np.zeros(n)
    for body in vehicle.bodies:
        terms = body_terms(body, vehicle.gravity)
        start = layout.start[body.name]
        weight[start:start + len(terms.gravity_force)] += terms.gravity_force
    wheelsets = [body for body in vehicle.bodies if body.kind == "wheelset"]
    held = np.array([layout.start[b.name] + place for b in wheelsets for place in (2, 4)], dtype=int)
    deflection, reactions = static_deflection(_elastic_stiffness(placed, n), weight, held)
    preload = {item.element.name: item.elastic * (item.gradient @ deflection) for item in placed}
    loads = [wheel_loads(*reactions[2 * i:2 * i + 2], b.contact_half_spacing) for i, b in enumerate(wheelsets)]
    return preload, np.array(loads).ravel()


def _add_elements(placed, layout, damping, stiffness):
    for item in placed:
        law, gradient = item.law, item.gradient
        if not law.series:
            damping += gradient.T @ (law.damping[:, None] * gradient)
            if item.element.name in layout.states:
                _add_follower(item, layout.states[item.element.name], damping, stiffness)
            continue
        # f = k (e - s), D s' = k (e - s)
        state = layout.states[item.element.name]
        row = gradient[0].copy()
        row[state] -= 1.0
        stiffness += law.stiffness[0] * np.outer(row, row)
        damping[state, state] += law.damping[0]


def _add_follower(item, state, damping, stiffness):
    """An actuator that follows its command, here zero: f = k (e - s) + c e', with k (T s' + s) = 0 for the state s."""
    k, lag = item.law.stiffness[0], item.element.parameters["lag"]
    stiffness[:, state] -= k * item.gradient[0]
    stiffness[state, state] += k
    damping[state, state] += k * lag


def _add_bodies(vehicle, layout, mass, damping, stiffness, speed, preload):
    for body in vehicle.bodies:
        terms = body_terms(body, vehicle.gravity)
        span = slice(layout.start[body.name], layout.start[body.name] + len(terms.gravity_force))
        mass[span, span] += terms.mass
        damping[span, span] += speed * terms.gyroscopic
        if preload:
            stiffness[span, span] += terms.gravity_stiffness


def single_wheels(wheels):
    """Split named arrays of WheelContacts into one namespace of numbers a wheel."""
    fields = ("load", "side", "wheel_radius", "contact_half_spacing", "conicity", "slope", "slope_gradient",
              "normal_stiffness", "f11", "f22", "f23", "f33")
    columns = {name: np.atleast_1d(np.asarray(getattr(wheels, name), float)) for name in fields}
    count = len(columns["load"])
    return [SimpleNamespace(**{name: float(np.broadcast_to(c, count)[i]) for name, c in columns.items()})
            for i in range(count)]


def _add_wheels(vehicle, layout, wheels, speed, terms, damping, stiffness):
    wheelsets = [body for body in vehicle.bodies if body.kind == "wheelset"]
    singles = single_wheels(wheels)
    if len(singles) != 2 * len(wheelsets):
        raise ValueError(f"{len(wheelsets)} wheelsets need {2 * len(wheelsets)} wheels, got {len(singles)}")
    for number, wheel in enumerate(singles):
        start = layout.start[wheelsets[number // 2].name]
        local_stiffness, local_damping = wheel_matrices(wheel, speed, terms)
        stiffness[start:start + 6, start:start + 6] += local_stiffness
        damping[start:start + 6, start:start + 6] += local_damping


def independent_model(vehicle, wheels, speed, preload=True, terms=ContactTerms()):
    """Assemble M, C(V), K of a vehicle.

    Parameters
    ----------
    vehicle : object with the fields of railsym's Vehicle
    wheels : WheelContacts or like, two wheels a wheelset in the order of the wheelsets; None: no wheel-rail forces
    speed : float, m/s, positive when there are wheels
    preload : True solves the static forces; False drops element preloads and the weight of axleboxes (the wheel
        loads' own terms are governed by `terms`); a mapping element name -> (m,) is taken as given
    terms : ContactTerms

    Returns
    -------
    IndependentModel
    """
    layout = Layout(vehicle)
    placed = _place_elements(vehicle, layout)
    n = len(layout.names)
    mass, damping, stiffness = np.zeros((n, n)), np.zeros((n, n)), _elastic_stiffness(placed, n)
    solved, loads = _static_state(vehicle, layout, placed)
    forces = solved if preload is True else ({} if preload is False else preload)
    _add_bodies(vehicle, layout, mass, damping, stiffness, speed, preload is not False)
    _add_elements(placed, layout, damping, stiffness)
    for item in placed:
        if item.element.name in forces:
            stiffness += item.geometric_stiffness(np.atleast_1d(forces[item.element.name]), n)
    if wheels is not None:
        _add_wheels(vehicle, layout, wheels, speed, terms, damping, stiffness)
    first_order = np.array([name in {m + ".s" for m in layout.states} for name in layout.names])
    cyclic = np.array([name.endswith(".spin") for name in layout.names])
    return IndependentModel(tuple(layout.names), mass, damping, stiffness, loads, forces, first_order, cyclic)
