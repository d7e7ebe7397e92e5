# SPDX-License-Identifier: BSD-3-Clause
"""Static balance of a tilting vehicle in a steady curve, by hand: rolls, wheel loads and jack forces, small angles about the tilted state.

Three joints above each other, front and rear alike: primary suspension (roll only, about a height h1), secondary springs (across at their
height, and roll), and the linkage with its jacks. Outward and roll-out are positive; every mass m at height h feels
m a outward and m g down. From the axle upwards

    K1 psi   = sum m (a (h - h1) + g u)                       all above the axles; u is how far the mass has moved out
    k2 d + B = sum m (a + g psi)                              all above the secondary springs; B: bump stops beyond their clearance
    K2 phi   = sum m ((a + g psi)(h - h2) + g w') + B (h2 - hb)     w' = w - d
    linkage  : jacks at their command angle theta0 give by theta:  K3 theta + m g rise(theta0 + theta)' = m (a + g (psi + phi)) across'
"""

import numpy as np
from scipy.linalg import solve
from scipy.optimize import fsolve

G = 9.81
SPRING, STOP = 0.9, 0.75                        # m: heights of secondary springs, bump stops
CAR, BOLSTER, BOGIE = (37400.0, 1.4910427807), (1600.0, 1.1), (6200.0, 0.55)   # kg, m: both bolsters, both bogie frames
SECONDARY_ACROSS = 4 * 2.5e5                    # N/m
SECONDARY_ROLL = 4 * (4.2e5 + 1e4) + 2 * 1e6    # N m/rad: springs 1 m from the middle, their bending, anti-roll bars
BUMP, CLEARANCE = 2 * 5e5, 0.03                 # N/m, m
JACKS = 4 * 1e7                                 # N/m
HALF_SPACING = 0.75                             # m


def primary_roll(vehicle):
    """Roll stiffness (N m/rad) of the primary suspension of both bogies, and the height (m) about which a moment turns the frame.

    Springs, trusses and bushings of one bogie between the frame, which may move across and roll, and axles that are held; axleboxes
    may pitch, trusses move as they like.
    """
    boxes = [f"wheelset{k}.axlebox_{side}" for k in (1, 2) for side in ("left", "right")]
    trusses = [b.name for b in vehicle.bodies if "truss" in b.name and b.position[0] > 0.0]
    centre = {"bogie1": vehicle.body("bogie1").position} | {name: vehicle.body(name).position for name in trusses}
    centre |= {name: vehicle.body(name[:9]).position for name in boxes}
    column = {name: 6 * k for k, name in enumerate(centre)}
    size = 6 * len(centre)
    stiffness = np.zeros((size, size))
    for element in vehicle.elements:
        ends = [(end, sign) for end, sign in ((element.first, -1.0), (element.second, 1.0)) if end.body in column]
        if element.type != "bushing" or len(ends) < 2:
            continue
        relative = np.zeros((6, size))
        for end, sign in ends:
            x, y, z = end.position - centre[end.body]
            place = column[end.body]
            relative[:, place:place + 6] = sign * np.eye(6)
            relative[:3, place + 3:place + 6] = -sign * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        springs = np.concatenate([element.parameters["stiffness"], element.parameters["rotational_stiffness"]])
        stiffness += relative.T @ (springs[:, None] * relative)
    loose = [1, 3, *(column[name] + k for name in trusses for k in range(6)), *(column[name] + 4 for name in boxes)]
    load = np.zeros(len(loose))
    load[1] = 1.0
    across, roll = solve(stiffness[np.ix_(loose, loose)], load, assume_a="pos")[:2]
    # a point at z from the frame's centre moves across by y - z roll: the one at rest
    return 2.0 / roll, -(centre["bogie1"][2] + across / roll)


class Balance:
    """The solved balance.

    Parameters
    ----------
    vehicle : Vehicle
        The tilting Pendolino; its primary suspension is taken from it, all else is written above.
    linkage : TiltLinkage
    acceleration : float
        m/s^2, outward in the track plane: V^2/R cos(cant) - g sin(cant).
    angle : float
        rad, tilt angle against the bolster for which the jacks have their length, positive inward.

    Attributes
    ----------
    bogie, bolster, car : float
        rad, roll inward against the axles.
    jack_moment : float
        N m, what the jacks give against the tilt angle: work over angle.
    overturning : float
        N m about the middle of the track, of everything above the axles.
    """

    def __init__(self, vehicle, linkage, acceleration, angle=0.0):
        self.primary, self.axle = primary_roll(vehicle)
        self.linkage, self.a, self.angle = linkage, acceleration, angle
        psi, d, phi, tilt = fsolve(self.residual, np.array([1e-3, 1e-2, 1e-3, angle]), xtol=1e-13)
        self.tilt = tilt
        self.bogie, self.bolster, self.car = -psi, -psi - phi, -psi - phi + tilt
        self.jack_moment = self._jack_stiffness(angle) * (angle - tilt)
        out = self._outward(psi, d, phi, tilt)
        self.overturning = sum(m * (self.a * h + G * u) for m, h, u in out)

    def _jack_stiffness(self, angle):
        rate = self._slope(lambda x: self.linkage.jack_length(self.linkage.jacks[0], x), angle)
        other = self._slope(lambda x: self.linkage.jack_length(self.linkage.jacks[1], x), angle)
        return JACKS / 2.0 * (rate ** 2 + other ** 2)

    @staticmethod
    def _slope(function, at, h=1e-4):
        return (function(at + h) - function(at - h)) / (2.0 * h)

    def _body_shift(self, tilt):
        """Outward shift of the body's centre on the linkage (a tilt to the right moves it to the left)."""
        return -self.linkage.shift(tilt)[0]

    def _outward(self, psi, d, phi, tilt):
        """(mass, height, outward displacement) of what is above the axles, track axes."""
        yield *BOGIE, psi * (BOGIE[1] - self.axle)
        yield *BOLSTER, psi * (BOLSTER[1] - self.axle) + d + phi * (BOLSTER[1] - SPRING)
        yield *CAR, psi * (CAR[1] - self.axle) + d + phi * (CAR[1] - SPRING) + self._body_shift(tilt)

    def residual(self, x):
        psi, d, phi, tilt = x
        felt, across = self.a + G * psi, self._body_shift(tilt)
        first = sum(m * (self.a * (h - self.axle) + G * u) for m, h, u in self._outward(psi, d, phi, tilt))
        above = (*BOLSTER, phi * (BOLSTER[1] - SPRING)), (*CAR, phi * (CAR[1] - SPRING) + across)
        pressed = d + phi * (STOP - SPRING)
        bump = BUMP * np.sign(pressed) * max(abs(pressed) - CLEARANCE, 0.0)
        second = sum(m * (felt * (h - SPRING) + G * w) for m, h, w in above)
        rises = self._slope(lambda t: -self.linkage.shift(t)[1], tilt)
        moved = -self._slope(self._body_shift, tilt)  # against theta inward
        gravity = CAR[0] * (G * rises - (felt + G * phi) * -moved)
        jacks = self._jack_stiffness(self.angle) * (tilt - self.angle)
        return [self.primary * psi - first, (SECONDARY_ACROSS * d + bump - (BOLSTER[0] + CAR[0]) * felt) * 1e-1,
                SECONDARY_ROLL * phi - second - bump * (SPRING - STOP), jacks + gravity]
