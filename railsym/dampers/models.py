# SPDX-License-Identifier: BSD-3-Clause
"""Models of a damper: viscous, and Maxwell (the viscous part in series with a stiffness)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from railsym.errors import ModelError
from railsym.force_laws import curve_slope, law_record
from railsym.vehicle_parts import Curve

KINDS = ("viscous", "maxwell")


@dataclass(frozen=True, eq=False)
class DamperModel:
    """A damper as the vehicle file has it.

    Parameters
    ----------
    kind : str
        "viscous": F = c v or F(v). "maxwell": that in series with a stiffness k or k(|v|), v the rate of the whole damper.
    damping : float, optional
        c, N s/m. Give this or ``damping_curve``.
    damping_curve : (speed, force), optional
        Arrays (n,), m/s and N: a monotone cubic, straight on beyond its ends; beginning at (0, 0) it is one half of an odd
        curve. Friction is a steep start of this curve, a blow-off valve its flat end.
    series_stiffness : float, optional
        k, N/m, of a Maxwell model. Give this or ``series_stiffness_curve``.
    series_stiffness_curve : (speed, stiffness), optional
        Arrays (n,), m/s (its magnitude) and N/m.
    origin : str
        Where the numbers come from.

    Raises
    ------
    ModelError
        Parameters missing, given twice, not positive, or curves that are no monotone tables.
    """

    kind: str
    damping: float | None = None
    damping_curve: tuple | None = None
    series_stiffness: float | None = None
    series_stiffness_curve: tuple | None = None
    origin: str = ""

    def __post_init__(self):
        if self.kind not in KINDS:
            raise ModelError(f"damper kind {self.kind!r} does not exist; kinds: {', '.join(KINDS)}")
        self._check_one_of("damping", "N s/m")
        if self.kind == "maxwell":
            self._check_one_of("series_stiffness", "N/m")
        elif self.series_stiffness is not None or self.series_stiffness_curve is not None:
            raise ModelError("a viscous damper has no series stiffness; kind='maxwell' has")
        self.force_law_record()  # a table that cannot be used raises here

    def _check_one_of(self, name, unit):
        value, curve = getattr(self, name), getattr(self, f"{name}_curve")
        if (value is None) == (curve is None):
            raise ModelError(f"{self.kind} damper: give either {name} or {name}_curve")
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise ModelError(f"{self.kind} damper: {name} = {value!r} {unit} is not above 0")
        if curve is not None:
            object.__setattr__(self, f"{name}_curve", _checked_curve(curve, f"{name}_curve"))

    @cached_property
    def _record(self):
        names = {"damping": "damping", "damping_curve": "damping_curve", "series_stiffness": "series_stiffness",
                 "series_stiffness_curve": "series_stiffness_curve"}
        units = {"damping_curve": ("m/s", "N"), "series_stiffness_curve": ("m/s", "N/m")}
        parameters = {}
        for name in names:
            value = getattr(self, name)
            if value is not None:
                parameters[name] = Curve(name, *value, *units[name], self.origin) if name in units else value
        return law_record(_Element("damper" if self.kind == "viscous" else "maxwell", parameters))

    def force_law_record(self) -> dict:
        """The record for `railsym._core.Laws` that a vehicle with this element has."""
        return self._record

    def replace(self, **changes) -> DamperModel:
        """A copy with other fields."""
        return replace(self, **changes)

    def linearised(self, amplitude: float = 0.0, frequency: float | None = None):
        """Damping (N s/m) and series stiffness (N/m; inf for viscous) of the equivalent linear model.

        At amplitude 0 (m) the tangents at rest; otherwise 1/K = 1/k + 1/(i omega c) solved for the describing function K at
        that amplitude and frequency (Hz).
        """
        if amplitude:
            if frequency is None:
                raise ModelError("linearised at an amplitude: give the frequency (Hz) too")
            compliance = 1.0 / complex(self.describing_function(amplitude, frequency))
            stored = compliance.real
            return -1.0 / (2.0 * np.pi * frequency * compliance.imag), 1.0 / stored if stored > 1e-15 else np.inf
        record = self._record
        slope = curve_slope(record["damping_curve"], 0.0) if record.get("damping_curve") is not None else 0.0
        if self.kind == "viscous":
            return float(record["damping"] + slope), np.inf
        table = record.get("stiffness_curve")
        return float(record["damping"] + slope), float(record["stiffness"] + (curve_value(table, 0.0) if table is not None else 0.0))

    def dynamic_stiffness(self, frequency):
        """Complex stiffness K = i omega c k/(k + i omega c) of the model linearised at rest (N/m), at frequencies in Hz."""
        damping, stiffness = self.linearised()
        s = 2j * np.pi * np.asarray(frequency, dtype=float) * damping
        return s if np.isinf(stiffness) else s / (1.0 + s / stiffness)

    def describing_function(self, amplitude, frequency):
        """Complex stiffness (N/m) of the force's first harmonic under a sine of ``amplitude`` (m) and ``frequency`` (Hz)."""
        from railsym.dampers.bench import steady_force

        amplitude, frequency = np.broadcast_arrays(np.asarray(amplitude, dtype=float), np.asarray(frequency, dtype=float))
        found = [2.0 * np.mean(steady_force(self, a, f) * np.exp(-1j * _PHASE)) / (-1j * a)
                 for a, f in zip(amplitude.ravel(), frequency.ravel(), strict=True)]
        return np.array(found).reshape(amplitude.shape)[()]


_PHASE = 2.0 * np.pi * np.arange(512) / 512


@dataclass(frozen=True)
class _Element:
    """What `law_record` wants to know of an element."""

    type: str
    parameters: dict
    name: str = "damper"


def curve_value(table, at):
    """Value of a cubic table (breakpoints, coefficients) at ``at``, straight on beyond its ends."""
    x, c = table
    at = np.asarray(at, dtype=float)
    inside = np.clip(at, x[0], x[-1])
    piece = np.clip(np.searchsorted(x, inside, side="right") - 1, 0, len(c) - 1)
    t, c = inside - x[piece], np.moveaxis(c[piece], -1, 0)
    slope = c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])
    return c[0] + t * (c[1] + t * (c[2] + t * c[3])) + (at - inside) * slope


def _checked_curve(curve, name):
    x, y = (np.array(part, dtype=float).ravel() for part in curve)
    if x.size != y.size or x.size < 2:
        raise ModelError(f"{name}: {x.size} speeds and {y.size} values; two arrays of one length, at least 2, are needed")
    if not (np.isfinite(x).all() and np.isfinite(y).all() and (np.diff(x) > 0.0).all()):
        raise ModelError(f"{name}: speeds must be finite and strictly increasing")
    if name == "damping_curve" and (np.diff(y) < 0.0).any():
        raise ModelError(f"{name}: the force falls with speed; a damper's force does not")
    if name != "damping_curve" and ((y <= 0.0).any() or x[0] != 0.0):
        raise ModelError(f"{name}: begins at {x[0]:g} m/s with a least value of {y.min():g} N/m; begin at 0, and stay above 0")
    for part in (x, y):
        part.flags.writeable = False
    return x, y
