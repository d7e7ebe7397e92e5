# SPDX-License-Identifier: BSD-3-Clause
"""Linear models and their modes: state matrix, vectors, constant-speed motions, symmetry, labels."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.synthetic_models import Train, Wheelset, coasting, dense_eigenvalues, model_of

from railsym.constant_speed import deflate
from railsym.errors import ModelError
from railsym.linear_model import Linearisation, LinearModel
from railsym.mode_labels import MotionLabels
from railsym.modes import modes
from railsym.symmetry import find_mirror, split

SPEED = 60.0


@pytest.fixture(scope="module")
def train():
    return Train().model()


@pytest.fixture(scope="module")
def train_modes(train):
    return modes(train, SPEED)


def blocks(seed=0):
    """A random model with blocks in M, a cyclic coordinate and coupled Maxwell coordinates in the middle of the list."""
    rng = np.random.default_rng(seed)
    n = 9
    first, cyclic = np.zeros(n, bool), np.zeros(n, bool)
    first[[3, 7]], cyclic[5] = True, True
    mass = np.zeros((n, n))
    for rows in ([0, 1, 2], [4, 5], [6, 8]):
        part = rng.normal(size=(len(rows), len(rows)))
        mass[np.ix_(rows, rows)] = part @ part.T + np.eye(len(rows))
    stiffness, constant = rng.normal(size=(2, n, n))
    stiffness[:, cyclic] = 0.0
    constant[np.ix_(first, first)] = [[3.0, 0.4], [-0.2, 2.0]]
    changing = rng.normal(size=(2, n, n)) * ~first * ~first[:, None]
    return LinearModel(tuple(f"b{i}.y" for i in range(n)), mass, stiffness, constant, *changing, first, cyclic)


# --- matrices ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("model", [blocks(), Wheelset().model()], ids=["blocks", "wheelset"])
@pytest.mark.parametrize("speed", [7.0, 50.0])
def test_state_matrix_has_the_eigenvalues_of_the_generalised_form(model, speed):
    model.state_matrix(20.0)         # the second call takes the stored parts
    found, expected = np.linalg.eigvals(model.state_matrix(speed)), dense_eigenvalues(model, speed)
    assert len(found) == len(expected) == len(model.states)
    # QZ on entries from 1 to 1e7 leaves eight digits of eigenvalues near 10 1/s
    assert max(np.abs(expected - value).min() / abs(value) for value in found) < 1e-7


def test_the_first_state_matrix_equals_the_next(train):
    fresh = replace(train)
    first = fresh.state_matrix(SPEED)
    assert np.array_equal(first, fresh.state_matrix(SPEED))
    first[:] = np.nan
    assert np.isfinite(fresh.state_matrix(SPEED)).all(), "the caller's array is the model's"


def test_states_name_the_rows(train):
    assert len(train.states) == len(set(train.states)) == len(train.state_matrix(SPEED))
    assert "wheelset1.spin" not in train.states and "wheelset1.spin.rate" in train.states
    row = train.state_matrix(SPEED)[train.states.index("car.y")]
    assert np.flatnonzero(row).tolist() == [train.states.index("car.y.rate")]


def test_slope_of_the_state_matrix(train):
    step = 1e-3
    difference = (train.state_matrix(SPEED + step) - train.state_matrix(SPEED - step)) / (2 * step)
    # V is linear and 1/V has a third derivative of 6/V^4: the truncation is step^2/V^2 of the slope
    assert np.allclose(train.state_matrix_slope(SPEED), difference, rtol=1e-6, atol=1e-6 * np.abs(difference).max())


def test_vectors_pass_between_state_and_coordinates():
    model = blocks()
    matrix = model.state_matrix(SPEED)
    value, right = np.linalg.eig(matrix)
    shapes = model.shape_vector(right, value)
    left = model.left_vector(np.linalg.inv(right).conj().T)
    for k, eigenvalue in enumerate(value):
        dynamic = model.dynamic_stiffness(eigenvalue, SPEED)
        assert np.abs(dynamic @ shapes[:, k]).max() < 1e-9 * (np.abs(dynamic) @ np.abs(shapes[:, k])).max()
        assert np.abs(left[:, k].conj() @ dynamic).max() < 1e-9 * (np.abs(left[:, k]) @ np.abs(dynamic)).max()
        assert np.allclose(model.state_vector(shapes[:, k], eigenvalue), right[:, k], atol=1e-12)


@pytest.mark.parametrize(("change", "says"), [
    (lambda m: replace(m, mass=m.mass[:1]), "mass has shape"),
    (lambda m: replace(m, stiffness=m.stiffness * np.nan), "wheelset1.y"),
    (lambda m: replace(m, cyclic=np.array([True, False])), "cyclic"),
    (lambda m: replace(m, first_order=np.array([True, False])), "no inertia"),
    (lambda m: m.state_matrix(0.0), "above 0"),
    (lambda m: m.damping(np.inf), "finite"),
    (lambda m: replace(m, mass=np.diag([1500.0, 0.0])).state_matrix(5.0), "singular"),
])
def test_errors_say_what_is_wrong(change, says):
    with pytest.raises(ModelError, match=says):
        change(Wheelset().model())


def test_maxwell_coordinate_without_damping_is_refused(train):
    index = train.coordinates.index("yaw_damper.front_left.s")
    damping = train.damping_constant.copy()
    damping[index, index] = 0.0
    with pytest.raises(ModelError, match=r"yaw_damper\.front_left\.s"):
        replace(train, damping_constant=damping).state_matrix(SPEED)


# --- modes ------------------------------------------------------------------------------------------------------

def test_modes_are_the_dense_eigenvalues(train, train_modes):
    dense = dense_eigenvalues(train, SPEED)
    dense = dense[np.abs(dense) > 1e-3]          # two zeros of uniform translation and speed, as +-sqrt(rounding)
    count = sum(2 if mode.eigenvalue.imag > 0 else 1 for mode in train_modes)
    assert count == len(dense)
    error = [np.abs(dense - mode.eigenvalue).min() / abs(mode.eigenvalue) for mode in train_modes]
    # pairs of nearly equal bogie modes are split by 1e-3 of themselves and lose digits accordingly
    assert max(error) < 1e-6 and np.median(error) < 1e-10


def test_vectors_of_modes(train, train_modes):
    for mode in train_modes:
        dynamic = train.dynamic_stiffness(mode.eigenvalue, SPEED)
        assert np.abs(dynamic @ mode.right).max() < 1e-8 * (np.abs(dynamic) @ np.abs(mode.right)).max()
        assert np.abs(mode.left.conj() @ dynamic).max() < 1e-8 * (np.abs(mode.left) @ np.abs(dynamic)).max()
        norm = mode.left.conj() @ train.dynamic_stiffness_slope(mode.eigenvalue, SPEED) @ mode.right
        assert norm == pytest.approx(1.0, abs=1e-9)


def test_modes_of_a_linearisation(train, train_modes):
    lin = Linearisation.of(train, SPEED)
    assert np.array_equal(lin.A, train.state_matrix(SPEED)) and lin.states == train.states
    assert np.allclose(lin.modes().eigenvalue, train_modes.eigenvalue)
    mode = lin.modes()[3]
    assert mode.damping_ratio == pytest.approx(-mode.eigenvalue.real / abs(mode.eigenvalue))
    assert set(mode.shape) == set(train.coordinates)
    assert max(abs(mode.shape[name]) for name in mode.shape if name.endswith((".x", ".y", ".z"))) == pytest.approx(1.0)


# --- constant-speed motions -------------------------------------------------------------------------------------

def test_uniform_translation_and_speed_are_kept_apart():
    model = coasting()
    result = modes(model, 30.0)
    place, speed = result.constant_speed
    assert [place.label, speed.label] == ["uniform translation", "uniform speed"]
    assert place.eigenvalue == speed.eigenvalue == 0.0
    assert place.shape["car.x"] == place.shape["wheelset2.x"] and place.shape["wheelset1.spin"] == 0
    assert speed.shape["wheelset1.spin"] / speed.shape["car.x"] == pytest.approx(-1 / 0.46, rel=1e-12)
    assert not result.unstable and len(dense_eigenvalues(model, 30.0)) == 2 + 2 * len(result) - sum(
        mode.eigenvalue.imag == 0 for mode in result)


def test_the_chain_is_a_jordan_chain(train):
    matrix, chain = train.state_matrix(SPEED), deflate(train, SPEED).chain
    rounding = 1e-12 * np.abs(matrix).max()
    assert np.abs(matrix @ chain[:, 0]).max() < rounding
    assert np.abs(matrix @ chain[:, 1] - chain[:, 0]).max() < rounding


def test_a_spring_to_the_track_leaves_no_constant_speed_motion():
    model = coasting()
    held = model.stiffness.copy()
    held[0, 0] += 1.0            # 1 N/m on 42 t: 0.0008 Hz, below any threshold on |lambda|
    result = modes(replace(model, stiffness=held), 30.0)
    assert result.constant_speed == ()
    assert result[0].frequency_hz == pytest.approx(np.sqrt(1.0 / 42428.0) / (2 * np.pi), rel=0.05)


def test_drag_of_the_wheels_slows_the_uniform_speed():
    model = coasting()
    drag = model.damping_inverse_speed.copy()
    for spin in (2, 4):
        drag[spin, spin] += 500.0
    result = modes(replace(model, damping_inverse_speed=drag), 30.0)
    assert [mode.label for mode in result.constant_speed] == ["uniform translation", "uniform speed"]
    # power 2 * 500/30 spin^2 = -mu times the kinetic energy 2T = (42000 + 180 / r^2) v^2; the drag makes the wheels creep by
    # 500 spin / 1.6e7 r, 1.5e-4 of the speed
    spin = 1 / 0.46
    assert result.constant_speed[1].eigenvalue == pytest.approx(-2 * 500 / 30 * spin**2 / (42000 + 180 * spin**2), rel=3e-4)


def test_static_instability_is_not_taken_for_a_constant_speed():
    model = coasting()
    result = modes(replace(model, stiffness=-model.stiffness, damping_constant=0 * model.stiffness), 30.0)
    assert len(result.unstable) > 0


# --- symmetry ---------------------------------------------------------------------------------------------------

def test_a_symmetric_train_splits_in_two(train):
    parts = split(train)
    assert [part.parity for part in parts] == [-1, 1]
    assert sum(part.model.size for part in parts) == train.size
    whole = dense_eigenvalues(train, SPEED)
    for part in parts:
        found = np.linalg.eigvals(deflate(part.model, SPEED).matrix)
        assert max(np.abs(whole - value).min() / abs(value) for value in found) < 1e-6


def test_parts_expand_to_motions_of_the_right_parity(train):
    permutation, sign = find_mirror(train)
    for part in split(train):
        shape = part.expand(np.random.default_rng(0).normal(size=part.model.size))
        assert np.allclose(sign * shape[permutation], part.parity * shape)


@pytest.mark.parametrize("dampers", [(True, True, True, False), (False, True, True, True)])
def test_a_missing_damper_breaks_the_symmetry(dampers):
    assert [part.parity for part in split(Train(yaw_dampers=dampers).model())] == [0]


def test_unequal_stiffness_left_and_right_breaks_the_symmetry(train):
    stiffness = train.stiffness.copy()
    i, j = train.coordinates.index("superior_truss_1_left.y"), train.coordinates.index("superior_truss_1_left.z")
    stiffness[i, j] += 1.0
    stiffness[j, i] += 1.0
    assert find_mirror(replace(train, stiffness=stiffness)) is None


# --- labels -----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize(("low", "high", "label"), [
    (0.4, 0.8, "car-body lower sway"), (0.9, 0.98, "car-body bounce"), (1.0, 1.05, "car-body yaw"),
    (1.05, 1.2, "car-body upper sway"), (1.2, 1.4, "car-body pitch"), (6.6, 6.7, "bogie bounce, both bogies")])
def test_labels_of_oscillations(train_modes, low, high, label):
    """Frequencies by hand: bounce sqrt(4*4.2e5/39000) rad/s = 1.04 Hz, less what the primary springs in series take."""
    assert label in {mode.label for mode in train_modes if low < mode.frequency_hz < high}


def test_labels_of_the_running_gear(train_modes):
    assert {mode.label for mode in train_modes.unstable} == {"bogie hunting, leading", "bogie hunting, trailing"}
    labels = train_modes.label
    for name in ("Maxwell damper relaxation, yaw_damper", "Maxwell damper relaxation, lateral_damper", "wheel-rail creep, wheelset1"):
        assert name in labels, name
    relaxed = [mode for mode in train_modes if mode.label.startswith("Maxwell damper relaxation, yaw_damper")]
    assert len(relaxed) == 4 and all(-3.0 < mode.eigenvalue.real < -1.0 for mode in relaxed)      # 2.3e6 / 1.2e6 = 1.9 1/s


def test_pole_of_the_car_body():
    """y right, z down, roll about the forward axis: a point h above the centre of mass moves by y + h roll."""
    model = model_of(["car.y", "car.roll"], np.diag([40000.0, 60000.0]), np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((2, 2)))
    labels = MotionLabels(model)
    pole_above, pole_below = np.array([1.0, -1.0 / 1.2]), np.array([1.0, 1.0 / 1.2])
    assert pole_above[0] + 1.2 * pole_above[1] == 0.0           # at rest 1.2 m above the centre of mass
    assert labels.label(5j, pole_above + 0j, 10.0) == "car-body upper sway"
    assert labels.label(5j, pole_below + 0j, 10.0) == "car-body lower sway"


def test_labels_without_telling_names():
    """Masses decide: 39 t over wheelsets of 1.5 t, frames of 3 t, trusses of 20 kg."""
    names = ["alpha.y", "beta.y", "gamma.y", "wheelset1.y", "wheelset1.spin"]
    mass = np.diag([39000.0, 3000.0, 20.0, 1500.0, 90.0])
    zero = np.zeros((5, 5))
    labels = MotionLabels(model_of(names, mass, zero, zero, zero, zero))
    assert [labels.bodies[name].role for name in ("alpha", "beta", "gamma", "wheelset1")] == ["car body", "bogie frame", "link", "wheelset"]
