# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of the README and of the documentation: ``python docs/make_images.py`` with railsym installed."""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import railsym as rs
from railsym import plots

HERE = Path(__file__).resolve().parent / "images"


def save(axes, name):
    """Save a drawing as a small PNG."""
    figure = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()[0].figure
    # no version and no date in the file: the same drawing gives the same bytes
    figure.savefig(HERE / name, dpi=96, metadata={"Software": None}, pil_kwargs={"optimize": True})
    print(f"docs/images/{name}: {(HERE / name).stat().st_size / 1000:.0f} kB")


def main():
    """All pictures, on the pendolino."""
    matplotlib.use("Agg")
    HERE.mkdir(exist_ok=True)
    vehicle = rs.load_vehicle("pendolino")
    found = rs.stability_map(vehicle)
    save(plots.plot_stability_map(found), "critical_speed.png")
    save(plots.plot_frequency(found), "frequency.png")
    save(plots.plot_change(found), "change.png")
    without = vehicle.configured("noAS_K")
    contact = rs.LinearContact(conicity=0.2)
    tracked = rs.track_modes(rs.linear_model(without, contact), np.linspace(20.0, 400.0, 58) / 3.6)
    save(plots.plot_root_locus(tracked), "root_locus.png")
    save(plots.plot_damping(tracked), "damping.png")
    speed = float(rs.critical_speed(without, 0.2).speed)
    modes = rs.linearise(without, speed, contact).modes()
    critical = min((m for m in modes if 0.1 < m.frequency_hz < 20.0), key=lambda mode: mode.damping_ratio)
    save(plots.plot_mode_shape(critical, without, speed=speed), "mode_shape.png")
    data = [name for name, value in without.parameters.components().items() if "position" not in name and value and np.isfinite(value)]
    save(plots.plot_sensitivities(rs.sensitivity(without, 0.2, parameters=["conicity", *data])), "sensitivity.png")
    pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40)
    amplitude, shift = np.linspace(1e-3, 7e-3, 121), np.arange(-140, 141) * 5e-5
    conicities = [pair.equivalent_conicity(amplitude, with_roll=roll) for roll in (False, True)]
    save(plots.plot_profile_pair(pair, pair.contact(shift), conicities, title="S1002 on UIC60, inclination 1:40, gauge 1435 mm"), "profile_pair.png")
    track = rs.Track.s_curve(500, 200, transition=60, cant=0.1, kind="bloss").with_irregularity("erri_b176_low", seed=1)
    save(track.plot(title="S-curve of radius 500 m, cant 100 mm, Bloss transitions; ERRI B176 low, seed 1")["plan"], "track.png")
    switch_images(without)
    run_images(vehicle, rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435).table())


def run_images(vehicle, table):
    """Runs: irregular straight track, and a curve beside its equilibria."""
    track = rs.Track.straight(1000.0).with_irregularity("erri_b176_low", seed=1)
    run = rs.simulate(vehicle, speed=60.0, duration=15.0, track=track, contact=table)
    axes = run.plot(["wheelset1.y", "bogie1.above_wheelset1_left.ay", "wheelset1.left.Q"])
    save(axes, "transient_irregular.png")
    curve = rs.Track.curve(600.0, 150.0, transition=60.0, cant=0.1)
    channels = ["s", "wheelset1.left.Y", "wheelset1.right.Y", "wheelset1.y", "wheelset2.y"]
    run = rs.simulate(vehicle, speed=25.0, duration=14.0, track=curve, contact=table, channels=channels)
    steady = rs.quasi_static(vehicle, speed=25.0, track=curve, places=np.arange(0.0, 340.0, 2.5), contact=table, channels=channels)
    _, axes = plt.subplots(2, 1, sharex=True, figsize=(7.5, 5.5), layout="constrained")
    for panel, names, scale, label in ((axes[0], channels[1:3], 1e-3, "Y of wheelset 1, kN"), (axes[1], channels[3:], 1e3, "lateral shift, mm")):
        for name, colour in zip(names, ("black", "tab:blue")):
            panel.plot(run["s"], scale * run[name], color=colour, label=name)
            panel.plot(steady["s"], scale * steady[name], "--", color=colour, label=f"{name}, equilibrium")
        panel.set_ylabel(label)
        panel.legend(fontsize="small")
        panel.grid(alpha=0.3)
    axes[1].set_xlabel("s of the vehicle's centre, m")
    axes[0].set_title("Pendolino at 25 m/s, curve of 600 m, cant 100 mm, S1002 on UIC60", fontsize="medium")
    save(axes, "transient_curve.png")


def switch_images(vehicle):
    """The switch study, amplitudes beside the quasi-linear theory, and a picture of an animation."""
    from railsym.studies import SWITCH, switch_track
    from railsym.studies.switch_run import CHANNELS, cross

    study = rs.switch_study(vehicle)
    save(study.plot(), "switch_study.png")
    wide = rs.switch_study(vehicle, ratios=(0.80, 0.85, 0.875, 0.90, 0.925, 0.95, 0.975, 1.0, 1.05), threshold=False)
    save(wide.plot_quasi_linear(), "switch_amplitude.png")
    from railsym.plots.animation import animate, animation_channels

    run = cross(vehicle, study.pair.table(deepest=6e-4), SWITCH, study.reference, reference=study.reference, after=3.4,
                channels=[*CHANNELS, *animation_channels(vehicle)]).run
    with TemporaryDirectory() as folder:
        found = animate(run, vehicle, Path(folder) / "switch.gif", track=switch_track(SWITCH, 400.0), start=0.2, end=2.2)
        print(found.message)
        with Image.open(found.path) as pictures:
            pictures.seek(13)
            pictures.convert("RGB").quantize(48).save(HERE / "animation.png", optimize=True)


if __name__ == "__main__":
    main()
