# SPDX-License-Identifier: BSD-3-Clause
"""Units that drawings and reports show: speeds in km/h, the rest as it is."""


def shown(unit):
    """Factor and text of the unit that a result is shown in.

    Parameters
    ----------
    unit : str
        SI.

    Returns
    -------
    (float, str)
    """
    return (3.6, "km/h") if unit == "m/s" else (1.0, "" if unit == "-" else unit)


def labelled(name, unit):
    """A name with its shown unit, for axes."""
    text = shown(unit)[1]
    return f"{name}, {text}" if text else name


def round_range(values):
    """Tick texts of the ends of a range: as short as tells them apart."""
    low, high = float(min(values)), float(max(values))
    if low == high:
        return f"{low:.4g}", ""
    for digits in range(3, 8):
        texts = f"{low:.{digits}g}", f"{high:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts
