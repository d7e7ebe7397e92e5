# SPDX-License-Identifier: BSD-3-Clause
"""First-order reliability: the probability that a result lies below a limit, from gradients.

With u standard normal, x = ppf(Phi(u)) and g(u) = (result - limit)/scale, the design point is the point of g = 0 nearest to the origin.
Linearised there, P(g < 0) = Phi(-beta), beta = -alpha.u*, alpha = grad g/|grad g| (Hasofer and Lind 1974; Rackwitz and Fiessler 1978).
The iteration u <- alpha (alpha.u - g/|grad g|) goes with a step that lowers the merit function |u|^2/2 + c |g| (Zhang and Der Kiureghian 1995).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railsym.errors import ConvergenceError, RailsymError
from railsym.uncertainty.errors import UncertaintyError
from railsym.uncertainty.tolerances import FARTHEST, as_tolerances

_TOLERANCE = 1e-4      # of u and of g over its gradient: 1e-4 of a standard deviation moves the probability by less than 1e-3 of it


@dataclass(frozen=True, eq=False)
class Form:
    """First-order reliability estimate.

    Attributes
    ----------
    limit, nominal : float
        The limit, and the result at the medians.
    beta : float
        Reliability index; negative where the result at the medians lies below the limit.
    probability : float
        Phi(-beta).
    mean_value_probability : float
        From the gradient at the medians alone, without looking for the design point.
    names : tuple of str
    design_point, u : ndarray, shape (k,)
        The most probable parameters at the limit, in SI and in the normal space.
    importance : ndarray, shape (k,)
        alpha_i^2, which add to 1.
    evaluations : int
        Of the result with its gradient.
    output, unit : str
    """

    limit: float
    nominal: float
    beta: float
    probability: float
    mean_value_probability: float
    names: tuple[str, ...]
    design_point: np.ndarray
    u: np.ndarray
    importance: np.ndarray
    evaluations: int
    output: str
    unit: str

    @property
    def message(self) -> str:
        """In one line."""
        return (f"P({self.output} < {self.limit:g} {self.unit}) = {self.probability:.3g} to first order (beta {self.beta:.3f}, {self.evaluations} gradients; "
                f"{self.mean_value_probability:.3g} from the gradient at the medians)")

    def __str__(self):
        order = np.argsort(-self.importance)
        lines = [f"  {self.names[k]:44} {self.design_point[k]:12.5g}  importance {self.importance[k]:.3f}" for k in order]
        return "\n".join([self.message, "most probable parameters at the limit:", *lines])


def form(model, tolerances, limit: float, *, most: int = 50) -> Form:
    """Probability that a result lies below a limit, by the first-order reliability method.

    Parameters
    ----------
    model : callable
        Parameters (k,) in the order of `tolerances` to (value, gradient (k,)).
    tolerances : mapping of str to distribution
        Independent.
    limit : float
        In the unit of the result.
    most : int
        Iterations.

    Returns
    -------
    Form

    Raises
    ------
    ConvergenceError
        No design point, or one that lies more than 7 standard deviations out (a probability below 1e-12).
    UncertaintyError
        A result that no tolerance moves.
    RailsymError
        What the model raises.

    Notes
    -----
    The estimate is of first order: exact where the limit surface is a plane in the normal space. A critical speed is the lowest over the modes,
    so the surface can have edges, where another mode takes over; and more than one design point. A count of cases (`probability_below`) knows
    neither weakness.
    """
    search = _Search(model, as_tolerances(tolerances), float(limit))
    u = np.zeros(len(search.tolerances))
    value, gradient = search(u)
    nominal, size = value * search.scale + limit, np.linalg.norm(gradient)
    mean_value = value / size
    for _ in range(most):
        alpha = gradient / np.linalg.norm(gradient)
        distance = value / np.linalg.norm(gradient)
        target = alpha * (alpha @ u - distance)
        if abs(distance) < _TOLERANCE and np.linalg.norm(target - u) < _TOLERANCE * max(1.0, np.linalg.norm(u)):
            return search.result(nominal, u, alpha, mean_value)
        u, value, gradient = search.step(u, target, value, gradient)
    raise ConvergenceError(f"first-order reliability: no design point at {limit:g} after {most} iterations (distance {distance:.3g} standard deviations); "
                           "another mode may take over near it: count cases instead (probability_below)")


class _Search:
    """The limit function in the normal space, and the steps towards the design point."""

    def __init__(self, model, tolerances, limit):
        self.model, self.tolerances, self.limit, self.scale, self.evaluations = model, tolerances, limit, 1.0, 0

    def __call__(self, u):
        x = self.tolerances.from_normal(u)
        value, gradient = self.model(x)
        self.evaluations += 1
        in_normal = np.asarray(gradient, float) * self.tolerances.slope(u)
        if self.evaluations == 1:
            self.scale = float(np.linalg.norm(in_normal))      # g then counts standard deviations
        if not np.isfinite(in_normal).all() or not np.linalg.norm(in_normal) > 0.0:
            raise UncertaintyError(f"the gradient of the result at {dict(zip(self.tolerances.names, x))} is {gradient}: no tolerance moves it")
        return (value - self.limit) / self.scale, in_normal / self.scale

    def step(self, u, target, value, gradient):
        """The first of the steps 1, 1/2, 1/4, ... along target - u that lowers the merit function."""
        if np.abs(target).max() > FARTHEST:
            raise ConvergenceError(f"first-order reliability: the limit {self.limit:g} lies more than {FARTHEST:g} standard deviations from the medians "
                                   "(a probability below 1e-12)")
        weight = 2.0 * np.linalg.norm(u) / np.linalg.norm(gradient) + 10.0
        merit = 0.5 * u @ u + weight * abs(value)
        failure = None
        for halving in range(8):
            trial = u + 0.5**halving * (target - u)
            try:
                found = self(trial)
            except UncertaintyError:
                raise
            except RailsymError as error:
                failure = error
                continue
            if 0.5 * trial @ trial + weight * abs(found[0]) < merit or halving == 7:
                return (trial, *found)
        raise ConvergenceError(f"first-order reliability: no result on the way to the limit {self.limit:g}: {failure}")

    def result(self, nominal, u, alpha, mean_value):
        from scipy.special import ndtr

        beta = float(-alpha @ u)
        return Form(self.limit, float(nominal), beta, float(ndtr(-beta)), float(ndtr(-mean_value)), self.tolerances.names, self.tolerances.from_normal(u), u,
                    alpha**2, self.evaluations, getattr(self.model, "output", "result"), getattr(self.model, "unit", ""))
