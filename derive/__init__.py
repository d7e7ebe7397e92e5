# SPDX-License-Identifier: BSD-3-Clause
"""Derivation of the kernels by Kane's method; never imported by railsym at run time.

``python -m derive`` writes ``csrc/generated/``; ``python -m derive --check`` compares.
"""
