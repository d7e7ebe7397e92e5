# SPDX-License-Identifier: BSD-3-Clause
"""Drawing of a tilting mechanism, seen from behind: upright and tilted, with the centre that the body turns about."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, VERMILION, new_axes

_ROOF, _FLOOR, _RECESS, _HALF = -3.7, -1.1, -1.45, 1.4       # m: outline of a coach, open over the bolster, drawn for the eye
_RAIL = np.array([[-0.035, 0.0], [0.035, 0.0], [0.035, 0.05], [0.01, 0.06], [0.01, 0.13], [0.07, 0.15], [-0.07, 0.15], [-0.01, 0.13], [-0.01, 0.06],
                  [-0.035, 0.05], [-0.035, 0.0]])
_SPRING = 9                                    # coils drawn


def plot_tilt_linkage(vehicle, angle=None, *, axes=None, bolster="bolster1", **groups):
    """Cross-section at a tilting bolster: body, bolster, links, jacks and springs from the vehicle file, upright and tilted.

    Parameters
    ----------
    vehicle : Vehicle
    angle : float, optional
        rad, of the right picture; 8 degrees if not given.
    axes : Axes (2,), optional
    bolster : str
    groups
        ``links`` and ``jacks`` of `railsym.tilt_linkage.TiltLinkage`.

    Returns
    -------
    ndarray of Axes, shape (2,)
    """
    from railsym.tilt_linkage import TiltLinkage

    linkage = TiltLinkage(vehicle, bolster, **groups)
    angle = np.radians(8.0) if angle is None else float(angle)
    drawn = new_axes(axes, 1, 2, size=(9.4, 5.4), sharey=True)[0]
    for ax, at in zip(drawn, (0.0, angle), strict=True):
        _ground(ax, vehicle, bolster)
        _bolster(ax, vehicle, bolster, linkage)
        _body(ax, vehicle, linkage, at)
        _elements(ax, vehicle, bolster, linkage, at)
        _centres(ax, vehicle, linkage, at)
        ax.set_aspect("equal")
        ax.set_xlim(-1.9, 1.9)
        ax.set_ylim(4.15, -0.25)
        ax.set_yticks(np.arange(0.0, 4.1, 0.5))
        ax.invert_yaxis()
        ax.set_xlabel("to the right, m")
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
        ax.set_title("upright" if at == 0.0 else f"tilted by {np.degrees(at):.3g} degrees, as in a curve to the right", loc="left", fontsize=10)
    drawn[0].set_ylabel("above the rail, m")
    _legend(drawn[1])
    return drawn


def _line(ax, points, **style):
    """Points [y, z] (n, 2) with z down, drawn with heights upward."""
    points = np.asarray(points, dtype=float)
    return ax.plot(points[:, 0], -points[:, 1], **style)


def _ground(ax, vehicle, bolster):
    """Rails, wheels and the frame's beam of the bogie below the bolster."""
    at = vehicle.body(bolster).position[0]
    wheelset = min((b for b in vehicle.bodies if b.kind == "wheelset"), key=lambda b: abs(b.position[0] - at))
    r, b = wheelset.wheel_radius, wheelset.contact_half_spacing
    for side in (-1.0, 1.0):
        _line(ax, _RAIL + [side * b, 0.0], color=GREY, linewidth=1.0)
        _line(ax, [[side * (b - 0.07), 0.03], [side * (b - 0.07), -2.0 * r], [side * (b + 0.065), -2.0 * r], [side * (b + 0.065), 0.0], [side * (b - 0.04), 0.0],
                   [side * (b - 0.045), 0.03], [side * (b - 0.07), 0.03]], color=GREY, linewidth=1.0)
    _line(ax, [[-b - 0.3, -r], [b + 0.3, -r]], color=GREY, linewidth=1.0, linestyle=(0, (6, 2, 1.5, 2)))


def _springs(ax, vehicle, bolster):
    """Secondary springs: elements from another body to the bolster that carry weight, drawn as coils about their point."""
    for element in vehicle.elements:
        if element.type == "bushing" and element.second.body == bolster and np.all(element.parameters["stiffness"] > 0.0):
            y, z = element.second.position[1:]
            heights = np.linspace(z + 0.25, z - 0.25, 2 * _SPRING)
            _line(ax, np.column_stack([y + 0.11 * (-1.0) ** np.arange(2 * _SPRING), heights]), color=GREY, linewidth=1.1)
            _line(ax, [[y - 0.2, z + 0.25], [y + 0.2, z + 0.25]], color=GREY, linewidth=3.0)


def _bolster(ax, vehicle, bolster, linkage):
    """A beam from spring to spring, above the upper pivots."""
    _springs(ax, vehicle, bolster)
    top = -1.2
    ax.fill_between([-1.2, 1.2], -(top + 0.06), -(top - 0.04), color=PALE, zorder=1)
    ax.fill_betweenx([0.74, -(top)], -0.16, 0.16, color=PALE, zorder=1)


def _moved(linkage, points, angle):
    return np.asarray(points, dtype=float) + np.array([linkage.travel(p, angle) for p in points])


def _body(ax, vehicle, linkage, angle):
    """A coach's outline down to the tilting bolster."""
    half, low = _HALF, -0.64
    outline = [[-half, _FLOOR], [-half, -2.2], [-1.22, _ROOF + 0.35], [-0.9, _ROOF + 0.08], [0.0, _ROOF], [0.9, _ROOF + 0.08], [1.22, _ROOF + 0.35],
               [half, -2.2], [half, _FLOOR], [1.28, _FLOOR], [1.28, _RECESS], [-1.28, _RECESS], [-1.28, _FLOOR], [-half, _FLOOR]]
    _line(ax, _moved(linkage, outline, angle), color=BLUE, linewidth=1.6)
    beam = [[-half + 0.02, _FLOOR], [-half + 0.02, -1.0], [-1.42, low - 0.05], [-1.0, low], [1.0, low], [1.42, low - 0.05], [half - 0.02, -1.0], [half - 0.02, _FLOOR]]
    _line(ax, _moved(linkage, beam, angle), color=BLUE, linewidth=1.0, linestyle=(0, (4, 2)))


def _elements(ax, vehicle, bolster, linkage, angle):
    """Links and jacks between their places on bolster and body, and the lines of the links up to where they meet."""
    for element in vehicle.elements:
        if (element.first.body, element.second.body) != (bolster, linkage.body) or element.type not in ("traction_rod", "actuator"):
            continue
        first, second = element.first.position[1:], element.second.position[1:]
        second = second + linkage.travel(second, angle)
        link = element.type == "traction_rod"
        _line(ax, [first, second], color=VERMILION if link else GREEN, linewidth=3.0 if link else 4.0, marker="o", markersize=5, zorder=4,
              solid_capstyle="round")
        if link:
            meet = linkage.centre(angle) + [0.0, vehicle.body(linkage.body).position[2]]
            _line(ax, [first, meet], color=VERMILION, linewidth=0.8, linestyle=(0, (2, 3)), zorder=3)


def _centres(ax, vehicle, linkage, angle):
    """Centre of mass with its path, and the centre that the body turns about."""
    height = vehicle.body(linkage.body).position[2]
    path = linkage.shift(np.linspace(-abs(angle) or -np.radians(8.0), abs(angle) or np.radians(8.0), 41)) + [0.0, height]
    _line(ax, path, color=PURPLE, linewidth=1.0, zorder=5)
    _line(ax, [linkage.shift(angle) + [0.0, height]], color=PURPLE, marker="o", markersize=7, linestyle="none", zorder=6)
    _line(ax, [linkage.centre(angle) + [0.0, height]], color=ORANGE, marker="X", markersize=9, linestyle="none", zorder=6)


def _legend(ax):
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=VERMILION, linewidth=3.0, marker="o", label="swing links"), Line2D([], [], color=GREEN, linewidth=4.0, marker="o", label="jacks"),
             Line2D([], [], color=PALE, linewidth=8.0, label="bolster, on the secondary springs"),
             Line2D([], [], color=BLUE, linestyle=(0, (4, 2)), label="tilting bolster, of the body"),
             Line2D([], [], color=ORANGE, marker="X", markersize=9, linestyle="none", label="roll centre"),
             Line2D([], [], color=PURPLE, marker="o", markersize=7, label="centre of mass and its path")]
    ax.figure.legend(handles=lines, loc="outside lower center", ncols=3, fontsize=8.5, frameon=False)
