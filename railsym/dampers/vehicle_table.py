# SPDX-License-Identifier: BSD-3-Clause
"""Critical speed of a vehicle with each identified damper model."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.dampers.toml_output import put_into

CONICITY = (0.1, 0.2, 0.3, 0.4)


@dataclass(frozen=True, eq=False)
class DamperSpeeds:
    """Critical speed by damper model.

    Attributes
    ----------
    vehicle, group, configuration : str
    rows : tuple of str
        "as in the file", then a row a model about rest, then rows at amplitudes of the damper.
    conicity : ndarray (c,)
    speed, frequency_hz : masked array (rows, c)
        m/s and Hz; masked where there is no critical speed in the range searched.
    """

    vehicle: str
    group: str
    configuration: str
    rows: tuple[str, ...]
    conicity: np.ndarray
    speed: np.ma.MaskedArray
    frequency_hz: np.ma.MaskedArray

    def lines(self):
        """The table as lines of text."""
        from railsym.cli_output import table

        cells = [[name, *("--" if np.ma.is_masked(v) else f"{3.6 * v:.0f} ({f:.1f})" for v, f in zip(speeds, frequencies))]
                 for name, speeds, frequencies in zip(self.rows, self.speed, self.frequency_hz)]
        return [f"{self.vehicle}, {self.configuration}: critical speed in km/h (frequency in Hz) with each model as {self.group}",
                table(["conicity", *(f"{c:.3g}" for c in self.conicity)], cells)]

    def as_data(self):
        """Plain data, SI; None where there is no critical speed."""
        return {"vehicle": self.vehicle, "group": self.group, "configuration": self.configuration, "conicity": self.conicity.tolist(),
                "speed": {name: [None if np.ma.is_masked(v) else float(v) for v in row] for name, row in zip(self.rows, self.speed)}}


def critical_speeds(vehicle, models, group="anti_yaw_damper", conicity=CONICITY, configuration=None, amplitudes=(1e-3, 3e-3)):
    """Critical speed with each damper model, linearised about rest and by its describing function at amplitudes.

    Parameters
    ----------
    vehicle : str or path
        A vehicle that comes along, or a TOML file.
    models : mapping of str to DamperModel
    group : str
        The group of elements that gets the model.
    conicity : array_like
    configuration : str, optional
        The file's first without it.
    amplitudes : sequence of float
        m, of the elongation of the damper; the equivalent damping and stiffness are those at the frequency of the unstable mode
        that the linearisation about rest gives, or the damper of the file where that has no critical speed.

    Returns
    -------
    DamperSpeeds
    """
    from railsym.vehicle import load_vehicle

    base = load_vehicle(vehicle)
    configuration = configuration or next(iter(base.configurations), None)
    found = {"as in the file": _speeds(base, configuration, conicity)}
    with tempfile.TemporaryDirectory() as folder:
        for name, model in models.items():
            tangent = _speeds(load_vehicle(put_into(vehicle, model, Path(folder) / "one.toml", group)), configuration, conicity)
            found[f"{name}, about rest"] = tangent
            # a model without a critical speed about rest has no frequency of its own: then that of the file's damper
            unstable = next((one.frequency_hz for one in (tangent, found["as in the file"]) if np.ma.count(one.frequency_hz)), None)
            for amplitude in amplitudes if unstable is not None else ():
                frequency = float(np.ma.median(unstable))
                path = put_into(vehicle, equivalent(model, amplitude, frequency), Path(folder) / "one.toml", group)
                found[f"{name}, {1e3 * amplitude:g} mm at {frequency:.1f} Hz"] = _speeds(load_vehicle(path), configuration, conicity)
    return DamperSpeeds(base.name, group, configuration or "", tuple(found), np.asarray(conicity, dtype=float),
                        np.ma.stack([one.speed for one in found.values()]), np.ma.stack([one.frequency_hz for one in found.values()]))


def equivalent(model, amplitude, frequency):
    """Linear model with the dynamic stiffness of a model at an amplitude (m) and a frequency (Hz)."""
    from railsym.dampers.models import DamperModel

    damping, stiffness = model.linearised(amplitude, frequency)
    if model.kind == "maxwell" and np.isfinite(stiffness):
        return DamperModel("maxwell", damping=damping, series_stiffness=stiffness)
    return DamperModel("viscous", damping=damping)


def _speeds(vehicle, configuration, conicity):
    from railsym.critical_speed import critical_speed

    return critical_speed(vehicle.configured(configuration) if configuration else vehicle, conicity)
