# SPDX-License-Identifier: BSD-3-Clause
"""Fault cases of the tilting study: sensors, actuators, failure at full tilt; each must end in a state that is reported."""

from __future__ import annotations

import numpy as np

from railsym.studies.tilt_figures import TrackParts
from railsym.tilt import Controller, SensorFault, TiltUnit
from railsym.tilt.errors import TiltError

BIAS = 0.5                 # m/s^2
GYRO_BIAS = np.radians(2.0)
FULL = 1.35                # share of the cases at full tilt: the demand meets the limit


def fault_cases(scene, parameters, sensors, passive, progress=False):
    """Run them; an iterator of TiltCase.

    Sensors fail when the vehicle's middle is in the first curve by a quarter, actuators when it is there by three quarters.

    Parameters
    ----------
    scene : Scene
    parameters : TiltParameters
    sensors : SensorSet
    passive : TiltCase
    """
    curves = [c for c in TrackParts.of(scene.track).curves if c[1] - c[0] > 30.0]
    if not curves:
        raise TiltError(f"fault cases need a circular curve of 30 m at least; track {scene.track.name!r} has none")
    (start, end), run = curves[0], passive.run
    early, late = (float(np.interp(start + part * (end - start), run["s"], run.time)) for part in (0.25, 0.75))

    def case(name, text, faults=(), change=None, also=(), vehicle=None):
        p = parameters.with_(**(change or {}))
        unit = TiltUnit(Controller(p), sensors.with_faults(*faults))
        return scene.case(name, text, unit, share=p.share, limit=p.limit, passive=passive, also=also, vehicle=vehicle, progress=progress)

    for name, text, faults in _sensor_faults(early):
        yield case(name, text, faults)
    weak = saturating(scene, parameters)
    yield case("saturation", f"actuators give {1e-3 * weak:.3g} kN at most", vehicle=scene.vehicle.replace({_limit_name(scene): weak}))
    full = {"share": FULL * parameters.limit / np.arctan(_deficiency(scene, passive) / 9.81)}
    front = [name for name in scene.drive.actuators if name.rpartition(".")[2].startswith("front")] or list(scene.drive.actuators)[:1]
    for name, text, kind, which in (("stuck", "all actuators stick at full tilt", "stuck", scene.drive.actuators),
                                    ("free", "all actuators lose their force at full tilt", "free", scene.drive.actuators),
                                    ("damped", "all actuators lose their pressure at full tilt, bypass damping is left", "damped", scene.drive.actuators),
                                    ("half stuck", "the leading bogie's actuators stick at full tilt", "stuck", front)):
        yield case(name, text, change=full, also=[(Failing(which, kind, late), parameters.rate)])


def _sensor_faults(time):
    """Name, text and faults, all from ``time`` (s) on."""
    yield "bias", f"accelerometer a {BIAS:g} m/s^2 off", [SensorFault("lateral_a", "bias", time, value=BIAS)]
    yield "accelerometer", "accelerometer a silent", [SensorFault("lateral_a", "missing", time)]
    yield "frozen", "accelerometer b repeats its last value", [SensorFault("lateral_b", "frozen", time)]
    yield "gyroscope", "gyroscope silent", [SensorFault(name, "missing", time) for name in ("roll_rate", "yaw_rate")]
    yield "gyroscope bias", f"yaw gyroscope {np.degrees(GYRO_BIAS):g} deg/s off", [SensorFault("yaw_rate", "bias", time, value=GYRO_BIAS)]
    yield "accelerometers", "both accelerometers silent", [SensorFault(name, "missing", time) for name in ("lateral_a", "lateral_b")]
    yield "odometer", "speed and place missing", [SensorFault(name, "missing", time) for name in ("speed", "place")]
    yield "tilt sensor", "tilt sensor silent", [SensorFault("tilt", "missing", time)]


class Failing:
    """A controller that lets actuators fail at a time (s); see `railsym.simulation.Controls.fault`."""

    def __init__(self, actuators, kind, time):
        self.actuators, self.kind, self.time, self.done = tuple(actuators), kind, time, False

    def __call__(self, controls):
        if not self.done and controls.time >= self.time - 1e-9:
            self.done = True
            for name in self.actuators:
                controls.fault(name, self.kind)


def _deficiency(scene, passive):
    from railsym.studies.tilt_figures import cant_deficiency

    return float(np.abs(cant_deficiency(scene.track, passive.run["s"], passive.run["V"])).max())


def _limit_name(scene):
    names = {name.rpartition(".")[0] for name in scene.drive.actuators}
    if len(names) != 1:
        raise TiltError("the saturation case lowers one force limit: the actuators belong to several elements")
    return f"{names.pop()}.force_limit"


def saturating(scene, parameters):
    """N: a quarter of what an actuator needs in the steady curve, by the moment of the body about its tilting centre.

    The body's centre of mass lies ``h`` below the centre about which the links turn it; tilted by theta and pulled out by a_nc it needs
    m h (g sin(theta) + a (1 - ...)) of moment; the estimate takes m h (g theta + a_nc) shared by the actuators at their levers.
    """
    drive, car = scene.drive, scene.vehicle.body(scene.drive.car)
    h = car.position[2] - drive.centre[1]
    deficiency = max(abs(float(v)) for v in _levels(scene))
    angle = parameters.share * np.arctan(deficiency / 9.81)
    moment = car.mass * h * (9.81 * angle + deficiency)
    return float(0.25 * moment / np.abs(drive.powers[:, 1]).sum())


def _levels(scene):
    from railsym.studies.tilt_figures import cant_deficiency

    speed = scene.speed if np.ndim(scene.speed) == 0 else max(v for _, v in scene.speed)
    s = np.arange(0.0, scene.track.length, 1.0)
    return cant_deficiency(scene.track, s, np.full_like(s, float(speed)))
