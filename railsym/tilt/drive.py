# SPDX-License-Identifier: BSD-3-Clause
"""From a tilt angle to the lengths of the actuators: the planar linkage of bolster, links and body."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.tilt.errors import TiltError

POWERS = 6           # of the polynomials, 0 to 5
_ANGLES = 33
_LARGEST = np.radians(10.0)
_ITERATIONS = 12
_FIT = 2e-5          # m, that a polynomial may miss


@dataclass(frozen=True, eq=False)
class TiltDrive:
    """Which bodies tilt, and how actuators make them.

    Attributes
    ----------
    car : str
        Body that tilts.
    bolsters : tuple of str
        Bodies that it tilts against.
    actuators : tuple of str
    powers : ndarray (actuators, 6)
        Length of each over the design length (m) = sum of powers[k] tilt^k (rad).
    centre : ndarray (2,)
        m, y and z of the point about which the body turns at the design position (instantaneous centre of the first bolster).
    """

    car: str
    bolsters: tuple
    actuators: tuple
    powers: np.ndarray = field(repr=False)
    centre: np.ndarray

    @classmethod
    def of(cls, vehicle):
        """Of a vehicle whose body hangs by links from bolsters and is tilted by actuators of mode "length".

        Raises
        ------
        TiltError
            No such actuators or links, or a linkage that jams.
        """
        jacks = [e for e in vehicle.elements if e.type == "actuator"]
        if not jacks:
            raise TiltError(f"vehicle {vehicle.name!r} has no actuators to tilt it; pendolino_tilting has")
        if any(e.parameters["mode"] != "length" for e in jacks):
            raise TiltError(f"vehicle {vehicle.name!r}: the tilt unit commands lengths; its actuators must be of mode \"length\"")
        car = max(vehicle.bodies, key=lambda body: body.mass).name
        bolsters = tuple(dict.fromkeys(_other(e, car, vehicle) for e in jacks))
        poses = {bolster: _poses(vehicle, car, bolster) for bolster in bolsters}
        powers = np.array([_lengths(vehicle, e, car, poses[_other(e, car, vehicle)]) for e in jacks])
        return cls(car, bolsters, tuple(e.name for e in jacks), _mirrored(jacks, powers), _centre(poses[bolsters[0]], vehicle.body(car)))

    def lengths(self, tilt):
        """Lengths (m, over those at the design position) of the actuators at a tilt angle (rad)."""
        return self.powers @ (float(tilt) ** np.arange(POWERS))

    def tilt(self, lengths):
        """Tilt angle (rad) that fits measured lengths (m) of the actuators best."""
        from scipy.optimize import least_squares

        return float(least_squares(lambda angle: self.lengths(angle[0]) - lengths, [0.0], xtol=1e-14).x[0])


def _other(element, car, vehicle):
    ends = element.first.body, element.second.body
    if car not in ends:
        raise TiltError(f"vehicle {vehicle.name!r}: actuator {element.name} does not act on {car}, the heaviest body")
    return ends[1 - ends.index(car)]


def _arms(element, car):
    """Points (y, z) of an element on the bolster and on the car, m."""
    points = element.first.position[1:], element.second.position[1:]
    return points if element.second.body == car else points[::-1]


def _moved(points, poses, pivot):
    """Points of the body (k, 2) at poses (n, 3), ndarray (n, k, 2)."""
    c, s = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
    y, z = (np.atleast_2d(points) - pivot).T
    return pivot + poses[:, None, :2] + np.stack([c * y - s * z, s * y + c * z], axis=-1)


def _poses(vehicle, car, bolster):
    """Rows y z angle of the body against the bolster, for tilt angles to one side, at which all links keep their lengths (Gauss-Newton)."""
    links = [_arms(e, car) for e in vehicle.elements if e.type == "traction_rod" and {e.first.body, e.second.body} == {car, bolster}]
    if len(links) < 2:
        raise TiltError(f"vehicle {vehicle.name!r}: {len(links)} links (traction_rod) join {car} and {bolster}; a body is led by two at least")
    up, down = (np.array(points) for points in zip(*links))
    pivot, long = vehicle.body(car).position[1:], np.linalg.norm(up - down, axis=1)
    poses = np.column_stack([np.zeros((_ANGLES, 2)), np.linspace(0.0, _LARGEST, _ANGLES)])
    for _ in range(_ITERATIONS):
        reach = _moved(down, poses, pivot) - up
        length = np.linalg.norm(reach, axis=-1)
        slopes = reach / length[..., None]
        poses[:, :2] -= (np.linalg.pinv(slopes) @ (length - long)[..., None])[..., 0]
    off = np.abs(np.linalg.norm(_moved(down, poses, pivot) - up, axis=-1) - long).max(axis=1)
    if not (off < 1e-3).all():
        raise TiltError(f"the links between {car} and {bolster} do not let it tilt by {np.degrees(poses[int(np.argmax(~(off < 1e-3))), 2]):.3g} degrees")
    return poses


def _lengths(vehicle, jack, car, poses):
    fixed, moved = _arms(jack, car)
    pivot = vehicle.body(car).position[1:]
    both = np.concatenate([poses, poses[1:] * [-1.0, 1.0, -1.0]])
    length = np.linalg.norm(_moved(moved, both, pivot)[:, 0] - fixed, axis=-1) - np.linalg.norm(moved - fixed)
    angles = both[:, 2:] ** np.arange(1, POWERS)
    found = np.linalg.lstsq(angles, length, rcond=None)[0]
    if np.abs(angles @ found - length).max() > _FIT:
        raise TiltError(f"actuator {jack.name}: its length is no smooth function of the tilt angle up to {np.degrees(_LARGEST):g} degrees")
    return np.concatenate([[0.0], found])


def _mirrored(jacks, powers):
    """Powers of jacks that lie opposite each other made mirror images to the bit."""
    signs, done = (-1.0) ** np.arange(POWERS), powers.copy()
    for i, jack in enumerate(jacks):
        for k in range(i + 1, len(jacks)):
            ends = jack.first.position - jacks[k].first.position * [1, -1, 1], jack.second.position - jacks[k].second.position * [1, -1, 1]
            if np.abs(ends).max() < 1e-9:
                done[i] = 0.5 * (powers[i] + signs * powers[k])
                done[k] = signs * done[i]
    return done


def _centre(poses, body):
    """Point of the body that stands still at first: pivot + (dz, -dy)/dangle turned."""
    y, z = (np.gradient(poses[:, k], poses[:, 2], edge_order=2)[0] for k in (0, 1))
    return body.position[1:] + np.array([-z, y])
