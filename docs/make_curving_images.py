# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_curving_images.py``: the pictures of docs/curving.md."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import railsym as rs

IMAGES = Path(__file__).resolve().parent / "images"
RADII = [250, 275, 300, 350, 400, 500, 600, 800, 1000, 1250, 1500]


def main():
    """Pendolino with runs, and the coach of the Manchester benchmarks."""
    for name, dynamic in (("pendolino", True), ("manchester_vehicle1", False)):
        vehicle = rs.load_vehicle(name)
        pair = rs.ContactPair("S1002", "UIC60", inclination=1 / 40, gauge=1.435, wheel_radius=vehicle.body("wheelset1").wheel_radius)
        found = rs.curving(vehicle, radius=RADII, cant=0.15, cant_deficiency=[0.0, 0.1], contact=pair, dynamic=dynamic, progress=True)
        print(found)
        found.plot()[0, 0].figure.savefig(IMAGES / f"curving_{name}.png", dpi=85)


if __name__ == "__main__":
    main()
