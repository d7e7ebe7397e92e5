# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of nonlinear_stability.md: ``python docs/make_nonlinear_images.py [CSV]`` with railsym installed.

CSV is the contact table of the simulator that the Cooperrider vehicle comes from, as docs/contact_table.md says; without it that picture is left
out. Takes some minutes.
"""

import sys
from pathlib import Path

import matplotlib

import railsym as rs
from railsym.conical_contact import Cone, ConicalContact

HERE = Path(__file__).resolve().parent / "images"
LAW = "shen_hedrick_elkins"


def save(found, name):
    """Draw one diagram."""
    found.plot().figure.savefig(HERE / f"{name}.png", dpi=110)
    print(name, found.message)


def main():
    """All pictures."""
    matplotlib.use("Agg")
    wheelset = rs.load_vehicle("wheelset").replace({"guide.stiffness": [4e5, 2e5, 1e6]})
    save(rs.bifurcation(wheelset, contact=ConicalContact((Cone(0.2),)), speeds=(30.0, 37.0), law=LAW, ramp_steps=15, points=30), "limit_cycle_wheelset")
    table = rs.ContactPair("S1002", "UIC60", inclination=1 / 40).table(deepest=5e-4)
    pendolino = rs.load_vehicle("pendolino").configured("AS_K")
    save(rs.bifurcation(pendolino, contact=table, speeds=(80.0, 120.0), disturbance=2e-3, ramp_steps=17, longest=20.0, continuation=False),
         "limit_cycle_pendolino")
    save(rs.bifurcation(rs.load_vehicle("pendolino").configured("noAS_K"), contact=table, speeds=(61.0, 71.0), disturbance=2e-3, ramp_steps=11,
                        longest=20.0, points=40), "limit_cycle_pendolino_noAS")
    if len(sys.argv) > 1:
        save(rs.bifurcation(rs.load_vehicle("cooperrider"), contact=rs.load_contact_table(sys.argv[1]), speeds=(55.0, 150.0), law=LAW, disturbance=6e-3,
                            ramp_steps=20, points=110), "limit_cycle_cooperrider")


if __name__ == "__main__":
    main()
