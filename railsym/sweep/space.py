# SPDX-License-Identifier: BSD-3-Clause
"""Factors bound to a vehicle and an analysis: names that exist, values in SI."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.factors import PERCENT, Factor
from railsym.units import UnitError, to_si
from railsym.vehicle_layout import field_of

CONFIGURATION = "configuration"


@dataclass(frozen=True)
class Input:
    """Something besides the vehicle's parameters that a study may set: of the contact, the track, the run.

    Attributes
    ----------
    unit : str
        SI.
    nominal : float or None
        What the analysis takes when nothing is set.
    """

    unit: str
    nominal: float | None = None


class Space:
    """The factors of a study.

    Parameters
    ----------
    vehicle : Vehicle
        Configured, with what the study sets.
    inputs : dict of str to Input
        Of the analysis.
    factors : dict of str to Factor

    Attributes
    ----------
    names, units : tuple of str, (k,)
    nominal : ndarray (k,)
        The vehicle's or the analysis' own values, SI; the median of a factor that has none.

    Raises
    ------
    SweepError
        A name that does not exist, or a unit that does not fit it.
    """

    def __init__(self, vehicle, inputs, factors):
        self.names, self.factors = tuple(factors), tuple(factors.values())
        for name, factor in factors.items():
            if not isinstance(factor, Factor):
                raise SweepError(f"factor {name!r} is {factor!r}; railsym.sweep.Grid, List, Uniform, Triangular, Normal or LogNormal is needed")
        targets = [target(name, vehicle, inputs, factor.labels() is not None) for name, factor in factors.items()]
        self.units = tuple(t.unit for t in targets)
        self._own = [_place(factor, vehicle) if factor.labels() else t.nominal for factor, t in zip(self.factors, targets)]
        for k in range(len(self.names)):
            self.converted(k, np.ones(1))
        self.nominal = np.array([self.quantile(k, 0.5) if own is None else own for k, own in enumerate(self._own)], dtype=float)

    def converted(self, k, values):
        """Values of factor k in its unit as SI."""
        unit, name = self.factors[k].unit, self.names[k]
        if unit == PERCENT:
            if self._own[k] is None:
                raise SweepError(f"factor {name!r} is in %, but neither vehicle nor analysis has a value of its own; give it in {self.units[k]}")
            return np.asarray(values) / 100.0 * self._own[k]
        try:
            return np.asarray(to_si(values, unit, self.units[k])) if unit else np.asarray(values)
        except UnitError as error:
            raise SweepError(f"factor {name!r}: {error}") from None

    def quantile(self, k, u):
        """Values of factor k at probabilities u, SI."""
        return self.converted(k, self.factors[k].quantile(u))

    def levels(self, count):
        """Values of every factor for a grid, SI; `count` of a distribution."""
        return [self.converted(k, factor.levels(count)) for k, factor in enumerate(self.factors)]

    def labels(self, k):
        """Texts that the values of factor k stand for, or None."""
        return self.factors[k].labels()


def _place(factor, vehicle):
    """Place of the vehicle's configuration in a list of them, else the first text."""
    labels = factor.labels()
    return float(labels.index(vehicle.configuration)) if vehicle.configuration in labels else 0.0


def target(name, vehicle, inputs, text=False):
    """What a dotted name means: an `Input` with its unit and present value.

    Raises
    ------
    SweepError
        It is neither a parameter of the vehicle nor an input of the analysis.
    """
    if text:
        return _text_target(name, vehicle)
    if name in inputs:
        return inputs[name]
    if name in vehicle.parameters:
        quantity = vehicle.parameters[name]
        if isinstance(quantity.value, np.ndarray):
            raise SweepError(f"factor {name!r} has {quantity.value.size} components; name one of them, such as {name + '.0'!r}")
        return Input(quantity.unit, float(quantity.value))
    absent = field_of(vehicle._layout, name)
    if absent is not None and not absent.shapes[0]:
        return Input(absent.unit)
    raise SweepError(f"factor {name!r} is {unknown(name, [*inputs, *vehicle.parameters.components()], 'parameters and inputs')}")


def parameter_unit(vehicle, name):
    """SI unit of a parameter of the vehicle."""
    if name in vehicle.parameters:
        return vehicle.parameters[name].unit
    absent = field_of(vehicle._layout, name)
    if absent is None:
        raise SweepError(f"parameter {name!r} is {unknown(name, vehicle.parameters, 'parameters')}")
    return absent.unit


def _text_target(name, vehicle):
    if name == CONFIGURATION or name.rpartition(".")[2].endswith("curve"):
        return Input("")
    raise SweepError(f"factor {name!r} lists texts; texts are for {CONFIGURATION!r} and for curves of elements of {vehicle.name!r}")
