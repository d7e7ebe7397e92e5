# SPDX-License-Identifier: BSD-3-Clause
"""Limits as data, with edition and trust mark, and values held against them."""

from __future__ import annotations

import difflib
import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from railsym.criteria.errors import CriterionError

TRUST = {"V2": "two independent sources agree", "V1": "one source", "R": "recalled, unverified"}
_KILO = {"kN": ("N", 1e3), "kN*m": ("N*m", 1e3), "km/h": ("m/s", 1 / 3.6)}


@dataclass(frozen=True)
class Limit:
    """A limit or a constant of a criterion.

    Attributes
    ----------
    name : str
    value : float or tuple of float
        In ``unit``, SI.
    unit : str
    trust : str
        V2 (two independent sources), V1 (one source) or R (recalled, unverified), as in the data file; ``given`` by the caller.
    edition, clause, origin, meaning : str
    """

    name: str
    value: float | tuple
    unit: str
    trust: str
    edition: str = ""
    clause: str = ""
    origin: str = ""
    meaning: str = ""

    @property
    def trusted(self):
        """False for a value that is only recalled: no verdict is given on it."""
        return self.trust != "R"

    def derived(self, value, unit, meaning, *others):
        """A limit computed from this one and ``others``, as far to trust as the weakest of them."""
        trust = min((self, *others), key=lambda limit: ("R", "V1", "V2", "given").index(limit.trust)).trust
        return Limit(self.name, float(value), unit, trust, self.edition, self.clause, self.origin, meaning)


@dataclass(frozen=True)
class Assessed:
    """A value held against a limit.

    Attributes
    ----------
    name : str
        Such as ``"Y/Q wheelset1.left"``.
    value : float
    unit : str
    limit : Limit or None
        None where there is none, or none was asked for.
    """

    name: str
    value: float
    unit: str
    limit: Limit | None = None

    @property
    def ratio(self):
        """|value| over the limit; None without a limit."""
        return None if self.limit is None else abs(self.value) / self.limit.value

    @property
    def over(self):
        """Whether |value| is above the limit's number; None without a limit. No verdict where ``limit.trusted`` is False."""
        return None if self.limit is None else bool(abs(self.value) > self.limit.value)

    @property
    def verdict(self):
        """In words: over or within the limit; for an R limit only how the numbers compare, without a verdict."""
        if self.limit is None:
            return "no limit"
        side = "over" if self.over else "within"
        bound = f"{_number(self.limit.value, self.unit)} ({self.limit.trust})"
        if self.limit.trusted:
            return f"{side} the limit {bound}"
        return f"{'above' if self.over else 'below'} {bound}: recalled and unverified, so no verdict"

    def __str__(self):
        return f"{self.name}: {_number(self.value, self.unit)}, {self.verdict}"


def _number(value, unit):
    if unit == "N":
        return f"{value / 1e3:.4g} kN"
    return f"{value:.4g}" + ("" if unit == "-" else f" {unit}")


@cache
def data(standard):
    """The data file of a standard, as tables: ``instability``, ``wheel_rail_forces`` or ``comfort``."""
    return tomllib.loads(files("railsym").joinpath("data", "criteria", f"{standard}.toml").read_text(encoding="utf-8"))


@cache
def _all():
    found = {}
    for standard in ("instability", "wheel_rail_forces", "comfort"):
        for name, entry in data(standard)["limits"].items():
            if "value" in entry:
                found[name] = _limit(name, entry, *entry["value"])
    return found


def _limit(name, entry, value, unit):
    unit, factor = _KILO.get(unit, (unit, 1.0))
    value = tuple(v * factor for v in value) if isinstance(value, list) else value * factor
    return Limit(name, value, unit, entry["trust"], entry["edition"], entry.get("clause", ""), entry["origin"], entry["meaning"])


def limits(name=None):
    """Limits and constants of the criteria, SI.

    Parameters
    ----------
    name : str, optional
        Such as ``"YQ"``.

    Returns
    -------
    Limit, or dict of str to Limit

    Raises
    ------
    CriterionError
        An unknown name.
    """
    if name is None:
        return dict(_all())
    if name not in _all():
        lower = {known.lower(): known for known in _all()}
        near = [lower[found] for found in difflib.get_close_matches(name.lower(), lower, n=3)]
        raise CriterionError(f"there is no limit {name!r}{'; near: ' + ', '.join(near) if near else ''}; there are {', '.join(_all())}")
    return _all()[name]


def wheel_load_limit(static_load, speed):
    """Largest Q (N) of a wheel of static load Q0 (N) at the vehicle's highest speed (m/s): min(Q0 + 90 kN, by speed).

    Returns
    -------
    Limit
    """
    entry = data("wheel_rail_forces")["limits"]["Q_by_speed"]
    over, bounds = limits("Q_over_static"), [v / 3.6 for v in entry["speeds"][0]]
    # a speed of 160 km/h given in m/s is 160 km/h to rounding
    by_speed = 1e3 * entry["values"][0][sum(speed > bound * (1 + 1e-9) for bound in bounds)]
    table = _limit("Q", entry, by_speed, "N")
    return table.derived(min(static_load + over.value, by_speed), "N", "min(Q0 + 90 kN, limit by speed)", over)


def sum_Y_limit(static_load, k1=None):
    """Largest sum of Y (N) of a wheelset whose wheels carry Q0 (N) each: k1 (10 kN + 2 Q0/3), after Prud'homme.

    Parameters
    ----------
    static_load : float
        N, of one wheel.
    k1 : float, optional
        1.0 (coaches, locomotives) if not given, 0.85 for freight wagons.

    Returns
    -------
    Limit
    """
    offset, share, coach = limits("sum_Y_offset"), limits("sum_Y_share"), limits("sum_Y_k1_coach")
    k1 = coach.value if k1 is None else float(k1)
    return offset.derived(k1 * (offset.value + share.value * static_load), "N", "k1 (10 kN + 2 Q0/3)", share, coach)


def scale_class(scale, value):
    """Class of a value on a scale of the comfort data, with its trust mark in brackets."""
    entry = data("comfort")["scales"][scale]
    bounds = entry["bounds"][0]
    mark = entry["trust"] if entry["trust"] != "R" else "scale recalled, R"
    return f"{entry['classes'][sum(value >= bound for bound in bounds)]} ({mark})"
