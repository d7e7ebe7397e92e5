# SPDX-License-Identifier: BSD-3-Clause
"""Models written separately from the package, which the tests compare it with."""
