# SPDX-License-Identifier: BSD-3-Clause
"""Curving of a vehicle: wheel-rail forces, angle of attack and wear number against radius, speed and cant deficiency."""

from railsym.lazy import lazy

_MODULE_OF = {"Curving": "result", "Failure": "result", "curving": "study"}

__getattr__, __dir__, __all__ = lazy(__name__, _MODULE_OF)
