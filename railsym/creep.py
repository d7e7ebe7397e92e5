# SPDX-License-Identifier: BSD-3-Clause
"""Creep forces of rolling contacts: Kalker linear, Shen-Hedrick-Elkins, Polach, FASTSIM, FaStrip, exact theory.

    forces = creep_forces("fastsim", a, b, creepages, load, friction, Material())

Conventions are those of `railsym.LinearContact`: x in the direction of rolling, y to
the right, z down; creepages of the wheel against the rail, (xi, eta, phi); forces on
the wheel, (Fx, Fy, Mz). The laws are in ``csrc/creep``, one a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from railsym.errors import ContactError
from railsym.kalker import kalker_coefficients

DERIVATIVES = ("xi", "eta", "phi", "load", "friction", "kalker_weight")
_C_NAMES = {"kalker": "kalker_linear"}  # the name that LinearContact uses


@dataclass(frozen=True)
class Material:
    """Elastic material of both bodies.

    Attributes
    ----------
    shear_modulus : float
        G, N/m^2; default 82e9 (steel).
    poisson : float
        Poisson's ratio, 0 to 0.5; default 0.28 (steel).
    """

    shear_modulus: float = 8.2e10
    poisson: float = 0.28

    def __post_init__(self):
        if not (np.isfinite(self.shear_modulus) and self.shear_modulus > 0):
            raise ContactError(f"shear modulus must be positive and finite (N/m^2), got {self.shear_modulus!r}")
        if not 0 <= self.poisson <= 0.5:
            raise ContactError(f"Poisson's ratio must lie between 0 and 0.5, got {self.poisson!r}")


class CreepForces(NamedTuple):
    """Creep forces and their derivatives.

    Attributes
    ----------
    forces : ndarray, shape (..., 3)
        Fx N, Fy N, Mz N m on the wheel.
    derivatives : ndarray, shape (..., 3, 6)
        With respect to `DERIVATIVES`: xi -, eta -, phi 1/m, load N, friction -, Kalker weight -;
        contact ellipse held constant.
    """

    forces: np.ndarray
    derivatives: np.ndarray


def creep_laws():
    """Names of the creep laws, tuple of str."""
    from railsym._core import CREEP_LAWS

    return tuple(CREEP_LAWS)


def creep_forces(law, a, b, creepages, load, friction, material=None, *, kalker_weight=1.0, reduction=(1.0, 1.0),
                 grid=(20, 20), derivatives=False):
    """Tangential forces of steadily rolling elliptic contacts.

    Parameters
    ----------
    law : str
        "kalker_linear" (or "kalker"), "shen_hedrick_elkins", "polach", "fastsim", "fastrip" or "exact";
        see `creep_laws`.
    a, b : float or ndarray, shape (...)
        Semi-axes along x (rolling direction) and y (lateral), m.
    creepages : array_like, shape (..., 3)
        xi -, eta -, spin phi 1/m of the wheel against the rail.
    load : float or ndarray
        Normal load N, N; zero or negative: no force.
    friction : float or ndarray
        Coefficient of friction; zero: no force.
    material : Material, optional
        Default: steel.
    kalker_weight : float or ndarray
        Factor on the initial slope of the law (contamination), positive.
    reduction : pair of float or ndarray
        Polach's reduction factors kA (adhesion) and kS (slip), 0 < kS <= kA <= 1; other laws ignore them.
    grid : pair of int
        FASTSIM, FaStrip: number of strips across, and of cells along each strip.
    derivatives : bool
        Return `CreepForces` with derivatives too.

    Returns
    -------
    ndarray, shape (..., 3), or CreepForces
        Fx N, Fy N, Mz N m on the wheel. Arguments are broadcast against each other.

    Raises
    ------
    ContactError
        For an unknown law, shapes that do not fit, or values that are not finite or outside their range.

    Notes
    -----
    Sources are at the head of each file in ``csrc/creep``, accuracy in ``docs/creep_forces.md``.
    Polach's law has no spin moment: its Mz is zero.
    """
    from railsym import _core

    name = _known(law, _core.CREEP_LAWS)
    material = material or Material()
    values = _checked(a, b, creepages, load, friction, kalker_weight, reduction)
    shape = values[0].shape
    xi, eta, phi, a, b, load, friction, weight, adhesion, slip = (part.ravel() for part in values)
    coefficients = kalker_coefficients(a / b, material.poisson)
    rows = np.stack([xi, eta, phi, a, b, load, friction, np.full(xi.shape, float(material.shear_modulus)), weight,
                     *coefficients, adhesion, slip])
    forces, slopes = _core.creep_forces(name, rows, _checked_grid(grid), derivatives)
    forces = np.ascontiguousarray(forces.T).reshape(*shape, 3)
    if not derivatives:
        return forces
    return CreepForces(forces, np.ascontiguousarray(np.moveaxis(slopes, -1, 0)).reshape(*shape, 3, 6))


def _known(law, laws):
    name = _C_NAMES.get(law, law)
    if name not in laws:
        from difflib import get_close_matches

        near = get_close_matches(str(law), laws, 1)
        raise ContactError(f"unknown creep law {law!r}; there are {', '.join(laws)}"
                           + (f"; did you mean {near[0]!r}?" if near else ""))
    return name


def _checked(a, b, creepages, load, friction, kalker_weight, reduction):
    """xi eta phi a b load friction weight kA kS of one shape; finite and inside their ranges."""
    creepages = np.asarray(creepages, dtype=float)
    if creepages.shape[-1:] != (3,):
        raise ContactError(f"creepages need 3 values a contact in their last axis (xi, eta, phi), got shape {creepages.shape}")
    adhesion, slip = reduction
    named = {"longitudinal creepage (-)": creepages[..., 0], "lateral creepage (-)": creepages[..., 1],
             "spin (1/m)": creepages[..., 2], "semi-axis a (m)": a, "semi-axis b (m)": b, "load (N)": load,
             "friction (-)": friction, "Kalker weight (-)": kalker_weight, "reduction factor kA (-)": adhesion,
             "reduction factor kS (-)": slip}
    arrays = [np.asarray(value, dtype=float) for value in named.values()]
    try:
        values = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{name} {part.shape}" for name, part in zip(named, arrays, strict=True))
        raise ContactError(f"arguments of creep_forces do not broadcast against each other: {shapes}") from None
    positive, not_negative = (3, 4, 7, 8, 9), (6,)
    for number, (name, value) in enumerate(zip(named, values, strict=True)):
        _require(np.isfinite(value), value, name, "finite")
        if number in positive:
            _require(value > 0, value, name, "positive")
        if number in not_negative:
            _require(value >= 0, value, name, "zero or positive")
    return values


def _require(allowed, value, name, wanted):
    if not np.all(allowed):
        first = np.argwhere(~allowed)[0]
        where = f" at contact {', '.join(map(str, first))}" if first.size else ""
        raise ContactError(f"{name} must be {wanted}, got {value[tuple(first)]!r}{where}")


def _checked_grid(grid):
    strips, cells = grid
    if int(strips) != strips or int(cells) != cells or not (1 <= strips <= 10000 and 1 <= cells <= 10000):
        raise ContactError(f"grid needs two whole numbers from 1 to 10000 (strips, cells), got {grid!r}")
    return int(strips), int(cells)
