# SPDX-License-Identifier: BSD-3-Clause
"""Linear models written down by hand, for tests of modes, tracking, critical speeds and sensitivities.

`wheelset`, `reentrant` and `coasting` have closed-form answers; `train` is a plain-NumPy vehicle of 31 bodies on bushings.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np

from railsym.linear_model import LinearModel

DOF = ("x", "y", "z", "yaw", "roll", "pitch")
ROTATION = {"roll": 0, "pitch": 1, "yaw": 2}


def model_of(names, mass, stiffness, constant, speed, inverse, **options):
    """A LinearModel of second-order coordinates from plain lists."""
    n = len(names)
    options.setdefault("first_order", np.zeros(n, bool))
    options.setdefault("cyclic", np.zeros(n, bool))
    return LinearModel(tuple(names), *(np.asarray(m, float) for m in (mass, stiffness, constant, speed, inverse)), **options)


@dataclass(frozen=True)
class Wheelset:
    """Lateral and yaw motion of one wheelset on springs; SI units."""

    mass: float = 1500.0
    inertia: float = 820.0
    lateral_stiffness: float = 1.0e6
    yaw_stiffness: float = 1.0e6
    creep: float = 8.0e6
    conicity: float = 0.15
    half_spacing: float = 0.75
    radius: float = 0.46

    def model(self) -> LinearModel:
        f, b = 2 * self.creep, self.half_spacing
        stiffness = [[self.lateral_stiffness, -f], [f * self.conicity * b / self.radius, self.yaw_stiffness]]
        return model_of(["wheelset1.y", "wheelset1.yaw"], np.diag([self.mass, self.inertia]), stiffness, np.zeros((2, 2)),
                        np.zeros((2, 2)), np.diag([f, f * b**2]))

    def critical_speed(self) -> float:
        """Hurwitz: a3 a2 a1 = a3^2 a0 + a4 a1^2 of the quartic characteristic polynomial, solved for V."""
        f, b, m, i = 2 * self.creep, self.half_spacing, self.mass, self.inertia
        dy, dyaw, ky, kyaw = f, f * b**2, self.lateral_stiffness, self.yaw_stiffness
        a3, a1 = m * dyaw + i * dy, dy * kyaw + dyaw * ky
        a0 = ky * kyaw + f * f * self.conicity * b / self.radius
        return np.sqrt(dy * dyaw * a3 * a1 / (a3**2 * a0 + m * i * a1**2 - a3 * a1 * (m * kyaw + i * ky)))


def reentrant(seed: int = 1) -> tuple[LinearModel, list[tuple[float, float, int]]]:
    """Two oscillators seen through random coordinates, and their crossings (speed, omega, direction).

    The damping b (V - V1)(V - V2) / V of the first is negative between V1 and V2; that of the second is negative above its V2.
    """
    omega, slope, low, high = np.array([9.0, 14.0]), np.array([0.05, -0.04]), np.array([30.0, 2.0]), np.array([55.0, 120.0])
    mix = np.eye(2) + 0.4 * np.random.default_rng(seed).normal(size=(2, 2))

    def seen(values):
        return mix.T @ np.diag(values) @ mix

    model = model_of(["car.y", "bogie1.y"], seen([1, 1]), seen(omega**2), seen(-slope * (low + high)), seen(slope),
                     seen(slope * low * high))
    return model, [(30.0, 9.0, 1), (55.0, 9.0, -1), (120.0, 14.0, 1)]


def coasting() -> LinearModel:
    """A car body drawn along by two wheelsets: x of the three bodies and the spins; nothing holds the whole along the track."""
    names = ["car.x", "wheelset1.x", "wheelset1.spin", "wheelset2.x", "wheelset2.spin"]
    radius, creep, spring = 0.46, 1.6e7, 4.0e6
    mass = np.diag([39000.0, 1500.0, 90.0, 1500.0, 90.0])
    stiffness, creeping = np.zeros((5, 5)), np.zeros((5, 5))
    for x in (1, 3):
        pull = np.zeros(5)
        pull[[0, x]] = 1.0, -1.0
        stiffness += spring * np.outer(pull, pull)
        slip = np.zeros(5)
        slip[[x, x + 1]] = 1.0, radius
        creeping += creep * np.outer(slip, slip)
    return model_of(names, mass, stiffness, 1e-3 * stiffness, np.zeros((5, 5)), creeping,
                    cyclic=np.array([False, False, True, False, True]))


@dataclass
class _Assembly:
    """Bodies and elements gathered into the matrices of a LinearModel."""

    names: list = field(default_factory=list)
    bodies: dict = field(default_factory=dict)
    elements: list = field(default_factory=list)
    mass_terms: list = field(default_factory=list)
    terms: list = field(default_factory=list)          # (row vectors, matrix of the law, kind of matrix)

    def body(self, name, position, mass, inertia, kind="rigid_body", dof=DOF, wheel_radius=None):
        self.bodies[name] = SimpleNamespace(name=name, kind=kind, position=np.array(position, float), mass=mass,
                                            wheel_radius=wheel_radius)
        values = dict(zip(DOF, [mass] * 3 + [inertia[2], inertia[0], inertia[1]])) | {"spin": inertia[1]}
        for d in dof:
            self.mass_terms.append((len(self.names), values[d]))
            self.names.append(f"{name}.{d}")

    def rows(self, attachment, point):
        """Displacement and rotation (6) of a point of an attachment as rows over named coordinates."""
        result = []
        if attachment == "track":
            return [dict() for _ in range(6)]
        body, _, box = attachment.partition(".")
        arm = np.array(point) - self.bodies[body].position
        for axis in range(3):
            row = {f"{body}.{'xyz'[axis]}": 1.0}
            for angle, about in ROTATION.items():
                value = np.cross(np.eye(3)[about], arm)[axis]
                name = f"{attachment}.pitch" if angle == "pitch" else f"{body}.{angle}"
                if value:
                    row[name] = value
            result.append(row)
        return result + [{f"{body}.roll": 1.0}, {f"{attachment}.pitch": 1.0}, {f"{body}.yaw": 1.0}]

    def relative(self, first, second, point_first, point_second=None):
        ends = self.rows(first, point_first), self.rows(second, point_first if point_second is None else point_second)
        return [{k: b.get(k, 0.0) - a.get(k, 0.0) for k in a.keys() | b.keys()} for a, b in zip(*ends)]

    def element(self, name, kind, first, second, point, second_point=None):
        group = name.split(".")[0]
        end = SimpleNamespace(body=first, position=np.array(point, float))
        other = SimpleNamespace(body=second, position=np.array(point if second_point is None else second_point, float))
        self.elements.append(SimpleNamespace(name=name, group=group, type=kind, first=end, second=other))

    def bushing(self, name, first, second, point, stiffness, damping=(0, 0, 0), rotational=(0, 0, 0)):
        self.element(name, "bushing", first, second, point)
        rows = self.relative(first, second, point)
        for row, k, c in zip(rows, list(stiffness) + list(rotational), list(damping) + [0, 0, 0]):
            self.terms.append((row, row, k, "stiffness"))
            self.terms.append((row, row, c, "constant"))

    def maxwell(self, name, first, second, points, axis, damping, series, viscous=False):
        self.element(name, "maxwell", first, second, *points)
        row = self.relative(first, second, *points)[axis]
        if viscous:
            self.terms.append((row, row, damping, "constant"))
            return
        internal = {f"{name}.s": 1.0}
        self.names.append(f"{name}.s")
        spring = row | {f"{name}.s": -1.0}
        self.terms.append((spring, spring, series, "stiffness"))
        self.terms.append((internal, internal, damping, "constant"))

    def wheel(self, name, side, load, conicity, creep, half_spacing, radius, spin_inertia):
        """Linear creep forces of one wheel; conical wheel, no contact point shift. f11, f22, f23, f33 as `creep`."""
        f11, f22, f23, f33 = creep
        along = {f"{name}.x": 1.0, f"{name}.spin": radius, f"{name}.yaw": -side * half_spacing}
        across = {f"{name}.y": 1.0, f"{name}.roll": -radius}
        about = {f"{name}.yaw": 1.0}
        shift = {f"{name}.y": -side * conicity / radius, f"{name}.roll": side * conicity}
        spin = {f"{name}.roll": -1.0 / radius, f"{name}.y": -conicity / half_spacing / radius}
        for out, coefficients in ((along, [(along, shift, f11)]),
                                  (across, [(across, {f"{name}.yaw": -1.0}, f22), (about, spin, f23)]),
                                  (about, [(across, {f"{name}.yaw": -1.0}, -f23), (about, spin, f33)])):
            for rate, position, value in coefficients:
                self.terms.append((out, rate, value, "inverse"))
                self.terms.append((out, position, value, "stiffness"))
        down = {f"{name}.z": 1.0, f"{name}.roll": side * half_spacing}
        self.terms.append((down, down, 8.0e8, "stiffness"))
        self.terms.append((across, across, load * conicity / half_spacing, "stiffness"))
        self.terms.append((about, about, -load * half_spacing * conicity, "stiffness"))
        if side > 0:
            turn = {f"{name}.yaw": 1.0}, {f"{name}.roll": 1.0}
            self.terms.append((*turn, -spin_inertia / radius, "speed"))
            self.terms.append((*turn[::-1], spin_inertia / radius, "speed"))

    def model(self) -> LinearModel:
        order = {name: i for i, name in enumerate(sorted(self.names, key=lambda name: name.endswith(".s")))}
        n = len(order)
        matrices = {kind: np.zeros((n, n)) for kind in ("mass", "stiffness", "constant", "speed", "inverse")}
        for index, value in self.mass_terms:
            i = order[self.names[index]]
            matrices["mass"][i, i] += value
        for out, into, value, kind in self.terms:
            for row, a in out.items():
                for column, b in into.items():
                    matrices[kind][order[row], order[column]] += a * b * value
        names = tuple(order)
        vehicle = SimpleNamespace(bodies=tuple(self.bodies.values()), elements=tuple(self.elements))
        return LinearModel(names, *matrices.values(), np.array([name.endswith(".s") for name in names]),
                           np.array([name.endswith(".spin") for name in names]), vehicle)


@dataclass(frozen=True)
class Train:
    """A tilting coach of 31 bodies: car, 2 bogies, 4 wheelsets with 2 axleboxes, 16 trusses; SI units, values per piece."""

    conicity: float = 0.2
    kalker_weight: float = 0.6
    yaw_damping: float = 1.2e6
    yaw_series: float = 2.3e6
    yaw_dampers: tuple = (True, True, True, True)
    viscous: bool = False
    primary_longitudinal: float = 4.0e6
    primary_lateral: float = 2.0e6
    secondary_shear: float = 2.3e5
    lateral_damping: float = 3.0e4
    car_mass: float = 39000.0
    bogie_yaw_inertia: float = 4130.0
    wheelbase: float = 2.7

    def model(self) -> LinearModel:
        """The matrices: 146 second-order coordinates and up to 24 Maxwell ones."""
        assembly = _Assembly()
        assembly.body("car", (0, 0, -1.475), self.car_mass, (65000, 1870000, 1850000))
        for number, x in ((1, 9.5), (2, -9.5)):
            assembly.body(f"bogie{number}", (x, 0, -0.55), 3100, (2000, 2150, self.bogie_yaw_inertia))
            self._secondary(assembly, number, x)
            for end in (1, -1):
                self._wheelset(assembly, number, x + end * self.wheelbase / 2, 2 * number - (end > 0))
        return assembly.model()

    def changed(self, **changes) -> Train:
        return replace(self, **changes)

    def _secondary(self, assembly, number, x):
        bogie, height = f"bogie{number}", -0.9
        for name, y in (("left", -1.0), ("right", 1.0)):
            at = f"{'front' if number == 1 else 'rear'}_{name}"
            assembly.bushing(f"flexicoil.{at}", bogie, "car", (x, y, height), (self.secondary_shear,) * 2 + (4.2e5,))
            assembly.maxwell(f"vertical_damper.{at}", bogie, "car", ((x, 1.2 * y, height),), 2, 2e4, 6e6, self.viscous)
            assembly.maxwell(f"lateral_damper.{at}", bogie, "car", ((x, 0.3 * y, -0.8),), 1, self.lateral_damping, 6e6,
                             self.viscous)
            if self.yaw_dampers[2 * (number - 1) + (y > 0)]:
                assembly.maxwell(f"yaw_damper.{at}", bogie, "car", ((x, 1.35 * y, -0.6),), 0, self.yaw_damping,
                                 self.yaw_series, self.viscous)
        assembly.bushing(f"roll_bar.{bogie}", bogie, "car", (x, 0, -0.6), (0, 0, 0), rotational=(1e6, 0, 0))
        assembly.bushing(f"traction_rod.{bogie}", bogie, "car", (x, 0, -0.6), (5e6, 0, 0), damping=(5e3, 0, 0))

    def _wheelset(self, assembly, number, x, index):
        name, bogie, radius = f"wheelset{index}", f"bogie{number}", 0.46
        assembly.body(name, (x, 0, -radius), 1250 if index in (1, 4) else 1550, (820, 90, 820), "wheelset",
                      ("x", "y", "z", "yaw", "roll", "spin"), radius)
        for side, y in (("left", -1.0), ("right", 1.0)):
            box = f"{name}.axlebox_{side}"
            assembly.mass_terms.append((len(assembly.names), 4.0))
            assembly.names.append(f"{box}.pitch")
            for d, inertia in (("x", 90), ("y", 90), ("z", 90), ("yaw", 93), ("roll", 91)):
                assembly.mass_terms.append((assembly.names.index(f"{name}.{d}"), inertia))
            assembly.bushing(f"coil.{name}_{side}", box, bogie, (x, y, -0.7), (2e5, 2e5, 1.1e6))
            assembly.maxwell(f"primary_damper.{name}_{side}", box, bogie, ((x + 0.2, y, -0.6),), 2, 1.5e4, 5e6, self.viscous)
            for truss, height, mass in (("superior", -0.75, 11.0), ("inferior", -0.25, 20.0)):
                self._truss(assembly, f"{truss}_truss_{index}_{side}", box, bogie, (x, y, height), mass)
            self._wheel(assembly, name, np.sign(y), radius)

    def _truss(self, assembly, name, box, bogie, at, mass):
        x, y, z = at
        inward = -1.0 if (x > 0) == (abs(x) > 9.5) else 1.0
        assembly.body(name, (x + 0.25 * inward, y, z), mass, (0.3, 0.4, 0.4))
        rubber = (4 * self.primary_longitudinal / 4, self.primary_lateral, 2e6)
        for end, body, place in (("box", box, x), ("frame", bogie, x + 0.5 * inward)):
            assembly.bushing(f"{name}_bushing.{end}", name, body, (place, y, z), rubber, damping=(800, 800, 400),
                             rotational=(4e3, 4e3, 4e3))

    def _wheel(self, assembly, name, side, radius):
        creep = self.kalker_weight * np.array([1.05e7, 0.95e7, 2.2e4, 80.0])
        assembly.wheel(name, side, 63e3, self.conicity, creep, 0.75, radius, 90.0)


@dataclass(frozen=True)
class CrossingPaths:
    """A gyroscopic pair, whose frequencies part with speed, and an oscillator that one of them passes; seen through a mixture."""

    gyroscopic: float = 0.2
    pair: float = 10.0
    single: float = 16.0
    damping: float = 0.5

    def model(self, seed: int = 3) -> LinearModel:
        mix = np.eye(3) + 0.3 * np.random.default_rng(seed).normal(size=(3, 3))
        turning = np.zeros((3, 3))
        turning[0, 1], turning[1, 0] = -self.gyroscopic, self.gyroscopic

        def seen(matrix):
            return mix.T @ matrix @ mix

        return model_of(["car.y", "car.z", "bogie1.y"], seen(np.eye(3)), seen(np.diag([self.pair, self.pair, self.single]) ** 2),
                        seen(np.diag([0.0, 0.0, self.damping])), seen(turning), np.zeros((3, 3)))

    def frequencies(self, speed):
        """omega of the falling and the rising mode of the pair, and of the oscillator, rad/s."""
        half = 0.5 * self.gyroscopic * np.asarray(speed)
        root = np.sqrt(self.pair**2 + half**2)
        return np.array([root - half, root + half, np.full_like(half, np.sqrt(self.single**2 - 0.25 * self.damping**2))])


def dense_eigenvalues(model: LinearModel, speed) -> np.ndarray:
    """Eigenvalues of a generalised first-order form of the equations, assembled here without `LinearModel.state_matrix`.

    [C M; I 0] d/dt [q; q'] = [-K 0; 0 I] [q; q'], rows and columns of rates without inertia and of cyclic angles left out.
    """
    from scipy.linalg import eigvals

    n, moving = model.size, ~model.first_order
    damping = model.damping_constant + speed * model.damping_speed + model.damping_inverse_speed / speed
    left = np.block([[damping, model.mass], [np.eye(n), np.zeros((n, n))]])
    right = np.block([[-model.stiffness, np.zeros((n, n))], [np.zeros((n, n)), np.eye(n)]])
    # q' of internal coordinates is no state; a cyclic angle enters nowhere but in its own kinematic row
    rows = np.r_[np.ones(n, bool), moving & ~model.cyclic]
    columns = np.r_[~model.cyclic, moving]
    right[:, n:][:, model.cyclic] -= left[:, :n][:, model.cyclic]
    return eigvals(right[np.ix_(rows, columns)], left[np.ix_(rows, columns)])
