# SPDX-License-Identifier: BSD-3-Clause
"""Reading tables of a study file: known keys, numbers with their units."""

from __future__ import annotations

import math

from railsym.campaign.errors import CampaignError
from railsym.units import UnitError, to_si
from railsym.vehicle_checks import unknown


def known(where, table, allowed):
    """The table, if it is one and holds nothing else.

    Raises
    ------
    CampaignError
    """
    if not isinstance(table, dict):
        raise CampaignError(f"{where} is {table!r}; a table with {', '.join(allowed)} is needed")
    for name in table:
        if name not in allowed:
            raise CampaignError(f"{where} {name} is {unknown(name, allowed, 'keys')}")
    return table


def quantities(where, entry, unit, count=None):
    """Numbers with their unit, ``[value, "unit"]`` or ``[[value, ...], "unit"]``, in SI.

    Parameters
    ----------
    where : str
    entry : list
    unit : str
        SI.
    count : int, optional
        How many; one number when not given.

    Returns
    -------
    float or list of float

    Raises
    ------
    CampaignError
    """
    example = f'[1.0, "{unit}"]' if count is None else f'[[{", ".join(["1.0"] * count)}], "{unit}"]'
    if not (isinstance(entry, list) and len(entry) == 2 and isinstance(entry[1], str)):
        raise CampaignError(f"{where} = {entry!r}: a number is written with its unit, such as {example}")
    values = [entry[0]] if count is None else entry[0]
    if not (isinstance(values, list) and (count is None or len(values) == count) and all(_number(v) for v in values)):
        raise CampaignError(f"{where} = {entry!r} cannot be read; write {example}")
    try:
        found = [float(to_si(float(v), entry[1], unit)) for v in values]
    except UnitError as error:
        raise CampaignError(f"{where}: {error}") from None
    return found[0] if count is None else found


def _number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def whole(where, value, least):
    """A whole number from `least` on.

    Raises
    ------
    CampaignError
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise CampaignError(f"{where} = {value!r}: a whole number from {least} on is needed")
    return value


def fraction(where, value):
    """A number between 0 and 1.

    Raises
    ------
    CampaignError
    """
    if not _number(value) or not 0.0 < value < 1.0:
        raise CampaignError(f"{where} = {value!r}: a number between 0 and 1 is needed")
    return float(value)


def truth(where, value):
    """true or false.

    Raises
    ------
    CampaignError
    """
    if not isinstance(value, bool):
        raise CampaignError(f"{where} = {value!r}: true or false is needed")
    return value
