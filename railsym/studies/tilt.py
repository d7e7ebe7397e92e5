# SPDX-License-Identifier: BSD-3-Clause
"""The paper's section 4: an S-curve passively and with active tilt, where the control lags, and what makes it quicker.

docs/tilting.md has the control law, what is assumed and what is found.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from railsym.contact_pair import DEEPEST_IN_MOTION
from railsym.studies.quasi_linear import mean_wheel_load
from railsym.studies.switch import default_pair
from railsym.studies.tilt_case import Scene, TiltCase
from railsym.tilt import CompiledController, Controller, LeadingSignals, SensorSet, TiltDrive, TiltError, TiltLoop, TiltParameters, TiltUnit, TrackDatabase
from railsym.tilt.plant import leading_frame, steps_between

SPEED = 105.0 / 3.6        # m/s, the paper
COACH = 25.9               # m, of a coach over its couplers (assumed: usual for the class): the leading vehicle's distance
QUIET = 0.5                # Hz, of the gyroscope where it makes the estimate: a third of the body's sway, which comes back through the roll of the bogie
EARLY = 0.25               # of that filter's delay: what the estimate of a transition of 2 to 3 s comes late by (found by trial)
OFFSET = 5.0               # m, error of the database's place (assumed: odometer corrected by balises)


@dataclass(frozen=True, eq=False)
class TiltStudy:
    """What `tilt_study` found.

    Attributes
    ----------
    scene : Scene
    parameters : TiltParameters
        Of the plain active case.
    cases : tuple of TiltCase
        Passive, active, and the improvements.
    faults, sensitivity : tuple of TiltCase
    loop : TiltLoop
    """

    scene: Scene = field(repr=False)
    parameters: TiltParameters
    cases: tuple
    faults: tuple = ()
    sensitivity: tuple = ()
    loop: Any = field(default=None, repr=False)

    def __getitem__(self, name):
        known = (*self.cases, *self.faults, *self.sensitivity)
        for case in known:
            if case.name == name:
                return case
        raise TiltError(f"no case {name!r}; there are {', '.join(case.name for case in known)}")

    @property
    def message(self):
        """The comparison in a sentence."""
        passive, active = self["passive"], self["active"]
        return (f"lateral acceleration on the floor, peak: passive {passive.ride[passive.worst]['peak']:.2f} m/s^2, active "
                f"{active.ride[active.worst]['peak']:.2f} m/s^2; tilt comes {active.delay:.2f} s ({active.delay * active.speed:.1f} m) after the curve")

    def __str__(self):
        from railsym.studies.tilt_report import report

        return report(self)

    def plot(self, *, axes=None):
        """Draw track and tilt, accelerations, actuators and wheel forces, as figures 21 to 24 of the paper; returns the axes."""
        from railsym.plots.tilt import plot_tilt_study

        return plot_tilt_study(self, axes=axes)


def tilt_study(vehicle, track=None, *, speed=SPEED, pair=None, parameters=None, sensors=None, improvements=True, faults=False, sensitivity=False, coach=COACH, offset=OFFSET,
               compiled=False, law="fastsim", grid=(20, 20), friction=None, dt=1e-3, channels=(), progress=False):
    """Run a vehicle through curves without and with active tilt.

    Parameters
    ----------
    vehicle : Vehicle
        With actuators that tilt it: ``load_vehicle("pendolino_tilting").configured("AS_K")``.
    track : railsym.Track, optional
        The shipped S-curve of radius 500 m if not given.
    speed : float or pairs of (time, speed)
        m/s; the paper's 105 km/h if not given.
    pair : ContactPair, optional
        S1002 on UIC60 at 1:40 if not given.
    parameters : TiltParameters, optional
    sensors : SensorSet, optional
    improvements : bool
        Also better detection, signals of a leading vehicle ``coach`` m ahead (constant speed only), a track database ``offset`` m off.
    faults : bool
        Also the fault cases of `railsym.studies.tilt_faults`.
    sensitivity : bool
        Also the active case with other biases, losses, delays: `railsym.studies.tilt_sensitivity`.
    compiled : bool
        The controller in C; the same results.
    law, grid, friction, dt : optional
        Of the simulation.
    channels : sequence of str
        Recorded beside those that the study reads.
    progress : bool

    Returns
    -------
    TiltStudy

    Raises
    ------
    TiltError
        A vehicle that does not tilt.
    """
    from railsym.studies.tilt_report import DETECTION, LEADING

    p, sensors = parameters or TiltParameters(), sensors or SensorSet()
    steps_between(p.rate, dt)
    p = p.with_(sensor_delay=sensors.yaw_rate.delay) if parameters is None else p
    scene = make_scene(vehicle, track, speed, pair, {"law": law, "grid": grid, "dt": dt} | ({} if friction is None else {"friction": friction}), channels)
    make = CompiledController if compiled else Controller
    passive = scene.case("passive", "actuators hold the body upright", progress=progress)

    def run(name, text, unit, share=p.share):
        return scene.case(name, text, unit, share=share, limit=p.limit, passive=passive, progress=progress)

    leader = TiltUnit(make(p), sensors)
    active = run("active", f"accelerometers below {p.lateral_cutoff:g} Hz, gyroscope finds the curve", leader)
    cases = [passive, active]
    if improvements:
        cases.append(run("detection", DETECTION, TiltUnit(make(detecting(p)), sensors)))
        if np.ndim(speed) == 0:
            cases.append(run("leading", LEADING.format(coach), _leading_unit(scene, p, sensors, coach, float(speed))))
        for name, off in (("database", offset), ("database, exact", 0.0)):
            cases.append(run(name, f"track database, {off:g} m off", TiltUnit(make(by_place(p), TrackDatabase.of(scene.track, offset=off)), sensors)))
    from railsym.studies.tilt_faults import fault_cases
    from railsym.studies.tilt_sensitivity import sensitivity_cases

    more = [tuple(make_cases(scene, p, sensors, passive, progress)) if wanted else () for make_cases, wanted in ((fault_cases, faults), (sensitivity_cases, sensitivity))]
    return TiltStudy(scene, p, tuple(cases), *more, TiltLoop.of(vehicle, float(np.mean(passive.run["V"])), p))


def make_scene(vehicle, track=None, speed=SPEED, pair=None, options=None, channels=()):
    """The `Scene` of a study."""
    from railsym.track import load_track

    drive = TiltDrive.of(vehicle)
    track = load_track("s_curve_500") if track is None else track
    contact = (pair or default_pair(vehicle)).table(deepest=DEEPEST_IN_MOTION)
    mass = sum(body.mass + sum(box.mass for box in body.axleboxes) for body in vehicle.bodies)
    return Scene(vehicle, track, contact, drive, speed, leading_frame(vehicle), mean_wheel_load(vehicle), mass, options or {}, tuple(channels))


def by_place(parameters):
    """The parameters with a database, called early by the delays of filter, latency and reference model."""
    return parameters.with_(source="database", lead=_late(parameters))


def _late(parameters):
    """s, from a low-passed acceleration to the tilt that follows it."""
    return parameters.filter_delay(parameters.lateral_cutoff) + parameters.latency + parameters.follow_delay


def detecting(parameters):
    """The parameters with the complementary estimate, called where the vehicle's middle is: it is early enough for that.

    A slow change it does not delay at all, a quick one by its gyroscope's filter.
    """
    quiet = parameters.with_(estimator="complementary", gyro_cutoff=QUIET, source="leading")
    return quiet.with_(lead=EARLY * quiet.filter_delay(QUIET) + quiet.latency + quiet.follow_delay)


def behind(parameters, distance):
    """The parameters with sensors of a vehicle ``distance`` m ahead: called early by the filter's delay too."""
    return parameters.with_(source="leading", ahead=distance + parameters.ahead, lead=_late(parameters))


def _leading_unit(scene, parameters, sensors, coach, speed):
    """A unit on the signals of a vehicle of the same kind ahead, with noise of its own; it runs first, and passively: its bogie rides alike."""
    from dataclasses import replace

    ahead = TiltUnit(Controller(parameters), replace(sensors, seed=sensors.seed + 1))
    scene.case("ahead", "the leading vehicle", ahead, share=parameters.share, limit=parameters.limit, duration=scene.duration + coach / speed)
    shift = round(coach / speed * parameters.rate) * speed / parameters.rate
    return TiltUnit(LeadingSignals(Controller(behind(parameters, shift)), ahead.record, coach, speed), sensors)


__all__ = ["COACH", "OFFSET", "SPEED", "TiltCase", "TiltStudy", "behind", "by_place", "detecting", "make_scene", "tilt_study"]
