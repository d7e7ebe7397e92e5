# SPDX-License-Identifier: BSD-3-Clause
"""A peer written by hand for one purpose: classical Runge-Kutta in Numba of a vehicle whose suspension is linear.

What a good engineer writes when speed is all: mass, damping and stiffness of the vehicle as one sparse matrix over its states, taken
from our own model at rest, so that both integrate the same vehicle; small angles; one patch a wheel with radius, angle, stiffness and
semi-axes over the lateral shift from our table of S1002 on UIC60 (evenly spaced, read linearly), load by the power 3/2, Polach's law.
Rails are computed before the clock starts, unlike in our steps. `condensed` takes the trusses as links without mass, which leaves a
coach of car, bogies and wheelsets with axleboxes.

Not in it, and in ours: large rotations, flange contact, curves, damper curves and stops, forces of elements as channels, any check.
"""

from dataclasses import dataclass
from math import atan, pi, sqrt

import numba
import numpy as np
from scipy.sparse import csr_matrix

from railsym.kalker import kalker_coefficients
from railsym.linear import RollingVehicle

FIELDS = ("closure", "stiffness", "radius", "angle", "a", "b", "c11", "c22", "c23", "ks")


@dataclass
class Peer:
    """Arrays of the peer, what `integrate` takes."""

    matrix: csr_matrix          # d(s, u)/dt over (q, s, u)
    constant: np.ndarray
    coordinates: int            # of q, and of u
    first: np.ndarray           # wheelsets
    mass: np.ndarray            # wheelsets x 8 x 6: accelerations by forces on x y z yaw roll spin
    table: np.ndarray           # nodes x FIELDS
    start: float                # m, first node
    step: float
    numbers: np.ndarray         # V, r0, half spacing, friction, G
    offsets: np.ndarray         # m, of wheelsets along the track


def contact_columns(table, load, nodes=241, reach=6e-3):
    """Fields of a wheel's main patch over its lateral shift, at the static load."""
    y = np.linspace(-reach, reach, nodes)
    drop, found = table.right.under_load(y, load)
    main = found.load.argmax(axis=1)
    at = lambda values: values[np.arange(nodes), main]  # noqa: E731
    depth = 1.5 * at(found.load) / at(found.slopes["load"][..., 2])
    a, b = at(found.a), at(found.b)
    root = np.sqrt(depth)
    kalker = [kalker_coefficients(ratio, 0.28) for ratio in a / b]
    columns = [drop - depth, at(found.load) / depth**1.5, at(found.radius), at(found.angle), a / root, b / root,
               *(np.array([getattr(c, name) for c in kalker], dtype=float) for name in ("c11", "c22", "c23")), 1.0 + 6.3 * (1.0 - np.exp(-a / b))]
    return np.column_stack(columns), y[0], y[1] - y[0]


def reduction(model, condensed):
    """Matrix that gives all second-order coordinates from those kept, these, and those dropped."""
    topology, second = model.topology, np.flatnonzero(~model.topology.first_order)
    K = model.pencil((1.0, 0.0, 0.0))[np.ix_(second, second)]
    starts = [(topology.start[b.name], b) for b in model.vehicle.bodies]
    dropped = np.zeros(len(second), dtype=bool)
    for start, body in starts:
        dropped[start : start + 6] |= condensed and "truss" in body.name
    T = np.zeros((len(second), (~dropped).sum()))
    T[~dropped] = np.eye((~dropped).sum())
    if condensed:
        T[dropped] = -np.linalg.solve(K[np.ix_(dropped, dropped)], K[np.ix_(dropped, ~dropped)])
    return T, np.flatnonzero(~dropped), dropped


def peer(vehicle, table, speed, condensed=False):
    """The peer of a vehicle."""
    rolling = RollingVehicle(vehicle)
    model = rolling.model
    model.set_speed(speed)
    first = model.topology.first_order
    second, internal, u0 = np.flatnonzero(~first), np.flatnonzero(first), model.rolling(speed)
    T, kept, dropped = reduction(model, condensed)
    K, C, M = (model.pencil(tuple(seed), u=u0) for seed in np.eye(3))
    r0 = model.residual(u=u0)
    M = M[np.ix_(second, second)]
    M[dropped], M[:, dropped] = 0.0, 0.0
    inverse = np.linalg.inv(T.T @ M @ T)
    n, m = T.shape[1], len(internal)
    A, constant = np.zeros((m + n, 2 * n + m)), np.zeros(m + n)
    damping = np.diag(C)[internal][:, None]
    A[:m, :n], A[:m, n : n + m], A[:m, n + m :] = K[np.ix_(internal, second)] @ T, K[np.ix_(internal, internal)], C[np.ix_(internal, second)] @ T
    A[:m] /= -damping
    rows = T.T @ np.hstack([K[np.ix_(second, second)] @ T, K[np.ix_(second, internal)], C[np.ix_(second, second)] @ T])
    A[m:] = -inverse @ rows
    constant[m:] = -inverse @ T.T @ (r0[second] - C[np.ix_(second, second)] @ u0[second])
    A[np.abs(A) < 1e-12 * np.abs(A).max(axis=1, keepdims=True)] = 0.0
    sets = [b for b in vehicle.bodies if b.kind == "wheelset"]
    place = np.array([np.searchsorted(kept, model.topology.start[b.name]) for b in sets])
    mass = np.array([inverse[p : p + 8, p : p + 6] for p in place])
    columns, start, step = contact_columns(table, float(np.mean(rolling.preload.wheel_loads)))
    numbers = np.array([speed, sets[0].wheel_radius, 0.75, 0.3, 8.2e10])
    offsets = np.array([b.position[0] for b in sets])
    return Peer(csr_matrix(A), constant, n, place, mass, columns, start, step, numbers, offsets), u0[kept]


@numba.njit(fastmath=True, error_model="numpy")
def wheel(q, u, p, side, rail_y, rail_z, table, start, step, numbers, force):
    """Adds the forces of one wheel to its wheelset's x y z yaw roll spin."""
    V, r0, half, friction, G = numbers
    yaw, roll = q[p + 3], q[p + 4]
    shift = side * (q[p + 1] - rail_y - r0 * roll)
    place = (shift - start) / step
    node = min(max(int(place), 0), table.shape[0] - 2)
    t = place - node
    low, high = table[node], table[node + 1]
    depth = q[p + 2] - rail_z + side * half * roll - (low[0] + t * (high[0] - low[0]))
    if depth <= 0.0:
        return
    stiffness, radius = low[1] + t * (high[1] - low[1]), low[2] + t * (high[2] - low[2])
    angle = low[3] + t * (high[3] - low[3]) - side * roll
    root = sqrt(depth)
    a, b = root * (low[4] + t * (high[4] - low[4])), root * (low[5] + t * (high[5] - low[5]))
    c11, c22 = low[6] + t * (high[6] - low[6]), low[7] + t * (high[7] - low[7])
    c23, ks = low[8] + t * (high[8] - low[8]), low[9] + t * (high[9] - low[9])
    cosine, sine = 1.0 - 0.5 * angle * angle, angle * (1.0 - angle * angle / 6.0)
    load, spin = stiffness * depth * root, u[p + 5]
    scale = G * a * b / (friction * load * V)
    e1 = scale * (V + u[p] - side * half * u[p + 3] + spin * radius)
    e2 = scale * (u[p + 1] - V * yaw - radius * u[p + 4]) / cosine
    e3 = scale * a * (side * sine * spin + cosine * u[p + 3])
    y = e2 + e3 if abs(e2 + e3) > abs(e2) else e2
    total, plain = sqrt(e1 * e1 + y * y) + 1e-30, e1 * e1 + e2 * e2 + 1e-60
    eps = 0.25 * pi * sqrt((c11 * c11 * e1 * e1 + c22 * c22 * e2 * e2) / plain) * total
    F = 2.0 / pi * (eps / (1.0 + eps * eps) + atan(eps)) / total
    eps = 8.0 / 3.0 * sqrt(b / a) * c23 * abs(y) / ks
    FS = 0.375 * ks * eps / ((1.0 + eps * eps) * (1.0 + eps * eps)) / total
    Fx, Fy = -friction * load * F * e1, -friction * load * (F * e2 + FS * e3)
    X, Y, Z = Fx - Fy * cosine * yaw, Fx * yaw + Fy * cosine - load * side * sine, -Fy * side * sine - load * cosine
    force[0] += X
    force[1] += Y
    force[2] += Z
    force[3] -= side * half * X
    force[4] += side * half * Z - radius * Y
    force[5] += radius * X


@numba.njit(fastmath=True, error_model="numpy")
def rates(x, rail, data, indices, pointer, constant, n, first, mass, table, start, step, numbers, force, out):
    """dx/dt of x = (q, s, u); rail: wheelsets x (left y, left z, right y, right z)."""
    behind = x.shape[0] - n
    for k in range(n):
        out[k] = x[behind + k]
    for k in range(constant.shape[0]):
        total = constant[k]
        for j in range(pointer[k], pointer[k + 1]):
            total += data[j] * x[indices[j]]
        out[n + k] = total
    for w in range(first.shape[0]):
        p = first[w]
        force[:] = 0.0
        wheel(x[:n], x[behind:], p, -1.0, rail[w, 0], rail[w, 1], table, start, step, numbers, force)
        wheel(x[:n], x[behind:], p, 1.0, rail[w, 2], rail[w, 3], table, start, step, numbers, force)
        for i in range(8):
            total = 0.0
            for j in range(6):
                total += mass[w, i, j] * force[j]
            out[behind + p + i] += total


@numba.njit(fastmath=True, error_model="numpy")
def integrate(x, h, steps, rail, data, indices, pointer, constant, n, first, mass, table, start, step, numbers, watched, record):
    """Classical Runge-Kutta; rail at every half step; x at the end, and coordinate `watched` after each step in record."""
    size = x.shape[0]
    k1, k2, k3, k4, y, force = np.empty(size), np.empty(size), np.empty(size), np.empty(size), np.empty(size), np.empty(6)
    for k in range(steps):
        rates(x, rail[2 * k], data, indices, pointer, constant, n, first, mass, table, start, step, numbers, force, k1)
        for i in range(size):
            y[i] = x[i] + 0.5 * h * k1[i]
        rates(y, rail[2 * k + 1], data, indices, pointer, constant, n, first, mass, table, start, step, numbers, force, k2)
        for i in range(size):
            y[i] = x[i] + 0.5 * h * k2[i]
        rates(y, rail[2 * k + 1], data, indices, pointer, constant, n, first, mass, table, start, step, numbers, force, k3)
        for i in range(size):
            y[i] = x[i] + h * k3[i]
        rates(y, rail[2 * k + 2], data, indices, pointer, constant, n, first, mass, table, start, step, numbers, force, k4)
        for i in range(size):
            x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
        record[k] = x[watched]


def run(own, rolling, track, place, duration, h):
    """A function that integrates anew from rest, and the record of the first wheelset's lateral shift that it fills."""
    steps = round(duration / h)
    s = place + own.numbers[0] * 0.5 * h * np.arange(2 * steps + 1)[:, None] + own.offsets
    rails = track.rails(s)
    rail = np.ascontiguousarray(np.stack([rails.left_y, rails.left_z, rails.right_y, rails.right_z], axis=-1))
    start, record, A = np.concatenate([np.zeros(own.matrix.shape[1] - own.coordinates), rolling]), np.empty(steps), own.matrix

    def go():
        x = start.copy()
        integrate(x, h, steps, rail, A.data, A.indices, A.indptr, own.constant, own.coordinates, own.first, own.mass, own.table, own.start,
                  own.step, own.numbers, own.first[0] + 1, record)
        return x

    return go, record
