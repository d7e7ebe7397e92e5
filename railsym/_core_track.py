# SPDX-License-Identifier: BSD-3-Clause
"""Binding of the track in C (csrc/track.h)."""

from dataclasses import dataclass

import numpy as np

from railsym._core import _check, _doubles, _vector, ffi, lib
from railsym.errors import ModelError, TrackError

POWERS, PLACE_POWERS = lib.RS_TRACK_POWERS, lib.RS_TRACK_PLACE_POWERS

PIECE = np.dtype([("middle", float), ("half", float), ("curvature", float, POWERS), ("cant", float, POWERS), ("slope", float, POWERS),
                  ("heading", float, POWERS + 1), ("place", float, (3, PLACE_POWERS)), ("base", float, 3), ("base_low", float, 3)])
FRAME = np.dtype([("place", float, 3), ("place_low", float, 3), ("attitude", float, (3, 3)), ("turning", float, 3), ("turning_rate", float, 3)])
POSE = np.dtype([("D", float, 3), ("C", float, (3, 3)), ("dD", float, 3), ("wf", float, 3)])
assert (PIECE.itemsize, FRAME.itemsize, POSE.itemsize) == tuple(ffi.sizeof(f"rs_track_{name}") for name in ("piece", "frame", "pose"))


@dataclass(frozen=True, eq=False)
class RailLayer:
    """Deviation of the rails on a uniform grid.

    Attributes
    ----------
    start, step : float
        m, place and distance of the nodes.
    coefficients : ndarray, shape (count + 2, 4)
        m, of the cubic B-splines about nodes -1 to count: left y, left z, right y, right z.
    after : ndarray, shape (4,)
        m, deviation behind the last node.
    """

    start: float
    step: float
    coefficients: np.ndarray
    after: np.ndarray


class CTrack:
    """The immutable track in C memory; ``pointer`` is what other C functions take.

    Parameters
    ----------
    joints : ndarray, shape (n + 1,)
        m
    pieces : ndarray of PIECE, shape (n,)
    kinks, jumps : ndarray
        m
    layers : sequence of RailLayer
    """

    def __init__(self, joints, pieces, kinks, jumps, layers):
        joints, kinks, jumps = (np.ascontiguousarray(part, dtype=float) for part in (joints, kinks, jumps))
        pieces = np.ascontiguousarray(pieces, dtype=PIECE)
        if len(joints) != len(pieces) + 1 or not (np.diff(joints) > 0.0).all():
            raise ModelError(f"{len(pieces)} pieces of track need {len(pieces) + 1} increasing joints, {len(joints)} were given")
        made = lib.rs_track_create(len(pieces), _doubles(joints), ffi.from_buffer("rs_track_piece[]", pieces), len(kinks), _doubles(kinks),
                                   len(jumps), _doubles(jumps))
        if made == ffi.NULL:
            raise ModelError(f"a track of {len(pieces)} pieces cannot be created")
        self.pointer = ffi.gc(made, lib.rs_track_free)
        self.start, self.end = float(joints[0]), float(joints[-1])
        for layer in layers:
            self._add(layer)

    def _add(self, layer):
        coefficients = np.ascontiguousarray(layer.coefficients, dtype=float)
        if coefficients.ndim != 2 or coefficients.shape[1] != 4:
            raise ModelError(f"rail deviations need coefficients of shape (count + 2, 4), got {coefficients.shape}")
        _check(lib.rs_track_add_rails(self.pointer, layer.start, layer.step, len(coefficients) - 2, _doubles(coefficients),
                                      _doubles(_vector(layer.after, 4, "deviation after the last node"))), "rail deviations")

    def frames(self, s):
        """Frames at ``s`` (m), shape (n,): array of FRAME, shape (n,)."""
        out = np.empty(len(s), dtype=FRAME)
        self._run(lib.rs_track_frames, (s,), (_doubles(s), ffi.from_buffer("rs_track_frame[]", out)))
        return out

    def rails(self, s):
        """Rail deviations (m) and their slopes at ``s`` (m), shape (n, 8)."""
        out = np.empty((len(s), lib.RS_TRACK_RAILS))
        self._run(lib.rs_track_rails, (s,), (_doubles(s), _doubles(out)))
        return out

    def poses(self, s1, s2, speed, offset1, offset2):
        """Frames at ``s2`` seen from those at ``s1``: array of POSE, shape (n,); offsets (n, 3) in m, speed (n,) in m/s."""
        out = np.empty(len(s1), dtype=POSE)
        given = [np.ascontiguousarray(part, dtype=float) for part in (s1, s2, speed, offset1, offset2)]
        self._run(lib.rs_track_poses, given[:2], (*map(_doubles, given), ffi.from_buffer("rs_track_pose[]", out)))
        return out

    def kinks(self):
        """Places of the kinks, m, increasing."""
        return self._places(lib.rs_track_kinks)

    def jumps(self):
        """Places where the turning jumps, m, increasing."""
        return self._places(lib.rs_track_jumps)

    def next_kink(self, s):
        """First kink behind ``s``, m; inf when there is none."""
        return lib.rs_track_next_kink(self.pointer, s)

    def _places(self, ask):
        where = ffi.new("double **")
        count = ask(self.pointer, where)
        return np.array(ffi.unpack(where[0], count) if count else [], dtype=float)

    def _run(self, function, places, arguments):
        failed = ffi.new("int *")
        status = function(self.pointer, len(places[0]), *arguments, failed)
        if status == lib.RS_OUT_OF_TRACK or status == lib.RS_NOT_FINITE:
            wrong = next(float(s[failed[0]]) for s in places if not self.start <= s[failed[0]] <= self.end)
            raise TrackError(out_of_track(wrong, self.start, self.end))
        _check(status, "track")


def out_of_track(s, start, end):
    """Text of the error for a place that the track has not."""
    if not np.isfinite(s):
        return f"s = {s} m is no place on a track; a finite number is needed"
    side = f"{s - end:.6g} m beyond its end" if s > end else f"{start - s:.6g} m before its start"
    return (f"s = {s:.6g} m lies {side}: the track is {end:.6g} m long, and goes on straight or round for {-start:.6g} m before s = 0; "
            "lengthen it, or shorten the run")
