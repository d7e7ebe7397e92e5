# SPDX-License-Identifier: BSD-3-Clause
"""What is read off a run with tilting: tilt, lag, what passengers feel, forces on actuators and rails."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria import curve_transition_comfort, derailment
from railsym.criteria.errors import CriterionError
from railsym.criteria.filters import Butterworth

SMOOTH = 2.0               # Hz, low-pass (zero phase) of accelerations before peaks and jerk are read: what tilting can act on
_LATEST = 2.0              # s, lags looked for
_STEADY = 1.0              # s at the end of a circular curve, over which its values are means
_HALF, _SETTLES = 12.0, 2.0  # m, half a vehicle; s, that a vehicle takes to settle at least
_STILL = 1e-7              # 1/m a metre: slower changes of curvature and cant are none
G = 9.81


@dataclass(frozen=True)
class TrackParts:
    """Where the track is what.

    Attributes
    ----------
    transitions, curves : list of (float, float)
        m, start and end.
    """

    transitions: list
    curves: list

    @classmethod
    def of(cls, track):
        """Of a `railsym.Track`."""
        s = np.arange(0.0, track.length, 0.25)
        curvature, cant = track.curvature(s), track.alignment.cant(s)
        changes = np.abs(np.gradient(curvature, s)) + np.abs(np.gradient(cant, s)) > _STILL * 10.0
        return cls(_spans(s, changes, 2.0), _spans(s, ~changes & (np.abs(curvature) > 1e-6), 5.0))


def _spans(s, inside, shortest):
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    return [(float(s[a]), float(s[b - 1])) for a, b in zip(edges[::2], edges[1::2]) if s[b - 1] - s[a] > shortest]


def cant_deficiency(track, s, speed, gravity=G):
    """Lateral acceleration that the cant leaves, V^2 k - g sin(cant angle), m/s^2, at places (m) and speeds (m/s)."""
    s = np.clip(s, track.start, track.length)
    return speed ** 2 * track.curvature(s) - gravity * track.alignment.cant(s)


def smooth(run, values):
    """Values low-passed at 2 Hz, zero phase."""
    return Butterworth(0.0, SMOOTH, 2, True).apply(values, 1.0 / run.step, "acceleration")


def tilt_of(run, track, vehicle, drive):
    """Tilt of the body against its bolsters (rad): rolls in their track frames and the cant under each."""
    def roll(name):
        return run[f"{name}.roll"] + np.arcsin(track.alignment.cant(np.clip(run["s"] + vehicle.body(name).position[0], track.start, track.length)))

    return roll(drive.car) - np.mean([roll(name) for name in drive.bolsters], axis=0)


def lag(time, tilt, ideal):
    """s, by which tilt comes after the ideal one: least squares with a free factor; nan where there is nothing to follow."""
    if np.abs(ideal).max() < 1e-6 or np.abs(tilt).max() < 1e-6:
        return np.nan
    shifts = np.arange(-_LATEST, _LATEST + 1e-9, 0.01)
    inside = (time > time[0] + _LATEST) & (time < time[-1] - _LATEST)

    def left(shift):
        moved = np.interp(time[inside] - shift, time, ideal)
        size = moved @ moved
        return np.inf if size == 0.0 else np.sum((tilt[inside] - (moved @ tilt[inside]) / size * moved) ** 2)

    found = np.array([left(shift) for shift in shifts])
    k = int(np.clip(np.argmin(found), 1, len(shifts) - 2))
    before, here, after = found[k - 1:k + 2]
    bend = before - 2.0 * here + after
    return float(shifts[k] + (0.005 * (before - after) / bend if bend > 0.0 else 0.0))


def steady_values(run, parts, names):
    """Means of channels over the last second before the vehicle's middle leaves each circular curve that lasts long enough: list of dict."""
    found = []
    for start, end in parts.curves:
        inside = (run["s"] <= end - _HALF) & (run["s"] > end - _HALF - _STEADY * run["V"])
        if inside.any() and end - start > 2.0 * _HALF + _SETTLES * float(run["V"].max()):
            found.append({name: float(np.mean(run[name][inside])) for name in names} | {"s": float(np.mean(run["s"][inside]))})
    return found


def comfort(run, parts, places, roll_rate):
    """Largest P_CT (per cent, standing) of the places over all transitions, name -> value; empty where the record is too short."""
    worst = {}
    for start, end in parts.transitions:
        for name, ahead in places.items():
            times = np.interp([start - ahead, end - ahead], run["s"], run.time)
            try:
                found = curve_transition_comfort(run.time, run[f"{name}.ay"], roll_rate, *times)
            except CriterionError:
                continue
            worst[name] = max(worst.get(name, 0.0), found.percent)
    return worst


def actuators(run, drive):
    """Largest force of one actuator (N), largest power (W) and work (J) of all together, counting only what is given."""
    forces = [run[f"{name}.force"] for name in drive.actuators]
    power = np.sum([run[f"{name}.power"] for name in drive.actuators], axis=0)
    return {"force": float(np.max(np.abs(forces))), "power": float(power.max()), "work": float(np.trapezoid(np.maximum(power, 0.0), run.time))}


def rails(run, wheel_loads):
    """Largest of Y/Q and unloading, and the sum of Y of every wheelset (N), after UIC 518."""
    found = derailment(run, wheel_load=wheel_loads)
    sums = {item.name.rpartition(" ")[2]: abs(item.value) for item in found.assessed if item.name.startswith("sum Y ")}
    ratios = {item.name.rpartition(" ")[2]: abs(item.value) for item in found.assessed if item.name.startswith("Y/Q ")}
    sums = dict(sorted(sums.items()))
    return {"Y/Q": abs(found.worst("Y/Q").value), "unloading": abs(found.worst("unloading").value), "sum_Y": sums, "ratios": ratios,
            "where": found.worst("Y/Q").name.rpartition(" ")[2], "limit Y/Q": found.worst("Y/Q").limit, "limit sum_Y": found.worst("sum Y").limit}
