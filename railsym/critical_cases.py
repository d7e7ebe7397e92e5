# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds of many changed vehicles: the inside of studies.

    solver = CriticalSpeedSolver(vehicle, conicity=0.2)
    found = solver.solve({"anti_yaw_damper.damping": 3e5, "traction_rod.stiffness": 6e6})

What all cases share is worked out once. A result depends on its own case and on the vehicle that the solver was made for, never
on the cases solved before it: any order and any number of processes give the same bytes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from railsym.critical_speed import CRITERIA, SPEED_RANGE, UNITS, contact_or_default, damping_ratio_of, masked
from railsym.errors import ModelError, RailsymError
from railsym.prepared_vehicle import PreparedVehicle
from railsym.progress import followed
from railsym.stability import FREQUENCY_BAND, Stability, stability
from railsym.verification import verify_stability


class CriticalSpeedSolver:
    """The critical speed of one vehicle with any of its parameters replaced.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    conicity : float, optional
        Equivalent conicity; that of `contact` when not given.
    criterion : {"real_part", "damping_ratio"}, optional
    damping_ratio : float, optional
    speed_range : (float, float)
        m/s.
    contact : LinearContact, optional
    frequency_band : (float, float)
        Hz. These five as `railsym.critical_speed`.

    Raises
    ------
    ModelError
        A criterion, range or vehicle that cannot be used.

    Notes
    -----
    It can be pickled: a process pool sends it once a worker.

    Examples
    --------
    >>> import railsym as rs
    >>> solver = rs.CriticalSpeedSolver(rs.load_vehicle("bogie"), conicity=0.2)
    >>> bool(solver.solve({}).speed > solver.solve({}, conicity=0.3).speed)
    True
    """

    def __init__(self, vehicle, conicity: float | None = None, criterion: str | None = None, damping_ratio: float | None = None,
                 speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND):
        self.vehicle = vehicle
        self.damping_ratio = damping_ratio_of(criterion, damping_ratio)
        self.speed_range = (float(speed_range[0]), float(speed_range[1]))
        self.frequency_band = (float(frequency_band[0]), float(frequency_band[1]))
        self.contact = contact_or_default(contact)
        if conicity is not None:
            self.contact = replace(self.contact, conicity=float(conicity))

    @cached_property
    def _prepared(self):
        return PreparedVehicle(self.vehicle, self.contact)

    def __getstate__(self):
        return {name: value for name, value in vars(self).items() if name != "_prepared"}     # C memory stays in its process

    def model(self, changes: Mapping[str, Any], conicity: float | None = None, contact=None):
        """The LinearModel of a case; arguments and errors as `solve`."""
        contact = self.contact if contact is None else contact
        if conicity is not None:
            contact = replace(contact, conicity=float(conicity))
        return self._prepared.linear_model(changes, contact)

    def solve(self, changes: Mapping[str, Any], conicity: float | None = None, verify: bool = False, contact=None) -> Stability:
        """The lowest speed at which a case becomes unstable.

        Parameters
        ----------
        changes : mapping of str to number, array, Quantity or str
            By dotted name, as `Vehicle.replace`.
        conicity : float, optional
            Of this case.
        verify : bool
            Compare with the dense eigenvalues of the whole model: at the critical speed and, for the real part, at five speeds
            below it.
        contact : LinearContact, optional
            Of this case, in place of the solver's.

        Returns
        -------
        Stability
            `speed` and `frequency_hz` are None where there is no critical speed in the range; `message` says why. Its only
            crossing is the critical speed: what happens beyond is not searched.

        Raises
        ------
        VehicleFileError
            A parameter that does not exist or a value that is not permitted.
        ModelError
            A vehicle without static equilibrium.
        ConvergenceError
            With `verify`: disagreement with the dense eigenvalues.
        """
        model = self.model(changes, conicity, contact)
        result, = stability(model, (self.damping_ratio,), self.speed_range, self.frequency_band, lowest_only=True)
        return verify_stability(model, result, self.speed_range, lowest_only=True) if verify else result


@dataclass(frozen=True, eq=False)
class CriticalSpeedCases:
    """Critical speeds of n cases.

    Attributes
    ----------
    speed, frequency_hz : masked array, shape (n,)
        m/s and Hz; masked where there is no critical speed in the range or the case failed.
    label : ndarray of str, shape (n,)
        What moves.
    message : tuple of str, length n
        What was found, or the error of a case that failed.
    failed : ndarray of bool, shape (n,)
    damping_ratio : float
        The criterion: 0 for real part = 0.
    speed_range : (float, float)
        m/s.
    vehicle : Vehicle
        Before the changes.
    """

    speed: np.ma.MaskedArray
    frequency_hz: np.ma.MaskedArray
    label: np.ndarray
    message: tuple[str, ...]
    failed: np.ndarray
    damping_ratio: float
    speed_range: tuple[float, float]
    vehicle: Any = field(repr=False)
    units = UNITS

    def __len__(self):
        return len(self.message)

    @property
    def criterion(self) -> str:
        """"real_part" or "damping_ratio"."""
        return CRITERIA[self.damping_ratio > 0.0]


def critical_speeds(vehicle, cases, conicity=None, criterion: str | None = None, damping_ratio: float | None = None,
                    speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND, verify: bool = False,
                    progress: bool = False) -> CriticalSpeedCases:
    """Critical speeds of a vehicle in many cases of changed parameters.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    cases : sequence of mapping, or pair (names, values)
        Changes of each case as `Vehicle.replace`; or dotted names (k,) and their values, array (n, k), SI.
    conicity : float or array_like, shape (n,), optional
        One of each case, or one for all; that of `contact` when not given.
    criterion, damping_ratio, speed_range, contact, frequency_band, verify, progress
        As `railsym.critical_speed`.

    Returns
    -------
    CriticalSpeedCases
        A case that fails is marked there and its error told; the others go on.

    Raises
    ------
    ModelError
        Cases, criterion or range that cannot be used.

    Examples
    --------
    >>> import railsym as rs
    >>> found = rs.critical_speeds(rs.load_vehicle("bogie"), [{}, {}], conicity=[0.1, 0.3])
    >>> bool(found.speed[0] > found.speed[1])
    True
    """
    cases = _listed(cases)
    conicities = _one_each(conicity, len(cases))
    solver = CriticalSpeedSolver(vehicle, None, criterion, damping_ratio, speed_range, contact, frequency_band)
    found = [_outcome(solver, *case, verify)
             for case in followed(zip(cases, conicities, strict=True), len(cases), "critical speeds", progress)]
    return _gathered(found, solver)


def _listed(cases):
    """Cases as a list of mappings."""
    if isinstance(cases, tuple) and len(cases) == 2 and not isinstance(cases[0], Mapping):
        names, values = list(cases[0]), np.asarray(cases[1], dtype=float)
        if values.ndim != 2 or values.shape[1] != len(names):
            raise ModelError(f"cases: values of shape {values.shape} do not fit {len(names)} names; one row a case and one column a "
                             "name are needed")
        return [dict(zip(names, row, strict=True)) for row in values.tolist()]
    cases = list(cases)
    wrong = next((k for k, case in enumerate(cases) if not isinstance(case, Mapping)), None)
    if wrong is not None:
        raise ModelError(f"cases[{wrong}] = {cases[wrong]!r}: a mapping of dotted names to values is needed, or give all cases as "
                         "(names, values)")
    return cases


def _one_each(conicity, count):
    """A conicity for each case, None where the contact's own is to serve."""
    if conicity is None:
        return [None] * count
    given = np.asarray(conicity, dtype=float)
    if given.ndim and given.shape != (count,):
        raise ModelError(f"conicity has shape {given.shape}; one number, or one for each of the {count} cases is needed")
    return np.broadcast_to(given, (count,)).tolist()


def _outcome(solver, changes, conicity, verify):
    try:
        return solver.solve(changes, conicity, verify)
    except RailsymError as error:
        return error


def _gathered(found, solver):
    failed = np.array([isinstance(result, Exception) for result in found], dtype=bool)
    speed, frequency = ([None if wrong else getattr(result, name) for result, wrong in zip(found, failed)]
                        for name in ("speed", "frequency_hz"))
    shape = (len(found),)
    return CriticalSpeedCases(masked(speed, shape), masked(frequency, shape),
                              np.array(["" if wrong else r.label for r, wrong in zip(found, failed)], dtype=object),
                              tuple(str(r) if wrong else r.message for r, wrong in zip(found, failed)), failed,
                              solver.damping_ratio, solver.speed_range, solver.vehicle)
