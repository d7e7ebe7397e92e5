# SPDX-License-Identifier: BSD-3-Clause
"""The tilting section from behind as a moving picture: cant, bogie, bolster and body as they lie in space, passive beside active."""

from __future__ import annotations

import numpy as np

from railsym.errors import SimulationError
from railsym.plots.animation import Animation, check_path, write_shots
from railsym.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, VERMILION
from railsym.topology import body_coordinates

_PER_SECOND = 16
_HALF_BODY, _ROOF, _UNDER = 1.42, -3.75, -0.95        # m, drawn outline of the body
_RAIL = ((0.036, 0.0), (0.036, 0.040), (0.009, 0.055), (0.009, 0.135), (0.075, 0.160), (0.075, 0.172))
_ARROW = 0.6                                          # m drawn for 1 m/s^2


def tilt_channels(vehicle):
    """Channels that `animate_tilt` needs beside those of the study."""
    from railsym.studies.tilt_case import channels
    from railsym.tilt.drive import TiltDrive
    from railsym.tilt.plant import leading_frame

    frame, bolster = leading_frame(vehicle), TiltDrive.of(vehicle).bolsters[0]
    wheelset = _wheelset(vehicle)
    wanted = [f"{name}.{word}" for name in (frame, bolster, wheelset.name) for word in ("y", "z", "roll")] + ["car.x", "car.y", "car.z", "car.pitch", "car.yaw"]
    known = {name for body in vehicle.bodies for name in body_coordinates(body)}
    return [name for name in wanted if name in known and name not in channels(TiltDrive.of(vehicle), frame)]


def animate_tilt(study, path, *, frames=120, progress=False):
    """Write the leading section of a tilting study as GIF or MP4: the passive run on the left, the active one on the right.

    Parameters
    ----------
    study : railsym.studies.TiltStudy
        Made with ``channels=tilt_channels(vehicle)``.
    path : str or path
        .gif or .mp4.
    frames : int
        Pictures, spread over the run.
    progress : bool

    Returns
    -------
    railsym.plots.animation.Animation

    Raises
    ------
    SimulationError
        Missing channels, a format that cannot be written.
    """
    path = check_path(path)
    if not 2 <= frames <= 2000:
        raise SimulationError(f"animation: {frames} pictures; from 2 to 2000 can be drawn")
    cases = [study["passive"], study["active"]]
    missing = [name for name in tilt_channels(study.scene.vehicle) if name not in cases[0].run]
    if missing:
        raise SimulationError(f"animation: the runs lack {missing[0]}; give tilt_study channels=tilt_channels(vehicle)")
    last = min(case.run.time[-1] for case in cases)
    times = np.linspace(0.0, last, frames)
    stage = _Stage(study, cases, times)
    write_shots((stage.pixels(k) for k in range(frames)), frames, path, progress)
    stage.close()
    return Animation(path, frames, 1.0, (frames - 1) / _PER_SECOND / last, 0.0, float(last), path.stat().st_size)


def _wheelset(vehicle):
    return max((body for body in vehicle.bodies if body.kind == "wheelset"), key=lambda body: body.position[0])


def _turned(points, angle, middle=(0.0, 0.0)):
    """Points (n, 2) of y, z turned by an angle (rad, right side down) about a point."""
    c, s = np.cos(angle), np.sin(angle)
    return (points - middle) @ np.array([[c, s], [-s, c]]) + middle


class _Stage:
    """The figure and what moves in it."""

    def __init__(self, study, cases, times):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.study, self.times = study, times
        self.figure = Figure(figsize=(8.6, 6.0), dpi=80)
        FigureCanvasAgg(self.figure)
        grid = self.figure.add_gridspec(2, 2, height_ratios=[3.1, 1.0], left=0.07, right=0.98, top=0.90, bottom=0.09, hspace=0.2, wspace=0.08)
        self.sections = [_Section(self.figure.add_subplot(grid[0, k]), study, case, times) for k, case in enumerate(cases)]
        self.strip = self.figure.add_subplot(grid[1, :])
        self._draw_strip(cases)
        self.title = self.figure.text(0.07, 0.95, "", fontsize=10, family="monospace")

    def _draw_strip(self, cases):
        from railsym.plots.style import tidy

        for case, colour in zip(cases, (BLACK, VERMILION)):
            self.strip.plot(case.run["s"], case.run["front.ay"], color=colour, linewidth=1.0, label=f"{case.name}, m/s²")
        self.strip.plot(cases[1].run["s"], np.degrees(cases[1].tilt) / 4.0, color=BLUE, linewidth=1.0, linestyle="--", label="tilt, 4 deg")
        tidy(self.strip, "s, m", "")
        self.strip.legend(fontsize=7, frameon=False, loc="upper right", ncols=3)
        self.now = self.strip.axvline(0.0, color=GREEN, linewidth=1.2)

    def pixels(self, k):
        """The k-th picture, (height, width, 4) bytes."""
        case = self.sections[1].case
        s = float(np.interp(self.times[k], case.run.time, case.run["s"]))
        for section in self.sections:
            section.show(k)
        self.now.set_xdata([s, s])
        V = float(np.interp(self.times[k], case.run.time, case.run["V"]))
        self.title.set_text(f"t = {self.times[k]:5.2f} s   s = {s:6.1f} m   {3.6 * V:.0f} km/h   seen from behind; bar: pull on a passenger")
        self.figure.canvas.draw()
        return np.asarray(self.figure.canvas.buffer_rgba()).copy()

    def close(self):
        """Let the figure go."""
        self.figure.clear()


class _Section:
    """One vehicle's leading section."""

    def __init__(self, axes, study, case, times):
        scene = study.scene
        self.case, self.axes, self.track = case, axes, scene.track
        self.bolster, self.car, self.frame = scene.drive.bolsters[0], scene.drive.car, scene.frame
        self.wheelset = _wheelset(scene.vehicle)
        self.at = {name: scene.vehicle.body(name).position for name in (self.bolster, self.car, self.frame, self.wheelset.name)}
        bolster_x = self.at[self.bolster][0]
        names = [f"{body}.{word}" for body in self.at for word in ("y", "z", "roll")] + ["s", "front.ay"]
        run = case.run
        self.values = {name: np.interp(times, run.time, run[name]) for name in names if name in run}
        place = np.clip(self.values["s"] + bolster_x, scene.track.start, scene.track.length)
        self.cant = np.arcsin(scene.track.alignment.cant(place))
        middle = np.clip(self.values["s"], scene.track.start, scene.track.length)
        self.car_turn = np.arcsin(scene.track.alignment.cant(middle)) - self.cant
        self.tilt = np.interp(times, run.time, case.tilt)
        self.links = [e for e in scene.vehicle.elements if e.type in ("traction_rod", "actuator") and {e.first.body, e.second.body} == {self.car, self.bolster}]
        self._draw()

    def _draw(self):
        axes = self.axes
        axes.set_xlim(-2.4, 2.4)
        axes.set_ylim(0.75, -4.25)
        axes.set_aspect("equal")
        axes.axis("off")
        self.shapes = {name: axes.fill([0.0], [0.0], facecolor=face, edgecolor=edge, linewidth=1.2, zorder=order)[0]
                       for name, face, edge, order in (("bed", "#ece7de", "none", 0), ("rail_left", "#8c8273", "none", 1), ("rail_right", "#8c8273", "none", 1),
                                                       ("wheel_left", PALE, GREY, 2), ("wheel_right", PALE, GREY, 2), ("axle", PALE, GREY, 2),
                                                       ("frame", "#c9dcea", BLUE, 3), ("bolster", "#f4d9a8", ORANGE, 4), ("body", "none", BLACK, 5))}
        self.lines = [axes.plot([], [], color=VERMILION if e.type == "actuator" else "#555555", linewidth=3.0 if e.type == "actuator" else 1.6, zorder=6)[0]
                      for e in self.links]
        self.floor = axes.plot([], [], color=GREY, linewidth=1.0, zorder=5)[0]
        self.arrow = axes.plot([], [], color=GREEN, linewidth=3.5, zorder=7, solid_capstyle="butt")[0]
        self.head = axes.plot([], [], marker="o", color=GREEN, markersize=6, zorder=7)[0]
        axes.plot([0.0, 0.0], [-4.1, 0.6], color=PALE, linewidth=0.7, linestyle=":", zorder=0)
        self.text = axes.text(0.0, -4.25, "", ha="center", fontsize=9)

    def _placed(self, body, points, k, extra=0.0):
        """Points (n, 2) of a body in vehicle coordinates where they lie in space in the k-th picture."""
        at = self.at[body][1:]
        y, z, roll = (self.values.get(f"{body}.{word}", np.zeros_like(self.cant))[k] for word in ("y", "z", "roll"))
        moved = _turned(np.asarray(points, dtype=float) - at, roll + extra) + at + [y, z]
        return _turned(moved, self.cant[k])

    def show(self, k):
        """Bring everything to the k-th picture."""
        spacing, radius = self.wheelset.contact_half_spacing, self.wheelset.wheel_radius
        extra = float(self.car_turn[k])
        still = {"bed": [(-1.35, 0.172), (1.35, 0.172), (1.35, 0.36), (-1.35, 0.36)]}
        for side, word in ((-1, "left"), (1, "right")):
            still[f"rail_{word}"] = [(side * spacing + y, z) for y, z in (*_RAIL, *((-y, z) for y, z in reversed(_RAIL)))]
        for name, points in still.items():
            self.shapes[name].set_xy(_turned(np.array(points), self.cant[k]))
        wheel = np.array([(spacing - 0.07, -2 * radius), (spacing - 0.07, 0.03), (spacing - 0.03, 0.03), (spacing - 0.02, 0.0), (spacing + 0.065, 0.0), (spacing + 0.065, -2 * radius)])
        for side, word in ((-1, "left"), (1, "right")):
            self.shapes[f"wheel_{word}"].set_xy(self._placed(self.wheelset.name, wheel * [side, 1], k))
        self.shapes["axle"].set_xy(self._placed(self.wheelset.name, _box(0.0, -radius, 2 * spacing - 0.14, 0.16), k))
        self.shapes["frame"].set_xy(self._placed(self.frame, _box(0.0, -0.66, 2.3, 0.22), k))
        self.shapes["bolster"].set_xy(self._placed(self.bolster, _box(0.0, -1.02, 1.7, 0.24), k))
        body = [(-_HALF_BODY, _UNDER), (-_HALF_BODY, -2.6), (-1.15, -3.4), (-0.7, _ROOF), (0.7, _ROOF), (1.15, -3.4), (_HALF_BODY, -2.6), (_HALF_BODY, _UNDER)]
        self.shapes["body"].set_xy(self._placed(self.car, body, k, extra))
        for line, element in zip(self.lines, self.links):
            ends = [self._placed(end.body, [end.position[1:]], k, extra if end.body == self.car else 0.0)[0] for end in (element.first, element.second)]
            line.set_data(*np.transpose(ends))
        self.floor.set_data(*self._placed(self.car, [(-_HALF_BODY, -1.2), (_HALF_BODY, -1.2)], k, extra).T)
        self._show_passenger(k, extra)

    def _show_passenger(self, k, extra):
        """What throws a passenger, outwards against the acceleration."""
        felt = float(self.values["front.ay"][k])
        ends = self._placed(self.car, [(0.0, -2.1), (-_ARROW * felt, -2.1)], k, extra)
        self.arrow.set_data(*ends.T)
        self.head.set_data(ends[:1, 0], ends[:1, 1])
        self.text.set_text(f"{self.case.name}: cant {np.degrees(self.cant[k]):+.1f}°, tilt {np.degrees(self.tilt[k]):+.1f}°, felt {felt:+.2f} m/s²")


def _box(y, z, width, height):
    return [(y - 0.5 * width, z - 0.5 * height), (y + 0.5 * width, z - 0.5 * height), (y + 0.5 * width, z + 0.5 * height), (y - 0.5 * width, z + 0.5 * height)]
