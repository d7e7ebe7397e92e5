# SPDX-License-Identifier: BSD-3-Clause
"""The paper's section 3.1: a vehicle without anti-yaw dampers over a switch, stable or not by the 8 m/s^2 criterion.

docs/switch_study.md says what is assumed, what is found and how it differs from the paper.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from railsym.contact_pair import DEEPEST_IN_MOTION
from railsym.errors import SimulationError
from railsym.studies.quasi_linear import hunting_mode, mean_wheel_load, quasi_linear
from railsym.studies.switch_run import cross
from railsym.studies.switch_threshold import SwitchThreshold, switch_threshold
from railsym.track import Switch

SWITCH = Switch(start=20.0, length=10.0, amplitude=5e-3, shape="bump")      # assumed: the geometry of the ERRI switch was not found
AMPLITUDE = 3e-3            # m, at which equivalent conicity is quoted; so V0 is taken there
RATIOS = (0.85, 0.90, 1.0)  # V/V0: those of the paper, and V0
AFTER = 6.0                 # s of motion behind the switch


@dataclass(frozen=True, eq=False)
class SwitchStudy:
    """What `switch_study` found.

    Attributes
    ----------
    vehicle : Vehicle
    pair : ContactPair
    contact : LinearContact
        Of the pair at the amplitude that V0 belongs to.
    reference, critical : float
        V0, and the linear critical speed with that contact (m/s): the same unless V0 was given.
    frequency_hz : float
        Of the mode that becomes unstable at the linear critical speed, Hz.
    label : str
        What moves in it.
    switch : railsym.track.Switch
    runs : tuple of SwitchRun
        One a speed asked for, and the one at the unstable end of the threshold's bracket, ascending.
    threshold : SwitchThreshold or None
    load : float
        Mean static wheel load, N.
    rigid, elastic : dict of str to ndarray (n,)
        Critical speeds of the pair against amplitude, see `railsym.studies.quasi_linear`: rigid profiles, and elastic contact under the
        wheel load.
    modes : tuple of Mode or None
        Of each run: the hunting mode at its speed with the elastic contact of its mean amplitude.
    sensitivity : tuple of SwitchThreshold or (Switch, str)
        Of other switches; the text where one has no verdict.
    """

    vehicle: Any = field(repr=False)
    pair: Any = field(repr=False)
    contact: Any
    reference: float
    critical: float
    frequency_hz: float
    label: str
    switch: Switch
    runs: tuple = field(repr=False)
    threshold: SwitchThreshold | None
    load: float
    rigid: dict = field(repr=False)
    elastic: dict = field(repr=False)
    modes: tuple = field(repr=False)
    sensitivity: tuple = field(default=(), repr=False)

    @property
    def message(self):
        """The verdicts in a sentence."""
        from railsym.studies.switch_report import WORDS, ratio_text

        found = ", ".join(f"{WORDS[run.unstable]} at {ratio_text(run.ratio)} V0" for run in self.runs)
        return found + (f"; {self.threshold.message}" if self.threshold else "")

    def __str__(self):
        from railsym.studies.switch_report import report

        return report(self)

    def plot(self, *, axes=None):
        """Draw accelerations and spectra, as figures 17 and 18 of the paper; see `railsym.plots.switch.plot_switch_study`."""
        from railsym.plots.switch import plot_switch_study

        return plot_switch_study(self, axes=axes)

    def plot_quasi_linear(self, *, axes=None):
        """Draw amplitudes behind the switch beside those of the quasi-linear theory; returns the axes."""
        from railsym.plots.switch import plot_quasi_linear

        return plot_quasi_linear(self, axes=axes)


def switch_study(vehicle, pair=None, *, ratios=RATIOS, reference=None, amplitude=AMPLITUDE, load=None, switch=SWITCH, threshold=True,
                 sensitivity=(), law="fastsim", grid=(20, 20), friction=None, after=AFTER, dt=1e-3, progress=False):
    """Run a vehicle over a switch at parts of its linear critical speed V0 and judge its stability.

    Parameters
    ----------
    vehicle : Vehicle
        The paper: the Pendolino without anti-yaw dampers, ``load_vehicle("pendolino").configured("noAS_K")``.
    pair : ContactPair, optional
        S1002 on UIC60 at 1:40, gauge 1435 mm, wheel radius of the vehicle, if not given.
    ratios : sequence of float
        V/V0 to run; those of the paper and V0 itself if not given.
    reference : float, optional
        V0, m/s; without it the linear critical speed (real part = 0) at the pair's conicity at ``amplitude``.
    amplitude : float
        m
    load : float, optional
        N a wheel: V0 with elastic contact; without it with rigid profiles, as conicity is quoted (EN 15302).
    switch : railsym.track.Switch
    threshold : bool
        Also find the speed at which the verdict turns.
    sensitivity : sequence of Switch
        Further switches whose threshold is found.
    law, grid, friction : optional
        Of the wheel-rail forces; friction also of V0.
    after : float
        s of motion behind the switch.
    dt : float
        s
    progress : bool

    Returns
    -------
    SwitchStudy

    Raises
    ------
    SimulationError
        The vehicle has no critical speed there, ratios that make no sense, a threshold that cannot be found.
    """
    pair = pair or default_pair(vehicle)
    ratios = _checked(ratios)
    contact, found = linear_reference(vehicle, pair, amplitude, friction, load)
    V0 = float(found.speed) if reference is None else float(reference)
    more = {"law": law, "grid": grid, "dt": dt} | ({} if friction is None else {"friction": friction})
    table = pair.table(deepest=DEEPEST_IN_MOTION)
    runs = [cross(vehicle, table, switch, ratio * V0, reference=V0, after=after, progress=progress, **more) for ratio in ratios]
    turn = switch_threshold(vehicle, table, switch, reference=V0, after=after, progress=progress, **more) if threshold else None
    if turn is not None and not np.isnan(turn.ratio):
        runs.append(cross(vehicle, table, switch, turn.bracket[1] * V0, reference=V0, after=after, progress=progress, **more))
    runs.sort(key=lambda run: run.ratio)
    others = tuple(_threshold_or_why(vehicle, table, other, V0, after, progress, more) for other in sensitivity)
    weight, given = mean_wheel_load(vehicle), _given(friction)
    modes = tuple(hunting_mode(vehicle, pair, run.speed, run.mean_motion, weight, **given) for run in runs)
    return SwitchStudy(vehicle, pair, contact, V0, float(found.speed), float(found.frequency_hz), str(found.label), switch, tuple(runs), turn, weight,
                       *quasi_linear(vehicle, pair, (None, weight), **given), modes, others)


def default_pair(vehicle):
    """S1002 on UIC60 at 1:40, gauge 1435 mm, on wheels of the vehicle's radius."""
    from railsym.contact_pair import ContactPair

    radii = {body.wheel_radius for body in vehicle.bodies if body.kind == "wheelset"}
    if len(radii) != 1:
        raise SimulationError(f"vehicle {vehicle.name!r} has {len(radii)} wheel radii; give the pair of profiles (ContactPair)")
    return ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435, wheel_radius=radii.pop())


def linear_reference(vehicle, pair, amplitude=AMPLITUDE, friction=None, load=None):
    """Linear contact of the pair at an amplitude (m), elastic with a load (N), and the critical speed with it (CriticalSpeeds of one number).

    Raises
    ------
    SimulationError
        No critical speed.
    """
    from railsym.critical_speed import critical_speed

    contact = pair.linear_contact(amplitude, load, **_given(friction))
    found = critical_speed(vehicle, contact=contact)
    if np.ma.getmaskarray(found.speed).any():
        raise SimulationError(f"{vehicle.name} on {pair.wheel.name}/{pair.rail.name} has no linear critical speed to serve as V0 ({found.message[0]}); "
                              "give V0 (reference=)")
    return contact, found


def variants(switch=SWITCH):
    """Switches beside one: amplitude and length halved, doubled and between, the other shapes, one rail only."""
    sizes = [replace(switch, amplitude=f * switch.amplitude) for f in (0.4, 0.6, 0.8, 1.2, 1.6)]
    lengths = [replace(switch, length=f * switch.length) for f in (0.6, 1.5, 2.0)]
    shapes = [replace(switch, shape=shape) for shape in ("half_sine", "blade", "smooth_step") if shape != switch.shape]
    return (*sizes, *lengths, *shapes, *(replace(switch, rails=rails) for rails in ("left", "right")))


def _threshold_or_why(vehicle, table, switch, V0, after, progress, more):
    try:
        return switch_threshold(vehicle, table, switch, reference=V0, after=after, progress=progress, **more)
    except SimulationError as error:
        return switch, str(error)


def _given(friction):
    return {} if friction is None else {"friction": friction}


def _checked(ratios):
    ratios = np.atleast_1d(np.asarray(ratios, dtype=float))
    if not ratios.size or not (np.isfinite(ratios) & (ratios > 0.0)).all():
        raise SimulationError(f"ratios {ratios}: speeds over V0, above 0, are needed, such as 0.85, 0.90")
    return ratios
