# SPDX-License-Identifier: BSD-3-Clause
"""A run in time of every case, judged by criteria."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from railsym.sweep.analysis import Analysis, Output, option
from railsym.sweep.errors import SweepError, unknown
from railsym.sweep.run_criteria import CRITERIA
from railsym.sweep.run_surroundings import contact_for, contact_inputs_of, part_of, track_for, track_inputs
from railsym.sweep.space import Input

_RATE = 200.0          # Hz: comfort and derailment need it
_INITIAL = "initial."


@dataclass(frozen=True)
class Transient(Analysis):
    """A simulation by `railsym.simulate`, and what criteria say of it.

    Parameters
    ----------
    speed : float
        m/s.
    duration : float, optional
        s; to the end of the track without it.
    track : str, optional
        One that comes along, or a track file; straight and level without it.
    irregularity : str, optional
        Spectrum by name or file.
    irregularity_seed, irregularity_scale : int, float
        Of the spectrum.
    wheel, rail, inclination, gauge
        Of the pair of profiles, as `railsym.ContactPair`; the wheelsets' measures are the vehicle's.
    conicity : float, optional
        Linear contact in place of profiles; it has no wheel-rail forces to judge.
    law : str
        Creep law on profiles.
    criteria : sequence of str
        Of "instability", "derailment", "body_acceleration", "comfort", "hunting".
    place : str, optional
        Where comfort and body accelerations are judged; the heaviest body without it.
    step : float
        s, of the integration.

    Notes
    -----
    Outputs: those of the criteria (docs/studies_sweep.md lists them), nan where a run stopped too early for them; ``ending``: "completed",
    "derailed", "not_converged"; ``time`` (s), when it ended. Inputs: ``speed``, ``contact.friction``, ``contact.gauge``,
    ``contact.inclination`` (or all of the linear contact), ``track.radius`` and ``track.cant`` (of all its curves),
    ``track.sections.1.length`` and so on, ``track.irregularity_scale``, ``track.irregularity_seed``, and ``initial.wheelset1.y`` (m) of
    every body.
    """

    speed: float = option(unit="m/s")
    duration: float | None = option(None, unit="s")
    track: str | None = option(None, path=True)
    irregularity: str | None = option(None, path=True)
    irregularity_seed: int = option(1)
    irregularity_scale: float = option(1.0)
    wheel: str = option("S1002", path=True)
    rail: str = option("UIC60", path=True)
    inclination: float = option(1.0 / 40.0)
    gauge: float = option(1.435, unit="m")
    conicity: float | None = option(None)
    law: str = option("fastsim")
    criteria: tuple = option(("instability",))
    place: str | None = option(None)
    step: float = option(1e-3, unit="s")
    kind = "transient"

    def __post_init__(self):
        object.__setattr__(self, "criteria", (self.criteria,) if isinstance(self.criteria, str) else tuple(self.criteria))
        for name in self.criteria:
            if name not in CRITERIA:
                raise SweepError(f"transient: criterion {name!r} is {unknown(name, CRITERIA, 'criteria')}")
        if self.duration is None and self.track is None:
            raise SweepError("transient: without a track a run needs a duration, such as duration=5.0 (s)")

    def inputs(self, vehicle):
        initial = {f"{_INITIAL}{body.name}.y": Input("m", 0.0) for body in vehicle.bodies}
        return {"speed": Input("m/s", self.speed)} | contact_inputs_of(self, vehicle) | track_inputs(self) | initial

    def outputs(self, vehicle):
        found = {name: out for criterion in self.criteria for name, out in CRITERIA[criterion].outputs.items()}
        return found | {"ending": Output("", "how the run ended", True), "time": Output("s", "when the run ended")}

    def solver(self, vehicle):
        contacts = lru_cache(maxsize=4)(lambda settings: contact_for(self, vehicle, dict(settings)))
        tracks = lru_cache(maxsize=4)(lambda settings, speed: track_for(self, vehicle, dict(settings), speed))
        place = self.place or max(vehicle.bodies, key=lambda body: body.mass).name

        def solve(case):
            speed = case.settings.get("speed", self.speed)
            contact, more = contacts(part_of(case.settings, "contact."))
            track, duration = tracks(part_of(case.settings, "track."), speed)
            initial = {name[len(_INITIAL):]: value for name, value in case.settings.items() if name.startswith(_INITIAL)}
            return self._judged(_run(case.vehicle, place, speed=speed, duration=duration, track=track, contact=contact, dt=self.step, rate=_RATE,
                                     initial=initial or None, **more), place)

        return solve

    def _judged(self, run, place):
        found = {"ending": run.status, "time": float(run.time[-1])}
        for name in self.criteria:
            found |= CRITERIA[name].judge(run, place)
        return found


def _run(vehicle, place, **options):
    """The run, with the channels that criteria read."""
    from railsym.results.channel import Channels
    from railsym.simulation import Simulation
    from railsym.simulation.channels import DEFAULT

    duration = options.pop("duration")
    available = Channels(recipe.channel for recipe in Simulation(vehicle, channels="s", **options).available.values())
    simulation = Simulation(vehicle, channels=available.match(*DEFAULT, f"{place}.a[xyz]"), **options)
    simulation.run(duration)
    return simulation.result()
