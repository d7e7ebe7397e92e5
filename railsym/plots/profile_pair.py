# SPDX-License-Identifier: BSD-3-Clause
"""Wheel and rail profiles with their contacts, rolling radius difference, contact angle and equivalent conicity over shift."""

from __future__ import annotations

from textwrap import fill

import numpy as np

from railsym.plots.style import BLACK, BLUE, GREY, PALE, VERMILION, tidy

_MM = 1e3
_APART = 0.010         # m, the wheel is drawn above its rail by this
_LABEL_EVERY = 1e-3    # m of shift between labelled contact lines
_TITLE_WIDTH = 130     # characters
_ROOM = 3.2            # mm, of a label
_STEEP = 80.0          # degrees, end of the angle's axis


def plot_profile_pair(pair, contact, conicities, *, title=""):
    """Draw what a pair of profiles does.

    Parameters
    ----------
    pair : railsym.contact_pair.ContactPair
    contact : railsym.contact_geometry.RigidContact
        Over the shifts to draw.
    conicities : sequence of railsym.conicity.Conicity
        Without and with roll, or one of them.
    title : str

    Returns
    -------
    ndarray of matplotlib Axes, shape (5,)
        Left and right profiles with contact lines, rolling radius difference, contact angle, conicity.
    """
    import matplotlib.pyplot as plt

    _, named = plt.subplot_mosaic([["left"] * 3 + ["right"] * 3, ["difference"] * 2 + ["angle"] * 2 + ["conicity"] * 2], figsize=(11.0, 6.9),
                                  layout="constrained", height_ratios=[0.85, 1.0])
    _draw_side(named["left"], pair, contact, 0)
    _draw_side(named["right"], pair, contact, 1)
    _draw_difference(named["difference"], contact, conicities)
    _draw_angle(named["angle"], contact)
    _draw_conicity(named["conicity"], conicities)
    if title:
        named["left"].figure.suptitle(fill(title, _TITLE_WIDTH), fontsize=11, x=0.01, ha="left")
    return np.array(list(named.values()), dtype=object)


def _draw_side(axes, pair, contact, which):
    """Profiles of one side in track coordinates, the wheel raised, and lines between the points that touch."""
    side, sign = pair.sides[which], (-1.0, 1.0)[which]
    found = (contact.left, contact.right)[which]
    across = lambda y: sign * _MM * y  # noqa: E731
    axes.plot(across(side.wheel_outline[0]), _MM * (side.wheel_outline[1] - side.radius - _APART), color=BLACK, linewidth=1.6)
    axes.plot(across(side.rail_outline[0]), _MM * side.rail_outline[1], color=BLACK, linewidth=1.6)
    ends = np.column_stack([found.wheel_y + side.tape_circle, found.rail_y + side.rail_offset])
    heights = np.column_stack([side.wheel.z(ends[:, 0]) - side.radius - _APART, side.rail.z(ends[:, 1])])
    _draw_lines(axes, contact.y, across(ends), _MM * heights)
    axes.set_ylim(30.0, -20.0)
    axes.set_xlim(*sorted((across(side.tape_circle - 0.072), across(side.tape_circle + 0.048))))
    axes.set_aspect("equal", adjustable="box")
    tidy(axes, "y, mm", "z, mm (down)", f"{side.name}: {(pair.wheel_left, pair.wheel)[which].name}, contact by lateral shift in mm")


def _draw_lines(axes, shifts, place, height):
    """A line every quarter of a millimetre of shift; those of whole millimetres coloured, and labelled where there is room."""
    taken = []
    for k in np.argsort(np.abs(shifts)):
        y = shifts[k]
        if abs(4e3 * y - round(4e3 * y)) > 1e-6:
            continue
        whole = abs(y / _LABEL_EVERY - round(y / _LABEL_EVERY)) < 1e-6
        colour = VERMILION if y > 0 else BLUE if y < 0 else BLACK
        axes.plot(place[k], height[k], color=colour if whole else PALE, linewidth=1.0 if whole else 0.7, zorder=3 if whole else 2)
        if whole and all(abs(place[k, 0] - other) > _ROOM for other in taken):
            taken.append(place[k, 0])
            axes.annotate(f"{_MM * y:.0f}", (place[k, 0], height[k, 0]), (0, 3), textcoords="offset points", ha="center", fontsize=7, color=colour)


def _draw_difference(axes, contact, conicities):
    for found in conicities:
        colour, dashes = _style(found)
        axes.plot(_MM * found.y, _MM * found.rolling_radius_difference, color=colour, linestyle=dashes, linewidth=1.4, label=_how(found))
    shown = np.concatenate([f.rolling_radius_difference[np.abs(f.y) <= contact.y[-1]] for f in conicities])
    axes.set_xlim(_MM * contact.y[0], _MM * contact.y[-1])
    axes.set_ylim(*(_MM * (shown.min() + np.ptp(shown) * np.array([-0.05, 1.05]))))
    axes.legend(fontsize=8, frameon=False)
    tidy(axes, "lateral shift y, mm", "mm", "rolling radius, right minus left")


def _draw_angle(axes, contact):
    for found, name, colour, dashes in ((contact.left, "left", BLUE, "--"), (contact.right, "right", VERMILION, "-")):
        axes.plot(_MM * contact.y, np.degrees(found.contact_angle), color=colour, linestyle=dashes, linewidth=1.4, label=name)
    axes.set_ylim(min(-2.0, axes.get_ylim()[0]), min(_STEEP, axes.get_ylim()[1]))
    axes.set_xlim(_MM * contact.y[0], _MM * contact.y[-1])
    axes.legend(fontsize=8, frameon=False)
    tidy(axes, "lateral shift y, mm", "degrees", "contact angle")


def _draw_conicity(axes, conicities):
    for found in conicities:
        colour, dashes = _style(found)
        axes.plot(_MM * found.amplitude, found.conicity, color=colour, linestyle=dashes, linewidth=1.4, label=_how(found))
        at = 3e-3
        if not found.with_roll and found.load is None and found.amplitude[0] <= at <= found.amplitude[-1]:
            value = float(np.interp(at, found.amplitude, found.conicity))
            axes.plot([_MM * at], [value], "o", color=colour, markersize=4.5)
            low = value < 0.15 * np.nanmax(found.conicity)       # below it there would be no room
            axes.annotate(f"{value:.3f} at 3 mm", (_MM * at, value), (-4, 8) if low else (0, -16), textcoords="offset points", fontsize=8,
                          color=GREY, ha="right" if low else "center")
    axes.set_ylim(bottom=0.0 if not any((f.conicity < 0.0).any() for f in conicities) else None)
    axes.legend(fontsize=8, frameon=False)
    tidy(axes, "amplitude, mm", "tan $\\gamma_e$", "equivalent conicity (EN 15302)")


def _style(found):
    return (VERMILION, ":") if found.load is not None else (BLUE, "--") if found.with_roll else (BLACK, "-")


def _how(found):
    if found.load is not None:
        return f"elastic, {found.load / 1e3:g} kN"
    return "with roll" if found.with_roll else "without roll"
