# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of a vehicle against equivalent conicity."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from railsym.errors import ModelError
from railsym.progress import followed
from railsym.stability import FREQUENCY_BAND, CriticalCrossing, Stability, stability
from railsym.verification import verify_stability

CRITERIA = ("real_part", "damping_ratio")
UNITS = {"conicity": "-", "amplitude": "m", "speed": "m/s", "frequency_hz": "Hz", "damping_ratio": "-"}
SPEED_RANGE = (5.0, 250.0)


@dataclass(frozen=True, eq=False)
class CriticalSpeeds:
    """Critical speed against conicity by one criterion.

    Attributes
    ----------
    conicity : ndarray
        As asked for; the arrays below have its shape.
    speed, frequency_hz : masked array
        The lowest speed at which the vehicle becomes unstable (m/s), and the frequency there (Hz). Masked where it does not
        become unstable within `speed_range`, or is unstable already at its lower end; `message` says which.
    label : ndarray of str
        What moves.
    crossings : tuple of tuples of CriticalCrossing
        Conicity by conicity, where the vehicle becomes unstable (direction +1) or stable again (-1), in the order of speed.
    message : tuple of str
        Conicity by conicity, what was found.
    damping_ratio : float
        The criterion: 0 for real part = 0.
    speed_range : (float, float)
        m/s.
    vehicle : Vehicle
    amplitude : ndarray, optional
        m, where each conicity is that of a pair of profiles at an amplitude; its shape is that of `conicity`.
    pair : str
        The pair, for headings.
    """

    conicity: np.ndarray
    speed: np.ma.MaskedArray
    frequency_hz: np.ma.MaskedArray
    label: np.ndarray
    crossings: tuple[tuple[CriticalCrossing, ...], ...]
    message: tuple[str, ...]
    damping_ratio: float
    speed_range: tuple[float, float]
    vehicle: Any = field(repr=False)
    amplitude: np.ndarray | None = None
    pair: str = ""
    units = UNITS

    @property
    def criterion(self) -> str:
        """"real_part" or "damping_ratio"."""
        return CRITERIA[self.damping_ratio > 0.0]

    def plot(self, **options):
        """Draw the critical speed against conicity; options and axes as `railsym.plots.plot_critical_speed`."""
        from railsym.plots import plot_critical_speed
        return plot_critical_speed(self, **options)


def critical_speed(vehicle, conicity=None, criterion: str | None = None, damping_ratio: float | None = None,
                   speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND, all_modes: bool = False,
                   verify: bool = False, progress: bool = False) -> CriticalSpeeds:
    """Critical speed of a vehicle on straight track.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    conicity : float or array_like, optional
        Equivalent conicities; that of `contact` when not given.
    criterion : {"real_part", "damping_ratio"}, optional
        "real_part" (the default without `damping_ratio`): a mode's real part rises through 0. "damping_ratio": the damping
        ratio of a lateral mode within `frequency_band` falls below `damping_ratio`.
    damping_ratio : float, optional
        0.05 is 5 %; given alone it selects its criterion.
    speed_range : (float, float)
        m/s.
    contact : LinearContact, optional
        Its conicity is replaced; what it leaves open comes from the vehicle file.
    frequency_band : (float, float)
        Hz, of the lateral motions that count for the damping ratio.
    all_modes : bool
        Also list modes that become unstable while others already are.
    verify : bool
        Check against the dense eigenvalues of the whole model between the crossings found.
    progress : bool
        Show progress.

    Returns
    -------
    CriticalSpeeds

    Raises
    ------
    ModelError
        A criterion, range or vehicle that cannot be used.
    ConvergenceError
        With `verify`: crossings and dense eigenvalues disagree.

    Examples
    --------
    >>> import railsym as rs
    >>> vehicle = rs.load_vehicle("bogie")
    >>> found = rs.critical_speed(vehicle, conicity=[0.1, 0.3])
    >>> bool(found.speed[0] > found.speed[1])
    True
    """
    ratio = damping_ratio_of(criterion, damping_ratio)
    contact = contact_or_default(contact)
    wanted = np.asarray(contact.conicity if conicity is None else conicity, dtype=float)
    found = []
    for model in followed(linear_models(vehicle, contact, wanted.ravel()), wanted.size, "critical speed", progress):
        result, = stability(model, (ratio,), speed_range, frequency_band, all_modes)
        found.append(verify_stability(model, result, speed_range) if verify else result)
    return collected(vehicle, wanted, found, ratio, speed_range)


def collected(vehicle, conicity, found: list[Stability], damping_ratio, speed_range) -> CriticalSpeeds:
    """Results by conicity as arrays."""
    return CriticalSpeeds(conicity, masked([r.speed for r in found], conicity.shape),
                          masked([r.frequency_hz for r in found], conicity.shape),
                          np.array([r.label for r in found], dtype=object).reshape(conicity.shape),
                          tuple(r.crossings for r in found), tuple(r.message for r in found), damping_ratio,
                          (float(speed_range[0]), float(speed_range[1])), vehicle)


def masked(values, shape):
    """Floats with None masked."""
    missing = [value is None for value in values]
    numbers = [0.0 if value is None else value for value in values]
    return np.ma.masked_array(numbers, missing, dtype=float, fill_value=np.nan).reshape(shape)


def damping_ratio_of(criterion, damping_ratio=None) -> float:
    """The damping ratio that a criterion stands for; 0 for the real part.

    Parameters
    ----------
    criterion : {"real_part", "damping_ratio"}, float or None
        A number is the damping ratio itself.
    damping_ratio : float, optional
    """
    if isinstance(criterion, (int, float)):
        return float(criterion)
    if criterion is None:
        criterion = "real_part" if damping_ratio is None else "damping_ratio"
    if criterion not in CRITERIA:
        raise ModelError(f"criterion {criterion!r} is unknown; there are {' and '.join(map(repr, CRITERIA))}")
    if criterion == "real_part":
        if damping_ratio:
            raise ModelError(f"criterion 'real_part' takes no damping_ratio, but {damping_ratio} was given; use 'damping_ratio'")
        return 0.0
    return 0.05 if damping_ratio is None else float(damping_ratio)


def contact_or_default(contact):
    """A LinearContact."""
    from railsym.contact import LinearContact
    return LinearContact() if contact is None else contact


def linear_models(vehicle, contact, conicities):
    """Linear models of one vehicle for several conicities, one after another."""
    from railsym.linear import linear_model

    for conicity in conicities:
        yield linear_model(vehicle, replace(contact, conicity=float(conicity)))
