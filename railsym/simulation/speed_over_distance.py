# SPDX-License-Identifier: BSD-3-Clause
"""Speed against place: what a driver keeps to. Between places the acceleration is constant, so v^2 is straight over distance."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.errors import SimulationError, TrackError
from railsym.simulation.speed import SpeedProfile

MAX_ACCELERATION = 1.5   # m/s^2, assumed: what trains reach in emergency braking; more is a mistake until it is asked for
COLUMNS = {"s": "m", "time": "s", "speed": "m/s", "limit": "m/s"}


@dataclass(frozen=True, eq=False)
class SpeedOverDistance:
    """Speed of the vehicle's centre against its arc length; constant before the first place and behind the last one.

        rs.simulate(vehicle, speed=rs.SpeedOverDistance([0, 500, 900], [40, 40, 25]), ...)     # brakes from 500 to 900 m

    Parameters
    ----------
    place : array_like, shape (n,)
        m, increasing.
    speed : array_like, shape (n,)
        m/s, above 0.
    max_acceleration : float
        m/s^2: a larger acceleration or braking is refused.

    Raises
    ------
    SimulationError
        Places that do not increase, speeds not above 0, accelerations beyond the limit, with the place.
    """

    place: np.ndarray
    speed: np.ndarray
    max_acceleration: float = MAX_ACCELERATION

    def __post_init__(self):
        place, speed = _checked(self.place, self.speed, "speed")
        if not 0.0 < self.max_acceleration < np.inf:
            raise SimulationError(f"max_acceleration = {self.max_acceleration!r} m/s^2: a number above 0 is needed")
        object.__setattr__(self, "place", place)
        object.__setattr__(self, "speed", speed)
        found = self.acceleration
        if len(found) and np.abs(found).max() > self.max_acceleration * (1.0 + 1e-9):
            k = int(np.abs(found).argmax())
            raise SimulationError(
                f"speed from {speed[k]:g} m/s at s = {place[k]:.6g} m to {speed[k + 1]:g} m/s at {place[k + 1]:.6g} m is an acceleration of "
                f"{found[k]:.3g} m/s^2, beyond {self.max_acceleration:g} m/s^2: give it "
                f"{abs(np.diff(speed ** 2)[k]) / (2.0 * self.max_acceleration):.4g} m, or another max_acceleration; are the units right?")

    @classmethod
    def from_limits(cls, place, limit, *, acceleration, braking, max_acceleration=MAX_ACCELERATION):
        """The fastest run that keeps to speed limits.

        Parameters
        ----------
        place : array_like, shape (n,)
            m, where each limit begins; the last one goes on.
        limit : array_like, shape (n,)
            m/s
        acceleration, braking : float
            m/s^2, above 0: with these it speeds up behind a limit, and slows down before one.

        Returns
        -------
        SpeedOverDistance
        """
        place, limit = _checked(place, limit, "limit")
        for name, value in (("acceleration", acceleration), ("braking", braking)):
            if not 0.0 < value < np.inf:
                raise SimulationError(f"{name} = {value!r} m/s^2: a number above 0 is needed")
        squares, length = limit ** 2, np.diff(place)
        ends = np.concatenate([squares[:1], np.minimum(squares[:-1], squares[1:])])
        for k in range(1, len(ends)):
            ends[k] = min(ends[k], ends[k - 1] + 2.0 * acceleration * length[k - 1])
        for k in range(len(ends) - 2, -1, -1):
            ends[k] = min(ends[k], ends[k + 1] + 2.0 * braking * length[k])
        points = [(place[0], ends[0])]
        for k, run in enumerate(length):
            points += [(place[k] + at, square) for at, square in _between(ends[k], ends[k + 1], squares[k], run, acceleration, braking)]
            points.append((place[k + 1], ends[k + 1]))
        if ends[-1] < squares[-1]:
            points.append((place[-1] + (squares[-1] - ends[-1]) / (2.0 * acceleration), squares[-1]))
        found = np.array(points)
        apart = np.concatenate([[True], np.diff(found[:, 0]) > 1e-9])
        return cls(found[apart, 0], np.sqrt(found[apart, 1]), max_acceleration)

    @property
    def acceleration(self):
        """m/s^2 between the places, shape (n - 1,)."""
        return np.diff(self.speed ** 2) / (2.0 * np.diff(self.place))

    def at(self, place):
        """Speeds (m/s) at places (m)."""
        return np.sqrt(np.interp(place, self.place, self.speed ** 2))

    def profile(self, start=0.0):
        """The same over time, of a vehicle whose centre is at ``start`` (m) at t = 0.

        Returns
        -------
        SpeedProfile
        """
        ahead = self.place > start + 1e-9
        place, speed = np.append(start, self.place[ahead]), np.append(self.at(start), self.speed[ahead])
        times = np.concatenate([[0.0], np.cumsum(2.0 * np.diff(place) / (speed[1:] + speed[:-1]))])
        return SpeedProfile(times, speed, start)


def _between(low, high, cap, length, acceleration, braking):
    """Points (distance, v^2) inside a stretch from v^2 = low to high under a cap."""
    up, down = (cap - low) / (2.0 * acceleration), length - (cap - high) / (2.0 * braking)
    if up <= down:
        return [(up, cap), (down, cap)]
    peak = (high - low + 2.0 * braking * length) / (2.0 * (acceleration + braking))
    return [(peak, low + 2.0 * acceleration * peak)]


def _checked(place, speed, what):
    place, speed = (np.array(part, dtype=float, ndmin=1) for part in (place, speed))
    if place.shape != speed.shape or place.ndim != 1 or not place.size or not np.isfinite(place).all() or (np.diff(place) <= 0.0).any():
        raise SimulationError(f"{what} over distance: as many places (m, increasing) as speeds (m/s) are needed, got {place} and {speed}")
    if not (np.isfinite(speed) & (speed > 0.0)).all():
        wrong = speed[~(np.isfinite(speed) & (speed > 0.0))][0]
        raise SimulationError(f"{what} {wrong:g} m/s: creepages are slips over the speed, so it must be finite and above 0 m/s everywhere")
    return place, speed


def load_speed(path):
    """Speed against place or time, from a file.

    Parameters
    ----------
    path : path
        CSV with the heading ``s [m], speed [km/h]``, ``time [s], speed [km/h]``, or ``s [m], limit [km/h]`` (accelerates and brakes
        with 0.5 m/s^2, assumed); or TOML with a table ``[speed]`` that has these columns as lists, such as
        ``s = [[0, 500], "m"]``, and may have ``acceleration``, ``braking`` and ``max_acceleration``, such as ``[0.8, "m/s^2"]``.

    Returns
    -------
    SpeedOverDistance or SpeedProfile

    Raises
    ------
    SimulationError
        A file, column, unit or number that cannot be used.
    """
    path = Path(path)
    try:
        given = _from_toml(path) if path.suffix.lower() == ".toml" else _from_csv(path)
        kind = ({"s", "time"} & set(given), {"speed", "limit"} & set(given))
        if any(len(one) != 1 for one in kind) or {"time", "limit"} <= set(given):
            raise SimulationError("give s and speed, time and speed, or s and limit")
        return _made(given)
    except (TrackError, SimulationError) as error:
        text = str(error)
        raise SimulationError(text if text.startswith((str(path), path.name)) else f"{path.name}: {text}") from None


def _made(given):
    if "limit" not in given:
        for name in ("acceleration", "braking"):
            if name in given:
                raise SimulationError(f"{name} belongs to limits: it follows from speeds over s or time")
    if "time" in given:
        return SpeedProfile(given["time"], given["speed"])
    most = {"max_acceleration": given["max_acceleration"]} if "max_acceleration" in given else {}
    if "limit" in given:
        return SpeedOverDistance.from_limits(given["s"], given["limit"], acceleration=given.get("acceleration", 0.5),
                                             braking=given.get("braking", 0.5), **most)
    return SpeedOverDistance(given["s"], given["speed"], **most)


def _from_csv(path):
    from railsym.track.tables import read_table

    return read_table(path, COLUMNS, ())


def _from_toml(path):
    import tomllib

    from railsym.track.toml_values import Reader

    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SimulationError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    reader, single = Reader(path.name), ("acceleration", "braking", "max_acceleration")
    table = reader.table("speed", reader.table("", document, ("speed",), ("speed",))["speed"], (*COLUMNS, *single))
    return {name: reader.quantity(f"speed.{name}", entry, "m/s^2" if name in single else COLUMNS[name], None if name in single else -1)
            for name, entry in table.items()}
