# SPDX-License-Identifier: BSD-3-Clause
"""What a run can record: names, units, and how each channel follows from what C samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from railsym import _core
from railsym.errors import SimulationError
from railsym.results.channel import Channel, Channels, UnknownChannelError
from railsym.simulation.markers import accelerometer, frame_motion

DEFAULT = ("s", "V", "wheelset*.y", "wheelset*.yaw", "bogie*.y", "bogie*.yaw", "car*.y", "car*.roll", "car*.a[yz]", "*.above_*.ay",
           "*.sum_Y", "wheelset*.left.[YQ]", "wheelset*.right.[YQ]")
WHEEL = (("Y", "N", "lateral force of the wheel on the rail, positive outwards"), ("Q", "N", "vertical force of the wheel on the rail"),
         ("X", "N", "longitudinal force of the rail on the wheel, positive forward"),
         ("t_gamma", "N", "energy dissipated in the contact per metre"), ("patches", "-", "contact patches that carry load"))
PATCH = (("load", "N"), ("xi", "-"), ("eta", "-"), ("phi", "1/m"), ("Fx", "N"), ("Fy", "N"), ("Mz", "N m"), ("x", "m"), ("across", "m"),
         ("radius", "m"), ("angle", "rad"), ("a", "m"), ("b", "m"))
ZONES = 3
_PATCH_NUMBER = {name: number for number, (name, _) in enumerate(PATCH)}
_COMPONENTS = (("fx", "N"), ("fy", "N"), ("fz", "N"))
_AXES = ("ax", "ay", "az")


@dataclass(frozen=True, eq=False)
class Recipe:
    """How a channel is made: ``raw`` are samples of C as (kind, number, instance, row), ``make`` turns their columns into values."""

    channel: Channel
    raw: tuple
    make: object


def catalogue(run, markers):
    """All channels that an `Assembled` vehicle can record, name -> Recipe.

    Parameters
    ----------
    run : Assembled
    markers : dict of str to (str, array (3,))
        Points whose accelerations are wanted: body and position in vehicle coordinates (m).
    """
    recipes = [*_travel(run), *_coordinates(run), *_accelerations(run, markers), *_elements(run), *_wheels(run)]
    return {recipe.channel.name: recipe for recipe in recipes}


def chosen(recipes, patterns):
    """Recipes of the channels that fit the patterns, in the catalogue's order.

    Raises
    ------
    SimulationError
        A pattern that fits nothing, with near matches. Patterns of the default set may fit nothing.
    """
    known = Channels(recipe.channel for recipe in recipes.values())
    if patterns is None:
        return [recipes[name] for name in known.match(*DEFAULT)]
    patterns = (patterns,) if isinstance(patterns, str) else tuple(patterns)
    try:
        return [recipes[name] for name in known.require(*("*" if p == "all" else p for p in patterns))]
    except UnknownChannelError as error:
        raise SimulationError(f"channels: {error}".replace("list(run.channels)", "Simulation(...).available")) from None


class Recorder:
    """From the rows that C samples to the values of the chosen channels.

    Parameters
    ----------
    recipes : list of Recipe
    """

    def __init__(self, recipes):
        self.recipes = recipes
        wanted = {raw for recipe in recipes for raw in recipe.raw}
        order = {kind: k for k, kind in enumerate(("position", "rate", "acceleration", "element", "wheel", "patch", "law"))}
        self.raw = sorted(wanted, key=lambda raw: (order[raw[0]], *raw[1:]))
        self._column = {raw: k for k, raw in enumerate(self.raw)}

    @property
    def channels(self):
        """Channels in their order."""
        return [recipe.channel for recipe in self.recipes]

    def values(self, time, samples):
        """Values (n, channels) from times (n,) and samples (n, raw)."""
        out = np.empty((len(time), len(self.recipes)))
        for k, recipe in enumerate(self.recipes):
            columns = [samples[:, self._column[raw]] for raw in recipe.raw]
            out[:, k] = recipe.make(time, *columns)
        return out


def _same(time, column):
    return column


def _minus(time, column):
    return -column


def _travel(run):
    yield Recipe(Channel("s", "m", "arc length of the vehicle's centre along the track"), (), run.speed.place)
    yield Recipe(Channel("V", "m/s", "speed of travel"), (), run.speed.at)


def _coordinates(run):
    for k, name in enumerate(run.names):
        last = name.rsplit(".", 1)[1]
        unit = run.units[k] if last == "s" else "m" if last in ("x", "y", "z") else "rad"
        yield Recipe(Channel(name, unit, "from the design position, in the track frame"), (("position", k, 0, 0),), _same)
        yield Recipe(Channel(name + ".rate", unit + "/s", "rate of the coordinate"), (("rate", k, 0, 0),), _same)
        if k < run.second:
            yield Recipe(Channel(name + ".acc", unit + "/s^2", "second derivative of the coordinate"), (("acceleration", k, 0, 0),), _same)


def _accelerations(run, markers):
    points = {body.name: (body.name, body.position) for body in run.vehicle.bodies} | _frame_points(run.vehicle) | dict(markers)
    for name, (body_name, position) in points.items():
        body, position = run.vehicle.body(body_name), np.asarray(position, dtype=float)
        if position.shape != (3,) or not np.isfinite(position).all():
            raise SimulationError(f"marker {name!r}: its position must be three finite numbers (m), got {position}")
        reading, raw = _accelerometer(run, body, position - body.position)
        for axis, word in enumerate(_AXES):
            make = partial(_component, reading, axis)
            where = "[" + ", ".join(f"{x:.4g}" for x in position) + "] m"
            yield Recipe(Channel(f"{name}.{word}", "m/s^2", "as an accelerometer on the body reads, less its reading at rest", where), raw, make)


def _frame_points(vehicle):
    """Points of the bogie frames above the axleboxes, where the stability criteria look."""
    try:
        from railsym.criteria.markers import frame_markers
    except ImportError:
        return {}
    return frame_markers(vehicle) if any(body.kind == "wheelset" for body in vehicle.bodies) and len(vehicle.bodies) > 1 else {}


def _component(reading, axis, time, *columns):
    return reading(time, *columns)[:, axis]


def _accelerometer(run, body, arm):
    """Function (time, columns) -> (n, 3) of what a point's accelerometer reads, kept for the three axes, and its raw numbers."""
    first, turns = run.model.topology.start[body.name], body.kind == "rigid_body"
    numbers = [first + k for k in range(6 if turns else 5)]
    raw = tuple((kind, k, 0, 0) for kind in ("position", "rate", "acceleration") for k in numbers)
    ahead, offset = body.position[0], np.array([0.0, *body.position[1:]])
    last = [None, None]

    def reading(time, *columns):
        if last[0] is not time:
            states = np.zeros((3, 6, len(time)))
            states[:, :len(numbers)] = np.reshape(columns, (3, len(numbers), len(time)))
            frame = frame_motion(run.track, run.speed, time, ahead, run.vehicle.gravity)
            last[:] = time, accelerometer(*states, arm, offset, frame, run.vehicle.gravity)
        return last[1]

    return reading, raw


def _elements(run):
    """Forces of elements from the rows that they add to the equations of their first end."""
    kernels = _core.kernels()
    lines = sum(element.axis is None for element in run.model.laws)
    for k, element in enumerate(run.model.bushings):
        for row, (word, unit) in enumerate(_COMPONENTS):
            channel = Channel(f"{element.name}.{word}", unit, f"force on {element.first.body}, axes of its track frame")
            yield Recipe(channel, (("element", kernels["bushing"].number, k, row),), _minus)
    from railsym.model import law_directions

    directions = law_directions(run.model.laws, run.model.law_pairs.apart)
    for k, (element, direction) in enumerate(zip(run.model.laws, directions, strict=True)):
        kernel, instance = ("line", k) if k < lines else ("axis", k - lines)
        raw = tuple(("element", kernels[kernel].number, instance, row) for row in range(3))
        yield Recipe(Channel(f"{element.name}.force", "N", "positive pulls the ends together"), raw, _along(direction))
        if element.type == "actuator":
            yield from _actuator(element.name, kernels[kernel].number, instance)


def _actuator(name, kernel, instance):
    """How far an actuator is out, how fast it goes and what it gives."""
    length, rate, force = (("law", kernel, instance, _core.SEEN[key]) for key in ("length", "rate", "force"))
    yield Recipe(Channel(f"{name}.length", "m", "longer than at the design position"), (length,), _same)
    yield Recipe(Channel(f"{name}.rate", "m/s", "rate of its length"), (rate,), _same)
    yield Recipe(Channel(f"{name}.power", "W", "given to the vehicle"), (rate, force), _power)


def _power(time, rate, force):
    return -rate * force


def _along(direction):
    def make(time, *columns):
        force = -np.array(columns)
        return np.copysign(np.sqrt(np.sum(force ** 2, axis=0)), direction @ force)

    return make


def _wheels(run):
    if run.wheels is None:
        return
    for k, place in enumerate(run.wheels.wheelsets):
        for side, word in enumerate(("left", "right")):
            yield from _wheel(f"{place.name}.{word}", 2 * k + side)
        sides = tuple(("wheel", (2 * k + side) * len(WHEEL), 0, 0) for side in (0, 1))
        yield Recipe(Channel(f"{place.name}.sum_Y", "N", "lateral force of the wheelset on the track, positive to the right"), sides, _sum_y)
        body = next(b for b in run.vehicle.bodies if run.model.topology.start[b.name] == place.first)
        attack = partial(_angle_of_attack, run, body.position[0])
        yield Recipe(Channel(f"{place.name}.angle_of_attack", "rad", "yaw against the rails under the wheelset, positive nose to the right"),
                     (("position", place.first + 3, 0, 0),), attack)


def _wheel(name, wheel):
    """Channels of one wheel and of its contact patches."""
    def raw(zone, quantity):
        return ("patch", (wheel * ZONES + zone) * len(PATCH) + _PATCH_NUMBER[quantity], 0, 0)

    for number, (quantity, unit, text) in enumerate(WHEEL):
        yield Recipe(Channel(f"{name}.{quantity}", unit, text), (("wheel", wheel * len(WHEEL) + number, 0, 0),), _same)
    forces = tuple(("wheel", wheel * len(WHEEL) + number, 0, 0) for number in (0, 1))
    yield Recipe(Channel(f"{name}.YQ", "-", "Y/Q; not a number where the wheel carries nothing"), forces, _ratio)
    power = [tuple(raw(zone, quantity) for quantity in ("Fx", "xi", "Fy", "eta", "Mz", "phi")) for zone in range(ZONES)]
    yield Recipe(Channel(f"{name}.dissipation", "N", "energy per metre that the contact takes: -(Fx xi + Fy eta + Mz phi)"), sum(power, ()), _dissipation)
    for zone in range(ZONES):
        for quantity, unit in PATCH:
            yield Recipe(Channel(f"{name}.zone{zone}.{quantity}", unit, "of the contact patch"), (raw(zone, quantity),), _same)
        yield Recipe(Channel(f"{name}.zone{zone}.t_gamma", "N", "|Fx xi| + |Fy eta| of the contact patch"), power[zone][:4], _t_gamma)


def _sum_y(time, left, right):
    return right - left


def _ratio(time, Y, Q):
    return np.divide(Y, Q, out=np.full_like(Q, np.nan), where=Q > 0.0)


def _t_gamma(time, Fx, xi, Fy, eta):
    return np.abs(Fx * xi) + np.abs(Fy * eta)


def _dissipation(time, *columns):
    """Force times slip and moment times spin of all patches, over the speed."""
    pairs = zip(columns[0::2], columns[1::2], strict=True)
    return -sum(force * creepage for force, creepage in pairs)


def _angle_of_attack(run, ahead, time, yaw):
    if run.track is None or not (run.track.irregularities or run.track.switches):
        return yaw
    rails = run.track.rails(run.speed.place(time) + ahead)
    return yaw - np.arctan(0.5 * (rails.left_y_slope + rails.right_y_slope))
