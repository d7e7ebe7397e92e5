# SPDX-License-Identifier: BSD-3-Clause
"""A tilting vehicle through curves, passive or with active tilt, of every case."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from railsym.sweep.analysis import Analysis, Output, option
from railsym.sweep.run_surroundings import contact_for, contact_inputs_of, part_of, track_for, track_inputs
from railsym.sweep.space import Input

_CONTROL = "tilt."
# Units of the numbers of TiltParameters that a study may change; the rest are pure numbers, seconds or belong to the detection of faults.
_UNITS = {"share": "-", "limit": "rad", "demand_rate": "rad/s", "kp": "-", "ki": "1/s", "kd": "s", "trim_limit": "rad", "latency": "s",
          "lateral_cutoff": "Hz", "gyro_cutoff": "Hz", "crossover": "s", "reference_frequency": "Hz", "reference_damping": "-", "ahead": "m",
          "lead": "s", "curve_on": "1/m", "curve_off": "1/m", "roll_on": "rad/s", "roll_off": "rad/s"}


@dataclass(frozen=True)
class Tilt(Analysis):
    """A run of the tilting study (`railsym.studies.tilt_study`): ride on the floor, lag of the tilt, wheel-rail forces.

    Parameters
    ----------
    speed : float
        m/s.
    track : str
        One that comes along, or a track file.
    active : bool
        With the tilt control; without it actuators hold the body upright.
    estimator : str
        "accelerometer" or "complementary", as `railsym.tilt.TiltParameters`.
    wheel, rail, inclination, gauge, law
        As `Transient`.
    step : float
        s, of the integration.

    Notes
    -----
    Outputs: ``ride.peak`` (m/s^2) and ``ride.jerk`` (m/s^3): lateral on the floor, worst place; ``ride.P_CT`` (per cent, nan where the run does not allow
    it); ``tilt.largest`` (rad); ``tilt.delay`` (s, behind the cant deficiency; nan when passive); ``derailment.YQ``; ``tilt.state``: how the controller
    ended; ``ending``, ``time``. Inputs: ``speed``, ``contact.*`` and ``track.*`` as `Transient`, and ``tilt.share``, ``tilt.lateral_cutoff`` and so on: the
    fields of `railsym.tilt.TiltParameters`.
    """

    speed: float = option(105.0 / 3.6, unit="m/s")
    track: str = option("s_curve_500", path=True)
    active: bool = option(True)
    estimator: str = option("accelerometer")
    wheel: str = option("S1002", path=True)
    rail: str = option("UIC60", path=True)
    inclination: float = option(1.0 / 40.0)
    gauge: float = option(1.435, unit="m")
    law: str = option("fastsim")
    step: float = option(1e-3, unit="s")
    kind = "tilt"
    # what the surroundings of a run ask for besides
    conicity = None
    irregularity = None
    duration = None

    def __post_init__(self):
        self._parameters({})

    def inputs(self, vehicle):
        control = self._parameters({})
        own = {f"{_CONTROL}{name}": Input(unit, float(getattr(control, name))) for name, unit in _UNITS.items()}
        return {"speed": Input("m/s", self.speed)} | contact_inputs_of(self, vehicle) | track_inputs(self) | (own if self.active else {})

    def outputs(self, vehicle):
        from railsym.tilt import TiltDrive

        TiltDrive.of(vehicle)               # raises where nothing tilts
        return {"ride.peak": Output("m/s^2", "largest lateral acceleration on the floor, below 2 Hz"), "ride.jerk": Output("m/s^3", "its largest rate"),
                "ride.P_CT": Output("-", "comfort on curve transitions, per cent dissatisfied"), "tilt.largest": Output("rad", "largest tilt angle"),
                "tilt.delay": Output("s", "tilt behind the cant deficiency"), "derailment.YQ": Output("-", "largest Y/Q, 2 m mean, 99.85 %"),
                "tilt.state": Output("", "state of the controller at the end", True), "ending": Output("", "how the run ended", True),
                "time": Output("s", "when the run ended")}

    def solver(self, vehicle):
        contacts = lru_cache(maxsize=4)(lambda settings: contact_for(self, vehicle, dict(settings)))

        def solve(case):
            speed = case.settings.get("speed", self.speed)
            contact, options = contacts(part_of(case.settings, "contact."))
            track, _ = track_for(self, case.vehicle, dict(part_of(case.settings, "track.")), speed)
            scene = _scene(case.vehicle, track, contact, speed, {"dt": self.step} | options)
            return _read(self._case(scene, case.settings))

        return solve

    def _parameters(self, settings):
        """TiltParameters of a case.

        Raises
        ------
        TiltError
        """
        from railsym.tilt import TiltParameters

        return TiltParameters(estimator=self.estimator, **{name[len(_CONTROL):]: value for name, value in settings.items() if name.startswith(_CONTROL)})

    def _case(self, scene, settings):
        from railsym.tilt import CompiledController, SensorSet, TiltUnit

        if not self.active:
            return scene.case("passive", "")
        sensors = SensorSet()
        control = self._parameters(settings)
        control = control.with_(sensor_delay=sensors.yaw_rate.delay)
        return scene.case("active", "", TiltUnit(CompiledController(control), sensors), share=control.share, limit=control.limit)


def _scene(vehicle, track, contact, speed, options):
    """The scene of `railsym.studies.tilt`, on a contact table that is there."""
    from railsym.studies.quasi_linear import mean_wheel_load
    from railsym.studies.tilt_case import Scene
    from railsym.tilt import TiltDrive
    from railsym.tilt.plant import leading_frame

    mass = sum(body.mass + sum(box.mass for box in body.axleboxes) for body in vehicle.bodies)
    return Scene(vehicle, track, contact, TiltDrive.of(vehicle), speed, leading_frame(vehicle), mean_wheel_load(vehicle), mass, options)


def _read(case):
    """Outputs of a `railsym.studies.TiltCase`."""
    worst = case.ride[case.worst]
    places = [ride["P_CT"] for ride in case.ride.values() if "P_CT" in ride]
    return {"ride.peak": worst["peak"], "ride.jerk": max(ride["jerk"] for ride in case.ride.values()), "ride.P_CT": max(places, default=np.nan),
            "tilt.largest": np.abs(case.tilt).max(), "tilt.delay": case.delay if case.state is not None else np.nan, "derailment.YQ": case.rails["Y/Q"],
            "tilt.state": case.end, "ending": case.run.status, "time": case.run.time[-1]}
