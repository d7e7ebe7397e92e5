# SPDX-License-Identifier: BSD-3-Clause
"""Tracks: geometry from sections or measurements, irregularities, switches.

    from railsym.track import Track, Straight, Transition, Curve
    track = Track([Straight(100), Transition(50), Curve(radius=500, length=200, cant=0.1)])
    track = track.with_irregularity("erri_b176_low", seed=1)

Names are imported when they are first used.
"""

from railsym.lazy import lazy

_MODULE_OF = {
    "Curve": "sections",
    "Gradient": "sections",
    "MeasuredGeometry": "measured",
    "MeasuredIrregularity": "irregularity",
    "RandomIrregularity": "irregularity",
    "Spectrum": "spectrum",
    "Straight": "sections",
    "Switch": "switch",
    "Track": "track",
    "Transition": "sections",
    "VerticalCurve": "sections",
    "load_spectrum": "spectrum",
    "load_track": "reading",
    "read_geometry": "geometry_file",
    "read_irregularity": "irregularity",
    "spectra": "spectrum",
    "tracks": "reading",
}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
