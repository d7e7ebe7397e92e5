# SPDX-License-Identifier: BSD-3-Clause
"""``railsym bifurcation``: limit cycles against speed as a table, a picture, JSON."""

from __future__ import annotations

import sys

import numpy as np

from railsym.cli_output import check_plot_path, deliver, finite, table
from railsym.cli_values import CommandError, speed_range
from railsym.plots.style import KMH
from railsym.vehicle import load_vehicle


def run(options):
    """Compute and show what the options of ``railsym bifurcation`` ask for."""
    from railsym.nonlinear import bifurcation

    check_plot_path(options.plot)
    vehicle = load_vehicle(options.vehicle)
    if options.configuration:
        vehicle = vehicle.configured(options.configuration)
    forces = {"law": options.law} | ({} if options.friction is None else {"friction": options.friction})
    watched = sys.stderr.isatty()
    found = bifurcation(vehicle, contact=_contact(vehicle, options), speeds=speed_range(" ".join(options.speed_range)), dt=options.dt,
                        disturbance=options.disturbance, ramp_steps=options.ramp_steps, ramps=not options.no_ramps,
                        continuation=not options.no_continuation, points=options.points, progress=_progress if watched else None, **forces)
    if watched:
        print("\r\033[K", end="", file=sys.stderr)
    deliver(options, lambda: report(vehicle, found), lambda: as_data(found), found.plot)


def _progress(text):
    print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def _contact(vehicle, options):
    """The contact table of the options."""
    from railsym.contact_pair import ContactPair
    from railsym.contact_table import load_contact_table

    if options.contact_table:
        return load_contact_table(options.contact_table)
    radii = {body.wheel_radius for body in vehicle.bodies if body.kind == "wheelset"}
    if len(radii) != 1:
        raise CommandError(f"vehicle {vehicle.name!r} has wheels of {len(radii)} radii; one pair of profiles serves wheels of one radius")
    pair = ContactPair(options.wheel, options.rail, inclination=options.inclination, wheel_radius=radii.pop())
    return pair.table(deepest=DEEPEST)


DEEPEST = 5e-4   # m: flanges strike harder in a limit cycle than the table of a run needs


def report(vehicle, found):
    """The result as text."""
    lines = [f"{found.vehicle}: {vehicle.description}", f"straight track, {found.law}, {KMH * found.speeds[0]:.0f} to {KMH * found.speeds[1]:.0f} km/h", ""]
    lines += [_speed_line("linear critical speed", found.linear_critical_speed, "" if found.criticality == "unknown" else f"{found.criticality} Hopf bifurcation"),
              _speed_line("non-linear critical speed", found.nonlinear_critical_speed, "lowest speed of a lasting limit cycle")]
    rows = [[f"{KMH * o.speed:.1f}", f"{1e3 * o.amplitude.max():.2f}", f"{1.0 / o.period:.2f}", f"{abs(o.dominant):.3f}", "fold"]
            for branch in found.branches for o in branch.folds]
    rows += [[f"{KMH * h.speed:.1f}", "0", f"{h.frequency_hz:.2f}", "1", "Hopf, " + ("unstable" if h.rising else "stable") + " above"] for h in found.hopf]
    if rows:
        lines += ["", table(["km/h", "amplitude, mm", "Hz", "multiplier", "kind"], rows)]
    for name, one in (("descending ramp", found.descending), ("ascending ramp", found.ascending)):
        if one is not None:
            lines += ["", f"{name}: amplitude of the wheelset that moves most", _ramp_table(one)]
    for branch in found.branches:
        lines += ["", f"branch from {branch.origin}: {len(branch.orbits)} orbits, {int(branch.stable.sum())} of them stable; ended: {branch.ending}"]
    lines += [f"note: {note}" for note in found.notes]
    return "\n".join(lines)


def _speed_line(name, speed, what):
    value = "none in the range" if np.isnan(speed) else f"{KMH * speed:.1f} km/h"
    return f"{name:26s} {value}" + (f"  ({what})" if what and not np.isnan(speed) else "")


def _ramp_table(one):
    rows = [[f"{KMH * v:.1f}", f"{1e3 * a:.2f}", "-" if np.isnan(f) else f"{f:.2f}", "settled" if s else "changing" if k else "decaying"]
            for v, a, f, s, k in zip(one.speed, one.largest, one.frequency_hz, one.settled, one.lasting)]
    return table(["km/h", "mm", "Hz", "motion"], rows) + "".join(f"\n{KMH * v:.1f} km/h: {text}" for v, text in one.failures)


def as_data(found):
    """Everything as plain data for JSON, SI units."""
    branches = [{"origin": b.origin, "ending": b.ending, "speed": b.speed.tolist(), "amplitude": [o.amplitude.tolist() for o in b.orbits],
                 "frequency_hz": b.frequency_hz.tolist(), "multiplier": np.abs(b.dominant).tolist(), "stable": b.stable.tolist(),
                 "folds": [{"speed": o.speed, "amplitude": o.amplitude.tolist()} for o in b.folds]} for b in found.branches]
    ramps = [{"speed": r.speed.tolist(), "amplitude": r.amplitude.tolist(), "settled": r.settled.tolist(), "lasting": r.lasting.tolist(),
              "failures": [{"speed": v, "message": text} for v, text in r.failures]} for r in found.ramps]
    return finite({"vehicle": found.vehicle, "law": found.law, "units": {"speed": "m/s", "amplitude": "m", "frequency_hz": "Hz"},
                   "linear_critical_speed": _or_null(found.linear_critical_speed), "nonlinear_critical_speed": _or_null(found.nonlinear_critical_speed),
                   "criticality": found.criticality, "hopf": [{"speed": h.speed, "frequency_hz": h.frequency_hz, "rising": h.rising} for h in found.hopf],
                   "branches": branches, "ramps": ramps, "message": found.message})


def _or_null(value):
    return None if np.isnan(value) else value
