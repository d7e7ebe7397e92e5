# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle on Cooperrider bogies against the open simulator that ships it: small motions on that simulator's own contact.

Numbers of the simulator (DYTSI, orthogonal model, straight track, contact table 1:40): its table at the centre, and eigenvalues of
its right-hand side by differences, wheelsets shifted by 50 um (closer, the table's noise moves frequencies by 0.5 %). A plain model
(tests/oracles/cooperrider_lateral.py) in its conventions gives its eigenvalues, and in railsym's conventions those of railsym.
"""

from dataclasses import fields
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

import railsym as rs
from railsym.contact_table_files import COLUMNS
from railsym.kalker import kalker_coefficients
from railsym.nonlinear.rolling import RollingSystem

from oracles.cooperrider_lateral import POISSON, Conventions, Tangent, state_matrix

CENTRE = {"normal_load_N": Tangent(66661.2, -5229.9), "contact_angle_rad": Tangent(0.0142232, 5.5277), "a_m": Tangent(5.95185e-3, -0.0167),
          "b_m": Tangent(6.65256e-3, -0.1923), "lateral_distance_m": Tangent(0.756301, -1.9364), "rolling_radius_m": Tangent(0.424883, 0.0297),
          "c11": Tangent(4.12457, 23.267), "c22": Tangent(3.5631, 31.124), "c23": Tangent(1.37032, 25.81), "penetration_m": Tangent(7.01077e-5, -1.138e-3)}
# speed (m/s): growth (1/s) and frequency (Hz) of the two least damped hunting motions
SIMULATOR = {40.0: ((-0.6946, 1.8006), (-1.0466, 1.8073)), 60.0: ((-1.0056, 2.6045), (-1.4658, 2.6628)), 80.0: ((-1.3597, 3.3863), (-1.6698, 3.5051)),
             100.0: ((-1.1482, 4.4427), (-1.7756, 4.5082)), 110.0: ((0.1389, 4.7360), (0.0413, 4.7126)), 120.0: ((0.8200, 4.9355), (0.7674, 4.9663))}
CRITICAL = 108.44                                        # m/s, the simulator's
SHEAR = (1.0 + POISSON) / (1.0 - POISSON)                # its shear modulus over that of its E and nu


def own_kalker():
    """The centre with Kalker's coefficients from the semi-axes, as railsym has them."""
    def at(shift):
        return np.array(kalker_coefficients(CENTRE["a_m"](shift) / CENTRE["b_m"](shift), POISSON))

    step = 1e-5
    slope = (at(step) - at(-step)) / (2.0 * step)
    return CENTRE | {name: Tangent(*pair) for name, pair in zip(("c11", "c22", "c23", "c33"), zip(at(0.0), slope))}


def hunting(matrix, count=2):
    """The least damped oscillations above 1.2 Hz: (count, 2) growth (1/s) and frequency (Hz)."""
    values = np.linalg.eigvals(matrix)
    values = values[(values.imag > 7.5) & (values.imag < 60.0)]
    values = values[np.argsort(-values.real)][:count]
    return np.column_stack([values.real, values.imag / (2.0 * np.pi)])


def critical(matrix_at, low=95.0, high=145.0):
    return brentq(lambda speed: hunting(matrix_at(speed), 1)[0, 0], low, high, xtol=1e-4)


@cache
def table(folder):
    shift = np.linspace(-8e-3, 8e-3, 1601)
    rows = np.column_stack([shift, *(CENTRE[name](shift) for name in COLUMNS[1:])])
    np.savetxt(folder / "centre.csv", rows, delimiter=",", fmt="%.14g")
    return rs.load_contact_table(folder / "centre.csv")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("cooperrider")


def rolling(folder, weight):
    vehicle = rs.load_vehicle("cooperrider").replace({"contact.kalker_weight": weight})
    system, guess = RollingSystem(vehicle, table(folder), law="shen_hedrick_elkins"), None
    lateral = [k for k, name in enumerate(system.names) if name.split(".")[1] in ("y", "roll", "yaw")]

    def matrix_at(speed):
        nonlocal guess
        guess = system.equilibrium(speed, guess)
        return system.state_matrix(guess)[np.ix_(lateral, lateral)]
    return matrix_at


@pytest.mark.parametrize("speed", SIMULATOR)
def test_the_simulators_conventions_give_its_eigenvalues(speed):
    # tangents have five digits
    found = hunting(state_matrix(CENTRE | {"c33": Tangent(0.0, 0.0)}, Conventions.of_simulator(), speed))
    assert found[:, 0] == pytest.approx([growth for growth, _ in SIMULATOR[speed]], abs=5e-3)
    assert found[:, 1] == pytest.approx([hertz for _, hertz in SIMULATOR[speed]], rel=2e-4)


@pytest.mark.parametrize(("weight", "shear"), [(1.0, False), (SHEAR, True)])
def test_railsyms_conventions_give_railsyms_eigenvalues(folder, weight, shear):
    # what is left is the spline of the table over the shift: second derivatives of load and angle within 50 um of the centre
    matrix_at, columns = rolling(folder, weight), own_kalker()
    for speed in (40.0, 80.0, 110.0):
        ours, plain = hunting(matrix_at(speed)), hunting(state_matrix(columns, Conventions(shear=shear), speed))
        assert ours[:, 0] == pytest.approx(plain[:, 0], abs=5e-3)
        assert ours[:, 1] == pytest.approx(plain[:, 1], rel=5e-4)


def test_the_shear_modulus_makes_the_difference(folder):
    # with the simulator's shear modulus as a Kalker weight: hunting within 1 %, critical speed within 2 %; without, 6 and 22 %
    imitated, own = rolling(folder, SHEAR), rolling(folder, 1.0)
    for speed in (40.0, 60.0, 80.0):
        assert hunting(imitated(speed))[0, 1] == pytest.approx(SIMULATOR[speed][0][1], rel=1e-2)
        assert hunting(own(speed))[0, 1] < 0.95 * SIMULATOR[speed][0][1]
    assert critical(imitated) == pytest.approx(CRITICAL, rel=0.02)
    assert critical(own) == pytest.approx(132.2, abs=0.1)


def test_what_each_convention_does_to_the_critical_speed():
    # printed in docs/nonlinear_stability.md; from railsym's conventions, one at a time
    columns = own_kalker() | {name: CENTRE[name] for name in ("c11", "c22", "c23")}
    found = {field.name: critical(lambda v, own=Conventions(**{field.name: True}): state_matrix(columns, own, v)) for field in fields(Conventions)}
    assert critical(lambda v: state_matrix(columns, Conventions(), v)) == pytest.approx(131.23, abs=0.02)
    assert found == pytest.approx({"shear": 110.05, "gyroscope": 120.76, "arm": 131.25, "roll_free": 129.58, "level_springs": 133.53,
                                   "no_spin_moment": 130.33}, abs=0.02)
    assert critical(lambda v: state_matrix(columns, Conventions.of_simulator(), v)) == pytest.approx(CRITICAL, abs=0.05)
