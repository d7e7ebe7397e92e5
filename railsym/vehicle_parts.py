# SPDX-License-Identifier: BSD-3-Clause
"""The parts a vehicle is made of: bodies, elements, curves and quantities. All are read-only."""

from dataclasses import dataclass, field

import numpy as np

TRACK = "track"


class FrozenDict(dict):
    """A dictionary that refuses to be changed; it can be pickled."""

    def _refuse(self, *args, **kwargs):
        raise TypeError("this mapping is read-only: use Vehicle.replace to change a parameter")

    __setitem__ = __delitem__ = clear = pop = popitem = setdefault = update = __ior__ = _refuse

    def __reduce__(self):
        return FrozenDict, (dict(self),)


@dataclass(frozen=True, eq=False, slots=True)
class Quantity:
    """A number or array of numbers with its unit and where it comes from.

    Attributes
    ----------
    value : float or ndarray
        In the unit `unit`; SI in everything that `Vehicle.parameters` gives. Arrays are read-only.
    unit : str
    origin : str
        Citation, or "assumed: reason".
    """

    value: float | np.ndarray
    unit: str
    origin: str


@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """A table y(x) with x strictly increasing and y monotone, SI units.

    Attributes
    ----------
    name : str
    x, y : ndarray, shape (n,)
    x_unit, y_unit : str
        SI units of the two columns.
    origin : str
    """

    name: str
    x: np.ndarray
    y: np.ndarray
    x_unit: str
    y_unit: str
    origin: str


@dataclass(frozen=True, eq=False, slots=True)
class Axlebox:
    """An axlebox that turns about the axle of its wheelset.

    Attributes
    ----------
    name : str
        Attachment name, for example ``"wheelset1.axlebox_left"``.
    side : int
        -1 left (y < 0), +1 right (y > 0).
    mass : float
        kg
    inertia : ndarray, shape (3, 3)
        kg m^2, about its centre of mass, axes of the vehicle.
    lateral_position : float
        m, y of its journal from the wheelset's centre, with sign.
    centre_offset : ndarray, shape (3,)
        m, centre of mass from the journal's centre, in the axlebox.
    """

    name: str
    side: int
    mass: float
    inertia: np.ndarray
    lateral_position: float
    centre_offset: np.ndarray


@dataclass(frozen=True, eq=False, slots=True)
class Body:
    """A rigid body, or a wheelset with its axleboxes.

    Attributes
    ----------
    name, group : str
        The instance and the group of bodies with the same data that it belongs to.
    kind : str
        ``"rigid_body"`` or ``"wheelset"``.
    position : ndarray, shape (3,)
        m, centre of mass at the design position, vehicle coordinates (x forward, y right, z down from the track plane).
    mass : float
        kg; of a wheelset without its axleboxes.
    inertia : ndarray, shape (3, 3)
        kg m^2, about the centre of mass, axes of the vehicle; of a wheelset without its axleboxes.
    wheel_radius, contact_half_spacing : float or None
        m, wheelsets only; half of the distance between the two contact points.
    axleboxes : tuple of Axlebox
        Left and right, or empty.
    """

    name: str
    group: str
    kind: str
    position: np.ndarray
    mass: float
    inertia: np.ndarray
    wheel_radius: float | None = None
    contact_half_spacing: float | None = None
    axleboxes: tuple = ()


@dataclass(frozen=True, eq=False, slots=True)
class End:
    """One end of an element.

    Attributes
    ----------
    body : str
        Attachment name: a body (of a wheelset: its axle, which does not spin), an axlebox, or ``"track"``.
    position : ndarray, shape (3,)
        m, vehicle coordinates at the design position.
    """

    body: str
    position: np.ndarray


@dataclass(frozen=True, eq=False, slots=True)
class Element:
    """A force element between two attachments.

    Attributes
    ----------
    name, group : str
        ``"group.instance"`` and the group.
    type : str
        One of `railsym.vehicle_schema.ELEMENT_TYPES`.
    first, second : End
    axes : ndarray, shape (3, 3)
        Columns are the element's axes in vehicle coordinates at the design position.
    axis : int or None
        None: along the line of the two points, or (bushing) all axes; 0, 1, 2: along or about that column of `axes`.
    parameters : dict
        Name to float, ndarray, `Curve` or (actuator ``mode``) str; SI. Read-only.
    """

    name: str
    group: str
    type: str
    first: End
    second: End
    axes: np.ndarray
    axis: int | None
    parameters: FrozenDict = field(repr=False)
