# SPDX-License-Identifier: BSD-3-Clause
"""railsym: railway vehicle dynamics from Kane-derived equations."""
