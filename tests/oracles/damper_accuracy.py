# SPDX-License-Identifier: BSD-3-Clause
"""Accuracy of the identification over random campaigns: the table of docs/dampers.md.

    python -m tests.oracles.damper_accuracy --kinds curve nonlinear --noise 0 0.02 --seeds 0:40

Errors of the constants, or of the force curve over the speeds that occurred, of its peak; of k over the whole speed range; of the lag.
"""

from __future__ import annotations

import argparse
import pickle
import warnings
from pathlib import Path

import numpy as np

from railsym.dampers import clean_all, identify, read_records
from railsym.dampers.models import curve_value
from tests.oracles.bench_campaign import random_campaign

KINDS = ("linear", "viscous curve", "curve", "nonlinear", "asymmetric")
MODEL = {"viscous": "viscous", "viscous curve": "viscous", "linear": "maxwell", "curve": "maxwell"}


def cleaned(made):
    """Cleaned tests of a campaign, without their warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return clean_all(read_records(made.records, units=made.units))


def force_error(fit, made):
    """Largest error of the damper's curve over the speeds that it had, of its peak."""
    record, speed = fit.model.force_law_record(), np.linspace(*made.fastest, 401)
    curve = record.get("damping_curve")
    force = record["damping"] * speed + (0.0 if curve is None else curve_value(curve, speed))
    wanted = made.damper.force(speed)
    return float(np.abs(force - wanted).max() / np.abs(wanted).max())


def stiffness_error(fit, made):
    """Largest relative error of k from rest to the highest speed of the ends."""
    record, speed = fit.model.force_law_record(), np.linspace(0.0, made.ends, 101)
    curve = record.get("stiffness_curve")
    found = record["stiffness"] + (0.0 if curve is None else curve_value(curve, speed))
    return float(np.abs(found / made.damper.stiffness(speed) - 1.0).max())


def errors(fit, made):
    """Errors of force (or c) and of k (nan without), relative; of the lag, s."""
    force = abs(fit.damping / made.damper.c - 1.0) if made.damper.shape == "linear" and made.damper.dry == 0.0 else force_error(fit, made)
    return force, np.nan if made.damper.k is None else stiffness_error(fit, made), fit.lag - made.bench.lag


def drawn(seed, kind, noise, cache=None):
    """The random campaign, kept in the folder ``cache`` if there is one (its solution takes longer than the fit)."""
    path = cache and Path(cache) / f"{kind}-{noise}-{seed}.pickle"
    if path and path.exists():
        return pickle.loads(path.read_bytes())
    made = random_campaign(seed, kind, noise)
    if path:
        path.write_bytes(pickle.dumps(made))
    return made


def measured(kind, noise, method, seeds, cache=None):
    """Rows (errors, fit, campaign, seed) of one kind of damper."""
    rows = []
    for seed in seeds:
        made = drawn(seed, kind, noise, cache)
        fit = identify(cleaned(made), MODEL.get(kind, "maxwell_nonlinear"), method)
        rows.append((errors(fit, made), fit, made, seed))
    return rows


def _three(values):
    values = 100 * np.abs(np.asarray(values, dtype=float))
    return "" if np.isnan(values).all() else " / ".join(f"{v:.2g}" for v in (np.median(values), np.quantile(values, 0.95), values.max()))


def main(argv=None):
    """Print the table: median / 95 % / worst, %."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", default=KINDS)
    parser.add_argument("--noise", nargs="+", type=float, default=[0.0, 0.02])
    parser.add_argument("--methods", nargs="+", default=["energy", "least_squares"])
    parser.add_argument("--seeds", default="0:40", help="first:end")
    parser.add_argument("--cache", help="folder that keeps the campaigns")
    parser.add_argument("--cases", action="store_true", help="a line for each campaign")
    given = parser.parse_args(argv)
    seeds = range(*map(int, given.seeds.split(":")))
    for kind in given.kinds:
        for noise in given.noise:
            for method in given.methods:
                rows = measured(kind, noise, method, seeds, given.cache)
                force, stiffness, lag = np.array([row[0] for row in rows]).T
                said = sum("wrong model" in fit.message for _, fit, _, _ in rows)
                print(f"{kind} | {100 * noise:g} % | {method} | {_three(force)} | {_three(stiffness)} | lag {_three(10 * lag)} ms | wrong model {said}", flush=True)
                for (f, k, tau), fit, made, seed in rows if given.cases else ():
                    print(f"   {seed:3d} force {100 * f:6.2f} k {100 * k:6.2f} lag {1e3 * tau:+.3f} ms  {made.damper.shape}, colour {made.bench.colour}, "
                          f"{made.bench.rate:.0f} Hz, {made.bench.cycles} cycles: {fit.message}", flush=True)


if __name__ == "__main__":
    main()
