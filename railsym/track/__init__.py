# SPDX-License-Identifier: BSD-3-Clause
"""Tracks: geometry from sections or measurements, irregularities, switches.

    from railsym.track import Track, Straight, Transition, Curve
    track = Track([Straight(100), Transition(50), Curve(radius=500, length=200, cant=0.1)])
    track = track.with_irregularity("erri_b176_low", seed=1)

Names are imported when they are first used.
"""

from importlib import import_module

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
    "read_geometry": "measured",
    "read_irregularity": "irregularity",
    "spectra": "spectrum",
    "tracks": "reading",
}

__all__ = list(_MODULE_OF)


def __getattr__(name):
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'railsym.track' has no attribute {name!r}; it offers {', '.join(__all__)}")
    value = getattr(import_module(f"railsym.track.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
