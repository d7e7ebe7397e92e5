# SPDX-License-Identifier: BSD-3-Clause
"""Units that drawings and reports of studies show."""


_SHOWN = {"m/s": (3.6, "km/h"), "N/m": (1e-6, "MN/m"), "N*s/m": (1e-3, "kN*s/m"), "N*m/rad": (1e-6, "MN*m/rad"), "N*m*s/rad": (1e-3, "kN*m*s/rad"),
          "-": (1.0, "")}


def shown(unit):
    """Factor and text of the unit that a number is shown in: speeds in km/h, stiffnesses in MN/m, dampings in kN*s/m, the rest as it is.

    Parameters
    ----------
    unit : str
        SI.

    Returns
    -------
    (float, str)
    """
    return _SHOWN.get(unit, (1.0, unit))


def short(value, digits=4):
    """A number with some digits, without an exponent where it is of a usual size: 44660, not 4.466e+04."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+0" in text and abs(value) < 1e7 else text


def labelled(name, unit):
    """A name with its shown unit, for axes."""
    text = shown(unit)[1]
    return f"{name}, {text}" if text else name


def round_range(values):
    """Tick texts of the ends of a range: as short as tells them apart."""
    low, high = float(min(values)), float(max(values))
    if low == high:
        return short(low), ""
    for digits in range(3, 8):
        texts = short(low, digits), short(high, digits)
        if texts[0] != texts[1]:
            break
    return texts
