# SPDX-License-Identifier: BSD-3-Clause
"""What is recorded of a vehicle in a curve, and how channels of a run become arrays over wheels, wheelsets and contact patches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.simulation.channels import ZONES


@dataclass(frozen=True)
class Kind:
    """One quantity.

    Attributes
    ----------
    channel : str
        Last part of the channels' names.
    of : {"wheel", "wheelset", "patch"}
    unit, meaning : str
    """

    channel: str
    of: str
    unit: str
    meaning: str


KINDS = {
    "Y": Kind("Y", "wheel", "N", "lateral force of the wheel on the rail, + outwards for each wheel"),
    "Q": Kind("Q", "wheel", "N", "vertical force of the wheel on the rail"),
    "YQ": Kind("YQ", "wheel", "-", "Y/Q"),
    "sum_Y": Kind("sum_Y", "wheelset", "N", "lateral force of the wheelset on the track, + to the right"),
    "angle_of_attack": Kind("angle_of_attack", "wheelset", "rad", "yaw against the rails, + nose to the right"),
    "y": Kind("y", "wheelset", "m", "lateral shift of the wheelset, + to the right"),
    "t_gamma": Kind("t_gamma", "wheel", "N", "wear number |Fx xi| + |Fy eta| of all patches, energy per metre"),
    "dissipation": Kind("dissipation", "wheel", "N", "energy per metre that the contact takes, spin included"),
    "patch_t_gamma": Kind("t_gamma", "patch", "N", "wear number of each contact patch"),
    "patch_load": Kind("load", "patch", "N", "normal force of each contact patch"),
    "patch_angle": Kind("angle", "patch", "rad", "inclination of each contact patch"),
}


def channel_names(kind, wheelsets):
    """Channels of a kind: a list by wheel or wheelset; of patches a list a wheel."""
    if kind.of == "wheelset":
        return [f"{name}.{kind.channel}" for name in wheelsets]
    wheels = wheel_names(wheelsets)
    if kind.of == "wheel":
        return [f"{name}.{kind.channel}" for name in wheels]
    return [[f"{name}.zone{zone}.{kind.channel}" for zone in range(ZONES)] for name in wheels]


def wheel_names(wheelsets):
    """Wheels of the wheelsets, left before right."""
    return tuple(f"{name}.{side}" for name in wheelsets for side in ("left", "right"))


def all_channels(wheelsets):
    """Every channel that a study records."""
    found = []
    for kind in KINDS.values():
        for name in channel_names(kind, wheelsets):
            found += [name] if isinstance(name, str) else name
    return list(dict.fromkeys(found))


def shape_of(kind, wheelsets):
    """Shape of one case's array."""
    count = len(wheelsets)
    return {"wheelset": (count,), "wheel": (2 * count,), "patch": (2 * count, ZONES)}[kind.of]


def collected(kind, wheelsets, value_of):
    """Array of a kind from a function of a channel's name."""
    return np.array([value_of(name) if isinstance(name, str) else [value_of(one) for one in name] for name in channel_names(kind, wheelsets)])
