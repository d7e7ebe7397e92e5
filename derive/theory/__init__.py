# SPDX-License-Identifier: BSD-3-Clause
"""docs/theory.md: the equations of every kernel, printed from the SymPy objects that make the C."""
