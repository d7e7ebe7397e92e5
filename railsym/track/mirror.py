# SPDX-License-Identifier: BSD-3-Clause
"""A track with left and right exchanged."""

from dataclasses import replace

from railsym.track.irregularity import MeasuredIrregularity, RandomIrregularity
from railsym.track.layers import SIGNALS
from railsym.track.measured import MeasuredGeometry
from railsym.track.sections import Curve, Straight

_OTHER = {"left": "right", "right": "left", "both": "both"}
_SIGN = {"alignment": -1.0, "cant": -1.0, "vertical": 1.0, "gauge": 1.0}


def mirrored(track):
    """The mirror image of a track: exactly, to the last bit."""
    if isinstance(track.sections, MeasuredGeometry):
        geometry = track.sections
        sections = replace(geometry, curvature=-geometry.curvature, cant=None if geometry.cant is None else -geometry.cant)
    else:
        sections = [_section(part) for part in track.sections]
    switches = [replace(part, amplitude=-part.amplitude, rails=_OTHER[part.rails]) for part in track.switches]
    return replace(track, sections=sections, irregularities=[_irregularity(part) for part in track.irregularities], switches=switches)


def _section(part):
    if isinstance(part, Straight):
        return replace(part, cant=-part.cant)
    if isinstance(part, Curve):
        return replace(part, direction=_OTHER[part.direction])
    level = part.end_radius is None or part.end_radius == float("inf")
    return replace(part, end_direction=_OTHER[part.end_direction], end_cant=-part.end_cant if level else part.end_cant)


def _irregularity(part):
    if isinstance(part, RandomIrregularity):
        return replace(part, mirrored=not part.mirrored)
    changed = {}
    for name, values in part.columns().items():
        if name in SIGNALS:
            changed[name] = _SIGN[name] * values
        else:
            side, axis = name.split("_")
            changed[f"{_OTHER[side]}_{axis}"] = -values if axis == "y" else values
    return MeasuredIrregularity(part.s, **changed, fade=part.fade, covers=part.covers, name=part.name)
