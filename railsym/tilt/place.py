# SPDX-License-Identifier: BSD-3-Clause
"""Values by place: what the leading sensors found, and a track database."""

from __future__ import annotations

import numpy as np

from railsym.tilt.errors import TiltError

APART = 0.2          # m, between values that are kept
ROOM = 1024          # values


class PlaceBuffer:
    """Values at increasing places, read behind the newest one; straight between them.

    csrc/tilt/tilt_place.c is the same in C.
    """

    def __init__(self):
        self.place, self.value = [0.0] * ROOM, [0.0] * ROOM
        self.count, self.at = 0, 0

    def push(self, place, value):
        """Keep a value, unless it lies less than 0.2 m further than the last one."""
        n = self.count
        if n and place - self.place[(n - 1) % ROOM] < APART:
            return
        self.place[n % ROOM], self.value[n % ROOM] = place, value
        self.count = n + 1

    def look(self, place):
        """Value at a place: 0 before the first one, the newest one beyond it. Places asked for may not go back."""
        n = self.count
        if self.at < n - ROOM:
            self.at = n - ROOM
        if not n or place < self.place[self.at % ROOM]:
            return 0.0 if self.at == 0 else self.value[self.at % ROOM]
        while self.at + 1 < n and self.place[(self.at + 1) % ROOM] <= place:
            self.at += 1
        if self.at + 1 == n:
            return self.value[self.at % ROOM]
        i, j = self.at % ROOM, (self.at + 1) % ROOM
        part = (place - self.place[i]) / (self.place[j] - self.place[i])
        return self.value[i] + part * (self.value[j] - self.value[i])


class TrackDatabase:
    """Curvature and cant by place, with the errors that a train's knowledge of its place has.

    Parameters
    ----------
    place : array_like (n,)
        m, increasing.
    curvature : array_like (n,)
        1/m, + to the right.
    cant : array_like (n,)
        rad, angle of the cant, + with the left rail higher.
    offset, scale : float
        m by which the database's places lie too far ahead, and the relative error of the odometer's way since ``place[0]``:
        a table value of place s is found at the odometer's (s + offset)(1 + scale).

    Raises
    ------
    TiltError
    """

    def __init__(self, place, curvature, cant, *, offset=0.0, scale=0.0):
        columns = [np.asarray(v, dtype=float) for v in (place, curvature, cant)]
        if any(v.ndim != 1 or v.shape != columns[0].shape or not np.isfinite(v).all() for v in columns) or columns[0].size < 2:
            raise TiltError("track database: place (m), curvature (1/m) and cant (rad) must be finite arrays of one length of at least 2")
        if (np.diff(columns[0]) <= 0.0).any():
            raise TiltError("track database: places (m) must increase")
        if not np.isfinite(offset) or not -0.5 < scale < 0.5:
            raise TiltError(f"track database: offset {offset!r} m, scale {scale!r}: a finite length and a relative error below 0.5 are needed")
        self.offset, self.scale = float(offset), float(scale)
        first = columns[0][0]
        self.place = first + (columns[0] - first) * (1.0 + self.scale) + self.offset
        self.curvature, self.cant = columns[1].copy(), columns[2].copy()

    @classmethod
    def of(cls, track, *, spacing=1.0, offset=0.0, scale=0.0):
        """Of a `railsym.Track`, a value every ``spacing`` m."""
        place = np.linspace(0.0, track.length, max(2, 1 + round(track.length / spacing)))
        return cls(place, track.curvature(place), np.arcsin(track.alignment.cant(place)), offset=offset, scale=scale)


class TableReader:
    """Cant deficiency V^2 k - g sin(cant angle) of a database, one place after the other."""

    def __init__(self, table, gravity):
        self.place, self.curvature, self.sine = table.place.tolist(), table.curvature.tolist(), np.sin(table.cant).tolist()
        self.gravity, self.at = gravity, 0

    def look(self, place, speed):
        """m/s^2 at a place (m) and a speed (m/s); beyond its ends the table goes on as it ends."""
        places, at, last = self.place, self.at, len(self.place) - 2
        while at < last and places[at + 1] <= place:
            at += 1
        while at > 0 and places[at] > place:
            at -= 1
        self.at = at
        part = (place - places[at]) / (places[at + 1] - places[at])
        part = 0.0 if part < 0.0 else 1.0 if part > 1.0 else part
        k = self.curvature[at] + part * (self.curvature[at + 1] - self.curvature[at])
        sine = self.sine[at] + part * (self.sine[at + 1] - self.sine[at])
        return speed * speed * k - self.gravity * sine
