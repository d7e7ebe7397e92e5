# SPDX-License-Identifier: BSD-3-Clause
"""Contact of cones on round rails, in closed form: csrc/wheel_rail/cones.c."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from railsym.errors import ContactError
from railsym.hertz import contact_modulus, hertz


@dataclass(frozen=True)
class Cone:
    """One zone of a `ConicalContact`: a cone on a rail whose head is a circle.

    Attributes
    ----------
    slope : float
        Conicity: the radius falls by it towards the field; tangent of the contact angle at rest.
    half_spacing : float
        m, lateral distance of the contact from the track's centre line, centred.
    radius : float
        m, of the cone at that place.
    rail_radius : float
        m, of the rail's head; the rail touches the cone there when the wheelset is centred at drop 0.
    gap : float
        m, distance of the rail from the cone along the normal instead, centred at drop 0.
    """

    slope: float
    half_spacing: float = 0.75
    radius: float = 0.46
    rail_radius: float = 0.3
    gap: float = 0.0

    def __post_init__(self):
        for field in fields(self):
            value = getattr(self, field.name)
            if not np.isfinite(value) or (field.name in ("half_spacing", "radius", "rail_radius") and value <= 0.0):
                raise ContactError(f"cone: {field.name} is {value!r}; it must be finite, and a radius or spacing positive")


@dataclass(frozen=True)
class ConicalContact:
    """Wheels of cones on rails with round heads, in closed form: the contact without a table.

    For verification, and for a conicity without profiles. Displacements and rotations are full; the load is Hertz's
    on the penetration of both surfaces, the ellipse that of rest scaled with the load.

    Parameters
    ----------
    zones : tuple of Cone
        Tread first; at most three.
    wheel_radius : float
        r0, m: height of the wheelset's centre over the top of rail at drop 0.
    young_modulus, poisson : float
        N/m^2, -; of both bodies.
    limits : tuple of 3 float
        Largest lateral shift m, roll rad and penetration m; beyond it is an error, as with a table.
    """

    zones: tuple = (Cone(0.05),)
    wheel_radius: float = 0.46
    young_modulus: float = 2.1e11
    poisson: float = 0.28
    limits: tuple = (0.02, 0.1, 0.01)

    def __post_init__(self):
        if not 1 <= len(self.zones) <= 3:
            raise ContactError(f"a conical contact has 1 to 3 zones, got {len(self.zones)}")

    def wheel_shape(self, side):
        """Shape of one wheel for the C library; both sides are alike."""
        from railsym._core_wheel_rail import cones

        def outside(number, place):
            value = (side * place[0], side * place[1], self._penetration(place))[number]
            return ("lateral shift", "roll", "penetration")[number], value, (0.0 if number == 2 else -self.limits[number], self.limits[number])

        return cones(self.wheel_radius, [self._zone(zone) for zone in self.zones], self.limits, self.zones[0].half_spacing, outside)

    def _penetration(self, place):
        """Largest of the zones, m, at a place (y, roll, drop, yaw) of a right wheel; csrc/wheel_rail/cones.c."""
        y, roll, drop, yaw = place
        axle = np.array([-np.sin(yaw) * np.cos(roll), np.cos(yaw) * np.cos(roll), np.sin(roll)])
        square = 1.0 - axle[0] ** 2
        deepest = -np.inf
        for zone in map(self._zone, self.zones):
            across, down = zone["rail_y"] - y, zone["rail_z"] + self.wheel_radius - drop
            height = (down * axle[1] - across * axle[2]) * np.sqrt(1.0 - (zone["slope"] * axle[0]) ** 2 / square)
            along = zone["slope"] * (across * axle[1] + down * axle[2]) / square
            gap = height / np.sqrt(square) + along - zone["slope"] * zone["b0"] - zone["radius"]
            deepest = max(deepest, zone["rail_radius"] - gap / np.hypot(1.0, zone["slope"]))
        return deepest

    def _zone(self, zone):
        angle = np.arctan(zone.slope)
        away = zone.rail_radius + zone.gap
        unit = hertz(1.0, np.cos(angle) / zone.radius, 1.0 / zone.rail_radius, contact_modulus(self.young_modulus, self.poisson))
        approach = float(unit.approach)
        return {"slope": zone.slope, "b0": zone.half_spacing, "radius": zone.radius, "rail_radius": zone.rail_radius,
                "rail_y": zone.half_spacing + away * np.sin(angle), "rail_z": zone.radius - self.wheel_radius + away * np.cos(angle),
                "a": float(unit.a) / np.sqrt(approach), "b": float(unit.b) / np.sqrt(approach), "stiffness": approach ** -1.5}
