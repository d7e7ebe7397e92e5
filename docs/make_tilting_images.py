# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of docs/tilting.md: ``python docs/make_tilting_images.py`` with railsym installed (half a minute)."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np

import railsym as rs
from railsym.plots.tilt_animation import animate_tilt, tilt_channels
from railsym.studies import tilt_study

HERE = Path(__file__).resolve().parent / "images"


def main():
    """The study's six panels, and a picture of its animation."""
    vehicle = rs.load_vehicle("pendolino_tilting").configured("AS_K")
    study = tilt_study(vehicle, channels=tilt_channels(vehicle), compiled=True)
    figure = study.plot()[0, 0].figure
    figure.savefig(HERE / "tilting_study.png", dpi=90)
    animate_tilt(study, HERE / "tilting.gif", frames=40)
    from PIL import Image

    with Image.open(HERE / "tilting.gif") as moving:
        times = np.linspace(0.0, study["active"].run.time[-1], 40)
        moving.seek(int(np.argmin(np.abs(np.interp(times, study["active"].run.time, study["active"].run["s"]) - 300.0))))
        moving.convert("RGB").save(HERE / "tilting_animation.png", optimize=True)
    (HERE / "tilting.gif").unlink()
    for name in ("tilting_study.png", "tilting_animation.png"):
        print(f"docs/images/{name}: {(HERE / name).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
