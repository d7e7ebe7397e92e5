# SPDX-License-Identifier: BSD-3-Clause
"""The theory page's matrices: kernels evaluated at a state, against closed forms."""

import pytest
import sympy as sm

from derive import bodies, elements, wheel_rail
from derive.theory.linear_form import at_rest, at_state, matrices
from derive.theory.notation import code, input_table, matrix


def named(text):
    return sm.symbols(text, real=True)


def test_a_spinning_wheelset_has_its_mass_and_gyroscopic_moments():
    """A roll rate turns the spin momentum I_yy Omega, which points to -y, about x: a moment about z, and back."""
    omega, along = named("Omega I_yy")
    stiffness, damping, mass = matrices(at_state(bodies.wheelset(axleboxes=False), {"u_spin": -omega}, at_rest)[1])
    assert mass == sm.diag(*named("m m m I_xx I_xx I_yy")) and stiffness == sm.zeros(6)
    wanted = sm.zeros(6)
    wanted[3, 4], wanted[4, 3] = -along * omega, along * omega
    assert damping == wanted


def test_a_taut_line_is_stiff_across_by_its_force():
    """Force over length, as for a string."""
    kernel = elements.line()
    here = {"m1_0": 0, "m1_1": 0, "m1_2": 0, "m2_0": 0, "m2_1": 0, "m2_2": 0, "D0": 4, "D1": 0, "D2": 0}
    residual, pencil = at_state(kernel, here, at_rest)
    f, f_e, f_v = named("f f_e f_v")
    stiffness, damping, _ = (sm.simplify(entry[:3, :3]) for entry in matrices(pencil))
    assert list(residual[:3]) == [-f, 0, 0]
    assert stiffness == sm.diag(f_e, f / 4, f / 4) and damping == sm.diag(f_v, 0, 0)


def test_a_cone_set_hunts_at_klingels_frequency():
    """The determinant of shift and yaw, inertia left out, is zero at V sqrt(lambda/(b0 r0))."""
    speed, radius, width, conicity, f11, f22 = named("V r0 b0 lam f11 f22")
    kernel = wheel_rail.wheel_rail()
    both = sum((at_state(kernel, {"side": side, "u_spin": -speed / radius, "slope": 0, "grad": 0, "f23": 0, "f33": 0}, at_rest)[1] for side in (-1, 1)), sm.zeros(6, 6))
    stiffness, damping, _ = (entry.extract([1, 3], [1, 3]) for entry in matrices(both))
    omega_squared = speed**2 * conicity / (width * radius)
    assert sm.simplify(stiffness.det() - omega_squared * damping.det()) == 0
    assert sm.simplify(damping.det() - 4 * f11 * f22 * width**2 / speed**2) == 0


def test_code_and_inputs_are_those_of_the_kernel():
    kernel = bodies.wheelset(axleboxes=False)
    lines = code(kernel)
    assert len(lines) == len(kernel.tape.lines) and all(" = " in line for line in lines)
    table = input_table(kernel.tape)
    assert "| `u_x` to `u_spin` | m/s or rad/s | rates of the coordinates |" in table
    assert sum("`" in row for row in table) < len(kernel.tape.inputs)


@pytest.mark.parametrize(("entries", "words"), [(sm.zeros(2), "M = 0."), (sm.diag(named("a"), 0), "M, of x:"),
                                                (sm.diag(sum(named("a b c d e f g")), named("h")), "entries that are not 0")])
def test_matrices_are_shown_by_what_they_hold(entries, words):
    assert words in "\n".join(matrix("M", entries, ("x", "y")))
