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
from railsym.model import bushing_diagonals
from railsym.topology import ends

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
    rows = np.zeros((6 * len(model.bushings) + len(model.laws), model.size))
    stiffness = np.zeros(len(rows))
    for k, element in enumerate(model.bushings):
        here = slice(6 * k, 6 * k + 6)
        stiffness[here] = bushing_diagonals(element)[0]
        index, form, turn, _ = _relative_motion(model, element)
        _scatter(rows[here], index, np.vstack([element.axes.T @ form, element.axes.T @ turn]))
    for k, element in enumerate(model.laws, start=6 * len(model.bushings)):
        stiffness[k] = slope_at_rest(element)
        if stiffness[k]:
            index, form, _, apart = _relative_motion(model, element)
            along = apart / np.linalg.norm(apart) if element.axis is None else element.axes[:, element.axis]
            _scatter(rows[k:k + 1], index, (along @ form)[None])
    return rows, stiffness


def _relative_motion(model, element):
    """Rates of separation and relative rotation (3, 12) seen from the first body, and the separation."""
    index, place, marker = ends(model.topology, element)
    apart = place[1] + marker[1] - place[0] - marker[0]
    lever = marker[0] + apart
    form = np.hstack([-np.eye(3), _turning(lever) @ _AXES, np.eye(3), -_turning(marker[1]) @ _AXES])
    turn = np.hstack([np.zeros((3, 3)), -_AXES, np.zeros((3, 3)), _AXES])
    return index, form, turn, apart


_AXES = np.eye(3)[[2, 0, 1]].T  # yaw, roll, pitch rates as a vector


def _turning(arm):
    """Matrix of ``arm x``."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _scatter(rows, index, values):
    present = index >= 0
    np.add.at(rows, (slice(None), index[present]), values[:, present])


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


