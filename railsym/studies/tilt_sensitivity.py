# SPDX-License-Identifier: BSD-3-Clause
"""How far the active case depends on its sensors and delays: one change a run, none of them a fault that the controller reports at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym.tilt import Controller, TiltUnit, TrackDatabase


def sensitivity_cases(scene, parameters, sensors, passive, progress=False):
    """Run them; an iterator of TiltCase.

    Parameters
    ----------
    scene : Scene
    parameters : TiltParameters
    sensors : SensorSet
    passive : TiltCase
    """
    for name, text, p, s, database in _changes(scene, parameters, sensors):
        unit = TiltUnit(Controller(p, database), s)
        yield scene.case(name, text, unit, share=p.share, limit=p.limit, passive=passive, progress=progress)


def _changes(scene, p, sensors):
    """Name, text, parameters, sensors, database."""
    from railsym.studies.tilt import by_place

    for bias in (0.1, 0.2):
        changed = {name: replace(getattr(sensors, name), bias=getattr(sensors, name).bias + bias) for name in ("lateral_a", "lateral_b")}
        yield f"bias {bias:g}", f"both accelerometers {bias:g} m/s^2 off", p, replace(sensors, **changed), None
    drift = np.radians(0.2)
    yield "drift", "gyroscope 0.2 deg/s off", p, replace(sensors, yaw_rate=replace(sensors.yaw_rate, bias=drift), roll_rate=replace(sensors.roll_rate, bias=drift)), None
    for loss in (0.05, 0.2):
        yield f"loss {100.0 * loss:g} %", f"{100.0 * loss:g} % of the samples lost", p, replace(sensors, loss=loss), None
    for latency in (0.1, 0.2):
        yield f"latency {1e3 * latency:g}", f"latency {1e3 * latency:g} ms", p.with_(latency=latency), sensors, None
    for cutoff in (0.25, 1.0):
        yield f"filter {cutoff:g}", f"low-pass {cutoff:g} Hz", p.with_(lateral_cutoff=cutoff), sensors, None
    for offset in (10.0, 20.0, 50.0):
        yield f"database {offset:g}", f"track database, {offset:g} m off", by_place(p), sensors, TrackDatabase.of(scene.track, offset=offset)
