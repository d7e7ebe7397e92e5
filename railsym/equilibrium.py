# SPDX-License-Identifier: BSD-3-Clause
"""Static preload: the element forces that make the design position the equilibrium.

On straight level track at rest. The vehicle is loaded by gravity with its wheelsets held
vertically and in roll by the rails; each elastic component then carries k e(delta), with
delta the linear displacement, and the wheel loads are the reactions at the rails.
"""

from dataclasses import dataclass

import numpy as np

from railsym.errors import ModelError
from railsym.force_laws import slope_at_rest
from railsym.model import bushing_diagonals, law_directions

# A rigid motion counts as free when its stiffness is this small against the largest one:
# far above roundoff of the assembled matrix (1e-15), far below any real spring.
_FREE = 1e-10
_RIGID = np.array([0, 1, 3])  # x, y and yaw among a body's coordinates


@dataclass(frozen=True)
class Preload:
    """Static forces at the design position.

    Attributes
    ----------
    bushing_forces : ndarray, shape (bushings, 6)
        N and N m.
    law_forces : ndarray, shape (line and axis elements,)
        N, positive pulls the ends together.
    wheel_loads : ndarray, shape (wheels,)
        Normal loads, N, left and right of each wheelset.
    """

    bushing_forces: np.ndarray
    law_forces: np.ndarray
    wheel_loads: np.ndarray


def static_preload(model):
    """Preload of a model's vehicle; sets it in the model.

    Parameters
    ----------
    model : railsym.model.Model
        Without wheel-rail contact, on straight level track.

    Returns
    -------
    Preload

    Raises
    ------
    ModelError
        A body that nothing holds, or a wheel that carries no load.
    """
    return Statics(model).preload(component_stiffness(model), -model.residual())


def component_stiffness(model):
    """Stiffness of every elastic component: six a bushing, then one a line or axis element; SI."""
    return np.concatenate([bushing_diagonals(model.bushings)[0].ravel(), [slope_at_rest(e) for e in model.laws]])


class Statics:
    """What the places of a model's bodies and elements alone decide of its preload.

    Parameters
    ----------
    model : railsym.model.Model
        Without wheel-rail contact, on straight level track.
    """

    def __init__(self, model):
        self.model = model
        self._index, self._form = _deformations(model)
        products = self._form[:, :, None] * self._form[:, None, :]
        existing = self._index < model.size
        self._component, i, j = np.nonzero((products != 0.0) & existing[:, :, None] & existing[:, None, :])
        self._product = products[self._component, i, j]
        self._entry = model.size * self._index[self._component, i] + self._index[self._component, j]
        self._motions = _rigid_motions(model)
        self._free = ~(model.topology.first_order | model.topology.cyclic)
        self._wheelsets = [b for b in model.vehicle.bodies if b.kind == "wheelset"]
        for body in self._wheelsets:
            self._free[model.topology.start[body.name] + np.array([2, 4])] = False

    def preload(self, stiffness, load):
        """Preload for stiffnesses (components,) and a load (n,) in N and N m; sets it in the model."""
        moved = np.append(self._displacement(self._matrix(stiffness), load), 0.0)
        forces = stiffness * (self._form * moved[self._index]).sum(axis=1)
        split = 6 * len(self.model.bushings)
        bushing_forces, law_forces = forces[:split].reshape(-1, 6), forces[split:]
        self.model.set_preload(bushing_forces, law_forces)
        return Preload(bushing_forces, law_forces, self._wheel_loads())

    def _matrix(self, stiffness):
        """Elastic stiffness sum k e e^T at the design position, (n, n)."""
        n = self.model.size
        return np.bincount(self._entry, self._product * stiffness[self._component], n * n).reshape(n, n)

    def _displacement(self, stiffness, load):
        """Static displacement with the wheelsets held by the rails and free rigid motions held."""
        picked = np.flatnonzero(self._free & ~self._held(stiffness))
        moved = np.zeros(self.model.size)
        matrix = stiffness[picked[:, None], picked]
        try:
            moved[picked] = np.linalg.solve(matrix, load[picked])
            wrong = np.abs(matrix @ moved[picked] - load[picked]).max(initial=0.0)
            scale = np.abs(load).max(initial=1.0)
        except np.linalg.LinAlgError:
            wrong, scale = np.inf, 1.0
        if not wrong <= 1e-6 * scale or np.abs(moved).max(initial=0.0) > 1e3:
            raise ModelError(_unheld(self.model, picked, matrix))
        return moved

    def _held(self, stiffness):
        """True for x, y or yaw of the first body where the whole vehicle can move so without force."""
        first, held = self.model.topology.start[self.model.vehicle.bodies[0].name], np.zeros(self.model.size, bool)
        size = np.abs(stiffness).max(initial=1.0)
        force = np.abs(stiffness @ self._motions).max(axis=0)
        held[first + _RIGID[force < _FREE * size * np.abs(self._motions).max(axis=0)]] = True
        return held

    def _wheel_loads(self):
        """Reactions of the rails, N: left and right of each wheelset, from z and roll."""
        r, loads = self.model.residual(), []
        for body in self._wheelsets:
            k = self.model.topology.start[body.name]
            mean, moment = -0.5 * r[k + 2], -0.5 * r[k + 4] / body.contact_half_spacing
            loads += [mean - moment, mean + moment]
            if min(loads[-2:]) <= 0.0:
                raise ModelError(f"{body.name}: static wheel loads {loads[-2] / 1e3:.3g} kN left, {loads[-1] / 1e3:.3g} kN "
                                 "right; both must be positive: check masses and the sides of its springs")
        return np.array(loads)


def _deformations(model):
    """Where every component's deformation e comes from: coordinates and de/dq there, each (components, 12)."""
    pair = model.bushing_pairs
    axes = np.array([e.axes for e in model.bushings]).reshape(-1, 3, 3)
    six = np.concatenate([np.swapaxes(axes, 1, 2) @ part for part in _relative_motion(pair)], axis=1)
    scalar = law_directions(model.laws, model.law_pairs.apart)[:, None, :] @ _relative_motion(model.law_pairs)[0]
    index = np.concatenate([np.repeat(pair.index, 6, axis=0), model.law_pairs.index])
    return np.where(index < 0, model.size, index), np.concatenate([six.reshape(-1, 12), scalar[:, 0]])


def _relative_motion(pair):
    """Rates of separation and relative rotation seen from the first body, each (count, 3, 12)."""
    count = len(pair.index)
    shift, turn = np.zeros((2, count, 3, 12))
    lever = pair.marker1 + pair.apart
    shift[:, :, 0:3], shift[:, :, 6:9] = -np.eye(3), np.eye(3)
    shift[:, :, 3:6], shift[:, :, 9:12] = _turning(lever) @ _AXES, -_turning(pair.marker2) @ _AXES
    turn[:, :, 3:6], turn[:, :, 9:12] = -_AXES, _AXES
    return shift, turn


_AXES = np.eye(3)[[2, 0, 1]].T  # yaw, roll, pitch rates as a vector


def _turning(arm):
    """Matrices of ``arm x``, (count, 3, 3)."""
    matrix = np.zeros((len(arm), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        matrix[:, j, i], matrix[:, i, j] = arm[:, k], -arm[:, k]
    return matrix


def _rigid_motions(model):
    """The whole vehicle shifted along and across the track and turned about z, (n, 3)."""
    motions = np.zeros((model.size, 3))
    for body in model.vehicle.bodies:
        k = model.topology.start[body.name]
        motions[k, 0] = motions[k + 1, 1] = motions[k + 3, 2] = 1.0
        motions[k, 2], motions[k + 1, 2] = -body.position[1], body.position[0]
    return motions


def _unheld(model, picked, matrix):
    values, vectors = np.linalg.eigh(matrix)
    k = int(np.argmin(np.abs(values)))
    worst = picked[np.argsort(-np.abs(vectors[:, k]))[:3]]
    names = ", ".join(model.topology.coordinates[i] for i in worst)
    return (f"vehicle {model.vehicle.name!r} has no static equilibrium: nothing holds {names} (stiffness "
            f"{values[k]:.3g} against {values[-1]:.3g} at most, SI); give those bodies an element with stiffness there")
