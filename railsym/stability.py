# SPDX-License-Identifier: BSD-3-Clause
"""Where one linear model loses and regains stability as the speed rises, for several criteria in one scan.

A criterion is a damping ratio zeta: Re(lambda) + zeta |lambda| = 0; zeta = 0 asks for a real part of zero. With zeta = 0 every
mode counts. With zeta > 0 only lateral motions in a frequency band count, because hunting is looked for: a mode that lies below
zeta from the lowest speed on is named in the message and is no crossing, unless it goes on to become unstable.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from railsym.errors import ConvergenceError, ModelError
from railsym.linear_model import LinearModel
from railsym.mode_labels import MotionLabels
from railsym.speed_scan import FIRST_STEP, Crossing, SpeedScan, is_below, is_same, scan_speeds
from railsym.symmetry import Part, split

FREQUENCY_BAND = (0.3, 20.0)      # Hz, of hunting and of the car body on its suspension
# Hz: elastic modes up to here, or 1.25 times the upper end of the band, make the first reduced model. Hunting at 10 Hz is then
# within 1 % already; a scan that leaves anything open is repeated with twice the limit and half the step.
_BASIS, _LEAST_BASIS, _REPEATS = 1.25, 25.0, 3
_AHEAD = 0.05                     # in log(speed): how far a scan that ends early goes beyond the crossing that it ends for, at least
_NEAR = 0.01                      # crossings this near each other, relatively, may swap places when polished, at least
_LATERAL = 0.1                    # share of the kinetic energy in y, yaw and roll of a motion that takes part in hunting


@dataclass(frozen=True, eq=False)
class CriticalCrossing:
    """A mode crosses a criterion.

    Attributes
    ----------
    speed : float
        m/s.
    frequency_hz : float
        Hz.
    eigenvalue : complex
        1/s, on the criterion to rounding.
    criterion : float
        The damping ratio zeta that is crossed; 0 for real part = 0.
    direction : int
        +1 becomes unstable as the speed rises, -1 becomes stable.
    label : str
        What moves.
    right, left : ndarray, shape (n,)
        T x = 0 and y^H T = 0 with y^H (dT/dlambda) x = 1, in the coordinates of the model.
    slope : complex
        d(eigenvalue)/dV, 1/m.
    residual : float
        Largest of |T x| / (|T| |x|), row by row.
    """

    speed: float
    frequency_hz: float
    eigenvalue: complex
    criterion: float
    direction: int
    label: str
    right: np.ndarray = field(repr=False)
    left: np.ndarray = field(repr=False)
    slope: complex = field(repr=False)
    residual: float = field(repr=False)

    def __str__(self):
        what = "unstable" if self.direction > 0 else "stable"
        bound = f"damping ratio {100 * self.criterion:g} %" if self.criterion else "real part 0"
        return f"{what} at {self.speed:.4g} m/s ({self.label}, {self.frequency_hz:.3g} Hz, {bound})"


@dataclass(frozen=True, eq=False)
class Stability:
    """One model under one criterion.

    Attributes
    ----------
    speed, frequency_hz : float or None
        The lowest speed at which the vehicle becomes unstable (m/s), and the frequency there (Hz); None when it does not, or
        when it is unstable already at the lowest speed.
    crossings : tuple of CriticalCrossing
        Where the vehicle becomes unstable or stable, in the order of speed.
    message : str
        What was found.
    scanned_speeds, newton_steps : int
        At how many speeds the reduced eigenproblem was solved, and steps of Newton's method on the full one.
    damping_ratio : float
        The criterion.
    unstable_at_start : bool
        Unstable already at the lowest speed.
    """

    speed: float | None
    frequency_hz: float | None
    crossings: tuple[CriticalCrossing, ...]
    label: str
    message: str
    scanned_speeds: int
    newton_steps: int
    damping_ratio: float
    unstable_at_start: bool


def stability(model: LinearModel, damping_ratios: Sequence[float] = (0.0,), speed_range=(5.0, 250.0),
              frequency_band=FREQUENCY_BAND, all_modes: bool = False, lowest_only: bool = False) -> tuple[Stability, ...]:
    """Stability of a model over a range of speeds.

    Parameters
    ----------
    model : LinearModel
        The linear equations.
    damping_ratios : sequence of float
        Criteria zeta in [0, 1); 0 is real part = 0.
    speed_range : (float, float)
        m/s, above 0.
    frequency_band : (float, float)
        Hz; modes outside do not count where zeta > 0. While crossings are searched, elastic modes beyond 1.25 times its upper
        end (at least 25 Hz) are left out, so instabilities beyond are not seen; crossings are solved with all of them.
    all_modes : bool
        Also report modes that become unstable or stable while others are unstable.
    lowest_only : bool
        Report the critical speed alone: crossings beyond it are left out.

    Returns
    -------
    tuple of Stability
        One a criterion.

    Raises
    ------
    ModelError
        A range or a criterion that cannot be searched.
    """
    _check(damping_ratios, speed_range, frequency_band)
    ratios = tuple(dict.fromkeys((0.0,) + tuple(damping_ratios)))
    parts, labels = split(model), MotionLabels.of(model)
    limit = max(_BASIS * frequency_band[1], _LEAST_BASIS)
    settled = partial(_settled, labels, frequency_band) if lowest_only and len(damping_ratios) == 1 else None
    step = FIRST_STEP
    for _ in range(_REPEATS):
        lateral, others = _scan_parts(parts, ratios, speed_range, limit, step, settled, 0.0 in damping_ratios)
        searches = [_Search(z, [lateral] + (others if z == 0.0 else []), labels, frequency_band) for z in damping_ratios]
        results = tuple(search.result(speed_range, all_modes, lowest_only) for search in searches)
        if settled and not searches[0].stands(speed_range):
            settled = None
        elif not any(scan.warnings for _, scan in [lateral, *others]):
            break
        else:
            limit, step = 2.0 * limit, 0.5 * step
    return results


def _check(damping_ratios, speed_range, frequency_band):
    if not 0.0 < speed_range[0] < speed_range[1] < np.inf:
        raise ModelError(f"speed_range {tuple(speed_range)} m/s: two finite speeds above 0 in ascending order are needed")
    if not 0.0 <= frequency_band[0] < frequency_band[1] < np.inf:
        raise ModelError(f"frequency_band {tuple(frequency_band)} Hz: two finite frequencies in ascending order are needed")
    for z in damping_ratios:
        if not 0.0 <= z < 1.0:
            raise ModelError(f"damping_ratio {z}: a number from 0 up to, not including, 1 is needed; 5 % is 0.05")


def _scan_parts(parts, ratios, speed_range, limit, step, settled, all_parts):
    """Scan the part in which hunting lives for every criterion, the other one for real part = 0 where it could be unstable."""
    first, *rest = parts
    rest = [part for part in rest if all_parts and not is_dissipative(part.model)]
    scans = [(part, scan_speeds(part.model, asked, speed_range, limit, settled and partial(settled, part), step))
             for part, asked in [(first, ratios)] + [(part, (0.0,)) for part in rest]]
    return scans[0], scans[1:]


def _settled(labels, frequency_band, part, scan) -> bool:
    """Does an unfinished scan hold the critical speed of a part, whatever comes beyond its end?"""
    return _Search(scan.damping_ratios[-1], [(part, scan)], labels, frequency_band).settled


def is_dissipative(model: LinearModel) -> bool:
    """Is the model stable at every speed because it only stores and dissipates energy?

    K symmetric and positive semidefinite, C0 and C2 with positive semidefinite symmetric parts, C1 skew: then the energy
    q'^T M q' + q^T K q never grows (Thomson, Tait and Chetaev), internal coordinates included.
    """
    size = np.sqrt(np.maximum(np.abs(model.stiffness).max(axis=1), 1e-300))
    if (np.abs(model.stiffness - model.stiffness.T) > 1e-9 * size[:, None] * size).any():
        return False
    if (np.abs(model.damping_speed + model.damping_speed.T) > 1e-9 * np.abs(model.damping_speed).max()).any():
        return False
    return all(_is_semidefinite(matrix) for matrix in (model.stiffness, model.damping_constant, model.damping_inverse_speed))


def _is_semidefinite(matrix) -> bool:
    filled = np.flatnonzero(matrix.any(axis=0) | matrix.any(axis=1))
    if len(filled) < len(matrix):
        matrix = matrix[filled[:, None], filled]
    both = 0.5 * (matrix + matrix.T)
    scale = 1.0 / np.sqrt(np.where(both.diagonal() > 0, both.diagonal(), 1.0))
    both *= scale[:, None] * scale
    both.ravel()[::len(both) + 1] += 1e-9
    try:
        np.linalg.cholesky(both)
    except np.linalg.LinAlgError:
        return False
    return True


@dataclass(eq=False)
class _Event:
    """A crossing found by a scan, and its polished form when there is one."""

    found: Crossing
    part: Part
    scan: SpeedScan
    point: object = None

    @property
    def key(self):
        return id(self.scan), self.found.path

    @property
    def position(self):
        return self.found.position if self.point is None else float(np.log(self.point.speed))


class _Search:
    """Crossings of one criterion in the scans of the parts of one model."""

    def __init__(self, damping_ratio, scans, labels, frequency_band):
        self.damping_ratio, self.scans, self.labels, self.band = damping_ratio, scans, labels, frequency_band
        self.notes, self.open = [], 0       # paths below the criterion from the start that neither recover nor turn unstable
        self.events = [_Event(c, part, scan) for part, scan in scans for c in scan.crossings
                       if c.damping_ratio == damping_ratio and self._counts(part, scan, *c.nearest, c.eigenvalue)]
        self.unstable = self._unstable_at_start()

    def _counts(self, part, scan, node, mode, eigenvalue) -> bool:
        if self.damping_ratio == 0.0:
            return True
        if not self.band[0] <= eigenvalue.imag / (2 * np.pi) <= self.band[1]:
            return False
        return part.parity == -1 or self.labels.lateral_share(self._shape(part, scan, node, mode)) > _LATERAL

    @staticmethod
    def _shape(part, scan, node, mode):
        return part.expand(scan.reduction.expand(node.right(mode)))

    def _unstable_at_start(self):
        """Paths that count as unstable at the lowest speed; the others below the criterion are noted."""
        unstable = set()
        for part, scan in self.scans:
            start = scan.nodes[0]
            for path in np.flatnonzero(is_below(start.eigenvalue, self.damping_ratio)):
                eigenvalue = start.eigenvalue[path]
                if not self._counts(part, scan, start, path, eigenvalue):
                    continue
                name = f"{self.labels.label(eigenvalue, self._shape(part, scan, start, path), start.speed)}, " \
                       f"{eigenvalue.imag / (2 * np.pi):.3g} Hz"
                if self._starts_unstable(scan, int(path), name):
                    unstable.add((id(scan), int(path)))
            for value in start.divergent:
                unstable.add((id(scan), complex(value)))
                self.notes.append(f"a motion that does not oscillate grows at {value:.3g} 1/s at every speed: the suspension does "
                                  "not hold the vehicle up; check its stiffnesses")
        return unstable

    def _starts_unstable(self, scan, path, name) -> bool:
        own = [c for c in scan.crossings if c.path == path]
        recovers = next((c.position for c in own if c.damping_ratio == self.damping_ratio and c.direction < 0), np.inf)
        grows = next((c.position for c in own if c.damping_ratio == 0.0 and c.direction > 0), np.inf)
        low = scan.nodes[0].speed
        if self._grows_at_start(scan, path) or (self.damping_ratio > 0.0 and grows < recovers):
            self.notes.append(f"{name}: already {self._state()} at the lowest speed, {low:.4g} m/s")
            return True
        if self.damping_ratio > 0.0:
            self.open += bool(np.isinf(min(recovers, grows)))
            until = f"up to {np.exp(recovers):.4g} m/s" if np.isfinite(recovers) else "over the whole range"
            self.notes.append(f"{name}: {self._state()} {until}, not counted")
        return False

    @staticmethod
    def _grows_at_start(scan, path) -> bool:
        """Is the mode unstable at the lowest speed, on the full matrices?"""
        if not is_below(scan.nodes[0].eigenvalue[path], 0.0):
            return False
        try:
            return bool(is_below(scan.polish_start(path).eigenvalue, 0.0))
        except ConvergenceError:
            return True

    @property
    def settled(self) -> bool:
        """Would more of the range leave the critical speed as it is?

        Modes below the criterion from the start must have recovered or turned unstable: that tells whether they count.
        """
        reached = min(scan.nodes[-1].position for _, scan in self.scans) - _AHEAD
        return bool(self.unstable) or not self.open and any(e.found.direction > 0 and e.position < reached for e in self.events)

    def stands(self, speed_range) -> bool:
        """Do the scans go far enough beyond the critical speed, as it was polished, for nothing before it to be missed?"""
        ends = [scan.nodes[-1].position for _, scan in self.scans]
        onset = min((e.position for e in self.events if e.point is not None and e.found.direction > 0), default=np.inf)
        return bool(self.unstable) or all(end > min(np.log(speed_range[1]) - 1e-9, onset + self._swapping_distance()) for end in ends)

    def _state(self):
        return f"below {100 * self.damping_ratio:g} % damping" if self.damping_ratio else "unstable"

    def _polish(self, events):
        for event in events:
            if event.point is None:
                taken = [e.point for e in self.events if e.point is not None and e.scan is event.scan and e.key != event.key]
                event.point = event.scan.polish(event.found, taken)
        self.events = _without_repeats([e for e in self.events if e not in events or e.point is not None])

    def _transitions(self, lowest_only):
        """Events at which the vehicle becomes unstable or stable, with the unstable modes counted from below."""
        unstable, result = set(self.unstable), []
        for event in sorted(self.events, key=lambda e: e.position):
            before = len(unstable)
            if event.found.direction > 0:
                unstable.add(event.key)
            else:
                unstable.discard(event.key)
            if (before == 0) != (len(unstable) == 0):
                result.append(event)
        return result[:0 if self.unstable else 1] if lowest_only else result

    def result(self, speed_range, all_modes, lowest_only) -> Stability:
        """Polish what decides and report it."""
        if all_modes:
            self._polish(list(self.events))
        while True:
            chosen = self._transitions(lowest_only)
            near = self._swapping_distance()
            open_ = [e for e in self.events if e.point is None and any(abs(e.position - c.position) < near for c in chosen)]
            if not open_:
                break
            self._polish(open_)
        reported = sorted(self.events, key=lambda e: e.position) if all_modes else chosen
        crossings = tuple(self._crossing(e) for e in reported)
        return self._report(crossings, speed_range)

    def _swapping_distance(self):
        """Distance in log(speed) within which crossings may swap places when polished, from how far polishing moved some."""
        moved = [abs(e.found.position - e.position) for e in self.events if e.point is not None]
        return max(_NEAR, 3.0 * max(moved, default=0.0))

    def _crossing(self, event) -> CriticalCrossing:
        point, part = event.point, event.part
        right, left = part.expand(point.right), part.expand(point.left)
        label = self.labels.label(point.eigenvalue, right, point.speed)
        return CriticalCrossing(point.speed, point.eigenvalue.imag / (2 * np.pi), point.eigenvalue, self.damping_ratio,
                                event.found.direction, label, right, left, point.slope, point.residual)

    def _report(self, crossings, speed_range) -> Stability:
        notes = list(crossings) + self.notes + [w for _, scan in self.scans for w in scan.warnings]
        onset = next((c for c in crossings if c.direction > 0), None) if not self.unstable else None
        if not crossings and not self.unstable:
            notes.insert(0, f"no mode becomes {self._state()} between {speed_range[0]:g} and {speed_range[1]:g} m/s")
        steps = sum(e.point.steps for e in self.events if e.point is not None)
        nodes = sum(len(scan.nodes) for _, scan in self.scans)
        message = "; ".join(str(note) for note in dict.fromkeys(notes))
        common = (message, nodes, steps, self.damping_ratio, bool(self.unstable))
        if onset is None:
            return Stability(None, None, crossings, "", *common)
        return Stability(onset.speed, onset.frequency_hz, crossings, onset.label, *common)


def _without_repeats(events):
    """Drop events that were polished to one and the same crossing: one path, seen from two intervals."""
    kept = []
    for event in events:
        if event.point is None or not any(other.point is not None and is_same(other.point, event.point) for other in kept):
            kept.append(event)
    return kept
