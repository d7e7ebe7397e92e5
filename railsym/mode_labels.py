# SPDX-License-Identifier: BSD-3-Clause
"""What moves in a mode: a label from the kinetic energy of the bodies, or from the dissipated power when nothing oscillates."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from railsym.linear_model import LinearModel

CAR, BOGIE, WHEELSET, LINK = "car body", "bogie frame", "wheelset", "link"
_ROLE_WORDS = ((WHEELSET, ("wheelset", "wheel_set", "axle")), (BOGIE, ("bogie", "frame", "bolster")), (CAR, ("car", "coach", "wagon")))
LATERAL = ("y", "yaw", "roll")
_MOTION = {"x": "surge", "y": "lateral", "z": "bounce", "yaw": "yaw", "roll": "roll", "pitch": "pitch", "spin": "spin"}
_MOST = 0.75          # share of the energy that makes one bogie or wheelset "the" moving one
_REAL = 1e-9          # |Im| / |lambda| of a real eigenvalue

_known_labels = WeakKeyDictionary()    # of bases and templates


@dataclass(frozen=True, eq=False)
class _Body:
    name: str
    role: str
    group: str
    x: float


class MotionLabels:
    """Labels for the modes of one model.

    Parameters
    ----------
    model : LinearModel
        Coordinates named "body.dof"; bodies of ``model.vehicle``, when there are any, give kinds, masses and positions.
    """

    def __init__(self, model: LinearModel):
        self.model = model
        self.internal = np.flatnonzero(model.first_order)
        self.moving = np.flatnonzero(~model.first_order)
        owner = [model.coordinates[i].split(".")[0] for i in self.moving]
        self.bodies = body_roles(model)
        self.role = np.array([self.bodies[name].role for name in owner])
        self.owner = np.array(owner)
        self.dof = np.array([model.coordinates[i].rpartition(".")[2] for i in self.moving])
        self.lateral = np.isin(self.dof, LATERAL)
        unit = self._running_units()
        self.mass = model.mass[self.moving[:, None], self.moving]
        self.units = {"bogies": self._sorted_units(unit), "wheelsets": self._sorted_units(self.owner)}

    @classmethod
    def of(cls, model: LinearModel) -> MotionLabels:
        """Labels of a model; what the vehicle decides is worked out once for all models of one base or template."""
        known = model.base or model.template
        if known is None:
            return cls(model)
        if known not in _known_labels:
            made = _known_labels[known] = cls(known)
            made.model = None          # would keep its own key alive
        labels = copy(_known_labels[known])
        labels.model = model
        if model.mass is not known.mass:
            labels.mass = model.mass[labels.moving[:, None], labels.moving]
        return labels

    def _sorted_units(self, units):
        """Unit of each coordinate, and the names of the units of the running gear from the front to the rear."""
        running = (self.role == BOGIE) | (self.role == WHEELSET)
        return units, sorted(set(units[running]) - {""}, key=lambda name: -self.bodies[name].x)

    def _running_units(self):
        """Name of the bogie that each coordinate of a bogie or wheelset belongs to: the nearest one along the track."""
        bogies = [b for b in self.bodies.values() if b.role == BOGIE]
        unit = {b.name: min(bogies, key=lambda other: abs(other.x - b.x)).name if bogies else "" for b in self.bodies.values()}
        return np.array([unit[name] for name in self.owner])

    def energy(self, shape):
        """Share of the kinetic energy of each coordinate with inertia; sums to 1."""
        x = shape[self.moving]
        energy = (x.real * (self.mass @ x.real) + x.imag * (self.mass @ x.imag)).clip(min=0.0)
        return energy / energy.sum() if energy.any() else energy

    def lateral_share(self, shape) -> float:
        """Share of the kinetic energy in y, yaw and roll."""
        return float(self.energy(shape)[self.lateral].sum())

    def label(self, eigenvalue, shape, speed) -> str:
        """Label of a mode with an eigenvalue in 1/s and a shape (n,) at a speed in m/s."""
        if abs(eigenvalue.imag) <= _REAL * abs(eigenvalue):
            return self._overdamped(eigenvalue, shape, speed)
        energy = self.energy(shape)
        share = {role: energy[self.role == role].sum() for role in (CAR, BOGIE, WHEELSET, LINK)}
        if share[CAR] >= max(share[BOGIE] + share[WHEELSET], share[LINK]):
            return self._car_body(energy, shape)
        if share[LINK] > share[BOGIE] + share[WHEELSET]:
            return "link vibration, " + self._most_moved(energy, self.role == LINK)
        return self._running_gear(energy, share)

    def _car_body(self, energy, shape):
        dof = self._leading_dof(energy * (self.role == CAR))
        name = "car-body " + _MOTION[dof]
        if dof in ("y", "roll"):
            y, roll = (self._amplitude(shape, d) for d in ("y", "roll"))
            # the body turns about a pole at height -z = -y/roll over its centre of mass: below it when y and roll agree
            name = "car-body lateral" if roll == 0 else f"car-body {'lower' if (y * np.conj(roll)).real > 0 else 'upper'} sway"
        if dof in LATERAL and self._rides_on_wheels(shape):
            return f"car-body hunting ({name.removeprefix('car-body ')})"
        return name

    def _amplitude(self, shape, dof):
        at = np.flatnonzero((self.role == CAR) & (self.dof == dof))
        return shape[self.moving[at]].sum() if len(at) else 0.0

    def _rides_on_wheels(self, shape) -> bool:
        """Do the wheelsets move across the track as much as the car body does over them?"""
        at = np.flatnonzero((self.role == WHEELSET) & (self.dof == "y"))
        cars = [body.x for body in self.bodies.values() if body.role == CAR]
        if not len(at) or len(cars) != 1:
            return False
        arm = np.array([self.bodies[self.owner[i]].x for i in at]) - cars[0]
        over = self._amplitude(shape, "y") + arm * self._amplitude(shape, "yaw")
        return bool(np.linalg.norm(shape[self.moving[at]]) > np.linalg.norm(over))

    def _running_gear(self, energy, share):
        running = (self.role == BOGIE) | (self.role == WHEELSET)
        moved = energy * running
        if moved[self.lateral].sum() >= 0.5 * moved.sum():
            if share[BOGIE] == 0.0:
                return "wheelset hunting" + self._which(moved, "wheelsets")
            if moved[(self.role == WHEELSET) & self.lateral].sum() > 0.1 * moved.sum():
                return "bogie hunting" + self._which(moved, "bogies")
            return f"bogie {_MOTION[self._leading_dof(moved)]}" + self._which(moved, "bogies")
        role = WHEELSET if share[WHEELSET] > share[BOGIE] else BOGIE
        dof = self._leading_dof(energy * (self.role == role))
        if role == BOGIE:
            return f"bogie {_MOTION[dof]}" + self._which(moved, "bogies")
        name = "axlebox pitch" if dof == "pitch" else f"wheelset {_MOTION[dof]}"
        return name + self._which(energy * (self.role == role), "wheelsets")

    def _leading_dof(self, energy):
        totals = {dof: energy[self.dof == dof].sum() for dof in dict.fromkeys(self.dof)}
        return max(totals, key=totals.get)

    def _which(self, energy, plural):
        """", leading" or ", trailing" or the name of one among many, or ", both/all ..." of the units that move."""
        units, names = self.units[plural]
        if len(names) < 2:
            return ""
        amounts = [energy[units == name].sum() for name in names]
        most = int(np.argmax(amounts))
        if amounts[most] < _MOST * sum(amounts):
            return f", both {plural}" if len(names) == 2 else f", several {plural}"
        return (", leading", ", trailing")[most] if len(names) == 2 else f", {names[most]}"

    def _most_moved(self, energy, among):
        groups = {}
        for name, value in zip(self.owner[among], energy[among]):
            group = self.bodies[name].group
            groups[group] = groups.get(group, 0.0) + value
        return max(groups, key=groups.get)

    def _overdamped(self, eigenvalue, shape, speed):
        """Label of a real eigenvalue by what dissipates: Maxwell dampers, creep, other damping."""
        model, rate = self.model, eigenvalue * shape
        damper = np.abs(rate[self.internal]) ** 2 * model.damping_constant.diagonal()[self.internal]
        v = rate[self.moving]
        index = np.ix_(self.moving, self.moving)
        creep = max((v.conj() @ (model.damping_inverse_speed[index] @ v)).real / speed, 0.0)
        viscous = max((v.conj() @ (model.damping_constant[index] @ v)).real, 0.0)
        if eigenvalue.real > 0:
            return "static divergence, " + self.owner[int(np.argmax(self.energy(shape)))]
        if damper.sum() >= max(creep, viscous) and damper.any():
            group = self._damper_group(damper)
            lags = any(e.group == group and e.type == "actuator" for e in getattr(model.vehicle, "elements", None) or ())
            return ("actuator lag, " if lags else "Maxwell damper relaxation, ") + group
        energy = self.energy(shape)
        body = self.owner[int(np.argmax(energy))]
        return f"wheel-rail creep, {body}" if creep >= viscous else f"overdamped motion, {body}"

    def _damper_group(self, power):
        groups = {}
        for i, value in zip(self.internal, power):
            group = self.model.coordinates[i].split(".")[0]
            groups[group] = groups.get(group, 0.0) + value
        return max(groups, key=groups.get)


def body_roles(model: LinearModel) -> dict[str, _Body]:
    """Role of each body of a model: car body, bogie frame, wheelset or link.

    Names decide first; without a telling name the heaviest rigid body is the car body when it outweighs five wheelsets, bodies
    over a third of a wheelset are bogie frames, the others links.
    """
    known = {b.name: b for b in getattr(model.vehicle, "bodies", None) or ()}
    mass, spins = {}, set()
    for i in np.flatnonzero(~model.first_order):
        body, _, dof = model.coordinates[i].partition(".")
        mass.setdefault(body, 0.0)
        if dof in ("x", "y", "z"):
            mass[body] = max(mass[body], model.mass[i, i])
        if dof == "spin":
            spins.add(body)
    wheelsets = [value for name, value in mass.items() if name in spins]
    typical = float(np.mean(wheelsets)) if wheelsets else 0.0
    heaviest = max(mass.values(), default=0.0)
    roles = {}
    for order, (name, value) in enumerate(mass.items()):
        body = known.get(name)
        role = WHEELSET if name in spins or getattr(body, "kind", "") == "wheelset" else _role(name, value, typical, heaviest)
        place = float(body.position[0]) if body is not None else -float(order)
        roles[name] = _Body(name, role, getattr(body, "group", None) or name.rstrip("0123456789_"), place)
    return roles


def _role(name, mass, wheelset_mass, heaviest):
    lower = name.lower()
    for role, words in _ROLE_WORDS:
        if any(word in lower for word in words):
            return role
    if mass == heaviest and mass > 5.0 * wheelset_mass:
        return CAR
    return BOGIE if mass > wheelset_mass / 3.0 else LINK
