# SPDX-License-Identifier: BSD-3-Clause
"""Linear laws of the element types: how they deform, and their slopes at the design position.

Curves enter by their slope at zero; a bump stop inside its clearance gives nothing; a Maxwell element has a spring and
a damper in series and carries no static force; a force actuator with constant command only its damping.
"""

from dataclasses import dataclass

import numpy as np

from .deformations import elongation, rotation, translation


@dataclass(frozen=True)
class LinearLaw:
    """Components (m,) of an element in parallel: stiffness, damping; or for `series` a damper on a series spring."""

    stiffness: np.ndarray
    damping: np.ndarray
    series: bool = False


def curve_slope_at_zero(curve):
    """Slope at zero of the monotone cubic (Fritsch-Butland) through a table.

    A table that starts at zero or above is continued as an odd function, the natural reading of a damper or bump
    stop that works both ways.
    """
    x, y = np.asarray(curve.x, float), np.asarray(curve.y, float)
    if x[0] >= 0.0:
        keep = x > 0.0
        zero = y[0] if x[0] == 0.0 else 0.0
        x = np.concatenate([-x[keep][::-1], [0.0], x[keep]])
        y = np.concatenate([-y[keep][::-1], [zero], y[keep]])
    from scipy.interpolate import PchipInterpolator

    return float(PchipInterpolator(x, y).derivative()(0.0))


def _number(parameters, *names):
    """Value of the first of `names` that is given (number or curve), 0 when none is."""
    for name in names:
        value = parameters.get(name)
        if value is None:
            continue
        value = getattr(value, "value", value)
        return curve_slope_at_zero(value) if hasattr(value, "x") else np.asarray(value, float)
    return np.zeros(())


def linear_law(element):
    """Slopes of an element's force components at the design position."""
    given = element.parameters
    if element.type == "bushing":
        parts = [("stiffness", "rotational_stiffness"), ("damping", "rotational_damping")]
        stiffness, damping = (np.concatenate([np.broadcast_to(_number(given, n), 3) for n in pair]) for pair in parts)
        return LinearLaw(stiffness, damping)
    if element.type == "maxwell":
        spring, damper = ("series_stiffness", "series_stiffness_curve"), ("damping", "damping_curve")
        # The curve of the series stiffness is stiffness against speed: its value at zero speed, not a slope.
        series = given.get("series_stiffness_curve")
        stiffness = np.interp(0.0, series.x, series.y) if series is not None else _number(given, *spring)
        return LinearLaw(np.atleast_1d(stiffness), np.atleast_1d(_number(given, *damper)), series=True)
    if element.type == "bump_stop":
        stiffness = _number(given, "curve") if given.get("curve") is not None else 0.0
        return LinearLaw(np.atleast_1d(stiffness), np.zeros(1))
    stiffness = _number(given, "stiffness", "curve") if element.type != "damper" else np.zeros(())
    damping = _number(given, "damping", "curve") if element.type == "damper" else _number(given, "damping")
    if element.type == "actuator" and given.get("mode") == "force":
        stiffness = np.zeros(())
    return LinearLaw(np.atleast_1d(stiffness), np.atleast_1d(damping))


def element_deformation(element, first, second):
    """(J, H) of the element's deformation components, for the motions of its two markers."""
    axes = np.asarray(element.axes, float)
    if element.type == "bushing":
        parts = translation(first, second, axes), rotation(first, second, axes)
        return tuple(np.concatenate(pair) for pair in zip(*parts))
    if element.type == "anti_roll_bar":
        gradient, hessian = rotation(first, second, axes)
        return gradient[:1], hessian[:1]
    if element.axis is None:
        return elongation(first, second)
    return translation(first, second, axes[:, [element.axis]])
