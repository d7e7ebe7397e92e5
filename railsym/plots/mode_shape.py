# SPDX-License-Identifier: BSD-3-Clause
"""Mode shapes: the vehicle from above or from the side, at rest and where the mode takes it."""

from __future__ import annotations

import numpy as np

from railsym.plots.outlines import outlines
from railsym.plots.style import BLUE, KMH, ORANGE, new_axes

_DRAWN = 0.14             # largest displacement drawn, of the vehicle's drawn width or height
_WEIGHT = {"car": 1.6, "frame": 1.3, "wheel": 1.2, "axle": 1.2, "axlebox": 0.9, "link": 1.0, "element": 0.7}
_FILLED = {"frame": 0.16, "wheel": 0.35, "axlebox": 0.3}
_LATER = ("car", "frame", "axle", "wheel")          # what is also drawn a quarter of a period later
_VERTICAL = ("z", "x")
_REST = "#b5b5b5"
_MARGIN = 1.2             # m, shown before and behind the wheelsets of a bogie
_APART = 4.5              # m, wheelsets farther apart belong to different bogies


def plot_mode_shape(mode, vehicle, *, view=None, speed=None, axes=None):
    """Draw a mode: the vehicle at rest, at the mode's largest displacement, and a quarter of a period later.

    Parameters
    ----------
    mode : railsym.modes.Mode
        Or anything with ``shape`` (mapping of coordinate name to complex amplitude), ``label``, ``frequency_hz`` and
        ``damping_ratio``.
    vehicle : Vehicle
        The vehicle that the mode belongs to.
    view : {"above", "side"}, optional
        From above (the vehicle travels to the right, its right side is at the bottom) or from its right side; by what moves
        if not given.
    speed : float, optional
        m/s, for the title.
    axes : matplotlib Axes, optional
        Without it a figure is made that also shows the running gear of each bogie enlarged.

    Returns
    -------
    matplotlib Axes
        That of the whole vehicle.

    Notes
    -----
    Displacements are magnified; lengths are to scale where the vehicle file gives them (see `railsym.plots.outlines`).
    """
    view = view or _best_view(mode.shape)
    drawn = outlines(vehicle, view)
    moves = [displacement(mode.shape, vehicle, outline) for outline in drawn]
    across = {"above": 1, "side": 2}[view]
    factor = _magnified_phase(drawn, moves, across)
    panels, windows = _panels(axes, vehicle, view)
    for panel, window in zip(panels, windows):
        _draw(panel, drawn, moves, across, factor, mode.frequency_hz > 0.0)
        _frame_panel(panel, vehicle, view, window)
    _annotate(panels, mode, view, speed)
    return panels[0]


def displacement(shape, vehicle, outline):
    """Complex displacement (k, 3) of the points of an outline for small motion: translation plus rotation times arm."""
    result = np.zeros(outline.points.shape, dtype=complex)
    for i, (point, attachment) in enumerate(zip(outline.points, outline.bodies)):
        name = attachment.partition(".")[0]
        if name == "track":
            continue
        turn = np.array([shape.get(key, 0.0) for key in (f"{name}.roll", f"{attachment}.pitch", f"{name}.yaw")])
        move = np.array([shape.get(f"{name}.{axis}", 0.0) for axis in "xyz"])
        result[i] = move + np.cross(turn, point - vehicle.body(name).position)
    return result


def _best_view(shape):
    size = {True: 0.0, False: 0.0}
    for name, amplitude in shape.items():
        dof = name.rpartition(".")[2]
        if dof in ("x", "y", "z"):
            size[dof in _VERTICAL] += abs(amplitude) ** 2
    return "side" if size[True] > size[False] else "above"


def _magnified_phase(drawn, moves, across):
    """Complex factor: magnification, and the phase at which the displacement is largest."""
    seen = [move[:, [0, across]] for move in moves]
    phase = np.exp(-0.5j * np.angle((np.concatenate(seen) ** 2).sum()))
    largest = max(np.linalg.norm((phase * move).real, axis=1).max() for move in seen)
    breadth = np.ptp(np.concatenate([outline.points[:, across] for outline in drawn]))
    return _DRAWN * breadth / largest * phase if largest else 0.0


def _panels(axes, vehicle, view):
    """Axes of the whole vehicle and of each bogie, and the range of x that each shows (None: all)."""
    places = sorted(b.position[0] for b in vehicle.bodies if b.kind == "wheelset")
    groups = np.split(places, np.flatnonzero(np.diff(places) > _APART) + 1)
    windows = [(group[0] - _MARGIN, group[-1] + _MARGIN) for group in groups]
    if axes is not None:
        return [new_axes(axes)[0, 0]], [None]
    if len(groups) == 1:
        return [new_axes(size=(6.4, 5.2) if view == "above" else (6.4, 4.2))[0, 0]], windows
    import matplotlib.pyplot as plt

    tall = view == "above"
    figure = plt.figure(figsize=(10.5, 5.8 if tall else 4.9), layout="constrained")
    grid = figure.add_gridspec(2, len(groups), height_ratios=[1.0, 2.2] if tall else [1.0, 1.5])
    below = [figure.add_subplot(grid[1, k]) for k in range(len(groups))]
    return [figure.add_subplot(grid[0, :]), *below], [None, *windows]


def _draw(axes, drawn, moves, across, factor, oscillates):
    for outline, move in zip(drawn, moves):
        at, weight = [0, across], _WEIGHT[outline.kind]
        axes.plot(*outline.points[:, at].T, color=_REST, linewidth=0.8 * weight, zorder=1)
        place = outline.points + (factor * move).real
        axes.plot(*place[:, at].T, color=BLUE, linewidth=weight, zorder=3)
        if outline.kind in _FILLED:
            axes.fill(*place[:, at].T, color=BLUE, alpha=_FILLED[outline.kind], linewidth=0.0, zorder=3)
        if oscillates and outline.kind in _LATER:
            later = outline.points + (1j * factor * move).real
            axes.plot(*later[:, at].T, color=ORANGE, linewidth=0.9 * weight, linestyle=(0, (4, 2)), zorder=2)


def _frame_panel(axes, vehicle, view, window):
    spacing = max(b.contact_half_spacing for b in vehicle.bodies if b.kind == "wheelset")
    for y in (-spacing, spacing) if view == "above" else (0.0,):
        axes.axhline(y, color="#e9e2d6", linewidth=3.0, zorder=0)
    axes.set_aspect("equal")
    axes.tick_params(labelsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.invert_yaxis()
    if window:
        axes.set_xlim(window)
        axes.set_ylim((1.75, -1.75) if view == "above" else (0.45, -1.9))


def _annotate(panels, mode, view, speed):
    first = panels[0]
    percent = round(100 * mode.damping_ratio, 1) + 0.0          # no minus sign before a zero
    at = f" at {KMH * speed:.4g} km/h" if speed else ""
    first.set_title(f"{mode.label}{at}: {mode.frequency_hz:.2f} Hz, damping ratio {percent:.1f} %",
                    loc="left", fontsize=11)
    for axes in panels:
        axes.set_ylabel("y, m (to the right)" if view == "above" else "z, m (down)", fontsize=9)
    for axes in panels[1:] or panels:
        axes.set_xlabel("x, m (direction of travel →)", fontsize=9)
    first.plot([], [], color=_REST, label="at rest")
    first.plot([], [], color=BLUE, label="largest displacement (magnified)")
    if mode.frequency_hz > 0.0:
        first.plot([], [], color=ORANGE, linestyle=(0, (4, 2)), label="a quarter of a period later")
    first.figure.legend(*first.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False, fontsize=9)
