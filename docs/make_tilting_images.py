# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of pendolino_tilting.md, and print its tables: ``python docs/make_tilting_images.py`` with railsym installed."""

from pathlib import Path

import matplotlib
import numpy as np

import railsym as rs
from railsym import plots
from railsym.plots import style
from railsym.track import Curve, Straight, Track, Transition

HERE = Path(__file__).resolve().parent / "images"
RADIUS, CANT, SPEED, TILT = 500.0, 0.12, 105.0 / 3.6, np.radians(7.5)
KINDS = {"stuck": ("hold their length", style.BLACK, "-"), "damped": ("lose pressure, bypass damping", style.BLUE, (0, (6, 2))),
         "free": ("give no force at all", style.VERMILION, (0, (1.5, 1.5)))}


def commands(vehicle, angle):
    """Lengths of all jacks at a tilt angle (rad)."""
    linkages = [rs.TiltLinkage(vehicle, name) for name in ("bolster1", "bolster2")]
    return {jack: float(linkage.jack_length(jack, angle)) for linkage in linkages for jack in linkage.jacks}


def failures(vehicle):
    """Runs in the curve whose four jacks fail at 1 s."""
    track = Track([Straight(60.0), Transition(100.0), Curve(RADIUS, 900.0, CANT)])
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435)
    told = commands(vehicle, TILT)
    start = rs.steady_state(vehicle, speed=SPEED, track=track, place=200.0, contact=pair, commands=told)
    return {kind: rs.simulate(vehicle, speed=SPEED, track=track, start=200.0, contact=pair, initial=start, commands=told, duration=8.0,
                              faults=[(1.0, jack, kind) for jack in told], channels=["*.roll", "car.ay", "*.Y", "*.Q"]) for kind in KINDS}


def tilt(run):
    """Angle of the body against the bolsters, degrees."""
    return np.degrees(run["car.roll"] - 0.5 * (run["bolster1.roll"] + run["bolster2.roll"]))


def ratio(run):
    """Largest Y/Q of all wheels at each time."""
    return np.max([np.abs(run[name] / run[name[:-1] + "Q"]) for name in run.channels.match("wheelset*.Y")], axis=0)


def draw_failures(runs):
    """Tilt, acceleration and Y/Q against time."""
    axes = style.new_axes(None, 3, 1, size=(6.4, 5.6), sharex=True)[:, 0]
    for kind, run in runs.items():
        words, colour, dashes = KINDS[kind]
        for ax, values in zip(axes, (tilt(run), run["car.ay"], ratio(run)), strict=True):
            ax.plot(run.time, values, color=colour, linestyle=dashes, linewidth=1.5, label=words)
    for ax, words in zip(axes, ("tilt, degrees", "lateral acceleration\nfelt, m/s$^2$", "largest Y/Q"), strict=True):
        style.tidy(ax, ylabel=words)
        ax.axvline(1.0, color=style.PALE, linewidth=1.0)
    axes[2].set_xlabel("time, s")
    axes[0].set_title("All jacks fail at 1 s: radius 500 m, cant 120 mm, 105 km/h, tilted by 7.5 degrees", loc="left", fontsize=10)
    axes[2].legend(loc="upper right", fontsize=8.5, frameon=False)
    return axes


def main():
    """Both pictures and both tables."""
    matplotlib.use("Agg")
    vehicle = rs.load_vehicle("pendolino_tilting")
    runs = failures(vehicle)
    for axes, name in ((plots.plot_tilt_linkage(vehicle), "tilt_linkage.png"), (draw_failures(runs), "tilt_failures.png")):
        axes[0].figure.savefig(HERE / name, dpi=96, metadata={"Software": None}, pil_kwargs={"optimize": True})
    for kind, run in runs.items():
        loads = np.array([run[name] for name in run.channels.match("*.Q")])
        print(f"{kind:8} tilt {tilt(run)[-1]:5.2f} at the end, {tilt(run).min():5.2f} least; felt {np.abs(run['car.ay']).max():.2f} at most; Y/Q {ratio(run).max():.2f}; "
              f"Q {loads.min() / 1e3:.1f} to {loads.max() / 1e3:.1f} kN")
    plain = rs.load_vehicle("pendolino")
    for name in plain.configurations:
        speeds = [3.6 * rs.critical_speed(one.configured(name), conicity=[0.1, 0.2, 0.3]).speed for one in (plain, vehicle)]
        print(f"{name:12}", *(f"{b:.0f} ({100.0 * (b / a - 1.0):+.1f} %)" for a, b in zip(*speeds, strict=True)))


if __name__ == "__main__":
    main()
