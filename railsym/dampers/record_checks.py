# SPDX-License-Identifier: BSD-3-Clause
"""Defects of bench records: each check raises a RecordError or returns a message, and says which test and why."""

from __future__ import annotations

import numpy as np

from railsym.dampers.record import RecordError

# What a damper of a railway vehicle gives on a bench. A factor of 1000 in one channel leaves these ranges.
FREQUENCY = (0.02, 60.0)            # Hz
AMPLITUDE = (2e-5, 0.2)             # m
FORCE = (2.0, 1e6)                  # N
DYNAMIC_STIFFNESS = (2e4, 3e8)      # N/m
_FLAT_BAND, _FLAT_SHARE = 0.0025, 0.15
_TURNED = 0.2                       # of the median dynamic stiffness
_UNITS = "check the units (m, N and s are expected), or call with check_units=False if the record is right"


def check_clipping(record):
    """Raise where the force stands at its highest or lowest value too often to be a peak.

    A sampled peak, also one quantised by the converter, has 2.4 times as many samples in its uppermost level as in the
    next one; a clipped one has far more.
    """
    force = record.force
    span = np.ptp(force)
    if span == 0.0:
        raise RecordError(f"{record.label}: the force is constant, {force[0]:.6g} N; was the force channel connected?")
    for sign, end in ((1, "highest"), (-1, "lowest")):
        below = np.max(sign * force) - sign * force
        at = np.count_nonzero(below <= 1e-9 * span)
        if at <= 0.02 * force.size:
            continue
        levels = np.unique(force)
        quantum = np.min(np.diff(levels)) if levels.size < 0.25 * force.size else 0.0
        near = np.count_nonzero(below <= max(0.005 * span, 2.0 * quantum)) - at
        if at > 1.8 * near:
            raise RecordError(f"{record.label}: the force is clipped: {at} of {force.size} samples stand at its {end} value "
                              f"{sign * np.max(sign * force):.6g} N; repeat the test with a larger range of the force channel, or leave it out")


def check_flat(record, mean):
    """A message where the force of the mean cycle stands within a 400th of its range at its highest or lowest value.

    Noise after the clipping hides it from `check_clipping`; a blow-off valve without slope looks the same, so this is no error.
    A sine is there for 3 % of its cycle.
    """
    low, high = float(mean.min()), float(mean.max())
    found = []
    for end, value in (("highest", high), ("lowest", low)):
        share = np.count_nonzero(np.abs(mean - value) < _FLAT_BAND * (high - low)) / mean.size
        if share > _FLAT_SHARE:
            found.append(f"{record.label}: the force stands for {100 * share:.0f} % of each cycle at its {end} value {value:.4g} N: "
                         "clipped, or a blow-off valve without slope")
    return found


def check_frequency(record, frequency, step, duration):
    """Raise for a motion that is none, too short, too coarse, or in another unit of time."""
    if not frequency > 0.0:
        raise RecordError(f"{record.label}: the displacement does not move")
    cycles = frequency * duration
    if cycles < 2.9:
        raise RecordError(f"{record.label}: has {cycles:.1f} cycles of {frequency:.3g} Hz; at least 3 are needed, better 10")
    if 1.0 / (frequency * step) < 16:
        raise RecordError(f"{record.label}: has {1.0 / (frequency * step):.1f} samples per cycle of {frequency:.3g} Hz; at least 16 are "
                          "needed; is the displacement channel a sine, and the unit of time right?")
    nominal = record.nominal_frequency
    if nominal and not 0.95 < frequency / nominal < 1.05:
        raise RecordError(f"{record.label}: its frequency is {frequency:.4g} Hz, the nominal one {nominal:.4g} Hz{_factor(frequency / nominal)}")


def check_gap(record, gap, frequency):
    """Raise for a gap of more than a tenth of a cycle; a message for a shorter one."""
    if not gap:
        return []
    if gap * frequency > 0.1:
        at = record.time[int(np.argmax(np.diff(record.time)))]
        raise RecordError(f"{record.label}: has a gap of {gap:.4g} s after {at:.6g} s, {gap * frequency:.2g} of a cycle; "
                          "cut the record there or repeat the test")
    return [f"{record.label}: missing samples up to {gap:.3g} s apart were filled in by a spline"]


def check_size(record, frequency, displacement, force):
    """Raise where amplitudes leave what a railway damper can give, as after a wrong unit or with swapped channels.

    Parameters
    ----------
    displacement, force : float
        Amplitudes of the first harmonics, m and N.
    """
    label = record.label
    if displacement > 1.0 and force < 1.0:
        raise RecordError(f"{label}: displacement ({displacement:.3g} m) and force ({force:.3g} N) are swapped: change the order of the columns")
    _within(label, "its frequency", frequency, "Hz", FREQUENCY)
    _within(label, "the amplitude of its displacement", displacement, "m", AMPLITUDE)
    _within(label, "the amplitude of its force", force, "N", FORCE)
    _within(label, "its dynamic stiffness (force over displacement)", force / displacement, "N/m", DYNAMIC_STIFFNESS)


def check_amplitude(record, amplitude):
    """Raise or warn where the amplitude is not the nominal one."""
    nominal = record.nominal_amplitude
    if nominal is None or 0.9 < amplitude / nominal < 1.1:
        return []
    text = f"{record.label}: its amplitude is {1e3 * amplitude:.4g} mm, the nominal one {1e3 * nominal:.4g} mm{_factor(amplitude / nominal)}"
    if not 0.3 < amplitude / nominal < 3.0:
        raise RecordError(text)
    return [text]


def check_energy(record, frequency, phase, energy):
    """Raise where the damper would give energy.

    Parameters
    ----------
    phase : float
        rad, of the force's first harmonic before that of the displacement. A damper's is between 0 and pi/2; a lag of 10 ms
        of the force channel can bring that of a stiff one below 0.
    energy : float
        J a cycle.
    """
    if -(0.1 + 2.0 * np.pi * frequency * 0.01) < phase < 2.2:
        return
    raise RecordError(f"{record.label}: the damper gives {-energy:.3g} J a cycle, phase of the force {np.degrees(phase):.0f} degrees: displacement and "
                      "force are swapped or one has the other sign (elongation and tension are positive; read_records(..., force_sign=-1) turns the force)")


def check_periodic(record, noise):
    """Raise or warn by the part of the displacement that does not repeat (of its r.m.s. value)."""
    if noise > 0.25:
        raise RecordError(f"{record.label}: {100 * noise:.0f} % of its displacement does not repeat from cycle to cycle: no sine test, or no displacement")
    return [f"{record.label}: {100 * noise:.0f} % of its displacement does not repeat from cycle to cycle"] if noise > 0.05 else []


def check_velocity(record, frequency, ratio):
    """Compare the velocity channel with the rate of the displacement.

    Parameters
    ----------
    ratio : complex
        First harmonic of the velocity channel over that of the displacement's rate; 1 if all is well.
    """
    size, lag = abs(ratio), -np.angle(ratio) / (2.0 * np.pi * frequency)
    if not 0.5 < size < 2.0:
        raise RecordError(f"{record.label}: the velocity channel is {size:.3g} times the rate of the displacement{_factor(size)}")
    if abs(np.angle(ratio)) > 0.5:
        raise RecordError(f"{record.label}: the velocity channel is {np.degrees(np.angle(ratio)):.0f} degrees away from the rate of the displacement: "
                          "wrong sign or wrong column")
    found = [f"{record.label}: the velocity channel is {size:.3f} times the rate of the displacement"] if not 0.95 < size < 1.05 else []
    if abs(lag) > 5e-4:
        found.append(f"{record.label}: the velocity channel is {1e3 * lag:.1f} ms behind the displacement channel")
    return found


def compare_sizes(cleaned):
    """Messages for tests whose dynamic stiffness is more than 50 times off the median of the others.

    Raises
    ------
    RecordError
        Beyond 200 times: a unit is off by 1000.
    """
    if len(cleaned) < 3:
        return
    stiffness = [one.dynamic_stiffness for one in cleaned]
    size = np.abs(stiffness)
    table = np.broadcast_to(size, (size.size, size.size))[~np.eye(size.size, dtype=bool)].reshape(size.size, -1)
    for one, own, ratio in zip(cleaned, stiffness, size / np.median(table, axis=1)):
        if ratio < _TURNED and own.imag < 0.0:
            raise RecordError(f"{one.label}: its damper gives energy and is {1.0 / ratio:.3g} times softer than in the other tests: "
                              "displacement and force are swapped")
        near = [other for other, at in zip(stiffness, cleaned) if abs(at.frequency / one.frequency - 1.0) < 0.05 and other.imag > 0.0]
        if own.imag < 0.0 and near and max(np.angle(near)) > np.angle(own) + 0.25 and not 0.5 < abs(own) / np.median(np.abs(near)) < 2.0:
            raise RecordError(f"{one.label}: its damper gives energy, unlike in other tests of its frequency: displacement and force are swapped")
        if not 0.005 < ratio < 200.0:
            raise RecordError(f"{one.label}: its dynamic stiffness {abs(own):.3g} N/m is {ratio:.3g} times that of the other tests: "
                              "a unit of its displacement or force is off by 1000")


def _within(label, what, value, unit, allowed):
    if not allowed[0] <= value <= allowed[1]:
        raise RecordError(f"{label}: {what}, {value:.3g} {unit}, is outside {allowed[0]:g} to {allowed[1]:g} {unit}: a unit is probably off by 1000; {_UNITS}")


def _factor(ratio):
    power = round(np.log10(ratio))
    return f": a unit is off by {10.0**abs(power):g}" if abs(power) >= 3 and 0.7 < ratio / 10.0**power < 1.4 else ""
