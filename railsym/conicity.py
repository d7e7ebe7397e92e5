# SPDX-License-Identifier: BSD-3-Clause
"""Equivalent conicity after EN 15302, and the other quantities of a quasi-linear contact.

A free wheelset without inertia runs along (Klingel)

    y'' + dr(y)/(e r0) = 0                                                  (1)

dr the rolling radius right minus left, e the distance of the tape circles, r0 the mean radius; ' is along the track. With
F(y) = integral of dr/(e r0), a motion between its turning points a and b, F(a) = F(b), b - a = 2A, has the wavelength

    L = 2 integral from a to b of dy / sqrt(2 (F(b) - F(y)))                (2)

and a conical wheelset of the conicity

    tan gamma_e = (pi/L)^2 2 e r0                                           (3)

has the same. dr is sampled every 0.01 mm: where the contact jumps, its width matters (wheel B of EN 15302 at 3 mm: 0.030; sampled
every 0.1 mm, as in the edition of 2008, 0.058). In (2), y = (a + b)/2 + A sin t makes the integrand smooth at the turning points.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from railsym.errors import ContactError

_STEP = 1e-5            # m, between samples of dr
_QUADRATURE = 4000      # midpoints of t
# m beyond the amplitude: where turning points of an asymmetric pair are looked for, as far as both wheels stay on their rails
_BEYOND = (8e-3, 6e-3, 4e-3, 3e-3, 2e-3, 1e-3, 5e-4, 0.0)
_PHASES = 360           # of a period, for first harmonics
_FLAT = 1e-6            # conicity taken as zero: a cylinder has rounding errors of dr


@dataclass(frozen=True, eq=False)
class Conicity:
    """Equivalent conicity over amplitudes; arrays (n,).

    Attributes
    ----------
    amplitude : ndarray
        Half the distance of the turning points, m.
    conicity : ndarray
        tan gamma_e; NaN where `message` says that there is no periodic motion.
    wavelength : ndarray
        m; infinite where dr is zero, NaN likewise.
    centre : ndarray
        Mean of the turning points, m; 0 for a symmetric pair.
    y, rolling_radius_difference : ndarray, shape (m,)
        What it was computed from, m.
    with_roll : bool
    message : str
    load : float or None
        Vertical load of each wheel in elastic contact, N; None for rigid contact.
    """

    amplitude: np.ndarray
    conicity: np.ndarray
    wavelength: np.ndarray
    centre: np.ndarray
    y: np.ndarray = field(repr=False)
    rolling_radius_difference: np.ndarray = field(repr=False)
    with_roll: bool = False
    message: str = ""
    load: float | None = None


def equivalent_conicity(pair, amplitude=3e-3, *, with_roll=False, load=None):
    """Equivalent conicity of wheel and rail profiles.

    Parameters
    ----------
    pair : ContactPair
    amplitude : float or array_like, shape (n,)
        m.
    with_roll : bool
        The wheelset rolls as both wheels touch; EN 15302 leaves it out.
    load : float, optional
        Vertical load of each wheel, N: elastic contact (`ContactPair.table`), rolling radii weighted by the loads of the patches.
        Without it contact is rigid, as in EN 15302.

    Returns
    -------
    Conicity

    Raises
    ------
    ContactError
        For an amplitude that is not positive, or beyond which a wheel is off its rail.
    """
    amplitude = _amplitudes(amplitude)
    y, difference = _difference(pair, amplitude.max(), _sampler(pair, with_roll, load))
    found = conicity_of_difference(y, difference, amplitude, pair.tape_circle_spacing, pair.mean_radius, with_roll=with_roll)
    return found if load is None else replace(found, load=float(load))


def _difference(pair, amplitude, sampled):
    """Shifts and rolling radius difference, as far as motions of the amplitude may need it."""
    if pair.symmetric:            # half of it: the difference is odd
        half = np.linspace(0.0, amplitude, int(np.ceil(amplitude / _STEP)) + 1)
        value = sampled(half)
        value[0] = 0.0
        return np.concatenate([-half[:0:-1], half]), np.concatenate([-value[:0:-1], value])
    for beyond in _BEYOND:
        reach = amplitude + beyond
        y = np.linspace(-reach, reach, 2 * int(np.ceil(reach / _STEP)) + 1)
        try:        # the ends are the worst
            sampled(y[[0, -1]])
        except ContactError:
            if not beyond:
                raise
            continue
        return y, sampled(y)
    raise AssertionError("unreachable")


def _sampler(pair, with_roll, load):
    """Rolling radius difference as a function of the shift."""
    if load is not None:
        table = pair.table()
        return lambda y: table.contact(y, load, with_roll=with_roll).rolling_radius_difference

    def rigid(y):       # in parts, for each shift looks at all of the rail
        parts = np.array_split(y, max(1, len(y) // 256))
        return np.concatenate([pair.contact(part, with_roll).rolling_radius_difference for part in parts])

    return rigid


def conicity_of_difference(y, difference, amplitude, spacing, radius, *, with_roll=False):
    """Equivalent conicity of a given rolling radius difference.

    Parameters
    ----------
    y : ndarray, shape (m,)
        Lateral shift, m, increasing.
    difference : ndarray, shape (m,)
        Rolling radius right minus left, m; between the samples straight.
    amplitude : float or array_like, shape (n,)
        m.
    spacing, radius : float
        Distance of the tape circles and mean radius, m.
    with_roll : bool
        For the record.

    Returns
    -------
    Conicity
    """
    amplitude = _amplitudes(amplitude)
    y, difference = np.asarray(y, dtype=float), np.asarray(difference, dtype=float)
    if y.ndim != 1 or y.shape != difference.shape or len(y) < 3 or not (np.diff(y) > 0.0).all():
        raise ContactError(f"y and difference have shapes {y.shape} and {difference.shape}; they must be (m,) with y increasing")
    potential = _Potential(y, difference / (spacing * radius), flat=_FLAT / (spacing * radius))      # F = tan gamma_e y^2/(e r0) for a cone
    found = [potential.motion(a) for a in amplitude]
    wavelength, centre = (np.array(column) for column in zip(*found))
    conicity = (np.pi / wavelength) ** 2 * 2.0 * spacing * radius
    lost = np.isnan(wavelength)
    message = "" if not lost.any() else ("no periodic motion at the amplitude " + ", ".join(f"{1e3 * a:g}" for a in amplitude[lost]) + " mm: "
                                         f"from y = {1e3 * y[0]:.3g} to {1e3 * y[-1]:.3g} mm the rolling radius difference does not drive the wheelset back")
    return Conicity(amplitude, conicity, wavelength, centre, y, difference, with_roll, message)


class _Potential:
    """F of equation (2) for a difference that is straight between its samples: exact, a parabola in each interval."""

    def __init__(self, y, force, flat):
        self.y, self.force, self.flat = y, force, flat
        self.slope = np.diff(force) / np.diff(y)
        value = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(y))])
        self.value = value - np.interp(0.0, y, value)

    def __call__(self, at):
        k = np.clip(np.searchsorted(self.y, at, side="right") - 1, 0, len(self.slope) - 1)
        d = at - self.y[k]
        return self.value[k] + d * (self.force[k] + 0.5 * d * self.slope[k])

    def motion(self, amplitude):
        """Wavelength and centre of the motion of an amplitude: infinite on a cylinder, NaN where there is none."""
        centre = self._centre(amplitude)
        if centre is None:
            return np.nan, np.nan
        t = np.pi * ((np.arange(_QUADRATURE) + 0.5) / _QUADRATURE - 0.5)
        top = max(self(centre - amplitude), self(centre + amplitude))
        drop = top - self(centre + amplitude * np.sin(t))
        if (np.abs(drop) < self.flat * amplitude**2).all():
            return np.inf, centre
        if not (drop > 0.0).all():
            return np.nan, np.nan
        return 2.0 * (np.pi / _QUADRATURE) * float(np.sum(amplitude * np.cos(t) / np.sqrt(2.0 * drop))), centre

    def _centre(self, amplitude):
        """Where turning points 2A apart are equally high, nearest to the track's centre."""
        unbalanced = lambda c: self(c + amplitude) - self(c - amplitude)  # noqa: E731
        room = min(self.y[-1], -self.y[0]) - amplitude
        if room < -1e-12:
            raise ContactError(f"the amplitude {1e3 * amplitude:g} mm is beyond the samples of the rolling radius difference "
                               f"({1e3 * self.y[0]:g} to {1e3 * self.y[-1]:g} mm)")
        if abs(unbalanced(0.0)) < 1e-12 * max(abs(self(amplitude)), 1e-30):
            return 0.0
        grid = np.linspace(-max(room, 0.0), max(room, 0.0), 401)
        values = np.array(unbalanced(grid))
        change = np.flatnonzero((values[:-1] <= 0.0) & (values[1:] > 0.0))
        if not len(change):
            return None
        k = change[np.abs(grid[change]).argmin()]
        low, high = grid[k], grid[k + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if unbalanced(middle) <= 0.0 else (low, middle)
        return float(0.5 * (low + high))


def _amplitudes(amplitude):
    amplitude = np.atleast_1d(np.asarray(amplitude, dtype=float))
    if amplitude.ndim != 1 or not amplitude.size or not (np.isfinite(amplitude) & (amplitude > 0.0)).all():
        raise ContactError(f"amplitude is {amplitude} m; it must be positive (for example 3e-3)")
    return amplitude


@dataclass(frozen=True)
class ContactParameters:
    """What a quasi-linear contact takes from a pair of profiles at an amplitude.

    Attributes
    ----------
    amplitude : float
        m.
    conicity : float
        After EN 15302 (without roll).
    contact_angle_parameter : float
        E: half the difference of the contact angles (right minus left) is E y/b0 in the mean square sense.
    roll_parameter : float
        sigma: roll is -sigma y/b0 likewise.
    wheel_curvature, rail_curvature : float
        1/m, mean over the motion, convex positive.
    """

    amplitude: float
    conicity: float
    contact_angle_parameter: float
    roll_parameter: float
    wheel_curvature: float
    rail_curvature: float


def contact_parameters(pair, amplitude=3e-3, load=None):
    """Equivalent conicity, contact-angle and roll parameter of a pair at an amplitude.

    Over y = A sin t the first harmonics are kept, which is the best straight line in the mean square under a sinusoidal motion:

        E = (b0/(pi A)) integral of (delta_right - delta_left)/2 sin t dt      sigma = -(b0/(pi A)) integral of phi sin t dt

    over one period, with both wheels in contact.

    Parameters
    ----------
    pair : ContactPair
    amplitude : float
        m.
    load : float, optional
        Vertical load of each wheel, N: elastic contact. The curvature is then that of the Hertzian ellipse with the mean a/b of the
        patches, all of it given to the wheel.

    Returns
    -------
    ContactParameters

    Raises
    ------
    ContactError
        Where the pair has no periodic motion at this amplitude.
    """
    found = equivalent_conicity(pair, float(amplitude), load=load)
    if found.message:
        raise ContactError(found.message)
    return harmonic_parameters(pair, float(amplitude), float(found.conicity[0]), float(found.centre[0]), load)


def harmonic_parameters(pair, amplitude, conicity, centre=0.0, load=None):
    """`contact_parameters` for a conicity and centre of the motion that are known.

    Returns
    -------
    ContactParameters
    """
    t = 2.0 * np.pi * (np.arange(_PHASES) + 0.5) / _PHASES
    y = centre + amplitude * np.sin(t)
    half_spacing = 0.5 * pair.tape_circle_spacing

    def harmonic(value):
        return 2.0 * half_spacing / amplitude * float(np.mean(value * np.sin(t)))

    if load is None:
        contact = pair.contact(y)
        left, right = contact.left.contact_angle, contact.right.contact_angle
        curvature = (0.5 * float(np.mean(getattr(contact.left, name) + getattr(contact.right, name))) for name in ("wheel_curvature", "rail_curvature"))
    else:
        contact = pair.table().contact(y, load, with_roll=True)
        left, right = (side.mean("angle") for side in (contact.left, contact.right))
        curvature = _curvature(contact, pair.mean_radius), 0.0
    return ContactParameters(amplitude, conicity, harmonic(0.5 * (right - left)), -harmonic(contact.roll), *curvature)


def _curvature(contact, radius):
    """Relative curvature across the track (1/m) of the Hertzian ellipse whose ln(a/b) is the mean of the patches'.

    B/A = R_D(0, a^2, b^2)/R_D(0, b^2, a^2) with A = 1/(2 radius) (railsym/hertz.py).
    """
    from scipy.special import elliprd

    logs = [np.log(side.mean("a") / side.mean("b")) for side in (contact.left, contact.right)]
    square = np.exp(2.0 * np.mean(logs))
    return float(elliprd(0.0, square, 1.0) / elliprd(0.0, 1.0, square)) / radius


def linear_contact(pair, amplitude=3e-3, load=None, **more):
    """`LinearContact` of a pair at an amplitude; see `ContactPair.linear_contact`."""
    from railsym.contact import LinearContact

    found = contact_parameters(pair, amplitude, load)
    if not found.wheel_curvature + found.rail_curvature > 0.0 and not {"wheel_transverse_radius", "rail_transverse_radius"} <= set(more):
        raise ContactError(f"the mean curvatures {found.wheel_curvature:.4g} and {found.rail_curvature:.4g} 1/m of wheel and rail at an amplitude of "
                           f"{1e3 * amplitude:g} mm make no convex contact; give wheel_transverse_radius and rail_transverse_radius")
    radius = lambda curvature: 1.0 / curvature if curvature else np.inf  # noqa: E731
    values = {"conicity": found.conicity, "contact_angle_parameter": found.contact_angle_parameter, "roll_parameter": found.roll_parameter,
              "amplitude": found.amplitude, "wheel_transverse_radius": radius(found.wheel_curvature), "rail_transverse_radius": radius(found.rail_curvature)}
    return LinearContact(**{**values, **more})
