# SPDX-License-Identifier: BSD-3-Clause
"""A wheelset on a track: two wheels, two rails, and how they lie to each other."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from railsym.contact_geometry import GAUGE_HEIGHT, Side, rigid_contact
from railsym.errors import ContactError
from railsym.profiles import Profile, load_profile

# m of penetration that tables made for motion cover: on rails that do not give way a flange strikes with several hundred kN for some milliseconds
DEEPEST_IN_MOTION = 6e-4
_LIMITS = {"gauge": (0.3, 2.0), "flange_back_distance": (0.3, 2.0), "tape_circle_offset": (0.01, 0.2), "wheel_radius": (0.05, 1.5),
           "wheel_radius_left": (0.05, 1.5)}


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Wheel and rail profiles, and the measures of wheelset and track; lengths in m.

    Attributes
    ----------
    wheel, rail : Profile or str
        Of the right side, and of both unless ``wheel_left``, ``rail_left`` are given: a profile, the name of one that comes
        along, or a file.
    inclination : float, optional
        Slope of the rail towards the track's centre, such as 1/40; 1/40 if not given. A rail whose profile is given as it lies
        (EN15302_rail_A) must have none.
    gauge : float, optional
        Distance of the rails' inner sides, the least within 14 mm below the top of rail; 1.435. None for rails given as they lie:
        their y = 0 is then under the tape circle.
    flange_back_distance : float
        Distance of the inner faces of the wheels.
    tape_circle_offset : float
        From the inner face of a wheel to its tape circle.
    wheel_radius : float
        Of the right tape circle, and of both unless ``wheel_radius_left`` is given.
    wheel_left, rail_left : Profile or str, optional
        Of the left side, as right-hand profiles (y + towards the field side).
    wheel_radius_left : float, optional

    Raises
    ------
    ContactError, ProfileError
        For measures or profiles that cannot be used.
    """

    wheel: Profile | str
    rail: Profile | str
    inclination: float | None = None
    gauge: float | None = 1.435
    flange_back_distance: float = 1.360
    tape_circle_offset: float = 0.070
    wheel_radius: float = 0.460
    wheel_left: Profile | str | None = None
    rail_left: Profile | str | None = None
    wheel_radius_left: float | None = None
    _kept: dict = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self):
        put = lambda name, value: object.__setattr__(self, name, value)  # noqa: E731
        for name, kind, fallback in (("wheel", "wheel", None), ("rail", "rail", None), ("wheel_left", "wheel", "wheel"), ("rail_left", "rail", "rail")):
            given = getattr(self, name)
            put(name, getattr(self, fallback) if given is None and fallback else load_profile(given, kind))
        if self.wheel_radius_left is None:
            put("wheel_radius_left", self.wheel_radius)
        for name, (low, high) in _LIMITS.items():
            value = getattr(self, name)
            if value is None and name == "gauge":
                continue
            if not isinstance(value, (int, float)) or not low <= value <= high:
                raise ContactError(f"{name} is {value!r} m; it must be from {low} to {high} m")
        if self.inclination is not None and not (isinstance(self.inclination, (int, float)) and abs(self.inclination) <= 0.2):
            raise ContactError(f"inclination is {self.inclination!r}; it must be a slope such as 1/40, at most 1/5")

    @property
    def tape_circle_spacing(self):
        """Distance of the tape circles, m."""
        return self.flange_back_distance + 2.0 * self.tape_circle_offset

    @property
    def mean_radius(self):
        """Mean of the two wheels' radii, m."""
        return 0.5 * (self.wheel_radius + self.wheel_radius_left)

    @property
    def symmetric(self):
        """True where left and right are the same."""
        return self.wheel is self.wheel_left and self.rail is self.rail_left and self.wheel_radius == self.wheel_radius_left

    @cached_property
    def sides(self):
        """Left and right as `railsym.contact_geometry.Side`."""
        return tuple(Side(name, wheel, *self._laid(rail), radius)
                     for name, wheel, rail, radius in (("left", self.wheel_left, self.rail_left, self.wheel_radius_left),
                                                       ("right", self.wheel, self.rail, self.wheel_radius)))

    def _laid(self, rail):
        """The rail as it lies, the lateral place of the tape circle and of the rail's axis from the track's centre."""
        tape_circle = 0.5 * self.tape_circle_spacing
        inclination = self.inclination
        if rail.inclined:
            if inclination:
                raise ContactError(f"rail {rail.name!r} is given as it lies: leave inclination out (asked: {inclination:.4g})")
            laid = rail
        else:
            # the head leans towards the track's centre: its field side, y > 0, goes up
            laid = rail.rotated(-np.arctan(1.0 / 40.0 if inclination is None else inclination))
        if self.gauge is None:
            if not rail.inclined:
                raise ContactError(f"rail {rail.name!r} needs a gauge (m): only a rail given as it lies has its place by itself")
            return laid, tape_circle, tape_circle
        return laid, tape_circle, 0.5 * self.gauge - inner_side(laid)

    @property
    def track_gauge(self):
        """Gauge of the rails as they lie, m."""
        (_, _, left), (_, _, right) = (self._laid(rail) for rail in (self.rail_left, self.rail))
        return left + inner_side(self._laid(self.rail_left)[0]) + right + inner_side(self._laid(self.rail)[0])

    def contact(self, y, with_roll=True, *, roll=None, yaw=0.0):
        """Rigid contact at lateral shifts.

        Parameters
        ----------
        y : array_like, shape (n,)
            Lateral shift of the wheelset, m, positive to the right.
        with_roll : bool
            Both wheels touch; otherwise each wheel is lowered onto its rail by itself, as in EN 15302.
        roll : array_like, shape (n,) or float, optional
            Roll that the wheelset has, rad, right side down positive; each wheel is then lowered by itself.
        yaw : float
            rad, nose to the right positive.

        Returns
        -------
        railsym.contact_geometry.RigidContact

        Raises
        ------
        ContactError
            Where a wheel is off its rail, or a number makes no sense.
        """
        return rigid_contact(*self.sides, y, with_roll, roll=roll, yaw=yaw)

    def table(self, *, young_modulus=2.1e11, poisson_ratio=0.28, deepest=3e-4, reach=15e-3):
        """Table of the elastic contact of both wheels.

        Parameters
        ----------
        young_modulus, poisson_ratio : float
            Of wheel and rail, N/m^2 and -; steel.
        deepest : float
            Largest normal penetration that the table covers, m (0.3 mm: some 400 kN).
        reach : float
            Largest lateral shift, m, if the wheels are on the rails so far.

        Returns
        -------
        railsym.contact_table.ContactTable
            Kept: the same call returns the same table.

        Raises
        ------
        ContactError
            For numbers that make no sense, wheels that are not on their rails, or profiles too rough for elastic contact.
        """
        key = ("table", young_modulus, poisson_ratio, deepest, reach)
        if key not in self._kept:
            from railsym.contact_table_build import build

            self._kept[key] = build(self, young_modulus, poisson_ratio, deepest, reach)
        return self._kept[key]

    def equivalent_conicity(self, amplitude=3e-3, with_roll=False, load=None):
        """Equivalent conicity after EN 15302:2021; see `railsym.conicity.equivalent_conicity`."""
        from railsym.conicity import equivalent_conicity

        return equivalent_conicity(self, amplitude, with_roll=with_roll, load=load)

    def linear_contact(self, amplitude=3e-3, load=None, **more):
        """`LinearContact` with conicity, contact-angle and roll parameter, and radii of this pair at an amplitude.

        Parameters
        ----------
        amplitude : float
            Of the lateral motion, m; also that of the quasi-linear creep forces.
        load : float, optional
            Vertical load of each wheel, N: parameters of elastic contact; without it contact is rigid.
        **more
            Other fields of `LinearContact`, such as friction; they win.

        Returns
        -------
        railsym.contact.LinearContact
        """
        from railsym.conicity import linear_contact

        return linear_contact(self, amplitude, load, **more)


def inner_side(rail):
    """Lateral place (m) of a laid rail's inner side: the least y within 14 mm below its top.

    Raises
    ------
    ContactError
        If the profile does not reach so far down on its inner side.
    """
    top = int(rail.z.argmin())
    z, y = rail.z[top::-1] - rail.z[top], rail.y[top::-1]
    if not z.max() >= GAUGE_HEIGHT:
        raise ContactError(f"rail {rail.name!r}: its inner side reaches {1e3 * z.max():.2f} mm below the top, and gauge is measured 14 mm below it; "
                           "the profile is too short")
    below = int((z >= GAUGE_HEIGHT).argmax())
    at = np.interp(GAUGE_HEIGHT, z[below - 1:below + 1], y[below - 1:below + 1])
    return float(min(at, y[:below].min()))
