# SPDX-License-Identifier: BSD-3-Clause
"""Mean and continuous comfort after EN 12299: weighted r.m.s. accelerations in blocks of 5 s."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data, limits, scale_class
from railsym.criteria.source import gather
from railsym.criteria.weighting import weighted
from railsym.results.run import Run

_WEIGHTS = {"x": "Wd", "y": "Wd", "z": "Wb"}


@dataclass(frozen=True, eq=False)
class Comfort:
    """Comfort at one place of the floor.

    Attributes
    ----------
    place : str
    continuous : dict of str to ndarray (m,)
        Weighted r.m.s. of each whole block of 5 s by axis ("x", "y", "z"), m/s^2: CCx, CCy, CCz.
    percentile : dict of str to float
        95th percentile of the blocks by axis, m/s^2.
    N_MV : float or None
        Mean comfort, standard method; None unless all three axes are there.
    partial : float
        6 sqrt(sum of squares) of the axes that are there.
    start : ndarray (m,)
        Start of each block, s.
    notes : tuple of str
    """

    place: str
    continuous: dict
    percentile: dict
    N_MV: float | None
    partial: float
    start: np.ndarray = field(repr=False)
    notes: tuple = ()

    @property
    def message(self):
        """Values, classes and notes."""
        name = "N_MV" if self.N_MV is not None else f"6 sqrt(sum of squares) of {' and '.join(self.percentile)}"
        shown = "" if self.N_MV is None else f", {scale_class('N_MV', self.N_MV)}"
        parts = [f"{self.place}: {name} = {self.partial:.3g}{shown}"]
        for axis, value in self.percentile.items():
            scale = f"CC{axis}"
            rank = f", {scale_class(scale, value)}" if scale in data("comfort")["scales"] else ""
            parts.append(f"  {scale} 95 %: {value:.3f} m/s^2 ({_WEIGHTS[axis]}){rank}")
        return "\n".join([*parts, *(f"  {note}" for note in self.notes)])

    def __str__(self):
        return self.message


def comfort(source, signal=None, *, place=None, weights=None):
    """Comfort after EN 12299 from the accelerations of the floor.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s, at 200 Hz or more.
    signal : dict of str to array_like (n,), optional
        m/s^2 by axis, ``{"x": ..., "y": ..., "z": ...}``, when ``source`` is time.
    place : str, optional
        Marker of the run whose ``.ax``, ``.ay``, ``.az`` are taken, such as ``"car"``.
    weights : dict of str to str, optional
        Weighting by axis; Wd for x and y, Wb for z if not given.

    Returns
    -------
    Comfort

    Raises
    ------
    CriterionError
        Less than 5 s, sampled below 200 Hz, no acceleration, not finite.
    """
    found = _accelerations(source, signal, place)
    block, expected = limits("block").value, int(limits("blocks").value)
    size = int(round(block * found.rate))
    count = found.time.size // size
    if not count:
        raise CriterionError(f"a block of comfort needs {block:g} s; the signal is {found.time.size * found.step:.4g} s long")
    weights = _WEIGHTS | (weights or {})
    continuous = {}
    for axis, value in found.values.items():
        rows = weighted(value, found.rate, weights[axis])[:count * size].reshape(count, size)
        continuous[axis] = np.sqrt(np.mean(rows ** 2, axis=1))
    percentile = {axis: float(np.percentile(rms, limits("percentile").value)) for axis, rms in continuous.items()}
    total = limits("mean_factor").value * float(np.sqrt(sum(value ** 2 for value in percentile.values())))
    notes = [] if count >= expected else [f"{count} blocks of 5 s; a test has {expected} (5 minutes), so the 95th percentile is near the largest"]
    missing = [axis for axis in "xyz" if axis not in continuous]
    if missing:
        notes.append(f"no acceleration along {', '.join(missing)}, so this is not N_MV")
    return Comfort(place or "floor", continuous, percentile, None if missing else total, total, found.time[:count * size:size], tuple(notes))


def _accelerations(source, signal, place):
    if isinstance(source, Run):
        names = [name for name in (f"{place}.a{axis}" for axis in "xyz") if name in source]
        if not names:
            markers = sorted({name[:-3] for name in source.channels.match("*.ax", "*.ay", "*.az")})
            raise CriterionError(f"place {place!r} has no acceleration .ax, .ay or .az; markers that have: {', '.join(markers) or 'none'}")
        found = gather(source, signal, names, "m/s^2")
        values = {name[-1]: value for name, value in found.values.items()}
        return type(found)(found.time, found.step, found.distance, values)
    if not isinstance(signal, dict) or not signal or set(signal) - set("xyz"):
        raise CriterionError('accelerations by axis are needed: comfort(time, {"x": ax, "y": ay, "z": az}), m/s^2')
    return gather(source, signal, (), "m/s^2")
