# SPDX-License-Identifier: BSD-3-Clause
"""The stage of an animation: panels, outlines that move, rails and sleepers that pass by."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, VERMILION

_WEIGHT = {"car": 1.5, "frame": 1.2, "wheel": 1.1, "axle": 1.1, "axlebox": 0.8, "link": 0.8, "element": 0.6}
_COLOUR = {"car": "#555555", "frame": BLUE, "wheel": VERMILION, "axle": VERMILION, "axlebox": VERMILION, "link": "#777777", "element": "#999999"}
_FILLED = {"frame": 0.20, "wheel": 0.40, "axlebox": 0.30}
_MARGIN = 1.3                # m, shown before and behind
_SLEEPERS = 0.6              # m apart
_SLEEPER = 1.25              # m, half its drawn length
_RAIL, _PALE = "#8c8273", "#ece7de"
# m, a rail as it is drawn: half its width, and how far below its top (UIC 60)
_PROFILE = ((0.036, 0.0), (0.036, 0.040), (0.009, 0.055), (0.009, 0.135), (0.075, 0.160), (0.075, 0.172))
_NODES = 0.1                 # m, between drawn points of a rail


def new_scene(vehicle):
    """Figure, its three axes (whole vehicle and leading bogie from above, leading bogie from behind) and the line of text above."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.4, 5.0), dpi=90)
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 2.6], width_ratios=[1.35, 1.0], left=0.06, right=0.99, top=0.90, bottom=0.09, hspace=0.22,
                               wspace=0.14)
    whole, bogie, behind = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1])
    ends, leading = _extent(vehicle)
    _frame(whole, (ends[0] - _MARGIN, ends[1] + _MARGIN), (2.3, -2.3))
    _frame(bogie, (leading[0] - _MARGIN, leading[1] + _MARGIN), (1.9, -1.9))
    _frame(behind, (-2.2, 2.2), (0.30, -min(4.2, _top(vehicle) + 0.3)))
    bogie.set_xlabel("x, m (direction of travel →)", fontsize=8)
    behind.set_xlabel("y, m (leading bogie from behind)", fontsize=8)
    return figure, (whole, bogie, behind), figure.text(0.06, 0.94, "", fontsize=9.5, family="monospace")


def _extent(vehicle):
    """Ends of the vehicle, and of its leading group of wheelsets (m)."""
    from railsym.plots.outlines import outlines

    points = np.concatenate([outline.points[:, 0] for outline in outlines(vehicle, "above")])
    places = sorted(b.position[0] for b in vehicle.bodies if b.kind == "wheelset")
    leading = [x for x in places if places[-1] - x < 4.5]
    return (points.min(), points.max()), (leading[0], leading[-1])


def _top(vehicle):
    from railsym.plots.cross_section import cross_section

    return -min(outline.points[:, 2].min() for outline in cross_section(vehicle))


def _frame(axes, across, down):
    axes.set_xlim(across)
    axes.set_ylim(down)
    axes.set_aspect("equal")
    axes.tick_params(labelsize=7)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


class Panel:
    """Outlines of one view.

    Parameters
    ----------
    axes : matplotlib Axes
    drawn : list of Outline
    moves : list of ndarray (pictures, k, 3)
        m.
    plane : (int, int)
        Coordinates to the right and upwards of the page.
    factor : float
        Exaggeration.
    """

    def __init__(self, axes, drawn, moves, plane, factor):
        self.drawn, self.moves, self.plane, self.factor = drawn, moves, list(plane), factor
        self.lines, self.fills = [], {}
        for k, outline in enumerate(drawn):
            colour = _COLOUR[outline.kind]
            points = outline.points[:, self.plane]
            self.lines.append(axes.plot(*points.T, color=colour, linewidth=_WEIGHT[outline.kind], zorder=4)[0])
            if outline.kind in _FILLED:
                self.fills[k] = axes.fill(*points.T, color=colour, alpha=_FILLED[outline.kind], linewidth=0.0, zorder=3)[0]

    @property
    def artists(self):
        """What moves."""
        return [*self.lines, *self.fills.values()]

    def show(self, k):
        """Move everything to the k-th picture."""
        for number, (outline, move, line) in enumerate(zip(self.drawn, self.moves, self.lines)):
            points = (outline.points + self.factor * move[k])[:, self.plane]
            line.set_data(*points.T)
            if number in self.fills:
                self.fills[number].set_xy(points)


class PassingTrack:
    """Rails with their deviations, and sleepers that pass.

    Parameters
    ----------
    axes : (Axes, Axes, Axes)
        Two from above, one from behind.
    vehicle : Vehicle
    factor : float
        Exaggeration of the deviations.
    """

    def __init__(self, axes, vehicle, factor):
        *self.above, behind = axes
        wheelset = max((b for b in vehicle.bodies if b.kind == "wheelset"), key=lambda body: body.position[0])
        self.ahead, self.spacing, self.factor = wheelset.position[0], wheelset.contact_half_spacing, factor
        self.level = wheelset.position[2] + wheelset.wheel_radius
        self.rails = [[panel.plot([], [], color=_RAIL, linewidth=1.6, zorder=1)[0] for _ in range(2)] for panel in self.above]
        self.sleepers = [panel.plot([], [], color=_PALE, linewidth=2.2, zorder=0)[0] for panel in self.above]
        self.heads = [behind.fill([0.0], [0.0], color=_RAIL, linewidth=0.0, zorder=1)[0] for _ in range(2)]

    @property
    def artists(self):
        """What moves."""
        return [*(line for pair in self.rails for line in pair), *self.sleepers, *self.heads]

    def show(self, track, s):
        """Bring the track to the vehicle's place s (m)."""
        for panel, rails, sleepers in zip(self.above, self.rails, self.sleepers):
            x = np.arange(*panel.get_xlim(), _NODES)
            for line, side, deviation in zip(rails, (-1, 1), _deviations(track, s + x)):
                line.set_data(x, side * self.spacing + self.factor * deviation[0])
            low, high = panel.get_xlim()
            places = np.arange(np.ceil((s + low) / _SLEEPERS), np.floor((s + high) / _SLEEPERS) + 1) * _SLEEPERS - s
            ends = np.tile([-_SLEEPER, _SLEEPER, np.nan], len(places))
            sleepers.set_data(np.repeat(places, 3), ends)
        for head, side, deviation in zip(self.heads, (-1, 1), _deviations(track, np.array([s + self.ahead]))):
            middle = np.array([side * self.spacing + self.factor * deviation[0, 0], self.level + self.factor * deviation[1, 0]])
            head.set_xy(middle + [*_PROFILE, *((-y, z) for y, z in reversed(_PROFILE))])


def _deviations(track, s):
    """(y, z) of the left and of the right rail at places (n,), each (2, n) in m; zero where there is no track."""
    found = np.zeros((2, 2, len(s)))
    if track is None:
        return found
    inside = (s >= track.start) & (s <= track.length)
    rails = track.rails(s[inside])
    found[:, :, inside] = [[rails.left_y, rails.left_z], [rails.right_y, rails.right_z]]
    return found
