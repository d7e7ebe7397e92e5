# SPDX-License-Identifier: BSD-3-Clause
"""Quasi-linear creep forces: the describing function of a saturating creep law.

A creep law gives |F| = mu N g(u), u = |F_linear|/(mu N), with g(u) -> u for
small u (Kalker's linear theory) and g <= 1.  Under a sinusoidal creepage that
makes F_linear = mu N U sin(t), the linear law G(U) F_linear that fits the real
force best in the mean square is also the one with the same first harmonic:

    G(U) = 1/(pi U) int_0^{2 pi} g(U sin t) sin t dt        (g odd)          (1)

(A. Gelb, W.E. Vander Velde, Multiple-Input Describing Functions, McGraw-Hill
1968, chapter 2).  G(0) = 1, G falls with U, and G -> 4/(pi U) for large U, the
value of dry friction.  (1) is evaluated in closed form, without approximation:

Shen, Hedrick, Elkins (1983):  g = u - u^2/3 + u^3/27 for u < 3, else 1

    U <= 3:  G = 1 - 8 U/(9 pi) + U^2/36                                    (2)
    U > 3, s = 3/U, c = sqrt(1 - s^2):
        G = 4/pi [ I2 - (U/3) I3 + (U^2/27) I4 + c/U ]                      (3)
        I_n = int_0^{asin s} sin^n t dt

Polach (1999), longitudinal and lateral creepage:
    g = (2/pi)(e/(1 + e^2) + atan e), e = pi u/4

    G = 1/sqrt(1 + (pi U/4)^2)                                              (4)
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ContactError

LAWS = ("shen_hedrick_elkins", "polach", "kalker")

_FULL_SLIDING = 3.0  # u at which the Shen-Hedrick-Elkins law reaches mu N
_SERIES_BELOW = 0.1  # s = 3/U below which I4 is summed as a series
# int_0^s x^4/sqrt(1 - x^2) dx = sum_k binomial(2k, k)/4^k s^(5+2k)/(5+2k); 8 terms leave 1e-17 at s = 0.1.
_SERIES = tuple(np.cumprod([1.0] + [(2 * k - 1) / (2 * k) for k in range(1, 8)]) / (5.0 + 2.0 * np.arange(8)))


def creep_force_ratio(saturation, law: str = "shen_hedrick_elkins"):
    """The creep law itself: |F|/(mu N) against u = |F_linear|/(mu N).

    Parameters
    ----------
    saturation : float or ndarray
        u, not negative.
    law : str
        One of `LAWS`; "kalker" has no saturation.

    Returns
    -------
    ndarray
        g(u).

    Raises
    ------
    ContactError
        For an unknown law or a negative or NaN u.
    """
    u = _checked_saturation(saturation)
    check_law(law)
    if law == "kalker":
        return u
    if law == "polach":
        e = np.pi / 4.0 * u
        return 2.0 / np.pi * (e / (1.0 + e**2) + np.arctan(e))
    below = np.minimum(u, _FULL_SLIDING)
    return below - below**2 / 3.0 + below**3 / 27.0


def creep_gain(saturation, law: str = "shen_hedrick_elkins"):
    """Describing-function gain G(U) of a creep law, equations (2)-(4).

    Parameters
    ----------
    saturation : float or ndarray
        U, amplitude of the linear creep force over mu N; not negative.
    law : str
        One of `LAWS`; "kalker" gives 1 everywhere.

    Returns
    -------
    ndarray
        Gain, 0 < G <= 1.

    Raises
    ------
    ContactError
        For an unknown law or a negative or NaN U.
    """
    amplitude = _checked_saturation(saturation)
    check_law(law)
    if law == "kalker":
        return np.ones_like(amplitude)
    if law == "polach":
        return 1.0 / np.hypot(1.0, np.pi / 4.0 * amplitude)
    below = np.minimum(amplitude, _FULL_SLIDING)
    gain = 1.0 - 8.0 / (9.0 * np.pi) * below + below**2 / 36.0
    if np.any(amplitude > _FULL_SLIDING):
        gain = np.where(amplitude > _FULL_SLIDING, _sliding_gain(np.maximum(amplitude, _FULL_SLIDING)), gain)
    return gain


def check_law(law: str) -> None:
    """Raise ContactError for a creep law that does not exist."""
    if law not in LAWS:
        from difflib import get_close_matches
        near = get_close_matches(str(law), LAWS, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ContactError(f"creep law {law!r} does not exist; laws: {', '.join(LAWS)}{hint}")


def _sliding_gain(amplitude):
    """Equation (3), U >= 3, with the integrals free of cancellation at large U."""
    s = _FULL_SLIDING / amplitude
    c = np.sqrt((1.0 - s) * (1.0 + s))
    theta = np.arcsin(s)
    i2 = 0.5 * (theta - s * c)
    i3 = (s**2 / (1.0 + c)) ** 2 * (2.0 + c) / 3.0  # = 2/3 - c + c^3/3
    i4 = 0.75 * i2 - 0.25 * s**3 * c
    series = s**5 * np.polynomial.polynomial.polyval(s**2, _SERIES)
    i4 = np.where(s < _SERIES_BELOW, series, i4)
    return 4.0 / np.pi * (i2 - amplitude * i3 / 3.0 + amplitude**2 * i4 / 27.0 + c / amplitude)


def _checked_saturation(saturation):
    value = np.asarray(saturation, dtype=float)
    if not np.all(value >= 0.0):
        raise ContactError(f"saturation (linear creep force over mu N) must not be negative or NaN, got {saturation!r}")
    return value
