# SPDX-License-Identifier: BSD-3-Clause
"""What the binding of the C library refuses, and how it says so."""

import numpy as np
import pytest

from railsym import _core
from railsym.errors import CoreError, ModelError

TWELVE = np.arange(12)[None]
ANGLES = np.tile([False] * 3 + [True] * 3, 2)
REST = np.zeros(12)


def inputs(name, count=1):
    return np.ones((count, len(_core.kernels()[name].inputs)))


@pytest.fixture
def assembly():
    """Twelve coordinates under one bushing."""
    made = _core.Assembly(ANGLES)
    made.add("bushing", inputs("bushing"), TWELVE)
    return made


@pytest.mark.parametrize("index", [12, -2, 10**6])
def test_index_outside_the_model(index):
    empty = _core.Assembly(ANGLES)
    with pytest.raises(CoreError, match="adding bushing: an index is outside its range"):
        empty.add("bushing", inputs("bushing"), np.where(TWELVE == 11, index, TWELVE))
    empty.add("bushing", inputs("bushing"), TWELVE)  # the refused call left nothing behind


def test_a_kernel_is_added_once(assembly):
    with pytest.raises(ModelError, match="'bushing' was added before"):
        assembly.add("bushing", inputs("bushing"), TWELVE)


def test_unknown_kernels_and_inputs_name_what_exists(assembly):
    with pytest.raises(ModelError, match="'bushng' does not exist; there are rigid_body, .*bushing"):
        assembly.add("bushng", inputs("bushing"), TWELVE)
    with pytest.raises(ModelError, match="kernel 'axis': none was added; there are bushing"):
        assembly.set_input("axis", "e0", [0.0])
    with pytest.raises(ModelError, match="bushing has no input 'stiffness'; it has k0"):
        assembly.set_input("bushing", "stiffness", [0.0])


def test_preloads_and_commands_of_force_laws():
    laws = _core.Laws([{"kind": "none"}] * 2)
    with pytest.raises(ModelError, match="preloads: 2 numbers are needed, 3 were given"):
        laws.set_preload(np.zeros(3))
    with pytest.raises(ModelError, match="command of force law 2: there are 2"):
        laws.set_command(2, 1.0)


@pytest.mark.parametrize(("table", "index"), [
    (inputs("axis")[:, 1:], np.arange(13)[None]),
    (inputs("axis"), np.arange(12)[None]),
    (inputs("axis", 2), np.arange(13)[None]),
    (inputs("axis")[0], np.arange(13)),
])
def test_tables_of_the_wrong_shape(table, index):
    with pytest.raises(ModelError, match=r"axis: inputs .* do not fit \d+ inputs and 13 coordinates"):
        _core.Assembly([*ANGLES, False]).add("axis", table, index, _core.Laws([{"kind": "none"}]))


def test_no_instances():
    with pytest.raises(CoreError, match="a size is not positive"):
        _core.Assembly(ANGLES).add("bushing", inputs("bushing", 0), np.empty((0, 12)))


def test_force_laws_that_are_missing_or_too_few():
    made, index = _core.Assembly([*ANGLES, False]), np.tile(np.arange(13), (3, 1))
    with pytest.raises(CoreError, match="force laws are missing"):
        made.add("line", inputs("line", 3), index)
    with pytest.raises(ModelError, match="3 instances need as many force laws, 2 were given"):
        made.add("line", inputs("line", 3), index, _core.Laws([{"kind": "none"}] * 2))


def test_an_angle_that_the_model_does_not_know():
    with pytest.raises(ModelError, match="coordinate 4 is an angle there"):
        _core.Assembly([k != 4 and angle for k, angle in enumerate(ANGLES)]).add("bushing", inputs("bushing"), TWELVE)


def test_a_model_without_coordinates():
    with pytest.raises(ModelError, match="0 coordinates"):
        _core.Assembly([])


@pytest.mark.parametrize("place", range(3))
def test_state_of_the_wrong_size(assembly, place):
    state = [REST, REST, REST]
    state[place] = np.zeros(11)
    with pytest.raises(ModelError, match=f"{'qua'[place]}: 12 numbers are needed, 11 were given"):
        assembly.residual(*state)
    with pytest.raises(ModelError, match="12 numbers are needed"):
        assembly.pencil(*state, (1, 0, 0))


def test_inputs_and_seeds_of_the_wrong_size(assembly):
    with pytest.raises(ModelError, match="bushing.k0: 1 numbers are needed, 2 were given"):
        assembly.set_input("bushing", "k0", [1.0, 2.0])
    with pytest.raises(ModelError, match="seed: 3 numbers"):
        assembly.pencil(REST, REST, REST, (1, 0))
    with pytest.raises(ModelError, match="bushing: 96 numbers are needed, 5 were given"):
        _core.kernel_real("bushing", np.ones(5), (1, 0, 0))
    with pytest.raises(ModelError, match="bushing: 96 inputs are needed, 5 were given"):
        _core.kernel_complex("bushing", np.ones(5), (1, 0, 0))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_residual_that_is_not_finite_is_an_error(assembly, bad):
    q = REST.copy()
    q[3] = q[1] = bad
    with pytest.raises(CoreError, match="residual, coordinate [0-3]: the residual is not finite"):
        assembly.residual(q, REST, REST)
    with pytest.raises(CoreError, match="pencil, coordinate [0-3]: the residual is not finite"):
        assembly.pencil(q, REST, REST, (1, 0, 0))
    assert np.isfinite(assembly.residual(REST, REST, REST)).all()  # and it leaves no trace


def test_set_input_reaches_every_instance():
    """Nine instances are two blocks of lanes; each takes its own value."""
    made = _core.Assembly(np.tile(ANGLES, 9))
    made.add("bushing", np.zeros(inputs("bushing", 9).shape), np.arange(108).reshape(9, 12))
    rest = np.zeros(108)
    assert not made.residual(rest, rest, rest).any()
    made.set_input("bushing", "C00", np.ones(9))
    made.set_input("bushing", "A1_00", np.ones(9))
    made.set_input("bushing", "f0_0", np.arange(9.0))
    np.testing.assert_array_equal(made.residual(rest, rest, rest).reshape(9, 12)[:, 0], -np.arange(9.0))


def test_descriptions_are_complete():
    """Names are unique, each has a unit, each coordinate has a rate, and slots are in range."""
    for kernel in _core.kernels().values():
        assert len(set(kernel.inputs)) == len(kernel.inputs) == len(kernel.units)
        assert all(kernel.units)
        assert kernel.slots.shape == (kernel.coordinates, 5)
        assert (kernel.slots[:, 1] >= 0).all() and kernel.slots.max() < len(kernel.inputs)
        used = kernel.slots[kernel.slots >= 0]
        assert len(set(used)) == len(used)
        assert kernel.pattern.min() >= 0 and kernel.pattern.max() < kernel.coordinates
        assert ((kernel.slots[:, 3] >= 0) == (kernel.slots[:, 4] >= 0)).all()
