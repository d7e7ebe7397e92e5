# SPDX-License-Identifier: BSD-3-Clause
"""Power spectral densities of track irregularity.

S(Omega) over the angular wavenumber Omega = 2 pi/wavelength (rad/m), one-sided: the variance is the integral of S over 0 < Omega.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railsym.errors import TrackError
from railsym.track.layers import SIGNALS
from railsym.track.toml_values import Reader

_FOLDER = Path(__file__).resolve().parent.parent / "data" / "track"
_UNIT = "m^3/rad"
_FORM = ("amplitude", "factor", "numerator_corner", "numerator_power", "corners")


@dataclass(frozen=True, eq=False)
class Density:
    """One signal's S(Omega) = factor A Oc^2 Omega^p / prod_i (Omega^2 + O_i^2), or a table.

    Attributes
    ----------
    amplitude : float
        A, m rad
    factor : float
    numerator_corner : float
        Oc, rad/m
    numerator_power : int
        p
    corners : tuple of float
        O_i, rad/m
    table : pair of ndarray, or None
        Omega (rad/m) and S (m^2/(rad/m)), joined by straight lines in logarithmic axes.
    sides : int
        2 for a file that gives the two-sided density: the values are doubled.
    """

    amplitude: float = 0.0
    factor: float = 1.0
    numerator_corner: float = 1.0
    numerator_power: int = 0
    corners: tuple = ()
    table: tuple | None = None
    sides: int = 1

    def __call__(self, wavenumber):
        """One-sided density at wavenumbers (rad/m), m^2/(rad/m)."""
        wavenumber = np.asarray(wavenumber, dtype=float)
        if self.table is not None:
            omega, density = self.table
            if wavenumber.size and not omega[0] * (1 - 1e-12) <= wavenumber.min() <= wavenumber.max() <= omega[-1] * (1 + 1e-12):
                raise TrackError(f"the table of the spectrum covers wavelengths of {2 * np.pi / omega[-1]:.4g} to {2 * np.pi / omega[0]:.4g} m, "
                                 f"asked for are {2 * np.pi / wavenumber.max():.4g} to {2 * np.pi / wavenumber.min():.4g} m; give others by wavelengths")
            return self.sides * np.exp(np.interp(np.log(wavenumber), np.log(omega), np.log(density)))
        below = np.prod([wavenumber**2 + corner**2 for corner in self.corners], axis=0)
        return self.sides * self.factor * self.amplitude * self.numerator_corner**2 * wavenumber**self.numerator_power / below


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Densities of the signals.

    Attributes
    ----------
    name, description : str
    densities : dict of str to Density
        Of those among alignment, vertical, cant, gauge that there are.
    wavelengths : tuple of float
        m, shortest and longest that it is meant for.
    origins : dict of str to str
    """

    name: str
    description: str
    densities: dict
    wavelengths: tuple
    origins: dict

    def variance(self, signal, wavelengths=None):
        """Variance (m^2) of a signal within a band of wavelengths (m)."""
        from scipy.integrate import quad

        short, long = wavelengths or self.wavelengths
        low, high = np.log(2 * np.pi / long), np.log(2 * np.pi / short)
        return quad(lambda x: float(self.densities[signal](np.exp(x))) * np.exp(x), low, high, epsrel=1e-10, limit=200)[0]


def spectra():
    """Names of the spectra that come along.

    Returns
    -------
    tuple of str
    """
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load_spectrum(name_or_path):
    """A spectrum by name, or from a TOML file (docs/track.md).

    Returns
    -------
    Spectrum

    Raises
    ------
    TrackError
        For an unknown name, or a file that cannot be used.
    """
    if isinstance(name_or_path, Spectrum):
        return name_or_path
    from railsym.vehicle_checks import unknown

    path = Path(name_or_path)
    if path.suffix != ".toml":
        if str(name_or_path) not in spectra():
            raise TrackError(f"spectrum {str(name_or_path)!r} is {unknown(name_or_path, spectra(), 'names')}; a file ends in .toml")
        path = _FOLDER / f"{name_or_path}.toml"
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise TrackError(f"{path.name}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    return _spectrum(Reader(path.name), document)


def _spectrum(read, document):
    read.table("", document, ("name", "description", "sides", "wavelengths", "origins", *SIGNALS), ("name", "sides", "wavelengths", "origins"))
    read.origins = {key: read.text(f"origins.{key}", text) for key, text in document["origins"].items()}
    sides = {"one-sided": 1, "two-sided": 2}[read.text("sides", document["sides"], ("one-sided", "two-sided"))]
    densities = {name: _density(read, name, document[name], sides) for name in SIGNALS if name in document}
    if not densities:
        raise read.problem("", None, f"no signal; allowed tables: {', '.join(SIGNALS)}")
    wavelengths = tuple(read.quantity("wavelengths", document["wavelengths"], "m", count=2).tolist())
    return Spectrum(document["name"], document.get("description", ""), densities, wavelengths, read.origins)


def _density(read, name, table, sides):
    if isinstance(table, dict) and "density" in table:
        read.table(name, table, ("wavenumber", "density"), ("wavenumber", "density"))
        omega, values = (read.quantity(f"{name}.{key}", table[key], unit, count=-1) for key, unit in (("wavenumber", "rad/m"), ("density", _UNIT)))
        if len(omega) != len(values) or (np.diff(omega) <= 0).any() or omega[0] <= 0 or (values <= 0).any():
            raise read.problem(name, None, "wavenumber must increase and be positive, density be positive, and both be equally many")
        return Density(table=(omega, values), sides=sides)
    read.table(name, table, _FORM, ("amplitude", "corners"))
    corners = read.quantity(f"{name}.corners", table["corners"], "rad/m", count=-1)
    power = table.get("numerator_power", 0)
    if not isinstance(power, int) or power < 0 or power >= 2 * len(corners):
        raise read.problem(f"{name}.numerator_power", power, "a whole number from 0 to below twice the number of corners is needed")
    amplitude, factor, corner = (float(read.quantity(f"{name}.{key}", table.get(key, default), unit, low=0.0)) for key, default, unit in
                                 (("amplitude", None, "m*rad"), ("factor", [1.0, "-"], "-"), ("numerator_corner", [1.0, "rad/m"], "rad/m")))
    return Density(amplitude, factor, corner, power, tuple(corners.tolist()), sides=sides)
