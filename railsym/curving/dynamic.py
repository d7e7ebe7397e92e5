# SPDX-License-Identifier: BSD-3-Clause
"""Runs through curves with irregularities: straight, transition, full curve; judged on the full curve as EN 14363 has it.

The transition is as long as the rule below asks; it begins on a straight where the irregularity fades in.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.curving.quantities import wheel_names
from railsym.curving.result import Failure
from railsym.errors import SimulationError
from railsym.track import Curve, Straight, Track, Transition

_BEFORE = 50.0           # m of straight before the transition, irregularity fades in over the first 25 m
_SETTLED = 30.0          # m of full curve behind the whole vehicle before it is judged, assumed: transients of the entry
_RAMP = 400.0            # m of transition for a metre of cant (2.5 mm a metre), and
_CHANGE = 55e-3          # m/s of cant deficiency: what lines are built by, assumed
_SHORTEST = 30.0         # m
_RATE = 200.0            # Hz, samples


@dataclass(frozen=True)
class Passage:
    """How curves are run through; see `railsym.curving`."""

    irregularity: object
    seed: int | None
    length: float
    dt: float
    direction: str

    def __post_init__(self):
        if not 20.0 <= self.length <= 2000.0:
            raise SimulationError(f"length = {self.length!r} m of full curve: 20 to 2000 m are needed")

    def track(self, vehicle, radius, cant, deficiency, speed):
        """The track, and where the judged part begins and ends for the vehicle's centre (m)."""
        ends = [body.position[0] for body in vehicle.bodies]
        ahead, behind = max(ends), -min(ends)
        transition = max(_SHORTEST, _RAMP * abs(cant), speed * abs(deficiency) / _CHANGE)
        first = _BEFORE + transition + behind + _SETTLED
        curve = ahead + behind + _SETTLED + self.length + 5.0
        track = Track([Straight(_BEFORE), Transition(transition), Curve(radius, curve, cant, self.direction)], name=f"curve of {radius:g} m")
        return track.with_irregularity(self.irregularity, **self._options()), first, first + self.length

    def check(self, vehicle, asked):
        """Refuse an irregularity that does not exist or is too short, before anything is computed.

        Raises
        ------
        TrackError
        """
        for k in {0, int(asked.cant.argmax())}:
            self.track(vehicle, float(asked.radius[k]), float(asked.cant[k]), float(asked.cant_deficiency[0, k]), float(asked.speed[0, k]))

    def _options(self):
        spectrum = isinstance(self.irregularity, (str, Path)) and Path(self.irregularity).suffix.lower() not in (".csv", ".txt")
        return {"seed": 1 if self.seed is None else self.seed} if spectrum else {} if self.seed is None else {"seed": self.seed}


def run_through(vehicle, wheels, asked, passage, wheelsets, told):
    """Run through every curve.

    Returns
    -------
    dict of str to ndarray
        As `Curving.largest`.
    list of Failure
    """
    count = len(wheelsets)
    sizes = {"YQ": 2 * count, "Q": 2 * count, "Y": 2 * count, "t_gamma": 2 * count, "sum_Y": count, "angle_of_attack": count}
    largest = {name: np.full((*asked.speed.shape, size), np.nan) for name, size in sizes.items()}
    failures = []
    for j, k in np.ndindex(asked.speed.shape):
        try:
            for name, values in _judged(vehicle, wheels, asked, j, k, passage, wheelsets).items():
                largest[name][j, k] = values
        except (SimulationError, CriterionError) as error:
            failures.append(Failure(j, k, float(asked.radius[k]), float(asked.speed[j, k]), "dynamic", str(error)))
        told()
    return largest, failures


def _judged(vehicle, wheels, asked, j, k, passage, wheelsets):
    """Arrays of one curve."""
    from railsym.criteria import derailment
    from railsym.simulation import simulate

    radius, cant, speed = float(asked.radius[k]), float(asked.cant[k]), float(asked.speed[j, k])
    track, first, last = passage.track(vehicle, radius, cant, float(asked.cant_deficiency[j, k]), speed)
    start = -max(body.position[0] for body in vehicle.bodies)
    names = [f"{wheel}.{name}" for wheel in wheel_names(wheelsets) for name in ("Y", "Q", "t_gamma")]
    names += [f"{wheelset}.{name}" for wheelset in wheelsets for name in ("sum_Y", "angle_of_attack")]
    run = simulate(vehicle, speed=speed, duration=(last - start) / speed, track=track, contact=wheels, channels=["s", "V", *names], rate=_RATE,
                   dt=passage.dt)
    if run.status != "completed":
        raise SimulationError(run.message)
    judged = run.between((first - start) / speed, (last - start) / speed)
    return _arrays(judged, derailment(judged), wheelsets)


def _arrays(run, forces, wheelsets):
    wheels = wheel_names(wheelsets)
    value = {item.name: item.value for item in forces.assessed}
    return {"YQ": [value[f"Y/Q {wheel}"] for wheel in wheels], "Q": [value[f"Q {wheel}"] for wheel in wheels],
            "Y": [value[f"Y quasi-static {wheel}"] for wheel in wheels], "sum_Y": [value[f"sum Y {wheelset}"] for wheelset in wheelsets],
            "t_gamma": [float(run[f"{wheel}.t_gamma"].mean()) for wheel in wheels],
            "angle_of_attack": [float(run[f"{wheelset}.angle_of_attack"].mean()) for wheelset in wheelsets]}
