# SPDX-License-Identifier: BSD-3-Clause
"""``python -m railsym`` is the command ``railsym``."""

import sys

from railsym.cli import main

if __name__ == "__main__":
    sys.exit(main())
