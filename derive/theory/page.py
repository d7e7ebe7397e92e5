# SPDX-License-Identifier: BSD-3-Clause
"""The page: method, and for each kernel inputs, code and matrices about the design position."""

from __future__ import annotations

import sympy as sm

from derive.theory.linear_form import at_rest, at_state, matrices
from derive.theory.notation import code, input_table, latex, matrix

_BODY = ("x", "y", "z", "yaw", "roll", "pitch")
_WHEEL = ("x", "y", "z", "yaw", "roll", "spin")
_SPINNING = {"u_spin": -sm.Symbol("Omega", real=True)}

_METHOD = r"""# Theory: the equations of the kernels

This page is written by `python -m derive.theory` from the SymPy objects that the C in `csrc/generated/` is made of, and `.ci/run` checks that it still is
what they give. Names are those of the code. Axes and signs: [conventions.md](conventions.md).

## Method
Every body has a track frame of its own, which runs along the track at the vehicle's speed V and turns with it. Its coordinates $q$ are the displacement from the
design position and yaw, roll and pitch (for a wheelset: spin) in that frame; its speeds are $u = \dot q$. **Kane's method** (`sympy.physics.mechanics.KanesMethod`)
gives the generalised active forces $F_r$ and inertia forces $F_r^*$, and a kernel computes the residual

$$ r(q, u, a, s) = -(F_r + F_r^*), \qquad a = \dot u, $$

with s the internal states of elements. Elements and contacts add their generalised forces, found by partial velocities: a force $F$ at a point with velocity $v$
and a moment $M$ on a body with angular velocity $\omega$ give $-F \cdot \partial v/\partial u_r - M \cdot \partial\omega/\partial u_r$. The equations of motion of a vehicle are r = 0,
the sum of its kernels.

The same kernel gives the **pencil**, the tangent of r when coordinate j moves q, u and a together,

$$ S = c_q \frac{\partial r}{\partial q} + c_u \frac{\partial r}{\partial u} + c_a \frac{\partial r}{\partial a}, $$

by pushing tangents through the straight-line code. With $(c_q, c_u, c_a) = (1,0,0), (0,1,0), (0,0,1)$ it is stiffness, damping and mass matrix, and the state matrix of a vehicle is

$$ A = \begin{pmatrix} 0 & 1 \\ -M^{-1} K & -M^{-1} C \end{pmatrix} $$

(with rows for s); with $(\beta' h^2, \gamma' h, \alpha')$ of a time step h it is the iteration matrix of the integrator ([simulation.md](simulation.md)).

Below, "about the design position" means: all coordinates 0, straight and level track. The matrices are evaluated from the code of the
kernels, not derived again.
"""


def page(kernels):
    """Text of docs/theory.md."""
    by_name = {kernel.tape.name: kernel for kernel in kernels}
    parts = [_METHOD, _body(by_name["rigid_body"], _BODY, "Rigid body"),
             _body(by_name["wheelset"], _WHEEL, "Wheelset", "It turns at $\\dot q_{\\mathrm{spin}} = -\\Omega$ about its axle, $\\Omega = V/r_0$ when it rolls: the damping matrix is that of the gyroscopic moments.", _SPINNING),
             _body(by_name["wheelset_with_axleboxes"], (*_WHEEL, "pitch of the left axlebox", "pitch of the right one"), "Wheelset with two axleboxes", "Without products of inertia, axleboxes centred on the axle at $\\pm b$ and alike.", _SPINNING | _alike_boxes()),
             _bushing(by_name["bushing"]), _law_element(by_name["line"], "Line element", {}),
             _law_element(by_name["axis"], "Axis element", {"ax0": 1, "ax1": 0, "ax2": 0}), _wheel_rail(by_name["wheel_rail"])]
    return "\n".join(line.rstrip() for line in "\n".join(parts).splitlines()) + "\n"


def _head(kernel, title):
    lines = [f"## {title}", f"{kernel.tape.summary}. `csrc/generated/{kernel.tape.name}.h`: {len(kernel.tape.inputs)} inputs, {len(kernel.rows)} rows, "
             f"{len(kernel.entries)} entries of the pencil that are not always 0.", ""]
    lines += ["<details><summary>Inputs</summary>", "", *input_table(kernel.tape), "", "</details>", ""]
    return [*lines, "<details><summary>Residual, line by line</summary>", "", "```", *code(kernel), "```", "", "</details>", ""]


def _alike_boxes():
    b, m, across, along = sm.symbols("b m_b I_b J_b", real=True)
    given = {}
    for side, sign in (("left", -1), ("right", 1)):
        given |= {f"m_{side}": m, f"I{side}_xx": across, f"I{side}_yy": along, f"I{side}_zz": across, f"I{side}_xy": 0, f"I{side}_yz": 0, f"I{side}_xz": 0,
                  f"c_{side}0": 0, f"c_{side}1": sign * b, f"c_{side}2": 0}
    return given


def _body(kernel, coordinates, title, remark="", given=None):
    _, pencil = at_state(kernel, given or {}, at_rest)
    stiffness, damping, mass = matrices(pencil)
    lines = _head(kernel, title) + ["**About the design position.** " + remark, "", *matrix("Mass", mass, coordinates), "", *matrix("Damping", damping, coordinates), "",
                                    *matrix("Stiffness", stiffness, coordinates), ""]
    return "\n".join(lines)


def _bushing(kernel):
    here = {f"{name}{k}": 0 for name in ("m1_", "m2_", "D", "f0_", "e0_") for k in range(3)}
    here |= {f"{name}{k}": 0 for name in ("f0_", "e0_") for k in range(3, 6)}
    _, pencil = at_state(kernel, here, at_rest)
    stiffness, damping, _ = matrices(pencil)
    names = tuple(f"{name} of body {k}" for k in (1, 2) for name in _BODY)
    block = stiffness[:6, :6], damping[:6, :6]
    lines = _head(kernel, "Bushing") + ["**About the design position**, both markers at the centres of their bodies and without preload; the block of body 1 (that of both bodies has "
                                        "the opposite sign):", "", *matrix("Stiffness", block[0], names), "", *matrix("Damping", block[1], names), ""]
    return "\n".join(lines)


def _law_element(kernel, title, given):
    length = sm.Symbol("L", real=True)
    here = {f"{name}{k}": 0 for name in ("m1_", "m2_") for k in range(3)} | {"D0": sm.Abs(length), "D1": 0, "D2": 0, "s": 0, "ds": 0} | given
    _, pencil = at_state(kernel, here, at_rest)
    stiffness, damping, _ = matrices(sm.simplify(pencil[:3, :3]))
    names = tuple(f"{name} of body 1" for name in _BODY)
    lines = _head(kernel, title) + ["`law` is the scalar force law of the element, f(e, de/dt, s, ds/dt), and its state equation g = 0 (`csrc/laws.h`, [vehicle_file.md](vehicle_file.md)); "
                                    "f_e, f_v, ... are its slopes.", "",
                                    "**About the design position**, body 2 at a distance L along x from body 1, both markers at the centres; the block of the displacements of body 1:", "",
                                    *matrix("Stiffness", stiffness, names), "", *matrix("Damping", damping, names), ""]
    return "\n".join(lines)


def _wheel_rail(kernel):
    speed, radius = sm.symbols("V r0", real=True)
    both = sum((at_state(kernel, {"side": side, "u_spin": -speed / radius}, at_rest)[1] for side in (-1, 1)), sm.zeros(6, 6)).applyfunc(sm.expand)
    stiffness, damping, _ = matrices(both)
    lines = _head(kernel, "Linear wheel-rail contact") + [
        "What the terms mean, and what is assumed: [linear_contact.md](linear_contact.md).", "",
        "**About the design position**, rolling at V, the sum of both wheels of a wheelset.", "", *matrix("Damping", damping, _WHEEL), "", *matrix("Stiffness", stiffness, _WHEEL), "",
        *_hunting(stiffness, damping)]
    return "\n".join(lines)


def _hunting(stiffness, damping):
    """Lateral motion and yaw of a wheelset, and Klingel's frequency from them."""
    simple = {sm.Symbol(name, real=True): 0 for name in ("slope", "grad", "f23", "f33")}
    positive = {sm.Symbol(name, real=True): sm.Symbol(name, positive=True) for name in ("V", "f11", "f22", "b0", "r0", "lam")}
    k, c = (entry.extract([1, 3], [1, 3]).xreplace(simple).applyfunc(sm.expand) for entry in (stiffness, damping))
    omega = sm.Symbol("omega", positive=True)
    determinant = sm.expand((k + sm.I * omega * c).xreplace(positive).det())
    (found,) = sm.solve(sm.re(determinant), omega)
    names = {name: sm.Symbol(str(name), real=True) for name in positive.values()}
    return ["**Hunting.** Without contact angle, spin creep and inertia, lateral shift y and yaw of a free wheelset obey", "", "$$", latex(k), r"\begin{pmatrix} y \\ \psi \end{pmatrix} + ",
            latex(c), r"\begin{pmatrix} \dot y \\ \dot\psi \end{pmatrix} = 0.", "$$", "",
            "The real part of its determinant vanishes at the angular frequency", "", f"$$ \\omega = {latex(found.xreplace(names))}, $$", "", "that of Klingel (1883): $V\\sqrt{\\lambda/(b_0 r_0)}$.", ""]
