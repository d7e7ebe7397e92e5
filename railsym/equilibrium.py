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
    load = -model.residual()
    forms, stiffness = _deformations(model)
    moved = _displacement(model, _stiffness(model, forms, stiffness), load)
    forces = stiffness * (forms @ moved)
    split = 6 * len(model.bushings)
    bushing_forces, law_forces = forces[:split].reshape(-1, 6), forces[split:]
    model.set_preload(bushing_forces, law_forces)
    return Preload(bushing_forces, law_forces, _wheel_loads(model))


def _stiffness(model, forms, stiffness):
    """Elastic stiffness sum k e e^T at the design position."""
    used = stiffness != 0.0
    part = forms[used]
    return part.T @ (stiffness[used, None] * part)


def _deformations(model):
    """Rows de/dq of every component at the design position, and their stiffnesses."""
    pair, count = model.bushing_pairs, len(model.bushings)
    axes = np.array([e.axes for e in model.bushings]).reshape(-1, 3, 3)
    shift, turn = _relative_motion(pair)
    six = np.concatenate([np.swapaxes(axes, 1, 2) @ part for part in (shift, turn)], axis=1)
    rows = [_scattered(six, pair.index, model.size).reshape(6 * count, model.size)]
    stiffness = [bushing_diagonals(model.bushings)[0].ravel()]

    pair = model.law_pairs
    along = law_directions(model.laws, pair.apart)
    scalar = along[:, None, :] @ _relative_motion(pair)[0]
    rows.append(_scattered(scalar, pair.index, model.size)[:, 0])
    stiffness.append([slope_at_rest(e) for e in model.laws])
    return np.vstack(rows), np.concatenate(stiffness)


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


def _scattered(values, index, size):
    """Values (count, rows, 12) placed in the model's columns, (count, rows, size)."""
    wide = np.zeros((*values.shape[:2], size + 1))  # the last column takes what does not exist
    count, rows = values.shape[:2]
    where = np.broadcast_to(index[:, None, :], values.shape)
    np.add.at(wide, (np.arange(count)[:, None, None], np.arange(rows)[None, :, None], where), values)
    return wide[:, :, :size]


def _displacement(model, stiffness, load):
    """Static displacement with the wheelsets held by the rails and free rigid motions held."""
    topo = model.topology
    free = ~(topo.first_order | topo.cyclic)
    for body in model.vehicle.bodies:
        if body.kind == "wheelset":
            free[topo.start[body.name] + np.array([2, 4])] = False
    _hold_rigid_motions(model, stiffness, free)
    moved = np.zeros(model.size)
    picked = np.flatnonzero(free)
    matrix = stiffness[np.ix_(picked, picked)]
    try:
        moved[picked] = np.linalg.solve(matrix, load[picked])
        wrong = np.abs(matrix @ moved[picked] - load[picked]).max(initial=0.0)
        scale = np.abs(load).max(initial=1.0)
    except np.linalg.LinAlgError:
        wrong, scale = np.inf, 1.0
    if not wrong <= 1e-6 * scale or np.abs(moved).max(initial=0.0) > 1e3:
        raise ModelError(_unheld(model, picked, matrix))
    return moved


def _hold_rigid_motions(model, stiffness, free):
    """Hold x, y or yaw of the first body where the whole vehicle can move so without force."""
    names, topo = model.topology.coordinates, model.topology
    motions = {"x": np.zeros(model.size), "y": np.zeros(model.size), "yaw": np.zeros(model.size)}
    for body in model.vehicle.bodies:
        k = topo.start[body.name]
        motions["x"][k] = motions["y"][k + 1] = motions["yaw"][k + 3] = 1.0
        motions["yaw"][k], motions["yaw"][k + 1] = -body.position[1], body.position[0]
    first = model.vehicle.bodies[0].name
    size = np.abs(stiffness).max(initial=1.0)
    for axis, motion in motions.items():
        if np.abs(stiffness @ motion).max() < _FREE * size * np.abs(motion).max():
            free[names.index(f"{first}.{axis}")] = False


def _unheld(model, picked, matrix):
    values, vectors = np.linalg.eigh(matrix)
    k = int(np.argmin(np.abs(values)))
    worst = picked[np.argsort(-np.abs(vectors[:, k]))[:3]]
    names = ", ".join(model.topology.coordinates[i] for i in worst)
    return (f"vehicle {model.vehicle.name!r} has no static equilibrium: nothing holds {names} (stiffness "
            f"{values[k]:.3g} against {values[-1]:.3g} at most, SI); give those bodies an element with stiffness there")


def _wheel_loads(model):
    """Reactions of the rails, N: left and right of each wheelset, from z and roll."""
    r, loads = model.residual(), []
    for body in model.vehicle.bodies:
        if body.kind != "wheelset":
            continue
        k = model.topology.start[body.name]
        mean, moment = -0.5 * r[k + 2], -0.5 * r[k + 4] / body.contact_half_spacing
        loads += [mean - moment, mean + moment]
        if min(loads[-2:]) <= 0.0:
            raise ModelError(f"{body.name}: static wheel loads {loads[-2] / 1e3:.3g} kN left, {loads[-1] / 1e3:.3g} kN "
                             "right; both must be positive: check masses and the sides of its springs")
    return np.array(loads)


