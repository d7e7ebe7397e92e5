# SPDX-License-Identifier: BSD-3-Clause
"""From a tilt angle to the lengths of the actuators, as polynomials that C evaluates too; the linkage is `railsym.tilt_linkage`'s."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.errors import ModelError
from railsym.tilt.errors import TiltError
from railsym.tilt_linkage import TiltLinkage

POWERS = 6           # of the polynomials, 0 to 5
_ANGLES = np.radians(np.linspace(-10.0, 10.0, 65))
_FIT = 2e-5          # m, that a polynomial may miss


@dataclass(frozen=True, eq=False)
class TiltDrive:
    """Which bodies tilt, and how actuators make them.

    Attributes
    ----------
    car : str
        Body that tilts.
    bolsters : tuple of str
        Bodies that it tilts against.
    actuators : tuple of str
    powers : ndarray (actuators, 6)
        Length of each over the design length (m) = sum of powers[k] tilt^k (rad).
    centre : ndarray (2,)
        m, y and z of the point about which the body turns at the design position.
    """

    car: str
    bolsters: tuple
    actuators: tuple
    powers: np.ndarray = field(repr=False)
    centre: np.ndarray

    @classmethod
    def of(cls, vehicle):
        """Of a vehicle whose body hangs by links from bolsters and is tilted by actuators of mode "length".

        Raises
        ------
        TiltError
            No such actuators or links.
        """
        jacks = [e for e in vehicle.elements if e.type == "actuator"]
        if not jacks:
            raise TiltError(f"vehicle {vehicle.name!r} has no actuators to tilt it; pendolino_tilting has")
        if any(e.parameters["mode"] != "length" for e in jacks):
            raise TiltError(f"vehicle {vehicle.name!r}: the tilt unit commands lengths; its actuators must be of mode \"length\"")
        bolsters = tuple(dict.fromkeys(e.first.body for e in jacks))
        try:
            linkages = {bolster: TiltLinkage(vehicle, bolster, jacks=jacks[0].group) for bolster in bolsters}
        except ModelError as error:
            raise TiltError(str(error)) from None
        cars = {linkage.body for linkage in linkages.values()}
        if len(cars) != 1:
            raise TiltError(f"vehicle {vehicle.name!r}: {', '.join(sorted(cars))} tilt; one body is controlled by a tilt unit")
        car, first = cars.pop(), linkages[bolsters[0]]
        powers = np.array([_powers(linkages[e.first.body], e.name) for e in jacks])
        return cls(car, bolsters, tuple(e.name for e in jacks), _mirrored(jacks, powers), first.centre(0.0) + vehicle.body(car).position[1:])

    def lengths(self, tilt):
        """Lengths (m, over those at the design position) of the actuators at a tilt angle (rad)."""
        return self.powers @ (float(tilt) ** np.arange(POWERS))

    def tilt(self, lengths):
        """Tilt angle (rad) that fits measured lengths (m) of the actuators best."""
        from scipy.optimize import least_squares

        return float(least_squares(lambda angle: self.lengths(angle[0]) - lengths, [0.0], xtol=1e-14).x[0])


def _powers(linkage, jack):
    """Coefficients (6,), zero at the design position, by least squares over 10 degrees either way."""
    if jack not in linkage.jacks:
        raise TiltError(f"actuator {jack} does not join {linkage.body} to a bolster; there do {', '.join(linkage.jacks)}")
    angles, length = _ANGLES[:, None] ** np.arange(1, POWERS), linkage.jack_length(jack, _ANGLES)
    found = np.linalg.lstsq(angles, length, rcond=None)[0]
    if np.abs(angles @ found - length).max() > _FIT:
        raise TiltError(f"actuator {jack}: its length is no smooth function of the tilt angle up to {np.degrees(_ANGLES[-1]):g} degrees")
    return np.concatenate([[0.0], found])


def _mirrored(jacks, powers):
    """Powers of jacks that lie opposite each other made mirror images to the bit."""
    signs, done = (-1.0) ** np.arange(POWERS), powers.copy()
    for i, jack in enumerate(jacks):
        for k in range(i + 1, len(jacks)):
            ends = jack.first.position - jacks[k].first.position * [1, -1, 1], jack.second.position - jacks[k].second.position * [1, -1, 1]
            if np.abs(ends).max() < 1e-9:
                done[i] = 0.5 * (powers[i] + signs * powers[k])
                done[k] = signs * done[i]
    return done
