# SPDX-License-Identifier: BSD-3-Clause
"""Ten short scripts, from a wheelset's hunting to the optimised Pendolino; ``python -m examples`` makes their pages."""
