# SPDX-License-Identifier: BSD-3-Clause
"""Lateral motion of the four-axle vehicle on Cooperrider bogies about steady rolling, in the conventions of railsym and of the
open simulator that ships the vehicle.

Coordinates of each body: y (right), roll phi, yaw psi; 21 in all. Small motions, one wheel-rail contact a wheel, wheels of
rows (see `TANGENT`): a value at the centre and a slope over the shift outwards. A spring along one axis between a lower and an
upper body measures e(q); the two vertical ones carry the static load P, whose second-order part is P d2e/dq2.

A wheel on side s = -1, +1 with contact at (s L, r) from the wheelset's centre, slope delta of its contact to the track plane,
normal n = (0, s sin delta, cos delta), Omega = V/r0:

    xi  = 1 - r/r0 - s L psi'/V                                        t1 = (1, psi, 0)
    eta = [cos delta (y' - r phi' - V psi) - sin delta L phi']/V       t2 = (0, cos delta, -s sin delta)
    spin = [-s Omega sin(delta + s phi) + cos delta psi']/V
    Fx = -R G a b C11 xi      Fy = -R G a b (C22 eta + sqrt(a b) C23 spin)      u = |F_linear|/(mu N),  R = 1 - u/3 + u^2/27
    F = -N n + Fx t1 + Fy t2      N = N0 (p/q0)^(3/2)      a, b as the root of p

Conventions, one flag each; a flag that is False is railsym's:

    shear            G = E/(2 (1 - nu)) in place of E/(2 (1 + nu))
    gyroscope        moments -(Iz - Iy) Omega of axes fixed in the turning wheelset in place of Iy Omega, in axes that do not turn
    arm              lateral forces at the rail have no moment about the wheelset's longitudinal axis
    roll_free        wheels are pressed in by z and roll from a place that is level at every shift: a wheelset that shifts
                     neither rises nor rolls, and its contact plane turns with the roll it has
    level_springs    vertical springs push along the track's normal in place of the lower body's
    no_spin_moment   contacts have no moment about their normal
"""

from dataclasses import dataclass, fields

import numpy as np

YOUNG, POISSON, FRICTION, GRAVITY = 2.1e11, 0.27, 0.15, 9.81
RADIUS, AXLES = 0.425, (8.574, 6.426, -6.426, -8.574)
MASS = {"car": (44388.0, 2.8e5, 5.0e5), "bogie": (2918.9, 6780.0, 6780.0), "wheelset": (1022.0, 678.0, 678.0)}
SPIN_INERTIA = 80.0
LOAD_CAR = 44388.0 * GRAVITY / 4                       # of a secondary vertical spring, N
LOAD_FRAME = (44388.0 + 2 * 2918.9) * GRAVITY / 8      # of a primary one
BODIES = ("car", "bogie1", "bogie2", "wheelset1", "wheelset2", "wheelset3", "wheelset4")
COLUMNS = ("normal_load_N", "a_m", "b_m", "lateral_distance_m", "rolling_radius_m", "c11", "c22", "c23", "c33", "penetration_m")
LARGEST_MOMENT = 3.0 * np.pi / 16.0                    # of a circular contact that turns on the spot, over mu N sqrt(a b)
STEP = 1e-20


@dataclass(frozen=True)
class Conventions:
    """Which conventions of the simulator are imitated; see the module's head."""

    shear: bool = False
    gyroscope: bool = False
    arm: bool = False
    roll_free: bool = False
    level_springs: bool = False
    no_spin_moment: bool = False

    @classmethod
    def of_simulator(cls, **changes):
        return cls(**{field.name: True for field in fields(cls)} | changes)


@dataclass(frozen=True)
class Tangent:
    """A column of the contact table at its centre: value, and slope over the shift outwards (1/m)."""

    value: float
    slope: float

    def __call__(self, shift):
        return self.value + self.slope * shift


def point(body, x, y, z):
    """Displacement of a point at x, y, z from the body's centre, as rows over the 21 coordinates: (longitudinal, lateral, vertical)."""
    rows, k = np.zeros((3, 3 * len(BODIES))), 3 * BODIES.index(body)
    rows[:, k:k + 3] = (0.0, 0.0, -y), (1.0, -z, x), (0.0, y, 0.0)
    return rows


class Suspension:
    """K and C (21, 21) of the link table."""

    def __init__(self, conventions):
        self.stiffness, self.damping = np.zeros((2, 21, 21))
        self._level = conventions.level_springs
        for number, sign in ((1, 1.0), (2, -1.0)):
            self._secondary(f"bogie{number}", 7.5 * sign, sign)
        for number, x in enumerate(AXLES, 1):
            frame = "bogie1" if x > 0.0 else "bogie2"
            self._primary(f"wheelset{number}", frame, x - np.sign(x) * 7.5)

    def _link(self, axis, lower, upper, stiffness, damping=0.0, load=0.0):
        for s in (-1.0, 1.0):
            ends = [point(body, x, s * y, z) for body, x, y, z in (lower, upper)]
            e = (ends[1] - ends[0])[axis]
            self.stiffness += stiffness * np.outer(e, e)
            self.damping += damping * np.outer(e, e)
            if load:
                self.stiffness += load * self._bend(lower, upper, (ends[1] - ends[0])[1])

    def _bend(self, lower, upper, across):
        """d2e/dq2 of a vertical spring: the ends rise by -z phi^2/2; the lower body's normal leans by its roll."""
        bend = np.zeros((21, 21))
        (low, _, _, z_low), (up, _, _, z_up) = lower, upper
        k_low, k_up = 3 * BODIES.index(low) + 1, 3 * BODIES.index(up) + 1
        bend[k_up, k_up] -= z_up
        bend[k_low, k_low] += z_low
        if not self._level:
            bend[k_low] -= across
            bend[:, k_low] -= across
            bend[k_low, k_low] -= -0.30 if low.startswith("bogie") else -0.725   # vertical distance of the ends, m
        return bend

    def _secondary(self, frame, x, sign):
        self._link(1, (frame, 0.0, 1.35, -0.6584), ("car", x, 1.65, 0.90), 182300.0, 29200.0)
        self._link(2, (frame, 0.0, 0.68, -0.9488), ("car", x, 0.68, 0.3096), 333300.0, 20000.0, LOAD_CAR)
        self._link(0, (frame, 0.0, 1.5, 0.0), ("car", x + 0.759 * sign, 1.5, 1.5584), 903350.0, 166669.0)

    def _primary(self, wheelset, frame, x):
        self._link(1, (wheelset, 0.0, 0.75, 0.0), (frame, x, 1.05, 0.0762), 1823000.0)
        self._link(2, (wheelset, 0.0, 0.62, 0.0), (frame, x, 0.62, -0.6488), 3646000.0, load=LOAD_FRAME)
        self._link(0, (wheelset, 0.0, 0.62, 0.0), (frame, np.sign(x) * 0.349, 0.62, 0.0762), 3646000.0)


class Contact:
    """Forces of a wheelset's two contacts about the centre, from the columns' tangents."""

    def __init__(self, tangent, conventions):
        self.columns, self.conventions = tangent, conventions
        self.shear = YOUNG / (2.0 * (1.0 + (-POISSON if conventions.shear else POISSON)))
        slope = np.tan(tangent["contact_angle_rad"].value)
        self.roll = -slope / (tangent["lateral_distance_m"].value - tangent["rolling_radius_m"].value * slope)   # of rigid contact, rad/m
        self.radius = tangent["rolling_radius_m"].value

    def forces(self, q, rate, speed):
        """Force along y, moments about x and z of both wheels, from (y, phi, psi) and its rate."""
        return sum(self._wheel(s, q, rate, speed) for s in (-1.0, 1.0))

    def _place(self, s, q):
        """Row of the table, slope to the track plane, normal penetration over the static one there."""
        y, phi, _ = q
        angle, distance = self.columns["contact_angle_rad"], self.columns["lateral_distance_m"]
        if self.conventions.roll_free:
            row = s * y
            slope = angle(row) - s * phi
            depth = self.columns["penetration_m"](row) + s * phi * distance(row) * np.cos(slope)
            return row, slope, depth
        across = s * (y - self.radius * phi)
        row = across / (1.0 - self.radius * self.roll)
        slope = angle(row) - s * phi
        return row, slope, self.columns["penetration_m"].value + np.sin(slope) * across + np.cos(slope) * s * phi * distance(row)

    def _wheel(self, s, q, rate, speed):
        (_, phi, psi), (dy, dphi, dpsi) = q, rate
        row, slope, depth = self._place(s, q)
        load, a, b, arm, radius, c11, c22, c23, c33, rest = (self.columns[name](row) for name in COLUMNS)
        normal, size = load * (depth / rest) ** 1.5, np.sqrt(depth / rest)
        a, b, turn = a * size, b * size, speed / self.radius
        xi = 1.0 - radius / self.radius - s * arm * dpsi / speed
        eta = (np.cos(slope) * (dy - radius * dphi - speed * psi) - np.sin(slope) * arm * dphi) / speed
        spin = (-s * turn * np.sin(slope + s * phi) + np.cos(slope) * dpsi) / speed
        fx, fy = -self.shear * a * b * c11 * xi, -self.shear * a * b * (c22 * eta + np.sqrt(a * b) * c23 * spin)
        u = np.sqrt(fx * fx + fy * fy) / (FRICTION * normal)
        saturated = 1.0 - u / 3.0 + u * u / 27.0
        fx, fy = saturated * fx, saturated * fy
        side = -normal * s * np.sin(slope) + fy * np.cos(slope)
        down = -normal * np.cos(slope) - s * fy * np.sin(slope)
        roll_moment = s * arm * (down + phi * side)
        if not self.conventions.arm:
            roll_moment = roll_moment - radius * (side + phi * down) - s * arm * phi * side
        yaw_moment = -s * arm * (fx - fy * np.cos(slope) * psi + psi * side)
        if not self.conventions.no_spin_moment:
            moment, reach = self.shear * (a * b) ** 1.5 * (c23 * eta - np.sqrt(a * b) * c33 * spin), FRICTION * normal * np.sqrt(a * b)
            v = np.sqrt(u * u + (moment / (LARGEST_MOMENT * reach)) ** 2)
            yaw_moment = yaw_moment + (1.0 - v / 3.0 + v * v / 27.0) * moment
        return np.array([fx * psi + side, roll_moment, yaw_moment])

    def slopes(self, speed):
        """Stiffness and damping (3, 3) of a wheelset."""
        at = np.eye(3) * 1j * STEP
        k = np.stack([self.forces(column, np.zeros(3), speed).imag for column in at], axis=1) / -STEP
        c = np.stack([self.forces(np.zeros(3), column, speed).imag for column in at], axis=1) / -STEP
        return k, c


def state_matrix(tangent, conventions, speed):
    """A (42, 42) over the 21 coordinates and their rates, at a speed in m/s."""
    suspension, contact = Suspension(conventions), Contact(tangent, conventions)
    stiffness, damping = suspension.stiffness.copy(), suspension.damping.copy()
    k, c = contact.slopes(speed)
    inertia = SPIN_INERTIA - (MASS["wheelset"][1] if conventions.gyroscope else 0.0)
    gyroscope = inertia * speed / contact.radius * np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    for number in range(3, 7):
        own = slice(3 * number, 3 * number + 3)
        stiffness[own, own] += k
        damping[own, own] += c + gyroscope
    mass = np.concatenate([MASS[name.rstrip("1234")] for name in BODIES])
    return np.block([[np.zeros((21, 21)), np.eye(21)], [-stiffness / mass[:, None], -damping / mass[:, None]]])
