# SPDX-License-Identifier: BSD-3-Clause
"""``railsym.curving``: a vehicle in curves, quasi-static or with irregularities. docs/curving.md says what is computed and how far to trust it."""

from __future__ import annotations

import numpy as np

from railsym.curving.cases import cases
from railsym.curving.quantities import KINDS, all_channels, collected, shape_of
from railsym.curving.result import Curving, Failure
from railsym.errors import SimulationError

IRREGULARITY = "erri_b176_low"


def curving(vehicle, *, radius, cant=0.0, speed=None, cant_deficiency=None, contact, direction="right", dynamic=False, irregularity=None, seed=None,
            length=250.0, dt=1e-3, progress=False, name=None, **forces):
    """Wheel-rail forces, angle of attack and wear number in curves, against radius and speed or cant deficiency.

        found = rs.curving(vehicle, radius=np.linspace(250, 1500, 10), cant=0.15, cant_deficiency=[0.1], contact=pair)
        found.Y[0, :, 0]               # N, of the first wheel over the radii
        print(found.table()); found.plot(path="curving.png")

    Parameters
    ----------
    vehicle : Vehicle
    radius : float or array_like (n,)
        m
    cant : float or array_like (n,)
        m, of the outer rail: one for all curves, or one a radius.
    speed, cant_deficiency : float or array_like (m,)
        m/s or m: one of the two. The cant deficiency is 1.5 m a_nc/g with a_nc in the track plane; negative is an excess.
    contact : ContactPair, contact table, ConicalContact or WheelRail
        The linear contact has no wheel-rail forces.
    direction : {"right", "left"}
    dynamic : bool
        Run through each curve, with irregularities, beside the equilibrium: gives `Curving.largest`.
    irregularity : str, path, RandomIrregularity or MeasuredIrregularity, optional
        Of dynamic runs, as for `Track.with_irregularity`; ``"erri_b176_low"`` without it.
    seed : int, optional
        Of a random one; 1 without it.
    length : float
        m of full curve that a dynamic run is judged on.
    dt : float
        s, of dynamic runs.
    progress : bool
        A bar on the error stream.
    name : str, optional
        Of the contact, for headings.
    forces
        Arguments of `WheelRail`: law, grid, friction ...

    Returns
    -------
    Curving
        Curves where no equilibrium was found, or whose run derailed, are in `Curving.failures`; their numbers are NaN.

    Raises
    ------
    SimulationError
        What cannot be started as asked.
    """
    wheels = _wheel_rail(vehicle, contact, forces)
    if direction not in ("right", "left"):
        raise SimulationError(f'direction {direction!r}: "right" or "left"')
    if not dynamic and (irregularity is not None or seed is not None):
        raise SimulationError("irregularity and seed belong to dynamic=True: an equilibrium has none")
    asked = cases(radius, cant, speed, cant_deficiency, vehicle.gravity)
    wheelsets, loads = _from_the_front(vehicle, wheels)
    values = {name: np.full((*asked.speed.shape, *shape_of(kind, wheelsets)), np.nan) for name, kind in KINDS.items()}
    failures, largest, passage = [], None, None
    if dynamic:
        from railsym.curving.dynamic import Passage, run_through

        passage = Passage(irregularity or IRREGULARITY, seed, length, dt, direction)
        passage.check(vehicle, asked)
    with _bar(asked.speed.size * (2 if dynamic else 1), progress) as bar:
        for row in range(len(asked.speed)):
            failures += _steady_row(vehicle, wheels, asked, row, direction, wheelsets, values, bar.update)
        if passage is not None:
            largest, more = run_through(vehicle, wheels, asked, passage, wheelsets, bar.update)
            failures += more
    return Curving(vehicle=vehicle.name, configuration=vehicle.configuration or "", direction=direction, cases=asked, wheelsets=wheelsets,
                   values=values, largest=largest, failures=tuple(failures), static_load=loads, law=wheels._law, contact=name or _name(contact))


def _steady_row(vehicle, wheels, asked, row, direction, wheelsets, values, told):
    from railsym.curving.steady import equilibria

    failures = []
    for k, found in equilibria(vehicle, asked.radius, asked.cant, asked.speed[row], direction, wheels, all_channels(wheelsets), {}, told):
        if isinstance(found, str):
            failures.append(Failure(row, k, float(asked.radius[k]), float(asked.speed[row, k]), "quasi-static", found))
            continue
        for name, kind in KINDS.items():
            values[name][row, k] = collected(kind, wheelsets, found.__getitem__)
    return failures


def _wheel_rail(vehicle, contact, forces):
    """WheelRail of the contact."""
    from railsym.contact import LinearContact
    from railsym.contact_pair import DEEPEST_IN_MOTION, ContactPair
    from railsym.wheel_rail import WheelRail

    if contact is None or isinstance(contact, (LinearContact, str)):
        raise SimulationError("curving needs wheel-rail forces: give a ContactPair, a contact table or ConicalContact as contact")
    if isinstance(contact, WheelRail):
        if forces:
            raise SimulationError(f"{', '.join(forces)}: this WheelRail has its own")
        return contact
    if isinstance(contact, ContactPair):
        contact = contact.table(deepest=DEEPEST_IN_MOTION)
    return WheelRail(vehicle, contact, **forces)


def _from_the_front(vehicle, wheels):
    """Names of the wheelsets from the leading one on, and the static loads of their wheels (N), left before right."""
    from railsym.linear import rolling_vehicle

    names = [place.name for place in wheels.wheelsets]
    order = sorted(range(len(names)), key=lambda k: -vehicle.body(names[k]).position[0])
    loads = np.asarray(rolling_vehicle(vehicle).preload.wheel_loads).reshape(-1, 2)
    return tuple(names[k] for k in order), loads[order].ravel()


def _name(contact):
    wheel, rail = (getattr(getattr(contact, part, None), "name", None) for part in ("wheel", "rail"))
    return f"{wheel} on {rail}" if wheel and rail else type(contact).__name__


def _bar(count, show):
    if not show:
        return _NoBar()
    from tqdm import tqdm

    return tqdm(total=count, desc="curves", bar_format="{desc}: {n_fmt} of {total_fmt} |{bar}| [{elapsed}<{remaining}]")


class _NoBar:
    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False

    def update(self):
        """Nothing is shown."""
