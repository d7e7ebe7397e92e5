# SPDX-License-Identifier: BSD-3-Clause
"""Sections of a track that are evaluated by themselves: straight, or full curve; transitions belong to none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.limits import data

_STEP = 1.0                     # m, between places that are looked at
_SHARE, _NOISE = 0.05, 2e-5     # of the curvature, 1/m: what it may vary by within a section, assumed
_STRAIGHT = 1e-4                # 1/m: straighter than a radius of 10 km, assumed


@dataclass(frozen=True)
class TrackSection:
    """A stretch of even curvature.

    Attributes
    ----------
    start, end : float
        m
    radius : float
        m, above 0; inf on a straight.
    direction : {"right", "left", "straight"}
    cant : float
        m, of the outer rail (of the left one on a straight), mean.
    """

    start: float
    end: float
    radius: float
    direction: str
    cant: float


def track_sections(track, *, length=None, first=0.0, last=None):
    """Sections of straight and full curve along a track, for ``sections=`` of `derailment` and `percentile_analysis`.

    Parameters
    ----------
    track : railsym.track.Track
        Of sections or measured; within a section the curvature may vary by 5 % and 2e-5 1/m.
    length : float, optional
        m of each section; by radius as EN 14363 has it (recalled, R) if not given: 70 m below 400 m, 100 m up to 600 m, else 250 m.
    first, last : float
        m, the part of the track; all of it if not given.

    Returns
    -------
    tuple of TrackSection

    Raises
    ------
    CriterionError
        A part that is not on the track, no section that fits.
    """
    last = track.length if last is None else last
    if not 0.0 <= first < last <= track.length:
        raise CriterionError(f"sections from {first:g} to {last:g} m: the track runs from 0 to {track.length:.6g} m")
    if length is not None and not length >= 2.0 * _STEP:
        raise CriterionError(f"sections of {length!r} m: at least {2.0 * _STEP:g} m are needed")
    places = np.arange(first, last + 1e-9, _STEP)
    curvature, found, k = track.curvature(places), [], 0
    while k < len(places):
        count = int(round((section_length(curvature[k]) if length is None else length) / _STEP))
        part = curvature[k:k + count + 1]
        if len(part) > count and _even(part):
            found.append(_section(track, float(places[k]), float(places[k + count]), float(part.mean())))
            k += count
        else:
            k += 1
    if not found:
        raise CriterionError(f"no section of even curvature fits between {first:g} and {last:g} m; give a shorter length")
    return tuple(found)


def section_length(curvature):
    """Length (m) of a section of that curvature (1/m), recalled (R)."""
    entry = data("wheel_rail_forces")["limits"]["section_lengths"]
    radius = np.inf if abs(curvature) < _STRAIGHT else 1.0 / abs(curvature)
    return float(entry["lengths"][0][sum(radius >= bound for bound in entry["radii"][0])])


def _even(curvature):
    mean = curvature.mean()
    return np.abs(curvature - mean).max() <= _SHARE * abs(mean) * (abs(mean) >= _STRAIGHT) + _NOISE


def _section(track, start, end, curvature):
    cant = float(np.mean(track.cant(np.linspace(start, end, 11))))
    if abs(curvature) < _STRAIGHT:
        return TrackSection(start, end, np.inf, "straight", cant)
    side = 1.0 if curvature > 0.0 else -1.0
    return TrackSection(start, end, 1.0 / abs(curvature), "right" if side > 0.0 else "left", side * cant)
