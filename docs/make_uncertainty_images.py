# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of uncertainty_and_optimisation.md: ``python docs/make_uncertainty_images.py [FOLDER]`` with railsym and a browser installed.

Runs the demonstration study (minutes); its stores go to FOLDER, and what is there is not computed again. The picture of the report needs chromium.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib
import numpy as np

from railsym import plots
from railsym.campaign import load
from railsym.campaign.campaign_file import EXAMPLE
from railsym.sweep import CriticalSpeed, FullGrid, Grid, Study

HERE = Path(__file__).resolve().parent / "images"
WANTED = {"histogram": "study_histogram", "tornado": "study_tornado", "sobol": "study_sobol", "damper_map": "study_damper_map",
          "damper_recheck": "study_recheck", "trade_front": "study_pareto"}


def save(axes, name):
    """Save a drawing as a small PNG."""
    figure = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()[0].figure
    figure.savefig(HERE / f"{name}.png", dpi=96, metadata={"Software": None}, pil_kwargs={"optimize": True})
    print(f"docs/images/{name}.png: {(HERE / name).with_suffix('.png').stat().st_size / 1000:.0f} kB")


def main(folder):
    """All pictures."""
    matplotlib.use("Agg")
    found = load(EXAMPLE).run(folder / "damper.nc", workers=os.cpu_count(), resume=True, progress=True)
    print(found)
    for figure in found.figures():
        if figure.name in WANTED:
            save(figure.draw(), WANTED[figure.name])
    found.report(folder / "damper.html")
    picture_of(folder / "damper.html", HERE / "study_report.png")
    factors = {"anti_yaw_damper.damping": Grid(50e3, 1600e3, 12, spacing="log"), "anti_yaw_damper.series_stiffness": Grid(2e6, 12e6, 10)}
    study = Study("pendolino", CriticalSpeed(conicity=0.2, criterion="damping_ratio"), factors, FullGrid(), configuration="AS_K")
    results = study.run(folder / "map.nc", workers=os.cpu_count())
    axes = plots.plot_study_map(results.factors, results.names, results["speed"], units=study.units, output="critical speed", unit="m/s")
    axes.set_xscale("log")
    save(axes, "study_map")


def picture_of(page, path):
    """The head of the report as a reader sees it."""
    from PIL import Image

    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        print("no browser: the picture of the report is left out")
        return
    with TemporaryDirectory() as profile:
        subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-background-networking", "--disable-sync",
                        "--force-device-scale-factor=1", f"--user-data-dir={profile}", "--window-size=1100,1500", f"--screenshot={path}", page.resolve().as_uri()],
                       check=True, capture_output=True, timeout=120)
    with Image.open(path) as image:
        image.convert("RGB").quantize(64).save(path, optimize=True)
    print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
