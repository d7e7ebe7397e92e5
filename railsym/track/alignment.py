# SPDX-License-Identifier: BSD-3-Clause
"""From sections to curvature, cant and slope over arc length, with their kinks."""

from dataclasses import dataclass

import numpy as np

from railsym.errors import TrackError
from railsym.track.piecewise import PiecewisePolynomial, joined
from railsym.track.sections import MAX_CANT, RAIL_SPACING, Curve, Gradient, Straight, Transition, VerticalCurve
from railsym.track.shapes import shape

_LENGTH_TOLERANCE = 1e-6      # m, by which vertical and horizontal sections may differ in length


@dataclass(frozen=True, eq=False)
class Alignment:
    """Geometry of the track before its frames are integrated.

    Attributes
    ----------
    curvature, cant, slope : PiecewisePolynomial
        1/m (positive to the right); sine of the cant angle (left rail higher); sine of the slope (uphill). From -lead on.
    length : float
        m
    """

    curvature: PiecewisePolynomial
    cant: PiecewisePolynomial
    slope: PiecewisePolynomial
    length: float

    def parts(self):
        """Function and the orders of its derivatives that the turning and its rate hold."""
        return (self.curvature, (0, 1)), (self.cant, (0, 1, 2)), (self.slope, (0, 1, 2))

    def kinks(self):
        """Places where the turning or its rate jumps, m."""
        return np.unique(np.concatenate([function.steps(orders) for function, orders in self.parts()]))

    def jumps(self):
        """Places where the turning itself jumps, m."""
        return np.unique(np.concatenate([function.steps(orders[:-1]) for function, orders in self.parts()]))

    def rounded(self, length):
        """The same with each jump of the turning spread over ``length`` (m), by polynomials of degree 5.

        Raises
        ------
        TrackError
            If two of them would touch.
        """
        if not length:
            return self
        return Alignment(*(_rounded(function, function.steps(orders[:-1]), length, self.length) for function, orders in self.parts()), self.length)


def _rounded(function, places, length, end):
    for before, after in zip(places[:-1], places[1:], strict=True):
        if after - before < length * (1.0 - 1e-9):
            raise TrackError(f"between s = {before:.6g} m and {after:.6g} m there are {after - before:.6g} m, less than the rounding of {length:g} m at "
                             "each of these ends; make the section longer, or the rounding shorter")
    if len(places) and places[-1] + 0.5 * length > end:
        raise TrackError(f"the last section begins {end - places[-1]:.6g} m before the end of the track, at s = {places[-1]:.6g} m: less than half of "
                         f"the rounding of {length:g} m; make it longer")
    for place in places:
        function = function.replaced(place - 0.5 * length, place + 0.5 * length)
    return function


def alignment(sections, vertical, lead):
    """Alignment of sections, with ``lead`` m before them that go on as they begin.

    Raises
    ------
    TrackError
        For sections that do not fit together.
    """
    if not sections:
        raise TrackError("a track needs at least one section, such as Straight(500)")
    for part in sections:
        if not isinstance(part, (Straight, Curve, Transition)):
            raise TrackError(f"section {part!r} is none of Straight, Curve, Transition")
    curvature, cant = zip(*_horizontal(sections), strict=True)
    curvature, cant = (_with_lead(joined(parts), lead) for parts in (curvature, cant))
    length = float(curvature.joints[-1])
    _check_steps(cant, RAIL_SPACING, "cant", "put a Transition between")
    return Alignment(curvature, cant, _vertical(vertical, length, lead), length)


def _horizontal(sections):
    """Curvature and sine of the cant angle of each section."""
    start, found = 0.0, []
    for k, section in enumerate(sections):
        if isinstance(section, Transition):
            before, after = _beside(sections, k)
            kinds = section.kind, section.cant_kind or section.kind
        else:
            before = after = section
            kinds = "clothoid", "clothoid"
        values = (before.curvature, after.curvature), (before.raised / RAIL_SPACING, after.raised / RAIL_SPACING)
        found.append([shape(kind).stretched(start, section.length, *ends) for kind, ends in zip(kinds, values, strict=True)])
        start = float(found[-1][0].joints[-1])
    return found


def _beside(sections, k):
    """What the transition number k leads from and to."""
    before = sections[k - 1] if k else Straight(1.0)
    before = before.end() if isinstance(before, Transition) else before
    after = sections[k].end() or (sections[k + 1] if k + 1 < len(sections) else None)
    if after is None or isinstance(after, Transition) or before is None:
        raise TrackError(f"section {k + 1} is a transition, and {'nothing' if after is None else 'another transition'} follows: say what it leads to by "
                         "end_radius (m; inf for a straight), end_direction and end_cant (m)")
    return before, after


def _with_lead(function, lead):
    first = float(function.at(0, function.joints[0]))
    return joined([PiecewisePolynomial.of([-lead, 0.0], [[first]]), function])


def _check_steps(function, factor, what, advice):
    places = function.steps((0,))
    if len(places):
        at = np.float64(places[0])
        after = function.index(at)
        values = [factor * float(function.at(piece, at)) for piece in (after - 1, after)]
        raise TrackError(f"{what} jumps from {values[0]:g} to {values[1]:g} {'m' if what == 'cant' else 'm/m'} at s = {at:.6g} m; {advice}")


def _vertical(vertical, length, lead):
    """Sine of the slope."""
    if not vertical:
        return PiecewisePolynomial.of([-lead, length], [[0.0]])
    start, parts = 0.0, []
    for k, part in enumerate(vertical):
        before = after = part
        if isinstance(part, VerticalCurve):
            before, after = (vertical[j] if 0 <= j < len(vertical) else None for j in (k - 1, k + 1))
            if not (isinstance(before, Gradient) and isinstance(after, Gradient)):
                raise TrackError(f"vertical section {k + 1} is a curve: it must stand between two gradients")
        elif not isinstance(part, Gradient):
            raise TrackError(f"vertical section {part!r} is none of Gradient, VerticalCurve")
        run = part.between(before, after) if isinstance(part, VerticalCurve) else part.length
        parts.append(shape("clothoid").stretched(start, run, before.sine, after.sine))
        start += run
    if abs(start - length) > _LENGTH_TOLERANCE:
        raise TrackError(f"the vertical sections are {start:.9g} m long together, the track is {length:.9g} m; make them equal")
    function = joined(parts)
    function.joints[-1] = length
    _check_steps(function, 1.0, "gradient", "put a VerticalCurve between")
    return _with_lead(function, lead)


def check_limits(function, factor, limit, what, unit):
    """Refuse values beyond a limit, as measured data may hold."""
    values = factor * function(function.joints)
    worst = int(np.abs(values).argmax())
    if abs(values[worst]) > limit:
        raise TrackError(f"{what} = {values[worst]:g} {unit} at s = {function.joints[worst]:.6g} m is beyond {limit:g} {unit}; are the units right?")


def check_cant(function, name=None):
    """Refuse cant beyond what track can have."""
    check_limits(function, RAIL_SPACING, MAX_CANT, "cant" if name is None else f"{name}: cant", "m")
