# SPDX-License-Identifier: BSD-3-Clause
"""Closed forms of one conical wheelset: Klingel's wavelength and the critical speed.

The wheelset has the coordinates y (right) and psi (yaw, z down) and springs
ky, kpsi to a frame that moves steadily with speed V.  Creepages of the wheel
on side s = -1, +1 (roll neglected; a cone's contact slope and roll then leave
the spin at psi'/V plus a constant that the two wheels cancel):

    xi_s = -s (b0 psi'/V + lam y/r0),  eta = y'/V - psi,  phi = psi'/V

Forces on a wheel  Fx = -f11 xi,  Fy = -(f22 eta + f23 phi),
Mz = f23 eta - f33 phi; with Fx on a lever -s b0 the sums over two wheels are

    Fy   = -2 f22 (y'/V - psi) - 2 f23 psi'/V
    Mpsi = -2 f11 b0 (b0 psi'/V + lam y/r0) + 2 f23 (y'/V - psi) - 2 f33 psi'/V

With c1 = 2 f22, c2 = 2 f11 b0^2 + 2 f33, d = 2 f23, h = 2 f11 b0 lam/r0 and
the stiffnesses k1 = ky + gy, k2 = kpsi + gpsi (g: gravitational stiffness)

    [ m s^2 + c1 s/V + k1     d s/V - c1             ] [ y   ]
    [ h - d s/V               I s^2 + c2 s/V + k2 + d ] [ psi ]  = 0

Determinant, with the products of the off-diagonal
-(d s/V - c1)(h - d s/V) = d^2 s^2/V^2 - d (h + c1) s/V + c1 h:

    p4 = m I
    p3 = (m c2 + I c1)/V
    p2 = m (k2 + d) + I k1 + (c1 c2 + d^2)/V^2
    p1 = (c1 k2 + c2 k1 - d h)/V              (c1 d cancels)
    p0 = k1 (k2 + d) + c1 h

Routh-Hurwitz: stable if and only if all p > 0 and p1 p2 p3 > p0 p3^2 + p4 p1^2.
Put w^2 = p1/p3, which does not depend on V; dividing by p3 p1 the last
condition reads p2 > p0/w^2 + p4 w^2, that is

    (c1 c2 + d^2)/V^2 > [ p0 + p4 w^4 - w^2 (m (k2 + d) + I k1) ]/w^2
                      = [ c1 h + (k1 - m w^2)(k2 + d - I w^2) ]/w^2

so the wheelset is stable exactly below

    V_c^2 = (c1 c2 + d^2) w^2 / [ c1 h + (k1 - m w^2)(k2 + d - I w^2) ]     (1)
    w^2   = (c1 k2 + c2 k1 - d h)/(m c2 + I c1)                             (2)

At V_c the roots on the axis are s = +-i w: w is the hunting frequency.  If the
bracket of (1) is not positive the wheelset is stable at every speed; if w^2 or
p0 is not positive it is unstable at every speed.

Without spin (d = 0) equation (2) gives c1 (k2 - I w^2) = -c2 (k1 - m w^2), so

    V_c^2 = c1 c2 w^2 / [ c1 h - (c2/c1)(k1 - m w^2)^2 ]                    (3)

for any f11, f22.  The bracket is largest, and V_c lowest, where both motions
have one natural frequency, k1/m = k2/I = w^2; then f11 and f22 drop out,

    V_c = w sqrt(b0 r0/lam)                                                 (4)

and hunting has Klingel's wavelength 2 pi V_c/w = 2 pi sqrt(b0 r0/lam).
For f11 = f22 = f and f33 = 0, c2 = b0^2 c1 and (2) is
w^2 = (k2 + b0^2 k1)/(I + b0^2 m).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt

import numpy as np


def klingel_wavelength(wheel_radius, contact_half_spacing, conicity):
    """Wavelength of a free conical wheelset, L = 2 pi sqrt(b0 r0/lam), m (Klingel 1883)."""
    return 2.0 * pi * sqrt(contact_half_spacing * wheel_radius / conicity)


@dataclass(frozen=True)
class Wheelset:
    """Two-degree-of-freedom wheelset on springs to ground; SI units.

    f11, f22 in N, f23 in N m, f33 in N m^2 are per wheel; stiffnesses per
    wheelset in N/m and N m/rad.  The gravitational stiffnesses are added to the
    springs: laterally + 2 N E/b0, in yaw - 2 N b0 delta0 for wheel load N.
    """

    mass: float
    yaw_inertia: float
    wheel_radius: float
    contact_half_spacing: float
    conicity: float
    lateral_stiffness: float
    yaw_stiffness: float
    f11: float
    f22: float
    f23: float = 0.0
    f33: float = 0.0
    gravity_lateral_stiffness: float = 0.0
    gravity_yaw_stiffness: float = 0.0

    def _symbols(self):
        k1 = self.lateral_stiffness + self.gravity_lateral_stiffness
        k2 = self.yaw_stiffness + self.gravity_yaw_stiffness
        c1 = 2.0 * self.f22
        c2 = 2.0 * self.f11 * self.contact_half_spacing**2 + 2.0 * self.f33
        h = 2.0 * self.f11 * self.contact_half_spacing * self.conicity / self.wheel_radius
        return k1, k2, c1, c2, 2.0 * self.f23, h

    def critical_speed(self):
        """(V_c in m/s, hunting frequency w in rad/s), equations (1) and (2).

        V_c = inf: stable at every speed (for positive w^2); V_c = 0: at none.
        """
        k1, k2, c1, c2, d, h = self._symbols()
        m, inertia = self.mass, self.yaw_inertia
        w2 = (c1 * k2 + c2 * k1 - d * h) / (m * c2 + inertia * c1)
        if w2 <= 0.0 or k1 * (k2 + d) + c1 * h <= 0.0:
            return 0.0, 0.0
        bracket = c1 * h + (k1 - m * w2) * (k2 + d - inertia * w2)
        if bracket <= 0.0:
            return inf, sqrt(w2)
        return sqrt((c1 * c2 + d**2) * w2 / bracket), sqrt(w2)

    def state_matrix(self, speed):
        """A of x' = A x, x = [y, psi, y', psi'], at a speed in m/s."""
        k1, k2, c1, c2, d, h = self._symbols()
        stiffness = np.array([[k1, -c1], [h, k2 + d]])
        damping = np.array([[c1, d], [-d, c2]]) / speed
        inverse_mass = np.diag([1.0 / self.mass, 1.0 / self.yaw_inertia])
        return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse_mass @ stiffness, -inverse_mass @ damping]])
