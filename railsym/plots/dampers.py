# SPDX-License-Identifier: BSD-3-Clause
"""Drawings of identified dampers: force over speed, stiffness over speed, loops of tests."""

from __future__ import annotations

import numpy as np

from railsym.plots.style import BLUE, GREEN, GREY, VERMILION, new_axes, tidy

_COLOUR = {"viscous": GREEN, "maxwell": BLUE, "maxwell_nonlinear": VERMILION}
_DASHES = {"viscous": (0, (1.5, 1.5)), "maxwell": (0, (6, 2)), "maxwell_nonlinear": "-"}
_LABEL = {"viscous": "viscous", "maxwell": "constant stiffness", "maxwell_nonlinear": "stiffness over speed"}
_SHOWN_LOOPS = ((1.0, 1e-3), (3.0, 1.5e-3))      # Hz, m: those of the paper


def plot_damper(fits, records, *, loops=_SHOWN_LOOPS, axes=None):
    """Four drawings: force over damper speed, series stiffness over speed, and the loops of two tests.

    Parameters
    ----------
    fits : mapping of str to Fit
        Model name -> fit; "viscous", "maxwell", "maxwell_nonlinear".
    records : sequence of CleanRecord
    loops : sequence of (frequency, amplitude)
        Hz and m; the nearest tests are drawn.
    axes : sequence of four matplotlib Axes, optional

    Returns
    -------
    ndarray of matplotlib Axes (2, 2)
    """
    axes = new_axes(axes, 2, 2, size=(10.4, 8.0))
    plot_force_speed(fits, records, axes=axes[0, 0])
    plot_stiffness_speed(fits, records, axes=axes[0, 1])
    for place, (frequency, amplitude) in zip(axes[1], loops):
        plot_loop(fits, nearest_test(records, frequency, amplitude), axes=place)
    return axes


def nearest_test(records, frequency, amplitude):
    """The test nearest to a frequency (Hz) and an amplitude (m), by their ratios."""
    return min(records, key=lambda one: abs(np.log(one.frequency / frequency)) + abs(np.log(one.amplitude / amplitude)))


def plot_force_speed(fits, records, *, axes=None):
    """Force of the damper over its own speed; dots: force and speed amplitudes of the tests."""
    axes = new_axes(axes, size=(5.6, 4.2))[0, 0]
    top = 1.05 * max(2.0 * np.pi * one.frequency * one.amplitude for one in records)
    speed = np.linspace(-top, top, 401)
    peak = np.array([_peak(one) for one in records])
    rate = np.array([2.0 * np.pi * one.frequency * one.amplitude for one in records])
    axes.plot(np.concatenate([1e3 * rate, -1e3 * rate]), 1e-3 * np.concatenate([peak[:, 0], peak[:, 1]]), "o", color=GREY,
              markersize=4, label="tests: peak force at the ends' peak speed")
    for name, fit in fits.items():
        force = damper_force(fit.model, speed)
        # a curve ends where the tests do: beyond their peak force nothing is known
        force[(force > 1.1 * peak[:, 0].max()) | (force < 1.1 * peak[:, 1].min())] = np.nan
        axes.plot(1e3 * speed, 1e-3 * force, color=_COLOUR[name], linestyle=_DASHES[name], label=_damper_label(name))
    tidy(axes, "speed of the damper, mm/s", "force, kN", "Force against speed")
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    return axes


def plot_stiffness_speed(fits, records, *, axes=None):
    """Series stiffness over the speed of the two ends."""
    axes = new_axes(axes, size=(5.6, 4.2))[0, 0]
    top = 1.05 * max(2.0 * np.pi * one.frequency * one.amplitude for one in records)
    speed = np.linspace(0.0, top, 301)
    highest = 0.0
    for name, fit in fits.items():
        if fit.model.kind == "maxwell":
            stiffness = series_stiffness(fit.model, speed)
            highest = max(highest, stiffness.max())
            axes.plot(1e3 * speed, 1e-6 * stiffness, color=_COLOUR[name], linestyle=_DASHES[name], label=_LABEL[name])
    tidy(axes, "relative speed of the ends, mm/s", "series stiffness, kN/mm", "Series stiffness against speed")
    if highest > 0.0:
        axes.set_ylim(0.0, 1.15e-6 * highest)
        axes.legend(fontsize=8, frameon=False, loc="lower left")
    else:
        axes.text(0.5, 0.5, "no Maxwell model", ha="center", transform=axes.transAxes, color=GREY)
    return axes


def plot_loop(fits, record, *, axes=None):
    """Force over displacement in one test: measured, and of each model under the measured motion."""
    axes = new_axes(axes, size=(5.6, 4.2))[0, 0]
    axes.plot(1e3 * record.displacement, 1e-3 * record.force, ".", color=GREY, markersize=2.0, label="measured")
    time, displacement, velocity, _ = record.mean_cycle
    for name, fit in fits.items():
        force = steady_force(fit, record)
        closed = np.r_[np.arange(time.size), 0]
        axes.plot(1e3 * displacement[closed], 1e-3 * force[closed], color=_COLOUR[name], linestyle=_DASHES[name], label=_LABEL[name])
    tidy(axes, "displacement, mm", "force, kN", f"{record.frequency:.3g} Hz, {1e3 * record.amplitude:.3g} mm")
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))
    return axes


def damper_force(model, speed):
    """Force of a model's viscous element, N."""
    speed = np.asarray(speed, dtype=float)
    if model.damping_curve is None:
        return model.damping * speed
    x, y = _table(model.damping_curve)
    if x[0] == 0.0:
        x, y = np.concatenate([-x[:0:-1], x]), np.concatenate([-y[:0:-1], y])
    return _straight_on(x, y, speed)


def series_stiffness(model, speed):
    """Series stiffness of a Maxwell model, N/m."""
    speed = np.abs(np.asarray(speed, dtype=float))
    if model.series_stiffness_curve is None:
        return np.full(speed.shape, float(model.series_stiffness))
    return _straight_on(*_table(model.series_stiffness_curve), speed)


def steady_force(fit, record):
    """Force of a fit over one steady cycle of a test's motion, with the lag that the fit found, N (samples_per_cycle,)."""
    from railsym._core import bench_cycles

    count = record.samples_per_cycle
    force = bench_cycles(fit.model.force_law_record(), np.array([1.0 / record.frequency]), record.displacement[None, :count],
                         record.velocity[None, :count])[0][0]
    lag = float(getattr(fit, "lag", 0.0) or 0.0)
    spectrum = np.fft.rfft(force) * np.exp(-2j * np.pi * record.frequency * lag * np.arange(count // 2 + 1))
    return np.fft.irfft(spectrum, count)


def _straight_on(x, y, at):
    """Monotone cubic, straight on beyond its ends, as in the vehicle."""
    from scipy.interpolate import PchipInterpolator

    curve = PchipInterpolator(x, y)
    inside = np.clip(at, x[0], x[-1])
    return curve(inside) + (at - inside) * curve.derivative()(inside)


def _table(curve):
    x, y = (curve.x, curve.y) if hasattr(curve, "x") else curve
    return np.asarray(x, dtype=float), np.asarray(y, dtype=float)


def _peak(record):
    """Highest and lowest force of the mean cycle, N."""
    force = record.mean_cycle[3]
    return float(force.max()), float(force.min())


def _damper_label(name):
    return "viscous" if name == "viscous" else f"damper of: {_LABEL[name]}"
