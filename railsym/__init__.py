# SPDX-License-Identifier: BSD-3-Clause
"""railsym: railway vehicle dynamics from Kane-derived equations."""

from railsym.contact import LinearContact

__all__ = ["LinearContact"]
