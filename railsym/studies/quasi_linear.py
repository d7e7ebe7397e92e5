# SPDX-License-Identifier: BSD-3-Clause
"""Hunting of a pair of profiles by the quasi-linear theory: the linear model with the contact that belongs to an amplitude.

At the critical speed that belongs to an amplitude, a motion so large neither grows nor decays. The contact is that of rigid profiles
(EN 15302), or elastic under the vehicle's wheel load: its conicity is lower at small amplitudes, where rigid contact jumps.
"""

from __future__ import annotations

import numpy as np

from railsym.errors import ContactError, RailsymError

AMPLITUDES = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0]) * 1e-3
_BAND = (1.0, 12.0)         # Hz, of hunting
_LEAST = 5e-5               # m: below it no conicity is quoted


def mean_wheel_load(vehicle):
    """Mean static wheel load, N."""
    from railsym.equilibrium import static_preload
    from railsym.model import Model

    return float(np.mean(static_preload(Model(vehicle)).wheel_loads))


def quasi_linear(vehicle, pair, loads=(None,), amplitudes=AMPLITUDES, **more):
    """Critical speeds against amplitude.

    Parameters
    ----------
    vehicle : Vehicle
    pair : ContactPair
    loads : sequence of float or None
        N, for elastic contact; None: rigid profiles.
    amplitudes : array_like, shape (n,)
        m
    more
        Fields of LinearContact, such as friction.

    Returns
    -------
    tuple of dict of str to ndarray (n,)
        A load each: ``amplitude`` m, ``conicity``, ``speed`` m/s, ``frequency_hz``; nan where there is none.
    """
    rows = np.full((len(loads), len(amplitudes), 4), np.nan)
    rows[:, :, 0] = amplitudes
    for k, amplitude in enumerate(amplitudes):
        for row, load in zip(rows[:, k], loads):
            try:
                row[1:] = _critical(vehicle, pair.linear_contact(float(amplitude), load, **more))
            except ContactError:
                pass              # the wheel leaves the profiles, or the flange has no linear contact
    return tuple(dict(zip(("amplitude", "conicity", "speed", "frequency_hz"), table.T)) for table in rows)


def _critical(vehicle, contact):
    """Conicity, critical speed (m/s) and frequency (Hz) there; nan where there is none."""
    from railsym.critical_speed import critical_speed

    found = critical_speed(vehicle, contact=contact)
    return contact.conicity, *(float(np.ma.filled(value, np.nan)) for value in (found.speed, found.frequency_hz))


def hunting_mode(vehicle, pair, speed, amplitude, load=None, **more):
    """The least damped lateral mode from 1 to 12 Hz at a speed (m/s) with the contact of an amplitude (m).

    Returns
    -------
    railsym.modes.Mode or None
        None where the pair has no linear contact at that amplitude, or it is too small to have a conicity.
    """
    from railsym.linear import linear_model
    from railsym.modes import modes

    if not amplitude > _LEAST:
        return None
    try:
        contact = pair.linear_contact(float(amplitude), load, **more)
    except RailsymError:
        return None
    found = modes(linear_model(vehicle, contact), speed)
    lateral = [mode for mode in found if _BAND[0] <= mode.frequency_hz <= _BAND[1] and mode.parity != "symmetric"]
    return min(lateral, key=lambda mode: mode.damping_ratio)
