# SPDX-License-Identifier: BSD-3-Clause
"""Sections that a track is made of: straights, curves, transitions; gradients and vertical curves."""

from dataclasses import dataclass

import numpy as np

from railsym.errors import TrackError
from railsym.track.shapes import check_kind

RAIL_SPACING = 1.5        # m, between the tape circles or the rails' axes: cant = RAIL_SPACING sin(cant angle)
MAX_CANT = 0.3            # m, more is a mistake of unit; 0.18 m is the most that is built
MAX_GRADIENT = 0.3        # -, likewise
MIN_RADIUS = 10.0         # m, likewise

DIRECTIONS = {"right": 1.0, "left": -1.0}


def number(value, what, unit, low=-np.inf, high=np.inf, above=None):
    """A finite number within limits, as float.

    Raises
    ------
    TrackError
    """
    try:
        given = float(value)
    except (TypeError, ValueError):
        raise TrackError(f"{what} = {value!r} is not a number; a number in {unit} is needed") from None
    if not np.isfinite(given):
        raise TrackError(f"{what} = {given} {unit} is not finite; a number in {unit} is needed")
    if above is not None and not given > above:
        raise TrackError(f"{what} = {given:g} {unit}: a number above {above:g} {unit} is needed")
    if not low <= given <= high:
        raise TrackError(f"{what} = {given:g} {unit} is outside {low:g} to {high:g} {unit}; are the units right?")
    return given


def choice(value, allowed, what):
    """One of some texts.

    Raises
    ------
    TrackError
    """
    from railsym.vehicle_checks import unknown

    if value not in allowed:
        raise TrackError(f"{what} {value!r} is {unknown(value, allowed)}")
    return value


def _set(section, **values):
    for name, value in values.items():
        object.__setattr__(section, name, value)


@dataclass(frozen=True)
class Straight:
    """Straight track.

    Parameters
    ----------
    length : float
        m
    cant : float
        m, positive when the left rail is higher.
    """

    length: float
    cant: float = 0.0

    def __post_init__(self):
        _set(self, length=number(self.length, "straight: length", "m", above=0.0),
             cant=number(self.cant, "straight: cant", "m", -MAX_CANT, MAX_CANT))

    curvature = 0.0

    @property
    def raised(self):
        """Cant in the track's sign (left rail higher), m."""
        return self.cant


@dataclass(frozen=True)
class Curve:
    """Circular curve.

    Parameters
    ----------
    radius : float
        m, above 0; ``direction`` says to which side.
    length : float
        m, along the track.
    cant : float
        m, of the outer rail over the inner one, for either direction.
    direction : {"right", "left"}
    """

    radius: float
    length: float
    cant: float = 0.0
    direction: str = "right"

    def __post_init__(self):
        radius = number(self.radius, "curve: radius", "m")
        if radius <= 0.0:
            raise TrackError(f'curve: radius = {radius:g} m: a radius is positive; for a curve to the left say direction="left"')
        _set(self, radius=number(radius, "curve: radius", "m", MIN_RADIUS), length=number(self.length, "curve: length", "m", above=0.0),
             cant=number(self.cant, "curve: cant", "m", -MAX_CANT, MAX_CANT), direction=choice(self.direction, DIRECTIONS, "curve: direction"))

    @property
    def curvature(self):
        """1/m, positive to the right."""
        return DIRECTIONS[self.direction] / self.radius

    @property
    def raised(self):
        """Cant in the track's sign (left rail higher), m."""
        return DIRECTIONS[self.direction] * self.cant


@dataclass(frozen=True)
class Transition:
    """Curvature and cant that lead from the section before to the section behind.

    Parameters
    ----------
    length : float
        m
    kind : {"clothoid", "bloss", "cosine", "sine", "helmert"}
        How the curvature grows.
    cant_kind : str, optional
        How the cant grows; as the curvature without it.
    end_radius, end_direction, end_cant : optional
        What it leads to, where no straight or curve follows: m (inf for a straight), "right" or "left", m (of the outer rail;
        for a straight of the left one).
    """

    length: float
    kind: str = "clothoid"
    cant_kind: str | None = None
    end_radius: float | None = None
    end_direction: str = "right"
    end_cant: float = 0.0

    def __post_init__(self):
        check_kind(self.kind, "transition: kind")
        if self.cant_kind is not None:
            check_kind(self.cant_kind, "transition: cant_kind")
        _set(self, length=number(self.length, "transition: length", "m", above=0.0))
        if self.end_radius is not None:
            self.end()

    def end(self):
        """Section of no matter what length that it leads to, if it says so itself."""
        if self.end_radius is None:
            return None
        if self.end_radius == np.inf:
            return Straight(1.0, cant=self.end_cant)
        return Curve(self.end_radius, 1.0, cant=self.end_cant, direction=self.end_direction)


@dataclass(frozen=True)
class Gradient:
    """Stretch of constant gradient.

    Parameters
    ----------
    length : float
        m, along the track.
    gradient : float
        Rise over horizontal run, positive uphill: 0.01 is 10 per mille.
    """

    length: float
    gradient: float = 0.0

    def __post_init__(self):
        _set(self, length=number(self.length, "gradient: length", "m", above=0.0),
             gradient=number(self.gradient, "gradient: gradient", "m/m", -MAX_GRADIENT, MAX_GRADIENT))

    @property
    def sine(self):
        """Sine of the slope."""
        return self.gradient / np.hypot(1.0, self.gradient)


@dataclass(frozen=True)
class VerticalCurve:
    """Between two gradients: the sine of the slope changes evenly along the track (a parabola of height over arc length).

    Parameters
    ----------
    radius : float, optional
        m: d2(height)/ds2 = 1/radius. Give this or the length.
    length : float, optional
        m
    """

    radius: float | None = None
    length: float | None = None

    def __post_init__(self):
        if (self.radius is None) == (self.length is None):
            raise TrackError("vertical curve: give either radius (m) or length (m)")
        name = "radius" if self.length is None else "length"
        _set(self, **{name: number(getattr(self, name), f"vertical curve: {name}", "m", above=0.0)})

    def between(self, before, after):
        """Its length (m) between two gradients.

        Raises
        ------
        TrackError
            For a radius between equal gradients.
        """
        if self.length is not None:
            return self.length
        if before.sine == after.sine:
            raise TrackError(f"vertical curve: radius = {self.radius:g} m between two equal gradients ({before.gradient:g}) has no length; leave it out")
        return self.radius * abs(after.sine - before.sine)
