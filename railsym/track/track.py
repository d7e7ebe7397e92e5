# SPDX-License-Identifier: BSD-3-Clause
"""The track: geometry, irregularities and switches, evaluated at arc lengths."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from railsym._core_track import CTrack, out_of_track
from railsym.errors import TrackError
from railsym.track.alignment import alignment
from railsym.track.integration import pieces
from railsym.track.irregularity import MeasuredIrregularity, RandomIrregularity, read_irregularity
from railsym.track.measured import MeasuredGeometry
from railsym.track.places import Frames, Rails
from railsym.track.sections import RAIL_SPACING, Curve, Straight, Transition, number
from railsym.track.switch import Switch

LEAD = 100.0      # m of track before s = 0


@dataclass(frozen=True, eq=False)
class Track:
    """A track; immutable, made from sections or from measured geometry.

    The frame at arc length s has x along the track, y to the right and z down, both in the canted plane. Curves to the right
    have positive curvature; cant is positive when the left rail is higher, and turns the frame about the centre between the
    rails. s runs from 0 to `length`; for 100 m before 0 the track goes on as it begins, so that a vehicle can stand there.

    Parameters
    ----------
    sections : sequence of Straight, Curve, Transition; or MeasuredGeometry
    vertical : sequence of Gradient, VerticalCurve
        As long as the sections together; level without it.
    rounding : float
        m, over which a step of curvature, and of the slope of cant and gradient, is spread: there the angular velocity of a
        track frame would jump, which no body follows. 0: the sections to the letter, for geometry only.
    name : str
    irregularities : sequence of RandomIrregularity, MeasuredIrregularity
    switches : sequence of Switch

    Raises
    ------
    TrackError
        For sections that do not fit together, or something that does not lie on the track.

    Examples
    --------
    >>> from railsym.track import Track, Straight, Transition, Curve
    >>> track = Track([Straight(100), Transition(50), Curve(radius=500, length=200, cant=0.1)])
    >>> track.length
    350.0
    >>> float(track.cant(300.0)), float(1 / track.curvature(300.0))
    (0.1, 500.0)
    """

    sections: tuple
    vertical: tuple = ()
    rounding: float = 1.0
    name: str = "track"
    irregularities: tuple = ()
    switches: tuple = ()

    def __post_init__(self):
        if not isinstance(self.sections, MeasuredGeometry):
            object.__setattr__(self, "sections", tuple(self.sections))
        for part in ("vertical", "irregularities", "switches"):
            object.__setattr__(self, part, tuple(getattr(self, part)))
        object.__setattr__(self, "rounding", number(self.rounding, "rounding", "m", low=0.0, high=LEAD))
        if self.vertical and isinstance(self.sections, MeasuredGeometry):
            raise TrackError("measured geometry holds its gradient: vertical sections do not go with it")
        self.core      # what does not fit is said now, not in a run

    def __getstate__(self):
        """What a copy in another process needs; C memory is made again there."""
        return {name: value for name, value in vars(self).items() if name not in ("core", "alignment")}

    # --- ways to make one ----------------------------------------------------------------------------------------------

    @classmethod
    def straight(cls, length, **options):
        """Straight level track of ``length`` (m)."""
        return cls([Straight(length)], **{"name": "straight", **options})

    @classmethod
    def curve(cls, radius, length, *, transition, cant=0.0, direction="right", kind="clothoid", before=50.0, after=50.0, **options):
        """Straight, transition, curve, transition, straight; lengths, radius and cant (of the outer rail) in m."""
        parts = [Straight(before), Transition(transition, kind), Curve(radius, length, cant, direction), Transition(transition, kind), Straight(after)]
        return cls(parts, **{"name": "curve", **options})

    @classmethod
    def s_curve(cls, radius, length, *, transition, cant=0.0, between=0.0, direction="right", kind="clothoid", before=50.0, after=50.0, **options):
        """Two curves of opposite direction, the first to ``direction``.

        Parameters
        ----------
        radius, length, cant : float
            m, of each curve.
        transition : float
            m, each; without a straight between the curves one transition of twice the length leads from one to the other.
        between : float
            m of straight between the curves.
        before, after : float
            m of straight.
        """
        other = {"right": "left", "left": "right"}.get(direction, direction)
        first, second = Curve(radius, length, cant, direction), Curve(radius, length, cant, other)
        middle = [Transition(transition, kind), Straight(between), Transition(transition, kind)] if between else [Transition(2 * transition, kind)]
        parts = [Straight(before), Transition(transition, kind), first, *middle, second, Transition(transition, kind), Straight(after)]
        return cls(parts, **{"name": "s-curve", **options})

    @classmethod
    def turnout(cls, radius, *, length=None, angle=None, direction="right", before=30.0, after=30.0, **options):
        """Diverging route of a turnout: straight, curve without transition and cant, straight.

        Parameters
        ----------
        radius : float
            m
        length, angle : float
            m of curve, or its angle in rad: one of the two.
        """
        if (length is None) == (angle is None):
            raise TrackError("turnout: give either length (m) of its curve or its angle (rad)")
        run = length if angle is None else radius * number(angle, "turnout: angle", "rad", above=0.0)
        return cls([Straight(before), Curve(radius, run, direction=direction), Straight(after)], **{"name": "turnout", **options})

    @classmethod
    def from_file(cls, path, **options):
        """Track from a file of curvature, radius or versine, cant and gradient over s.

        Parameters
        ----------
        path : path
            CSV, as `railsym.track.read_geometry` takes it.
        options
            smoothing, interpolation, chord, curve_positive, cant_positive, largest_gap of `read_geometry`; others of `Track`.
        """
        from railsym.track.geometry_file import OPTIONS, read_geometry

        geometry = read_geometry(path, **{name: options.pop(name) for name in OPTIONS if name in options})
        return cls(geometry, **{"name": geometry.name, **options})

    def with_irregularity(self, irregularity, *, seed=None, **options):
        """The same track with one irregularity more.

        Parameters
        ----------
        irregularity : str, path, RandomIrregularity or MeasuredIrregularity
            A spectrum by name (`railsym.track.spectra` lists them) or TOML file, with a ``seed``; measured values as a CSV file; or
            made before.
        seed : int
        options
            As for `RandomIrregularity`: wavelengths, start, length, fade (m), scale; for a CSV file fade, covers.

        Returns
        -------
        Track
        """
        if isinstance(irregularity, (RandomIrregularity, MeasuredIrregularity)):
            if seed is not None or options:
                raise TrackError("this irregularity is made already: seed and options belong to a spectrum")
        elif isinstance(irregularity, (str, Path)) and Path(irregularity).suffix.lower() in (".csv", ".txt"):
            if seed is not None:
                raise TrackError(f"{irregularity} is measured: a seed belongs to a spectrum")
            irregularity = read_irregularity(irregularity, **options)
        elif isinstance(irregularity, (str, Path)):
            if seed is None:
                raise TrackError(f"irregularity {str(irregularity)!r} is random: give a seed, such as seed=1, so that it can be made again")
            irregularity = RandomIrregularity(str(irregularity), seed, **options)
        else:
            raise TrackError(f"irregularity {irregularity!r} is none: give the name of a spectrum, a RandomIrregularity or a MeasuredIrregularity")
        return replace(self, irregularities=(*self.irregularities, irregularity))

    def with_switch(self, switch=None, **options):
        """The same track with one switch more: a `Switch`, or its start, length, amplitude, shape, rails, crossing_..."""
        return replace(self, switches=(*self.switches, switch or Switch(**options)))

    def mirrored(self):
        """The same track with left and right exchanged."""
        from railsym.track.mirror import mirrored

        return mirrored(self)

    # --- what it is ----------------------------------------------------------------------------------------------------

    @cached_property
    def alignment(self):
        """Curvature, cant and slope as piecewise polynomials."""
        if isinstance(self.sections, MeasuredGeometry):
            return self.sections.alignment(LEAD).rounded(self.rounding)
        return alignment(self.sections, self.vertical, LEAD).rounded(self.rounding)

    @cached_property
    def core(self):
        """The track in C, for the integrator."""
        line = self.alignment
        layers = [part.layer(self.length) for part in self.irregularities] + [layer for part in self.switches for layer in part.layers(self.length)]
        corners = [place for part in self.switches for place in part.corners() if place < self.length]
        joints, made = pieces(line)
        return CTrack(joints, made, np.unique(np.concatenate([line.kinks(), corners])), line.jumps(), layers)

    @property
    def length(self):
        """m; the largest s."""
        return self.alignment.length

    @property
    def start(self):
        """m; the smallest s, below 0."""
        return -LEAD

    @property
    def kinks(self):
        """Places (m) where the turning of the frame, its rate, or the slope of a rail jumps: land steps there."""
        return self.core.kinks()

    @property
    def jumps(self):
        """Places (m) where the turning itself jumps; none unless rounding is 0."""
        return self.core.jumps()

    def check_run(self, first, last):
        """Refuse a run between two places (m) that the track does not have.

        Raises
        ------
        TrackError
        """
        for s in (first, last):
            if not self.start <= s <= self.length:
                raise TrackError(out_of_track(s, self.start, self.length))

    # --- at a place ----------------------------------------------------------------------------------------------------

    def curvature(self, s):
        """1/m, positive to the right; s in m, any shape."""
        return self._of(self.alignment.curvature, s)

    def cant(self, s):
        """m, positive when the left rail is higher."""
        return RAIL_SPACING * self._of(self.alignment.cant, s)

    def gradient(self, s):
        """Rise over run, positive uphill."""
        sine = self._of(self.alignment.slope, s)
        return sine / np.sqrt(1.0 - sine**2)

    def frame(self, s):
        """Track frames.

        Parameters
        ----------
        s : array_like
            m

        Returns
        -------
        railsym.track.places.Frames
            Arrays with the shape of s in front.

        Raises
        ------
        TrackError
            Outside the track.
        """
        flat, shape = _flat(s)
        return Frames.of(self.core.frames(flat), shape)

    def rails(self, s):
        """Deviation of the rails from their design place.

        Returns
        -------
        railsym.track.places.Rails
        """
        flat, shape = _flat(s)
        return Rails.of(self.core.rails(flat), shape)

    def relative_pose(self, s1, s2, speed=0.0, offset1=(0.0, 0.0, 0.0), offset2=(0.0, 0.0, 0.0)):
        """Track frame at s2 seen from that at s1, both moving at ``speed``.

        Parameters
        ----------
        s1, s2 : array_like
            m
        speed : array_like
            m/s
        offset1, offset2 : array_like, shape (3,) or (..., 3)
            m, design place of each body in its own frame (x is 0 for a body at the arc length of its frame).

        Returns
        -------
        dict of ndarray
            As `railsym.track_frames.relative_pose`: D (..., 3) m, C (..., 3, 3), dD (..., 3) m/s, wf (..., 3) rad/s.
        """
        s1, s2, speed = np.broadcast_arrays(*(np.asarray(part, dtype=float) for part in (s1, s2, speed)))
        offsets = [np.broadcast_to(np.asarray(part, dtype=float), (*s1.shape, 3)).reshape(-1, 3) for part in (offset1, offset2)]
        found = self.core.poses(s1.ravel(), s2.ravel(), speed.ravel(), *offsets)
        return {key: found[key].reshape(s1.shape + found[key].shape[1:]) for key in found.dtype.names}

    def _of(self, function, s):
        s = np.asarray(s, dtype=float)
        for end in (s.min(), s.max()) if s.size else ():
            self.check_run(end, end)
        return function(s)

    # --- the other ways out --------------------------------------------------------------------------------------------

    def to_toml(self, path=None):
        """Text of the track file (docs/track.md), written to ``path`` if given."""
        from railsym.track.writing import track_toml

        return track_toml(self, path)

    def plot(self, **options):
        """Curvature, cant, gradient, plan view and irregularities: `railsym.plots.plot_track`."""
        from railsym.plots.track import plot_track

        return plot_track(self, **options)

    def __repr__(self):
        extra = "".join(f", {len(part)} {what}" for what, part in (("irregularities", self.irregularities), ("switches", self.switches)) if part)
        return f"<Track {self.name!r}: {self.length:.6g} m{extra}>"


def _flat(s):
    s = np.asarray(s, dtype=float)
    return np.ascontiguousarray(s.ravel()), s.shape
