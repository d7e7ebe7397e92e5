# SPDX-License-Identifier: BSD-3-Clause
"""Keys of a track file: for each table the class that it makes, and its keys with unit or kind.

A kind is an SI unit (a number with a unit is written), ``"pair m"`` (two of them), ``"column m"`` (a list), ``"text"``, ``"whole"``
or ``"flag"``.
"""

from railsym.track.irregularity import MeasuredIrregularity, RandomIrregularity
from railsym.track.layers import RAILS, SIGNALS
from railsym.track.measured import COLUMNS, MeasuredGeometry
from railsym.track.sections import Curve, Gradient, Straight, Transition, VerticalCurve
from railsym.track.switch import Switch

SECTIONS = {
    "straight": (Straight, {"length": "m", "cant": "m"}),
    "curve": (Curve, {"radius": "m", "length": "m", "cant": "m", "direction": "text"}),
    "transition": (Transition, {"length": "m", "kind": "text", "cant_kind": "text", "end_radius": "m", "end_direction": "text", "end_cant": "m"}),
}
VERTICAL = {
    "gradient": (Gradient, {"length": "m", "gradient": "-"}),
    "vertical_curve": (VerticalCurve, {"radius": "m", "length": "m"}),
}
RANDOM = (RandomIrregularity, {"spectrum": "text", "seed": "whole", "wavelengths": "pair m", "start": "m", "length": "m", "fade": "m", "scale": "-",
                              "mirrored": "flag"})
MEASURED = (MeasuredIrregularity, {"name": "text", "s": "column m", **dict.fromkeys((*SIGNALS, *RAILS), "column m"), "fade": "m", "covers": "flag"})
IRREGULARITY_FILE = {"file": "text", "fade": "m", "covers": "flag"}
GEOMETRY = (MeasuredGeometry, {"name": "text", "interpolation": "text", **{name: f"column {unit}" for name, unit in COLUMNS.items()}})
GEOMETRY_FILE = {"file": "text", "smoothing": "m", "interpolation": "text", "chord": "m", "curve_positive": "text", "cant_positive": "text",
                 "largest_gap": "m"}
SWITCH = (Switch, {"start": "m", "length": "m", "amplitude": "m", "shape": "text", "rails": "text",
                   "crossing_start": "m", "crossing_length": "m", "crossing_depth": "m"})
TRACK = {"name": "text", "rounding": "m"}
NEEDED = {"straight": ("length",), "curve": ("radius", "length"), "transition": ("length",), "gradient": ("length", "gradient"), "vertical_curve": ()}
