# SPDX-License-Identifier: BSD-3-Clause
"""Least squares on the loops: misfit of the harmonics, its Jacobian by the linearised bench, and where curves have their nodes.

The steady force of F = k(|v|) (e - s) = D(w), w = ds/dt, changes with the parameters as

    dF = dk (e - s) - k ds,     D'(w) d(ds)/dt = dk (e - s) - k ds - dD(w)

which is linear in ds and periodic. It is stepped here exactly for rates constant and targets linear over a step; the bench itself gives the
force, so that the error of these steps slows the iteration down but moves its end by no more than that times the misfit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from railsym import _core
from railsym.dampers.energy import shared
from railsym.dampers.models import curve_value
from railsym.errors import CoreError

_STEP = 1e-5          # of the logarithms and rises, for the change of curves
_SOFT = 0.06          # standard deviation of the relative change of slope from node to node
_TAIL = 3.0           # degrees of freedom of the t density of these changes
_LEAST_NOISE = 1e-3   # relative misfit that curves of a few nodes leave even without noise
_BENCH_ERROR = 3e-5   # relative misfit by the bench's steps
_WIDEST = 1.5         # of the ends' speed: the damper itself is hardly faster


def steady(loops, model, state=None):
    """Force (N) and damper elongation (m) over a cycle of all tests, each (tests, points)."""
    return _core.bench_cycles(model.force_law_record(), loops.period, loops.displacement, loops.velocity, 2, state)


def harmonics_of(loops, force, lag):
    """Harmonics 1.. of a force (..., tests, points) that is measured ``lag`` (s) late."""
    orders = loops.harmonics.shape[1]
    spectrum = 2.0 * np.fft.rfft(force, axis=-1)[..., 1:1 + orders] / force.shape[-1]
    return spectrum * np.exp(-1j * (1 + np.arange(orders)) * loops.angular[:, None] * np.reshape(lag, (-1, 1)))


def _flat(loops, spectrum):
    """Kept harmonics relative to the r.m.s. force: real and imaginary parts (..., 2 kept)."""
    part = (spectrum / (np.sqrt(2.0 * len(loops.scale)) * loops.scale[:, None]))[..., loops.kept]
    return np.concatenate([part.real, part.imag], axis=-1)


def misfit(loops, made, x, fixed, state=None):
    """Harmonics of model less measured, relative to the r.m.s. force; squares sum to the mean square of the tests.

    Infinite where the bench finds no steady cycle.
    """
    try:
        force, _ = steady(loops, made.model(x), state)
    except CoreError:
        if state is not None:
            state[:] = 0.0
        return np.full(2 * int(loops.kept.sum()), np.inf)
    return _flat(loops, harmonics_of(loops, force, made.lag(x) if made.lags else fixed) - loops.harmonics)


def noise_floor(loops):
    """Relative misfit that noise leaves in the harmonics."""
    return float(np.sqrt(np.mean(0.5 * np.sum((loops.deviation * loops.kept) ** 2, axis=1) / loops.scale**2)))


def low_excess(loops, misfit, orders=5):
    """Root mean square of the misfit over its deviation in the lowest orders: near 1 where only noise is left.

    A curve that is missing shows there, while the sum over all orders is mostly noise.
    """
    low = (np.broadcast_to(np.arange(loops.kept.shape[1]), loops.kept.shape) < orders)[loops.kept]
    return float(np.sqrt(np.mean((misfit / entry_deviations(loops, True))[np.concatenate([low, low])] ** 2)))


def entry_deviations(loops, curves):
    """Standard deviation of each entry of the misfit: noise, and what the nodes of curves (or the bench's steps) leave, spread over the entries."""
    least = _LEAST_NOISE if curves else _BENCH_ERROR
    noise = loops.deviation / (2.0 * np.sqrt(len(loops.scale)) * loops.scale[:, None])
    part = np.hypot(noise, least / np.sqrt(2.0 * loops.kept.sum()))[loops.kept]
    return np.concatenate([part, part])


def entry_weights(loops):
    """Weights that make the noise of all entries equal, where it is more than what nodes leave; their mean square error stays."""
    deviation = entry_deviations(loops, True)
    return np.sqrt(np.mean(deviation**2)) / deviation


def _damping(record, speed):
    """Force D (N) and slope (N s/m) of the damper's own law."""
    table = record.get("damping_curve")
    if table is None:
        return record["damping"] * speed, np.full_like(speed, record["damping"])
    x, c = table
    inside = np.clip(speed, x[0], x[-1])
    piece = np.clip(np.searchsorted(x, inside, side="right") - 1, 0, len(c) - 1)
    t, c = inside - x[piece], np.moveaxis(c[piece], -1, 0)
    return curve_value(table, speed) + record["damping"] * speed, c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]) + record["damping"]


def _stiffness(record, speed):
    table = record.get("stiffness_curve")
    return record["stiffness"] + (0.0 if table is None else curve_value(table, np.abs(speed)))


def own_speed(record, force):
    """Speed (m/s) of the damper at a force: D turned round by a dense table."""
    if record.get("damping_curve") is None:
        return force / record["damping"]
    x = record["damping_curve"][0]
    fine = np.linspace(-1.0, 1.0, 2001)
    fine = np.where(fine < 0.0, -x[0], x[-1]) * fine * np.abs(fine)
    ends = [10.0 * x[0], 10.0 * x[-1]]
    speed = np.concatenate([ends[:1], fine, ends[1:]])
    return np.interp(force, _damping(record, speed)[0], speed)


def jacobian(loops, made, x, fixed, state=None):
    """Slopes of `misfit` (2 kept, unknowns)."""
    if made.damping_nodes is None and made.stiffness_nodes is None and made.kind == "maxwell":
        return _linear_jacobian(loops, made, x, fixed)
    record = made.model(x).force_law_record()
    force, s = steady(loops, made.model(x), state)
    count_d = made.sizes[0]
    speed = loops.velocity if made.kind == "viscous" else own_speed(record, force)
    damping, stiffening, _ = made.split(x)
    if made.damping_nodes is None:
        d_damping = (record["damping"] * speed)[None]
    else:
        d_damping = _curve_changes(made.damping_nodes, made.forces, damping, speed, odd=True)
    if made.kind == "viscous":
        change = d_damping
    else:
        stiffness = _stiffness(record, loops.velocity) + np.zeros_like(force)
        if made.stiffness_nodes is None:
            d_stiffness = stiffness[None]
        else:
            d_stiffness = _curve_changes(made.stiffness_nodes, made.stiffnesses, stiffening, np.abs(loops.velocity), odd=False)
        spring = np.concatenate([np.zeros_like(d_damping), d_stiffness * (loops.displacement - s)])
        target = (spring - np.concatenate([d_damping, np.zeros_like(spring[count_d:])])) / stiffness
        change = spring - stiffness * _periodic(target, stiffness / np.maximum(_damping(record, speed)[1], 1e-3), loops.period)
    lag = made.lag(x) if made.lags else fixed
    columns = _flat(loops, harmonics_of(loops, change, lag))
    if not made.lags:
        return columns.T
    turning = -1j * (1 + np.arange(loops.harmonics.shape[1])) * loops.angular[:, None]
    turned = _flat(loops, harmonics_of(loops, force, lag) * turning * made.lag_unit)
    return np.concatenate([columns, turned[None]]).T


def _linear_jacobian(loops, made, x, fixed):
    """Slopes for constants, closed: F = K X, 1/K = 1/k + 1/(i omega c), order by order."""
    damping, stiffness, _ = (np.exp(part) for part in made.split(x))
    order = 1 + np.arange(loops.harmonics.shape[1])
    turning = 1j * order * loops.angular[:, None]
    lag = made.lag(x) if made.lags else fixed
    motion = harmonics_of(loops, loops.displacement, lag)
    dynamic = 1.0 / (1.0 / stiffness[0] + 1.0 / (turning * damping[0]))
    slopes = [motion * dynamic**2 / (turning * damping[0]), motion * dynamic**2 / stiffness[0]]
    if made.lags:
        slopes.append(-turning * made.lag_unit * motion * dynamic)
    return _flat(loops, np.array(slopes)).T


def _curve_changes(nodes, values_of, x, at, odd):
    """Changes (unknowns, ...) at ``at`` of a monotone cubic whose values at the nodes are ``values_of`` the unknowns."""
    from scipy.interpolate import PchipInterpolator

    values = np.array([values_of(one) for one in (x, *(x + _STEP * np.eye(x.size)))])
    if odd and nodes[0] == 0.0:
        nodes, values = np.concatenate([-nodes[:0:-1], nodes]), np.concatenate([-values[:, :0:-1], values], axis=1)
    curve = PchipInterpolator(nodes, values, axis=1)
    inside = np.clip(at, nodes[0], nodes[-1])
    found = curve(inside)
    if (inside != at).any():
        found = found + (at - inside) * curve.derivative()(inside)
    return (found[1:] - found[0]) / _STEP


def _periodic(target, rate, period):
    """Periodic solution of dy/dt = rate (target - y): target (unknowns, tests, points), rate (tests, points) in 1/s."""
    points = rate.shape[1]
    middle = 0.5 * (rate + np.roll(rate, -1, axis=1))
    turns = middle * (period / points)[:, None]
    keep, share = np.exp(-turns), -np.expm1(-turns) / np.maximum(turns, 1e-12)
    gain = (share - keep) * target + (1.0 - share) * np.roll(target, -1, axis=2)
    out = np.zeros_like(target)
    now = np.zeros(target.shape[:2])
    for k in range(points):
        out[:, :, k] = now
        now = keep[:, k] * now + gain[:, :, k]
    product = np.cumprod(keep, axis=1)
    start = now / np.maximum(1.0 - product[:, -1], 1e-9)
    return out + start[:, :, None] * np.concatenate([np.ones((len(keep), 1)), product[:, :-1]], axis=1)


def bends(made, x):
    """Relative change of slope from node to node of the damping curve, in units of what is usual."""
    if made.damping_nodes is None:
        return np.zeros(0)
    slope = made.split(x)[0] / np.diff(made.damping_nodes)
    return (slope[1:] - slope[:-1]) / (slope[1:] + slope[:-1]) / _SOFT


def _roughness(made, x, weight, tail=_TAIL):
    """A weak wish for slopes of the curves that change little from node to node: it decides where the tests do not.

    For the damping curve minus the logarithm of Student's t density: a valve that opens makes one large change among small ones, and
    a normal density (``tail`` of 1e6) would round its corner off.
    """
    bend = bends(made, x)
    rows = [np.sign(bend) * np.sqrt(tail * np.log1p(bend**2 / tail))]
    if made.stiffness_nodes is not None:
        slope = made.split(x)[1][1:] / np.diff(made.stiffness_nodes) * made.stiffness_nodes[-1]
        rows.append((slope[1:] - slope[:-1]) / _SOFT)
    return weight * np.concatenate(rows)


def _weight(loops, left=0.0):
    """Size of the error of one entry of the misfit; ``left`` is what a model leaves that is wrong."""
    return max(noise_floor(loops), _LEAST_NOISE, left) / np.sqrt(2.0 * loops.kept.sum())


def cost(loops, made, x, fixed):
    """What least squares makes small: squares of the misfit, weighted, and of the wish for smooth curves."""
    entries = np.concatenate([misfit(loops, made, x, fixed) * entry_weights(loops), _roughness(made, x, _weight(loops))])
    return float(entries @ entries)


def evidence(loops, made, x, fixed, weight=None, state=None, tail=_TAIL):
    """Slopes of the misfit and, below them, of the wish for smooth curves."""
    weight = _weight(loops) if weight is None else weight
    own = _roughness(made, x, weight, tail)
    rows = np.array([(_roughness(made, x + _STEP * unit, weight, tail) - own) / _STEP for unit in np.eye(x.size)]).T
    return np.concatenate([jacobian(loops, made, x, fixed, state) * entry_weights(loops)[:, None], rows])


def refine(loops, made, x, fixed, bounds, progress=False, most=40, left=0.0):
    """Least squares from ``x``; its parametrisation and vector."""
    from scipy.optimize import least_squares

    low, high = made.bounds(bounds)
    state = np.zeros_like(loops.force)
    weight, tail = _weight(loops, left), 1e6 if left else _TAIL      # what a wrong model leaves is no reason for corners

    whiten = entry_weights(loops)

    def function(p):
        return np.concatenate([misfit(loops, made, p, fixed, state) * whiten, _roughness(made, p, weight, tail)])

    x = np.clip(x, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
    if not np.isfinite(function(x)).all():
        return made, x
    found = least_squares(function, x, lambda p: evidence(loops, made, p, fixed, weight, state, tail), bounds=(low, high), x_scale="jac", ftol=1e-5,
                          xtol=1e-6, gtol=1e-12, max_nfev=most, verbose=2 if progress else 0)
    return made, found.x


def with_better_nodes(loops, made, x, count=28):
    """The same damping curve with nodes over the speeds that the damper has in these tests, denser where it bends."""
    model = made.model(x)
    record = model.force_law_record()
    try:
        force = steady(loops, model)[0]
    except CoreError:
        return made, x
    speed = loops.velocity if made.kind == "viscous" else own_speed(record, force)
    speed = np.clip(speed, -_WIDEST * np.abs(loops.velocity).max(), _WIDEST * np.abs(loops.velocity).max())
    low = 0.3 * np.abs(speed).max(axis=1).min()
    if made.damping_nodes[0] == 0.0:
        nodes = _spread(record, np.abs(speed).max(), low, count)
    else:
        nodes = np.concatenate([_spread(record, speed.min(), low, count)[:0:-1], _spread(record, speed.max(), low, count)])
    damping, stiffness, lag = made.split(x)
    value = _damping(record, nodes)[0]
    moved = replace(made, damping_nodes=nodes)
    return moved, np.concatenate([moved.vector(value, np.ones(max(len(stiffness), 1)), 0.0)[:len(nodes) - 1], stiffness, lag])


def _spread(record, end, low, count):
    """Nodes from 0 to ``end``: shares of speed, of its logarithm down to ``low``, of force and of bend."""
    def force_and_bend(fine):
        force, slope = _damping(record, fine * end)
        bend = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(np.log(np.maximum(slope, 1e-3 * slope.max())))))])
        return np.abs(force / force[-1]) + bend / max(bend[-1], 1.0)

    return end * shared(low / abs(end), count, force_and_bend, (0.7, 0.7, 1.4))
