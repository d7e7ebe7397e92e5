# SPDX-License-Identifier: BSD-3-Clause
"""A profile as dense nodes along its arc, with tangent angle and curvature."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from railsym.profiles.checks import ProfileError

KINDS = ("wheel", "rail")


@dataclass(frozen=True, eq=False)
class Profile:
    """Cross-section of a wheel or rail, right-hand side of the track; arrays are read-only, one entry a node.

    Attributes
    ----------
    name : str
    kind : {"wheel", "rail"}
    y : ndarray, shape (n,)
        Lateral, m, positive towards the field side; 0 at the tape circle of a wheel, the axis of a rail.
    z : ndarray, shape (n,)
        m, positive down: towards the flange tip of a wheel, towards the foot of a rail.
    angle : ndarray, shape (n,)
        Direction of the curve, rad: dz/dy = tan(angle) as y grows.
    curvature : ndarray, shape (n,)
        1/m, positive where the body is convex.
    arc_length : ndarray, shape (n,)
        m, strictly increasing from the flange (gauge) side to the field side.
    description, origin : str
        What it is; where the numbers come from.
    inclined : bool
        True for a rail given in track axes, its inclination included.
    points : ndarray, shape (m, 2), optional
        The points (y, z) that the curve was laid through, m.
    deviation : float
        Largest distance of the points from the smoothed curve, m; 0 for a formula.
    """

    name: str
    kind: str
    y: np.ndarray
    z: np.ndarray
    angle: np.ndarray
    curvature: np.ndarray
    arc_length: np.ndarray
    description: str = ""
    origin: str = ""
    inclined: bool = False
    points: np.ndarray | None = field(default=None, repr=False)
    deviation: float = 0.0

    def __post_init__(self):
        if self.kind not in KINDS:
            raise ProfileError(f"profile {self.name!r}: kind is {self.kind!r}; it must be one of {', '.join(KINDS)}")
        for name in ("y", "z", "angle", "curvature", "arc_length"):
            array = np.array(getattr(self, name), dtype=float)
            if array.ndim != 1 or array.shape != np.shape(self.y):
                raise ProfileError(f"profile {self.name!r}: {name} has shape {array.shape}; all arrays of nodes must be (n,)")
            if not np.isfinite(array).all():
                raise ProfileError(f"profile {self.name!r}: {name} of node {int((~np.isfinite(array)).argmax())} is not a finite number")
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if not (np.diff(self.arc_length) > 0.0).all():
            raise ProfileError(f"profile {self.name!r}: arc_length does not increase at node {int((np.diff(self.arc_length) <= 0).argmax()) + 1}")

    def __repr__(self):
        return (f"Profile({self.name!r}, {self.kind}, y {1e3 * self.y.min():.2f} to {1e3 * self.y.max():.2f} mm, "
                f"{len(self.y)} nodes)")

    @classmethod
    def from_points(cls, name, kind, y, z, *, smoothing=0.0, description="", origin="", inclined=False):
        """A curve through points, by splines over the arc length.

        Parameters
        ----------
        name : str
        kind : {"wheel", "rail"}
        y, z : array_like, shape (m,)
            m, in the axes of the class, in either direction along the curve.
        smoothing : float
            Root-mean-square distance, m, that the curve may keep from the points; 0 lays it through them.
        description, origin : str
        inclined : bool

        Returns
        -------
        Profile

        Raises
        ------
        ProfileError
            If the points make no usable profile (`railsym.profiles.checks.check_points`).
        """
        from railsym.profiles.checks import check_points
        from railsym.profiles.smoothing import smooth_curve

        y, z = check_points(name, kind, y, z)
        return cls(name=name, kind=kind, description=description, origin=origin, inclined=inclined,
                   points=np.column_stack([y, z]), **smooth_curve(name, kind, y, z, smoothing))

    def rotated(self, angle):
        """The profile turned about its origin.

        Parameters
        ----------
        angle : float
            rad, positive from y towards z (the field side goes down).

        Returns
        -------
        Profile
        """
        c, s = np.cos(angle), np.sin(angle)
        points = None if self.points is None else self.points @ np.array([[c, s], [-s, c]])
        return replace(self, y=c * self.y - s * self.z, z=s * self.y + c * self.z, angle=self.angle + angle, points=points)

    def shifted(self, y=0.0, z=0.0):
        """The profile moved by y and z (m)."""
        points = None if self.points is None else self.points + [y, z]
        return replace(self, y=self.y + y, z=self.z + z, points=points)
