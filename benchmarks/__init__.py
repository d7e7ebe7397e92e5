# SPDX-License-Identifier: BSD-3-Clause
"""What railsym costs: ``python -m benchmarks`` from the checkout, with railsym installed."""
