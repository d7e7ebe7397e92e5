# SPDX-License-Identifier: BSD-3-Clause
"""The frequency at which a vehicle hunts, from the spectra of its lateral motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.criteria.errors import CriterionError
from railsym.criteria.source import gather
from railsym.results.run import Run
from railsym.results.spectrum import Spectrum, amplitude_spectrum

_CHANNELS = ("*.above_*.ay", "bogie*.y", "*frame*.y", "wheelset*.y")
_BAND = (0.5, 12.0)  # Hz: from the lower sway of the car to above the hunting of a stiff short bogie


@dataclass(frozen=True, eq=False)
class HuntingFrequency:
    """Dominant frequency of lateral motions.

    Attributes
    ----------
    frequency_hz, amplitude : float
        Of the channel with the largest amplitude.
    channel, unit : str
    band : (float, float)
        Hz.
    spectra : dict of str to Spectrum
        Of each channel.
    resolution_hz : float
    """

    frequency_hz: float
    amplitude: float
    channel: str
    unit: str
    band: tuple
    spectra: dict
    resolution_hz: float

    @property
    def agreeing(self):
        """Channels whose dominant frequency is the same within the resolution, tuple of str."""
        return tuple(n for n, s in self.spectra.items() if abs(s.dominant_hz - self.frequency_hz) <= self.resolution_hz)

    @property
    def message(self):
        """In a sentence."""
        return (f"{self.frequency_hz:.2f} Hz (resolution {self.resolution_hz:.2g} Hz), amplitude {self.amplitude:.4g} {self.unit} in {self.channel}; "
                f"{len(self.agreeing)} of {len(self.spectra)} channels agree")

    def __str__(self):
        return self.message

    def plot(self, *, axes=None):
        """Draw the spectrum of the leading channel; returns the axes."""
        return self.spectra[self.channel].plot(axes=axes)


def hunting_frequency(source, signal=None, *, channels=None, band=_BAND, start=None, end=None):
    """Dominant frequency of the lateral motions of bogies and wheelsets.

    Parameters
    ----------
    source : Run or array_like (n,)
        A run, or time in s.
    signal : array_like (n,) or dict, optional
    channels : str or sequence of str, optional
        Of one unit; the first of ``*.above_*.ay``, ``bogie*.y``, ``*frame*.y``, ``wheelset*.y`` that the run has if not given.
    band : (float, float)
        Hz.
    start, end : float, optional
        s, the part of a run that is looked at.

    Returns
    -------
    HuntingFrequency

    Raises
    ------
    CriterionError
        No such channels, nothing moves.
    railsym.results.ResultError
        Too short or sampled too slowly for the band.
    """
    if isinstance(source, Run):
        source = source.between(-np.inf if start is None else start, np.inf if end is None else end)
        channels = channels or next((pattern for pattern in _CHANNELS if source.channels.match(pattern)), _CHANNELS[0])
        names = source.channels.require(*((channels,) if isinstance(channels, str) else channels))
        unit = source.unit(names[0])
    else:
        names, unit = channels, "-" if signal is not None else ""
    return dominant_frequency(gather(source, signal, names, unit), band, unit)


def dominant_frequency(found, band, unit=""):
    """As `hunting_frequency`, of `Signals`."""
    spectra = {name: amplitude_spectrum(found.time, value, band, unit=unit, name=name) for name, value in found.values.items()}
    moving = {name: spectrum for name, spectrum in spectra.items() if np.isfinite(spectrum.dominant_hz)}
    if not moving:
        raise CriterionError(f"nothing moves between {band[0]:g} and {band[1]:g} Hz in {', '.join(spectra)}")
    lead: Spectrum = max(moving.values(), key=lambda spectrum: spectrum.dominant_amplitude)
    return HuntingFrequency(lead.dominant_hz, lead.dominant_amplitude, lead.channel, unit, tuple(band), spectra, lead.resolution_hz)
