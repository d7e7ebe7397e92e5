# SPDX-License-Identifier: BSD-3-Clause
"""A study as data: a vehicle, an analysis, factors, a plan, what to keep."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import Path

import numpy as np

from railsym.sweep.analysis import Analysis, files_of
from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.factors import List
from railsym.sweep.plans import MOST, Plan
from railsym.sweep.space import CONFIGURATION, Space, parameter_unit
from railsym.units import UnitError, to_si
from railsym.vehicle import SHIPPED, load_vehicle, vehicles
from railsym.vehicle_parts import Quantity

_BLOCK = 8192          # cases made at once


class Study:
    """Many runs of one analysis over changes of a vehicle.

    Parameters
    ----------
    vehicle : str or path
        A vehicle that comes along, or a vehicle file.
    analysis : Analysis
        Such as `railsym.sweep.CriticalSpeed`.
    factors : dict of str to Factor
        By dotted name: a parameter of the vehicle, an input of the analysis (``"contact.conicity"``, ``"speed"``, ``"track.radius"``),
        or ``"configuration"`` with a `List` of names. A plain list of values is a `List`.
    plan : Plan
        `FullGrid`, `OneAtATime`, `LatinHypercube`, `Sobol`, or `Table`; an array is a `Table`.
    configuration : str, optional
        Of the vehicle.
    set : dict of str to float or str, optional
        Parameters and inputs that all cases have, SI; a factor of the same name goes before.
    keep : sequence of str, optional
        Outputs of the analysis to keep, names or patterns (``"*_hz"``); all without it.
    seed : int
        Of plans that draw.

    Attributes
    ----------
    names, units : tuple of str, (k,)
        Of the factors; units are SI.
    outputs : dict of str to Output
        What is kept of a case.
    hash : str
        Of everything that the results depend on but the version of railsym, the content of the vehicle file included.

    Raises
    ------
    SweepError, VehicleFileError
        What does not exist or fit, before anything runs.
    """

    def __init__(self, vehicle, analysis, factors, plan, *, configuration=None, set=None, keep=None, seed=0):
        if not isinstance(analysis, Analysis):
            raise SweepError(f"analysis is {analysis!r}; one such as railsym.sweep.CriticalSpeed() is needed")
        self.vehicle, self.analysis, self.configuration = str(vehicle), analysis, configuration
        self.set, self.keep, self.seed = dict(set or {}), None if keep is None else tuple(keep), _seed(seed)
        self.factors = {name: List(f) if isinstance(f, (list, tuple, np.ndarray)) else f for name, f in factors.items()}
        self.plan = plan if isinstance(plan, Plan) else _table(plan)
        self.loaded = load_vehicle(vehicle)
        self._check_factors()
        inputs = analysis.inputs(self._configured(self.configuration))
        self.set = {name: _si(self.loaded, inputs, name, value) for name, value in self.set.items()}
        self.settings = {name: value for name, value in self.set.items() if name in inputs}
        self.inputs = inputs | {name: replace(inputs[name], nominal=value) for name, value in self.settings.items()}
        self.space = Space(self.base(), self.inputs, self.factors)
        self.factors = {name: _with_unit(f, unit) for (name, f), unit in zip(self.factors.items(), self.space.units)}
        self.outputs = self._kept(analysis.outputs(self.base()))
        self.size = self._size()

    # --- what it is made of --------------------------------------------------------------------------------------------

    @property
    def names(self):
        return self.space.names

    @property
    def units(self):
        return self.space.units

    def __len__(self):
        return self.size

    def __repr__(self):
        where = f" {self.configuration}" if self.configuration else ""
        return f"<Study of {self.loaded.name}{where}: {self.analysis.kind}, {self.size} cases by {self.plan.kind} over {', '.join(self.names)}>"

    def base(self, configuration=None):
        """The vehicle that cases depart from: configured (as `configuration` or the study says), with what the study sets."""
        vehicle = self._configured(configuration or self.configuration)
        changes = {name: value for name, value in self.set.items() if name not in self.inputs}
        return vehicle.replace(changes) if changes else vehicle

    def _configured(self, name):
        return self.loaded.configured(name) if name else self.loaded

    def _check_factors(self):
        if not self.factors:
            raise SweepError("a study needs at least one factor: factors={'contact.conicity': railsym.sweep.Grid(0.05, 0.4, 8)}")
        if CONFIGURATION in self.factors and not isinstance(self.factors[CONFIGURATION], List):
            raise SweepError(f"factor {CONFIGURATION!r} needs railsym.sweep.List of names: {', '.join(self.loaded.configurations)}")
        names = self.factors[CONFIGURATION].labels() or () if CONFIGURATION in self.factors else ()
        if self.configuration is None and names:
            self.configuration = names[0]
        for name in (*names, *((self.configuration,) if self.configuration else ())):
            self.loaded.configured(name)       # raises where there is none

    def _kept(self, outputs):
        clash = [name for name in outputs if name in self.factors]
        if clash:
            raise SweepError(f"factor {clash[0]!r} has the name of an output of {self.analysis.kind!r}")
        if self.keep is None:
            return outputs
        for pattern in self.keep:
            if not any(fnmatchcase(name, pattern) for name in outputs):
                raise SweepError(f"keep: {pattern!r} is {unknown(pattern, outputs, 'outputs')}")
        return {name: out for name, out in outputs.items() if any(fnmatchcase(name, pattern) for pattern in self.keep)}

    def _size(self):
        size = self.plan.size(self.space)
        if not 1 <= size <= MOST:
            raise SweepError(f"plan {self.plan!r} has {size} cases; at most {MOST} are allowed")
        return size

    # --- its cases -----------------------------------------------------------------------------------------------------

    def rows(self, start=0, stop=None):
        """Values of the factors of some cases, (m, k), SI (texts by their place in the list)."""
        stop = self.size if stop is None else min(stop, self.size)
        parts = [self.plan.rows(self.space, a, min(a + _BLOCK, stop), self.seed) for a in range(start, stop, _BLOCK)]
        return np.concatenate(parts) if parts else np.empty((0, len(self.names)))

    def case(self, number):
        """The `Case` of a number: ``.vehicle``, ``.changes``, ``.settings``."""
        from railsym.sweep.worker import Cases

        if not 0 <= number < self.size:
            raise SweepError(f"case {number}: there are {self.size}, counted from 0")
        return Cases.of(self).case(self.rows(number, number + 1)[0])

    # --- as data -------------------------------------------------------------------------------------------------------

    def document(self):
        """The study as plain data, in the form of its file."""
        from railsym.sweep.study_file import document

        return document(self)

    @cached_property
    def hash(self):
        content = self.document() | {"vehicle_file": _digest(self.path.read_bytes())}
        files = files_of(self.analysis)
        if files:
            content["analysis"] = {**content["analysis"], **{name: _digest(file.read_bytes()) for name, file in files.items()}}
        if self.plan.kind == "table":
            content["plan"] = {"kind": "table", "rows": _digest(np.ascontiguousarray(self.rows(), dtype=">f8").tobytes())}
        del content["study"]["vehicle"]
        return _digest(json.dumps(content, sort_keys=True).encode())

    @property
    def path(self):
        """File of the vehicle."""
        return SHIPPED / f"{self.vehicle}.toml" if self.vehicle in vehicles() else Path(self.vehicle)

    def save(self, path):
        """Write the study as TOML; `load` reads it.

        Raises
        ------
        SweepError
        """
        from railsym.sweep.study_file import save

        save(self, path)

    @classmethod
    def load(cls, path):
        """A study from its TOML file (docs/studies_sweep.md describes the format).

        Raises
        ------
        SweepError, VehicleFileError
            Naming the file, the key, and what is allowed.
        """
        from railsym.sweep.study_file import load

        return load(path)

    # --- running -------------------------------------------------------------------------------------------------------

    def run(self, path, *, workers=1, executor=None, progress=False, retry_failed=False):
        """Compute every case that the store does not hold yet; see `railsym.sweep.run`."""
        from railsym.sweep.run import run

        return run(self, path, workers=workers, executor=executor, progress=progress, retry_failed=retry_failed)


def _digest(data):
    return hashlib.sha256(data).hexdigest()


def _si(vehicle, inputs, name, value):
    """What is set, in SI: float or array, or the name of a curve."""
    if isinstance(value, str) and name not in inputs:
        return value
    number, unit = (value.value, value.unit) if isinstance(value, Quantity) else (value, None)
    shown = repr(value) if unit is None else f"[{number!r}, {unit!r}]"
    try:
        number = np.asarray(number, dtype=float)
        if unit is not None:
            number = np.asarray(to_si(number, unit, inputs[name].unit if name in inputs else parameter_unit(vehicle, name)))
    except SweepError:
        raise
    except (UnitError, TypeError, ValueError) as error:
        raise SweepError(f"set {name!r} = {shown}: a finite number is needed ({error})") from None
    if not np.isfinite(number).all() or (name in inputs and number.ndim):
        raise SweepError(f"set {name!r} = {shown}: a finite number is needed")
    return float(number) if number.ndim == 0 else number


def _with_unit(factor, unit):
    """The factor with its unit written down: SI where none was given."""
    return factor if factor.unit or factor.labels() else replace(factor, unit=unit)


def _seed(seed):
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise SweepError(f"seed = {seed!r}: a whole number from 0 is needed")
    return int(seed)


def _table(plan):
    from railsym.sweep.plans import Table

    if isinstance(plan, (list, tuple, np.ndarray)):
        return Table(plan)
    raise SweepError(f"plan is {plan!r}; railsym.sweep.FullGrid(), OneAtATime(), LatinHypercube(n), Sobol(n), or an array is needed")
