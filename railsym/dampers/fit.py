# SPDX-License-Identifier: BSD-3-Clause
"""Identify a damper model from bench tests: energy method, and least squares on the loops."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from railsym.dampers import corners, elongation, energy, solve
from railsym.dampers.models import DamperModel
from railsym.dampers.parametrisation import Parametrisation, stiffness_nodes
from railsym.dampers.uncertainty import Identifiability, covariance, estimated_weights, identifiability, intervals
from railsym.errors import ModelError

MODELS = ("viscous", "maxwell", "maxwell_nonlinear")
METHODS = ("energy", "least_squares")
_DIFFERENT_FREQUENCIES = 1.2  # ratio that tells the lag
_GOOD = 1e-3                  # relative misfit below which a constant is enough
_EXCESS = 1.6                 # times the noise that the lowest orders leave, above which a constant is not enough
_DOUBTFUL = 0.02              # relative misfit above which a fit is begun again from another lag
_NO_MODEL = {"energy": 0.15, "least_squares": 0.05}  # relative misfit above which a model is wrong even if none is better
_CONSTANT = 0.04             # a stiffness that changes by less over the tests is constant
_WRONG = 0.03                 # relative misfit of a curve above which the model cannot be right
_HOPELESS = 0.05              # relative misfit of constants by the energy method above which a curve is needed
_CORNER = 4.0                 # usual changes of slope between two nodes: a corner, about which nodes are placed anew
_STEEPEST = 100.0             # times the equivalent damping: the start of a curve
_EVEN = 2e-3                  # even harmonics above this part of the force, and above noise: not symmetric


@dataclass(frozen=True)
class TestError:
    """Errors of a fit in one test: loop (r.m.s. force error over r.m.s. force), energy and peak force (relative, signed), s."""

    name: str
    frequency: float
    amplitude: float
    loop_error: float
    energy_error: float
    peak_error: float
    computing_time: float
    __test__ = False


@dataclass(frozen=True, eq=False)
class Fit:
    """An identified damper.

    Attributes
    ----------
    model : DamperModel
    method : str
    damping, series_stiffness : float
        N s/m and N/m (None for viscous): constants, or of a curve the equivalent constants over all tests by the energy method.
    confidence : dict
        Name -> 95 % interval (low, high), SI. Empty for the energy method.
    identifiability : Identifiability or None
    tests : tuple of TestError
    lag : float
        s, of the force channel behind the displacement channel (mean over tests if each has its own).
    message : str
    seconds : float
    """

    model: DamperModel
    method: str
    damping: float
    series_stiffness: float | None
    confidence: dict
    identifiability: Identifiability | None
    tests: tuple[TestError, ...]
    lag: float
    message: str
    seconds: float
    records: tuple = field(default=(), repr=False)

    @property
    def damping_curve(self):
        """(speed, force) or None."""
        return self.model.damping_curve

    @property
    def series_stiffness_curve(self):
        """(speed, stiffness) or None."""
        return self.model.series_stiffness_curve

    def to_toml(self, path=None, name="anti_yaw_damper"):
        """Vehicle-file lines of the model; written to ``path`` if given."""
        from railsym.dampers.toml_output import damper_toml

        return damper_toml(self.model, path, name)

    def plot(self):
        """Force against speed, stiffness against speed, and loops."""
        from railsym.plots.dampers import plot_damper

        return plot_damper({"maxwell_nonlinear" if self.series_stiffness_curve else self.model.kind: self}, self.records)


def identify(records, model="maxwell", method="least_squares", bounds=None, progress=False, *, damping="auto", symmetric="auto",
             lag="auto"):
    """Identify a damper model from sinusoidal bench tests.

    Parameters
    ----------
    records : sequence of Record or CleanRecord
    model : str
        "viscous", "maxwell" or "maxwell_nonlinear" (series stiffness a monotone function of speed).
    method : str
        "energy", or "least_squares" started from it.
    bounds : dict, optional
        "damping", "series_stiffness", "lag" -> (low, high), SI; for constants.
    damping : str
        "constant", "curve", or "auto": a curve where a constant leaves more than noise.
    symmetric : bool or "auto"
        Whether the damping curve is odd; "auto" looks at the even harmonics of the force.
    lag : float or "auto"
        s; "auto" estimates one lag over all tests if they differ enough in frequency.

    Returns
    -------
    Fit

    Raises
    ------
    ModelError
        An unknown model or method, or no records.
    """
    started = perf_counter()
    _check("model", model, MODELS), _check("method", method, METHODS), _check("damping", damping, ("auto", "constant", "curve"))
    cleaned = _cleaned(records)
    loops = energy.loops_of(cleaned)
    odd = _is_odd(loops) if symmetric == "auto" else bool(symmetric)
    free_lag = lag == "auto" and loops.angular.max() > _DIFFERENT_FREQUENCIES * loops.angular.min()
    fixed = 0.0 if lag == "auto" else float(lag)
    given = None if free_lag else fixed
    best = _best_shape(loops, damping, model, odd, given, method, bounds, progress)
    return _result(cleaned, loops, best, fixed, model, method, bounds, free_lag or lag != "auto", started)


def _best_shape(loops, damping, model, odd, given, method, bounds, progress):
    """Parametrisation, vector and misfit of a constant damping or a curve, as asked; of both the constant where it leaves no more than noise."""
    shapes = {"constant": (False,), "curve": (True,), "auto": (False, True)}[damping]
    best = None
    for curve in shapes:
        found = _fitted(loops, model, curve, odd, given, "energy" if len(shapes) > 1 and not curve else method, bounds, progress)
        if method == "least_squares" and len(shapes) > 1 and not curve and _norm(found[2]) < _HOPELESS:
            found = _fitted(loops, model, curve, odd, given, method, bounds, progress)
        if best is None or _is_better(loops, found[2], best[2]):
            best = found
        if _norm(best[2]) < np.hypot(_GOOD, 1.3 * solve.noise_floor(loops)) and solve.low_excess(loops, best[2]) < _EXCESS:
            break
    return best


def _is_better(loops, found, best):
    """Whether the misfit of a curve is clearly less than that of a constant, in all or in the lowest orders."""
    before = solve.low_excess(loops, best)
    return _norm(found) < 0.8 * _norm(best) or (before > _EXCESS and solve.low_excess(loops, found) < 0.7 * before)


def _check(what, value, allowed):
    if value not in allowed:
        raise ModelError(f"{what} {value!r} does not exist; there are {', '.join(allowed)}")


def _cleaned(records):
    from railsym.dampers.cleaning import clean_all
    from railsym.dampers.record import Record

    records = [records] if isinstance(records, Record) or hasattr(records, "mean_cycle") else list(records)
    if not records:
        raise ModelError("identify: no records were given; at least one test is needed")
    return clean_all(records) if any(isinstance(one, Record) for one in records) else records


def _is_odd(loops):
    """Whether the even harmonics of the force are noise in half of the tests."""
    even, total = np.linalg.norm(loops.harmonics[:, 1::2], axis=1), np.linalg.norm(loops.harmonics, axis=1)
    noise = np.linalg.norm(loops.deviation[:, 1::2] * loops.kept[:, 1::2], axis=1)
    return bool(np.median((even - 1.7 * noise) / total) < _EVEN)


def _norm(misfit):
    return float(np.sqrt(misfit @ misfit))


def _speeds(loops, model):
    """Nodes of the stiffness curve of a model that has one."""
    return stiffness_nodes(loops.velocity) if model == "maxwell_nonlinear" else None


def _lags(loops, model, curve, odd, given):
    """Lags (s) to begin with, the likeliest first."""
    if given is not None:
        return [given]
    plain = energy.constants(loops, viscous=model == "viscous")[2]
    if model == "viscous" or (model == "maxwell" and not curve):
        return [plain]
    return [elongation.lag_by_elongation(loops, _speeds(loops, model), odd, None if curve else _one_level(loops)), plain]


def _one_level(loops):
    """Level of force that makes the damper's curve a constant."""
    return np.array([0.0, np.abs(loops.force).max()])


def _fitted(loops, model, curve, odd, given, method, bounds, progress=False, passes=(25, 40)):
    """Parametrisation, vector and misfit; from the second lag too where the first one leaves much."""
    best, fixed = None, 0.0 if given is None else given
    for tau in _lags(loops, model, curve, odd, given):
        made, x = _start(loops, model, curve, odd, tau, int(given is None))
        if method == "least_squares":
            made, x = _sharpened(loops, made, x, fixed, bounds, progress, passes)
        found = made, x, solve.misfit(loops.coarse(max(1, loops.force.shape[1] // 128)) if method == "energy" else loops, made, x, fixed)
        if best is None or _norm(found[2]) < _norm(best[2]):
            best = found
        if _norm(best[2]) < (_NO_MODEL[method] if method == "energy" else np.hypot(_DOUBTFUL, 2.0 * solve.noise_floor(loops))):
            break
    return best


def _sharpened(loops, made, x, fixed, bounds, progress, passes=(25, 40)):
    """Least squares; a curve gets nodes after its start, and once more where it then leaves more than noise."""
    if made.damping_nodes is None:
        return solve.refine(loops, made, x, fixed, bounds, progress)
    left = 0.0
    for most in passes:
        made, x = solve.with_better_nodes(loops, made, x)
        made, x = solve.refine(loops, made, x, fixed, bounds, progress, most, left)
        misfit = _norm(solve.misfit(loops, made, x, fixed))
        if misfit < np.hypot(_GOOD, 1.1 * solve.noise_floor(loops)) and np.abs(solve.bends(made, x)).max() < _CORNER:
            break
        # what a wrong model leaves is no reason for a curve with steps
        left = min(misfit, 0.2) if misfit > np.hypot(_WRONG, 3.0 * solve.noise_floor(loops)) else 0.0
    return (made, x) if left else _with_better_corners(loops, made, x, fixed, bounds, progress, passes[-1])


def _with_better_corners(loops, made, x, fixed, bounds, progress, most):
    """The fit, or one begun from corners in place of groups of bends where tests and prior like that better."""
    shaped = corners.with_corners(made, x)
    if shaped is None:
        return made, x
    tried = solve.refine(loops, *shaped, fixed, bounds, progress, most)
    return tried if solve.cost(loops, *tried, fixed) < solve.cost(loops, made, x, fixed) else (made, x)


def _start(loops, model, curve, odd, tau, lags):
    """Parametrisation and vector by the energy method."""
    shifted, nodes = loops.shifted(tau), _speeds(loops, model)
    stiffness, value, _ = energy.constants(loops, tau, model == "viscous")
    kind, rising, at = "viscous" if model == "viscous" else "maxwell", True, None
    if kind == "maxwell" and (curve or nodes is not None):
        found = elongation.refined_elongation(shifted, nodes, odd) if curve else elongation.split_elongation(shifted, nodes, True, _one_level(loops))
        stiffness, rising = _monotone(1.0 / np.maximum(found.compliance, 1e-10))
        at, curve_force = found.speed, found.force
        value = max(float(found.force[-1] / max(found.speed[-1], 1e-12)), 1.0)
        if curve:
            # a step of force takes a little speed, so that D has a slope everywhere
            at, value = at + curve_force / (_STEEPEST * np.ptp(curve_force) / max(np.ptp(at), 1e-9)), curve_force
    elif curve:
        at = energy.speed_nodes(loops, odd)
        value = energy.force_curve(shifted, loops.velocity, at, _STEEPEST * max(value, 1.0))
    at = at if curve else None
    made = Parametrisation(kind, at, nodes, float(np.abs(loops.force).max()), rising, lags)
    return made, made.vector(value, stiffness, tau)


def _monotone(stiffness):
    """A stiffness curve made monotone in the direction of its ends, within a factor of ten of its median; whether it rises."""
    middle = float(np.clip(np.median(stiffness), 1e4, 1e10))
    clipped = np.clip(stiffness, 0.1 * middle, 10.0 * middle)
    rising = bool(clipped[-1] >= clipped[0])
    # the mean of the two tightest monotone curves from either end
    sign = 1.0 if rising else -1.0
    up, down = np.maximum.accumulate(sign * clipped), np.minimum.accumulate(sign * clipped[::-1])[::-1]
    return sign * 0.5 * (up + down), rising


def _result(cleaned, loops, best, fixed, model, method, bounds, lag_known, started):
    made, x, misfit = best
    damper = made.model(x, f"identified from {len(cleaned)} bench tests, {method.replace('_', ' ')}")
    lag = float(np.mean(made.lag(x))) if made.lags else fixed
    confidence, told = {}, None
    if method == "least_squares":
        freedom = misfit.size - x.size
        jacobian = solve.evidence(loops, made, x, fixed)
        whiten = solve.entry_weights(loops)
        deviation = solve.entry_deviations(loops, made.damping_nodes is not None or made.stiffness_nodes is not None)
        spread = covariance(jacobian, deviation * whiten, misfit * whiten) * estimated_weights([one.cycles for one in cleaned])
        confidence = intervals(made, x, spread, freedom)
        told = identifiability(made, x, jacobian, spread, made.bounds(bounds), confidence)
    tests = _errors(cleaned, loops, damper, lag)
    shifted = loops.shifted(lag)
    stiffness = damper.series_stiffness
    if made.kind == "maxwell" and stiffness is None:
        stiffness = 1.0 / max(float(elongation.split_elongation(shifted.coarse(), None, made.damping_nodes is None or made.damping_nodes[0] == 0.0).compliance[0]), 1e-10)
    compliance = np.array([0.0 if stiffness is None else 1.0 / stiffness])
    damping = damper.damping or energy.dissipated(shifted, energy.damper_speed(shifted, compliance))
    message = _message(loops, model, method, _norm(misfit), lag, lag_known, made, x, stiffness, damping, told)
    return Fit(damper, method, damping, stiffness, confidence, told, tests, lag, message, perf_counter() - started, tuple(cleaned))


def _errors(cleaned, loops, damper, lag):
    found, shifted = [], loops.coarse(max(1, loops.force.shape[1] // 128)).shifted(lag)
    for k, one in enumerate(cleaned):
        begun = perf_counter()
        force = solve.steady(shifted.only(k), damper)[0]
        seconds = perf_counter() - begun
        measured = shifted.force[k]
        moving = force[0] - force[0].mean()
        work, wanted = (np.mean(part * shifted.velocity[k]) for part in (moving, measured))
        error = np.sqrt(np.mean((moving - measured) ** 2) + loops.noise[k] ** 2) / loops.scale[k]
        found.append(TestError(one.name, one.frequency, one.amplitude, float(error), float(work / wanted - 1.0),
                               float(np.ptp(moving) / np.ptp(measured) - 1.0), seconds))
    return tuple(found)


def _message(loops, model, method, misfit, lag, lag_known, made, x, stiffness, damping, told):
    """What the fit leaves, and which other model would leave less or be enough."""
    floor = solve.noise_floor(loops)
    said = [f"{model}: the loops are met within {100 * misfit:.2g} % of the r.m.s. force (noise of the mean cycles {100 * floor:.2g} %)"]
    if misfit > np.hypot(5e-3, 3.0 * floor):
        better = _better(loops, model, method, None if made.lags else lag, misfit)
        if better:
            said.append(f"wrong model: {better} leaves less")
        elif misfit > np.hypot(_NO_MODEL[method], 3.0 * floor):
            said.append("wrong model: none of the models here meets these loops")
        elif method == "energy":
            said.append("least squares will leave less")
        else:
            said.append("that is more than noise, but no other model leaves less")
    if method == "energy" and made.damping_nodes is not None and made.damping_nodes[0] < 0.0:
        said.append("the force is not the same in both directions: its curve by the energy method is rough, take least squares")
    if made.kind == "maxwell" and loops.angular.max() * damping / np.max(stiffness) < 0.02:
        said.append(f"the series stiffness {stiffness:.3g} N/m is too high to matter in these tests: a viscous model is enough")
    elif made.stiffness_nodes is not None and made.split(x)[1][1:].sum() < _CONSTANT:
        said.append("the stiffness hardly changes with speed: maxwell, with a constant one, is enough")
    if made.kind == "viscous" and abs(lag) > 5e-4 and "wrong model" not in said[-1]:
        said.append(f"a lag of {1e3 * lag:.2f} ms does here what a series stiffness of {damping / abs(lag):.3g} N/m would do"
                    if lag > 0 else f"the force leads by {-1e3 * lag:.2f} ms")
    if not lag_known:
        said.append("all tests have about one frequency: the lag cannot be told and is taken as 0")
    return "; ".join([*said, *(told.warnings if told else ())])


def _better(loops, model, method, given, misfit):
    """The first costlier model that leaves less than half of the misfit, by a quarter of the points."""
    quick = loops.coarse()
    for other in MODELS[MODELS.index(model) + 1:]:
        if _norm(_fitted(quick, other, True, _is_odd(loops), given, method, None, passes=(12,))[2]) < 0.5 * misfit:
            return other
    return None
