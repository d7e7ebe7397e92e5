# SPDX-License-Identifier: BSD-3-Clause
"""Left-right symmetry of a linear model: find it, prove it on the matrices, split the equations in two.

Mirroring a motion swaps what stands left and right and turns the sign of y, yaw and roll. When the matrices commute with it,
the motions that mirroring leaves as they are (bounce, pitch, surge) and those that it turns round (sway, yaw, roll, hunting)
do not see each other, and two problems of half the size replace one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from railsym.linear_model import MATRICES, LinearModel
from railsym.topology import has_state

# sign of a coordinate under y -> -y: vectors turn their y, axial vectors their x and z components
_SIGN = {"x": 1.0, "y": -1.0, "z": 1.0, "yaw": -1.0, "roll": -1.0, "pitch": 1.0, "spin": 1.0}
_PLACE = 1e-6               # m, two positions that differ less are one
_DIFFERENCE = 1e-9          # of the largest entry in a row: assembling in another order moves the last digits only
_ROUNDING = 1e-14           # of the largest entry of a matrix

# of models that others were made from: bases without contact, templates with other numbers
_known_mirrors = WeakKeyDictionary()
_known_halves = WeakKeyDictionary()           # (antisymmetric, symmetric) LinearModel


@dataclass(frozen=True, eq=False)
class Part:
    """One half of a symmetric model, or the whole of an unsymmetric one.

    Attributes
    ----------
    parity : int
        +1 motions equal to their mirror image, -1 motions opposite to it, 0 the whole model.
    first, second : ndarray of int
        The coordinates combined in each coordinate of the part (equal where a coordinate is its own image).
    weight_first, weight_second : ndarray
        Their factors.
    whole : LinearModel
        The model that was split.
    known : LinearModel or None
        The same half of the base or template of the whole: only the matrices that differ are folded.
    """

    parity: int
    first: np.ndarray
    second: np.ndarray
    weight_first: np.ndarray
    weight_second: np.ndarray
    whole: LinearModel
    known: LinearModel | None = None

    @cached_property
    def model(self) -> LinearModel:
        """The matrices of the part, in coordinates that are orthonormal combinations of those of the whole."""
        whole = self.whole
        if self.parity == 0:
            return whole
        if self.known is not None:
            origin = whole.base or whole.template
            changed = {name: self._folded(getattr(whole, name)) for name in MATRICES if getattr(whole, name) is not getattr(origin, name)}
            related = {"base": self.known} if origin is whole.base else {"template": self.known}
            return replace(self.known, **changed, vehicle=whole.vehicle, contact=whole.contact, **related)
        translation = whole.uniform_translation
        if translation is not None:
            translation = self.weight_first * translation[self.first] + self.weight_second * translation[self.second]
        return LinearModel(tuple(whole.coordinates[i] for i in self.first), *(self._folded(getattr(whole, name)) for name in MATRICES),
                           whole.first_order[self.first], whole.cyclic[self.first], whole.vehicle, whole.contact,
                           translation=np.zeros(len(self.first)) if translation is None else translation)

    def _folded(self, matrix):
        # the matrix commutes with the mirroring: a row of the image gives nothing that the row itself does not give
        rows = matrix[self.first]
        columns = rows[:, self.first] * self.weight_first + rows[:, self.second] * self.weight_second
        return columns / self.weight_first[:, None]

    def expand(self, shape: np.ndarray) -> np.ndarray:
        """Vectors of the part (m, ...) as vectors of the whole (n, ...)."""
        axes = (slice(None),) + (None,) * (shape.ndim - 1)
        result = np.zeros((self.whole.size,) + shape.shape[1:], dtype=shape.dtype)
        result[self.first] += self.weight_first[axes] * shape
        result[self.second] += self.weight_second[axes] * shape
        return result


def split(model: LinearModel) -> tuple[Part, ...]:
    """The antisymmetric and the symmetric part of a model, or one part that is the model itself.

    Parameters
    ----------
    model : LinearModel
        With `mirror`, or with a vehicle whose bodies and Maxwell elements stand in mirrored places.

    Returns
    -------
    tuple of Part
        (antisymmetric, symmetric) when all matrices commute with the mirroring to 1e-9 of each row, else (whole,).
    """
    mirror = find_mirror(model)
    if mirror is None:
        index, one = np.arange(model.size), np.ones(model.size)
        return (Part(0, index, index, one, 0 * one, model),)
    known = model.base or model.template
    if known is None or mirror is not _known_mirrors.get(known):
        return tuple(_part(model, mirror, parity) for parity in (-1, 1))
    if known not in _known_halves:
        _known_halves[known] = [_part(known, mirror, parity).model for parity in (-1, 1)]
    return tuple(_part(model, mirror, parity, half) for parity, half in zip((-1, 1), _known_halves[known]))


def find_mirror(model: LinearModel) -> tuple[np.ndarray, np.ndarray] | None:
    """Permutation and signs of the mirroring that all matrices commute with, or None."""
    names, known = MATRICES, model.base or model.template
    if model.mirror is not None:
        mirror = model.mirror
    elif known is None:
        mirror = _mirror_of_vehicle(model)
    else:
        # the same coordinates, and mostly the same matrices: those were looked at already
        if known not in _known_mirrors:
            _known_mirrors[known] = find_mirror(known)
        mirror = _known_mirrors[known]
        names = [name for name in MATRICES if getattr(model, name) is not getattr(known, name)]
    return mirror if mirror is not None and all(_commutes(getattr(model, name), *mirror) for name in names) else None


def _commutes(matrix, permutation, sign) -> bool:
    # an entry without counterpart is found from its own side, so looking at the entries that are not zero is enough
    place = np.flatnonzero(matrix != 0.0)          # of truth values: ten times as fast as of numbers
    if not len(place):
        return True
    row, column = np.divmod(place, len(matrix))
    value = matrix.ravel()[place]
    image = matrix.ravel()[permutation[row] * len(matrix) + permutation[column]] * (sign[row] * sign[column])
    first = np.flatnonzero(np.diff(row, prepend=-1))
    largest = np.zeros(len(matrix))
    largest[row[first]] = np.maximum.reduceat(np.abs(value), first)
    # rows that are zero but for rounding are measured against the whole matrix
    allowed = np.maximum(_DIFFERENCE * largest, _ROUNDING * largest.max())
    return bool((np.abs(image - value) <= allowed[row]).all())


def _part(model: LinearModel, mirror, parity: int, known: LinearModel | None = None) -> Part:
    """One half of a model."""
    permutation, sign = mirror
    index = np.arange(model.size)
    keep = (index < permutation) | ((index == permutation) & (sign == parity))
    first, second = index[keep], permutation[keep]
    alone = first == second
    weight_first = np.where(alone, 1.0, np.sqrt(0.5))
    weight_second = np.where(alone, 0.0, parity * sign[first] * np.sqrt(0.5))
    return Part(parity, first, second, weight_first, weight_second, model, known)


def _mirror_of_vehicle(model: LinearModel):
    """Pair the coordinates by the places of their bodies and elements; None when something has no counterpart."""
    if getattr(model.vehicle, "bodies", None) is None:
        return None
    images = _body_images(model.vehicle.bodies)
    if images is None:
        return None
    place = {name: i for i, name in enumerate(model.coordinates)}
    elements = _element_images(model.vehicle.elements, images) if model.first_order.any() else {}
    permutation, sign = np.empty(model.size, int), np.ones(model.size)
    for i, name in enumerate(model.coordinates):
        image = _image_of_coordinate(name, bool(model.first_order[i]), images, elements)
        if image not in place:
            return None
        permutation[i] = place[image]
        sign[i] = 1.0 if model.first_order[i] else _SIGN[name.rpartition(".")[2]]
    return permutation, _sign_of_elongations(model, permutation, sign)


def _image_of_coordinate(name, internal, images, elements):
    owner, _, last = name.rpartition(".")
    if internal:
        return f"{elements.get(owner)}.{last}"
    return f"{_attachment_image(owner, images)}.{last}"


def _attachment_image(name, images):
    body, _, box = name.partition(".")
    other = {"axlebox_left": "axlebox_right", "axlebox_right": "axlebox_left"}.get(box, box)
    return images.get(body, body) + ("." + other if box else "")


def _key(position, flip=1.0):
    x, y, z = position
    return round(float(x) / _PLACE), round(flip * float(y) / _PLACE), round(float(z) / _PLACE)


def _body_images(bodies):
    """Name of each body -> name of the body in its mirrored place, of the same mass."""
    places = {(_key(b.position), round(b.mass, 6)): b.name for b in bodies}
    if len(places) < len(bodies):
        return None
    images = {b.name: places.get((_key(b.position, -1.0), round(b.mass, 6))) for b in bodies}
    return None if None in images.values() else images


def _element_images(elements, images):
    """Name of each element with a state -> name of the one of its group between the mirrored places of the mirrored bodies."""
    inner = [e for e in elements if has_state(e)]
    places = {(e.group, e.first.body, e.second.body, _key(e.first.position), _key(e.second.position)): e.name for e in inner}
    return {e.name: places.get((e.group, _attachment_image(e.first.body, images), _attachment_image(e.second.body, images),
                                _key(e.first.position, -1.0), _key(e.second.position, -1.0))) for e in inner}


def _sign_of_elongations(model, permutation, sign):
    """An elongation and its image are equal or opposite: read it from the rows of K over second-order coordinates."""
    internal, outer = np.flatnonzero(model.first_order), np.flatnonzero(~model.first_order)
    row = model.stiffness[np.ix_(internal, outer)]
    image = model.stiffness[np.ix_(permutation[internal], permutation[outer])] * sign[outer]
    sign[internal] = np.where((row * image).sum(axis=1) < 0, -1.0, 1.0)
    return sign
