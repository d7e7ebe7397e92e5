# SPDX-License-Identifier: BSD-3-Clause
"""Track irregularity: random after a spectrum, or measured."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.track.layers import RAILS, REST, SIGNALS, placed, rails_of, signals_of, spline_layer, window
from railsym.track.sections import number
from railsym.track.spectrum import load_spectrum
from railsym.track.tables import checked_columns, read_table

LARGEST = 0.1                  # m, more is a mistake of unit
_PER_WAVELENGTH = 16           # nodes in the shortest wavelength: the spline keeps its amplitude to 1e-4
_PERIODS = 8                   # longest wavelengths in the period of the series
_MOST_NODES = 2**26


@dataclass(frozen=True)
class RandomIrregularity:
    """Sum of cosines with the amplitudes of a spectrum and random phases.

    x(s) = sum_k sqrt(2 S(k dO) dO) cos(k dO s + phase_k), over the band of wavelengths. Each signal has phases of its own.

    Parameters
    ----------
    spectrum : str
        Name of one that comes along (`railsym.track.spectra`) or TOML file.
    seed : int
        The same seed gives the same track on every machine, to rounding.
    wavelengths : pair of float, optional
        m, shortest and longest; that of the spectrum without it.
    start, length : float
        m, where; without a length to the end of the track.
    fade : float
        m, at least 1, over which it fades in behind the start, and out where it ends before the track does.
    scale : float
        Factor on all signals.
    mirrored : bool
        Left and right exchanged: alignment and cant change their sign.
    """

    spectrum: str
    seed: int
    wavelengths: tuple | None = None
    start: float = 0.0
    length: float | None = None
    fade: float = 25.0
    scale: float = 1.0
    mirrored: bool = False

    def __post_init__(self):
        if isinstance(self.seed, bool) or not isinstance(self.seed, (int, np.integer)) or self.seed < 0:
            raise TrackError(f"seed = {self.seed!r}: a whole number from 0 on is needed, so that the track can be made again")
        object.__setattr__(self, "seed", int(self.seed))
        load_spectrum(self.spectrum)
        _check_place(self)
        object.__setattr__(self, "scale", number(self.scale, "irregularity: scale", "-"))
        short, long = self.band()
        object.__setattr__(self, "wavelengths", None if self.wavelengths is None else (short, long))

    def band(self):
        """Shortest and longest wavelength, m."""
        try:
            short, long = self.wavelengths or load_spectrum(self.spectrum).wavelengths
        except (TypeError, ValueError) as error:
            if isinstance(error, TrackError):
                raise
            raise TrackError(f"wavelengths = {self.wavelengths!r}: two numbers in m are needed, the shortest and the longest") from None
        short, long = (number(one, "irregularity: wavelength", "m", above=0.0) for one in (short, long))
        if not short < long:
            raise TrackError(f"wavelengths = ({short:g}, {long:g}) m: the shortest comes first, and they must differ")
        return short, long

    def signals(self, length):
        """Signals without fading.

        Parameters
        ----------
        length : float
            m

        Returns
        -------
        step : float
            m
        signals : ndarray, shape (n, 4)
            m: alignment, vertical, cant, gauge; from the start on.
        """
        short, long = self.band()
        step = short / _PER_WAVELENGTH
        count = int(np.ceil(length / step)) + 1
        period = 1 << int(np.ceil(np.log2(max(count + long / step, _PERIODS * long / step))))      # nodes; a power of 2 on every machine
        if period > _MOST_NODES:
            raise TrackError(f"{length:g} m of irregularity down to a wavelength of {short:g} m needs {period} points; make the shortest wavelength longer")
        spectrum = load_spectrum(self.spectrum)
        signals = np.empty((count, len(SIGNALS)))
        for k, name in enumerate(SIGNALS):
            signals[:, k] = self._signal(spectrum, k, name, step, period)[:count]
        return step, signals

    def _signal(self, spectrum, which, name, step, period):
        if name not in spectrum.densities:
            return np.zeros(period)
        short, long = self.band()
        spacing = 2.0 * np.pi / (period * step)
        k = np.arange(int(np.ceil(2.0 * np.pi / long / spacing)), int(np.floor(2.0 * np.pi / short / spacing)) + 1)
        # the generator's raw numbers are the same in every version of NumPy; its distributions need not be
        raw = np.random.PCG64(np.random.SeedSequence([self.seed, which])).random_raw(len(k))
        phase = 2.0 * np.pi * (raw >> np.uint64(11)) * 2.0**-53
        series = np.zeros(period // 2 + 1, dtype=complex)
        sign = -1.0 if self.mirrored and name in ("alignment", "cant") else 1.0
        amplitude = sign * self.scale * np.sqrt(2.0 * spectrum.densities[name](k * spacing) * spacing)
        series[k] = 0.5 * period * amplitude * np.exp(1j * phase)
        return np.fft.irfft(series, period)

    def layer(self, track_length):
        """Deviations of the rails on a track of that length (m), as RailLayer."""
        start, end = placed("irregularity", self.start, self.length, track_length)
        step, rails = self._rails(end - start)
        return _faded_layer(start, step, rails, end, self.fade, 0.0 if end == track_length else self.fade)

    def _rails(self, length):
        step, signals = self.signals(length)
        return step, rails_of(signals)


@dataclass(frozen=True, eq=False)
class MeasuredIrregularity:
    """Irregularity given at points; between them it is a cubic spline, nothing is filtered.

    Parameters
    ----------
    s : array_like, shape (n,)
        m, arc length on the track, increasing.
    alignment, vertical, cant, gauge : array_like, shape (n,), optional
        m: rails to the right, rails down, left rail higher, rails further apart. 0 without it. Or, instead of these:
    left_y, left_z, right_y, right_z : array_like, shape (n,), optional
        m, each rail to the right and down.
    fade : float
        m, at least 1, over which it fades in behind its first point, and out before its last one if the track goes on.
    covers : bool
        True (usual): it must reach to the end of the track.
    name : str
    """

    s: np.ndarray
    alignment: np.ndarray | None = None
    vertical: np.ndarray | None = None
    cant: np.ndarray | None = None
    gauge: np.ndarray | None = None
    left_y: np.ndarray | None = None
    left_z: np.ndarray | None = None
    right_y: np.ndarray | None = None
    right_z: np.ndarray | None = None
    fade: float = 25.0
    covers: bool = True
    name: str = "irregularity"

    def __post_init__(self):
        given = {key: getattr(self, key) for key in (*SIGNALS, *RAILS) if getattr(self, key) is not None}
        if not given or (set(given) & set(SIGNALS) and set(given) & set(RAILS)):
            raise TrackError(f"{self.name}: give signals ({', '.join(SIGNALS)}) or rails ({', '.join(RAILS)}), one of the two")
        for key, array in checked_columns(self.name, self.s, given).items():
            if key != "s" and np.abs(array).max() > LARGEST:
                k = int(np.abs(array).argmax())
                raise TrackError(f"{self.name}: {key} = {array[k]:g} m at s = {self.s[k]:.6g} m is beyond {LARGEST:g} m; are the units right?")
            object.__setattr__(self, key, array)
        _check_place(self)

    def columns(self):
        """Name -> values (m) of what was given."""
        return {key: getattr(self, key) for key in (*SIGNALS, *RAILS) if getattr(self, key) is not None}

    def rails(self):
        """Deviations of the rails at the points, shape (n, 4), m."""
        columns = self.columns()
        names = SIGNALS if set(columns) & set(SIGNALS) else RAILS
        values = np.stack([columns.get(name, np.zeros_like(self.s)) for name in names], axis=1)
        return rails_of(values) if names is SIGNALS else values

    def filtered(self, wavelengths):
        """The same within a band of wavelengths (m): `railsym.track.filtering.filtered`."""
        from railsym.track.filtering import filtered

        return filtered(self, wavelengths)

    def layer(self, track_length):
        """Deviations of the rails on a track of that length (m), as RailLayer."""
        from scipy.interpolate import CubicSpline

        start, last = float(self.s[0]), float(self.s[-1])
        if start < 0.0 or start >= track_length:
            raise TrackError(f"{self.name} begins at s = {start:.6g} m, outside the track from 0 to {track_length:.6g} m")
        if self.covers and last < track_length - 1e-6:
            raise TrackError(f"{self.name} ends at s = {last:.6g} m, the track at {track_length:.6g} m: it is {track_length - last:.6g} m too short; "
                             "shorten the track, or say covers=False for level track behind it")
        gaps = np.diff(self.s)
        end, step = min(last, track_length), float(gaps.min())
        if (last - start) / step > _MOST_NODES:
            raise TrackError(f"{self.name}: two points are only {step:.3g} m apart; thin them out")
        step = (end - start) / np.ceil((end - start) / step * (1.0 - 1e-9))
        nodes = start + step * np.arange(round((end - start) / step) + 1)
        even = len(nodes) <= len(self.s) and np.abs(nodes - self.s[:len(nodes)]).max() < 1e-6 * step
        rails = self.rails()
        rails = rails[:len(nodes)] if even else CubicSpline(self.s, rails)(np.minimum(nodes, last))
        return _faded_layer(start, step, rails, end, self.fade, 0.0 if end == track_length else self.fade)


def read_irregularity(path, *, fade=25.0, covers=True):
    """Measured irregularity from a CSV file.

    Parameters
    ----------
    path : path
        Heading with units: ``s [m], alignment [mm], vertical [mm], cant [mm], gauge [mm]`` (any of the four), or
        ``s [m], left_y [mm], left_z [mm], right_y [mm], right_z [mm]``.
    fade, covers
        As for `MeasuredIrregularity`.

    Returns
    -------
    MeasuredIrregularity

    Raises
    ------
    TrackError
        A file, column, unit or number that cannot be used.
    """
    columns = read_table(path, {"s": "m", **dict.fromkeys((*SIGNALS, *RAILS), "m")}, ("s",))
    return MeasuredIrregularity(**columns, fade=fade, covers=covers, name=Path(path).name)


def write_irregularity(path, s, rails):
    """Write deviations of the rails (n, 4) in m at s (m) as the four signals, in mm."""
    rows = np.column_stack([s, 1e3 * signals_of(rails)])
    lines = ["s [m], " + ", ".join(f"{name} [mm]" for name in SIGNALS), *(", ".join(f"{value:.17g}" for value in row) for row in rows)]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _check_place(what):
    for name, low in (("start", 0.0), ("fade", 1.0)):
        if hasattr(what, name):
            object.__setattr__(what, name, number(getattr(what, name), f"irregularity: {name}", "m", low=low))
    if getattr(what, "length", None) is not None:
        object.__setattr__(what, "length", number(what.length, "irregularity: length", "m", above=0.0))


def _faded_layer(start, step, rails, end, fade_in, fade_out):
    if fade_in + fade_out > end - start:
        raise TrackError(f"irregularity from s = {start:.6g} m to {end:.6g} m is shorter than its fading, {fade_in + fade_out:g} m; make the fading shorter")
    # beyond the end of the track a node more, so that the end lies inside the spline
    tail = np.zeros((REST, 4)) if fade_out else 2.0 * rails[-1:] - rails[-2:-1]
    values = np.zeros((REST + len(rails) + len(tail), 4))
    shape = window(start + step * np.arange(len(rails)), start, end, fade_in, fade_out)
    np.multiply(rails, shape[:, None], out=values[REST:REST + len(rails)])
    values[REST + len(rails):] = tail
    return spline_layer(start - REST * step, step, values, after=tail[-1])
