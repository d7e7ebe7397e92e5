# SPDX-License-Identifier: BSD-3-Clause
"""A run as a moving picture: the vehicle from above, its leading bogie from above and from behind, motions exaggerated."""

from __future__ import annotations

import io
import shutil
import subprocess
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from railsym.errors import SimulationError
from railsym.plots.cross_section import cross_section
from railsym.plots.outlines import outlines
from railsym.plots.scene import Panel, PassingTrack, new_scene
from railsym.topology import body_coordinates

FORMATS = (".gif", ".mp4")
_PER_SECOND = 16             # pictures in a second
_COLOURS = 48                # of a GIF's palette
_DRAWN = 0.25                # m, the largest motion is drawn about so large
_LADDER = np.outer(10.0 ** np.arange(0, 5), [1.0, 2.0, 5.0]).ravel()


@dataclass(frozen=True)
class Animation:
    """What was written.

    Attributes
    ----------
    path : Path
    frames : int
    factor : float
        Motions, and deviations of the rails, are drawn so many times too large.
    slowdown : float
        A second of motion takes so many seconds.
    start, end : float
        s, what is shown.
    size : int
        Bytes.
    """

    path: Path
    frames: int
    factor: float
    slowdown: float
    start: float
    end: float
    size: int

    @property
    def message(self):
        """In a sentence."""
        pace = f"{self.slowdown:.3g} times slower" if self.slowdown >= 1.0 else f"{1.0 / self.slowdown:.3g} times faster"
        return (f"{self.path}: {self.frames} pictures of t = {self.start:.3g} to {self.end:.3g} s, {pace} than life, "
                f"motions times {self.factor:g}, {self.size / 1e6:.2f} MB")


def animation_channels(vehicle):
    """Channels that `animate` needs.

    Returns
    -------
    list of str
    """
    return ["s", "V", *(name for body in vehicle.bodies for name in body_coordinates(body) if not name.endswith(".spin"))]


def animate(run, vehicle, path, *, track=None, start=None, end=None, slowdown=None, factor=None, frames=96, progress=False):
    """Write a run as GIF or MP4.

    Parameters
    ----------
    run : railsym.Run
        With the channels of `animation_channels`.
    vehicle : Vehicle
        That it is a run of.
    path : str or path
        Ends in .gif, or in .mp4, for which ffmpeg must be there.
    track : railsym.Track, optional
        Its rails' deviations are drawn, exaggerated as the motions are.
    start, end : float, optional
        s, what is shown; the whole run if not given.
    slowdown : float, optional
        A second of motion takes so many seconds. As the pictures give it at 16 a second if not given.
    factor : float, optional
        Exaggeration; such that the largest motion is drawn about 25 cm large (at least 1) if not given.
    frames : int
        Pictures; with ``slowdown`` they follow from it.
    progress : bool

    Returns
    -------
    Animation

    Raises
    ------
    SimulationError
        Another format, no ffmpeg, missing channels, nothing to show.

    Notes
    -----
    Everything is seen from the track frames: a curve is drawn straight. Rotations are drawn to first order.
    """
    path = check_path(path)
    times, slowdown = _times(run, start, end, slowdown, frames)
    states = _states(run, vehicle, times)
    scene = _Scene(run, vehicle, track, times, states, factor)
    try:
        write_shots((scene.pixels(k, slowdown) for k in range(len(times))), len(times), path, progress)
    finally:
        scene.close()
    return Animation(path, len(times), scene.factor, slowdown, float(times[0]), float(times[-1]), path.stat().st_size)


def write_shots(shots, count, path, progress=False):
    """Write pictures, (height, width, 4) bytes each, as GIF or MP4 at 16 a second.

    Raises
    ------
    SimulationError
        A file that cannot be written.
    """
    from railsym.progress import followed

    write = _write_gif if path.suffix.lower() == ".gif" else _write_mp4
    try:
        write(followed(shots, count, "pictures", progress), path)
    except OSError as error:
        raise SimulationError(f"{path}: {error.strerror or error}") from None


def check_path(path):
    """The path of a picture that can be written; see `animate`."""
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise SimulationError(f"animation {path}: the name must end in {' or '.join(FORMATS)}")
    if not path.resolve().parent.is_dir():
        raise SimulationError(f"animation {path}: there is no directory {path.resolve().parent}")
    if path.suffix.lower() == ".mp4" and not shutil.which("ffmpeg"):
        raise SimulationError(f"animation {path}: MP4 is written by ffmpeg, which is not installed (not on the PATH); install it or write a .gif")
    return path


def _times(run, start, end, slowdown, frames):
    """Times of the pictures (s), and how many times slower than life they pass."""
    first = float(run.time[0]) if start is None else max(float(start), float(run.time[0]))
    last = float(run.time[-1]) if end is None else min(float(end), float(run.time[-1]))
    if not last > first:
        raise SimulationError(f"animation: nothing to show from {first:g} to {last:g} s; the run has {run.time[0]:g} to {run.time[-1]:g} s")
    if slowdown is not None:
        if not 0.0 < slowdown < np.inf:
            raise SimulationError(f"animation: slowdown {slowdown!r}; a number above 0 is needed, such as 4")
        frames = 1 + round(_PER_SECOND * slowdown * (last - first))
    if not 2 <= frames <= 2000:
        raise SimulationError(f"animation: {frames} pictures; from 2 to 2000 can be drawn: change start, end, or slowdown")
    return np.linspace(first, last, frames), (frames - 1) / _PER_SECOND / (last - first)


def _states(run, vehicle, times):
    """Coordinate -> values at the times of the pictures."""
    names = animation_channels(vehicle)
    missing = [name for name in names if name not in run]
    if missing:
        raise SimulationError(f"animation: the run lacks {len(missing)} channels, such as {missing[0]}; record those of "
                              "railsym.plots.animation_channels(vehicle)")
    return {name: np.interp(times, run.time, run[name]) for name in names}


def moved(outline, vehicle, states, count):
    """Displacements (count, k, 3) in m of the points of an outline, rotations to first order."""
    result = np.zeros((count, *outline.points.shape))
    zero = np.zeros(count)
    for i, (point, attachment) in enumerate(zip(outline.points, outline.bodies)):
        name = attachment.partition(".")[0]
        if name == "track":
            continue
        turn = np.stack([states.get(key, zero) for key in (f"{name}.roll", f"{attachment}.pitch", f"{name}.yaw")], -1)
        move = np.stack([states.get(f"{name}.{axis}", zero) for axis in "xyz"], -1)
        result[:, i] = move + np.cross(turn, point - vehicle.body(name).position)
    return result


class _Scene:
    """The figure and what moves in it."""

    def __init__(self, run, vehicle, track, times, states, factor):
        self.run, self.vehicle, self.track, self.times, self.states = run, vehicle, track, times, states
        views = [outlines(vehicle, "above"), cross_section(vehicle)]
        moves = [[moved(outline, vehicle, states, len(times)) for outline in view] for view in views]
        self.factor = _factor(moves) if factor is None else float(factor)
        if not 0.0 < self.factor < np.inf:
            raise SimulationError(f"animation: factor {factor!r}; a number above 0 is needed, such as 20")
        self.figure, (whole, bogie, behind), self.title = new_scene(vehicle)
        self.panels = [Panel(whole, views[0], moves[0], (0, 1), self.factor), Panel(bogie, views[0], moves[0], (0, 1), self.factor),
                       Panel(behind, views[1], moves[1], (1, 2), self.factor)]
        self.rails = PassingTrack((whole, bogie, behind), vehicle, self.factor)
        self.still, self.movable = None, []

    def pixels(self, k, slowdown):
        """The k-th picture, (height, width, 4) bytes. Axes are drawn once, what moves is drawn over them."""
        canvas = self.figure.canvas
        if self.still is None:
            self.movable = sorted([self.title, *self.rails.artists, *(artist for panel in self.panels for artist in panel.artists)], key=lambda a: a.zorder)
            for artist in self.movable:
                artist.set_animated(True)
            canvas.draw()
            self.still = canvas.copy_from_bbox(self.figure.bbox)
        self._place(k, slowdown)
        canvas.restore_region(self.still)
        for artist in self.movable:
            self.figure.draw_artist(artist)
        return np.asarray(canvas.buffer_rgba()).copy()

    def _place(self, k, slowdown):
        for panel in self.panels:
            panel.show(k)
        self.rails.show(self.track, float(self.states["s"][k]))
        self.title.set_text(f"t = {self.times[k]:.2f} s   s = {self.states['s'][k]:.1f} m   {3.6 * self.states['V'][k]:.0f} km/h   "
                            f"(motions × {self.factor:g}, {slowdown:.2g} times slower)")

    def close(self):
        """Let the figure go."""
        self.figure.clear()


def _factor(moves):
    """A round exaggeration at which the largest displacement across the track is drawn about 0.25 m large."""
    largest = max(np.abs(move[..., 1:]).max() for view in moves for move in view)
    if not largest > 0.0:
        return 1.0
    return float(max(1.0, _LADDER[np.argmin(np.abs(np.log(_LADDER * largest / _DRAWN)))]))


def _write_gif(shots, path):
    """Pictures in one palette; Pillow stores of each only what differs from the one before."""
    from PIL import Image

    pictures, palette = [], None
    for shot in shots:
        picture = Image.fromarray(shot).convert("RGB")
        palette = picture.quantize(_COLOURS) if palette is None else palette
        pictures.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    held = io.BytesIO()
    pictures[0].save(held, "GIF", save_all=True, append_images=pictures[1:], duration=round(1000 / _PER_SECOND), loop=0, optimize=True)
    path.write_bytes(held.getvalue())


def _write_mp4(shots, path):
    """Pictures as raw bytes through ffmpeg, which wants even numbers of rows and columns."""
    shots = iter(shots)
    first = next(shots)
    height, width = (2 * (size // 2) for size in first.shape[:2])
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{width}x{height}", "-r", str(_PER_SECOND), "-i", "-",
               "-pix_fmt", "yuv420p", str(path)]
    data = b"".join(np.ascontiguousarray(shot[:height, :width]).tobytes() for shot in chain([first], shots))
    done = subprocess.run(command, input=data, capture_output=True)
    if done.returncode:
        raise SimulationError(f"{path}: ffmpeg failed: {done.stderr.decode(errors='replace').strip()}")
