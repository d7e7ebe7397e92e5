# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of the README and of the documentation: ``python docs/make_images.py`` with railsym installed."""

from pathlib import Path

import matplotlib
import numpy as np

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


if __name__ == "__main__":
    main()
