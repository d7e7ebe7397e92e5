# SPDX-License-Identifier: BSD-3-Clause
"""Strict reading of the values of a track's TOML files."""

import numpy as np

from railsym.errors import TrackError
from railsym.units import UnitError, to_si
from railsym.vehicle_checks import Problem, numeric, unknown


class Reader:
    """Checks of one document; errors name file, key, value, what is allowed and the nearest match.

    Attributes
    ----------
    origins : dict of str to str
        Keys that a number may name as third entry.
    """

    def __init__(self, file):
        self.file, self.origins = file, {}

    def problem(self, key, value, text):
        """The error to raise."""
        shown = "" if value is None else f" = {value!r}" if len(repr(value)) <= 80 else f" = {repr(value)[:77]}..."
        return TrackError(f"{self.file}: {key}{shown}: {text}")

    def table(self, key, table, allowed, required=()):
        """The table itself, if it holds nothing but ``allowed`` keys and all of ``required``."""
        if not isinstance(table, dict):
            raise self.problem(key, table, "a table is needed")
        prefix = f"{key}." if key else ""
        for name in table:
            if name not in allowed:
                raise self.problem(prefix + name, None, "key is " + unknown(name, allowed, "allowed keys"))
        for name in required:
            if name not in table:
                raise self.problem(prefix + name, None, f"is missing (needed keys: {', '.join(required)})")
        return table

    def text(self, key, value, allowed=None):
        """A string, one of ``allowed`` when given."""
        if not isinstance(value, str):
            raise self.problem(key, value, "a text is needed")
        if allowed is not None and value not in allowed:
            raise self.problem(key, value, unknown(value, allowed))
        return value

    def quantity(self, key, entry, unit, count=None, low=None):
        """``[value, "unit"]`` or ``[value, "unit", "origin-key"]`` in the given SI unit.

        ``count`` None asks for a single number, -1 for any list, else for a list of so many.
        """
        if not isinstance(entry, list) or len(entry) not in (2, 3) or not all(isinstance(part, str) for part in entry[1:]):
            raise self.problem(key, entry, f'a number is written [value, "unit"], here with a unit such as "{unit}"')
        if len(entry) == 3 and entry[2] not in self.origins:
            raise self.problem(key, entry, "origin is " + unknown(entry[2], self.origins, "keys of [origins]"))
        try:
            value = to_si(numeric(key, entry[0]), entry[1], unit)
        except (UnitError, Problem) as error:
            raise self.problem(key, entry, str(error)) from None
        if (count is None) != (np.ndim(value) == 0) or (count not in (None, -1) and len(value) != count):
            raise self.problem(key, entry, "a single number is needed" if count is None else f"a list of {'' if count == -1 else count} numbers is needed")
        if np.isnan(value).any():
            raise self.problem(key, entry, "is not a number")
        if low is not None and not np.all(value >= low):
            raise self.problem(key, entry, f"allowed are numbers from {low:g} {unit} on")
        return value
