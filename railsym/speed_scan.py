# SPDX-License-Identifier: BSD-3-Clause
"""Where modes cross a damping ratio as the speed rises.

The eigenvalues of a reduced model are computed with left and right vectors at a few speeds. Modes of neighbouring speeds are
matched by biorthogonality; each path is interpolated by the cubic through both eigenvalues and their derivatives; the interval
is halved where a path is not smooth or comes near a criterion without clearly crossing. `SpeedScan.polish` then solves a
crossing on the full matrices, so a reported speed owes nothing to the reduction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from railsym.constant_speed import chain_length, deflate
from railsym.errors import ConvergenceError
from railsym.linear_model import LinearModel
from railsym.polish import EigenPoint, polish_crossing, polish_eigenvalue
from railsym.reduction import Reduction, real_times, reduce_model

FIRST_STEP = 1.0           # in log(speed): four intervals from 5 to 250 m/s
_SHORT_STEP = 0.2          # in log(speed): a step towards a crossing that is expected ahead is not shorter than this
_BEYOND = 0.08             # in log(speed): how far beyond an expected crossing such a step goes, besides a tenth of its length
_ENRICHED = 1              # times that a scan begins anew with a better basis
_SMALLEST_STEP = 2e-3      # in log(speed): paths that are not resolved at 0.2 % of the speed are reported
_SIMILAR = 0.5             # product of two biorthogonalities: 1 for one and the same mode
_WATCH = 0.12              # modes within this of the highest damping ratio asked for are followed closely
_SMOOTH = 0.05             # kink of a path, relative to the eigenvalue, that similar vectors make credible
_CLEAR = 0.005             # kink so small that the vectors need not be alike: nearly equal modes mix freely
_PLACED = 0.1              # of the interval, that a kink may shift a crossing of a path that runs nearly along the criterion
_ATTEMPTS = 3              # modes of like eigenvalue that are tried when Newton's method goes astray
_SAME = 1e-8               # relative distance of polished crossings that are one: a hundred times what Newton leaves
_NEUTRAL = 1e-9            # |Re lambda| / |lambda| of a mode without damping, after rounding
# The basis is enriched where dropped modes move a watched eigenvalue by more than this share of itself and by more than half its
# distance from the nearest criterion: less cannot hide a crossing.
_REDUCTION_ERROR = 5e-3
_REDUCTION_MARGIN = 0.5
_GRID = np.linspace(0.0, 1.0, 17)


@dataclass(frozen=True, eq=False)
class ScanNode:
    """Oscillatory modes (Im > 0) of the reduced model at one speed; vectors in columns."""

    speed: float
    eigenvalue: np.ndarray
    slope: np.ndarray                 # d(eigenvalue)/d(log V)
    state_right: np.ndarray
    state_left: np.ndarray            # scaled to state_left^H state_right = 1
    divergent: np.ndarray             # real positive eigenvalues
    reduced: LinearModel

    @cached_property
    def position(self) -> float:
        return float(np.log(self.speed))

    def right(self, modes):
        """T x = 0 in the reduced model, columns for some modes, or one vector."""
        return self.reduced.shape_vector(self.state_right[:, modes], self.eigenvalue[modes])

    def left(self, modes):
        """y^H T = 0 in the reduced model, with y^H (dT/dlambda) x = 1; as `right`."""
        return self.reduced.left_vector(self.state_left[:, modes])


@dataclass(frozen=True, eq=False)
class Crossing:
    """A path of the reduced model crosses a damping ratio; `direction` +1 where damping is lost as the speed rises."""

    damping_ratio: float
    direction: int
    position: float                   # log(V), V in m/s
    eigenvalue: complex
    path: int
    ends: tuple                       # ((node, mode), (node, mode)) of the interval

    @property
    def nearest(self):
        """Node and mode of the end that lies nearer."""
        middle = 0.5 * (self.ends[0][0].position + self.ends[1][0].position)
        return self.ends[0] if self.position < middle else self.ends[1]


@dataclass(eq=False)
class SpeedScan:
    """What a scan found.

    Attributes
    ----------
    model : LinearModel
        The full model.
    reduction : Reduction
        The reduced one.
    damping_ratios : tuple of float
        The criteria.
    crossings : list of Crossing
        As the reduced model has them, in the order of speed.
    nodes : list of ScanNode
        Speeds at which the reduced eigenproblem was solved, ascending; path i starts as mode i of the first.
    warnings : list of str
        Intervals in which a path could not be resolved.
    """

    model: LinearModel
    reduction: Reduction
    damping_ratios: tuple
    known: int
    crossings: list = field(default_factory=list)
    nodes: list = field(default_factory=list)
    warnings: list = field(default_factory=list)

    def walk(self, speed_range, enough, first_step) -> None:
        """Follow all paths from the lowest speed up, to the highest one or until there is enough."""
        low, high = np.log(speed_range)
        widest = (high - low) / max(1, int(np.ceil((high - low) / first_step)))
        node = self.node(speed_range[0])
        self.nodes.append(node)
        paths = np.arange(len(node.eigenvalue))
        while node.position < high - 1e-9:
            step = widest if enough is None else _step_ahead(node, self.damping_ratios[-1], widest)
            ahead = self.node(np.exp(min(node.position + step, high)))
            paths = self.follow(node, ahead, paths)
            node = ahead
            if enough is not None and enough(self):
                break

    def polish(self, crossing: Crossing, taken=()) -> EigenPoint | None:
        """The crossing on the full matrices.

        Parameters
        ----------
        crossing : Crossing
        taken : sequence of EigenPoint
            Crossings of other modes. Modes of like frequency share their shapes, so that Newton's method may go to the other one.

        Returns
        -------
        EigenPoint or None
            None, with a warning, when there is no crossing within reach.
        """
        point = self._polish_from(crossing, *crossing.nearest, crossing.position, crossing.eigenvalue, taken)
        if point is not None:
            return point
        node = self.node(np.exp(crossing.position))
        for mode in np.argsort(np.abs(node.eigenvalue - crossing.eigenvalue))[:_ATTEMPTS]:
            step = _step_to(node, mode, crossing.damping_ratio)
            point = self._polish_from(crossing, node, mode, node.position + step, node.eigenvalue[mode] + step * node.slope[mode], taken)
            if point is not None:
                return point
        self.warnings.append(f"a crossing expected near {np.exp(crossing.position):.4g} m/s, {abs(crossing.eigenvalue) / (2 * np.pi):.3g} "
                             "Hz was not found on the full model; ask for verify=True")
        return None

    def _polish_from(self, crossing, node, mode, position, eigenvalue, taken):
        """Newton's method from the vectors of a mode; None where it strays or meets a crossing that is taken."""
        (first, _), (second, _) = crossing.ends
        margin = 0.2 * (second.position - first.position) + 0.01
        vectors = self.reduction.expand(node.right(mode)), self.reduction.expand(node.left(mode))
        try:
            point = polish_crossing(self.model, np.exp(position), eigenvalue, *vectors, crossing.damping_ratio)
        except ConvergenceError:
            return None
        near = abs(np.log(point.speed) - crossing.position) < margin and abs(point.eigenvalue / crossing.eigenvalue - 1) < 0.1
        return point if near and not any(is_same(point, other) for other in taken) else None

    def polish_start(self, path: int) -> EigenPoint:
        """A mode of the lowest speed on the full matrices."""
        node = self.nodes[0]
        return polish_eigenvalue(self.model, node.speed, node.eigenvalue[path], self.reduction.expand(node.right(path)),
                                 self.reduction.expand(node.left(path)))

    def node(self, speed) -> ScanNode:
        """Solve the reduced eigenproblem at a speed in m/s."""
        reduced = self.reduction.model
        deflated = deflate(reduced, speed, self.known)
        value, right, left, divergent = _oscillations(deflated.matrix)
        if self.known:
            right, left = deflated.restore(value, right, left)
        left = left / (left.conj() * right).sum(axis=0).conj()
        slope = (real_times(reduced.state_matrix_slope(speed), right) * left.conj()).sum(axis=0) * speed
        return ScanNode(float(speed), value, slope, right, left, divergent, reduced)

    def follow(self, first, second, paths):
        """Resolve one interval, recursively; returns the path number of each mode of the second node."""
        pairs = match(first, second)
        resolved, crossings = examine(first, second, pairs, self.damping_ratios, paths)
        if not resolved and second.position - first.position > 2 * _SMALLEST_STEP:
            middle = self.node(np.exp(0.5 * (first.position + second.position)))
            return self.follow(middle, second, self.follow(first, middle, paths))
        if not resolved:
            self.warnings.append(f"a mode could not be followed between {first.speed:.4g} and {second.speed:.4g} m/s")
        self.crossings += crossings
        self.nodes.append(second)
        following = np.full(len(second.eigenvalue), -1)
        following[pairs[1]] = paths[pairs[0]]
        return following


def _oscillations(matrix):
    """Eigenvalues with positive imaginary part and their right and left vectors; and the real positive eigenvalues."""
    from scipy.linalg.lapack import dgeev

    real, imaginary, left, right, status = dgeev(matrix)
    if status:
        raise ConvergenceError(f"eigenvalues of a reduced model of {len(matrix)} states did not converge; check the vehicle's data")
    divergent = real[(imaginary == 0) & (real > _NEUTRAL * np.abs(real).max())]
    above = np.flatnonzero(imaginary > 0)
    # LAPACK puts the real and the imaginary part of a pair's vector in neighbouring columns, which lie in one piece
    return real[above] + 1j * imaginary[above], *((v.T[above] + 1j * v.T[above + 1]).T for v in (right, left)), divergent


def is_same(a: EigenPoint, b: EigenPoint) -> bool:
    """Are two polished crossings one?"""
    return abs(a.speed / b.speed - 1) < _SAME and abs(a.eigenvalue / b.eigenvalue - 1) < _SAME


def excess(eigenvalue, damping_ratio):
    """Re(lambda) + zeta |lambda|, 1/s: positive where the damping ratio is below zeta."""
    return np.real(eigenvalue) + damping_ratio * np.abs(eigenvalue)


def _step_to(node, mode, damping_ratio):
    """Step in log(speed) to a criterion along the tangent of a mode, at most a tenth."""
    value, slope = node.eigenvalue[mode], node.slope[mode]
    rate = _rate(value, slope, damping_ratio)
    return float(np.clip(-excess(value, damping_ratio) / rate, -0.1, 0.1)) if rate else 0.0


def _rate(value, slope, damping_ratio):
    """d(excess)/d(log V)."""
    return slope.real + damping_ratio * (value.conj() * slope).real / np.abs(value)


def _step_ahead(node, damping_ratio, widest):
    """Step in log(speed) to just beyond the crossing that comes first along the tangents, or the widest one."""
    g, rate = excess(node.eigenvalue, damping_ratio), _rate(node.eigenvalue, node.slope, damping_ratio)
    coming = (g < 0) & (rate > 0)
    first = (-g[coming] / rate[coming]).min(initial=np.inf)
    return min(widest, max(_SHORT_STEP, 1.1 * first + _BEYOND))


def is_below(eigenvalue, damping_ratio):
    """Is the damping ratio below zeta by more than rounding?"""
    return excess(eigenvalue, damping_ratio) > _NEUTRAL * np.abs(eigenvalue)


def scan_speeds(model: LinearModel, damping_ratios, speed_range, frequency_limit, enough=None, first_step=FIRST_STEP) -> SpeedScan:
    """Follow the oscillatory modes of a model over speed and find where they cross damping ratios.

    Parameters
    ----------
    model : LinearModel
        A whole model or one half of a symmetric one.
    damping_ratios : sequence of float
        Criteria; 0 is real part = 0.
    speed_range : (float, float)
        m/s.
    frequency_limit : float
        Hz, up to which elastic modes enter the reduced model.
    enough : callable, optional
        Asked with the scan after every interval whether it may end there; steps then go to the crossings of the largest ratio.
    first_step : float
        Of log(speed): intervals are not wider.

    Returns
    -------
    SpeedScan
        Its basis is enriched, and the scan begun anew, where the dropped modes matter.
    """
    reduction, missing = reduce_model(model, frequency_limit), []
    known = chain_length(model, speed_range[0])
    for attempt in range(_ENRICHED + 1):
        scan = SpeedScan(model, reduction, tuple(damping_ratios), known)
        scan.walk(speed_range, enough, first_step)
        lacking = _missing(scan, speed_range) if attempt < _ENRICHED else []
        if not lacking:
            break
        missing += lacking
        shapes = np.column_stack([part for shape in missing for part in (shape.real, shape.imag)])
        reduction = reduce_model(model, reduction.next_frequency, _main_directions(shapes, model.mass))
    scan.crossings.sort(key=lambda crossing: crossing.position)
    return scan


def _missing(scan: SpeedScan, speed_range) -> list:
    """What the dropped modes add to shapes of watched modes that they move too much.

    At a middle speed and at the last one; where that is the end of the range, and not just behind a crossing, also at the first.
    """
    nodes = scan.nodes if scan.reduction.dropped.shape[1] else []
    places = (0, len(nodes) // 2, -1) if scan.nodes[-1].speed > 0.999 * speed_range[1] else (len(nodes) // 2, -1)
    return [shape for node in dict.fromkeys(nodes[k] for k in places if nodes) for shape in _missing_at(scan, node)]


def _missing_at(scan: SpeedScan, node):
    """What the dropped modes add to the shapes of watched modes at one speed, where they move the eigenvalue too much."""
    watched = np.flatnonzero(excess(node.eigenvalue, max(scan.damping_ratios) + _WATCH) > 0)
    value = node.eigenvalue[watched]
    change, missing = scan.reduction.correction(value, node.speed, node.right(watched), node.left(watched))
    distance = np.min([np.abs(excess(value + change, z)) for z in scan.damping_ratios], axis=0)
    poor = (np.abs(change) > _REDUCTION_ERROR * np.abs(value)) & (np.abs(change) > _REDUCTION_MARGIN * distance)
    return [missing[:, i] for i in np.flatnonzero(poor)]


def _main_directions(shapes, mass):
    """Directions that hold the shapes to 1 %, in the mass metric."""
    shapes = shapes / np.sqrt((shapes * (mass @ shapes)).sum(axis=0))
    square, directions = np.linalg.eigh(shapes.T @ mass @ shapes)
    return shapes @ directions[:, square > 1e-4 * square[-1]]


def match(first: ScanNode, second: ScanNode):
    """Pair the modes of two nodes: an assignment on |y1^H x2| |y2^H x1|, which is 1 for one and the same mode.

    Returns
    -------
    i, j : ndarray of int
        Paired modes of the first and the second node.
    similarity : ndarray
        Their measure.
    """
    from scipy.optimize import linear_sum_assignment

    similarity = np.abs(first.state_left.conj().T @ second.state_right) * np.abs(second.state_left.conj().T @ first.state_right).T
    step = second.position - first.position
    ahead = first.eigenvalue + 0.5 * step * first.slope
    back = second.eigenvalue - 0.5 * step * second.slope
    distance = np.abs(ahead[:, None] - back) / (np.abs(first.eigenvalue)[:, None] + np.abs(second.eigenvalue))
    i, j = linear_sum_assignment(np.minimum(distance, 1.0) - np.minimum(similarity, 1.0))
    return i, j, similarity[i, j]


def examine(first: ScanNode, second: ScanNode, pairs, damping_ratios, paths):
    """Interpolate the watched paths of an interval.

    Returns
    -------
    resolved : bool
        Every watched path is smooth and, but for the crossings, clear of the criteria.
    crossings : list of Crossing
    """
    i, j, similarity = pairs
    limit = max(damping_ratios) + _WATCH
    watched, also = excess(first.eigenvalue, limit) > 0, excess(second.eigenvalue, limit) > 0
    keep = watched[i] | also[j]
    unpaired = np.count_nonzero(watched) > np.count_nonzero(watched[i]) or np.count_nonzero(also) > np.count_nonzero(also[j])
    i, j = i[keep], j[keep]
    coefficients, kink = _cubics(first, second, i, j)
    size = np.minimum(np.abs(first.eigenvalue[i]), np.abs(second.eigenvalue[j]))
    credible = ((kink < _SMOOTH * size) & (similarity[keep] > _SIMILAR)) | (kink < _CLEAR * size)
    resolved, crossings = not unpaired and bool(credible.all()), []
    g = _excesses(_at(coefficients, _GRID[:, None]), damping_ratios)
    far = np.abs(g)
    changes = g[:, 1:] * g[:, :-1] < 0
    count, nearest = changes.sum(axis=1), far.min(axis=1)
    grazing = (count == 0) & (nearest < np.minimum(far[:, 0], far[:, -1])) & (nearest < 0.25 * kink)
    resolved = resolved and not (grazing | (count > 1)).any()
    for c, k, path in zip(*np.nonzero(changes)):
        before, after = g[c, k, path], g[c, k + 1, path]
        resolved = resolved and 0.25 * kink[path] < _PLACED * abs(after - before) / (_GRID[k + 1] - _GRID[k])
        t = _GRID[k] + (_GRID[k + 1] - _GRID[k]) * before / (before - after)
        crossings.append(Crossing(damping_ratios[c], int(np.sign(after)), first.position + t * (second.position - first.position),
                                  complex(_at(coefficients[:, path], t)), int(paths[i[path]]), ((first, i[path]), (second, j[path]))))
    return resolved, crossings


def _excesses(values, damping_ratios):
    """Excess of paths (points, paths) over each damping ratio, (ratios, points, paths); what is rounding is zero."""
    size = np.abs(values)
    g = values.real + np.array(damping_ratios)[:, None, None] * size
    g[np.abs(g) <= _NEUTRAL * size] = 0.0
    return g


def _cubics(first, second, i, j):
    """Coefficients in t = 0..1 of the cubics through eigenvalues and slopes, and their kinks."""
    step = second.position - first.position
    a, b, da, db = first.eigenvalue[i], second.eigenvalue[j], step * first.slope[i], step * second.slope[j]
    # the kink is how far the end is from where the mean of both slopes points: of the order of the cubic term
    return np.array([a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db]), np.abs(b - a - 0.5 * (da + db))


def _at(c, t):
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))
