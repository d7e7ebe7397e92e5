# SPDX-License-Identifier: BSD-3-Clause
"""Why a run stopped, in words: which equation or wheel, where, and what to do."""

from __future__ import annotations

from railsym import _core_integrator as core
from railsym.errors import ContactError, CoreError
from railsym.results.metadata import Ending


def ending_of(parts, status):
    """The `Ending` that a status of the integrator stands for.

    Parameters
    ----------
    parts : Assembled
    status : int

    Returns
    -------
    Ending
    """
    report = parts.integrator.report
    where = {"time": float(report.time), "distance": float(parts.speed.place(report.time))}
    equation = parts.names[report.coordinate] if 0 <= report.coordinate < len(parts.names) else ""
    if status == core.STOPPED:
        return Ending("interrupted", **where, detail="the controller stopped the run")
    if status in (core.OUT_OF_TABLE, core.BAD_SPEED, core.NOT_FINITE) and parts.wheels is not None:
        found = _wheel_failure(parts, status, where)
        if found is not None:
            return found
    if status == core.OUT_OF_TRACK:
        return Ending("interrupted", **where, detail="a body is beyond the end of the track; lengthen it or shorten the run")
    return Ending("not_converged", **where, detail=_detail(status, equation, parts.integrator.step))


def _detail(status, equation, step):
    if status == core.NOT_FINITE:
        return (f"the equation of {equation} is not finite: look at what acts there (parameters, applied forces, commands) and at the initial "
                "state")
    if status == core.SINGULAR:
        return f"the matrix of the iteration is singular at {equation}: it has neither mass nor stiffness there"
    return (f"the iteration of a step of {step:g} s stuck at {equation}; take a shorter step (dt={step / 4:g}), and look at what is stiff or "
            "switches there")


def _wheel_failure(parts, status, where):
    """Derailment and other ends that a wheel is to blame for; None where no wheel is."""
    try:
        parts.wheels._core.explain(status, float(parts.speed.at(where["time"])))
    except CoreError:
        return None  # the wheels are not to blame
    except ContactError as error:
        text = str(error)
        wheel = getattr(error, "wheel", text.partition(":")[0]).replace(", ", ".")
        left = status == core.OUT_OF_TABLE and "lateral shift" in text
        advice = "" if left else f"; a shorter step (dt={parts.integrator.step / 4:g}) or a smoother start may keep it inside"
        return Ending("derailed" if left else "not_converged", wheel=wheel, **where, detail=text + advice)
    return None
