# SPDX-License-Identifier: BSD-3-Clause
"""From the parameters of an element to the record of its scalar force law in C."""

from functools import lru_cache

import numpy as np

from railsym.errors import ModelError


def law_record(element):
    """Record for `railsym._core.Laws` of a line or axis element.

    Raises
    ------
    ModelError
        A curve that starts above zero, so that its other half is unknown.
    """
    parameters = element.parameters
    make = _MAKERS[element.type]
    return make(parameters, element)


def slope_at_rest(element):
    """Stiffness of a line or axis element at its design position, N/m.

    A Maxwell element, a damper and a stop inside its clearance carry no static force.
    """
    if element.type not in ("spring", "traction_rod"):
        record = law_record(element)
        return record["stiffness"] if record["kind"] == "actuator_length" else 0.0
    record = law_record(element)
    curve = record.get("stiffness_curve")
    return record.get("stiffness", 0.0) + (curve_slope(curve, 0.0) if curve is not None else 0.0)


def curve_slope(table, at):
    """Slope of a cubic table (breakpoints, coefficients) at ``at``."""
    x, c = table
    piece = int(np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(c) - 1))
    t = at - x[piece]
    return c[piece, 1] + t * (2 * c[piece, 2] + 3 * t * c[piece, 3])


def cubic_table(curve, element):
    """Breakpoints (n,) and coefficients (n - 1, 4) of the monotone cubic through a curve.

    Fritsch and Butland's slopes (SciPy's PchipInterpolator). A curve that begins at (0, 0)
    is one half of an odd one.
    """
    x, y = np.asarray(curve.x, dtype=float), np.asarray(curve.y, dtype=float)
    if x[0] > 0.0 or (x[0] == 0.0 and y[0] != 0.0):
        raise ModelError(f"{element.name}: curve {curve.name!r} begins at ({x[0]:g} {curve.x_unit}, {y[0]:g} "
                         f"{curve.y_unit}); begin at (0, 0) for a symmetric law or below 0 for both directions")
    return _pchip(*_odd(x, y)) if x[0] == 0.0 else _pchip(tuple(x), tuple(y))


def half_table(curve):
    """As `cubic_table` for a curve over a magnitude (stop, stiffness over speed); it is not mirrored."""
    return _pchip(tuple(curve.x), tuple(curve.y))


def held_table(curve):
    """As `half_table`, held at its last value beyond its end: a stiffness stays positive."""
    x, c = half_table(curve)
    return np.append(x, 2.0 * x[-1] - x[0]), np.vstack([c, [curve.y[-1], 0.0, 0.0, 0.0]])


def _odd(x, y):
    return tuple(np.concatenate([-x[:0:-1], x])), tuple(np.concatenate([-y[:0:-1], y]))


@lru_cache(maxsize=256)
def _pchip(x, y):
    from scipy.interpolate import PchipInterpolator

    return np.array(x), np.ascontiguousarray(PchipInterpolator(x, y).c[::-1].T)


def _spring(p, element):
    table = cubic_table(p["curve"], element) if "curve" in p else None
    return {"kind": "spring_damper", "stiffness": p.get("stiffness", 0.0), "stiffness_curve": table}


def _damper(p, element):
    curve = p.get("curve", p.get("damping_curve"))
    table = cubic_table(curve, element) if curve is not None else None
    return {"kind": "spring_damper", "damping": p.get("damping", 0.0), "damping_curve": table}


def _maxwell(p, element):
    damping, stiffness = p.get("damping_curve"), p.get("series_stiffness_curve")
    return {
        "kind": "maxwell",
        "damping": p.get("damping", 0.0),
        "damping_curve": cubic_table(damping, element) if damping is not None else None,
        "stiffness": p.get("series_stiffness", 0.0),
        "stiffness_curve": held_table(stiffness) if stiffness is not None else None,
    }


def _bump_stop(p, element):
    if "curve" in p and p["curve"].x[0] < 0.0:  # both sides given: they may differ
        return {"kind": "spring_damper", "stiffness_curve": cubic_table(p["curve"], element)}
    table = half_table(p["curve"]) if "curve" in p else None
    return {"kind": "bump_stop", "clearance": p.get("clearance", 0.0), "stiffness": p.get("stiffness", 0.0),
            "stiffness_curve": table}


def _traction_rod(p, element):
    return {"kind": "spring_damper", "stiffness": p["stiffness"], "damping": p.get("damping", 0.0)}


def _actuator(p, element):
    limits = {key: p.get(key, np.inf) for key in ("rate_limit", "force_limit")}
    return {"kind": f"actuator_{p['mode']}", "keep": True} | {key: p.get(key, 0.0) for key in _ACTUATOR_NUMBERS} | {
        key: 0.0 if np.isinf(limit) else limit for key, limit in limits.items()}


_ACTUATOR_NUMBERS = "stiffness", "damping", "lag", "bypass_damping"

_MAKERS = {
    "spring": _spring,
    "damper": _damper,
    "maxwell": _maxwell,
    "bump_stop": _bump_stop,
    "traction_rod": _traction_rod,
    "actuator": _actuator,
}
