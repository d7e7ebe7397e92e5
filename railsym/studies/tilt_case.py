# SPDX-License-Identifier: BSD-3-Clause
"""One run of the tilting study, and what it shows."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from railsym.studies import tilt_figures as figures
from railsym.tilt.errors import TiltError
from railsym.tilt.faults import State

FLOOR = -1.2               # m, height of the floor (assumed)
PLACES = {"front": (9.5, 0.0, FLOOR), "middle": (0.0, 0.0, FLOOR), "rear": (-9.5, 0.0, FLOOR), "seat": (0.0, 0.9, -1.7)}
_LEAST = 5.0               # s, of a run that is worth reading
_TAIL = 12.0               # m, of the vehicle behind its middle and before the end of the track


@dataclass(frozen=True, eq=False)
class TiltCase:
    """A run.

    Attributes
    ----------
    name, text : str
    run : railsym.Run
    record : railsym.Run or None
        Of the tilt unit; None without.
    reports : tuple of FaultReport
    state : State or None
        Of the controller at the end.
    tilt, ideal : ndarray (n,)
        rad, over ``run.time``; ideal: the share of the cant deficiency under the vehicle's middle, without lag and within the limit.
    ride : dict of str to dict
        By place: ``peak``, ``jerk`` (m/s^2, m/s^3, low-passed at 2 Hz), ``over_peak``, ``over_rms`` (m/s^2, of what a perfect tilt would have
        spared), ``P_CT`` (per cent, where the record allows).
    delay : float
        s, of tilt after the ideal.
    speed : float
        m/s, mean.
    steady : list of dict
        Means at the end of each circular curve.
    actuators, rails : dict
        See `railsym.studies.tilt_figures`.
    """

    name: str
    text: str
    run: Any = field(repr=False)
    record: Any = field(repr=False)
    reports: tuple
    state: Any
    tilt: np.ndarray = field(repr=False)
    ideal: np.ndarray = field(repr=False)
    ride: dict = field(repr=False)
    delay: float
    speed: float
    steady: list = field(repr=False)
    actuators: dict = field(repr=False)
    rails: dict = field(repr=False)

    @property
    def worst(self):
        """Place of the floor with the largest peak."""
        return max(("front", "middle", "rear"), key=lambda name: self.ride[name]["peak"])

    @property
    def end(self):
        """In words: how the controller ended."""
        if self.state is None:
            return "no control"
        return State(self.state).name.lower()


def markers(car):
    """Points on the car's floor above both bogies and in the middle, and a seat, for ``rs.simulate``."""
    return {name: (car, list(point)) for name, point in PLACES.items()}


def channels(drive, frame):
    """What a case records."""
    bodies = [f"{body}.{word}" for body in (drive.car, *drive.bolsters, frame) for word in ("roll", "roll.rate", "y", "z", "yaw")]
    return ["s", "V", *bodies, f"{frame}.ay", *(f"{name}.ay" for name in PLACES), *(f"{name}.{word}" for name in drive.actuators for word in ("force", "length", "power")),
            "wheelset*.sum_Y", "wheelset*.left.[YQ]", "wheelset*.right.[YQ]"]


@dataclass(frozen=True, eq=False)
class Scene:
    """What all cases of a study share.

    Attributes
    ----------
    vehicle, track, contact, drive : Vehicle, Track, contact, TiltDrive
    speed : float or pairs
        As `railsym.simulate` takes it.
    frame : str
        Leading bogie frame.
    load, mass : float
        N, mean static wheel load; kg, of the vehicle.
    options : dict
        For `railsym.simulate`.
    start : float or None
        m, place of the middle at the beginning.
    """

    vehicle: Any
    track: Any
    contact: Any
    drive: Any
    speed: Any
    frame: str
    load: float
    mass: float
    options: dict
    extra: tuple = ()

    def case(self, name, text, unit=None, *, share=0.0, limit=np.inf, passive=None, also=(), vehicle=None, duration=None, progress=False):
        """Run and read.

        Parameters
        ----------
        unit : TiltUnit, optional
        share, limit : float
            Of the ideal tilt.
        passive : TiltCase, optional
            To measure what a perfect tilt would spare.
        also : sequence of (callable, float)
            Further controllers, such as one that lets an actuator fail.
        vehicle : Vehicle, optional
            A changed one.
        duration : float, optional
            s
        """
        from railsym.simulation import simulate

        control = [] if unit is None else [unit.controller]
        run = simulate(vehicle or self.vehicle, speed=self.speed, duration=duration or self.duration, track=self.track, contact=self.contact,
                       channels=[*channels(self.drive, self.frame), *self.extra], markers=markers(self.drive.car), controllers=[*also, *control],
                       progress=progress, **self.options)
        if run.status != "completed" and run.time[-1] < _LEAST:
            raise TiltError(f"case {name}: {run.message}")
        return self.read(name, text, run, unit, share, limit, passive)

    @property
    def duration(self):
        """s, until the middle is so far from the end of the track as sensors of a leading vehicle need."""
        from railsym.simulation import SpeedProfile

        foremost = max(body.position[0] for body in self.vehicle.bodies)
        profile, end = SpeedProfile.of(self.speed, -foremost), self.track.length - _TAIL - 30.0
        return float(profile.when(np.array([end]))[0])

    def read(self, name, text, run, unit, share, limit, passive):
        """The `TiltCase` of a run."""
        vehicle, track, drive, parts = self.vehicle, self.track, self.drive, figures.TrackParts.of(self.track)
        tilt = figures.tilt_of(run, track, vehicle, drive)
        ideal = np.clip(share * np.arctan(figures.cant_deficiency(track, run["s"], run["V"]) / figures.G), -limit, limit)
        rows = None if unit is None else unit.record
        turning = run[f"{drive.car}.roll.rate"] + run["V"] * track.frame(np.clip(run["s"], track.start, track.length)).turning[:, 0]
        names = [f"{place}.ay" for place in PLACES] + [f"{self.frame}.ay", f"{drive.car}.roll", f"{self.frame}.roll", *(f"wheelset{k}.sum_Y" for k in (1, 2, 3, 4))]
        return TiltCase(name, text, run, rows, () if unit is None else tuple(unit.reports), None if unit is None else unit.state, tilt, ideal,
                        self._ride(run, parts, turning, ideal, passive), figures.lag(run.time, tilt, ideal), float(np.mean(run["V"])),
                        figures.steady_values(run, parts, [n for n in names if n in run]), figures.actuators(run, drive), figures.rails(run, self.load))

    def _ride(self, run, parts, turning, ideal, passive):
        found, comfort = {}, figures.comfort(run, parts, {name: point[0] for name, point in PLACES.items()}, turning)
        settled = run.time > 0.5
        for name in PLACES:
            felt = figures.smooth(run, run[f"{name}.ay"])
            ride = {"peak": np.abs(felt[settled]).max(), "jerk": np.abs(np.gradient(felt, run.time)[settled]).max()}
            if passive is not None:
                n = min(len(run), len(passive.run))
                spared = figures.smooth(passive.run, passive.run[f"{name}.ay"])[:n] - figures.G * np.sin(ideal[:n])
                over = (felt[:n] - spared)[settled[:n]]
                ride |= {"over_peak": np.abs(over).max(), "over_rms": np.sqrt(np.mean(over ** 2))}
            found[name] = {key: float(value) for key, value in ride.items()}
            if name in comfort:
                found[name]["P_CT"] = float(comfort[name])
        return found
