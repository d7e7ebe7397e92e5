# SPDX-License-Identifier: BSD-3-Clause
"""What workers of a process pool find loaded: they then start in milliseconds."""

import railsym.sweep.critical_speed  # noqa: F401
import railsym.sweep.worker  # noqa: F401
