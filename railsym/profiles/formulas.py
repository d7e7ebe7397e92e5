# SPDX-License-Identifier: BSD-3-Clause
"""Profiles from zones: polynomials, arcs and segments, one after the other along y.

A zone is a mapping with ``type``, ``from`` and ``to`` (y, mm) and

    polynomial   z = sum c_k y^k                 coefficients
    arc          z = z0 +- sqrt(R^2 - (y-y0)^2)  centre [y0, z0], radius, bulge "down" (+) or "up" (-)
    segment      the straight line between       start [y, z], end [y, z]      (no from, to)

in mm, z down (`railsym.profiles`). Every zone is sampled along its own arc, so that angle and curvature are those of the formula.
"""

from __future__ import annotations

import numpy as np

from railsym.profiles.checks import ProfileError
from railsym.profiles.profile import Profile

STEP = 0.05          # mm along the arc: a sagitta of 2e-5 mm on the smallest radius used (13 mm)
_GAP = 2e-3          # mm: tables are printed to 1e-3 and 1e-4 mm, which shows at the ends of zones
_MM = 1e-3


def profile_from_zones(name, kind, zones, *, mirrored=False, description="", origin="", inclined=False, step=STEP):
    """Build a profile from its zones.

    Parameters
    ----------
    name : str
    kind : {"wheel", "rail"}
    zones : sequence of mapping
        In order of y; lengths in mm.
    mirrored : bool
        The zones are the half y >= 0 of a symmetric profile.
    description, origin : str
    inclined : bool
    step : float
        Distance of nodes along the arc, mm.

    Returns
    -------
    Profile

    Raises
    ------
    ProfileError
        For an unknown zone, or zones that do not meet.
    """
    if not isinstance(zones, (list, tuple)) or not zones or not all(isinstance(zone, dict) for zone in zones):
        raise ProfileError(f"profile {name!r}: zones must be a list of tables [[zones]], at least one")
    parts = [_sampled(name, number, zone, step) for number, zone in enumerate(zones, start=1)]
    if mirrored:
        parts = [(-y[::-1], z[::-1], -angle[::-1], turn[::-1]) for y, z, angle, turn in parts[::-1]] + parts
    y, z, angle, turn = _joined(name, parts)
    sign = -1.0 if kind == "wheel" else 1.0      # the wheel's body is above its curve, the rail's below
    chord = np.hypot(np.diff(y), np.diff(z))
    bend = 0.5 * np.diff(angle)
    # arc over chord of a circular arc; where two zones meet at an angle, a chord is its own arc
    arc = np.where(np.abs(bend) < 0.1, chord / np.sinc(bend / np.pi), chord)
    return Profile(name=name, kind=kind, y=y * _MM, z=z * _MM, angle=angle, curvature=sign * turn / _MM,
                   arc_length=_MM * np.concatenate([[0.0], np.cumsum(arc)]), description=description, origin=origin, inclined=inclined)


def _joined(name, parts):
    """Zones one after the other; of the two nodes at a junction the first stays."""
    result = [parts[0]]
    for number, (before, after) in enumerate(zip(parts, parts[1:]), start=1):
        gap = np.hypot(after[0][0] - before[0][-1], after[1][0] - before[1][-1])
        if not gap <= _GAP:
            raise ProfileError(f"profile {name!r}: zones {number} and {number + 1} are {gap:.4f} mm apart where they should meet "
                               f"(y = {before[0][-1]:.4f} mm); at most {_GAP} mm")
        result.append(tuple(array[1:] for array in after))
    return tuple(np.concatenate(arrays) for arrays in zip(*result))


def _sampled(name, number, zone, step):
    """Nodes of one zone: y, z (mm), angle (rad), turn = d angle/d arc (1/mm)."""
    samplers = {"polynomial": _polynomial, "arc": _arc, "segment": _segment}
    kind = zone.get("type")
    if kind not in samplers:
        raise ProfileError(f"profile {name!r}, zone {number}: type is {kind!r}; it must be one of {', '.join(samplers)}")
    try:
        return samplers[kind](zone, step)
    except KeyError as error:
        raise ProfileError(f"profile {name!r}, zone {number} ({kind}): {error.args[0]!r} is missing") from None
    except (ValueError, TypeError) as error:
        raise ProfileError(f"profile {name!r}, zone {number} ({kind}): {error}") from None


def _polynomial(zone, step):
    polynomial = np.polynomial.Polynomial(zone["coefficients"])
    first, second = polynomial.deriv(1), polynomial.deriv(2)
    fine = np.linspace(zone["from"], zone["to"], 4001)
    speed = np.sqrt(1.0 + first(fine) ** 2)
    arc = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    y = np.interp(np.linspace(0.0, arc[-1], _count(arc[-1], step)), arc, fine)
    y[0], y[-1] = zone["from"], zone["to"]
    return y, polynomial(y), np.arctan(first(y)), second(y) / (1.0 + first(y) ** 2) ** 1.5


def _arc(zone, step):
    (y0, z0), radius = zone["centre"], zone["radius"]
    if zone["bulge"] not in ("down", "up"):
        raise ValueError(f"bulge is {zone['bulge']!r}; it must be 'down' or 'up'")
    sine = (np.array([zone["from"], zone["to"]]) - y0) / radius
    if (np.abs(sine) > 1.0 + 1e-6).any():
        raise ValueError(f"from {zone['from']} to {zone['to']} mm reaches beyond the circle of radius {radius} mm about y = {y0} mm")
    ends = np.arcsin(np.clip(sine, -1.0, 1.0))
    t = np.linspace(*ends, _count(radius * (ends[1] - ends[0]), step))
    sign = 1.0 if zone["bulge"] == "down" else -1.0
    return y0 + radius * np.sin(t), z0 + sign * radius * np.cos(t), -sign * t, np.full(len(t), -sign / radius)


def _segment(zone, step):
    start, end = np.array(zone["start"], dtype=float), np.array(zone["end"], dtype=float)
    t = np.linspace(0.0, 1.0, _count(np.hypot(*(end - start)), step))[:, None]
    y, z = ((1.0 - t) * start + t * end).T
    return y, z, np.full(len(y), np.arctan2(*(end - start)[::-1])), np.zeros(len(y))


def _count(length, step):
    if not length > 0.0:
        raise ValueError(f"its length is {length} mm; 'to' must be greater than 'from'")
    return max(3, int(np.ceil(length / step)) + 1)
