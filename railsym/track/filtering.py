# SPDX-License-Identifier: BSD-3-Clause
"""Band of wavelengths of a measured irregularity."""

from dataclasses import replace

import numpy as np

from railsym.errors import TrackError
from railsym.track.sections import number

ORDER = 4      # of the Butterworth filter in one direction; forwards and backwards it has no phase and halves the power twice


def filtered(irregularity, wavelengths):
    """An irregularity within a band of wavelengths.

    Butterworth band-pass of 4th order, forwards and backwards: amplitude 1/2 at either end of the band, no shift.

    Parameters
    ----------
    irregularity : MeasuredIrregularity
        With equally spaced points.
    wavelengths : pair of float
        m, shortest and longest.

    Returns
    -------
    MeasuredIrregularity

    Raises
    ------
    TrackError
        For points that are not equally spaced, too few, or too far apart for the band.
    """
    from scipy.signal import butter, sosfiltfilt

    short, long = (number(one, "filter: wavelength", "m", above=0.0) for one in wavelengths)
    gaps = np.diff(irregularity.s)
    step = float(gaps.mean())
    if np.ptp(gaps) > 1e-3 * step:
        raise TrackError(f"{irregularity.name}: a filter needs equally spaced points, these are {gaps.min():.6g} to {gaps.max():.6g} m apart; resample them")
    if not 2.0 * step < short < long:
        raise TrackError(f"filter: wavelengths ({short:g}, {long:g}) m: they must rise, and lie above two steps of {step:g} m")
    if step * len(irregularity.s) < long:
        raise TrackError(f"{irregularity.name} is {step * len(irregularity.s):.6g} m long, shorter than the longest wavelength, {long:g} m")
    sections = butter(ORDER, [1.0 / long, 1.0 / short], btype="bandpass", fs=1.0 / step, output="sos")
    columns = {name: sosfiltfilt(sections, values, padlen=min(len(values) - 1, int(long / step))) for name, values in irregularity.columns().items()}
    return replace(irregularity, **columns)
