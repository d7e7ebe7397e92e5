# SPDX-License-Identifier: BSD-3-Clause
"""Which damper model is enough for which test, in numbers and in words."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from railsym.dampers.record import RecordError

_GAIN = 0.2         # of the loop error: what a costlier model must take off to be worth it
_FLOOR = 0.005      # loop errors below this count as equal
TOLERANCE = 0.05  # of the r.m.s. force: a loop this good is good enough for a vehicle model
_POOR = 0.1         # loop error above which no model fits
MODELS = ("viscous", "maxwell", "maxwell_nonlinear")
_WORDS = {"viscous": "the viscous damper", "maxwell": "the Maxwell model with constant stiffness",
          "maxwell_nonlinear": "the Maxwell model with a stiffness over speed"}


@dataclass(frozen=True, eq=False)
class Verdict:
    """Comparison of models over the same tests.

    Attributes
    ----------
    models : tuple of str
        From the simplest to the costliest.
    tests : tuple of str
    frequency, amplitude : ndarray (tests,)
        Hz, m.
    loop_error, energy_error, peak_error, computing_time : ndarray (models, tests)
        R.m.s. error of the force over its r.m.s. value; relative errors of dissipated energy and peak force; s.
    enough : tuple of str
        For each test the simplest model whose loop error, the noise left aside, is within the tolerance, or which no costlier
        model beats by more than a fifth.
    text : str
        The verdict in words.
    """

    models: tuple[str, ...]
    tests: tuple[str, ...]
    frequency: np.ndarray
    amplitude: np.ndarray
    loop_error: np.ndarray
    energy_error: np.ndarray
    peak_error: np.ndarray
    computing_time: np.ndarray
    enough: tuple[str, ...]
    text: str = field(repr=False)
    units = {"frequency": "Hz", "amplitude": "m", "loop_error": "-", "energy_error": "-", "peak_error": "-", "computing_time": "s"}

    def __str__(self):
        return self.text


def verdict(fits, records, tolerance=TOLERANCE):
    """Compare fits of different models to the same tests.

    Parameters
    ----------
    fits : mapping of str to Fit
        Model name ("viscous", "maxwell", "maxwell_nonlinear") -> its fit.
    records : sequence of CleanRecord
        The tests of the fits, in their order.
    tolerance : float
        Loop error, without the noise, at which a model is enough.

    Returns
    -------
    Verdict

    Raises
    ------
    RecordError
        No fit, an unknown model, or fits of other tests.
    """
    unknown = [name for name in fits if name not in MODELS]
    if unknown or not fits:
        raise RecordError(f"models {', '.join(map(repr, unknown)) or '(none)'} cannot be compared; there are {', '.join(MODELS)}")
    models = tuple(name for name in MODELS if name in fits)
    wrong = [name for name in models if len(fits[name].tests) != len(records)]
    if wrong:
        raise RecordError(f"the fit of {wrong[0]!r} has {len(fits[wrong[0]].tests)} tests, but {len(records)} records were given")
    errors = [np.array([[getattr(test, what) for test in fits[name].tests] for name in models], dtype=float)
              for what in ("loop_error", "energy_error", "peak_error", "computing_time")]
    noise = np.array([one.noise / (np.std(one.force) or 1.0) for one in records])
    enough = tuple(models[_simplest(column, floor, tolerance)] for column, floor in zip(errors[0].T, noise))
    frequency, amplitude = (np.array([getattr(one, what) for one in records]) for what in ("frequency", "amplitude"))
    text = f"Enough: loop error within {100 * tolerance:g} % of the r.m.s. force, noise left aside, or as good as the costlier models.\n"
    text += _in_words(models, fits, records, errors, enough, noise)
    return Verdict(models, tuple(one.name for one in records), frequency, amplitude, *errors, enough, text)


def _simplest(errors, noise, tolerance):
    """Number of the simplest model whose error, without the noise that no model can fit, is small or about the smallest."""
    own = np.sqrt(np.maximum(errors**2 - noise**2, 0.0))
    for k in range(len(own) - 1):
        best = own[k + 1:].min()
        if own[k] <= tolerance or own[k] - best <= max(_GAIN * own[k], _FLOOR):
            return k
    return len(own) - 1


def _in_words(models, fits, records, errors, enough, noise):
    lines = []
    for name in models:
        tests = [one for one, which in zip(records, enough) if which == name]
        if tests:
            lines.append(f"{_WORDS[name]} is enough for {_several(tests, len(records))}.")
        else:
            lines.append(f"{_WORDS[name]} is {'not enough for any test' if name != models[-1] else 'not needed for any test'}.")
    if {"maxwell", "maxwell_nonlinear"} <= set(models):
        lines.append(_stiffness_sentence(models, records, errors))
    best = errors[0].min(axis=0)
    poor = [one.label for one, error, floor in zip(records, best, noise) if error > max(_POOR, 2.0 * floor)]
    if poor:
        lines.append(f"No model fits {', '.join(poor)}: the loop error stays above {100 * _POOR:.0f} %, so the damper does there what none of these models can.")
    return "\n".join(line[0].upper() + line[1:] for line in lines)


def _stiffness_sentence(models, records, errors):
    """What the non-linear stiffness changes at small and at large speeds, as the paper asks."""
    constant, curved = (models.index(name) for name in ("maxwell", "maxwell_nonlinear"))
    order = np.argsort([one.amplitude * one.frequency for one in records])
    third = max(1, len(order) // 3)
    slow, fast = (errors[0][:, part].mean(axis=1) for part in (order[:third], order[-third:]))
    time = errors[3][curved].sum() / max(errors[3][constant].sum(), 1e-12)
    cost = f"at {time:.1f} times the computing time" if np.isfinite(time) and time > 0.0 else ""
    return (f"a stiffness over speed in place of a constant one takes the mean loop error from {100 * slow[constant]:.1f} to {100 * slow[curved]:.1f} % "
            f"in the third of the tests with the smallest speed, and from {100 * fast[constant]:.1f} to {100 * fast[curved]:.1f} % in that with the largest"
            f"{', ' + cost if cost else ''}.")


def _several(tests, number):
    if len(tests) == number:
        return "every test"
    return ", ".join(f"{one.frequency:.3g} Hz {1e3 * one.amplitude:.3g} mm" for one in tests)
