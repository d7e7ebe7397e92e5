# SPDX-License-Identifier: BSD-3-Clause
"""Checks of single values of a vehicle, and the text of their errors."""

import difflib

import numpy as np

from railsym.errors import VehicleFileError
from railsym.vehicle_schema import RULES

# Rounding allowance of the triangle inequality of principal inertias: equality is a flat plate and permitted.
_PLATE_TOLERANCE = 1e-9


class Problem(Exception):
    """What is wrong with one key; `vehicle_error` turns it into the error that the user sees."""

    def __init__(self, key, value, text):
        super().__init__(text)
        self.key, self.value, self.text = key, value, text


def vehicle_error(file, key, value, text):
    """The one form of error: file, key, value, what is wrong and allowed.

    Parameters
    ----------
    file : str
        Name of the file or vehicle.
    key : str
        Dotted key.
    value : object
        As given; None when there is none to show.
    text : str

    Returns
    -------
    VehicleFileError
    """
    shown = "" if value is None else f" = {_shown(value)}"
    return VehicleFileError(f"{file}: {key}{shown}: {text}")


def _shown(value):
    text = repr(value.tolist()) if isinstance(value, np.ndarray) else repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def unknown(name, allowed, what="allowed"):
    """Text that lists what exists, with the nearest match first.

    Parameters
    ----------
    name : str
    allowed : iterable of str
    what : str
        Noun of the list, for example "bodies".
    """
    allowed = list(allowed)
    near = difflib.get_close_matches(str(name), allowed, n=1, cutoff=0.4)
    nearest = f"; nearest: {near[0]!r}" if near else ""
    if len(allowed) > 16:
        close = difflib.get_close_matches(str(name), allowed, n=6, cutoff=0.3)
        return f"unknown{nearest} ({what}: {len(allowed)} names, among them {', '.join(close or allowed[:6])})"
    return f"unknown{nearest} ({what}: {', '.join(allowed) if allowed else 'none'})"


def checked_value(key, raw, field):
    """A number or array that fits its field, as float or read-only ndarray.

    Parameters
    ----------
    key : str
    raw : object
        Number, list of numbers or array, already in SI.
    field : Field

    Raises
    ------
    Problem
    """
    value = numeric(key, raw)
    shape = () if isinstance(value, float) else value.shape
    if shape not in field.shapes and not ((-1,) in field.shapes and len(shape) == 1 and shape[0] >= 2):
        raise Problem(key, raw, f"holds {_counted(shape)}; allowed: {_shapes_text(field.shapes)}")
    test, allowed = RULES[field.rule]
    if not np.all(test(value)):
        raise Problem(key, raw, f"allowed are {allowed} (in {field.unit})")
    return value


def numeric(key, raw):
    """A number or list of numbers of any kind as float, or as ndarray of float that cannot be written to.

    Raises
    ------
    Problem
    """
    if not _is_numeric(raw):
        raise Problem(key, raw, "a number or a list of numbers is needed")
    try:
        array = np.array(raw, dtype=float)
    except OverflowError:
        raise Problem(key, raw, "the number is too large") from None
    if array.ndim == 0:
        return float(array)
    array.setflags(write=False)
    return array


def _is_numeric(raw):
    if isinstance(raw, np.ndarray):
        return raw.dtype.kind in "iuf"
    items = raw if isinstance(raw, (list, tuple)) else (raw,)
    return all(isinstance(i, (int, float, np.integer, np.floating)) and not isinstance(i, bool) for i in items)


def _counted(shape):
    return "a single number" if shape == () else f"{shape[0]} numbers" if len(shape) == 1 else f"an array of shape {shape}"


def _shapes_text(shapes):
    if shapes == ((-1,),):
        return "a list of at least 2 numbers"
    return " or ".join("a single number" if shape == () else f"a list of {shape[0]} numbers" for shape in shapes)


def inertia_tensor(key, value):
    """Inertia tensor of 3 principal values or the 6 tensor entries xx yy zz xy yz xz.

    Parameters
    ----------
    key : str
    value : ndarray, shape (3,) or (6,)
        kg m^2

    Returns
    -------
    ndarray, shape (3, 3)
        Read-only.

    Raises
    ------
    Problem
        If no rigid body can have this tensor: it must be positive definite, and each principal value at most the sum of the
        other two (as the integrals of y^2 + z^2, z^2 + x^2, x^2 + y^2 over the mass are).
    """
    tensor = np.diag(value[:3])
    if value.size == 6:
        xy, yz, xz = value[3:]
        tensor += np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])
    principal = np.sort(value) if value.size == 3 else np.linalg.eigvalsh(tensor)
    shown = ", ".join(f"{p:.6g}" for p in principal)
    if principal[0] <= 0.0:
        raise Problem(key, value, f"no body has this inertia: its principal values ({shown} kg*m^2) must all be above 0")
    if principal[2] > (principal[0] + principal[1]) * (1.0 + _PLATE_TOLERANCE):
        raise Problem(
            key, value,
            f"no body has this inertia: of its principal values ({shown} kg*m^2) the largest may not exceed the sum of the others",
        )
    tensor.setflags(write=False)
    return tensor


def check_axisymmetric(key, tensor, value):
    """Require of a wheelset that it looks the same at every angle of spin: Ixx = Izz, no products.

    Raises
    ------
    Problem
    """
    scale = np.abs(tensor).max() * 1e-9
    products = np.abs(tensor - np.diag(np.diag(tensor))).max()
    if abs(tensor[0, 0] - tensor[2, 2]) > scale or products > scale:
        raise Problem(key, value, "a wheelset spins about y, so Ixx must equal Izz and the products of inertia must be 0")
