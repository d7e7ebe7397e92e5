# SPDX-License-Identifier: BSD-3-Clause
"""From which speed on a crossing is unstable: speeds scanned, then halved between the last stable and the first unstable one."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.errors import SimulationError
from railsym.plots.style import KMH
from railsym.progress import followed
from railsym.studies.switch_run import cross

RATIOS = np.round(np.arange(0.70, 1.101, 0.05), 12)


@dataclass(frozen=True, eq=False)
class SwitchThreshold:
    """Where the verdict turns.

    Attributes
    ----------
    switch : railsym.track.Switch
    reference : float
        V0, m/s.
    ratio : float
        Middle of the bracket, V/V0; nan where the verdict does not turn within the speeds scanned.
    bracket : (float, float)
        V/V0, stable and unstable; the ends of the scan where it does not turn.
    tried : tuple of (float, bool, str)
        V/V0, unstable, and what becomes of the motion, ascending.
    """

    switch: object
    reference: float
    ratio: float
    bracket: tuple
    tried: tuple = field(repr=False)

    @property
    def monotone(self):
        """Whether every speed tried above the bracket is unstable."""
        return all(unstable for ratio, unstable, _ in self.tried if ratio >= self.bracket[1])

    @property
    def message(self):
        """In a sentence."""
        low, high = self.bracket
        if np.isnan(self.ratio):
            return f"{'unstable' if self.tried[0][1] else 'stable'} at all speeds from {low:.2f} to {high:.2f} V0"
        more = "" if self.monotone else "; stable again at " + ", ".join(f"{r:.2f}" for r, unstable, _ in self.tried if r > high and not unstable) + " V0"
        return (f"the verdict turns between {low:.3f} and {high:.3f} V0 ({KMH * low * self.reference:.1f} and "
                f"{KMH * high * self.reference:.1f} km/h){more}")


def switch_threshold(vehicle, contact, switch, *, reference, after, ratios=RATIOS, tolerance=0.005, progress=False, **options):
    """Find the speed at which the verdict on a crossing turns.

    Parameters
    ----------
    vehicle : Vehicle
    contact : ContactTable
    switch : railsym.track.Switch
    reference : float
        V0, m/s.
    after : float
        s of motion behind the switch.
    ratios : sequence of float
        V/V0 scanned first, ascending: the lowest one that is unstable counts.
    tolerance : float
        Width of the bracket in V/V0.
    progress : bool
    options
        Of `railsym.simulate`.

    Returns
    -------
    SwitchThreshold

    Raises
    ------
    SimulationError
        Ratios or a tolerance that make no sense.
    """
    ratios = np.asarray(ratios, dtype=float)
    if ratios.ndim != 1 or len(ratios) < 2 or not (ratios > 0.0).all() or (np.diff(ratios) <= 0.0).any():
        raise SimulationError(f"ratios {ratios}: at least two speeds over V0 above 0 in ascending order are needed")
    if not 0.0 < tolerance < 1.0:
        raise SimulationError(f"tolerance {tolerance!r}: a part of V0 between 0 and 1 is needed, such as 0.005")
    tried = {}

    def unstable(ratio):
        found = cross(vehicle, contact, switch, ratio * reference, reference=reference, after=after, **options)
        if found.unstable is None:
            raise SimulationError(f"no verdict at {ratio:.3f} V0 on this switch, because the run stopped: {found.run.message}")
        tried[float(ratio)] = (found.unstable, found.fate)
        return found.unstable

    verdicts = [unstable(ratio) for ratio in followed(ratios, len(ratios), "speeds", progress)]
    first = next((k for k, bad in enumerate(verdicts) if bad), None)
    bracket = (float(ratios[0]), float(ratios[-1]))
    if first:
        bracket = _halved(unstable, float(ratios[first - 1]), float(ratios[first]), tolerance)
    listed = tuple((ratio, *tried[ratio]) for ratio in sorted(tried))
    return SwitchThreshold(switch, float(reference), 0.5 * sum(bracket) if first else np.nan, bracket, listed)


def _halved(unstable, low, high, tolerance):
    while high - low > tolerance:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return low, high
