# SPDX-License-Identifier: BSD-3-Clause
"""Critical speeds over configurations, criteria and conicities, and over any one or two parameters of a vehicle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from railsym.critical_speed import (SPEED_RANGE, UNITS, CriticalSpeeds, collected, contact_or_default, damping_ratio_of,
                                    linear_models, masked)
from railsym.errors import ModelError
from railsym.progress import followed
from railsym.stability import FREQUENCY_BAND, stability

CONICITY = "conicity"      # name of the contact's conicity in a parameter map


@dataclass(frozen=True, eq=False)
class StabilityMap:
    """Critical speeds of configurations by several criteria against conicity.

    Attributes
    ----------
    configurations : tuple of str
    damping_ratios : tuple of float
        The criteria; 0 is real part = 0.
    conicity : ndarray, shape (k,)
    results : tuple of tuples of CriticalSpeeds
        ``results[configuration][criterion]``.
    speeds_solved : int
        At how many speeds an eigenproblem was solved, scans and Newton steps, all in all.
    """

    configurations: tuple[str, ...]
    damping_ratios: tuple[float, ...]
    conicity: np.ndarray
    results: tuple[tuple[CriticalSpeeds, ...], ...] = field(repr=False)
    speeds_solved: int
    units = UNITS | {"change": "%"}

    @property
    def speed(self) -> np.ma.MaskedArray:
        """m/s, shape (configurations, criteria, k); masked where there is none."""
        return np.ma.stack([np.ma.stack([r.speed for r in row]) for row in self.results])

    @property
    def frequency_hz(self) -> np.ma.MaskedArray:
        """Hz, shaped as `speed`."""
        return np.ma.stack([np.ma.stack([r.frequency_hz for r in row]) for row in self.results])

    @property
    def change(self) -> np.ma.MaskedArray:
        """Change of the critical speed against the first configuration, %, shaped as `speed`."""
        speed = self.speed
        return 100.0 * (speed / speed[:1] - 1.0)

    @property
    def message(self) -> tuple[str, ...]:
        """Every case in a line."""
        return tuple(f"{name}, {'real part' if z == 0 else f'{100 * z:g} % damping'}, conicity {c:g}: {text}"
                     for name, row in zip(self.configurations, self.results) for z, r in zip(self.damping_ratios, row)
                     for c, text in zip(r.conicity, r.message))

    def of(self, configuration: str, criterion=None, damping_ratio=None) -> CriticalSpeeds:
        """The critical speeds of one configuration by one criterion.

        Raises
        ------
        ModelError
            A configuration or criterion that the map does not hold.
        """
        z = damping_ratio_of(criterion, damping_ratio)
        if configuration not in self.configurations or z not in self.damping_ratios:
            raise ModelError(f"the map holds the configurations {', '.join(self.configurations)} and the damping ratios "
                             f"{', '.join(map(str, self.damping_ratios))}; asked for {configuration!r} and {z}")
        return self.results[self.configurations.index(configuration)][self.damping_ratios.index(z)]

    def plot(self, **options):
        """Draw critical speeds by configuration; options and axes as `railsym.plots.plot_stability_map`."""
        from railsym.plots import plot_stability_map
        return plot_stability_map(self, **options)


def stability_map(vehicle, configurations=None, conicity=(0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4),
                  criteria=("real_part", 0.05, 0.1), speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND,
                  executor=None, progress: bool = False) -> StabilityMap:
    """Critical speeds of several configurations by several criteria: one scan over speed serves all criteria.

    Parameters
    ----------
    vehicle : Vehicle
        As loaded, no configuration applied.
    configurations : sequence of str, optional
        Names in the vehicle file; all of them when not given. The first is the reference of `StabilityMap.change`.
    conicity : array_like, shape (k,)
    criteria : sequence
        "real_part", "damping_ratio" (5 %), or damping ratios as numbers.
    speed_range, contact, frequency_band, progress
        As `railsym.critical_speed.critical_speed`.
    executor : concurrent.futures.Executor, optional
        Spreads the configurations; anything with its ``map``.

    Returns
    -------
    StabilityMap

    Raises
    ------
    VehicleFileError
        An unknown configuration.
    ModelError
        No configurations, or a criterion or range that cannot be used.
    """
    names = tuple(vehicle.configurations if configurations is None else configurations)
    if not names:
        raise ModelError(f"vehicle {vehicle.name!r} has no configurations; use critical_speed or parameter_map")
    ratios = tuple(damping_ratio_of(criterion) for criterion in criteria)
    wanted = np.atleast_1d(np.asarray(conicity, dtype=float))
    options = ratios, wanted, speed_range, contact_or_default(contact), frequency_band
    rows = (executor.map if executor is not None else map)(_Row(options), [vehicle.configured(name) for name in names])
    rows = list(followed(rows, len(names), "stability map", progress))
    return StabilityMap(names, ratios, wanted, tuple(row for row, _ in rows), sum(count for _, count in rows))


def join_amplitudes(maps, amplitude, pair):
    """Maps of one conicity each, of a pair of profiles at several amplitudes, as one map.

    Parameters
    ----------
    maps : sequence of StabilityMap
        Of the same configurations, criteria and speeds.
    amplitude : array_like, shape (k,)
        m, in the order of the maps.
    pair : str
        The pair, for headings.

    Returns
    -------
    StabilityMap
    """
    def joined(results):
        parts = {name: np.ma.concatenate([getattr(r, name) for r in results]) for name in ("speed", "frequency_hz")}
        chained = {name: tuple(item for r in results for item in getattr(r, name)) for name in ("crossings", "message")}
        return replace(results[0], conicity=np.concatenate([r.conicity for r in results]), label=np.concatenate([r.label for r in results]),
                       amplitude=np.array(amplitude, dtype=float), pair=pair, **parts, **chained)

    rows = tuple(tuple(map(joined, zip(*same))) for same in zip(*(m.results for m in maps)))
    return replace(maps[0], conicity=np.concatenate([m.conicity for m in maps]), results=rows, speeds_solved=sum(m.speeds_solved for m in maps))


@dataclass(frozen=True)
class _Row:
    """Critical speeds of one configured vehicle; a class, so that process pools can carry it."""

    options: tuple

    def __call__(self, vehicle):
        ratios, conicity, speed_range, contact, band = self.options
        found = [stability(model, ratios, speed_range, band) for model in linear_models(vehicle, contact, conicity)]
        columns = zip(*found)
        count = sum(max(r.scanned_speeds for r in case) + sum(r.newton_steps for r in case) for case in found)
        return tuple(collected(vehicle, conicity, list(c), z, speed_range) for z, c in zip(ratios, columns)), count


@dataclass(frozen=True, eq=False)
class ParameterMap:
    """Critical speeds over one or two parameters.

    Attributes
    ----------
    parameters : tuple of str
        Dotted names, or "conicity".
    values : tuple of ndarray
        Their values, SI.
    units : tuple of str
        Their units.
    speed, frequency_hz : masked array
        m/s and Hz, shape (len(values[0]),) or (len(values[0]), len(values[1])).
    label : ndarray of str
    message : ndarray of str
        What was found, case by case.
    damping_ratio : float
        The criterion; 0 is real part = 0.
    """

    parameters: tuple[str, ...]
    values: tuple[np.ndarray, ...]
    units: tuple[str, ...]
    speed: np.ma.MaskedArray
    frequency_hz: np.ma.MaskedArray
    label: np.ndarray
    message: np.ndarray
    damping_ratio: float

    def plot(self, **options):
        """Draw the map; options and axes as `railsym.plots.plot_parameter_map`."""
        from railsym.plots import plot_parameter_map
        return plot_parameter_map(self, **options)


def parameter_map(vehicle, parameters: Mapping[str, Any], conicity=None, criterion=None, damping_ratio=None,
                  speed_range=SPEED_RANGE, contact=None, frequency_band=FREQUENCY_BAND, executor=None,
                  progress: bool = False) -> ParameterMap:
    """Critical speed over a range of one parameter, or over a grid of two.

    Parameters
    ----------
    vehicle : Vehicle
        With its configuration applied.
    parameters : mapping of str to array_like
        One or two dotted names (or "conicity") with their values, SI.
    conicity : float, optional
        That of `contact` when neither given here nor as a parameter.
    criterion, damping_ratio, speed_range, contact, frequency_band, progress
        As `railsym.critical_speed.critical_speed`.
    executor : concurrent.futures.Executor, optional
        Spreads the cases; anything with its ``map``.

    Returns
    -------
    ParameterMap

    Raises
    ------
    VehicleFileError
        An unknown parameter or a value that it cannot have.
    ModelError
        Not one or two parameters.
    """
    if not 1 <= len(parameters) <= 2:
        raise ModelError(f"a parameter map takes one or two parameters, got {len(parameters)}: {', '.join(parameters)}")
    names, values = tuple(parameters), tuple(np.atleast_1d(np.asarray(v, dtype=float)) for v in parameters.values())
    ratio = damping_ratio_of(criterion, damping_ratio)
    contact = contact_or_default(contact)
    contact = contact if conicity is None else replace(contact, conicity=float(conicity))
    units = tuple("-" if name == CONICITY else vehicle.parameters[name].unit for name in names)
    case = _Case(vehicle, names, contact, (ratio, speed_range, frequency_band))
    cells = (executor.map if executor is not None else map)(case, product(*values))
    found = list(followed(cells, int(np.prod([len(v) for v in values])), "parameter map", progress))
    shape = tuple(len(v) for v in values)
    text = [np.array(items, dtype=object).reshape(shape) for items in ([r.label for r in found], [r.message for r in found])]
    return ParameterMap(names, values, units, masked([r.speed for r in found], shape),
                        masked([r.frequency_hz for r in found], shape), *text, ratio)


@dataclass(frozen=True)
class _Case:
    """Stability at one point of a parameter map."""

    vehicle: Any
    names: tuple
    contact: Any
    options: tuple

    def __call__(self, values):
        ratio, speed_range, band = self.options
        changes = dict(zip(self.names, map(float, values)))
        conicity = changes.pop(CONICITY, self.contact.conicity)
        vehicle = self.vehicle.replace(changes) if changes else self.vehicle
        model, = linear_models(vehicle, self.contact, [conicity])
        return stability(model, (ratio,), speed_range, band)[0]
